//! What stages of a step leave for the stages after them: scratch, which no step needs from the one before.

use crate::assembly_energy::PartMotion;
use crate::system::{Motion, System};

/// System vectors of the iterations.
#[derive(Default)]
pub(super) struct Vectors {
    /// The unknown.
    pub(super) x: Vec<f64>,
    pub(super) dx: Vec<f64>,
    /// What supports that move add to the unknown in the first iteration.
    pub(super) jump: Vec<f64>,
    /// Whether any of it is not zero.
    pub(super) jumps: bool,
    /// Loads, inertia, internal and damping forces at x, N.
    pub(super) load: Vec<f64>,
    pub(super) inertia: Vec<f64>,
    pub(super) internal: Vec<f64>,
    pub(super) damping: Vec<f64>,
    /// Internal forces in the balance of the step, N.
    pub(super) balanced: Vec<f64>,
    /// The residual without the forces of links, N; empty without links.
    pub(super) unlinked: Vec<f64>,
    /// Acceleration that the contact forces give by themselves, m/s²; empty of schemes that do not use it.
    pub(super) push: Vec<f64>,
    pub(super) contact: Vec<f64>,
    pub(super) residual: Vec<f64>,
    pub(super) half: Vec<f64>,
    /// Loads whose motion is found together with the contact forces, N; empty where it is found before.
    pub(super) left: Vec<f64>,
    /// The unknown before an iteration.
    pub(super) before: Vec<f64>,
    /// A configuration or an acceleration.
    pub(super) place: Vec<f64>,
    /// Velocity at the instant of the internal forces.
    pub(super) rate: Vec<f64>,
    /// Displacement at the end of the step at the x of the iteration; empty without rotations.
    pub(super) end: Vec<f64>,
    /// Displacement at the end of the step, predicted; empty where no contact is paired ahead.
    pub(super) ahead: Vec<f64>,
    pub(super) work: Vec<f64>,
    /// Histories of the bodies at the end of the attempt.
    pub(super) history: Vec<f64>,
}

impl Vectors {
    /// Makes room for a step with iterations from this motion; does nothing where there is room.
    pub(super) fn make_room(&mut self, from: &Motion) {
        self.make_room_for_start(from);
        let n = from.u.len();
        for vector in self.of_iterations() {
            vector.resize(n, 0.0);
        }
    }

    /// The same for the start of a run or of its dynamics.
    pub(super) fn make_room_for_start(&mut self, from: &Motion) {
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
    pub(super) fn give_up_room(&mut self) {
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

/// Forces in the balance of a step by works, N.
#[derive(Default)]
pub(super) struct Works {
    /// Of contacts as the ledger counts them.
    pub(super) contact: Vec<f64>,
    /// What the balance leaves to supports, with what contact forces give by themselves in the inertia where they push.
    pub(super) own: Vec<f64>,
    /// What supports hold of contact forces.
    pub(super) held: Vec<f64>,
    /// Of supports.
    pub(super) reaction: Vec<f64>,
    /// Of springs; empty without any.
    pub(super) springs: Vec<f64>,
    /// Mean of one force over the step.
    pub(super) mean: Vec<f64>,
    /// Work of loads and supports in the step on each connected part, J.
    pub(super) given: Vec<f64>,
    /// Work in the step of the obstacle of each contact, J.
    pub(super) obstacles: Vec<f64>,
    /// Connected parts at the end of the step.
    pub(super) motions: Vec<PartMotion>,
}

impl Works {
    /// Sets all but springs and mean. `link`: forces of links, N, empty without any; `factor`: of the contact forces; `push`: the factor of
    /// contact forces that push by themselves.
    pub(super) fn hold(
        &mut self,
        system: &System,
        vectors: &Vectors,
        (link, factor, push): (&[f64], f64, Option<f64>),
    ) {
        let n = system.unknowns();
        for force in [
            &mut self.contact,
            &mut self.own,
            &mut self.held,
            &mut self.reaction,
        ] {
            force.resize(n, 0.0);
        }
        for i in 0..n {
            self.contact[i] = factor * vectors.contact[i];
            if !system.fixed[i] {
                // what a static stage held and let go has no reaction any more
                (self.own[i], self.held[i], self.reaction[i]) = (0.0, 0.0, 0.0);
                continue;
            }
            let inside = vectors.inertia[i] + vectors.balanced[i] + vectors.damping[i];
            // held nodes have no push
            let pushed = push.map_or(0.0, |factor| factor * vectors.contact[i]);
            self.own[i] = inside + pushed - vectors.load[i] - link.get(i).unwrap_or(&0.0);
            self.held[i] = -self.contact[i];
            self.reaction[i] = match push {
                Some(_) => self.own[i],
                None => self.own[i] + self.held[i],
            };
        }
    }
}

/// How fast the iterations go.
#[derive(Default)]
pub(super) struct Pace {
    /// Iterations of this attempt with the factor at hand.
    pub(super) age: usize,
    /// The iteration in which it was made.
    pub(super) made: usize,
    /// Contraction with a factor made within the iterations of a step, between two states; zero while unknown.
    pub(super) fresh: f64,
    /// Whether the scales of the forces have the motion at the start of the attempt, and the matrix at hand.
    pub(super) is_sized: bool,
}

/// Points and forces of the stage.
#[derive(Default)]
pub(super) struct Predictor {
    pub(super) points: Vec<u32>,
    /// R of each point, kg m.
    pub(super) forces: Vec<f64>,
    /// Gap of each contact point at u + dt v, m.
    pub(super) gaps: Vec<f64>,
    pub(super) values: Vec<f64>,
    pub(super) present: Vec<f64>,
    /// The acceleration of the state before the step.
    pub(super) kept: Vec<f64>,
}

impl Predictor {
    /// Gap of a contact point at u + dt v, m; `None` without this stage.
    pub(super) fn gap(&self, point: usize) -> Option<f64> {
        self.gaps.get(point).copied()
    }
}

/// What the impulses after a step did, those of a projection or of another stage; one entry per contact point.
#[derive(Default)]
pub(super) struct Projected {
    /// Impulse, N s.
    pub(super) impulse: Vec<f64>,
    /// Work of the impulse, J.
    pub(super) work: Vec<f64>,
    pub(super) points: Vec<u32>,
    /// Quantity of each of the points that the impulses change.
    pub(super) values: Vec<f64>,
    pub(super) present: Vec<f64>,
    /// What the projection of the acceleration adds to the multipliers of links, N per unit of the rows; empty without.
    pub(super) links: Vec<f64>,
}

impl Projected {
    pub(super) fn new(points: usize) -> Projected {
        Projected {
            impulse: vec![0.0; points],
            work: vec![0.0; points],
            ..Projected::default()
        }
    }

    /// Forgets the step before.
    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.links.clear();
        self.impulse.fill(0.0);
        self.work.fill(0.0);
    }

    /// Impulse of a point, N s.
    pub(super) fn impulse(&self, point: usize) -> f64 {
        self.impulse.get(point).copied().unwrap_or(0.0)
    }

    /// Work of that impulse, J.
    pub(super) fn work(&self, point: usize) -> f64 {
        self.work.get(point).copied().unwrap_or(0.0)
    }
}

/// Work that the points which close take in the step.
#[derive(Default)]
pub(super) struct Restoring {
    /// w of each point with an impulse, J.
    pub(super) works: Vec<f64>,
}

/// Squares of norms of the forces of a connected part, or of several, N².
#[derive(Clone, Copy, Default)]
pub(super) struct Squares {
    pub(super) imbalance: f64,
    /// Of contacts, loads, internal and inertia forces, links.
    pub(super) forces: [f64; 5],
    /// Of the momentum at the start of the step, per step.
    pub(super) momentum: f64,
    /// What rounding of places leaves of forces.
    pub(super) rounding: f64,
    /// What rounding of the unknowns leaves of inertia forces.
    pub(super) inertia_rounding: f64,
}

impl Squares {
    /// The sums of both.
    pub(super) fn with(mut self, other: &Squares) -> Squares {
        self.imbalance += other.imbalance;
        for (sum, force) in self.forces.iter_mut().zip(other.forces) {
            *sum += force;
        }
        self.momentum += other.momentum;
        self.rounding += other.rounding;
        self.inertia_rounding += other.inertia_rounding;
        self
    }

    /// Largest norm of the forces that balance, N.
    pub(super) fn largest(&self) -> f64 {
        self.forces.into_iter().fold(0.0, f64::max).sqrt()
    }

    /// The same, or of the momentum per step.
    pub(super) fn scale(&self) -> f64 {
        let momentum = self.momentum.sqrt();
        self.largest().max(momentum).max(f64::MIN_POSITIVE)
    }
}
