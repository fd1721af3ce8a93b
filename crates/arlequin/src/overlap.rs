//! The overlap of two models: region, pieces, borders, cells that fall away.

use std::collections::BTreeSet;

use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh};

use crate::border::Border;
use crate::error::{Error, Model};
use crate::model::Cells;
use crate::polytope::{Plane, dot};
use crate::refine::{Piece, Refinement};

/// A cell that is this much inside the other model is inside: meshes of one curved body differ near its surface.
const INSIDE: f64 = 0.95;
/// Fraction of a cell's measure below which the overlap does not touch it.
const TOUCHED: f64 = 1e-9;
/// Two models of overlapping parts of one body. Their cells are in one mesh but share no node.
#[derive(Clone, Copy, Debug)]
pub struct Models<'a> {
    /// The mesh of both. Cells fill its space: bars in one dimension, plane cells in two, solids in three.
    pub mesh: &'a Mesh,
    /// Cells of the impact zone, the finer model.
    pub inner: &'a [ElementId],
    /// Cells of the rest, the coarser model; it may cover the whole body.
    pub outer: &'a [ElementId],
}

/// Where two models are coupled: the part of what they have in common that lies in a region.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// In some cells of either model.
    Cells(Vec<ElementId>),
    /// In a box with sides along the axes, in m; components beyond the dimension of the mesh do not count.
    Box {
        /// Least coordinates.
        min: [f64; 3],
        /// Largest coordinates.
        max: [f64; 3],
    },
    /// Everywhere.
    Intersection,
}

/// The overlap S of two models, ready for weights and rows.
///
/// The inner model has weight 1 outside S. The outer one has weight 0 where it lies in the inner model outside S; its
/// cells that lie there altogether are [removed](Overlap::removed).
#[derive(Clone, Debug)]
pub struct Overlap<'a> {
    pub(crate) refinement: Refinement<'a>,
    /// Cells of the region, where it is a group.
    pub(crate) group: Option<BTreeSet<ElementId>>,
    /// Pieces by cell of each model: offsets, then indices of pieces.
    pub(crate) by_inner: (Vec<usize>, Vec<u32>),
    pub(crate) by_outer: (Vec<usize>, Vec<u32>),
    /// Connected parts of S; the part of each piece.
    pub(crate) parts: Vec<Borders>,
    pub(crate) part_of: Vec<u32>,
    removed: Vec<ElementId>,
    pub(crate) sizes: [f64; 2],
    pub(crate) layers: f64,
}

/// The two borders of a connected part of S.
#[derive(Clone, Debug)]
pub(crate) struct Borders {
    /// Where the inner model ends inside the outer one.
    pub inner_end: Option<Border>,
    /// Where the outer model (or its weight) ends inside the inner one.
    pub outer_end: Option<Border>,
}

impl<'a> Overlap<'a> {
    /// The overlap of two models in a region.
    ///
    /// Meshes may be nested or not. Cells are intersected exactly where they are straight; a hexahedron with warped
    /// faces that is cut is taken as 24 tetrahedra around its centre, which fills the same volume and leaves gaps of
    /// second order in the warp to the true faces.
    ///
    /// Errors: a model without cells or with unfit ones; a node of both; no volume in common; a cell of the group not
    /// covered (below 95 %) by the other model; the inner model ends inside the outer one outside S; S thinner than one
    /// cell of the outer model.
    pub fn new(models: Models<'a>, region: &Region) -> Result<Overlap<'a>, Error> {
        refuse_kinds(&models)?;
        Overlap::of_any(models, region)
    }

    /// The same of cells of any kind, which count with straight edges where they are cut.
    pub(crate) fn of_any(models: Models<'a>, region: &Region) -> Result<Overlap<'a>, Error> {
        let inner = Cells::new(models.mesh, Model::Inner, models.inner)?;
        let outer = Cells::new(models.mesh, Model::Outer, models.outer)?;
        refuse_shared_nodes(&inner, &outer)?;
        let group = match region {
            Region::Cells(cells) => Some(cells.iter().copied().collect()),
            _ => None,
        };
        let sides = box_sides(region, models.mesh.dim);
        let full = Refinement::new(inner, outer, sides, |i, o| in_group(&group, (i, o)));
        if !full.pieces.iter().any(|piece| piece.measure > 0.0) {
            return Err(Error::Empty);
        }
        if let Some(group) = &group {
            refuse_uncovered(&full, group)?;
        }
        let (refinement, removed) = without_inside_cells(full)?;
        let mut overlap = Overlap {
            by_inner: grouped(refinement.inner.len(), &refinement.pieces, |p| p.inner),
            by_outer: grouped(refinement.outer.len(), &refinement.pieces, |p| p.outer),
            refinement,
            group,
            parts: Vec::new(),
            part_of: Vec::new(),
            removed,
            sizes: [0.0; 2],
            layers: f64::INFINITY,
        };
        overlap.sizes = [Model::Inner, Model::Outer].map(|model| overlap.mean_length(model));
        overlap.find_borders();
        overlap.refuse_end_outside()?;
        overlap.measure_layers()?;
        Ok(overlap)
    }

    /// The mesh of both models.
    pub fn mesh(&self) -> &'a Mesh {
        self.refinement.inner.mesh
    }

    /// Cells of a model that stay, in the order in which they were given.
    pub fn cells(&self, model: Model) -> &[ElementId] {
        &self.side(model).ids
    }

    /// Cells of the outer model that fall away: inside the inner model, outside S.
    pub fn removed(&self) -> &[ElementId] {
        &self.removed
    }

    /// Measure of S, in m, m² or m³.
    pub fn measure(&self) -> f64 {
        self.refinement
            .pieces
            .iter()
            .map(|piece| piece.measure)
            .sum()
    }

    /// Mean size in m of the cells of a model in S: the edge of a cube, or of the corner of a cube, of their mean
    /// measure.
    pub fn size(&self, model: Model) -> f64 {
        self.sizes[model as usize]
    }

    /// The model with the larger cells in S; the outer one if they are equal.
    pub fn coarser(&self) -> Model {
        match self.sizes[0] > (1.0 + 1e-9) * self.sizes[1] {
            true => Model::Inner,
            false => Model::Outer,
        }
    }

    /// Least thickness of S between its borders, in cells of the outer model; infinite without two borders.
    pub fn layers(&self) -> f64 {
        self.layers
    }

    /// Whether both borders of each connected part of S are plane and parallel: then linear weights are affine on S,
    /// and a field of constant strain passes the coupling to round-off.
    pub fn is_strip(&self) -> bool {
        self.parts.iter().all(|borders| {
            let plane = |border: &Option<Border>| border.as_ref().and_then(|b| b.plane);
            match (plane(&borders.inner_end), plane(&borders.outer_end)) {
                (Some(a), Some(b)) => (dot(&a.normal, &b.normal).abs() - 1.0).abs() < 1e-12,
                _ => false,
            }
        })
    }

    /// The cells of a model that S touches, ascending in its order, each with the fraction of it in S.
    pub fn touched(&self, model: Model) -> Vec<(ElementId, f64)> {
        let side = self.side(model);
        let fractions = (0..side.len()).map(|i| (side.ids[i], self.measure_in(model, i)));
        let measures = fractions.zip(&side.measures);
        let fractions = measures.map(|((id, inside), all)| (id, inside / all));
        fractions.filter(|(_, f)| *f > TOUCHED).collect()
    }

    pub(crate) fn side(&self, model: Model) -> &Cells<'a> {
        match model {
            Model::Inner => &self.refinement.inner,
            Model::Outer => &self.refinement.outer,
        }
    }

    /// Pieces of a cell of a model.
    pub(crate) fn pieces_of(&self, model: Model, cell: usize) -> impl Iterator<Item = usize> + '_ {
        let (offsets, pieces) = match model {
            Model::Inner => &self.by_inner,
            Model::Outer => &self.by_outer,
        };
        let range = offsets[cell]..offsets[cell + 1];
        pieces[range].iter().map(|&p| p as usize)
    }

    /// Measure of S in a cell of a model.
    pub(crate) fn measure_in(&self, model: Model, cell: usize) -> f64 {
        let pieces = self.pieces_of(model, cell);
        pieces.map(|p| self.refinement.pieces[p].measure).sum()
    }

    fn mean_length(&self, model: Model) -> f64 {
        let side = self.side(model);
        let touched: Vec<f64> = (0..side.len())
            .filter(|&i| self.measure_in(model, i) > TOUCHED * side.measures[i])
            .map(|i| side.cell(i).length())
            .collect();
        touched.iter().sum::<f64>() / touched.len() as f64
    }
}

/// Whether a pair of cells (inner, outer) belongs to a group, if there is one.
pub(crate) fn in_group(group: &Option<BTreeSet<ElementId>>, pair: (ElementId, ElementId)) -> bool {
    let has = |group: &BTreeSet<ElementId>| group.contains(&pair.0) || group.contains(&pair.1);
    group.as_ref().is_none_or(has)
}

/// Refuses kinds of cells whose weights and rows have no tests.
fn refuse_kinds(models: &Models) -> Result<(), Error> {
    let taken = [Kind::Bar2, Kind::Tri3, Kind::Quad4, Kind::Tet4, Kind::Hex8];
    for (model, cells) in [(Model::Inner, models.inner), (Model::Outer, models.outer)] {
        let other = |&&cell: &&ElementId| {
            let kind = models.mesh.kind(cell);
            kind.table().dim == models.mesh.dim && !taken.contains(&kind)
        };
        if let Some(&cell) = cells.iter().find(other) {
            let kind = models.mesh.kind(cell).table().name;
            return Err(Error::Kind { model, cell, kind });
        }
    }
    Ok(())
}

fn box_sides(region: &Region, dim: usize) -> Vec<Plane> {
    let Region::Box { min, max } = region else {
        return Vec::new();
    };
    let side = |i: usize, sign: f64, x: f64| {
        let mut normal = [0.0; 3];
        normal[i] = sign;
        Plane {
            normal,
            offset: sign * x,
        }
    };
    (0..dim)
        .flat_map(|i| [side(i, -1.0, min[i]), side(i, 1.0, max[i])])
        .collect()
}

fn refuse_shared_nodes(inner: &Cells, outer: &Cells) -> Result<(), Error> {
    let mut used = vec![false; inner.mesh.nodes.len()];
    for i in 0..inner.len() {
        inner
            .nodes(i)
            .iter()
            .for_each(|&node| used[node as usize] = true);
    }
    let mut nodes = (0..outer.len()).flat_map(|o| outer.nodes(o));
    match nodes.find(|&&node| used[node as usize]) {
        Some(&node) => Err(Error::SharedNode { node }),
        None => Ok(()),
    }
}

/// Refuses a group with cells that the other model does not cover.
fn refuse_uncovered(full: &Refinement, group: &BTreeSet<ElementId>) -> Result<(), Error> {
    let (mut cells, mut least) = (Vec::new(), 1.0f64);
    let mut judge = |side: &Cells, of: fn(&Piece) -> u32| {
        let mut covered = vec![0.0; side.len()];
        for piece in &full.pieces {
            covered[of(piece) as usize] += piece.common;
        }
        for i in (0..side.len()).filter(|&i| group.contains(&side.ids[i])) {
            let fraction = covered[i] / side.measures[i];
            least = least.min(fraction);
            if fraction < INSIDE {
                cells.push(side.ids[i]);
            }
        }
    };
    judge(&full.inner, |piece| piece.inner);
    judge(&full.outer, |piece| piece.outer);
    match cells.is_empty() {
        true => Ok(()),
        false => Err(Error::NotCovered { cells, least }),
    }
}

/// Takes away the outer cells that lie in the inner model and not in S, with their pieces.
fn without_inside_cells(full: Refinement) -> Result<(Refinement, Vec<ElementId>), Error> {
    let (mut common, mut inside) = (vec![0.0; full.outer.len()], vec![0.0; full.outer.len()]);
    for piece in &full.pieces {
        common[piece.outer as usize] += piece.common;
        inside[piece.outer as usize] += piece.measure;
    }
    // Cells that are half inside and out of S straddle the end of the inner model; that is judged by its faces.
    let falls = |o: usize| {
        inside[o] <= TOUCHED * full.outer.measures[o] && common[o] > 0.5 * full.outer.measures[o]
    };
    let (mut kept, mut removed, mut number) =
        (Vec::new(), Vec::new(), vec![u32::MAX; inside.len()]);
    for (o, &id) in full.outer.ids.iter().enumerate() {
        if falls(o) {
            removed.push(id);
        } else {
            number[o] = kept.len() as u32;
            kept.push(id);
        }
    }
    let stays = full
        .pieces
        .iter()
        .filter(|p| number[p.outer as usize] != u32::MAX);
    let pieces = stays.map(|piece| piece.renumbered(number[piece.outer as usize]));
    let refinement = Refinement {
        pieces: pieces.collect(),
        outer: Cells::new(full.outer.mesh, Model::Outer, &kept)?,
        inner: full.inner,
        sides: full.sides,
    };
    Ok((refinement, removed))
}

/// Pieces grouped by a cell: offsets and indices.
fn grouped(n: usize, pieces: &[Piece], cell: impl Fn(&Piece) -> u32) -> (Vec<usize>, Vec<u32>) {
    let mut offsets = vec![0; n + 1];
    for piece in pieces {
        offsets[cell(piece) as usize + 1] += 1;
    }
    (0..n).for_each(|i| offsets[i + 1] += offsets[i]);
    let (mut next, mut order) = (offsets.clone(), vec![0; pieces.len()]);
    for (p, piece) in pieces.iter().enumerate() {
        let at = &mut next[cell(piece) as usize];
        order[*at] = p as u32;
        *at += 1;
    }
    (offsets, order)
}
