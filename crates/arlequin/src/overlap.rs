//! The overlap of two models: region, pieces, borders, cells that fall away.

use std::collections::BTreeSet;

use carom_mesh::{ElementId, Mesh};

use crate::border::Border;
use crate::cell::Cell;
use crate::error::{Error, Model};
use crate::model::Cells;
use crate::polytope::{Facet, Plane, dot, sub};
use crate::refine::{Part, Piece, Refinement};

/// A cell that is this much inside the other model is inside: meshes of one curved body differ near its surface.
const INSIDE: f64 = 0.95;
/// Fraction of a cell's measure below which the overlap does not touch it.
const TOUCHED: f64 = 1e-9;
/// Step to a facet's other side, as a fraction of a cell's size, that stays within the next cell.
const NEXT: f64 = 1e-6;
/// Step, as a fraction of an outer cell's size, that leaves the strip by which meshes of one curved body differ.
const BEYOND: f64 = 0.1;

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
    group: Option<BTreeSet<ElementId>>,
    /// Pieces by cell of each model: offsets, then indices of pieces.
    pub(crate) by_inner: (Vec<usize>, Vec<u32>),
    pub(crate) by_outer: (Vec<usize>, Vec<u32>),
    /// Connected parts of S; the part of each piece.
    pub(crate) parts: Vec<Borders>,
    pub(crate) part_of: Vec<u32>,
    removed: Vec<ElementId>,
    sizes: [f64; 2],
    layers: f64,
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

    /// Finds the connected parts of S and their borders.
    fn find_borders(&mut self) {
        let pieces = &self.refinement.pieces;
        let roots = self.connect();
        let mut parts: Vec<u32> = Vec::new();
        self.part_of = vec![u32::MAX; pieces.len()];
        let mut facets: Vec<[Vec<Facet>; 2]> = Vec::new();
        let mut scratch = Vec::new();
        for (p, piece) in pieces.iter().enumerate() {
            if piece.measure == 0.0 {
                continue;
            }
            let root = roots[self.refinement.inner.nodes(piece.inner as usize)[0] as usize];
            let part = parts.iter().position(|&r| r == root).unwrap_or(parts.len());
            if part == parts.len() {
                parts.push(root);
                facets.push([Vec::new(), Vec::new()]);
            }
            self.part_of[p] = part as u32;
            for (model, facet) in self.border_facets(piece, &mut scratch) {
                facets[part][model as usize].push(facet);
            }
        }
        let length = self.sizes[1];
        let borders = facets.into_iter().map(|[inner_end, outer_end]| Borders {
            inner_end: Border::new(inner_end, length),
            outer_end: Border::new(outer_end, length),
        });
        self.parts = borders.collect();
    }

    /// For each node the least node of its connected part of S. Cells are connected that share a node or a piece.
    fn connect(&self) -> Vec<u32> {
        let mut parent: Vec<u32> = (0..self.mesh().nodes.len() as u32).collect();
        fn root(parent: &mut [u32], mut i: u32) -> u32 {
            while parent[i as usize] != i {
                parent[i as usize] = parent[parent[i as usize] as usize];
                i = parent[i as usize];
            }
            i
        }
        for piece in self.refinement.pieces.iter().filter(|p| p.measure > 0.0) {
            let inner = self.refinement.inner.nodes(piece.inner as usize);
            let outer = self.refinement.outer.nodes(piece.outer as usize);
            let first = root(&mut parent, inner[0]);
            for &node in inner.iter().chain(outer) {
                let (a, b) = (root(&mut parent, first), root(&mut parent, node));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
        (0..parent.len() as u32)
            .map(|i| root(&mut parent, i))
            .collect()
    }

    /// The facets of a piece on a border of S, with the model that ends there.
    fn border_facets(&self, piece: &Piece, scratch: &mut Vec<u32>) -> Vec<(Model, Facet)> {
        let outer = self.refinement.outer.cell(piece.outer as usize);
        let inner = self.refinement.inner.cell(piece.inner as usize);
        let size = inner.size.min(outer.size);
        let least = 1e-8 * size.powi(self.mesh().dim as i32 - 1);
        let mut found = Vec::new();
        for polytope in self.refinement.polytopes(piece, Part::Overlap) {
            for facet in polytope.facets() {
                if facet.measure <= least {
                    continue;
                }
                let next = self.presence(&step(&facet, NEXT * size), scratch);
                if next.in_overlap() {
                    continue;
                }
                let beyond = self.presence(&step(&facet, BEYOND * outer.size), scratch);
                let judge = if beyond.in_overlap() { next } else { beyond };
                match (judge.inner, judge.outer) {
                    (false, true) => found.push((Model::Inner, facet)),
                    (true, _) => found.push((Model::Outer, facet)),
                    (false, false) => {}
                }
            }
        }
        found
    }

    /// What lies at a position.
    fn presence(&self, x: &[f64; 3], scratch: &mut Vec<u32>) -> Presence {
        let inner = self.refinement.inner.locate(x, scratch);
        let outer = self.refinement.outer.locate(x, scratch);
        let in_box = self
            .refinement
            .sides
            .iter()
            .all(|side| side.distance(x) <= 0.0);
        let ids = |i: usize, o: usize| (self.refinement.inner.ids[i], self.refinement.outer.ids[o]);
        let region = match (inner, outer) {
            (Some(i), Some(o)) => in_box && in_group(&self.group, ids(i, o)),
            _ => false,
        };
        Presence {
            inner: inner.is_some(),
            outer: outer.is_some(),
            region,
        }
    }

    /// Refuses an inner model whose end lies inside the outer one but not on S.
    fn refuse_end_outside(&self) -> Result<(), Error> {
        let (inner, mut scratch) = (&self.refinement.inner, Vec::new());
        let mut cells = Vec::new();
        for (i, f) in inner.outside_faces() {
            let facet = face_of(&inner.cell(i), f);
            let size = inner.cell(i).size;
            let beyond = self.presence(&step(&facet, BEYOND * self.sizes[1]), &mut scratch);
            let before = self.presence(&step(&facet, -NEXT * size), &mut scratch);
            if beyond.outer && !beyond.inner && !before.in_overlap() {
                cells.push(inner.ids[i]);
            }
        }
        cells.dedup();
        match cells.is_empty() {
            true => Ok(()),
            false => Err(Error::EndsOutside { cells }),
        }
    }

    /// Measures the thickness of S where it has two borders; refuses less than one cell of the outer model.
    fn measure_layers(&mut self) -> Result<(), Error> {
        let mut thin = Vec::new();
        for (p, piece) in self.refinement.pieces.iter().enumerate() {
            let Some(borders) = self.parts.get(self.part_of[p] as usize) else {
                continue;
            };
            let (Some(inner_end), Some(outer_end)) = (&borders.inner_end, &borders.outer_end)
            else {
                continue;
            };
            let outer = self.refinement.outer.cell(piece.outer as usize);
            for polytope in self.refinement.polytopes(piece, Part::Overlap) {
                let x = polytope.middle();
                let to_inner = sub(&inner_end.nearest(&x), &x);
                let distance = inner_end.distance(&x);
                let direction = to_inner.map(|d| d / distance.max(f64::MIN_POSITIVE));
                let width = distance + outer_end.distance(&x);
                let layers = width / outer.extent(&direction).max(f64::MIN_POSITIVE);
                self.layers = self.layers.min(layers);
                if layers < 1.0 - 1e-6 {
                    thin.push(self.refinement.outer.ids[piece.outer as usize]);
                }
            }
        }
        thin.dedup();
        match thin.is_empty() {
            true => Ok(()),
            false => Err(Error::Thin {
                layers: self.layers,
                cells: thin,
            }),
        }
    }
}

/// Which models are at a position, and whether it is in the region where they are coupled.
struct Presence {
    inner: bool,
    outer: bool,
    region: bool,
}

impl Presence {
    fn in_overlap(&self) -> bool {
        self.inner && self.outer && self.region
    }
}

/// The middle of a facet moved along its normal.
fn step(facet: &Facet, length: f64) -> [f64; 3] {
    let middle = crate::polytope::Polytope::mean(&facet.vertices);
    [0, 1, 2].map(|i| middle[i] + length * facet.normal[i])
}

/// A face of a cell.
fn face_of(cell: &Cell, face: usize) -> Facet {
    let table = cell.kind.table();
    let vertices: Vec<[f64; 3]> = table.faces[face]
        .nodes
        .iter()
        .map(|&a| cell.x()[a])
        .collect();
    let plane = match table.dim {
        1 => {
            let other = cell.x()[1 - face];
            Plane::new(&vertices[0], &sub(&vertices[0], &other))
        }
        2 => {
            let t = sub(&vertices[1], &vertices[0]);
            Plane::new(&vertices[0], &[t[1], -t[0], 0.0])
        }
        _ => Plane::of_face(&vertices),
    };
    Facet {
        vertices,
        normal: plane.normal,
        measure: 1.0,
    }
}

/// Whether a pair of cells (inner, outer) belongs to a group, if there is one.
fn in_group(group: &Option<BTreeSet<ElementId>>, pair: (ElementId, ElementId)) -> bool {
    let has = |group: &BTreeSet<ElementId>| group.contains(&pair.0) || group.contains(&pair.1);
    group.as_ref().is_none_or(has)
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
