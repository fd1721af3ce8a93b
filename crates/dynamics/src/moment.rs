//! Moments of contact forces about a point.

use carom_algebra::rotation::Rotation;
use carom_contact::Rows;

use crate::resultant::Resultant;
use crate::system::System;

/// Moment of the forces of a contact on its secondary body about the point of the contact
/// ([`MomentAbout`](crate::system::MomentAbout)), N m; zero without one.
///
/// `Σ (x_a - c) × f_a` over the nodes a of the secondary surface, moments on rotations included, with f the part of `Nᵀ P + Tᵀ t` on
/// that side. Places are the means of those at the displacements given; of parts at small displacements those of the reference
/// configuration. That is where the balance of angular momentum has them.
///
/// Nodes of the secondary surface and of those that carry a force are touched, no others.
///
/// `forces`: rows, point, and its force along them in N; `at`: frames, and displacements from them, m; `nodal`: room for nodal
/// forces, all zero.
pub fn moment<'a>(
    (system, contact): (&System, usize),
    forces: impl Iterator<Item = (&'a Rows, usize, f64)>,
    at: (&[Rotation], &[&[f64]]),
    nodal: &mut Vec<f64>,
) -> [f64; 3] {
    let Some(about) = &system.contacts[contact].moment else {
        return [0.0; 3];
    };
    nodal.resize(system.unknowns(), 0.0);
    let mut loaded = Vec::new();
    for (rows, point, force) in forces.filter(|(_, _, force)| *force != 0.0) {
        rows.add_force(point, force, nodal);
        loaded.push((rows, point));
    }
    if loaded.is_empty() {
        return [0.0; 3];
    }
    let sum = Resultant::on((system, &about.arms), at, nodal);
    for (rows, point) in loaded {
        for &unknown in rows.row(point).0 {
            nodal[unknown as usize] = 0.0;
        }
    }
    let c = [0, 1, 2].map(|i| about.point[i] - system.about[i]);
    let f = &sum.linear;
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        sum.angular[i] - (c[j] * f[k] - c[k] * f[j])
    })
}
