//! Bodies that may act on each other, and the frame in which their energy is told.
//!
//! Kinetic energy depends on the frame of reference. A loss of energy relative to all of it vanishes where the model moves
//! sideways as a whole, or where a fast body flies far away. So energies are compared with those of the *assembly*: the
//! connected parts that contacts or links may join, in a frame that moves as the assembly does on the mean at the start. In
//! directions in which something outside holds the assembly (a support, an obstacle, a spring to the ground) the frame moves
//! as that does.

/// Connected parts that contacts or links may join.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assembly {
    /// Numbers of the connected parts, ascending.
    pub parts: Vec<usize>,
    /// Numbers of its contacts, ascending.
    pub contacts: Vec<usize>,
    /// Mass along each axis, kg: that of unknowns which are translations.
    pub mass: [f64; 3],
    /// Velocity of its frame V, m/s, constant.
    pub velocity: [f64; 3],
    /// The first assembly of those whose materials are told of together: springs of one name are in all of them, and have one energy. In general it is its own number.
    pub balanced_with: usize,
}

impl Assembly {
    /// Kinetic energy in its frame, J: K - V · p + ½ m V², of kinetic energy K (J) and momentum p (N s) in the frame of the model.
    pub fn kinetic(&self, kinetic: f64, momentum: &[f64; 3]) -> f64 {
        let own =
            |i: usize| self.velocity[i] * (0.5 * self.mass[i] * self.velocity[i] - momentum[i]);
        kinetic + own(0) + own(1) + own(2)
    }
}

/// All assemblies of a system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assemblies {
    /// The assemblies, in the order of their first parts.
    pub all: Vec<Assembly>,
    /// The assembly of each connected part.
    pub of_part: Vec<usize>,
}
