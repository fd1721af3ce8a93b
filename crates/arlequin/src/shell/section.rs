//! Whether the solid is around the middle surface of the shell, from one face to the other.

use carom_mesh::ElementId;

use super::model::{Prisms, ShellModels};
use crate::error::Error;
use crate::model::Cells;
use crate::overlap::Region;

/// Part of half the thickness by which a face of the solid may lie beside that of the shell: curved faces of two meshes differ.
const BESIDE: f64 = 0.1;
/// Places in the parent cells at which this is looked at.
const PLACES: [f64; 3] = [-0.8, 0.0, 0.8];
/// Step and reach of the search for the faces of a solid, in half thicknesses.
const STEP: f64 = 0.02;
const REACH: f64 = 4.0;

/// Refuses a solid in the region that is thicker or thinner than the shell, or lies beside its middle surface.
pub(super) fn check(
    models: &ShellModels,
    prisms: &Prisms,
    solid: &Cells,
    region: &Region,
) -> Result<(), Error> {
    let mut scratch = Vec::new();
    let mut locate = |x: &[f64; 3]| solid.locate(x, &mut scratch);
    let (mut first_found, mut unfit) = (None, Vec::new());
    for (element, shell) in models.shell.iter().enumerate() {
        let prism = prisms.cell(element);
        for [r, s] in places(shell.x.len()) {
            let mut at = |height: f64| locate(&prism.point(&[r, s, height]));
            let inside = [-0.5, 0.0, 0.5].map(&mut at);
            let Some(first) = inside.iter().flatten().next() else {
                continue;
            };
            let pair = (prisms.cells[element], solid.ids[*first]);
            if !counts(region, pair, &prism.point(&[r, s, 0.0])) {
                continue;
            }
            let within = [-1.0 + BESIDE, 0.0, 1.0 - BESIDE].map(|height| at(height).is_some());
            let beyond = [-1.0 - BESIDE, 1.0 + BESIDE].map(|height| at(height).is_some());
            if within == [true; 3] && beyond == [false; 2] {
                continue;
            }
            let half = 0.5 * shell.thickness;
            let mut measured =
                || extent(&mut |height| at(height).is_some()).map(|height| half * height);
            first_found.get_or_insert_with(|| (measured(), half));
            unfit.push(shell.cell);
            break;
        }
    }
    match first_found {
        None => Ok(()),
        Some((found, expected)) => Err(Error::Thickness {
            found,
            expected,
            cells: unfit,
        }),
    }
}

/// Places in the parent cell of an element of three or four nodes.
fn places(nodes: usize) -> Vec<[f64; 2]> {
    let grid = PLACES.iter().flat_map(|&r| PLACES.map(|s| [r, s]));
    match nodes {
        3 => vec![[0.1, 0.1], [0.8, 0.1], [0.1, 0.8], [1.0 / 3.0, 1.0 / 3.0]],
        _ => grid.collect(),
    }
}

/// Whether a place in an extruded element and a cell of the solid belongs to a region.
fn counts(region: &Region, (prism, solid): (ElementId, ElementId), x: &[f64; 3]) -> bool {
    match region {
        Region::Intersection => true,
        Region::Cells(cells) => {
            let has = |cell| cells.binary_search(cell).is_ok();
            has(&prism) || has(&solid)
        }
        Region::Box { min, max } => (0..3).all(|i| x[i] >= min[i] && x[i] <= max[i]),
    }
}

/// Least and largest height at which the solid is, in half thicknesses.
fn extent(is_in: &mut dyn FnMut(f64) -> bool) -> [f64; 2] {
    let steps = (REACH / STEP) as i32;
    let mut found = [f64::NAN; 2];
    for height in (-steps..=steps).map(|k| STEP * f64::from(k)) {
        if is_in(height) {
            found = [found[0].min(height), height];
        }
    }
    found
}
