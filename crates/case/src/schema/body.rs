//! `[material]`, `[body]`, `[support]` and `[load]`: what moves, what holds it, what pulls it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::quantity::{Acceleration, Area, Coordinate, Density, Length, Modulus, Vector, Velocity};

/// A material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Material {
    /// Mass density.
    pub density: Density,
    /// Linear isotropic elasticity, small strain.
    pub elastic: Elastic,
}

/// Linear isotropic elasticity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Elastic {
    /// Young's modulus.
    pub young: Modulus,
    /// Poisson's ratio. Bars and plane stress take what it makes of a free side.
    #[schemars(extend("exclusiveMinimum" = -1.0, "exclusiveMaximum" = 0.5))]
    pub poisson: f64,
}

/// A body: cells of the mesh, with a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Body {
    /// Group of the cells.
    pub region: String,
    /// Name of a material of this file.
    pub material: String,
    /// What the cells leave out of three-dimensional space: required for bars and plane cells, refused for solids.
    pub section: Option<Section>,
    /// Mass matrix.
    #[serde(default)]
    pub mass: Mass,
    /// State at the beginning. Default: at rest, undeformed.
    pub initial: Option<Initial>,
}

/// The section of a body of bars or plane cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Section {
    /// Bars: axial force only.
    Bar(BarSection),
    /// Plane cells whose strain across the plane is zero.
    PlaneStrain(PlaneSection),
    /// Plane cells whose stress across the plane is zero.
    PlaneStress(PlaneSection),
    /// Plane cells that turn about the axis x = 0: x is the radius, y the axis. The whole turn is modelled.
    Axisymmetric(AxisymmetricSection),
}

/// Section of bars.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct BarSection {
    /// Area of the section.
    pub area: Area,
}

/// Section of plane cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PlaneSection {
    /// Thickness across the plane.
    pub thickness: Length,
}

/// Section of cells of revolution: nothing to give.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AxisymmetricSection {}

/// How the mass is distributed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Mass {
    /// Diagonal: the rows of the consistent matrix summed.
    #[default]
    Lumped,
    /// The matrix of the shape functions.
    Consistent,
}

/// State of a body at the beginning, the same at all its nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Initial {
    /// Velocity.
    pub velocity: Option<Vector<Velocity>>,
    /// Displacement from where the mesh stands.
    pub displacement: Option<Vector<Coordinate>>,
}

/// A support: displacements held at zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Support {
    /// Group whose nodes are held: a side, or the cells of a body.
    pub on: String,
    /// Directions held.
    #[schemars(extend("minItems" = 1, "uniqueItems" = true))]
    pub fix: Vec<Axis>,
}

/// A direction of the axes.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The first axis.
    X,
    /// The second axis.
    Y,
    /// The third axis.
    Z,
}

impl Axis {
    /// Component number, from 0.
    pub fn index(self) -> usize {
        match self {
            Axis::X => 0,
            Axis::Y => 1,
            Axis::Z => 2,
        }
    }
}

/// Loads on all bodies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Loads {
    /// Gravity on every body.
    pub gravity: Option<Gravity>,
}

/// A uniform field of acceleration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Gravity {
    /// Acceleration of free fall.
    pub acceleration: Vector<Acceleration>,
}
