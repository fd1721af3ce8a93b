//! Contact laws: pure functions of the local state of one point.
//!
//! A law says (i) which points it watches, (ii) what holds at the end of the step in a point of given status,
//! `gap_factor g₊ + rate_factor ġ₊ + compliance P + offset = 0`, or P = 0 if open, and (iii) which status the end state
//! asks for. Where a law is no line, the relation is its tangent about the present gap and rate, and is renewed until these stand.
//! The sign fields are these decisions: S_g for a law in the gap, S_d and S_v for a law in the rate. With the status
//! and the tangents frozen all is linear; the interface problem repeats until no status changes.
//!
//! Signs: gap positive when open, gap rate positive when opening, force positive in compression.
//!
//! Friction laws ([`Friction`]) say what part of the normal force a point carries along the surface.
//!
//! Adding a law: one file, and its lines here.

/// The list of contact laws: each with what the case file says of it, and the type that it gives.
macro_rules! laws {
    ($declare:ident) => {
        $declare! {
            /// Exact non-penetration: 0 <= g, 0 <= p, p g = 0 at the end of each step.
            Displacement Displacement,
            /// A spring with a damper: p = k max(0, -g), minus C times the gap rate while the gap is closed.
            Damped GivenDamped,
            /// Exact impenetrability in velocity: where the gap is closed, 0 <= gap rate, 0 <= p, and p times the gap rate = 0 at the end of
            /// each step.
            Velocity GivenVelocity,
            /// A one-sided damper: where the gap is closed, p = C max(0, -gap rate) at the end of each step. It absorbs energy:
            /// 1 % of that of the striker if C is 100 times the impedance per area of two equal bars, or 400 times that of a
            /// bar on a rigid obstacle.
            Compliance GivenCompliance,
            /// Newton's restitution: where the gap is closed, the gap rate at the end of each step is at least -e times that at
            /// its start, and equal to it where there is a pressure. For bodies that are rigid at the time scale of the step.
            Restitution GivenRestitution,
            /// A given stiffness: p = k max(0, -g), minus C times the gap rate while the gap is closed.
            Penalty Penalty,
            /// A Hertz point, for the contact as a whole: force k times the penetration to the power 3/2, or another one.
            Hertz Hertz,
            /// The law of Hunt and Crossley, for the contact as a whole: that of a Hertz point times 1 + c times the rate of the
            /// penetration, which loses energy without a jump of the force.
            HuntCrossley GivenHuntCrossley,
            /// A stop of engineering structures, for the contact as a whole: a clearance, a curve of force over penetration, a
            /// dashpot.
            Stop GivenStop,
        }
    };
}

mod capture;
mod compliance;
mod curve;
mod damped;
mod defaults;
mod displacement;
mod friction;
mod hertz;
mod hunt_crossley;
mod law;
mod list;
mod penalty;
mod restitution;
mod stop;
mod velocity;

pub use capture::Capture;
pub use compliance::{Compliance, GivenCompliance};
pub use curve::{Curve, CurveError, MOST_CURVE_POINTS};
pub use damped::{Adhesion, Damped, GivenDamped};
pub use defaults::{Defaults, Side};
pub use displacement::Displacement;
pub use friction::*;
pub use hertz::Hertz;
pub use hunt_crossley::{GivenHuntCrossley, HuntCrossley};
pub use law::{ContactLaw, End, Level, Local, Relation, Status};
pub use list::{GivenLaw, Law};
pub use penalty::Penalty;
pub use restitution::{GivenRestitution, Restitution};
pub use stop::{Crush, CurvePoint, GivenStop, Stop};
pub use velocity::{GivenVelocity, Reading, Velocity};
