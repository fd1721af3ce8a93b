//! `[time]`: how long, in which steps, by which scheme.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::Duration;
use carom_schemes::{Scheme, Theta};

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
    /// Solution of steps that need iterations.
    #[serde(default)]
    pub newton: Newton,
    /// Solution of the linear equations of implicit steps.
    #[serde(default)]
    pub solver: Solver,
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
        self.scheme.unwrap_or(Scheme::Theta(Theta::default()))
    }

    /// Whether the case ends with its static stage.
    pub fn is_static(&self) -> bool {
        self.stage.is_some_and(|stage| stage.end.0 == self.end.0)
    }
}

/// Solution of the linear equations of implicit steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Solver {
    /// As predicted to cost less, from counts of operations and of bytes.
    #[default]
    Auto,
    /// A sparse factor: computed once where the matrix stays the same.
    Direct,
    /// Conjugate gradients, without a factor: forces of contacts and motion are found together, friction too. Not with links, zones or a
    /// static stage.
    Iterative,
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

/// Solution of the equations of a step that needs iterations.
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
    /// Number of times that a failed step is halved before the run ends. With 0 steps stay whole, also those in which bodies pass through each other.
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
    /// This fraction of the critical step of an explicit scheme, which comes from the eigenvalues of the elements. At finite strain
    /// steps become shorter as elements deform, so that they stay this fraction of it.
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
    /// A step is halved if the energy that the scheme balances then exceeds its initial value plus the work of
    /// loads, supports and moving obstacles by more than this fraction of the largest energy.
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
