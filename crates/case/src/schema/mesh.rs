//! `[mesh]`: files and generated parts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Named, NormalVector};
use carom_quantities::{Angle, Coordinate, Length, Vector};

/// The mesh: a file, parts from further files, generated parts. Groups of the file keep their names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("anyOf" = [{ "required": ["file"] }, { "required": ["part"] }, { "required": ["generate"] }], "dependentRequired" = { "unit": ["file"] }))]
pub struct Mesh {
    /// Path of a Gmsh file (MSH 2.2 or 4.1, ASCII or binary), of one of Abaqus or CalculiX (`.inp`), of a surface of triangles (`.stl`), of an unstructured grid of VTK (`.vtu`), or of a mesh of Salome and code_aster (`.med`, of a Carom built with `--features hdf5`), from the folder of the case file. Its physical
    /// groups, or its sets and surfaces, are the names that bodies, supports, contacts and probes use.
    pub file: Option<String>,
    /// Unit of the coordinates in `file`.
    #[serde(default)]
    pub unit: LengthUnit,
    /// Dimension of the space, where it is more than that of the coordinates: nodes that all lie on the x axis make a mesh of one
    /// dimension, in which nothing bends. Default: the number of axes along which coordinates of the file differ from zero, or
    /// that points of generated parts have.
    #[schemars(extend("minimum" = 1, "maximum" = 3))]
    pub dimension: Option<u32>,
    /// Number of uniform refinements. Each divides every element by two in each of its directions: two refinements make
    /// 16 elements of a quadrilateral, 64 of a hexahedron. Groups keep their names; curved borders keep the shape of
    /// the coarse mesh. For linear elements except wedges and pyramids.
    #[serde(default)]
    #[schemars(extend("minimum" = 0, "maximum" = 10))]
    pub refine: u32,
    /// Parts from files of their own, each placed where it belongs; a file may serve several parts. The group `g` of the part `a` is called `a.g`.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub part: Named<Placed>,
    /// Generated parts. The part `a` has a group `a` of its cells, and groups of its sides: `a.left` and `a.right` (ends in x),
    /// `a.bottom` and `a.top` (in y in two dimensions, in z in three), `a.front` and `a.back` (in y in three dimensions).
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub generate: Named<Part>,
}

impl Mesh {
    /// Whether nothing is given.
    pub fn is_empty(&self) -> bool {
        *self == Mesh::default()
    }
}

/// A unit of length, such as `"mm"`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LengthUnit(pub String);

impl Default for LengthUnit {
    fn default() -> LengthUnit {
        LengthUnit("m".to_owned())
    }
}

impl JsonSchema for LengthUnit {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "LengthUnit".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "string", "x-length-unit": true, "x-example": "mm" })
    }
}

/// A part from a file: its coordinates times their unit and `scale`, then turned, then moved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Placed {
    /// Path of the file, as `mesh.file`.
    pub file: String,
    /// Unit of its coordinates.
    #[serde(default)]
    pub unit: LengthUnit,
    /// Factor of its coordinates. Default: 1.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub scale: Option<f64>,
    /// Rotation about an axis through the origin of the file.
    pub turn: Option<PartTurn>,
    /// Translation.
    pub shift: Option<Vector<Coordinate>>,
}

/// A rotation of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PartTurn {
    /// Angle, counter-clockwise for who looks against the axis.
    pub angle: Angle,
    /// Direction of the axis, of any length except zero. Default: that of z.
    pub axis: Option<NormalVector>,
}

/// A generated part: one shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// Bars along a straight line.
    Line(Line),
    /// A rectangle in the plane: x to the right, y up.
    Rectangle(Rectangle),
    /// A box: x to the right, y to the back, z up.
    Box(BoxPart),
}

/// Bars of equal length along a straight line, in as many dimensions as its points have components.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Line {
    /// First point: the side `left`.
    pub from: Vector<Coordinate>,
    /// Last point: the side `right`. As many components as `from`.
    pub to: Vector<Coordinate>,
    /// Number of elements.
    pub elements: Count,
}

/// A rectangle of quadrilaterals, or of triangles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Rectangle {
    /// Corner of least x and y.
    pub origin: [Coordinate; 2],
    /// Extent in x and y.
    pub size: [Length; 2],
    /// Number of quadrilaterals along x and y.
    pub elements: [Count; 2],
    /// Cuts every quadrilateral into two triangles.
    #[serde(default)]
    pub triangles: bool,
}

/// A box of hexahedra, or of tetrahedra.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct BoxPart {
    /// Corner of least x, y and z.
    pub origin: [Coordinate; 3],
    /// Extent in x, y and z.
    pub size: [Length; 3],
    /// Number of hexahedra along x, y and z.
    pub elements: [Count; 3],
    /// Cuts every hexahedron into tetrahedra.
    #[serde(default)]
    pub tetrahedra: bool,
}

/// A number of elements along one direction, 1 or more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Count(pub usize);

impl JsonSchema for Count {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Count".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "integer", "minimum": 1, "maximum": 10_000_000 })
    }
}
