//! Time schemes as pure numbers: how a step depends on its unknown, and its energy balance. No state, no model.
//!
//! A scheme says its [`StepMap`]: every vector of a step as a combination of those at the start and of one unknown. A scheme of several
//! stages says one for each ([`TimeScheme::stages`]). The driver of `carom-dynamics` knows no scheme besides.
//!
//! Adding a scheme: one file, and its lines here.

/// The list of time schemes, each with what the case file says of it.
macro_rules! schemes {
    ($declare:ident) => {
        $declare! {
            /// Newmark's scheme in displacement.
            Newmark,
            /// The theta scheme in velocity (Moreau, Jean).
            Theta,
            /// Central difference, explicit; lumped mass.
            CentralDifference,
            /// The generalised-alpha scheme in displacement (Chung, Hulbert).
            GeneralisedAlpha,
            /// The scheme of Hilber, Hughes and Taylor in displacement.
            Hht,
            /// The dissipative scheme of Tchamwa and Wielgosz, explicit; lumped mass.
            TchamwaWielgosz,
            /// The two-step scheme of Paoli and Schatzman, with restitution; made for the displacement law.
            PaoliSchatzman,
            /// The mid-point rule with contact on the mean rate (Laursen, Chawla): exact energy, useless force; made for the
            /// velocity law.
            LaursenChawla,
            /// The mid-point rule with the displacement law and a velocity update that returns the work of the contact
            /// (Laursen, Love): exact energy, no penetration, useless force; displacement law only.
            LaursenLove,
            /// The generalised-alpha scheme for the smooth motion, with separate contact impulses (Chen, Acary, Virlez, Brüls);
            /// lumped mass, laws in the rate only: velocity, compliance, restitution.
            NonsmoothAlpha,
            /// A scheme in extended state space, with damping through filtered increments of displacement and velocity (after
            /// Krenk).
            Krenk,
            /// Newmark's scheme with implicit contact forces (Kane, Repetto, Ortiz, Marsden); lumped mass, displacement law only.
            Kane,
            /// The trapezoid with a predictor that is projected on the admissible displacements (contact-stabilised Newmark: Deuflhard,
            /// Krause, Ertel); displacement law only. Its energy never grows.
            ContactStabilised,
            /// The mid-point rule with an algorithmic stress whose work is the change of the stored energy (Simo, Tarnow; Gonzalez): energy
            /// and momenta to round-off in large transformations, for hyperelastic materials; made for the velocity law.
            EnergyMomentum,
            /// The composite scheme of Bathe: the trapezoidal rule over a part of the step, then the three-point backward formula over all of it.
            /// Damps what the step does not resolve, and little else.
            Bathe,
        }
    };
}

mod bathe;
mod central_difference;
mod contact_stabilised;
mod durations;
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

pub use bathe::Bathe;
pub use central_difference::CentralDifference;
pub use contact_stabilised::ContactStabilised;
pub use durations::Durations;
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
