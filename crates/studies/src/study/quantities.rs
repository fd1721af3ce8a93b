//! The quantities of a study, each once.

use crate::compare::Done;
use crate::study::Run;

/// A quantity whose convergence is studied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// ∫ F dt over the run.
    Impulse,
    /// Impulse over the time spent closed.
    MeanForce,
    /// Largest mean of the force over the window of the summary.
    PeakMeanForce,
    /// Largest force of a single step.
    PeakForce,
    /// Relative L² error of the force against the exact one.
    ForceError,
    /// Relative L² error of the displacements of the contact points against the exact ones.
    DisplacementError,
    /// Restitution from the mean velocities, so that of the end velocity too.
    Restitution,
    /// Energy that the bodies gain without work of the loads, relative to the energy at the start.
    EnergyChange,
}

/// A value, and what it should be where that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// The value, SI.
    pub value: f64,
    /// The exact value.
    pub exact: Option<f64>,
}

impl Measure {
    /// Distance from the exact value: relative, unless that is zero.
    pub fn error(&self) -> Option<f64> {
        self.exact.map(|exact| {
            let distance = (self.value - exact).abs();
            if exact == 0.0 {
                distance
            } else {
                distance / exact.abs()
            }
        })
    }
}

impl Quantity {
    /// All of them, in the order of the tables.
    pub const ALL: [Quantity; 8] = [
        Quantity::Impulse,
        Quantity::MeanForce,
        Quantity::PeakMeanForce,
        Quantity::PeakForce,
        Quantity::ForceError,
        Quantity::DisplacementError,
        Quantity::Restitution,
        Quantity::EnergyChange,
    ];

    /// Name for people.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Impulse => "impulse",
            Quantity::MeanForce => "mean force",
            Quantity::PeakMeanForce => "peak of the mean force",
            Quantity::PeakForce => "raw peak force",
            Quantity::ForceError => "force, L² error",
            Quantity::DisplacementError => "displacement, L² error",
            Quantity::Restitution => "restitution",
            Quantity::EnergyChange => "energy change",
        }
    }

    /// Name of its column in a CSV file, with the unit.
    pub fn column(self) -> &'static str {
        match self {
            Quantity::Impulse => "impulse_n_s",
            Quantity::MeanForce => "mean_force_n",
            Quantity::PeakMeanForce => "peak_mean_force_n",
            Quantity::PeakForce => "peak_force_n",
            Quantity::ForceError => "force_error",
            Quantity::DisplacementError => "displacement_error",
            Quantity::Restitution => "restitution",
            Quantity::EnergyChange => "energy_change",
        }
    }

    /// Its unit; empty for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Impulse => "N s",
            Quantity::MeanForce | Quantity::PeakMeanForce | Quantity::PeakForce => "N",
            Quantity::ForceError
            | Quantity::DisplacementError
            | Quantity::Restitution
            | Quantity::EnergyChange => "",
        }
    }

    /// Whether it is a distance from an exact solution, which goes to zero.
    pub fn is_error(self) -> bool {
        matches!(self, Quantity::ForceError | Quantity::DisplacementError)
    }

    /// What it is in a run; `None` where it does not exist.
    pub fn of(self, run: &Run) -> Option<Measure> {
        let done = run.variant.done()?;
        let exact = done.summary.exact.as_ref();
        let (value, exact) = match self {
            Quantity::Impulse => (done.contact()?.impulse?, exact.map(|e| e.impulse)),
            Quantity::MeanForce => (done.contact()?.mean_force?, run.exact_mean_force),
            Quantity::PeakMeanForce => (
                done.contact()?.peak_mean_force?,
                exact.map(|e| e.peak_force),
            ),
            Quantity::PeakForce => (done.contact()?.peak_force, exact.map(|e| e.peak_force)),
            Quantity::ForceError => (exact?.force_error?, Some(0.0)),
            Quantity::DisplacementError => (exact?.displacement_error?, Some(0.0)),
            Quantity::Restitution => match exact {
                Some(exact) => (exact.restitution?, exact.exact_restitution),
                None => (done.contact()?.restitution?, None),
            },
            Quantity::EnergyChange => {
                let energy = &done.summary.energy;
                let start = energy.kinetic_initial + energy.strain_initial;
                let loads = energy.works.get("loads").copied().unwrap_or(0.0);
                let gain = energy.kinetic_final + energy.strain_final - start - loads;
                if start <= 0.0 {
                    return None;
                }
                // elastic bars keep their energy
                (gain / start, exact.map(|_| 0.0))
            }
        };
        value.is_finite().then_some(Measure { value, exact })
    }

    /// Why a run that was computed has no value.
    pub(crate) fn reason(self, done: &Done) -> String {
        let Some(contact) = done.contact() else {
            return match self {
                Quantity::EnergyChange => "no energy at the start".to_owned(),
                _ => "no contact".to_owned(),
            };
        };
        let reason = match self {
            Quantity::EnergyChange => "no energy at the start",
            Quantity::ForceError | Quantity::DisplacementError => match &done.summary.exact {
                None => "no exact solution",
                Some(_) => "the exact solution is zero over the run",
            },
            Quantity::Restitution => {
                let told = contact.no_restitution.clone();
                return told.unwrap_or_else(|| match contact.first_closing {
                    None => "no impact".to_owned(),
                    Some(_) => "no complete impact".to_owned(),
                });
            }
            _ => "static steps take no time",
        };
        reason.to_owned()
    }
}
