//! Lengths that count as none.

use carom_mesh::{Bounds, ElementId};

use crate::model::Model;

/// Part of a length that counts as none.
const PART: f64 = 1e-12;

/// What counts as none of a length, m, in coordinates with this rounding (m).
pub(crate) fn tolerance(length: f64, rounding: f64) -> f64 {
    (PART * length).max(rounding)
}

/// The same of contacts.
pub(crate) struct Tolerances {
    whole: f64,
    /// Around each body.
    boxes: Vec<Bounds>,
}

impl Tolerances {
    pub(crate) fn new(model: &Model) -> Tolerances {
        let bodies = 0..model.bodies.len() + model.discrete.len();
        Tolerances {
            whole: tolerance(model.length(), model.mesh.rounding()),
            boxes: bodies
                .map(|body| bounds(model, cells(model, body)))
                .collect(),
        }
    }

    /// That of a contact which may touch these bodies. Where they have no extent, as a point mass before an obstacle, it is that of the model.
    pub(crate) fn of(&self, bodies: &[usize]) -> f64 {
        let around = bodies.iter().map(|&body| self.boxes[body]);
        let around = around.reduce(|one, other| one.union(&other));
        match around.map(|around| (around.diagonal(), around.reach())) {
            Some((length, reach)) if length > 0.0 && length.is_finite() => {
                tolerance(length, 2.0 * f64::EPSILON * reach)
            }
            _ => self.whole,
        }
    }
}

/// The box around some cells.
fn bounds(model: &Model, cells: &[ElementId]) -> Bounds {
    let nodes = cells
        .iter()
        .flat_map(|&cell| model.mesh.element_nodes(cell));
    let places = nodes.map(|&node| Bounds::of(&[model.mesh.nodes[node as usize]]));
    places.fold(Bounds::EMPTY, |around, place| around.union(&place))
}

/// Cells of a body of the system: discrete elements follow the bodies.
fn cells(model: &Model, body: usize) -> &[ElementId] {
    match body.checked_sub(model.bodies.len()) {
        None => &model.bodies[body].spec.cells,
        Some(place) => &model.discrete[place].spec.cells,
    }
}
