//! `[mass]`, `[spring]`, `[dashpot]`, `[stop]`: discrete elements at nodes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_laws::{Adhesion, Crush, CurvePoint, Friction, GivenLaw};
use carom_quantities::{
    Clearance, Coordinate, Damping, MomentOfInertia, SignedForce, Stiffness, Vector, Velocity,
    Weight,
};

use super::body::Initial;
use super::obstacle::{NormalVector, Obstacle};

/// A point mass: at a node of its own, or at each node of a group.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("oneOf" = [{ "required": ["at"] }, { "required": ["on"] }]))]
pub struct PointMass {
    /// Mass of each node.
    pub mass: Weight,
    /// Moments of inertia of each node: three about the axes of coordinates, or one about z in the plane. The nodes must have
    /// rotations, as those of beams have. Default: none.
    #[schemars(extend("minItems" = 1, "maxItems" = 3))]
    pub inertia: Option<Vec<MomentOfInertia>>,
    /// Place of its own node. The node is a group with the name of the mass: supports, springs, contacts and probes use that
    /// name.
    pub at: Option<Vector<Coordinate>>,
    /// Group whose nodes get the mass in addition to what they have.
    pub on: Option<String>,
    /// Initial state of its own node. On a group: of its nodes, in place of that of their body. Default: at rest at its place,
    /// on a group as the body.
    pub initial: Option<Initial>,
    /// Whether its nodes wait for the dynamics: over a static stage they are held where they are, as by a support.
    #[serde(default)]
    pub hold: bool,
}

/// Names of the two ends of a discrete element.
pub type Ends = [String; 2];

/// A spring: its force depends on its elongation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("oneOf" = [{ "required": ["stiffness"] }, { "required": ["curve"] }], "dependentRequired" = { "curve": ["axis"] }))]
pub struct Spring {
    /// Names of groups of one node, or of a group and `"ground"`. Between a group of several nodes and the ground there is a
    /// spring at each node.
    pub ends: Ends,
    /// Direction from the first end to the second one. It is fixed in space: the spring has no force across it. Default: all
    /// directions, in each of which the displacement between the ends is opposed by the stiffness.
    pub axis: Option<NormalVector>,
    /// Force over elongation.
    pub stiffness: Option<Stiffness>,
    /// Points of force over elongation, both positive in tension, with ascending elongations. Linear between the points; the
    /// first and the last piece continue beyond them. With `axis` only.
    #[schemars(extend("minItems" = 2))]
    pub curve: Option<Vec<SpringPoint>>,
}

/// A point of the curve of a spring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SpringPoint {
    /// Elongation; negative when shortened.
    pub elongation: Coordinate,
    /// Force; negative in compression.
    pub force: SignedForce,
}

/// A dashpot: its force depends on the rate of its elongation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("oneOf" = [{ "required": ["damping"] }, { "required": ["curve"] }], "dependentRequired" = { "curve": ["axis"] }))]
pub struct Dashpot {
    /// Names of groups of one node, or of a group and `"ground"`. Between a group of several nodes and the ground there is a
    /// dashpot at each node.
    pub ends: Ends,
    /// Direction from the first end to the second one, fixed in space. Default: all directions.
    pub axis: Option<NormalVector>,
    /// Force over rate.
    pub damping: Option<Damping>,
    /// Points of force over the rate of elongation, with ascending rates. Linear between the points; the first and the last
    /// piece continue beyond them. A force has the sign of its rate and is zero at rate zero. With `axis` only.
    #[schemars(extend("minItems" = 2))]
    pub curve: Option<Vec<DashpotPoint>>,
}

/// A point of the curve of a dashpot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DashpotPoint {
    /// Rate of elongation; negative while it shortens.
    pub rate: Velocity,
    /// Force; negative in compression.
    pub force: SignedForce,
}

/// A stop: it pushes its ends apart where they come nearer than the gap. It is a contact of one point with the law `stop`: its
/// force, gap, impulse and impacts are reported as those of a contact with its name. A node may have any number of stops.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "oneOf" = [{ "required": ["axis"] }, { "required": ["obstacle"] }],
    "anyOf" = [{ "required": ["stiffness"] }, { "required": ["curve"] }, { "required": ["law"] }],
    "not" = { "required": ["stiffness", "curve"] },
))]
pub struct Stop {
    /// Names of two groups of one node, or of one and `"ground"`.
    pub ends: Ends,
    /// Direction from the first end to the second one, fixed in space.
    pub axis: Option<NormalVector>,
    /// The place and shape of the ground, in place of `axis`: the gap is the distance of the node from it less `gap` and the radius of
    /// the section. In a round hole this is the clearance less the eccentricity, in every direction.
    pub obstacle: Option<Obstacle>,
    /// With `axis`: by how much the ends can come nearer along it, from their places in the mesh, until the stop acts. With
    /// `obstacle`: by how much the obstacle is further away than its shape says. A negative gap is a stop that is compressed
    /// at the start, which a `law` in the gap or in the rate alone cannot be. Default: 0.
    pub gap: Option<Coordinate>,
    /// Force over penetration.
    pub stiffness: Option<Stiffness>,
    /// Points of force over penetration, as in the law `stop` of contacts.
    #[schemars(extend("minItems" = 1, "maxItems" = 16))]
    pub curve: Option<Vec<CurvePoint>>,
    /// Unloading of the stop.
    #[serde(default)]
    pub crush: Crush,
    /// Dashpot that acts while the stop is closed. Default: 0.
    pub damping: Option<Damping>,
    /// Treatment of a tensile force of the dashpot.
    #[serde(default)]
    pub adhesion: Adhesion,
    /// A law of contacts in place of the spring and the dashpot of the stop, whose keys are then not needed and do not matter:
    /// `displacement`, `velocity`, `restitution`, `hertz`, `hunt-crossley` or `stop`.
    pub law: Option<GivenLaw>,
    /// Friction across the axis while the stop is closed. Default: none.
    pub friction: Option<Friction>,
    /// Radii of the sections of the two ends, in their order. Friction acts at the surface of a section, at this distance from the
    /// node along the axis: the rotation of the node is part of the sliding, and friction turns the node. The gap of a stop
    /// with an axis does not depend on it. Default: 0.
    #[schemars(extend("minItems" = 1, "maxItems" = 2))]
    pub radius: Option<Vec<Clearance>>,
}
