//! Elements that are deleted where their material has flowed too far.
//!
//! A deleted element has no force and no energy any more; its mass stays at its nodes. What tells it from others is the last number
//! that its points keep. It is computed like others, at no displacement and with the history of a point that nothing has happened to: so
//! that it takes no branch.

use carom_algebra::number::Number;

use super::body::{Failed, Finite};
use super::cell::Element;
use super::{Placement, Stored};
use crate::block::Block;

/// What was deleted at the end of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deleted {
    /// Number of elements.
    pub elements: usize,
    /// Energies that they had stored, J.
    pub stored: Stored,
}

impl Finite {
    /// Whether an element with this history at the start of the step is deleted.
    pub(super) fn is_deleted(&self, history: &[f64]) -> bool {
        self.limit.is_some() && history[self.kept - 1] != 0.0
    }

    /// Whether each element is deleted; none of a body without deletion.
    pub(super) fn deleted(&self, blocks: &[Block], mut history: &[f64]) -> Option<Vec<bool>> {
        self.limit?;
        let mut out = Vec::new();
        for block in blocks {
            let own = self.kept_of_element(block);
            let (of_block, rest) = history.split_at_checked(own * block.len())?;
            history = rest;
            out.extend(of_block.chunks_exact(own).map(|own| self.is_deleted(own)));
        }
        Some(out)
    }

    /// Puts the deleted among several elements of `points` points, with these histories at the start and at the end of the step, to no
    /// displacement. A short batch repeats its last element.
    #[inline(always)]
    pub(super) fn leave_out<T: Number, const N: usize, const D: usize>(
        &self,
        points: usize,
        (old, new): (&[f64], &mut [f64]),
        u: &mut [[T; D]; N],
    ) {
        let (last, count) = (self.kept - 1, new.len() / (points * self.kept));
        for k in 0..u[0][0].lanes().len() {
            if old[k.min(count - 1) * points * self.kept + last] == 0.0 {
                continue;
            }
            for u in u.iter_mut().flatten() {
                u.lanes_mut()[k] = 0.0;
            }
        }
        let points = new.chunks_exact_mut(self.kept);
        for (new, old) in points.zip(old.chunks_exact(self.kept)) {
            new[last] = old[last];
        }
    }

    /// Deletes the elements whose mean plastic strain over their points has reached the limit in the history `new` at the end of the
    /// step that ends at `at`. Their history becomes that of elements that nothing has happened to.
    pub(super) fn delete(
        &self,
        blocks: &[Block],
        at: &Placement,
        new: &mut [f64],
    ) -> Result<Deleted, Failed> {
        let (mut deleted, mut kept, mut first) = (Deleted::default(), 0, 0);
        let Some(limit) = self.limit else {
            return Ok(deleted);
        };
        let (mut room, mut scratch) = (Element::room(), Vec::new());
        for block in blocks {
            let own = self.kept_of_element(block);
            for place in 0..block.len() {
                let range = kept + own * place..kept + own * (place + 1);
                let history = &mut new[range.clone()];
                if self.is_deleted(history) || self.mean_plastic_strain(history) < limit {
                    continue;
                }
                block.set(&mut room, &self.shape, place);
                scratch.resize(own, 0.0);
                let mut forces = vec![0.0; room.unknowns()];
                let stored = self.at_element(&room, at, range, |local| {
                    room.force(local, &mut scratch, &mut forces)
                });
                deleted
                    .stored
                    .include(&stored.map_err(|fault| (first + place, fault))?);
                deleted.elements += 1;
                self.start_history(history);
                for point in history.chunks_exact_mut(self.kept) {
                    point[self.kept - 1] = 1.0;
                }
            }
            kept += own * block.len();
            first += block.len();
        }
        Ok(deleted)
    }

    /// Mean over the points of an element, each alike.
    fn mean_plastic_strain(&self, history: &[f64]) -> f64 {
        let points = history.chunks_exact(self.kept);
        let count = points.len() as f64;
        let of_point = |point: &[f64]| self.law.plastic_strain(&point[..self.kept_by_law]);
        points.filter_map(of_point).sum::<f64>() / count
    }
}
