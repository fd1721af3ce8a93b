//! `[body]` and `[support]`: what moves, and what holds it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::axis::Axis;
use super::beam::{BeamSection, Rotations};
use super::explicit::{BulkViscosity, Deletion, MassScaling};
use super::joint::Hinge;
use super::obstacle::NormalVector;
use carom_quantities::{
    Angle, AngularVelocity, Area, Coordinate, Delay, Frequency, Length, MomentOfInertia, Rate,
    Vector, Velocity, Weight,
};

/// A body: cells of the mesh, with a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Body {
    /// Group of the cells.
    pub region: String,
    /// Name of a material of this file.
    pub material: String,
    /// Section of bars, beams, shells or plane cells: required for all of these, refused for solids.
    pub section: Option<Section>,
    /// Mass matrix. Default: lumped; of beams and shells consistent, where the scheme takes it.
    pub mass: Option<Mass>,
    /// Integration of the internal work of its cells.
    #[serde(default)]
    pub formulation: Formulation,
    /// Damping, of Rayleigh or of modes. Default: none.
    pub damping: Option<Damping>,
    /// Hinges of beams. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hinges: Vec<Hinge>,
    /// Solids about which this body of beams or shells turns freely where it shares nodes with them. A solid has no rotations, so that without this key such a
    /// hinge is refused. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("uniqueItems" = true))]
    pub hinged_to: Vec<String>,
    /// Makes the body rigid: its cells keep their shape, and it moves as one. Default: deformable.
    pub rigid: Option<Rigid>,
    /// Reduces the body to the nodes on which something acts and to modes, for a material at small strain. Default: not reduced.
    pub reduction: Option<Reduction>,
    /// Bulk viscosity. Default: none.
    pub bulk_viscosity: Option<BulkViscosity>,
    /// Mass scaling, for explicit schemes. Default: none.
    pub mass_scaling: Option<MassScaling>,
    /// Deletion of cells that have flowed too far, for explicit schemes. Default: none.
    pub deletion: Option<Deletion>,
    /// Initial state. After a static stage the velocity applies at the end of that stage. Default: at rest, undeformed.
    pub initial: Option<Initial>,
    /// Whether the body waits for the dynamics: over a static stage all of it is held where it is, as by a support. Not of a reduced body.
    #[serde(default)]
    pub hold: bool,
}

/// A body reduced to nodes and modes. It retains the nodes of contacts, stops, links, constraints, loads and motions, those that it shares with other
/// bodies and discrete elements, and those of `retain`. Supports are part of the reduction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Reduction {
    /// Number of modes.
    #[schemars(extend("minimum" = 1))]
    pub modes: u32,
    /// Groups whose nodes are retained as well.
    #[serde(default)]
    pub retain: Vec<String>,
    /// Whether the retained nodes have no mass, so that they do not vibrate against what they touch. Default: they have mass.
    #[serde(default)]
    pub massless: bool,
    /// Damping ratio of the modes, beside `damping`. Default: 0.
    #[serde(default)]
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub damping_ratio: f64,
    /// File in which the reduction is kept, relative to the case file. It is read where it follows from the same body and options, made
    /// anew and saved there where it does not, or where the file does not exist. Default: it is made for each run.
    pub file: Option<String>,
}

/// How cells integrate the internal work.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Formulation {
    /// By its name.
    Named(FormulationName),
    /// With parameters.
    With(FormulationWith),
}

impl Default for Formulation {
    fn default() -> Formulation {
        Formulation::Named(FormulationName::Full)
    }
}

/// How cells integrate the internal work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FormulationName {
    /// All points of the stiffness rule.
    Full,
    /// One volume ratio for the whole cell, against volumetric locking. For materials at finite strain.
    MeanDilatation,
}

/// How cells integrate the internal work, with parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FormulationWith {
    /// One-point integration with a stiffness against hourglass modes. For 4-node quadrilaterals and 8-node hexahedra
    /// of materials at finite strain, and for quadrilaterals of shells with finite rotations.
    Reduced(Reduced),
}

/// Reduced integration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Reduced {
    /// Factor of the stiffness against hourglass modes; of shells relative to that of full integration in a parallelogram. Default: 1 for
    /// shells of an elastic material, which then bend in their plane as with full integration; 0.05 for shells of a metal, whose
    /// stiffness against hourglass modes does not flow with it, and for cells of solids.
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))]
    pub hourglass: Option<f64>,
}

/// A rigid body. What is left out is that of its cells with the density of its material.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Rigid {
    /// Mass. Without `inertia` the moments of inertia of the cells grow with it.
    pub mass: Option<Weight>,
    /// Moments of inertia about the centre of mass: three about the axes of coordinates, or one about z in the plane.
    #[schemars(extend("minItems" = 1, "maxItems" = 3))]
    pub inertia: Option<Vec<MomentOfInertia>>,
    /// Centre of mass.
    pub centre: Option<Vector<Coordinate>>,
}

/// Damping: the damping matrix is `mass` times the mass matrix plus `stiffness` times the stiffness matrix, plus what `modal` gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Damping {
    /// Factor of the mass matrix. It also damps rigid motion. Default: 0.
    pub mass: Option<Rate>,
    /// Factor of the stiffness matrix; for materials at small strain. Default: 0.
    pub stiffness: Option<Delay>,
    /// Damping ratios of modes of the body, which has small strain and is not reduced. Default: none.
    pub modal: Option<ModalDamping>,
}

/// Damping ratios of the modes of a body by itself with its supports: `ratios` of the lowest modes, or one `ratio` of all modes `below` a
/// frequency. Other modes and rigid motions are not damped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "oneOf" = [{ "required": ["ratios"] }, { "required": ["ratio"] }],
    "dependentRequired" = { "below": ["ratio"], "ratio": ["below"] },
))]
pub struct ModalDamping {
    /// Ratio of each of the lowest modes that are no rigid motions.
    #[schemars(extend("minItems" = 1, "items" = { "type": "number", "minimum": 0.0, "maximum": 1.0 }))]
    pub ratios: Option<Vec<f64>>,
    /// Ratio of all modes below `below`.
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub ratio: Option<f64>,
    /// Frequency up to which modes are damped.
    pub below: Option<Frequency>,
}

/// The section of a body of bars, beams or plane cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Section {
    /// Bars: axial force only, of an elastic material or of a metal: `j2`, `j2-table`, `johnson-cook`.
    Bar(BarSection),
    /// Beams: extension, shear, bending and torsion, with rotations of the nodes, of an elastic material or of a metal: `j2`, `j2-table`,
    /// `johnson-cook`. Metal flows in extension and bending; shear and torsion stay elastic.
    Beam(Box<BeamSection>),
    /// Plates and shells in space, of triangles of three nodes and quadrilaterals of four: membrane, bending and shear, with rotations of the
    /// nodes. Of an elastic material or of a metal: `j2`, `j2-table`, `johnson-cook`, which flows in membrane and bending; shear across stays elastic.
    Shell(Box<ShellSection>),
    /// Plane cells whose strain across the plane is zero.
    PlaneStrain(PlaneSection),
    /// Plane cells whose stress across the plane is zero.
    PlaneStress(PlaneSection),
    /// Axisymmetric cells: x is the radius, y is along the axis x = 0. The model is the full circumference.
    Axisymmetric(AxisymmetricSection),
}

/// Section of bars.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct BarSection {
    /// Area of the section.
    pub area: Area,
}

/// Section of plates and shells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ShellSection {
    /// Thickness; with `taper` that before it. Required without `plies` and `nodal-thickness`.
    pub thickness: Option<Length>,
    /// Thickness at the nodes from a text file, in place of `thickness`; linear between them.
    pub nodal_thickness: Option<ThicknessColumns>,
    /// Change of the thickness along an axis, linear between nodes. Default: none.
    pub taper: Option<ShellTaper>,
    /// Layers of several materials, in the order in which the normal of the cells passes them, in place of `thickness`; metal has two points in each. Default: one
    /// material.
    #[schemars(extend("minItems" = 1))]
    pub plies: Option<Vec<ShellPly>>,
    /// Middle surface from the nodes, along the normal of the cells. Default: in the nodes.
    pub offset: Option<Coordinate>,
    /// How far the nodes turn.
    #[serde(default)]
    pub rotations: Rotations,
    /// Layers through the thickness of a metal that flows, an even number; each has two points. Default: 4.
    #[schemars(extend("minimum" = 2, "maximum" = 50))]
    pub layers: Option<u32>,
}

/// Thickness along an axis: constant before `from` and beyond `to`, linear between.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ShellTaper {
    /// Direction of the axis through the origin, of any length except zero.
    pub along: NormalVector,
    /// Coordinate along the axis up to which the section has its `thickness`.
    pub from: Coordinate,
    /// Coordinate along the axis from which it has that of the taper, above `from`.
    pub to: Coordinate,
    /// Thickness beyond `to`.
    pub thickness: Length,
}

/// Columns of a text file with the thickness at places of nodes, as in signals. Each node of the body has a line; others are left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ThicknessColumns {
    /// Path of the file, from the folder of the case file.
    pub file: String,
    /// Columns of the coordinates of the node.
    pub place: [String; 3],
    /// Column of the thickness.
    pub thickness: String,
    /// Unit of the coordinates, if the columns do not say it. Default: m.
    pub place_unit: Option<String>,
    /// Unit of the thickness, if the column does not say it. Default: m.
    pub unit: Option<String>,
}

/// A layer of one material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ShellPly {
    /// Thickness.
    pub thickness: Length,
    /// Name of a material of this file. Default: that of the body.
    pub material: Option<String>,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Mass {
    /// Diagonal: the row sums of the consistent matrix for linear elements, its scaled diagonal for quadratic elements and for
    /// bending.
    Lumped,
    /// The consistent mass matrix of the shape functions.
    Consistent,
}

/// Initial state of a body, the same at all its nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Initial {
    /// Velocity.
    pub velocity: Option<Vector<Velocity>>,
    /// Displacement from the position of the mesh.
    pub displacement: Option<Vector<Coordinate>>,
    /// Angular velocity about the axes of coordinates: three components, or one about z in the plane. Of rigid bodies, and about their
    /// centre of mass of bodies at finite strain and beams with finite rotations.
    pub spin: Option<Vector<AngularVelocity>>,
}

/// A support: displacements held at zero, or moved as prescribed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("anyOf" = [{ "required": ["fix"] }, { "required": ["move"] }]))]
pub struct Support {
    /// Group whose nodes are held: a side, or the cells of a body.
    pub on: String,
    /// Directions in which the nodes are held; `rx`, `ry`, `rz` are rotations: of nodes of beams and shells about x, y, z, of rigid bodies
    /// about the principal axes of inertia nearest to x, y, z.
    #[serde(default)]
    #[schemars(extend("minItems" = 1, "uniqueItems" = true))]
    pub fix: Vec<Axis>,
    /// Directions in which the nodes move as prescribed.
    #[serde(rename = "move")]
    pub motion: Option<Movement>,
}

/// Displacements as functions of time: names of signals, or points, linear between them, constant before the first and after the
/// last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("anyOf" = [{ "required": ["x"] }, { "required": ["y"] }, { "required": ["z"] }, { "required": ["rx"] }, { "required": ["ry"] }, { "required": ["rz"] }]))]
pub struct Movement {
    /// Displacement along the first axis. Default: free.
    pub x: Option<MovementCourse>,
    /// Displacement along the second axis. Default: free.
    pub y: Option<MovementCourse>,
    /// Displacement along the third axis. Default: free.
    pub z: Option<MovementCourse>,
    /// Rotation of a rigid body about its first axis, of nodes of beams and shells about x. Default: free.
    pub rx: Option<Vec<TurnPoint>>,
    /// Rotation of a rigid body about its second axis, of nodes of beams and shells about y. Default: free.
    pub ry: Option<Vec<TurnPoint>>,
    /// Rotation of a rigid body about its third axis, of nodes of beams and shells about z; the only one in the plane. Default: free.
    pub rz: Option<Vec<TurnPoint>>,
}

/// A displacement as a function of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum MovementCourse {
    /// By the name of a signal, of a displacement or of an acceleration.
    Signal(String),
    /// By points.
    #[schemars(extend("minItems" = 1))]
    Points(Vec<MovementPoint>),
}

/// A point of a rotation as a function of time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TurnPoint {
    /// Time.
    pub time: Delay,
    /// Angle at that time.
    pub angle: Angle,
}

/// A point of a displacement as a function of time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct MovementPoint {
    /// Time.
    pub time: Delay,
    /// Displacement at that time.
    pub displacement: Coordinate,
}
