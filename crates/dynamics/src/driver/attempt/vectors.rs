//! Vectors of an attempt that several stages share.

use crate::system::Motion;

/// System vectors of the iterations.
#[derive(Default)]
pub(crate) struct Vectors {
    /// The unknown.
    pub(crate) x: Vec<f64>,
    pub(crate) dx: Vec<f64>,
    /// What supports that move add to the unknown in the first iteration.
    pub(crate) jump: Vec<f64>,
    /// Whether any of it is not zero.
    pub(crate) jumps: bool,
    /// Loads, inertia, internal and damping forces at x, N.
    pub(crate) load: Vec<f64>,
    pub(crate) inertia: Vec<f64>,
    pub(crate) internal: Vec<f64>,
    pub(crate) damping: Vec<f64>,
    /// Internal forces in the balance of the step, N.
    pub(crate) balanced: Vec<f64>,
    /// The residual without the forces of links, N; empty without links.
    pub(crate) unlinked: Vec<f64>,
    /// Acceleration that the contact forces give by themselves, m/s²; empty of schemes that do not use it.
    pub(crate) push: Vec<f64>,
    pub(crate) contact: Vec<f64>,
    pub(crate) residual: Vec<f64>,
    pub(crate) half: Vec<f64>,
    /// Loads whose motion is found together with the contact forces, N; empty where it is found before.
    pub(crate) left: Vec<f64>,
    /// The unknown before an iteration.
    pub(crate) before: Vec<f64>,
    /// A configuration or an acceleration.
    pub(crate) place: Vec<f64>,
    /// Velocity at the instant of the internal forces.
    pub(crate) rate: Vec<f64>,
    /// Displacement at the end of the step at the x of the iteration; empty without rotations.
    pub(crate) end: Vec<f64>,
    /// Displacement at the end of the step, predicted; empty where no contact is paired ahead.
    pub(crate) ahead: Vec<f64>,
    pub(crate) work: Vec<f64>,
    /// Histories of the bodies at the end of the attempt.
    pub(crate) history: Vec<f64>,
}

impl Vectors {
    /// Makes room for a step with iterations from this motion; does nothing where there is room.
    pub(crate) fn make_room(&mut self, from: &Motion) {
        self.make_room_for_start(from);
        let n = from.u.len();
        for vector in self.of_iterations() {
            vector.resize(n, 0.0);
        }
    }

    /// The same for the start of a run or of its dynamics.
    pub(crate) fn make_room_for_start(&mut self, from: &Motion) {
        let n = from.u.len();
        self.x.resize(n, 0.0);
        for vector in self.of_start() {
            vector.resize(n, 0.0);
        }
        if self.history.len() != from.history.len() {
            self.history.clone_from(&from.history);
        }
    }

    /// Leaves no room but that of the unknown, for steps without iterations.
    pub(crate) fn give_up_room(&mut self) {
        for vector in self.of_start() {
            *vector = Vec::new();
        }
        self.history = Vec::new();
        for vector in self.of_iterations() {
            *vector = Vec::new();
        }
    }

    /// Those that iterations alone need.
    fn of_iterations(&mut self) -> [&mut Vec<f64>; 5] {
        [
            &mut self.dx,
            &mut self.jump,
            &mut self.balanced,
            &mut self.contact,
            &mut self.before,
        ]
    }

    /// Those that a start needs too.
    fn of_start(&mut self) -> [&mut Vec<f64>; 9] {
        [
            &mut self.load,
            &mut self.inertia,
            &mut self.internal,
            &mut self.damping,
            &mut self.residual,
            &mut self.half,
            &mut self.place,
            &mut self.rate,
            &mut self.work,
        ]
    }
}
