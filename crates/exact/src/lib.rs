//! Closed solutions of impact problems, against which the numerical schemes are judged.
//!
//! * [`solve`] gives the exact motion of elastic bars that hit a rigid wall or each other: piecewise-linear
//!   velocity waves, no time step, any number of bounces.
//! * [`beam`] has the frequencies and waves of uniform beams, [`beam_on_stop`] the fall of one on a stop.
//! * [`closed_forms`] holds the formulas of the discrete schemes that are known in closed form.
//! * [`friction`] holds motions under Coulomb friction that slide and stick.
//! * [`hertz`] is the contact of spheres and cylinders, at rest and in impact.
//! * [`mass_on_bar`] is a rigid mass that strikes an elastic bar.
//!
//! Nothing here is shared with the code that is judged: this crate depends on no other.

mod bar;
pub mod beam;
pub mod beam_on_stop;
pub mod closed_forms;
mod error;
pub mod friction;
pub mod hertz;
mod impact;
pub mod mass_on_bar;
mod motion;
mod wave;

pub use bar::{Bar, FarEnd, constrained_modulus};
pub use error::Error;
pub use impact::{Contact, Impact, Solution, solve};
pub use motion::Motion;
pub use wave::Wave;
