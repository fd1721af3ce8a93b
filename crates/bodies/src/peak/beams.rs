//! Beams with small rotations: nine forces at the ends of an element, linear in the unknowns of its nodes.

use rayon::prelude::*;

use super::state::{StressedState, larger};
use crate::SectionForces;
use crate::beam::Beam;

/// Elements that a thread takes at least: waking it takes as long as some hundred.
const SHARE: usize = 256;

/// Forces at the ends: N, V_y, V_z, and the three moments at the first and at the second end.
const FORCES: usize = 9;

/// Coefficients of the forces of each element.
#[derive(Debug)]
pub(super) struct BeamForces {
    /// Unknowns of an element.
    unknowns: usize,
    /// By element, unknown and force.
    coefficients: Vec<[f64; FORCES]>,
}

impl BeamForces {
    /// Whether the forces of a beam are linear in its displacement, and its largest stress is known.
    pub(super) fn serve(beam: &Beam) -> bool {
        beam.flowing.is_none() && beam.places.is_some()
    }

    /// None of beams that they do not serve.
    pub(super) fn new(beam: &Beam) -> Option<BeamForces> {
        let per_node = beam.per_node();
        let linear = BeamForces::serve(beam);
        let last = beam.first.iter().flatten().max()?;
        let mut u = vec![0.0; last + per_node];
        let mut coefficients = Vec::new();
        for element in (0..beam.first.len()).filter(|_| linear) {
            for first in beam.first[element] {
                for unknown in first..first + per_node {
                    u[unknown] = 1.0;
                    let found = beam.section_force(element, &u, &[]);
                    u[unknown] = 0.0;
                    let mut all = [0.0; FORCES];
                    let [first, second] = [found.moment_first, found.moment_second];
                    let parts = [found.force, first, second].into_iter().flatten();
                    all.iter_mut()
                        .zip(parts)
                        .for_each(|(all, part)| *all = part);
                    coefficients.push(all);
                }
            }
        }
        linear.then_some(BeamForces {
            unknowns: 2 * per_node,
            coefficients,
        })
    }

    /// See [`PeakStress::above`](super::PeakStress::above).
    pub(super) fn above(&self, floor: f64, beam: &Beam, at: &StressedState) -> Option<(f64, u32)> {
        let places = beam.places.as_ref()?;
        let elements = (0..beam.first.len()).into_par_iter().with_min_len(SHARE);
        let stress = |element: usize| {
            let forces = self.forces(element, beam, at);
            if places.bound(&forces) <= floor {
                return None;
            }
            let value = places.stress(&forces).von_mises;
            (value > floor).then_some((value, element as u32))
        };
        elements.filter_map(stress).reduce_with(larger)
    }

    fn forces(&self, element: usize, beam: &Beam, at: &StressedState) -> SectionForces {
        let own = &self.coefficients[self.unknowns * element..][..self.unknowns];
        let (one, other) = own.split_at(self.unknowns / 2);
        let mut all = [0.0; FORCES];
        for (first, own) in beam.first[element].iter().zip([one, other]) {
            for (u, coefficients) in at.u[*first..].iter().zip(own) {
                for (force, c) in all.iter_mut().zip(coefficients) {
                    *force += c * u;
                }
            }
        }
        SectionForces {
            force: [
                all[0] + beam.kept_force(element, at.history),
                all[1],
                all[2],
            ],
            moment_first: [all[3], all[4], all[5]],
            moment_second: [all[6], all[7], all[8]],
        }
    }
}
