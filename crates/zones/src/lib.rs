//! Zones: groups of bodies with their own scheme and step, which meet in the multipliers of their links and in contacts between them (`cross_zone`).
//!
//! A link gives rows `Σ C v = 0` between velocities of zones at the same instant, and its multipliers L act as `Cᵀ L`. The
//! condensed problem of an outer step is `H ΔL = Σ C v`, with H the velocity that multipliers leave in the rows when
//! nothing touches: made and factored once. Contact makes the answer of a zone nonlinear; the passes over the step with the
//! same H end when the rows hold to rounding, in few passes where contacts are some elements away from the links.
//!
//! Sources: Gravouil, Combescure (2001); Prakash, Hjelmstad (2004); Ben Dhia et al. (2003), equations (11)-(12). The form
//! for any pair of schemes with weights of the multipliers in time is this project's.

mod control;
mod cross_zone;
mod discrete;
mod ending;
mod error;
mod iterated;
mod joined;
mod link_solver;
mod model;
mod moves;
mod origin;
mod passes;
mod places;
mod pointwise;
mod refusals;
mod response;
mod rows;
mod stage;
mod start;
mod step;
mod thin;
mod tie;
mod together;
mod turning;
mod whole;
mod zones;

pub use cross_zone::CrossZoneState;
pub use error::Error;
pub use model::{LinkKind, ModelZone, Zoned};
pub use thin::{Glued, glue_thin};
pub use tie::mortar_rows;
pub use whole::Whole;
pub use zones::{Sample, Zones, ZonesState};
