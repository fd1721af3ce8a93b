//! Resultants of nodal forces and momenta.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use serde::{Deserialize, Serialize};

use crate::system::{MomentArms, System};

/// Force and moment about a point of the system ([`System::about`]) in the reference configuration; or momentum and angular momentum; or their
/// impulses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Resultant {
    /// Force in N, or momentum in N s.
    pub linear: [f64; 3],
    /// Moment in N m, or angular momentum in N m s.
    pub angular: [f64; 3],
}

impl Resultant {
    /// Resultant of a system vector of nodal forces. In axisymmetry only the axial force is one: radial forces of a full
    /// turn cancel, and hoop stresses are no external force.
    pub(crate) fn of(system: &System, f: &[f64]) -> Resultant {
        Resultant::at(system, (&[], &[]), f)
    }

    /// Resultant of nodal forces, with moments about [`System::about`] of the nodes at the mean of these displacements from the
    /// frames; in the reference configuration without any, and in parts of small displacements ([`System::undeformed`]). Moments on
    /// finite rotations, about the axes of their frames, are turned by the mean of the rotations.
    pub(crate) fn at(system: &System, at: (&[Rotation], &[&[f64]]), f: &[f64]) -> Resultant {
        Resultant::on((system, &system.arms), at, f)
    }

    /// The same of the forces on some arms.
    pub(crate) fn on(
        (system, arms): (&System, &MomentArms),
        (frames, displacements): (&[Rotation], &[&[f64]]),
        f: &[f64],
    ) -> Resultant {
        let mut sum = Resultant::default();
        let (unknowns, share) = (&system.unknowns, 1.0 / displacements.len() as f64);
        // forces that a model does not have are an empty vector
        if f.is_empty() {
            return sum;
        }
        let dim = system.dim;
        for arm in &arms.nodes {
            let first = arm.first as usize;
            let vector = |values: &[f64]| {
                let mut vector = [0.0; 3];
                vector[..dim].copy_from_slice(&values[first..first + dim]);
                vector
            };
            let place = &system.x[arm.node as usize];
            let mut x = [0, 1, 2].map(|i| place[i] - system.about[i]);
            let force = vector(f);
            if !arm.undeformed {
                for u in displacements.iter().map(|u| vector(u)) {
                    for i in 0..3 {
                        x[i] += share * u[i];
                    }
                }
            }
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                sum.linear[i] += force[i];
                sum.angular[i] += x[j] * force[k] - x[k] * force[j];
            }
            if arm.bends {
                match dim {
                    2 => sum.angular[2] += f[first + 2],
                    _ => (0..3).for_each(|i| sum.angular[i] += f[first + dim + i]),
                }
            }
        }
        let about = Vec3::from(system.about);
        for (unknown, amplitude) in &arms.amplitudes {
            // rotations of amplitudes are about the origin of coordinates
            let moved = about.cross(&Vec3::from(amplitude.translation));
            for i in 0..3 {
                sum.linear[i] += amplitude.translation[i] * f[*unknown];
                sum.angular[i] += (amplitude.rotation[i] - moved[i]) * f[*unknown];
            }
        }
        let turning = arms.turning.iter();
        let turning = turning.filter_map(|&(place, node)| Some((frames.get(place)?, node)));
        for (frame, node) in turning {
            let own = frame.matrix() * Vec3::from(unknowns.spin(node, f));
            let turned = |u: &&[f64]| {
                let increment = unknowns.spin(node, u).into();
                let turned = frame.then(&Rotation::cayley(&increment));
                turned.matrix() * Vec3::from(unknowns.spin(node, f)) * share
            };
            let moment = match displacements.is_empty() {
                true => own,
                false => displacements.iter().map(turned).sum(),
            };
            for i in 0..3 {
                sum.angular[i] += moment[i];
            }
        }
        if system.axisymmetric {
            sum.linear[0] = 0.0;
            sum.angular = [0.0; 3];
        }
        sum
    }

    /// The sum of two.
    pub(crate) fn plus(&self, other: &Resultant) -> Resultant {
        self.combine(1.0, other, 1.0)
    }

    /// The opposite.
    pub(crate) fn reversed(&self) -> Resultant {
        self.combine(-1.0, &Resultant::default(), 0.0)
    }

    pub(crate) fn combine(&self, factor: f64, other: &Resultant, other_factor: f64) -> Resultant {
        let mix = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| factor * a[i] + other_factor * b[i]);
        Resultant {
            linear: mix(self.linear, other.linear),
            angular: mix(self.angular, other.angular),
        }
    }

    /// Largest absolute component of the linear part.
    pub fn largest(&self) -> f64 {
        self.linear.iter().fold(0.0, |m, x| m.max(x.abs()))
    }

    /// Largest absolute component of the angular part.
    pub fn largest_moment(&self) -> f64 {
        self.angular.iter().fold(0.0, |m, x| m.max(x.abs()))
    }
}
