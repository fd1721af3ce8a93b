//! What the summary says of contacts, springs, dashpots, bolts and loads.

use serde::{Deserialize, Serialize};

use crate::statistics::Statistics;

/// What one contact did. Force: the sum of the normal forces over its points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Contact law with its parameters, as text: `velocity, capture = half`.
    pub law: String,
    /// Sum of the normal forces at the end of the static stage, with which the dynamics begins, N; absent without both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preload: Option<f64>,
    /// Largest force of a single step, N. It does not converge with the mesh where the exact force jumps: read
    /// `peak_mean_force` beside it.
    pub peak_force: f64,
    /// Largest magnitude of the force on the secondary body in a single step, friction included; `None` where there was none.
    #[serde(default)]
    pub peak_resultant: Option<PeakResultant>,
    /// Largest magnitude of the moment on the secondary body in a single step about the point that the case names; absent where it
    /// names none, or nothing touched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_moment: Option<PeakMoment>,
    /// Largest mean of the force over `window`, N; `None` of a static run, whose steps take no time, and without a window.
    pub peak_mean_force: Option<f64>,
    /// Length of that window, s: a tenth of the time in which a wave crosses the secondary body, whatever the step; zero of a body
    /// without waves.
    pub window: f64,
    /// `impulse` over the time spent closed, N; zero if never closed, `None` of a static run.
    pub mean_force: Option<f64>,
    /// Impulse over the dynamics, N s: what the momentum of the bodies changes by; `None` of a static run.
    pub impulse: Option<f64>,
    /// The part of it that is in no force, N s: impulses of a projection, or of another stage after a step. The rest is the
    /// sum of forces times step.
    pub impulsive: f64,
    /// Beginning of the first step with force, s.
    pub first_closing: Option<f64>,
    /// End of the last step with force, s; `None` if never closed or still closed.
    pub last_release: Option<f64>,
    /// Changes of status summed over the points.
    pub status_changes: u64,
    /// Changes of status to a closing of a point that is due: 2 where each point closes and opens once in an impact.
    pub chatter: f64,
    /// Largest penetration (minus the smallest gap), m, zero if never penetrated.
    pub max_penetration: f64,
    /// Persistency defect: Σ |P · gap rate| dt over the steps, J, with the rate that the law holds.
    pub persistency_defect: f64,
    /// Energy lost in crush, J; zero of laws without memory.
    pub energy_crushed: f64,
    /// Most nodes of the secondary surface in a step whose supports are partly closed: the pressure of the weak form
    /// depends on r there. `None` with another integration.
    pub mixed_supports: Option<u64>,
    /// Coulomb friction, where there is some.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<Friction>,
    /// Impacts, from the first closing to the last release before a flight that lasts, whose largest force is more than a hundredth of that of
    /// the contact.
    pub impacts: usize,
    /// Restitution of the last complete impact, from the momenta of the bodies before and after it; `None` where it means
    /// nothing ([`carom_dynamics::Impact::restitution`]), or links join further bodies to one of the two.
    pub restitution: Option<f64>,
    /// Why there is none, in a sentence without its beginning; `None` where there is one, or no impact.
    #[serde(default)]
    pub no_restitution: Option<String>,
    /// Statistics of the impacts; `None` without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub statistics: Option<Statistics>,
}

/// Largest force of a contact as a vector. Where normals differ it is less than the sum of the normal forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PeakResultant {
    /// Its magnitude, N.
    pub magnitude: f64,
    /// The force on the secondary body, N.
    pub force: [f64; 3],
    /// End of its step, s.
    pub time: f64,
}

/// Largest moment of a contact about a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PeakMoment {
    /// Its magnitude, N m.
    pub magnitude: f64,
    /// The moment on the secondary body, N m.
    pub moment: [f64; 3],
    /// The point that it is about, m.
    pub about: [f64; 3],
    /// End of its step, s.
    pub time: f64,
}

/// Largest force of the springs or dashpots of one name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Discrete {
    /// `spring` or `dashpot`.
    pub kind: String,
    /// Largest magnitude of the sum of their forces at the end of a step, N.
    pub peak_force: f64,
    /// When, s.
    pub time: f64,
    /// Largest magnitude of the mean elongation (m) of springs, of its rate (m/s) of dashpots.
    pub extent: f64,
}

/// Forces of a bolt that the static stage tightens, at the ends of the steps, positive in tension.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pretension {
    /// At the end of the static stage, N; `None` before it.
    pub end_of_stage: Option<f64>,
    /// Largest over the dynamics, N, and when, s; `None` without dynamics.
    pub largest: Option<[f64; 2]>,
    /// Smallest over the dynamics, N, and when, s.
    pub smallest: Option<[f64; 2]>,
    /// At the end of the run, N.
    pub last: Option<f64>,
    /// Part of the preload that is lost at the end of the run: 1 - `last`/`end_of_stage`.
    pub loss: Option<f64>,
}

/// Total force of a load on a surface or at nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Largest magnitude at the end of a step, N.
    pub peak_force: f64,
    /// The force then, N.
    pub force: [f64; 3],
    /// When, s.
    pub time: f64,
    /// Impulse over the dynamics, N s: of the forces at the ends of the steps, by the trapezoidal rule.
    pub impulse: [f64; 3],
}

/// Friction of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Friction {
    /// Its coefficient, of points that stick.
    pub coefficient: f64,
    /// That of points that slide fast, where it is another one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinetic: Option<f64>,
    /// Largest magnitude of the sum of the friction forces in a step, N.
    pub peak_force: f64,
    /// Energy that friction took, J: its work on what slides, a measure of wear.
    #[serde(default)]
    pub loss: f64,
}
