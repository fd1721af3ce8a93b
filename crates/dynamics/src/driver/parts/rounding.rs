//! What rounding may leave of the balances of a linear step.
//!
//! A force of a stiff element is a sum of products that cancel: shear of thin shells and beams, motions of a body as a whole. A row of K u is known to
//! the unit roundoff times the sizes of its terms, which are at most √(K_ii K_jj) |u_j| as K is positive, and times the root of their number, 8 of the 54 of a shell. Over a step that
//! is an energy of `8 ε Σ K_ii |u_i| |Δu_i|`, and a momentum of `8 ε dt max_j(√K_jj |u_j|) √(Σ K_ii)`, the sum over the translations. Both are added up over the steps as
//! if all had the same sign. In a plate of thickness h with elements of length L they are beyond the energy of bending by (L/h)².

use carom_algebra::unknowns::Kind;

use super::Parts;
use super::effective::Matrices;
use crate::driver::attempt::Attempt;
use crate::system::{Maps, System};
use crate::tolerated::Tolerated;

/// Root of the number of terms of a row: errors of either sign.
const TERMS: f64 = 8.0;

impl Parts {
    /// That of the step just taken.
    pub(crate) fn rounding_of_step(&mut self, attempt: &Attempt) -> Tolerated {
        let Some(matrices) = &mut self.effective.now else {
            return Tolerated::default();
        };
        let system = &attempt.system;
        if matrices.stiffness.is_empty() {
            matrices.stiffness = stiffness(system, matrices, &attempt.maps);
        }
        let (old, new) = (&attempt.state.motion.u, &attempt.next.motion.u);
        let (mut energy, mut size, mut sum) = (0.0, 0.0_f64, 0.0);
        for (i, stiffness) in matrices.stiffness.iter().enumerate() {
            energy += stiffness * new[i].abs() * (new[i] - old[i]).abs();
            size = size.max(stiffness * new[i].powi(2));
            if matches!(system.unknowns.kind(i), Kind::Translation(_)) {
                sum += stiffness;
            }
        }
        let unit = TERMS * 0.5 * f64::EPSILON;
        Tolerated {
            energy: unit * energy,
            momentum: unit * attempt.dt * (size * sum).sqrt(),
        }
    }
}

/// The diagonal of K, by unknown: the matrix of a step less its mass.
fn stiffness(system: &System, matrices: &Matrices, maps: &Maps) -> Vec<f64> {
    let mut all = vec![0.0; system.unknowns()];
    for part in &system.parts {
        let map = maps.of(part.start);
        if map.force.x == 0.0 {
            continue;
        }
        for i in part.clone().filter(|&i| !system.fixed[i]) {
            let inertia = map.inertia.x * system.mass.diagonal(i);
            all[i] = ((matrices.diagonal[i] - inertia) / map.force.x).max(0.0);
        }
    }
    all
}
