//! `[time]`: how long, in which steps, by which scheme.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::quantity::Duration;

/// Duration, step and time scheme.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Time {
    /// Time at the end of the run; the run begins at 0.
    pub end: Duration,
    /// A static stage before the dynamics. The dynamics begin at its end, with the initial velocities of the bodies.
    /// Default: none.
    #[serde(rename = "static")]
    pub stage: Option<StaticStage>,
    /// Time step of the dynamics; required unless the whole case is static. With zones: the outer step; `courant` and
    /// `critical` then refer to the zones that take it.
    pub step: Option<Step>,
    /// Time scheme of the dynamics; required unless the whole case is static or every zone has its own. With zones: the scheme
    /// of every zone without its own.
    pub scheme: Option<Scheme>,
    /// Solution of nonlinear steps.
    #[serde(default)]
    pub newton: Newton,
}

impl Time {
    /// The time step; of a case that is all static, that of its stage.
    pub fn step(&self) -> Step {
        match (self.stage, self.step) {
            (Some(stage), _) if self.is_static() => {
                Step::Fixed(Duration(stage.end.0 / f64::from(stage.steps)))
            }
            (_, Some(step)) => step,
            (_, None) => Step::Fixed(self.end),
        }
    }

    /// The time scheme; of a case that is all static one that is never asked.
    pub fn scheme(&self) -> Scheme {
        self.scheme.unwrap_or(Scheme::Theta(Theta { theta: 0.5 }))
    }

    /// Whether the case ends with its static stage.
    pub fn is_static(&self) -> bool {
        self.stage.is_some_and(|stage| stage.end.0 == self.end.0)
    }
}

/// A static stage: the equilibrium of loads, supports and contacts, without inertia.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct StaticStage {
    /// Time at its end, at most the end of the case. A case that ends there needs no step and no scheme.
    pub end: Duration,
    /// Number of equal steps of the stage.
    #[schemars(extend("minimum" = 1))]
    pub steps: u32,
}

/// Solution of the equations of a nonlinear step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Newton {
    /// Residual of a converged step, relative to the largest of the balancing forces.
    #[serde(default = "tolerance")]
    #[schemars(extend("minimum" = 1e-14, "maximum" = 0.01))]
    pub tolerance: f64,
    /// Largest number of iterations; a step with more has failed.
    #[serde(default = "thirty")]
    #[schemars(extend("minimum" = 1))]
    pub passes: u32,
    /// Number of times that a failed step is halved before the run ends.
    #[serde(default = "six")]
    #[schemars(extend("minimum" = 0, "maximum" = 20))]
    pub halvings: u32,
}

impl Default for Newton {
    fn default() -> Newton {
        Newton {
            tolerance: tolerance(),
            passes: thirty(),
            halvings: six(),
        }
    }
}

/// The time step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Step {
    /// A fixed time step.
    Fixed(Duration),
    /// A time step from the mesh, or one that adapts itself.
    Rule(StepRule),
}

/// A time step from the mesh, or one that adapts itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StepRule {
    /// This fraction of the shortest time in which a wave crosses an element.
    Courant(#[schemars(extend("exclusiveMinimum" = 0.0))] f64),
    /// This fraction of the critical step of an explicit scheme, which comes from the eigenvalues of the elements.
    Critical(#[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))] f64),
    /// A step that is cut where a contact closes, and halved where energy grows or no solution is found.
    Adaptive(Adaptive),
}

/// A step that adapts itself to events. A step that fails is dropped as a whole and tried again with a smaller one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Adaptive {
    /// The largest step, and the first.
    pub largest: LargestStep,
    /// The smallest step. A failure at this size ends the run. Default: a thousandth of the largest step.
    pub smallest: Option<Duration>,
    /// Response to a point in flight that will close.
    #[serde(default)]
    pub closing: Closing,
    /// A step is halved if the energy that the scheme balances then exceeds its initial value plus the work of the
    /// loads by more than this fraction of the largest energy.
    #[serde(default = "hundredth")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub energy_growth: f64,
    /// Number of steps without a halving after which the step doubles. A point without a force for this number of
    /// largest steps is in flight; its next closing causes a cut.
    #[serde(default = "ten")]
    #[schemars(extend("minimum" = 1))]
    pub patience: u32,
}

/// The largest step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum LargestStep {
    /// A time.
    Fixed(Duration),
    /// From the mesh.
    FromMesh(MeshStep),
}

/// A time step from the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MeshStep {
    /// This fraction of the shortest time in which a wave crosses an element.
    Courant(#[schemars(extend("exclusiveMinimum" = 0.0))] f64),
    /// This fraction of the critical step of an explicit scheme, which comes from the eigenvalues of the elements.
    Critical(#[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))] f64),
}

/// What a contact that closes within a step does to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Closing {
    /// The step before the closing is cut, so that the closing falls at the best position in its step for the scheme
    /// and the law.
    #[default]
    Cut,
    /// Nothing.
    Pass,
}

/// A time scheme. Any contact law may be named with it; a pair that makes no sense is refused with the reason.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Newmark's scheme in displacement.
    Newmark(Newmark),
    /// The theta scheme in velocity (Moreau, Jean).
    Theta(Theta),
    /// Central difference, explicit; lumped mass.
    CentralDifference(CentralDifference),
    /// The generalised-alpha scheme in displacement (Chung, Hulbert).
    GeneralisedAlpha(GeneralisedAlpha),
    /// The scheme of Hilber, Hughes and Taylor in displacement.
    Hht(Hht),
    /// The dissipative scheme of Tchamwa and Wielgosz, explicit; lumped mass.
    TchamwaWielgosz(TchamwaWielgosz),
    /// The two-step scheme of Paoli and Schatzman, with restitution; made for the displacement law.
    PaoliSchatzman(PaoliSchatzman),
    /// The mid-point rule with contact on the mean rate (Laursen, Chawla): exact energy, useless force; made for the
    /// velocity law.
    LaursenChawla(LaursenChawla),
    /// The mid-point rule with the displacement law and a velocity update that returns the work of the contact
    /// (Laursen, Love): exact energy, no penetration, useless force; displacement law only.
    LaursenLove(LaursenLove),
    /// The generalised-alpha scheme for the smooth motion, with separate contact impulses (Chen, Acary, Virlez, Brüls);
    /// lumped mass, laws in the rate only: velocity, compliance, restitution.
    NonsmoothAlpha(NonsmoothAlpha),
    /// A scheme in extended state space, with damping through filtered increments of displacement and velocity (after
    /// Krenk).
    Krenk(Krenk),
    /// Newmark's scheme with implicit contact forces (Kane, Repetto, Ortiz, Marsden); lumped mass, displacement law only.
    Kane(Kane),
    /// The trapezoid with a predictor that is projected on the admissible displacements (contact-stabilised Newmark: Deuflhard,
    /// Krause, Ertel); displacement law only. Its energy never grows.
    ContactStabilised(ContactStabilised),
    /// The mid-point rule with an algorithmic stress whose work is the change of the stored energy (Simo, Tarnow; Gonzalez): energy
    /// and momenta to round-off in large transformations, for hyperelastic materials; made for the velocity law.
    EnergyMomentum(EnergyMomentum),
}

/// Newmark's scheme.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Newmark {
    /// Weight of the end acceleration in the displacement.
    #[serde(default = "quarter")]
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))]
    pub beta: f64,
    /// Weight of the end acceleration in the velocity. Stable at any step for gamma >= 1/2 and 2 beta >= gamma.
    #[serde(default = "half")]
    #[schemars(extend("minimum" = 0.5, "maximum" = 1.0))]
    pub gamma: f64,
}

/// The theta scheme.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Theta {
    /// Weight of the end of the step: 1/2 conserves energy, 1 damps most.
    #[serde(default = "half")]
    #[schemars(extend("minimum" = 0.5, "maximum" = 1.0))]
    pub theta: f64,
}

/// Central difference: nothing to give.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CentralDifference {}

/// The generalised-alpha scheme.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct GeneralisedAlpha {
    /// Spectral radius at infinite frequency: 1 damps nothing, 0 most.
    #[serde(default = "four_fifths")]
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub rho_inf: f64,
}

/// The scheme of Hilber, Hughes and Taylor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Hht {
    /// Internal forces are evaluated at (1 + alpha) u+ - alpha u: 0 damps nothing, -1/3 most. Some authors define alpha
    /// with the opposite sign.
    #[serde(default = "minus_tenth")]
    #[schemars(extend("minimum" = -1.0 / 3.0, "maximum" = 0.0))]
    pub alpha: f64,
}

/// The scheme of Tchamwa and Wielgosz.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TchamwaWielgosz {
    /// Factor of dt² a in the displacement: 1 damps nothing; the damping ratio is (phi - 1) omega dt / 2, and the critical
    /// step 2 / (omega sqrt(2 phi - 1)).
    #[serde(default = "usual_phi")]
    #[schemars(extend("minimum" = 1.0, "maximum" = 2.0))]
    pub phi: f64,
}

/// The scheme of Paoli and Schatzman.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PaoliSchatzman {
    /// Restitution e of bodies that are rigid during a step; the displacement law applies to (u+ + e u-)/(1 + e). A
    /// value above 0 requires the displacement law.
    #[serde(default)]
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub restitution: f64,
}

/// The scheme of Laursen and Chawla: nothing to give.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct LaursenChawla {}

/// The scheme of Laursen and Love: nothing to give.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct LaursenLove {}

/// The nonsmooth generalised-alpha scheme.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct NonsmoothAlpha {
    /// Spectral radius at infinite frequency of the smooth motion: 1 damps nothing, 0 most.
    #[serde(default = "four_fifths")]
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub rho_inf: f64,
}

/// The scheme in extended state space after Krenk.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Krenk {
    /// Spectral radius at infinite frequency: 1 damps nothing, 0 most.
    #[serde(default = "four_fifths")]
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub rho_inf: f64,
}

/// The scheme of Kane, Repetto, Ortiz and Marsden.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Kane {
    /// Weight of the end acceleration in the displacement, as in Newmark's scheme.
    #[serde(default = "quarter")]
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))]
    pub beta: f64,
    /// Weight of the end acceleration in the velocity, as in Newmark's scheme.
    #[serde(default = "half")]
    #[schemars(extend("minimum" = 0.5, "maximum" = 1.0))]
    pub gamma: f64,
}

/// The contact-stabilised Newmark scheme: nothing to give.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ContactStabilised {}

/// The energy-momentum scheme: nothing to give.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct EnergyMomentum {}

fn tolerance() -> f64 {
    1e-10
}

fn thirty() -> u32 {
    30
}

fn six() -> u32 {
    6
}

fn hundredth() -> f64 {
    0.01
}

fn ten() -> u32 {
    10
}

fn quarter() -> f64 {
    0.25
}

fn half() -> f64 {
    0.5
}

fn four_fifths() -> f64 {
    0.8
}

fn minus_tenth() -> f64 {
    -0.1
}

fn usual_phi() -> f64 {
    1.033
}
