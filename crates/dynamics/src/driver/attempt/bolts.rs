//! Bolts that the static stage tightens: their forces among the loads, and what they keep from the stage.

use super::Attempt;

impl Attempt {
    /// Adds the forces of bolts to the loads of the step at a time (s): over the static stage all of their force, in the dynamics what they keep
    /// beside their stiffness.
    pub(super) fn add_bolts(&mut self, time: f64) {
        let system = &*self.system;
        if !system.has_bolts {
            return;
        }
        let share = self.is_static().then(|| system.nonlinear.ramp(time));
        let motion = &self.state.motion;
        for (number, body) in system.bodies.iter().enumerate() {
            let history = system.history(number, &motion.history);
            for (bolt, kept) in body.bolts().iter().zip(history) {
                let tension = share.map_or(*kept, |share| share * bolt.force);
                bolt.add_load(tension, &mut self.vectors.load);
            }
        }
    }

    /// At the end of a static step bolts keep their forces beside their stiffness.
    pub(crate) fn keep_bolts(&mut self) {
        let system = &*self.system;
        if !system.has_bolts || !self.maps.is_static() {
            return;
        }
        let share = system.nonlinear.ramp(self.state.time + self.dt);
        let motion = &mut self.next.motion;
        for (body, range) in system.bodies.iter().zip(&system.nonlinear.histories) {
            let history = motion.history.get_mut(range.clone()).into_iter().flatten();
            for (bolt, kept) in body.bolts().iter().zip(history) {
                *kept = bolt.kept(&motion.u, share * bolt.force);
            }
        }
    }
}
