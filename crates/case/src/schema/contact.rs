//! `[contact]`: who may touch whom, and by which law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::obstacle::Obstacle;
use super::quantity::{Clearance, Damping, Force, Length, SurfaceDamping, SurfaceStiffness};

/// Contact between two surfaces, between a surface and a rigid obstacle, or of a surface with itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("oneOf" = [
    { "required": ["primary"] },
    { "required": ["obstacle"] },
    { "required": ["self"] },
]))]
pub struct Contact {
    /// Group of the surface that carries the contact pressure at its nodes.
    pub secondary: String,
    /// Group of the surface that gives the normal.
    pub primary: Option<String>,
    /// A rigid obstacle in place of a primary surface.
    pub obstacle: Option<Obstacle>,
    /// `true`: the secondary surface faces itself.
    #[serde(rename = "self")]
    #[schemars(extend("const" = true))]
    pub itself: Option<bool>,
    /// Contact law.
    pub law: Law,
    /// Whether the pairing of the two surfaces follows their motion. Default: `finite` where the steps are not linear anyway (finite
    /// strain, plasticity, friction, obstacles or supports that move, loads in time, damping, static stages, mortar); `small`
    /// elsewhere.
    pub sliding: Option<Sliding>,
    /// Where the contact condition is imposed. Default: `node` on linear faces, `mortar` where faces are quadratic: forces at the nodes
    /// of quadratic faces give no pressure.
    pub integration: Option<Integration>,
    /// Friction. Default: none.
    pub friction: Option<Friction>,
    /// What is done where the surfaces penetrate at the start.
    #[serde(default)]
    pub initial: Penetration,
    /// Depth beyond which a penetration is no contact: points see only faces that are turned against them and not further away inside
    /// than this. For thin parts. Default: no bound; of a surface with itself, half its thickness.
    pub depth: Option<Length>,
    /// Whether the nodes of the two surfaces keep their mass.
    #[serde(default)]
    pub nodes: Nodes,
}

/// Friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Friction {
    /// Coulomb's coefficient of friction.
    Coulomb(#[schemars(extend("minimum" = 0.0))] f64),
}

/// What is done where surfaces penetrate at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Penetration {
    /// The case is refused.
    #[default]
    Refuse,
    /// Gaps count from where the points are: the overlap stays and carries no force.
    Offset,
    /// Secondary nodes are moved onto the other surface; the mesh changes, and no stress arises.
    Remove,
    /// Nothing: the law pushes the points out.
    Keep,
}

/// Whether nodes in contact have a mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Nodes {
    /// They keep their mass.
    #[default]
    Heavy,
    /// Their mass goes to the other nodes of their bodies; mass and centre of mass stay, and as far as possible the
    /// moments of inertia. For the displacement law with implicit schemes and lumped mass.
    Massless,
}

/// A contact law. Gap g is positive when open, pressure p positive in compression, gap rate positive when opening.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// Exact non-penetration: 0 <= g, 0 <= p, p g = 0 at the end of each step.
    Displacement(DisplacementLaw),
    /// Compliant with a damper: p = k max(0, -g), less C times the gap rate while the gap is closed.
    Damped(DampedLaw),
    /// Exact impenetrability in velocity: where the gap is closed, 0 <= gap rate, 0 <= p, and p times the gap rate = 0 at the end of
    /// each step.
    Velocity(VelocityLaw),
    /// A one-sided damper: where the gap is closed, p = C max(0, -gap rate) at the end of each step. Absorbs energy: 1 % of the
    /// striker's at 100 times the impedance per area of two equal bars, at 400 times that of a bar on a rigid obstacle.
    Compliance(ComplianceLaw),
    /// Newton's restitution: where the gap is closed, the gap rate at the end of each step is at least -e times that at its start,
    /// and exactly that where there is pressure. For bodies that are rigid at the time scale of the step.
    Restitution(RestitutionLaw),
    /// A given stiffness: p = k max(0, -g), less C times the gap rate while the gap is closed.
    Penalty(PenaltyLaw),
    /// A stop of engineering structures, given for the contact as a whole: a clearance, a curve of force over penetration, a
    /// dashpot.
    Stop(StopLaw),
}

/// Exact non-penetration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DisplacementLaw {
    /// Whether velocity and acceleration of closed points are projected at the end of a step in which points close: the
    /// cure for the oscillation of the force under Newmark's scheme, and for that scheme only.
    #[serde(default)]
    pub projection: bool,
}

/// A compliant law with a damper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("not" = { "required": ["damping", "damping-factor"] }))]
pub struct DampedLaw {
    /// Stiffness per area k. Default: Young's modulus over the element size of the softer side.
    pub stiffness: Option<SurfaceStiffness>,
    /// Damping per area C. Default: from `damping-factor`.
    pub damping: Option<SurfaceDamping>,
    /// C over the impedance per area of the softer side, times sqrt(k h / E). Default: 0.5.
    #[schemars(extend("minimum" = 0.0))]
    pub damping_factor: Option<f64>,
    /// What becomes of a pressure that the damper makes tensile.
    #[serde(default)]
    pub adhesion: Adhesion,
}

/// What becomes of a tensile pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Adhesion {
    /// It is set to zero.
    #[default]
    Clip,
    /// It stays, as the law is printed; the summary says how much it pulled.
    AsPrinted,
}

/// Impenetrability in velocity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct VelocityLaw {
    /// The gap that decides whether a point is closed. Default: `half` for theta = 1/2, `now` otherwise.
    pub capture: Option<Capture>,
    /// Which gaps switch the condition on.
    #[serde(default)]
    pub sign: Sign,
}

/// A compliance in velocity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("oneOf" = [{ "required": ["damping"] }, { "required": ["damping-factor"] }]))]
pub struct ComplianceLaw {
    /// Damping per area C.
    pub damping: Option<SurfaceDamping>,
    /// C over the impedance per area of the softer side, in place of `damping`.
    #[schemars(extend("minimum" = 0.0))]
    pub damping_factor: Option<f64>,
    /// The gap that decides whether a point is closed. Default: `half` for theta = 1/2, `now` otherwise.
    pub capture: Option<Capture>,
}

/// Newton's restitution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RestitutionLaw {
    /// Coefficient e: 0 is the velocity law, 1 the elastic rebound of rigid bodies.
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub coefficient: f64,
    /// The gap that decides whether a point is closed. Default: `half` for theta = 1/2, `now` otherwise.
    pub capture: Option<Capture>,
}

/// A penalty law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PenaltyLaw {
    /// Stiffness per area k.
    pub stiffness: SurfaceStiffness,
    /// Damping per area C. Default: 0.
    pub damping: Option<SurfaceDamping>,
    /// What becomes of a pressure that the damper makes tensile.
    #[serde(default)]
    pub adhesion: Adhesion,
}

/// A stop, for the contact as a whole: its points share the force by their areas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct StopLaw {
    /// Clearance that the mesh does not show: the stop presses where the gap is below minus this. Default: 0.
    pub clearance: Option<Clearance>,
    /// Points of force over penetration, both increasing, after (0, 0), which is not written; linear between them, and beyond the
    /// last one as before it. One point gives a spring.
    #[schemars(extend("minItems" = 1, "maxItems" = 16))]
    pub curve: Vec<CurvePoint>,
    /// What becomes of the crush when the stop is unloaded.
    #[serde(default)]
    pub crush: Crush,
    /// Dashpot. Default: 0.
    pub damping: Option<Damping>,
    /// What becomes of a force that the dashpot makes tensile.
    #[serde(default)]
    pub adhesion: Adhesion,
}

/// What becomes of the crush of a stop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Crush {
    /// All of it is given back: unloading follows the curve.
    #[default]
    Recovered,
    /// It stays but for its elastic part: unloading and reloading follow a line of the initial stiffness from the point of largest
    /// crush, and beyond that point the curve goes on. No piece of the curve may be steeper than the first.
    Permanent,
}

/// A point of the curve of a stop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CurvePoint {
    /// Penetration, beyond the clearance.
    pub penetration: Length,
    /// Force of the whole contact.
    pub force: Force,
}

/// The gap that decides whether a point is closed in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Capture {
    /// The gap at the beginning of the step.
    Now,
    /// The gap at the beginning of the step or the one predicted for its middle, whichever is less.
    Half,
    /// The gap at the beginning of the step or the one predicted for its end from the gap rate, whichever is less.
    Full,
    /// The gap at the end of the step without any contact force.
    Free,
    /// None: in all points the gap rate at the end of the step is at least -g / dt, g at its start, so that what has penetrated is
    /// pushed out (Stewart and Trinkle). Not for the restitution law.
    GapTarget,
}

/// Which gaps switch the velocity condition on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sign {
    /// Closed gaps.
    #[default]
    Closed,
    /// Open gaps, as equation (7.d) is printed: bodies pass through each other. For comparison only.
    AsPrinted,
}

/// Whether the pairing follows the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sliding {
    /// Points keep the partner and the normal of the initial configuration.
    Small,
    /// The closest points are found again at each step.
    Finite,
}

/// Where the contact condition is imposed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Integration {
    /// By its name.
    Named(IntegrationName),
    /// With parameters.
    With(IntegrationWith),
}

/// Where the contact condition is imposed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegrationName {
    /// At the nodes of the secondary surface.
    Node,
    /// At the Gauss points of its faces: the exact laws in their weak form, with a pressure in the shape functions of the
    /// surface and a sign at each point; the compliance, and penalty and stop without damping, in each point by itself.
    Quadrature,
    /// Segment to segment: in the mean around each node of the secondary surface, with multipliers of the dual basis. Passes
    /// a constant pressure through meshes that do not match.
    Mortar,
}

/// Where the contact condition is imposed, with parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegrationWith {
    /// At the Gauss points of the secondary faces, as the name says, with the r of the weak form: the sign of a point is
    /// that of p - r g, or p - r-v times the gap rate. The result depends on it only around nodes between closed and open
    /// points; the summary counts them.
    Quadrature(Quadrature),
    /// Segment to segment, with the basis of the multipliers.
    Mortar(Mortar),
}

/// The multipliers of segment-to-segment contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Mortar {
    /// Their shape functions.
    #[serde(default)]
    pub basis: Basis,
}

/// Shape functions of multipliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// Those biorthogonal to the shape functions of the faces: no two multipliers share a secondary node of linear faces.
    #[default]
    Dual,
    /// The shape functions of the faces.
    Standard,
}

/// The r of the weak form.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Quadrature {
    /// r of the displacement law. Default: Young's modulus over the element size of the softer side.
    pub r: Option<SurfaceStiffness>,
    /// r of the velocity law. Default: the impedance per area of the softer side.
    pub r_v: Option<SurfaceDamping>,
}
