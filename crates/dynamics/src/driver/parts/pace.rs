//! How the iterations of a step go, and the sizes of their forces.

/// How fast the iterations go.
#[derive(Default)]
pub(crate) struct Pace {
    /// Iterations of this attempt with the factor at hand.
    pub(crate) age: usize,
    /// The iteration in which it was made.
    pub(crate) made: usize,
    /// Contraction with a factor made within the iterations of a step, between two states; zero while unknown.
    pub(crate) fresh: f64,
    /// Whether the scales of the forces have the motion at the start of the attempt, and the matrix at hand.
    pub(crate) is_sized: bool,
}

impl Pace {
    /// Begins with a factor that is made in iteration `made`, and has been used in `age` of them.
    pub(crate) fn begin(&mut self, age: usize, made: usize) {
        (self.age, self.made) = (age, made);
    }
}

/// Squares of norms of the forces of a connected part, or of several, N².
#[derive(Clone, Copy, Default)]
pub(crate) struct Squares {
    pub(crate) imbalance: f64,
    /// Of contacts, loads, internal and inertia forces, links.
    pub(crate) forces: [f64; 5],
    /// Of the momentum at the start of the step, per step.
    pub(crate) momentum: f64,
    /// What rounding of places leaves of forces.
    pub(crate) rounding: f64,
    /// What rounding of the unknowns leaves of inertia forces.
    pub(crate) inertia_rounding: f64,
}

impl Squares {
    /// The sums of both.
    pub(crate) fn with(mut self, other: &Squares) -> Squares {
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
    pub(crate) fn largest(&self) -> f64 {
        self.forces.into_iter().fold(0.0, f64::max).sqrt()
    }

    /// The same, or of the momentum per step.
    pub(crate) fn scale(&self) -> f64 {
        let momentum = self.momentum.sqrt();
        self.largest().max(momentum).max(f64::MIN_POSITIVE)
    }
}
