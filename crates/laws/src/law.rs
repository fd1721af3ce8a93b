//! What a contact law is asked, and what it answers.

use serde::{Deserialize, Serialize};

/// Status of a contact point in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// No force.
    #[default]
    Open,
    /// The relation of the law holds.
    Closed,
    /// Between the two: g₊ = 0 with the force that this takes. Only laws whose force jumps with the status need it.
    Corner,
    /// The relation of one piece, from 0, of a law that is linear in pieces.
    Piece(u16),
}

/// What is known of a point before the forces of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Local {
    /// Surface that the point stands for, m².
    pub area: f64,
    /// Share of the point in the surface of its contact: the shares add up to 1.
    pub share: f64,
    /// Gap at the captured instant, m.
    pub gap: f64,
    /// Gap rate at the start of the step, m/s.
    pub rate: f64,
    /// What the start of the step adds to ġ₊ in the way of the gap, m/s: over the step the gap changes by a positive multiple
    /// of ġ₊ + `start`. (1 - θ)/θ ġ with the theta scheme; zero where that way is no such sum.
    #[serde(default)]
    pub start: f64,
    /// Gap that the law looks at, without any contact force: at the end of the step, of a law with a compliance at the
    /// instant of the internal forces, m.
    pub gap_free: f64,
    /// Length of the step, s.
    pub dt: f64,
    /// Gap below which a point counts as closed, m.
    pub tolerance: f64,
    /// What a law with memory keeps of the point, m: the largest penetration so far.
    #[serde(default)]
    pub crush: f64,
    /// Gap (m) and gap rate (m/s) at which a law that is not linear gives its relation.
    #[serde(default)]
    pub at: [f64; 2],
}

impl Local {
    /// The same, with relations about this gap (m) and this rate (m/s).
    #[must_use]
    pub fn about(&self, gap: f64, rate: f64) -> Local {
        Local {
            at: [gap, rate],
            ..*self
        }
    }
}

/// Which quantity at the end of the step a law constrains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The gap.
    Gap,
    /// The gap rate.
    Rate,
    /// Both, through a compliance.
    GapAndRate,
}

/// State of a point at the end of a trial step.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// Gap without any force in this point, all other forces standing, in m.
    pub gap_released: f64,
    /// Gap g₊ in m.
    pub gap: f64,
    /// Gap rate ġ₊ in m/s.
    pub rate: f64,
    /// Force P in N, compressive positive.
    pub force: f64,
}

/// Coefficients of `gap g₊ + rate ġ₊ + compliance P + offset = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relation {
    /// Factor of the gap.
    pub gap: f64,
    /// Factor of the gap rate.
    pub rate: f64,
    /// Factor of the force.
    pub compliance: f64,
    /// What is left when gap, rate and force vanish.
    pub offset: f64,
}

impl Relation {
    /// g₊ = 0.
    pub const GAP: Relation = Relation {
        gap: 1.0,
        rate: 0.0,
        compliance: 0.0,
        offset: 0.0,
    };
    /// ġ₊ = 0.
    pub const RATE: Relation = Relation {
        gap: 0.0,
        rate: 1.0,
        compliance: 0.0,
        offset: 0.0,
    };
}

/// What a contact law must answer.
pub trait ContactLaw {
    /// Name as in the case file.
    fn name(&self) -> &'static str;
    /// Which end quantity it constrains.
    fn level(&self) -> Level;
    /// The instant at which the geometry is taken and closure is tested, as a fraction of the step ahead of the newest
    /// known configuration.
    fn capture(&self) -> f64;
    /// S_d: whether a point with this gap (m) at the captured instant takes part in the step, `tolerance` in m; `None`
    /// where only the end of the step can tell, so that every point within reach is asked.
    fn watches(&self, gap: f64, tolerance: f64) -> Option<bool>;
    /// The distance from the surface up to which a point that approaches is closed in the step, in ways of the approach over
    /// the step; a point as far as this less one was closed in the step before. `known`: the part of the step over which
    /// displacements are known before the forces, 1 of explicit schemes and 0 of the others. `None` of laws that no gap switches on.
    fn reach(&self, _known: f64) -> Option<f64> {
        None
    }
    /// Whether it looks at the gap without any contact force ([`Local::gap_free`]) by itself, not only at sums with what the forces add.
    fn needs_free_gap(&self) -> bool {
        false
    }
    /// What holds in a point of this status other than open. Only the offset may change from step to step: the factors
    /// belong to a matrix that is kept while the statuses stand. Of a law that is not linear it is the tangent about [`Local::at`].
    fn relation(&self, status: Status, local: &Local) -> Relation;
    /// The status that the end state asks for. `reversals`: how often the status of this point has turned within the
    /// step so far.
    fn status(&self, now: Status, end: &End, local: &Local, reversals: u32) -> Status;
    /// Whether the relation of each status is linear. That of a law that is not is renewed about the gap and the rate that it leads to,
    /// until these stand: Newton's method.
    fn is_linear(&self) -> bool {
        true
    }
    /// Penetration at which a contact holds this energy (J), m, of laws whose stiffness grows with it: explicit steps are bounded by
    /// the stiffness there.
    fn depth(&self, _energy: f64) -> f64 {
        0.0
    }
    /// Whether velocity and acceleration are projected when points of this law close.
    fn projects(&self) -> bool {
        false
    }
    /// Whether it is complementarity of the force and one quantity, for which there is a weak form with a multiplier.
    fn has_weak_form(&self) -> bool {
        false
    }
    /// Whether it gives the force of each point as a continuous function of gap and rate there, so that points may be as
    /// many as one likes. A damper beside a spring is none: its force jumps where the gap closes.
    fn is_function(&self) -> bool {
        false
    }
    /// Whether it is that of the contact as a whole, whose points share its force: the penetration then stands for what the bodies do not
    /// resolve.
    fn is_of_the_whole(&self) -> bool {
        false
    }
    /// The largest penetration of a point that has carried a force, in m, after a step that ended with the gap `gap` in
    /// m; `before`: the one before the step. Only laws with memory change it.
    fn crushed(&self, before: f64, _gap: f64) -> f64 {
        before
    }
    /// Energy that a contact all of whose points have this largest penetration (m) does not give back, J.
    fn crush_energy(&self, _crush: f64) -> f64 {
        0.0
    }
    /// What stays of this largest penetration (m) without a force, m.
    fn stays(&self, _crush: f64) -> f64 {
        0.0
    }
    /// Whether tensile forces are cut off once the statuses stand.
    fn clips(&self) -> bool;
}
