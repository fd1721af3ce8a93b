//! The overlap of a shell and a solid: what stays of the shell, weights and rows.

use std::collections::BTreeSet;

use carom_mesh::ElementId;

use super::mediator::Mediator;
use super::model::{Prisms, ShellModels};
use super::rows::rows;
use super::section;
use crate::error::{Error, Model};
use crate::model::Cells;
use crate::overlap::{Models, Overlap, Region};
use crate::polytope::{cross, dot, sub};
use crate::rows::Rows;
use crate::weights::{CellWeights, Profile, Weighting, Weights};

/// The overlap S of a shell and a solid.
///
/// The solid has weight 1 outside S. The shell has weight 0 where it lies in the solid outside S; its cells there are removed.
#[derive(Clone, Debug)]
pub struct ShellOverlap {
    /// Cells that stay, of the inner and of the outer model, in the order in which they were given.
    pub cells: [Vec<ElementId>; 2],
    /// Weights of these cells, those of the shell at its nodes.
    pub weights: Weights,
    /// The rows of the coupling condition; a function of the mediator at a node has the components 0 to 2, and of 3 to 5 two.
    pub rows: Rows,
    /// Cells of the shell that fall away: inside the solid, outside S.
    pub removed: Vec<ElementId>,
    /// Cells that S touches, of both models, sorted.
    pub touched: Vec<ElementId>,
    /// Volume of S, m³.
    pub measure: f64,
    /// Least width of S, in cells of the coarser model.
    pub layers: f64,
    /// Mean size along the middle surface of the cells of the inner and of the outer model, m.
    pub sizes: [f64; 2],
}

impl ShellOverlap {
    /// The overlap of a shell and a solid in a region: a box, cells of either model, or everywhere.
    ///
    /// Errors: no cells, or unfit ones; a solid around the shell of another thickness, or beside its middle surface; a shell that has a fold
    /// or folds over in its thickness there; a solid that ends outside S; S narrower than a cell; a varying weight where a model does not end.
    pub fn new(
        models: &ShellModels,
        region: &Region,
        weighting: &Weighting,
    ) -> Result<ShellOverlap, Error> {
        models.check()?;
        let prisms = Prisms::new(models)?;
        let found = glued(models, &prisms, region, weighting);
        found.map_err(|error| named(error, models, &prisms))
    }
}

fn glued(
    models: &ShellModels,
    prisms: &Prisms,
    region: &Region,
    weighting: &Weighting,
) -> Result<ShellOverlap, Error> {
    let region = prisms.region(models, region);
    let solid = Cells::new(&prisms.mesh, Model::Inner, models.solid)?;
    section::check(models, prisms, &solid, &region)?;
    let both = Models {
        mesh: &prisms.mesh,
        inner: models.solid,
        outer: &prisms.cells,
    };
    let overlap = Overlap::of_any(both, &region)?;
    let back = |ids: &[ElementId]| -> Vec<ElementId> {
        ids.iter()
            .map(|&id| shell_cell(models, prisms, id))
            .collect()
    };
    let touched = [Model::Inner, Model::Outer].map(|model| {
        let cells = overlap.touched(model).into_iter();
        back(&cells.map(|(cell, _)| cell).collect::<Vec<_>>())
    });
    let inside: BTreeSet<ElementId> = touched[1].iter().copied().collect();
    let elements: Vec<usize> = (0..models.shell.len())
        .filter(|&e| inside.contains(&models.shell[e].cell))
        .collect();
    models.refuse_folds(&elements)?;
    let sizes = sizes(prisms, &overlap);
    let layers = layers(&overlap, sizes, &touched[1])?;
    let mediator = Mediator::new(models, prisms, &overlap, sizes[0])?;
    let rows = rows(models, prisms, &overlap, &mediator)?;
    let mut cells = [Model::Inner, Model::Outer].map(|model| back(overlap.cells(model)));
    let mut sizes = sizes;
    if models.shell_is == Model::Inner {
        cells.swap(0, 1);
        sizes.swap(0, 1);
    }
    let mut touched = touched.concat();
    touched.sort_unstable();
    Ok(ShellOverlap {
        cells,
        weights: weights(models, prisms, &overlap, weighting)?,
        rows: Rows {
            rows,
            slivers: Vec::new(),
        },
        removed: back(overlap.removed()),
        touched,
        measure: overlap.measure(),
        layers,
        sizes,
    })
}

/// The cell of the shell behind an extruded one; others are what they are.
fn shell_cell(models: &ShellModels, prisms: &Prisms, id: ElementId) -> ElementId {
    prisms
        .element(id)
        .map_or(id, |element| models.shell[element].cell)
}

/// An error of the extruded elements in terms of the shell.
fn named(error: Error, models: &ShellModels, prisms: &Prisms) -> Error {
    let back = |cells: Vec<ElementId>| -> Vec<ElementId> {
        let cells = cells.into_iter();
        cells.map(|id| shell_cell(models, prisms, id)).collect()
    };
    let own = |model: Model| match model {
        Model::Inner => models.solid_is(),
        Model::Outer => models.shell_is,
    };
    match error {
        Error::NotCovered { cells, least } => Error::NotCovered {
            cells: back(cells),
            least,
        },
        Error::EndsOutside { cells } => Error::SolidEndsOutside { cells },
        Error::Thin { layers, cells } => Error::Short {
            layers,
            cells: back(cells),
        },
        Error::NoBorder { model } => Error::NoEnd { model: own(model) },
        Error::InverseMap { cell } => Error::InverseMap {
            cell: shell_cell(models, prisms, cell),
        },
        other => other,
    }
}

/// Mean sizes along the middle surface of the cells of the solid and of the elements in S, m.
fn sizes(prisms: &Prisms, overlap: &Overlap) -> [f64; 2] {
    let mut seen = vec![false; overlap.side(Model::Inner).len()];
    let mut sums = [[0.0; 2]; 2];
    let mut add = |side: usize, size: f64| {
        sums[side][0] += size;
        sums[side][1] += 1.0;
    };
    for (place, prism) in overlap.side(Model::Outer).ids.iter().enumerate() {
        let Some(element) = prisms.element(*prism) else {
            continue;
        };
        let cell = prisms.cell(element);
        let x = cell.x();
        let along = sub(&x[1], &x[0]);
        let length = dot(&along, &along).sqrt();
        let first = along.map(|x| x / length);
        let up = sub(&x[x.len() / 2], &x[0]);
        let thickness = dot(&up, &up).sqrt();
        let second = cross(&up.map(|x| x / thickness), &first);
        let mut touched = false;
        for piece in overlap.pieces_of(Model::Outer, place) {
            let piece = &overlap.refinement.pieces[piece];
            let inner = piece.inner as usize;
            if piece.measure > 0.0 && !std::mem::replace(&mut seen[inner], true) {
                let solid = overlap.side(Model::Inner).cell(inner);
                add(0, (solid.extent(&first) * solid.extent(&second)).sqrt());
            }
            touched |= piece.measure > 0.0;
        }
        if touched {
            let triangle = if x.len() == 6 { 2.0 } else { 1.0 };
            add(1, (triangle * cell.measure() / thickness).sqrt());
        }
    }
    sums.map(|[sum, count]| sum / count)
}

/// Least width of S in cells of the coarser model.
fn layers(overlap: &Overlap, [solid, shell]: [f64; 2], cells: &[ElementId]) -> Result<f64, Error> {
    let layers = overlap.layers() * (shell / solid).min(1.0);
    match layers < 1.0 - 1e-6 {
        true => Err(Error::Short {
            layers,
            cells: cells.to_vec(),
        }),
        false => Ok(layers),
    }
}

/// The weights, those of the extruded elements averaged over their thickness.
fn weights(
    models: &ShellModels,
    prisms: &Prisms,
    overlap: &Overlap,
    weighting: &Weighting,
) -> Result<Weights, Error> {
    let swapped = models.shell_is == Model::Inner;
    let of_solid = |profile: Profile| match profile {
        Profile::Constant(value) if swapped => Profile::Constant(1.0 - value),
        profile => profile,
    };
    weighting.check()?;
    let mut weights = overlap.weights(&Weighting {
        inertia: of_solid(weighting.inertia),
        stiffness: of_solid(weighting.stiffness),
        floor: weighting.floor,
    })?;
    let counts = overlap.cells(Model::Outer).iter().map(|&prism| {
        let nodes = prisms.mesh.element_nodes(prism).len();
        nodes / 2
    });
    let counts: Vec<usize> = counts.collect();
    let middle = |values: &[f64]| {
        let (mut means, mut from) = (Vec::new(), 0);
        for &count in &counts {
            let own = &values[from..from + 2 * count];
            means.extend((0..count).map(|a| 0.5 * (own[a] + own[a + count])));
            from += 2 * count;
        }
        means
    };
    weights.outer = CellWeights {
        inertia: middle(&weights.outer.inertia),
        stiffness: middle(&weights.outer.stiffness),
    };
    for cell in &mut weights.flattened {
        *cell = shell_cell(models, prisms, *cell);
    }
    if swapped {
        std::mem::swap(&mut weights.inner, &mut weights.outer);
    }
    Ok(weights)
}
