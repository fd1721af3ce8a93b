//! Forces of springs and of elastic foundations in the balance of momentum: they may have a resultant and a moment, on the ground and across their nodes, which is
//! counted with that of the supports.

use carom_bodies::Placement;

use super::Attempt;
use super::vectors::Vectors;

impl Attempt {
    /// Writes the forces of springs in the balance of the step, N; none without springs.
    pub(crate) fn balanced_springs(&mut self, forces: &mut Vec<f64>) {
        let Vectors { x, push, place, .. } = &mut self.vectors;
        if self.system.has_springs {
            self.maps
                .whole(|map| map.force, &self.state.motion, [x, push], place);
        }
        self.springs_at_place(self.between(), forces);
    }

    /// Writes the forces of springs at the displacement in `place`, or between that of the state and this one, N; none without springs.
    pub(crate) fn springs_at_place(&self, between: bool, forces: &mut Vec<f64>) {
        let system = &*self.system;
        forces.clear();
        if !system.has_springs {
            return;
        }
        forces.resize(system.unknowns(), 0.0);
        let at = Placement {
            u: &self.vectors.place,
            v: &self.vectors.rate,
            from: between.then_some(&self.state.motion.u[..]),
            frames: &self.state.motion.frames,
            dt: self.dt,
            old: &[],
        };
        for body in &system.bodies {
            body.add_unbalanced_force(&at, forces);
        }
    }

    /// Takes from `work` the forces of linear springs in the balance of the step.
    pub(crate) fn take_linear_springs(&mut self) {
        if !self.system.has_springs {
            return;
        }
        let Vectors { x, push, place, .. } = &mut self.vectors;
        self.maps
            .whole(|map| map.force, &self.state.motion, [x, push], place);
        self.take_linear_springs_at_place();
    }

    /// Takes from `work` the forces of linear springs at the displacement in `place`, which is its opposite afterwards.
    pub(crate) fn take_linear_springs_at_place(&mut self) {
        if !self.system.has_springs {
            return;
        }
        let Vectors { place, work, .. } = &mut self.vectors;
        place.iter_mut().for_each(|u| *u = -*u);
        let at = Placement {
            u: place,
            v: &[],
            from: None,
            frames: &[],
            dt: 0.0,
            old: &[],
        };
        for body in &self.system.bodies {
            body.add_unbalanced_force(&at, work);
        }
    }
}
