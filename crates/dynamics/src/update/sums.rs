//! The sums of which the balances of an explicit step consist.

use crate::resultant::Resultant;

/// Sums over nodes in a step from `u` to u₊ on the way Δu = u₊ - u.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// |v₊|²_M.
    pub(crate) velocity: f64,
    /// |a|²_M at start and end.
    pub(crate) acceleration: [f64; 2],
    /// Works on Δu of the means of the forces: inertia, internal forces, loads, contacts, damping; J.
    pub(crate) works: [f64; 5],
    /// |Δu|².
    pub(crate) way: f64,
    /// Squares of the forces of the end, in the order of the works without damping, and of the momentum M v at the start.
    pub(crate) squares: [f64; 5],
    /// M v₊.
    pub(crate) momentum: Resultant,
    /// Means of loads, contact forces, reactions of the supports, and damping.
    pub(crate) forces: [Resultant; 4],
    /// Sums of the forces of the end: loads less damping with the reactions to all but contacts, and the reactions to contacts.
    pub(crate) outside: [[f64; 3]; 2],
    /// Largest |v₊ - w|² of a node.
    pub(crate) fastest: f64,
}

impl Sums {
    /// Adds those of other nodes.
    pub(crate) fn add(&mut self, other: &Sums) {
        self.velocity += other.velocity;
        self.way += other.way;
        let pairs = self.acceleration.iter_mut().zip(other.acceleration);
        let pairs = pairs.chain(self.works.iter_mut().zip(other.works));
        let pairs = pairs.chain(self.squares.iter_mut().zip(other.squares));
        for (sum, term) in pairs {
            *sum += term;
        }
        self.momentum = self.momentum.plus(&other.momentum);
        for (sum, term) in self.forces.iter_mut().zip(&other.forces) {
            *sum = sum.plus(term);
        }
        let outside = self.outside.iter_mut().flatten();
        for (sum, term) in outside.zip(other.outside.iter().flatten()) {
            *sum += term;
        }
        self.fastest = self.fastest.max(other.fastest);
    }

    /// All sums but the largest.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> {
        let mut all = *self;
        let mut numbers = [0.0; 50];
        let mut out = numbers.iter_mut();
        all.each(&mut |number| {
            if let Some(out) = out.next() {
                *out = *number;
            }
        });
        numbers.into_iter()
    }

    /// Replaces all sums but the largest, in the order of [`Sums::numbers`].
    pub(crate) fn take(&mut self, next: &mut impl FnMut() -> f64) {
        self.each(&mut |number| *number = next());
    }

    fn each(&mut self, visit: &mut impl FnMut(&mut f64)) {
        let Sums {
            velocity,
            acceleration,
            works,
            way,
            squares,
            momentum,
            forces,
            outside,
            fastest: _,
        } = self;
        visit(velocity);
        visit(way);
        let lists = acceleration.iter_mut().chain(works).chain(squares);
        lists.for_each(&mut *visit);
        for resultant in forces.iter_mut().chain([momentum]) {
            let entries = resultant.linear.iter_mut().chain(&mut resultant.angular);
            entries.for_each(&mut *visit);
        }
        outside.iter_mut().flatten().for_each(visit);
    }

    /// Leaves out what is no force in an axisymmetric system.
    pub(crate) fn of_axisymmetric(&mut self) {
        let resultants = self.forces.iter_mut().chain([&mut self.momentum]);
        for resultant in resultants {
            resultant.linear[0] = 0.0;
            resultant.angular = [0.0; 3];
        }
    }
}
