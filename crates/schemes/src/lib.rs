//! Time schemes as pure numbers: how a step depends on its unknown, and its energy balance. No state, no model.
//!
//! A scheme says its [`StepMap`]: every vector of a step as a combination of those at the start and of one unknown. The
//! driver of `carom-dynamics` knows no scheme besides.
//!
//! Adding a scheme: one file here and its lines in `list.rs`.

mod central_difference;
mod contact_stabilised;
mod energy_momentum;
mod generalised_alpha;
mod hht;
mod kane;
mod krenk;
mod laursen_chawla;
mod laursen_love;
mod list;
mod newmark;
mod nonsmooth_alpha;
mod paoli_schatzman;
mod scheme;
pub mod step_map;
mod tchamwa_wielgosz;
mod theta;

pub use central_difference::CentralDifference;
pub use contact_stabilised::ContactStabilised;
pub use energy_momentum::EnergyMomentum;
pub use generalised_alpha::GeneralisedAlpha;
pub use hht::Hht;
pub use kane::Kane;
pub use krenk::Krenk;
pub use laursen_chawla::LaursenChawla;
pub use laursen_love::LaursenLove;
pub use list::Scheme;
pub use newmark::Newmark;
pub use nonsmooth_alpha::NonsmoothAlpha;
pub use paoli_schatzman::PaoliSchatzman;
pub use scheme::{EnergyIdentity, TimeScheme};
pub use step_map::{Impulse, Known, Row, StepMap};
pub use tchamwa_wielgosz::TchamwaWielgosz;
pub use theta::Theta;
