//! Forces and statuses of contact points: pure problems, numbers in and numbers out.
//!
//! [`interface`]: complementarity without friction. [`coulomb`]: with Coulomb friction. [`ContactSolver`]: one entry to both, for points that
//! [`ContactPoint`] describes. [`Weak`]: what the weak form of a law adds to the compliance. [`impulses_of_work`]: impulses that give back a work. [`Compliance`]: the matrix of the problem, or the sparse rows that it is a product of. No model, no state: the driver of `carom-dynamics` states the problems.

mod compliance;
mod contact_point;
mod contact_solver;
pub mod coulomb;
pub mod interface;
mod lumped;
mod point_forces;
mod tangents;
mod weak;
mod work;

pub use compliance::Compliance;
pub use contact_point::ContactPoint;
pub use contact_solver::{CandidateData, Candidates, Condensed, ContactSolver, Unsolved};
pub use lumped::{Lumped, Unknown};
pub use point_forces::PointForces;
pub use weak::Weak;
pub use work::impulses_of_work;
