//! What a system that nothing outside touches keeps: linear momentum, angular momentum, energy.

use carom_dynamics::{Balance, Resultant, State, System};

/// How far the conserved quantities went from their start, at most so far.
pub(crate) struct Kept {
    start: Balance,
    /// Centre of mass at the start, m: angular momentum is taken about this place.
    centre: [f64; 3],
    /// Sizes that the changes are divided by: those of the momentum in N s and of the angular momentum in N m s.
    scale: [f64; 2],
    /// Largest change of the linear momentum, relative.
    pub(crate) linear: f64,
    /// Largest change of the angular momentum, relative.
    pub(crate) angular: f64,
    /// Largest change of the energy in either direction, relative to that at the start.
    pub(crate) energy: f64,
}

impl Kept {
    /// Begins at a state.
    pub(crate) fn new(system: &System, state: &State) -> Kept {
        let start = state.ledger.balance;
        let mut mass = 0.0;
        let mut centre = [0.0; 3];
        for &(node, m) in system.body_masses.iter().flatten() {
            mass += m;
            for i in 0..system.dim {
                let at = system.unknowns.first(node) + i;
                centre[i] += m * (system.x[node as usize][i] + state.motion.u[at]);
            }
        }
        let centre = [0, 1, 2].map(|i| centre[i] / mass - system.about[i]);
        let linear = size(start.momentum.linear);
        let angular = size(about(&start.momentum, centre));
        Kept {
            start,
            centre,
            scale: [linear, angular],
            linear: 0.0,
            angular: 0.0,
            energy: 0.0,
        }
    }

    /// Measures the changes of the linear momentum by `momentum` in N s: for systems whose centre rests.
    pub(crate) fn scaled_by(mut self, momentum: f64) -> Kept {
        self.scale[0] = momentum;
        self
    }

    /// Looks at a later state.
    pub(crate) fn follow(&mut self, state: &State) {
        let now = &state.ledger.balance;
        let change = |one: [f64; 3], other: [f64; 3]| size([0, 1, 2].map(|i| one[i] - other[i]));
        let linear = change(now.momentum.linear, self.start.momentum.linear) / self.scale[0];
        let [one, other] = [&now.momentum, &self.start.momentum].map(|p| about(p, self.centre));
        let angular = change(one, other) / self.scale[1];
        let energy = (now.energy() / self.start.energy() - 1.0).abs();
        self.linear = self.linear.max(linear);
        self.angular = self.angular.max(angular);
        self.energy = self.energy.max(energy);
    }
}

fn size(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Angular momentum about a place at rest: L - c × p, with `centre` from the point that L is about.
fn about(momentum: &Resultant, centre: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let p = &momentum.linear;
        momentum.angular[i] - (centre[j] * p[k] - centre[k] * p[j])
    })
}
