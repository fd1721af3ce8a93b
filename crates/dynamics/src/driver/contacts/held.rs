//! Points that the iterations of a step have made stay with a face.

use std::sync::Arc;

use super::Contacts;
use super::deletion::as_narrowed;
use crate::driver::attempt::Attempt;
use crate::driver::parts::Parts;
use crate::error::Error;

/// Error of the gap of a point that stays with a face, over the face's diagonal, beyond which the step fails.
const STRAYED: f64 = 0.01;

impl Contacts {
    /// Tells of the points that the iterations have made stay with a face.
    ///
    /// # Errors
    /// One that has left its face so far that it does not stand for the surface.
    pub(crate) fn check_held(
        &self,
        parts: &Parts,
        attempt: &mut Attempt,
        passes: usize,
    ) -> Result<(), Error> {
        let system = Arc::clone(&attempt.system);
        for k in 0..system.contacts.len() {
            let mut u = std::mem::take(&mut attempt.vectors.place);
            let paired = self.paired_at(k);
            let xc = [&attempt.vectors.x[..], &attempt.vectors.push];
            let motion = &attempt.state.motion;
            attempt
                .maps
                .whole(|map| paired.row(map), motion, xc, &mut u);
            let time = attempt.state.time + self.paired_after(attempt, k);
            let mut places = system.places(time, &u, &attempt.state.motion.frames);
            places.frames.middle = attempt.between();
            let all = as_narrowed(&self.narrowed, &system, k).held(&places, &self.search[k]);
            attempt.vectors.place = u;
            for held in all {
                let name = attempt.name(system.contacts[k].range.start + held.point);
                tracing::debug!(
                    "step {}: {name} alternated between faces and stays with one; the error of its gap is {:.1e} of the face",
                    attempt.state.step + 1,
                    held.error
                );
                if held.error.abs() > STRAYED {
                    return Err(self.strayed(parts, attempt, &name, passes));
                }
            }
        }
        Ok(())
    }

    /// The error of a point that has left the face which it stays with.
    fn strayed(&self, parts: &Parts, attempt: &Attempt, point: &str, passes: usize) -> Error {
        let mut error = self.no_equilibrium(parts, attempt, passes);
        if let Error::Equilibrium { contact, .. } = &mut error {
            *contact = format!("; {point} slides through the fold between two faces").into();
        }
        error
    }
}
