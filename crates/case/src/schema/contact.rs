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
    /// Group of the surface whose points carry the contact forces.
    pub secondary: String,
    /// Group of the surface that defines the normal.
    pub primary: Option<String>,
    /// A rigid obstacle in place of a primary surface.
    pub obstacle: Option<Obstacle>,
    /// `true`: self-contact of the secondary surface.
    #[serde(rename = "self")]
    #[schemars(extend("const" = true))]
    pub itself: Option<bool>,
    /// Contact law.
    pub law: Law,
    /// Whether the pairing of the two surfaces follows their motion. Default: `finite` in nonlinear cases (finite
    /// strain, plasticity, friction, moving obstacles or supports, loads as functions of time, damping, static stages,
    /// mortar), otherwise `small`.
    pub sliding: Option<Sliding>,
    /// Where the contact condition is imposed. Default: `node` on linear faces, `mortar` where faces are quadratic,
    /// because forces at the nodes of quadratic faces do not represent the pressure.
    pub integration: Option<Integration>,
    /// Friction. Default: none.
    pub friction: Option<Friction>,
    /// Treatment of surfaces that penetrate at the start.
    #[serde(default)]
    pub initial: Penetration,
    /// Largest penetration that counts as contact. A point is then paired only with faces of opposite normal that it
    /// penetrates by at most this depth. For thin parts. Default: no bound; in self-contact half the thickness.
    pub depth: Option<Length>,
    /// Mass of the nodes of the two surfaces.
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
    /// The initial overlap counts as a gap of zero and carries no force.
    Offset,
    /// Secondary nodes are moved onto the other surface. The mesh changes, without stress.
    Remove,
    /// The contact law pushes the points out.
    Keep,
}

/// Whether nodes in contact have a mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Nodes {
    /// They keep their mass.
    #[default]
    Heavy,
    /// Their mass is redistributed to the other nodes of their bodies. This preserves mass and centre of mass, and if
    /// possible the moments of inertia. For the displacement law with implicit schemes and lumped mass.
    Massless,
}

/// A contact law. Gap g is positive when open, pressure p positive in compression, gap rate positive when opening.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// Exact non-penetration: 0 <= g, 0 <= p, p g = 0 at the end of each step.
    Displacement(DisplacementLaw),
    /// A spring with a damper: p = k max(0, -g), minus C times the gap rate while the gap is closed.
    Damped(DampedLaw),
    /// Exact impenetrability in velocity: where the gap is closed, 0 <= gap rate, 0 <= p, and p times the gap rate = 0 at the end of
    /// each step.
    Velocity(VelocityLaw),
    /// A one-sided damper: where the gap is closed, p = C max(0, -gap rate) at the end of each step. It absorbs energy:
    /// 1 % of that of the striker if C is 100 times the impedance per area of two equal bars, or 400 times that of a
    /// bar on a rigid obstacle.
    Compliance(ComplianceLaw),
    /// Newton's restitution: where the gap is closed, the gap rate at the end of each step is at least -e times that at
    /// its start, and equal to it where there is a pressure. For bodies that are rigid at the time scale of the step.
    Restitution(RestitutionLaw),
    /// A given stiffness: p = k max(0, -g), minus C times the gap rate while the gap is closed.
    Penalty(PenaltyLaw),
    /// A stop of engineering structures, for the contact as a whole: a clearance, a curve of force over penetration, a
    /// dashpot.
    Stop(StopLaw),
}

/// Exact non-penetration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DisplacementLaw {
    /// Whether velocity and acceleration of closed points are projected at the end of a step in which points close.
    /// This removes the oscillation of the force under Newmark's scheme; other schemes refuse it.
    #[serde(default)]
    pub projection: bool,
}

/// A compliant law with a damper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("not" = { "required": ["damping", "damping-factor"] }))]
pub struct DampedLaw {
    /// Stiffness per area k. Default: Young's modulus of the softer side divided by its element size.
    pub stiffness: Option<SurfaceStiffness>,
    /// Damping per area C. Default: from `damping-factor`.
    pub damping: Option<SurfaceDamping>,
    /// C relative to the impedance per area of the softer side times sqrt(k h / E). Default: 0.5.
    #[schemars(extend("minimum" = 0.0))]
    pub damping_factor: Option<f64>,
    /// Treatment of a tensile pressure of the damper.
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
    /// It remains, as in the printed law, and is a negative force in the histories.
    AsPrinted,
}

/// Impenetrability in velocity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct VelocityLaw {
    /// The gap that decides whether a point is closed. Default: `half` for theta = 1/2, otherwise `now`.
    pub capture: Option<Capture>,
    /// Gaps at which the condition applies.
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
    /// C relative to the impedance per area of the softer side, in place of `damping`.
    #[schemars(extend("minimum" = 0.0))]
    pub damping_factor: Option<f64>,
    /// The gap that decides whether a point is closed. Default: `half` for theta = 1/2, otherwise `now`.
    pub capture: Option<Capture>,
}

/// Newton's restitution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RestitutionLaw {
    /// Coefficient e: 0 is the velocity law, 1 the elastic rebound of rigid bodies.
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub coefficient: f64,
    /// The gap that decides whether a point is closed. Default: `half` for theta = 1/2, otherwise `now`.
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
    /// Treatment of a tensile pressure of the damper.
    #[serde(default)]
    pub adhesion: Adhesion,
}

/// A stop, for the contact as a whole: its points share the force by their areas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct StopLaw {
    /// Clearance that is not in the mesh: the stop acts where the gap is below minus this value. Default: 0.
    pub clearance: Option<Clearance>,
    /// Points of force over penetration, both increasing. The curve begins at (0, 0), which is not written; it is
    /// linear between the points and continues beyond the last one. One point gives a spring.
    #[schemars(extend("minItems" = 1, "maxItems" = 16))]
    pub curve: Vec<CurvePoint>,
    /// Unloading of the stop.
    #[serde(default)]
    pub crush: Crush,
    /// Dashpot. Default: 0.
    pub damping: Option<Damping>,
    /// Treatment of a tensile force of the dashpot.
    #[serde(default)]
    pub adhesion: Adhesion,
}

/// What becomes of the crush of a stop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Crush {
    /// Unloading follows the curve; all energy is recovered.
    #[default]
    Recovered,
    /// The crush is permanent: unloading and reloading follow a line of the initial stiffness from the point of largest
    /// penetration; beyond that point the force follows the curve again. No piece of the curve may be steeper than the
    /// first.
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
    /// The smaller of the gap at the beginning of the step and the gap predicted for its middle.
    Half,
    /// The smaller of the gap at the beginning of the step and the gap predicted for its end from the gap rate.
    Full,
    /// The gap at the end of the step without any contact force.
    Free,
    /// None. At all points the gap rate at the end of the step is at least -g / dt, with g at its start, so that
    /// penetrating points are pushed out (Stewart and Trinkle). Not for the restitution law.
    GapTarget,
}

/// Which gaps switch the velocity condition on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sign {
    /// Closed gaps.
    #[default]
    Closed,
    /// Open gaps, as in the printed equation (7.d): bodies pass through each other. For comparison only.
    AsPrinted,
}

/// Whether the pairing follows the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sliding {
    /// Points keep the face and the normal of the initial configuration.
    Small,
    /// The closest faces are determined again in each step, or in each iteration of a nonlinear step.
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
    /// At the Gauss points of its faces. The exact laws have their weak form, with a multiplier in the shape functions
    /// of the surface and a sign at each point. Compliance, and penalty and stop without damping, apply at each point
    /// separately.
    Quadrature,
    /// Segment to segment: in a weighted average around each node of the secondary surface, with the dual basis of
    /// multipliers. Non-matching meshes transmit a constant pressure exactly.
    Mortar,
}

/// Where the contact condition is imposed, with parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegrationWith {
    /// At the Gauss points of the secondary faces, with the parameter r of the weak form: the sign of a point is that
    /// of p - r g, or of p - r-v times the gap rate. The result depends on r only around nodes between closed and open
    /// points; the summary counts these nodes.
    Quadrature(Quadrature),
    /// Segment to segment, with a choice of the basis of the multipliers.
    Mortar(Mortar),
}

/// The multipliers of segment-to-segment contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Mortar {
    /// Shape functions of the multipliers.
    #[serde(default)]
    pub basis: Basis,
}

/// Shape functions of multipliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// Biorthogonal to the shape functions of the faces: on linear faces each multiplier belongs to one secondary node.
    #[default]
    Dual,
    /// The shape functions of the faces.
    Standard,
}

/// The r of the weak form.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Quadrature {
    /// r of the displacement law. Default: Young's modulus of the softer side divided by its element size.
    pub r: Option<SurfaceStiffness>,
    /// r of the velocity law. Default: the impedance per area of the softer side.
    pub r_v: Option<SurfaceDamping>,
}
