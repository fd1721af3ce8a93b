//! Forces and statuses of contact points: pure problems, numbers in and numbers out.
//!
//! [`interface`]: complementarity without friction. [`coulomb`]: with Coulomb friction. [`Weak`]: what the weak form of a
//! law adds to the compliance. No model, no state: the driver of `carom-dynamics` states the problems.

pub mod coulomb;
pub mod interface;
mod weak;

pub use weak::Weak;
