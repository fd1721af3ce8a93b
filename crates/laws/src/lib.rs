//! Contact laws: pure functions of the local state of one point.
//!
//! A law says (i) which points it watches, (ii) what holds at the end of the step in a point of given status,
//! `gap_factor g₊ + rate_factor ġ₊ + compliance P + offset = 0`, or P = 0 if open, and (iii) which status the end state
//! asks for.
//! The sign fields are these decisions: S_g for a law in the gap, S_d and S_v for a law in the rate. With the status
//! frozen all is linear; the interface problem repeats until no status changes.
//!
//! Signs: gap positive when open, gap rate positive when opening, force positive in compression.
//!
//! Adding a law: one file here and its lines in `list.rs`.

mod capture;
mod compliance;
mod curve;
mod damped;
mod displacement;
mod law;
mod list;
mod penalty;
mod restitution;
mod stop;
mod velocity;

pub use capture::Capture;
pub use compliance::Compliance;
pub use curve::{Curve, CurveError, MOST_CURVE_POINTS};
pub use damped::{Adhesion, Damped};
pub use displacement::Displacement;
pub use law::{ContactLaw, End, Level, Local, Relation, Status};
pub use list::Law;
pub use penalty::Penalty;
pub use restitution::Restitution;
pub use stop::{Crush, Stop};
pub use velocity::{Reading, Velocity};
