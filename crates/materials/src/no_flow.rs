//! An elastic law among metals.

use carom_algebra::number::Number;

use crate::hardening::Hardening;
use crate::plane_points::{PLASTIC, PlaneStressPoints};
use crate::plane_stress::{PlaneStress, PlaneStressResponse, stress, update};
use crate::{Elastic, side_by_side};

/// An elastic law among metals: it does not flow.
#[derive(Debug)]
struct NoFlow(Elastic);

impl Hardening for NoFlow {
    fn elastic(&self) -> &Elastic {
        &self.0
    }

    #[inline(always)]
    fn slip<T: Number>(&self, q: T, _stiffness: f64, _old: &[T], _dt: f64) -> [T; 2] {
        [q.like(0.0); 2]
    }

    #[inline(always)]
    fn spent<T: Number>(&self, slip: T, _q: T, _history: (&[T], &mut [T])) -> [T; 2] {
        [slip; 2]
    }
}

impl PlaneStress for NoFlow {
    fn history_len(&self) -> usize {
        PLASTIC + 1
    }

    fn stress(&self, strain: &[f64; 3], history: &[f64]) -> [f64; 3] {
        stress(self, strain, history)
    }

    fn update(
        &self,
        strain: &[f64; 3],
        dt: f64,
        history: (&[f64], &mut [f64]),
    ) -> PlaneStressResponse {
        update(self, strain, dt, history)
    }

    fn side_by_side(&self, dt: f64, points: &mut PlaneStressPoints) {
        side_by_side::update(self, dt, points);
    }
}

/// An elastic law under plane stress, for sections in which other plies flow.
pub fn elastic_in_plane(law: Elastic) -> Box<dyn PlaneStress> {
    Box::new(NoFlow(law))
}
