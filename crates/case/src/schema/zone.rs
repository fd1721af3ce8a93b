//! `[zone]`, `[arlequin]` and `[interface]`: parts of the model with their own scheme and step, and what joins them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Named;
use carom_quantities::{Coordinate, Length, Vector};
use carom_schemes::Scheme;

/// A zone: bodies with their own scheme and step. If a case has zones, every body is in one of them. The two sides of a
/// contact may be in different ones, also with unequal steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Zone {
    /// Names of its bodies.
    #[schemars(extend("minItems" = 1, "uniqueItems" = true))]
    pub bodies: Vec<String>,
    /// Time scheme of the zone. Default: `time.scheme`. Zones that are joined and have unequal steps use any but
    /// tchamwa-wielgosz.
    pub scheme: Option<Scheme>,
    /// Number of inner steps of this zone per outer step, which is `time.step`; or, in the outer zone, the numbers of
    /// other zones by name: `{ impact = 4 }`, or `{ impact = { near = 400, far = 1 } }` for fewer inner steps while
    /// nothing can touch. Default: 1. At least one zone takes the outer step; all others take the same number of inner
    /// steps.
    pub substeps: Option<Substeps>,
}

/// Inner steps to one outer step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Substeps {
    /// Of the zone itself.
    Own(StepCount),
    /// Of other zones, by name.
    Of(Named<InnerSteps>),
}

/// Inner steps of a zone to one outer step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum InnerSteps {
    /// Always as many.
    Always(StepCount),
    /// As many as contact asks for.
    Choice(StepChoice),
}

/// Inner steps where contact asks for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct StepChoice {
    /// In outer steps in which a contact is closed or may close.
    pub near: StepCount,
    /// In the others.
    pub far: StepCount,
}

/// A number of inner steps, from 1 to 1000.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline, extend("minimum" = 1, "maximum" = 1000))]
pub struct StepCount(pub u32);

/// An overlap of two bodies, which represent the same material there and are glued in volume (Arlequin method). The two
/// bodies have their own meshes and are in different zones. Contact surfaces lie outside of the overlap. One of the two may be a body of beams
/// and the other a solid or plane body that continues it, or a shell and the other a solid that continues it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Arlequin {
    /// Body of the impact zone, the finer model. Outside of the overlap it is the only model.
    pub inner: String,
    /// Body of the rest, the coarser model. It may cover the inner body; its cells inside the inner body and outside of
    /// the overlap are removed.
    pub outer: String,
    /// Region in which the two are glued, at least one cell of the outer body thick, better two to four. Of a beam and a solid it is a length of
    /// the axis of the beam, of a shell and a solid a band of the middle surface.
    #[serde(default)]
    pub overlap: OverlapRegion,
    /// Distribution of inertia and internal work between the two bodies. Default `"linear"`: the only profile that
    /// reproduces a constant strain.
    #[serde(default)]
    pub weights: Weights,
    /// Body whose shape functions represent the multiplier. Default `"coarser"`: a finer one locks the fine motion and
    /// reflects short waves.
    #[serde(default)]
    pub mediator: Mediator,
    /// Scalar product of multiplier and velocity. Default `"l2"`: it needs no length, and requires weights without
    /// jumps, such as linear weights.
    #[serde(default)]
    pub bracket: Bracket,
    /// Multiplier as a function of time within an outer step. Default: `"gravouil-combescure"` if all zones take the
    /// outer step, otherwise `"prakash-hjelmstad"`, which then does not dissipate and alone takes bodies with finite rotations.
    /// All joints of a case use the same.
    pub link: Option<Link>,
}

/// A border where two bodies in different zones are tied: node to node, at nodes that they share or at nodes at the same place,
/// or over surfaces whose nodes need not match.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Interface {
    /// One body.
    pub inner: String,
    /// The other body, in another zone.
    pub outer: String,
    /// Groups of sides of the inner and of the outer body. They are tied by mortar where they are opposite to each
    /// other in the mesh. Default: ties at common nodes.
    pub surfaces: Option<[String; 2]>,
    /// Multiplier as a function of time within an outer step, as in `arlequin`.
    pub link: Option<Link>,
}

/// Where two bodies are glued.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum OverlapRegion {
    /// By its name.
    Named(OverlapName),
    /// A group of cells of either body.
    Group(String),
    /// A region.
    Region(OverlapShape),
}

impl Default for OverlapRegion {
    fn default() -> OverlapRegion {
        OverlapRegion::Named(OverlapName::Intersection)
    }
}

/// Where two bodies are glued, by a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OverlapName {
    /// The whole region that both bodies cover. Other texts are groups of cells of either body.
    Intersection,
}

/// A region in which two bodies are glued.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OverlapShape {
    /// A box with sides along the axes.
    Box(OverlapBox),
}

/// A box with sides along the axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct OverlapBox {
    /// Least coordinates.
    pub min: Vector<Coordinate>,
    /// Largest coordinates.
    pub max: Vector<Coordinate>,
}

/// Weights of the two bodies in the overlap, that of the inner one given; the two add up to one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Weights {
    /// One profile for both.
    Same(ProfileName),
    /// Inertia and internal work apart.
    Apart(WeightTable),
}

impl Default for Weights {
    fn default() -> Weights {
        Weights::Same(ProfileName::Linear)
    }
}

/// Profile of a weight, from the border where the inner body ends to that where the outer one ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProfileName {
    /// Linear in the distances to the two borders of the overlap.
    #[default]
    Linear,
    /// 3 s² - 2 s³ of the linear profile s: smooth, but strains are wrong by some per cent.
    Smooth,
}

/// Weights of inertia and of internal work.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct WeightTable {
    /// Weight of the inertia, alpha.
    #[serde(default)]
    pub inertia: Profile,
    /// Weight of the internal work, delta.
    #[serde(default)]
    pub stiffness: Profile,
    /// Smallest weight of either body in the overlap, for profiles that are not constant. With a value above zero the
    /// weights jump at the borders.
    #[serde(default)]
    #[schemars(extend("minimum" = 0.0, "exclusiveMaximum" = 0.5))]
    pub floor: f64,
}

/// Profile of a weight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Profile {
    /// By its name.
    Named(ProfileName),
    /// With a value.
    With(ProfileWith),
}

impl Default for Profile {
    fn default() -> Profile {
        Profile::Named(ProfileName::Linear)
    }
}

/// Profile of a weight, with a value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProfileWith {
    /// This weight of the inner body in the whole overlap. For the internal work it does not reproduce a constant
    /// strain.
    Constant(#[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 1.0))] f64),
}

/// Body whose shape functions represent the multiplier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Mediator {
    /// The body with the larger cells in the overlap.
    #[default]
    Coarser,
    /// The inner body.
    Inner,
    /// The outer body.
    Outer,
}

/// Product of multiplier L and velocity w over the overlap.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Bracket {
    /// By its name.
    Named(BracketName),
    /// With a length.
    With(BracketWith),
}

impl Default for Bracket {
    fn default() -> Bracket {
        Bracket::Named(BracketName::L2)
    }
}

/// Product of multiplier L and velocity w over the overlap, by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BracketName {
    /// The integral of L w.
    L2,
}

/// Product of multiplier L and velocity w over the overlap, with a length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BracketWith {
    /// The integral of L w + length² strain(L) : strain(w).
    H1(H1Bracket),
}

/// The bracket with strains.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct H1Bracket {
    /// The length.
    #[serde(default)]
    pub length: BracketLength,
}

/// The length of the bracket with strains.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum BracketLength {
    /// By a word.
    Named(LengthName),
    /// A length.
    Given(Length),
}

impl Default for BracketLength {
    fn default() -> BracketLength {
        BracketLength::Named(LengthName::Auto)
    }
}

/// A length by a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LengthName {
    /// The size of the cells of the outer body in the overlap.
    Auto,
}

/// How the multiplier of a joint runs over an outer step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Link {
    /// Velocities are equal at every inner instant; those of the outer zone are interpolated. Dissipates energy with
    /// inner steps.
    GravouilCombescure,
    /// Multipliers are linear over the outer step; velocities are equal at its end.
    PrakashHjelmstad,
}
