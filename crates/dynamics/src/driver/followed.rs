//! Accelerations of unknowns that follow a function of time ū(t), as the state shows them.
//!
//! The steps themselves know one rate of such an unknown, and no acceleration: it jumps from rate to rate at their ends
//! ([`supports`](super::supports)). What the state shows is the jump over the step, the second difference of ū,
//!
//! `a = (ū(t + h) - 2 ū(t) + ū(t - h))/h²`,
//!
//! at the instant t to which the accelerations of the other unknowns belong, with the size h of the step, or the time since the start of the
//! dynamics where that is shorter. At the start itself it is `2 (ū(t + h) - ū(t) - h v)/h²`, v the rate before. Both are of second order, and exact where
//! ū is a parabola. It is zero again before the next step begins.

use super::owners::Attempt;

impl Attempt {
    /// Writes the accelerations of the state at the end of a step of `dt`, or, where that is zero, at the start of the dynamics.
    pub(super) fn show_followed(&mut self, dt: f64) {
        // static steps have no accelerations
        if self.maps.is_static() {
            return;
        }
        let system = &*self.system;
        let begin = system.nonlinear.preload.map_or(0.0, |stage| stage.end);
        for follows in &system.nonlinear.follows {
            let i = follows.unknown as usize;
            let at = |time: f64| system.nonlinear.amplitudes[follows.amplitude].at(time);
            let time = system.instant_of(i, self.state.time, dt);
            let since = time - begin;
            self.state.motion.a[i] = if since > 0.0 {
                let h = dt.min(since);
                (at(time + h) - at(time) - (at(time) - at(time - h))) / (h * h)
            } else {
                // of a scheme whose balance is that of the start of the step, the state before it has the rate there
                let (h, before) = match dt > 0.0 {
                    true => (dt, &self.next.motion),
                    false => (system.dt, &self.state.motion),
                };
                2.0 * (at(time + h) - at(time) - h * before.v[i]) / (h * h)
            };
        }
    }

    /// Takes them from the state again.
    pub(super) fn hide_followed(&mut self) {
        for follows in &self.system.nonlinear.follows {
            self.state.motion.a[follows.unknown as usize] = 0.0;
        }
    }
}
