//! The common refinement of two meshes: cells of one cut by cells of the other, as pieces with quadrature points.
//!
//! A piece keeps only the two cells; its geometry is computed again where it is needed, so that memory does not grow
//! with the number of vertices. A cell that lies wholly in one of the other model is not cut at all and integrated
//! on its own reference cell.

use carom_elements::Kind;
use carom_mesh::ElementId;

use crate::cell::{Cell, Convex};
use crate::error::Error;
use crate::model::Cells;
use crate::polytope::{Plane, Polytope};
use crate::rule::Rule;

/// Pieces of less than this fraction of the smaller of their two cells are round-off.
const NOTHING: f64 = 1e-13;
/// By how much the degree of the quadrature is raised, by dimension, where a cell is not affine: shape functions are then
/// no polynomials of the position, and the error of the rule falls geometrically with its degree. Less in space, where
/// pieces of such cells are cut small.
const RAISED: [usize; 4] = [0, 0, 6, 2];

/// What a cell of one model and one of the other have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    /// Index of the inner cell in its model.
    pub inner: u32,
    /// Index of the outer cell in its model.
    pub outer: u32,
    /// Measure common to both cells.
    pub common: f64,
    /// Measure of the part in the region of the overlap.
    pub measure: f64,
    shape: Shape,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// The whole inner cell.
    Inner,
    /// The whole outer cell.
    Outer,
    /// A part of both.
    Cut,
}

impl Piece {
    /// The same piece under another number of its outer cell.
    pub fn renumbered(self, outer: u32) -> Piece {
        Piece { outer, ..self }
    }
}

/// A quadrature point of a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub x: [f64; 3],
    /// Weight times Jacobian, in length^dim.
    pub weight: f64,
    /// Reference coordinates in the inner cell.
    pub inner: [f64; 3],
    /// Reference coordinates in the outer cell.
    pub outer: [f64; 3],
}

/// Which part of a piece is meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    /// All that the two cells have in common.
    Common,
    /// The part in the overlap.
    Overlap,
}

/// Quadrature rules of one degree, and of a raised one for cells that are not affine.
pub(crate) struct Rules {
    /// For each kind of corners.
    made: Vec<(Kind, [Rule; 2])>,
    /// For quadrilaterals and hexahedra whose axes are those of the other cell.
    aligned: Rule,
    /// For pieces.
    simplex: [Rule; 2],
}

impl Rules {
    /// `degree`: total degree of what is integrated; `along`: its degree in each reference coordinate, where the axes of
    /// the two cells agree.
    pub fn new(dim: usize, degree: usize, along: usize) -> Rules {
        let kinds: &[Kind] = match dim {
            1 => &[Kind::Bar2],
            2 => &[Kind::Tri3, Kind::Quad4],
            _ => &[Kind::Tet4, Kind::Hex8, Kind::Wedge6, Kind::Pyramid5],
        };
        let both = [degree, degree + RAISED[dim]];
        let pair = |&kind| (kind, both.map(|degree| Rule::of(kind, degree)));
        Rules {
            made: kinds.iter().map(pair).collect(),
            aligned: Rule::cube(dim, along),
            simplex: both.map(|degree| Rule::simplex(dim, degree)),
        }
    }

    /// The rule for a whole cell within one of the other model.
    fn of_whole(&self, cell: &Cell, within: &Cell) -> &Rule {
        match cell.is_aligned(within) {
            true => &self.aligned,
            false => self.of_cell(cell, cell.is_affine() && within.is_affine()),
        }
    }

    /// The rule for one cell by itself.
    pub fn of_cell(&self, cell: &Cell, affine: bool) -> &Rule {
        let found = self.made.iter().find(|(kind, _)| *kind == cell.corners());
        let rules = found.map_or(&self.simplex, |(_, rules)| rules);
        &rules[usize::from(!affine)]
    }

    fn of_simplices(&self, affine: bool) -> &Rule {
        &self.simplex[usize::from(!affine)]
    }
}

/// Two models and the pieces that they have in common.
#[derive(Clone, Debug)]
pub(crate) struct Refinement<'a> {
    pub inner: Cells<'a>,
    pub outer: Cells<'a>,
    /// Sides of the region, where it is a box.
    pub sides: Vec<Plane>,
    /// Sorted by outer cell, then by inner cell.
    pub pieces: Vec<Piece>,
}

impl<'a> Refinement<'a> {
    /// All pieces of two models. `counts`: whether a pair (inner, outer) belongs to the region; `sides`: planes that
    /// bound the region besides.
    pub fn new(
        inner: Cells<'a>,
        outer: Cells<'a>,
        sides: Vec<Plane>,
        counts: impl Fn(ElementId, ElementId) -> bool,
    ) -> Refinement<'a> {
        let mut refinement = Refinement {
            inner,
            outer,
            sides,
            pieces: Vec::new(),
        };
        let (mut pieces, mut found) = (Vec::new(), Vec::new());
        for o in 0..refinement.outer.len() {
            refinement.inner.near(&refinement.outer, o, &mut found);
            if found.is_empty() {
                continue;
            }
            let cut = Cutter::new(refinement.outer.cell(o));
            for &i in &found {
                let ids = (refinement.inner.ids[i as usize], refinement.outer.ids[o]);
                pieces.extend(refinement.piece(i, o as u32, &cut, counts(ids.0, ids.1)));
            }
        }
        refinement.pieces = pieces;
        refinement
    }

    /// The piece of two cells, if they have a volume in common.
    fn piece(&self, inner: u32, outer: u32, cut: &Cutter, counts: bool) -> Option<Piece> {
        let cell = Cutter::new(self.inner.cell(inner as usize));
        let smaller = self.inner.measures[inner as usize].min(self.outer.measures[outer as usize]);
        let shape = if cut.holds(&cell.cell) {
            Shape::Inner
        } else if cell.holds(&cut.cell) {
            Shape::Outer
        } else {
            Shape::Cut
        };
        let polytopes = match shape {
            Shape::Inner => polytopes_of(&cell),
            Shape::Outer => polytopes_of(cut),
            Shape::Cut => cell.common(cut),
        };
        let common = match shape {
            Shape::Inner => self.inner.measures[inner as usize],
            Shape::Outer => self.outer.measures[outer as usize],
            Shape::Cut => measure(&polytopes),
        };
        let size = cell.cell.size.min(cut.cell.size);
        let measure = match counts {
            false => 0.0,
            true if self.sides.is_empty() => common,
            true => measure(&clip_all(polytopes, &self.sides, 1e-12 * size)),
        };
        (common > NOTHING * smaller).then_some(Piece {
            inner,
            outer,
            common,
            measure: if measure > NOTHING * smaller {
                measure
            } else {
                0.0
            },
            shape,
        })
    }

    /// The convex bodies that make up a part of a piece.
    pub fn polytopes(&self, piece: &Piece, part: Part) -> Vec<Polytope> {
        let inner = Cutter::new(self.inner.cell(piece.inner as usize));
        let outer = Cutter::new(self.outer.cell(piece.outer as usize));
        let size = inner.cell.size.min(outer.cell.size);
        let common = match piece.shape {
            Shape::Inner => polytopes_of(&inner),
            Shape::Outer => polytopes_of(&outer),
            Shape::Cut => inner.common(&outer),
        };
        match part {
            Part::Common => common,
            Part::Overlap => clip_all(common, &self.sides, 1e-12 * size),
        }
    }

    /// Quadrature points of a part of a piece, into `points`, which is cleared first.
    ///
    /// Errors: a distorted cell cannot be inverted at a point.
    pub fn points(
        &self,
        piece: &Piece,
        part: Part,
        rules: &Rules,
        points: &mut Vec<Point>,
    ) -> Result<(), Error> {
        points.clear();
        let (i, o) = (piece.inner as usize, piece.outer as usize);
        let (inner, outer) = (self.inner.cell(i), self.outer.cell(o));
        let affine = inner.is_affine() && outer.is_affine();
        let inverse = |cells: &Cells, k: usize, cell: &Cell, x: &[f64; 3]| {
            cell.reference(x)
                .ok_or(Error::InverseMap { cell: cells.ids[k] })
        };
        // The box cuts nothing off a piece that lies wholly in it.
        let whole =
            part == Part::Common || (piece.common - piece.measure).abs() <= 1e-12 * piece.common;
        match piece.shape {
            Shape::Inner if whole => {
                for (xi, weight) in inner.points(rules.of_whole(&inner, &outer)) {
                    let x = inner.point(&xi);
                    points.push(Point {
                        x,
                        weight,
                        inner: xi,
                        outer: inverse(&self.outer, o, &outer, &x)?,
                    });
                }
            }
            Shape::Outer if whole => {
                for (xi, weight) in outer.points(rules.of_whole(&outer, &inner)) {
                    let x = outer.point(&xi);
                    points.push(Point {
                        x,
                        weight,
                        inner: inverse(&self.inner, i, &inner, &x)?,
                        outer: xi,
                    });
                }
            }
            _ => {
                for (x, weight) in simplex_points(
                    &self.polytopes(piece, part),
                    rules.of_simplices(affine),
                    self.inner.mesh.dim,
                ) {
                    points.push(Point {
                        x,
                        weight,
                        inner: inverse(&self.inner, i, &inner, &x)?,
                        outer: inverse(&self.outer, o, &outer, &x)?,
                    });
                }
            }
        }
        Ok(())
    }
}

/// A cell with its convex parts.
struct Cutter {
    cell: Cell,
    parts: Vec<Convex>,
}

impl Cutter {
    fn new(cell: Cell) -> Cutter {
        Cutter {
            parts: cell.parts(),
            cell,
        }
    }

    /// Whether a cell lies wholly in this one, which must be convex.
    fn holds(&self, cell: &Cell) -> bool {
        let tolerance = tolerance(&self.cell, cell);
        let below = |plane: &Plane| cell.x().iter().all(|x| plane.distance(x) <= tolerance);
        self.parts.len() == 1 && self.parts[0].planes.iter().all(below)
    }

    /// What two cells have in common.
    fn common(&self, other: &Cutter) -> Vec<Polytope> {
        let tolerance = tolerance(&self.cell, &other.cell);
        let mut common = Vec::new();
        for part in &self.parts {
            for by in &other.parts {
                let clipped = by
                    .planes
                    .iter()
                    .try_fold(part.shape.clone(), |shape, plane| {
                        shape.clip(plane, tolerance)
                    });
                common.extend(clipped);
            }
        }
        common
    }
}

/// Distance below which a vertex counts as lying on a plane: round-off of cells of these sizes and positions.
fn tolerance(a: &Cell, b: &Cell) -> f64 {
    let largest = a.x().iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    1e-12 * a.size.max(b.size) + 1e-15 * largest
}

fn polytopes_of(cutter: &Cutter) -> Vec<Polytope> {
    cutter.parts.iter().map(|part| part.shape.clone()).collect()
}

fn clip_all(polytopes: Vec<Polytope>, planes: &[Plane], tolerance: f64) -> Vec<Polytope> {
    let clip = |shape: Polytope| {
        planes
            .iter()
            .try_fold(shape, |shape, plane| shape.clip(plane, tolerance))
    };
    polytopes.into_iter().filter_map(clip).collect()
}

fn measure(polytopes: &[Polytope]) -> f64 {
    polytopes.iter().map(Polytope::measure).sum()
}

/// Points and weights of a simplex rule on every simplex of some bodies.
pub(crate) fn simplex_points(
    polytopes: &[Polytope],
    rule: &Rule,
    dim: usize,
) -> Vec<([f64; 3], f64)> {
    let reference = [1.0, 1.0, 2.0, 6.0][dim];
    let mut points = Vec::new();
    for polytope in polytopes {
        polytope.simplices(|x, measure| {
            for (xi, w) in rule.points.iter().zip(&rule.weights) {
                let last = 1.0 - xi[0] - xi[1] - xi[2];
                let at = [0, 1, 2]
                    .map(|i| last * x[0][i] + (0..dim).map(|k| xi[k] * x[k + 1][i]).sum::<f64>());
                points.push((at, w * reference * measure));
            }
        });
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Model;
    use carom_mesh::{Mesh, generate};

    /// SplitMix64. Steele, Lea and Flood (2014).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Two meshes in one: the first as it stands, the second turned by angles about z and x, and moved.
    fn meshes(
        a: Mesh,
        mut b: Mesh,
        angles: [f64; 2],
        shift: [f64; 3],
    ) -> (Mesh, Vec<ElementId>, Vec<ElementId>) {
        for x in &mut b.nodes {
            let (s, c) = angles[0].sin_cos();
            *x = [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]];
            let (s, c) = angles[1].sin_cos();
            *x = [x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]];
            (0..3).for_each(|i| x[i] += shift[i]);
        }
        b.groups = b
            .groups
            .into_iter()
            .map(|(name, group)| (format!("b{name}"), group))
            .collect();
        let mut mesh = a;
        mesh.merge("b", b).unwrap();
        let cells = |name: &str| mesh.groups[name].elements.clone();
        let (inner, outer) = (cells("a"), cells("ba"));
        (mesh, inner, outer)
    }

    fn refinement<'a>(mesh: &'a Mesh, inner: &[ElementId], outer: &[ElementId]) -> Refinement<'a> {
        let inner = Cells::new(mesh, Model::Inner, inner).unwrap();
        let outer = Cells::new(mesh, Model::Outer, outer).unwrap();
        Refinement::new(inner, outer, Vec::new(), |_, _| true)
    }

    /// Models of which the second covers the first, turned at random.
    fn covered(
        seed: u64,
        dim: usize,
        simplices: [bool; 2],
    ) -> (Mesh, Vec<ElementId>, Vec<ElementId>) {
        let mut state = seed;
        let turn = 6.3 * random(&mut state);
        let shift = [0, 1, 2].map(|i| {
            if i < dim {
                0.2 * random(&mut state)
            } else {
                0.0
            }
        });
        match dim {
            2 => {
                let a = generate::rectangle("a", [-0.5; 2], [1.0; 2], [3, 4], simplices[0]);
                let b = generate::rectangle("a", [-1.5; 2], [3.0; 2], [7, 5], simplices[1]);
                meshes(a, b, [turn, 0.0], shift)
            }
            _ => {
                let a = generate::box_("a", [-0.5; 3], [1.0; 3], [2, 3, 2], simplices[0]);
                let b = generate::box_("a", [-1.7; 3], [3.4; 3], [4, 5, 3], simplices[1]);
                meshes(a, b, [turn, 0.7 * turn], shift)
            }
        }
    }

    const KINDS: [[bool; 2]; 4] = [[false, false], [false, true], [true, false], [true, true]];

    #[test]
    fn the_pieces_of_every_covered_cell_fill_it_and_have_its_moments() {
        for (dim, seeds) in [(2, 20), (3, 2)] {
            let rules = Rules::new(dim, 4, 4);
            for (seed, kinds) in (0..seeds).flat_map(|s| KINDS.map(|kinds| (s, kinds))) {
                let (mesh, inner, outer) = covered(seed, dim, kinds);
                let refinement = refinement(&mesh, &inner, &outer);
                let (mut points, mut sums) = (Vec::new(), vec![[0.0; 3]; inner.len()]);
                for piece in &refinement.pieces {
                    let i = piece.inner as usize;
                    sums[i][0] += piece.common;
                    refinement
                        .points(piece, Part::Common, &rules, &mut points)
                        .unwrap();
                    for p in &points {
                        sums[i][1] += p.weight;
                        sums[i][2] += p.weight * p.x[0].powi(2) * p.x[1] * (1.0 + p.x[dim - 1]);
                        let at = refinement.outer.cell(piece.outer as usize).point(&p.outer);
                        assert!((0..3).all(|k| (at[k] - p.x[k]).abs() < 1e-14));
                    }
                }
                for (i, sum) in sums.iter().enumerate() {
                    let cell = refinement.inner.cell(i);
                    let moment: f64 = cell
                        .points(rules.of_cell(&cell, true))
                        .map(|(xi, w)| {
                            let x = cell.point(&xi);
                            w * x[0].powi(2) * x[1] * (1.0 + x[dim - 1])
                        })
                        .sum();
                    let whole = refinement.inner.measures[i];
                    // Vertices are snapped to planes within 1e-12 of a cell's size.
                    for (found, exact) in sum.iter().zip([whole, whole, moment]) {
                        assert!(
                            (found - exact).abs() < 1e-11 * whole,
                            "{seed} {kinds:?} {i}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_tree_finds_the_pairs_that_trying_all_finds() {
        for (dim, kinds) in [(2, KINDS[0]), (2, KINDS[3]), (3, KINDS[1])] {
            let (mesh, inner, outer) = covered(11, dim, kinds);
            let refinement = refinement(&mesh, &inner, &outer);
            let mut all = Vec::new();
            for o in 0..outer.len() {
                let cut = Cutter::new(refinement.outer.cell(o));
                for i in 0..inner.len() {
                    all.extend(refinement.piece(i as u32, o as u32, &cut, true));
                }
            }
            assert!(refinement.pieces == all && all.len() > inner.len());
        }
    }

    #[test]
    fn nested_cells_are_not_cut_and_equal_meshes_have_one_piece_a_cell() {
        let a = generate::box_("a", [0.0; 3], [1.0; 3], [4, 4, 4], false);
        let b = generate::box_("a", [0.0; 3], [1.0; 3], [2, 2, 2], false);
        let (mesh, inner, outer) = meshes(a.clone(), b, [0.0; 2], [0.0; 3]);
        let nested = refinement(&mesh, &inner, &outer);
        assert_eq!(nested.pieces.len(), 64);
        assert!(nested.pieces.iter().all(|p| p.shape == Shape::Inner));
        let (mesh, inner, outer) = meshes(a.clone(), a, [0.0; 2], [0.0; 3]);
        let equal = refinement(&mesh, &inner, &outer);
        assert!(
            equal
                .pieces
                .iter()
                .all(|p| p.inner == p.outer && p.shape == Shape::Inner)
        );
        assert_eq!(equal.pieces.len(), 64);
    }
}
