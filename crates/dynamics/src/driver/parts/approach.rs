//! How the parts go on where pieces float.

use std::sync::Arc;

use super::Parts;
use super::rigid::Rigid;
use crate::driver::attempt::Attempt;

impl Parts {
    /// Adds to x what finite turns of the pieces have beyond the linear motion `share` dx from `before`.
    pub(crate) fn turn(&self, attempt: &mut Attempt, share: f64) {
        let system = Arc::clone(&attempt.system);
        let mut places = vec![0.0; attempt.vectors.x.len()];
        let motion = &attempt.state.motion;
        attempt.maps.whole(
            |map| map.displacement,
            motion,
            [&attempt.vectors.before, &attempt.vectors.push],
            &mut places,
        );
        let pieces = Arc::clone(&self.floating.pieces);
        let rigid = Rigid::new(
            &system,
            &pieces,
            (&places, Some(&attempt.state.motion.frames)),
        );
        let mut c = rigid.nearest(&attempt.vectors.dx);
        c.iter_mut().for_each(|c| *c *= share);
        for (i, u) in rigid.arc(&c) {
            attempt.vectors.x[i] += u;
        }
    }
}
