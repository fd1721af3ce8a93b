//! `[contact]`: who may touch whom, and by which law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::obstacle::Obstacle;
use super::output::ChannelClass;
use carom_laws::{Friction, GivenLaw};
use carom_quantities::{Coordinate, Duration, Length, SurfaceDamping, SurfaceStiffness, Vector};

/// Contact between two surfaces, between a surface and a rigid obstacle, or of a surface with itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("oneOf" = [
    { "required": ["primary"] },
    { "required": ["obstacle"] },
    { "required": ["self"] },
]))]
pub struct Contact {
    /// Group of the surface whose points carry the contact forces, which act on it. Where contact is looked for both ways (solids, `sliding` finite, at
    /// nodes of linear faces) points are on both sides, and the choice matters little.
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
    pub law: GivenLaw,
    /// Whether the pairing of the two surfaces follows their motion. Default: `finite` where the sides may move
    /// far (friction, mortar, a moving obstacle; a body of the contact that is rigid, at finite strain, with finite
    /// rotations, damped, loaded or moved; base acceleration, static stages, energy-momentum), otherwise `small`.
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
    /// penetrates by at most this depth. For thin parts. Default: no bound; in self-contact half the thickness, where contact is looked for both ways the
    /// least thickness of the cells at the two surfaces.
    pub depth: Option<Length>,
    /// Point, fixed in space, about which the moment of the contact force is written, as columns `contact.NAME.moment_x_n_m` … and with
    /// its largest magnitude in the summary. For two surfaces that share no nodes, in the plane and in space. Default: none.
    pub moment_about: Option<Vector<Coordinate>>,
    /// Flights shorter than this belong to one impact: closings of a contact that chatters are one event in the table of impacts, with
    /// one restitution. Default: the time in which a wave crosses the longer of the two bodies, or ten times the impact so far where
    /// that is shorter; four steps at least.
    pub merge_within: Option<Duration>,
    /// Mass of the nodes of the two surfaces.
    #[serde(default)]
    pub nodes: Nodes,
    /// Filters of SAE J211-1 behind which the sum of the normal forces is written too, in `filtered.csv`, and drawn over the raw force.
    /// Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("uniqueItems" = true))]
    pub filter: Vec<ChannelClass>,
}

/// General contact: the outer sides of all bodies, in the plane and in space, each body with each other; bodies at finite strain or with
/// finite rotations with themselves too. Of shells and beams they are around middles and axes; bars take no part. Pairs of bodies are left out that a contact of `[contact]`, a
/// transition, an overlap or an interface joins, or that share nodes, and cells in an overlap.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct GeneralContact {
    /// Contact law of pairs of materials that have none of their own.
    pub law: GivenLaw,
    /// Friction of pairs of materials that have none of their own. Default: none.
    pub friction: Option<Friction>,
    /// Largest penetration that counts as contact. Default: the least thickness of a cell at the outer sides of the two bodies. It means
    /// nothing to shells and beams.
    pub depth: Option<Length>,
    /// What has a contact, with results of its own. Default: `bodies` up to 100 pairs of bodies, as of 14, `materials` beyond.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<GeneralBy>,
    /// What is different between two materials.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pairs: Vec<MaterialPair>,
}

/// What has a contact of the general contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GeneralBy {
    /// Each two bodies, `all-a-b` of the bodies `a` and `b`: forces, impulses and restitution of each pair. Memory and time grow with the square of the
    /// number of bodies.
    Bodies,
    /// Each two materials, `all-m-n` of the materials `m` and `n`, `all-m` of all bodies of one: one search over all their sides, memory in
    /// proportion to their faces. What two bodies do to each other is not told apart. Bodies of one material have contacts of their own
    /// where their sections, their zones or their rotations differ, and where cells are deleted. Shells of one contact do not meet edge on edge.
    Materials,
}

/// Law and friction between bodies of two materials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("anyOf" = [{ "required": ["law"] }, { "required": ["friction"] }]))]
pub struct MaterialPair {
    /// The two materials, in any order; the same twice for bodies of one material.
    pub materials: [String; 2],
    /// Contact law. Default: that of the general contact.
    pub law: Option<GivenLaw>,
    /// Friction. Default: that of the general contact.
    pub friction: Option<Friction>,
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

/// Whether the pairing follows the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sliding {
    /// Points keep the face and the normal of the initial configuration.
    Small,
    /// The closest faces are determined again in each step, or in each iteration where the law needs it. Between solids, at nodes, contact is looked for
    /// both ways.
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
