//! Points that the iterations of a step have made stay with a face.

use std::sync::Arc;

use super::Driver;
use super::deletion::as_narrowed;
use crate::error::Error;

/// Error of the gap of a point that stays with a face, over the face's diagonal, beyond which the step fails.
const STRAYED: f64 = 0.01;

impl Driver {
    /// Tells of the points that the iterations have made stay with a face.
    ///
    /// # Errors
    /// One that has left its face so far that it does not stand for the surface.
    pub(super) fn check_held(&mut self, passes: usize) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        for k in 0..system.contacts.len() {
            let mut u = std::mem::take(&mut self.attempt.vectors.place);
            let paired = self.contacts.paired_at(k);
            let xc = [&self.attempt.vectors.x[..], &self.attempt.vectors.push];
            let motion = &self.attempt.state.motion;
            self.attempt
                .maps
                .whole(|map| paired.row(map), motion, xc, &mut u);
            let time = self.attempt.state.time + self.contacts.paired_after(&self.attempt, k);
            let mut places = system.places(time, &u, &self.attempt.state.motion.frames);
            places.frames.middle = self.attempt.between();
            let all = as_narrowed(&self.contacts.narrowed, &system, k)
                .held(&places, &self.contacts.search[k]);
            self.attempt.vectors.place = u;
            for held in all {
                let name = self
                    .attempt
                    .name(system.contacts[k].range.start + held.point);
                tracing::debug!(
                    "step {}: {name} alternated between faces and stays with one; the error of its gap is {:.1e} of the face",
                    self.attempt.state.step + 1,
                    held.error
                );
                if held.error.abs() > STRAYED {
                    return Err(self.strayed(&name, passes));
                }
            }
        }
        Ok(())
    }

    /// The error of a point that has left the face which it stays with.
    fn strayed(&self, point: &str, passes: usize) -> Error {
        let mut error = self.no_equilibrium(passes);
        if let Error::Equilibrium { contact, .. } = &mut error {
            *contact = format!("; {point} slides through the fold between two faces").into();
        }
        error
    }
}
