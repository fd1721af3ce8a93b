//! The list of time schemes.

use serde::{Deserialize, Serialize};

use crate::{
    CentralDifference, ContactStabilised, EnergyMomentum, GeneralisedAlpha, Hht, Kane, Krenk,
    LaursenChawla, LaursenLove, Newmark, NonsmoothAlpha, PaoliSchatzman, TchamwaWielgosz, Theta,
    TimeScheme,
};

/// A time scheme, as chosen in the case file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Scheme {
    /// Newmark's family.
    Newmark(Newmark),
    /// The theta scheme in velocities.
    Theta(Theta),
    /// Central differences.
    CentralDifference(CentralDifference),
    /// Generalised-alpha.
    GeneralisedAlpha(GeneralisedAlpha),
    /// Hilber, Hughes, Taylor.
    Hht(Hht),
    /// Explicit and dissipative, Tchamwa and Wielgosz.
    TchamwaWielgosz(TchamwaWielgosz),
    /// Two-step, Paoli and Schatzman.
    PaoliSchatzman(PaoliSchatzman),
    /// Mid-point rule with contact on the mean rate, Laursen and Chawla.
    LaursenChawla(LaursenChawla),
    /// Mid-point rule with the displacement law and a velocity that gets the energy back, Laursen and Love.
    LaursenLove(LaursenLove),
    /// Generalised-alpha with impulses apart, Chen, Acary, Virlez and Brüls.
    NonsmoothAlpha(NonsmoothAlpha),
    /// Extended state space with filtered velocity and acceleration, Krenk.
    Krenk(Krenk),
    /// Newmark with implicit contact forces, Kane, Repetto, Ortiz and Marsden.
    Kane(Kane),
    /// Trapezoid with a projected predictor, Deuflhard, Krause and Ertel.
    ContactStabilised(ContactStabilised),
    /// Discrete gradient, for large transformations, Simo and Tarnow, Gonzalez.
    EnergyMomentum(EnergyMomentum),
}

impl Scheme {
    /// The scheme behind the choice.
    pub fn get(&self) -> &dyn TimeScheme {
        match self {
            Scheme::Newmark(scheme) => scheme,
            Scheme::Theta(scheme) => scheme,
            Scheme::CentralDifference(scheme) => scheme,
            Scheme::GeneralisedAlpha(scheme) => scheme,
            Scheme::Hht(scheme) => scheme,
            Scheme::TchamwaWielgosz(scheme) => scheme,
            Scheme::PaoliSchatzman(scheme) => scheme,
            Scheme::LaursenChawla(scheme) => scheme,
            Scheme::LaursenLove(scheme) => scheme,
            Scheme::NonsmoothAlpha(scheme) => scheme,
            Scheme::Krenk(scheme) => scheme,
            Scheme::Kane(scheme) => scheme,
            Scheme::ContactStabilised(scheme) => scheme,
            Scheme::EnergyMomentum(scheme) => scheme,
        }
    }

    /// Weights of the multipliers of links at the start and the end of a step in the force that the momentum balance sees;
    /// `None` of schemes that no link takes.
    pub fn link_weights(&self) -> Option<[f64; 2]> {
        match self {
            Scheme::Theta(Theta { theta }) => Some([1.0 - theta, *theta]),
            Scheme::EnergyMomentum(_) => Some([0.5, 0.5]),
            Scheme::Newmark(_) | Scheme::CentralDifference(_) => Some([0.0, 1.0]),
            _ => None,
        }
    }

    /// One of each that the linear driver takes, with usual parameters: what the batteries run over.
    pub fn registered() -> Vec<Scheme> {
        vec![
            Scheme::Newmark(Newmark {
                beta: 0.25,
                gamma: 0.5,
            }),
            Scheme::Newmark(Newmark {
                beta: 0.49,
                gamma: 0.9,
            }),
            Scheme::Theta(Theta { theta: 0.5 }),
            Scheme::Theta(Theta { theta: 0.75 }),
            Scheme::CentralDifference(CentralDifference),
            Scheme::GeneralisedAlpha(GeneralisedAlpha { rho_inf: 0.8 }),
            Scheme::Hht(Hht { alpha: -0.1 }),
            Scheme::TchamwaWielgosz(TchamwaWielgosz { phi: 1.033 }),
            Scheme::PaoliSchatzman(PaoliSchatzman { restitution: 0.0 }),
            Scheme::PaoliSchatzman(PaoliSchatzman { restitution: 0.5 }),
            Scheme::LaursenChawla(LaursenChawla),
            Scheme::LaursenLove(LaursenLove),
            Scheme::NonsmoothAlpha(NonsmoothAlpha { rho_inf: 0.8 }),
            Scheme::Krenk(Krenk { rho_inf: 0.8 }),
            Scheme::Kane(Kane {
                beta: 0.25,
                gamma: 0.5,
            }),
            Scheme::ContactStabilised(ContactStabilised),
        ]
    }
}
