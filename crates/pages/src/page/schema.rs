//! What the head of a page says. Lengths in m, times in s, all else in the unit that stands beside it.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::page::block::Array;

/// The version of what is written here; `report/src/data.js` has the same.
pub const SCHEMA: u32 = 4;

/// The head of a page.
#[derive(Debug, Serialize)]
pub struct Page {
    /// [`SCHEMA`].
    pub schema: u32,
    /// Name and unit of what plots are drawn over: time, or the pseudo-time of a static run.
    pub abscissa: Quantity,
    /// Time at which the dynamics begin, s: plots over time show what follows at first.
    pub begin: f64,
    /// Time reached, s.
    pub end: f64,
    /// Instants that every plot over time marks.
    pub events: Vec<Event>,
    /// The plots in their order.
    pub plots: Vec<Plot>,
    /// Statuses of the contact points; none without contacts.
    pub raster: Option<Raster>,
    /// The model; none where nothing can be drawn.
    pub model: Option<Model>,
}

/// A quantity with its unit.
#[derive(Clone, Debug, Serialize)]
pub struct Quantity {
    /// In words.
    pub name: String,
    /// SI, empty of a bare number.
    pub unit: &'static str,
}

/// An instant with a name.
#[derive(Clone, Debug, Serialize)]
pub struct Event {
    /// s.
    pub time: f64,
    /// In words.
    pub name: String,
}

/// A plot.
#[derive(Debug, Serialize)]
pub struct Plot {
    /// The section of the page in which it stands.
    pub id: &'static str,
    /// Over it.
    pub title: String,
    /// `time` or `frequency`.
    pub abscissa: &'static str,
    /// What is plotted, for the axis.
    pub quantity: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// `linear`, `logarithmic` (of magnitudes), or `double logarithmic`.
    pub scale: &'static str,
    /// The value below which a band says "rounding".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounding: Option<f64>,
    /// Whether it is drawn only when its section is opened further.
    pub folded: bool,
    /// The curves.
    pub curves: Vec<Curve>,
    /// A sentence under the plot.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// A curve of a plot.
#[derive(Debug, Serialize)]
pub struct Curve {
    /// In the legend.
    pub name: String,
    /// `computed`, `exact`, `filtered`, or `instants` for single values.
    pub role: &'static str,
    /// Whether it is drawn only when its name is clicked.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub hidden: bool,
    /// Abscissae, ascending; two equal ones are a jump.
    pub x: Array,
    /// Ordinates.
    pub y: Array,
}

/// Statuses of contact points over time, row after row, column after column: bits 1 some point was open, 2 some was closed, 4 some slipped.
#[derive(Debug, Serialize)]
pub struct Raster {
    /// The section of the page.
    pub id: &'static str,
    /// Equal parts of the time from `begin` to `end`.
    pub columns: usize,
    /// Time at the start of the first one, s.
    pub begin: f64,
    /// Time at the end of the last one, s.
    pub end: f64,
    /// The contacts with their rows.
    pub contacts: Vec<RasterRows>,
    /// The rows.
    pub cells: Array,
    /// What a row is.
    pub note: String,
}

/// The rows of a contact.
#[derive(Debug, Serialize)]
pub struct RasterRows {
    /// Name of the contact.
    pub name: String,
    /// Rows.
    pub rows: usize,
    /// Contact points.
    pub points: usize,
}

/// The model: what is seen of the mesh, and its motion at the instants that the run kept. Nodes and cells are numbered from 0 in here.
#[derive(Debug, Serialize)]
pub struct Model {
    /// Dimension of space.
    pub dimension: usize,
    /// Whether the other half of a section through the y axis is to be drawn too.
    pub axisymmetric: bool,
    /// Number of nodes.
    pub nodes: usize,
    /// Nodes of the surface of the mesh, if only a part of them is in the page.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decimated_from: Option<usize>,
    /// Reference places, three to each node.
    pub x: Array,
    /// Numbers of the nodes in the mesh.
    pub numbers: Array,
    /// Body of each node.
    pub body_of_node: Array,
    /// Body of each cell.
    pub body_of_cell: Array,
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// Corners of triangles, three to each.
    pub triangles: Array,
    /// Cell of each triangle.
    pub triangle_cells: Array,
    /// Ends of the edges of cells.
    pub edges: Array,
    /// Ends of bars, beams and springs.
    pub lines: Array,
    /// Cell of each of these.
    pub line_cells: Array,
    /// Nodes drawn as dots.
    pub points: Array,
    /// Names of the zones, and zone of each body; empty without zones.
    pub zones: Vec<String>,
    /// See `zones`.
    pub zone_of_body: Vec<usize>,
    /// Fields that never change, one value to each cell, by the `id` in `fields`.
    pub constants: BTreeMap<&'static str, Array>,
    /// Surfaces of the contacts.
    pub contacts: Vec<Sides>,
    /// Groups of the mesh.
    pub groups: Vec<Group>,
    /// Rigid obstacles.
    pub obstacles: Vec<Obstacle>,
    /// What acts on the model, with names.
    pub signs: Vec<Sign>,
    /// Fields beside the displacement.
    pub fields: Vec<Field>,
    /// The instants, ascending.
    pub frames: Vec<Frame>,
}

/// Both surfaces of a contact.
#[derive(Debug, Serialize)]
pub struct Sides {
    /// Name of the contact.
    pub name: String,
    /// Secondary side.
    pub secondary: Side,
    /// Primary side; empty if it is an obstacle.
    pub primary: Side,
}

/// A surface.
#[derive(Debug, Serialize)]
pub struct Side {
    /// Corners of triangles.
    pub triangles: Array,
    /// Ends of lines.
    pub lines: Array,
}

/// A group of the mesh: of cells their part of the surface.
#[derive(Debug, Serialize)]
pub struct Group {
    /// In the mesh.
    pub name: String,
    /// Corners of triangles.
    pub triangles: Array,
    /// Ends of lines.
    pub lines: Array,
}

/// A rigid obstacle at time 0.
#[derive(Debug, Serialize)]
pub struct Obstacle {
    /// Name of its contact.
    pub name: String,
    /// Places of the corners of triangles, nine numbers to each.
    pub triangles: Array,
    /// Places of the ends of lines, six numbers to each.
    pub lines: Array,
}

/// A support, load, mass, link of two nodes, body or contact: a mark at its nodes and a name.
#[derive(Debug, Serialize)]
pub struct Sign {
    /// `support`, `load`, `mass`, `link` (a spring, dashpot or bolt), `body` or `contact`.
    pub what: &'static str,
    /// Kind and name.
    pub label: String,
    /// Nodes of the page; of a link in pairs.
    pub nodes: Array,
    /// Direction of the force of a load at each node, three numbers; empty of all else.
    pub ways: Array,
}

/// A field.
#[derive(Clone, Debug, Serialize)]
pub struct Field {
    /// Key of its arrays.
    pub id: &'static str,
    /// In words.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// `node` or `cell`.
    pub on: &'static str,
    /// Whether its sign matters: its colours are symmetric about zero.
    pub signed: bool,
}

/// The largest value of a field at cells, which may be inside of the model.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Peak {
    /// In the unit of the field.
    pub value: f64,
    /// Middle of the cell in the reference configuration, m.
    pub place: [f64; 3],
    /// Displacement of the middle, m.
    pub moved: [f64; 3],
}

/// An instant.
#[derive(Debug, Serialize)]
pub struct Frame {
    /// s.
    pub time: f64,
    /// Why it was kept.
    pub kinds: Vec<&'static str>,
    /// Displacement of each body that `moved` counts from.
    pub offsets: Vec<[f64; 3]>,
    /// Displacements along the three axes, beyond those of the bodies.
    pub moved: [Array; 3],
    /// The fields that change, by their `id`; `status`: 0 no contact point, 1 open, 2 closed, 3 slipping.
    pub values: BTreeMap<&'static str, Array>,
    /// The largest values among all cells of the model, by the `id` of the field.
    pub largest: BTreeMap<&'static str, Peak>,
    /// The upper three rows of the matrix of each obstacle, empty if none moves.
    pub poses: Vec<[f64; 12]>,
    /// Whether each triangle is there; none if all are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub visible: Option<Array>,
}
