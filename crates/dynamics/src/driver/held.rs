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
        let system = Arc::clone(&self.system);
        for k in 0..system.contacts.len() {
            let mut u = std::mem::take(&mut self.vectors.place);
            let paired = self.paired_at(k);
            let xc = [&self.vectors.x[..], &self.vectors.push];
            let motion = &self.state.motion;
            self.maps.whole(|map| paired.row(map), motion, xc, &mut u);
            let time = self.state.time + self.paired_after(k);
            let mut places = system.places(time, &u, &self.state.motion.frames);
            places.frames.middle = self.between();
            let all = as_narrowed(&self.narrowed, &system, k).held(&places, &self.search[k]);
            self.vectors.place = u;
            for held in all {
                let name = self.name(system.contacts[k].range.start + held.point);
                tracing::debug!(
                    "step {}: {name} alternated between faces and stays with one; the error of its gap is {:.1e} of the face",
                    self.state.step + 1,
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
