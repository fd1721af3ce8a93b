//! Rigid obstacles of `[contact]`, and how they move.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::{Angle, AngularVelocity, Coordinate, Delay, Length, Vector, Velocity};

/// A rigid obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Obstacle {
    /// A half space behind a plane.
    Plane(Plane),
    /// A ball; a disc in the plane.
    Sphere(Sphere),
    /// A circular cylinder without ends.
    Cylinder(Cylinder),
    /// Faces of the mesh that belong to no body.
    Surface(Surface),
    /// A prism without ends whose section across an axis is a closed curve given by points.
    Profile(PolarProfile),
}

/// A rigid plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Plane {
    /// A point of the plane.
    pub point: Vector<Coordinate>,
    /// Normal of the plane out of the obstacle, towards the bodies; of any length except zero.
    pub normal: NormalVector,
    /// Its motion. Default: none.
    pub motion: Option<ObstacleMotion>,
}

/// A rigid sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Sphere {
    /// Its centre.
    pub centre: Vector<Coordinate>,
    /// Its radius.
    pub radius: Length,
    /// The side of the bodies.
    #[serde(default)]
    pub side: Side,
    /// Its motion. Default: none.
    pub motion: Option<ObstacleMotion>,
}

/// A rigid cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Cylinder {
    /// A point of its axis.
    pub point: Vector<Coordinate>,
    /// Direction of its axis, of any length except zero. In the plane: [0, 0, 1].
    pub axis: NormalVector,
    /// Its radius.
    pub radius: Length,
    /// The side of the bodies.
    #[serde(default)]
    pub side: Side,
    /// Its motion. Default: none.
    pub motion: Option<ObstacleMotion>,
}

/// A rigid prism: its section across the axis is a closed curve r(angle).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("oneOf" = [{ "required": ["points"] }, { "required": ["csv"] }]))]
pub struct PolarProfile {
    /// A point of its axis, from which radii count.
    pub point: Vector<Coordinate>,
    /// Direction of its axis, of any length except zero. In the plane: [0, 0, 1].
    pub axis: NormalVector,
    /// Direction of angle zero; its part across the axis counts. Angles run anticlockwise about the axis. Default: x, or y where the
    /// axis is along x.
    pub zero: Option<NormalVector>,
    /// Points of the curve, angles ascending within one turn and less than half a turn apart.
    #[schemars(extend("minItems" = 3))]
    pub points: Option<Vec<PolarPoint>>,
    /// Columns of a text file with such points.
    pub csv: Option<PolarColumns>,
    /// The curve between the points.
    #[serde(default)]
    pub curve: PolarCurve,
    /// The side of the bodies.
    #[serde(default)]
    pub side: Side,
    /// Its motion. Default: none.
    pub motion: Option<ObstacleMotion>,
}

/// A point of a profile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PolarPoint {
    /// Angle.
    pub angle: Angle,
    /// Distance from the axis.
    pub radius: Length,
}

/// Two columns of a text file with the points of a profile, as in signals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PolarColumns {
    /// Path of the file, from the folder of the case file.
    pub file: String,
    /// Column of the angles.
    pub angle: String,
    /// Column of the radii.
    pub radius: String,
    /// Unit of the angles, if the column does not say it. Default: rad.
    pub angle_unit: Option<String>,
    /// Unit of the radii, if the column does not say it. Default: m.
    pub unit: Option<String>,
}

/// The curve between the points of a profile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PolarCurve {
    /// Straight: a polygon.
    #[default]
    Straight,
    /// The periodic cubic spline of the radius over the angle, with continuous curvature.
    Smooth,
}

/// A rigid surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Surface {
    /// Group of its faces. The order of the nodes of a face defines its normal; the bodies are on the side to which the
    /// normals point.
    pub group: String,
    /// Whether to reverse the normals.
    #[serde(default)]
    pub turned: bool,
    /// Its motion. Default: none.
    pub motion: Option<ObstacleMotion>,
}

/// The side of a round obstacle on which the bodies stay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Outside: a ball, a shaft.
    #[default]
    Outside,
    /// Inside: a hollow, a bore.
    Inside,
}

/// One to three numbers, not all zero; those left out are zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline, extend("minItems" = 1, "maxItems" = 3))]
pub struct NormalVector(pub Vec<f64>);

impl NormalVector {
    /// The three components as written, zeros added.
    pub fn components(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.0.get(axis).copied().unwrap_or(0.0))
    }
}

/// Motion of an obstacle: a translation, and a rotation about an axis that moves with the translation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "not" = { "required": ["velocity", "displacement"] },
    "anyOf" = [
        { "required": ["velocity"] },
        { "required": ["displacement"] },
        { "required": ["turn"] },
    ],
))]
pub struct ObstacleMotion {
    /// Constant velocity from time 0.
    pub velocity: Option<Vector<Velocity>>,
    /// Displacement as a function of time: linear between the given points, constant before the first and after the
    /// last.
    #[schemars(extend("minItems" = 1))]
    pub displacement: Option<Vec<ObstaclePoint>>,
    /// Rotation at constant rate from time 0.
    pub turn: Option<Turn>,
}

/// A point of the displacement of an obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ObstaclePoint {
    /// Time.
    pub time: Delay,
    /// Displacement at that time.
    pub displacement: Vector<Coordinate>,
}

/// A turn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Turn {
    /// A point of the axis at time 0.
    pub point: Vector<Coordinate>,
    /// Direction of the axis, of any length except zero. In the plane: [0, 0, 1].
    pub axis: NormalVector,
    /// Angular velocity.
    pub rate: AngularVelocity,
}
