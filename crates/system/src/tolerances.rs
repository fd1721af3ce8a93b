//! Lengths that count as none.

use carom_mesh::{Bounds, ElementId};

use crate::model::Model;

/// Part of a length that counts as none.
const PART: f64 = 1e-12;

/// What counts as none of a length, m, in coordinates with this rounding (m).
pub(crate) fn tolerance(length: f64, rounding: f64) -> f64 {
    (PART * length).max(rounding)
}

/// The same of each contact: of the bodies that it may touch, by number. Where these have no extent, as a point mass before an obstacle, it is that of the model.
pub(crate) fn tolerances(model: &Model, touching: &[Vec<usize>]) -> Vec<f64> {
    let whole = tolerance(model.length(), model.mesh.rounding());
    let boxes: Vec<Bounds> = (0..model.bodies.len() + model.discrete.len())
        .map(|body| bounds(model, cells(model, body)))
        .collect();
    let of = |bodies: &Vec<usize>| {
        let around = bodies.iter().map(|&body| boxes[body]);
        let around = around.reduce(|one, other| one.union(&other));
        match around.map(|around| (around.diagonal(), around.reach())) {
            Some((length, reach)) if length > 0.0 && length.is_finite() => {
                tolerance(length, 2.0 * f64::EPSILON * reach)
            }
            _ => whole,
        }
    };
    touching.iter().map(of).collect()
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
