//! What the interface problem knows of one contact point.

use carom_laws::{Displacement, Law, Local, Status};
use serde::{Deserialize, Serialize};

/// A candidate before the solve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Its law.
    pub law: Law,
    /// What is known of it before the forces; holds g_f.
    pub local: Local,
    /// ġ_f, m/s.
    pub rate_free: f64,
    /// Status at the end of the last step.
    pub status: Status,
    /// Whether its surface faces itself, so that other points may say the same as it does.
    pub faces_itself: bool,
    /// Factors of D P in gap and rate of this candidate over those of the problem: those of the instant at which its law
    /// holds, `StepMap::compliant` of a scheme.
    #[serde(default = "whole")]
    pub instant: [f64; 2],
}

/// Factors of a law at the end of the step.
fn whole() -> [f64; 2] {
    [1.0; 2]
}

impl Candidate {
    /// A point of `0 ≤ g_f + D P ⟂ P ≥ 0`, open at the start of the solve. `gap_free`: g_f.
    #[must_use]
    pub fn unilateral(gap_free: f64) -> Candidate {
        Candidate {
            law: Law::Displacement(Displacement::default()),
            local: Local {
                gap_free,
                ..Local::default()
            },
            rate_free: 0.0,
            status: Status::Open,
            faces_itself: false,
            instant: whole(),
        }
    }

    /// A point of `0 ≤ q + D ΔI ⟂ I + ΔI ≥ 0`, whose force in the solution is I + ΔI. `q`: infinite where I + ΔI must vanish;
    /// `row`: that of D; `present`: I of all points.
    #[must_use]
    pub fn beside(q: f64, row: &[f64], present: &[f64]) -> Candidate {
        let of_present: f64 = row.iter().zip(present).map(|(d, i)| d * i).sum();
        Candidate {
            status: match q.is_finite() {
                true => Status::Closed,
                false => Status::Open,
            },
            ..Candidate::unilateral(q - of_present)
        }
    }

    /// Factors of D P in its gap and rate; `s`: those of the problem.
    pub(crate) fn factors(&self, s: [f64; 2]) -> [f64; 2] {
        [self.instant[0] * s[0], self.instant[1] * s[1]]
    }
}
