//! Bodies at small strain through the functions of the nonlinear ones.

use carom_algebra::csr::Csr;

use super::{Placement, Stored};
use crate::scratch::Scratch;
use crate::solid::Solid;

impl Solid {
    /// Adds K u, or K (u_0 + u)/2 between two displacements, whose work is exactly U(u) - U(u_0); the energy is U(u).
    pub(super) fn linear_force(
        &self,
        at: &Placement,
        scratch: &mut Scratch,
        f: &mut [f64],
    ) -> Stored {
        let strain = match at.from {
            None => self.internal_force(at.u, scratch, f),
            Some(from) => {
                let mut middle = std::mem::take(&mut scratch.middle);
                middle.clear();
                middle.extend(at.u.iter().zip(from).map(|(u, from)| 0.5 * (u + from)));
                self.internal_force(&middle, scratch, f);
                // room for the forces at u, which nobody wants
                middle.fill(0.0);
                let strain = self.internal_force(at.u, scratch, &mut middle);
                scratch.middle = middle;
                strain
            }
        };
        Stored {
            strain,
            ..Stored::default()
        }
    }

    /// Adds `factor` K, half of it between two displacements.
    pub(super) fn add_linear_tangent(&self, at: &Placement, factor: f64, matrix: &mut Csr) {
        let dim = self.dim();
        let factor = if at.from.is_some() {
            0.5 * factor
        } else {
            factor
        };
        let (mut unknowns, mut block) = (Vec::new(), Vec::new());
        self.each_matrix(true, &mut |element| {
            unknowns.clear();
            let of_node = |&first: &u32| first..first + dim as u32;
            unknowns.extend(element.first.iter().flat_map(of_node));
            block.clear();
            block.extend(element.stiffness.iter().map(|k| factor * k));
            matrix.add_block(&unknowns, &block);
        });
        let all = 0..usize::MAX;
        self.layers.loosen_matrix(factor, &all, matrix);
    }
}
