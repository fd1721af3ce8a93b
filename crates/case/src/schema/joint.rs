//! `[rigid-link]`, `[transition]`, `[constraint]`, `[fluid]`, and what joins beams: hinges, foundations, added mass.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::{Density, Length, LineMass, Modulus};

use super::axis::Axis;
use super::obstacle::NormalVector;

/// A hinge in a body of beams.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Hinge {
    /// Group of nodes of the body.
    pub on: String,
    /// Rotations, about the axes of the section, in which the cells of the body that meet in a node do not turn together. The first of
    /// the cells keeps to the node, and so do other bodies; of a node with one cell of the body this cell is released.
    #[schemars(extend("minItems" = 1, "uniqueItems" = true))]
    pub free: Vec<Axis>,
}

/// An elastic foundation of beams: a force per length that opposes the displacement of the axis, in the axes of the section.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("minProperties" = 1))]
pub struct Foundation {
    /// Stiffness along the axis, a force per length over displacement. Default: 0.
    pub x: Option<Modulus>,
    /// Stiffness along y. Default: 0.
    pub y: Option<Modulus>,
    /// Stiffness along z. Default: 0.
    pub z: Option<Modulus>,
}

/// The mass of a fluid that moves with a beam across its axis. It has no weight, and the motion of a base does not act on it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AddedMass {
    /// Its mass per length.
    PerLength(LineMass),
    /// That of a fluid in a round channel around a round section, at rest with the frame of coordinates. Gravity and the motion of the base act on the section
    /// with its buoyancy.
    Channel(Channel),
}

/// A fluid in a round channel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Channel {
    /// Density of the fluid.
    pub density: Density,
    /// Diameter of the channel, larger than that of the section.
    pub diameter: Length,
}

/// Nodes that move as parts of a rigid body, which turns by small angles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RigidLink {
    /// Group of one node, which leads: `u = u₀ + θ₀ × (x - x₀)`. Without rotations of its own it gives its translation only.
    pub first: String,
    /// Group of the nodes that follow. Those of beams also turn with the first one.
    pub nodes: String,
}

/// The end of a beam on a face of a solid or plane body that it continues, the edge of a shell on a face of a solid, or two surfaces whose
/// nodes need not match. The two bodies have no common nodes.
/// Ends turn by small angles, or by any if `motion` is `"distributing"`, the beam has finite rotations and the other body is at finite strain.
/// In zones, only of this last kind, between two zones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "oneOf" = [{ "required": ["end"] }, { "required": ["surfaces"] }],
    "dependentRequired" = { "end": ["face"], "face": ["end"], "motion": ["end"] },
))]
pub struct Transition {
    /// Group of one node: the end of the beam. Or group of lines: the edge of the shell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<String>,
    /// Group of the sides of the other body that the end stands on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub face: Option<String>,
    /// How the face moves with the end. Default `"distributing"`: it keeps uniform tension and pure bending.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<TransitionMotion>,
    /// Two groups of sides of solid or plane bodies that lie on each other and are tied: their displacements are equal in the mean around
    /// each node of the side with more nodes (mortar method).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surfaces: Option<[String; 2]>,
}

/// How a face moves with a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TransitionMotion {
    /// The node has the mean translation and rotation of the face, of an edge those of the strip beside it; the face may deform otherwise.
    #[default]
    Distributing,
    /// All nodes of the face move as parts of a rigid body with the node, on an edge with its section beside them.
    Rigid,
}

/// A linear constraint: the sum of its terms keeps its initial value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Constraint {
    /// Terms of the sum.
    #[schemars(extend("minItems" = 1))]
    pub terms: Vec<ConstraintTerm>,
}

/// A displacement or a rotation times a factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ConstraintTerm {
    /// Group of one node.
    pub on: String,
    /// Direction of the displacement, or axis of the rotation.
    pub direction: Axis,
    /// Factor, of rotations in m.
    pub factor: f64,
}

/// The inertia of a fluid between two bodies beside each other: a mass matrix between nodes that stand beside each other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "oneOf" = [{ "required": ["diameters"] }, { "required": ["relative-mass"] }],
    "dependentRequired" = { "diameters": ["density"], "density": ["diameters"], "length": ["axis"], "axis": ["length"] },
))]
pub struct FluidGap {
    /// Group of the cells of the inner body, lines, or of one node.
    pub inner: String,
    /// Group of the cells of the outer body, lines with as many nodes at the same places along the axis, or of one node.
    pub outer: String,
    /// Density of the fluid between coaxial bodies.
    pub density: Option<Density>,
    /// Inner and outer diameter of the gap between coaxial bodies.
    pub diameters: Option<[Length; 2]>,
    /// Mass per length that opposes the motion of the bodies relative to each other across the axis.
    pub relative_mass: Option<LineMass>,
    /// Length that groups of one node stand for.
    pub length: Option<Length>,
    /// Axis of the bodies at groups of one node: the fluid opposes motion across it.
    pub axis: Option<NormalVector>,
}
