//! Contacts that are paired where the step is predicted to lead.

use super::Driver;
use crate::error::Error;

impl Driver {
    /// Predicts the displacement at the end of the step: an iteration with the forces of contacts and links of the step
    /// before.
    pub(super) fn look_ahead(&mut self) -> Result<(), Error> {
        self.renew()?;
        self.parts.pace_mut().begin(1, 0);
        let motion = &self.attempt.state.motion;
        let vectors = &mut self.attempt.vectors;
        let residual = match self.links.force().is_empty() {
            true => &vectors.residual,
            false => &vectors.unlinked,
        };
        for (i, r) in vectors.work.iter_mut().enumerate() {
            let link = motion.link_force.get(i).unwrap_or(&0.0);
            *r = match self.attempt.system.fixed[i] {
                true => 0.0,
                false => residual[i] + self.attempt.maps.contact() * motion.contact_force[i] + link,
            };
        }
        self.links.free_motion(&mut self.parts, &mut self.attempt)?;
        let vectors = &mut self.attempt.vectors;
        for (dx, x) in vectors.dx.iter_mut().zip(&vectors.x) {
            *dx += x;
        }
        vectors.ahead.resize(vectors.x.len(), 0.0);
        let (motion, xc) = (&self.attempt.state.motion, [&vectors.dx[..], &vectors.push]);
        let ahead = &mut vectors.ahead;
        self.attempt
            .maps
            .whole(|map| map.displacement, motion, xc, ahead);
        Ok(())
    }
}
