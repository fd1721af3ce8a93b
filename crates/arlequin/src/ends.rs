//! Where the two models end: the facets of the border of S are found by looking across them.
//!
//! A facet of a piece is inside S if S goes on just behind it. Else it is a border, and what lies a tenth of an outer cell
//! behind it says of which model: that step leaves the strip by which two meshes of one curved body differ.

use carom_elements::Face;

use crate::border::Border;
use crate::cell::{Cell, norm};
use crate::error::{Error, Model};
use crate::overlap::{Borders, Overlap, in_group};
use crate::polytope::{Facet, Plane, Polytope, sub};
use crate::refine::{Part, Piece};

/// Step to a facet's other side, as a fraction of a cell's size, that stays within the next cell.
const NEXT: f64 = 1e-6;
/// Step, as a fraction of an outer cell's size, that leaves the strip by which meshes of one curved body differ.
const BEYOND: f64 = 0.1;

impl Overlap<'_> {
    /// Finds the connected parts of S and their borders.
    pub(crate) fn find_borders(&mut self) {
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
    pub(crate) fn refuse_end_outside(&self) -> Result<(), Error> {
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
    pub(crate) fn measure_layers(&mut self) -> Result<(), Error> {
        let (mut thin, mut hints) = (Vec::new(), [0; 2]);
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
                let to_inner = sub(&inner_end.nearest(&x, &mut hints[0]), &x);
                let distance = norm(&to_inner);
                let direction = to_inner.map(|d| d / distance.max(f64::MIN_POSITIVE));
                let width = distance + outer_end.distance(&x, &mut hints[1]);
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
    let middle = Polytope::mean(&facet.vertices);
    [0, 1, 2].map(|i| middle[i] + length * facet.normal[i])
}

/// A face of a cell.
fn face_of(cell: &Cell, face: usize) -> Facet {
    let table = cell.kind.table();
    let Face { kind, nodes } = table.faces[face];
    let corners = kind.table().linear.table().nodes;
    let vertices: Vec<[f64; 3]> = nodes[..corners].iter().map(|&a| cell.x()[a]).collect();
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
