//! Pairs of surfaces whose meshes do not match, flat and bent.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Basis, Contact, Frames, Integration, Mortar, Pairing, Places, Target};
use carom_elements::Kind;
use carom_mesh::Face;
use carom_testing::Random;

use crate::fixture::{contact, face, paired};

pub const BASES: [Basis; 2] = [Basis::Standard, Basis::Dual];

/// Nodes of both sides, and the faces of each.
#[derive(Clone)]
pub struct Pair {
    pub dim: usize,
    pub unknowns: Unknowns,
    pub x: Vec<[f64; 3]>,
    pub secondary: Vec<Face>,
    pub primary: Vec<Face>,
}

impl Pair {
    pub fn contact(&self, basis: Basis, factor: f64) -> Contact {
        let (mortar, points) = Mortar::new(self.secondary.clone(), &self.x, |_| factor);
        Contact {
            integration: Integration::Mortar { basis },
            mortar: Some(mortar),
            ..contact(points, Target::Surface(self.primary.clone()))
        }
    }

    pub fn pairing(&self, basis: Basis) -> Pairing {
        let u = vec![0.0; self.dim * self.x.len()];
        let places = self.places(&u);
        paired(&self.contact(basis, 1.0), &places)
    }

    pub fn places<'a>(&'a self, u: &'a [f64]) -> Places<'a> {
        Places {
            unknowns: &self.unknowns,
            time: 0.0,
            x: &self.x,
            u,
            frames: Frames::default(),
        }
    }

    /// The same pair turned about an axis that is none of the coordinate axes (the third one in the plane).
    fn turned(mut self) -> Pair {
        let (s, c) = 0.7_f64.sin_cos();
        for x in &mut self.x {
            *x = [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]];
            if self.dim == 3 {
                *x = [x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]];
            }
        }
        self
    }

    /// ∫ N_a over some faces, by node.
    pub fn consistent(&self, faces: &[Face]) -> Vec<f64> {
        let mut areas = vec![0.0; self.x.len()];
        for point in carom_contact::Point::of_faces(faces, &self.x, |_| 1.0) {
            for (node, n) in point.carriers() {
                areas[node as usize] += n * point.area;
            }
        }
        areas
    }
}

/// Two lines of edges, `gap` apart, the secondary one above; of two nodes or, through midpoints, of three.
pub fn lines(secondary: &[f64], primary: &[f64], gap: f64, kind: Kind) -> Pair {
    let mut x = Vec::new();
    let mut line = |ends: &[f64], height: f64, up: bool| -> Vec<Face> {
        let first = x.len() as u32;
        x.extend(ends.iter().map(|&end| [end, height, 0.0]));
        let edges = ends.windows(2).enumerate().map(|(k, ends)| {
            let (a, b) = (first + k as u32, first + k as u32 + 1);
            let mut nodes = if up { vec![b, a] } else { vec![a, b] };
            if kind == Kind::Bar3 {
                nodes.push(x.len() as u32);
                x.push([0.5 * (ends[0] + ends[1]), height, 0.0]);
            }
            face(kind, &nodes)
        });
        edges.collect()
    };
    let (secondary, primary) = (line(secondary, gap, false), line(primary, 0.0, true));
    Pair {
        dim: 2,
        unknowns: Unknowns::translations(2, x.len()),
        x,
        secondary,
        primary,
    }
}

/// A grid of faces over a rectangle.
fn grid(
    x: &mut Vec<[f64; 3]>,
    kind: Kind,
    stretch: [[f64; 2]; 2],
    cells: [u32; 2],
    height: f64,
    up: bool,
) -> Vec<Face> {
    let step = if kind.table().nodes > 4 { 2 } else { 1 };
    let cells = cells.map(|n| step * n);
    let (first, row) = (x.len() as u32, cells[0] + 1);
    for j in 0..=cells[1] {
        for i in 0..=cells[0] {
            let part = [
                f64::from(i) / f64::from(cells[0]),
                f64::from(j) / f64::from(cells[1]),
            ];
            let at = |k: usize| stretch[k][0] + part[k] * (stretch[k][1] - stretch[k][0]);
            x.push([at(0), at(1), height]);
        }
    }
    let mut faces = Vec::new();
    for j in (0..cells[1]).step_by(step as usize) {
        for i in (0..cells[0]).step_by(step as usize) {
            let at = |k: u32| first + j * row + i + step * (k % 2) + step * row * (k / 2);
            let corners = match up {
                true => [at(0), at(1), at(3), at(2)],
                false => [at(2), at(3), at(1), at(0)],
            };
            faces.extend(split(kind, corners));
        }
    }
    faces
}

/// The faces of one square of a grid; midside nodes have the mean number of their ends.
fn split(kind: Kind, [a, b, c, d]: [u32; 4]) -> Vec<Face> {
    let m = |a: u32, b: u32| (a + b) / 2;
    let (sides, middle) = ([m(a, b), m(b, c), m(c, d), m(d, a)], m(a, c));
    let [ab, bc, cd, da] = sides;
    let nodes: Vec<Vec<u32>> = match kind {
        Kind::Tri3 => vec![vec![a, b, c], vec![a, c, d]],
        Kind::Tri6 => vec![vec![a, b, c, ab, bc, middle], vec![a, c, d, middle, cd, da]],
        Kind::Quad4 => vec![vec![a, b, c, d]],
        Kind::Quad8 => vec![vec![a, b, c, d, ab, bc, cd, da]],
        _ => vec![vec![a, b, c, d, ab, bc, cd, da, middle]],
    };
    nodes.iter().map(|nodes| face(kind, nodes)).collect()
}

/// Two grids over the unit square, or the primary one over another rectangle.
pub fn grids(kinds: [Kind; 2], cells: [[u32; 2]; 2], primary: [[f64; 2]; 2], gap: f64) -> Pair {
    let mut x = Vec::new();
    let unit = [[0.0, 1.0]; 2];
    let secondary = grid(&mut x, kinds[0], unit, cells[0], gap, false);
    let primary = grid(&mut x, kinds[1], primary, cells[1], 0.0, true);
    Pair {
        dim: 3,
        unknowns: Unknowns::translations(3, x.len()),
        x,
        secondary,
        primary,
    }
}

/// Secondary faces that see one primary face of a kind each: their pieces are themselves wherever they move.
pub fn over_one_face(kind: Kind, gap: f64) -> Pair {
    if kind == Kind::Bar2 {
        return lines(&[0.0, 0.4, 1.0], &[-1.0, 2.0], gap, kind);
    }
    let wide = [[-2.0, 1.5], [-0.5, 3.0]];
    let mut pair = grids([Kind::Tri3, kind], [[1, 1], [1, 1]], wide, gap);
    pair.secondary.truncate(1);
    pair.primary.truncate(1);
    pair
}

pub const KINDS: [[Kind; 2]; 7] = [
    [Kind::Tri3, Kind::Tri3],
    [Kind::Quad4, Kind::Quad4],
    [Kind::Tri3, Kind::Quad4],
    [Kind::Quad4, Kind::Tri3],
    [Kind::Tri6, Kind::Quad8],
    [Kind::Quad8, Kind::Quad9],
    [Kind::Quad9, Kind::Tri6],
];

pub fn flat_pairs() -> Vec<Pair> {
    let one = [0.0, 0.13, 0.5, 0.61, 1.0];
    let other = [0.0, 0.2, 0.25, 0.7, 0.9, 1.0];
    let mut pairs = Vec::new();
    for kind in [Kind::Bar2, Kind::Bar3] {
        let made = |gap| lines(&one, &other, gap, kind);
        pairs.extend([made(0.1), made(-0.02).turned()]);
    }
    for kinds in KINDS {
        let made = || grids(kinds, [[3, 2], [2, 5]], [[0.0, 1.0]; 2], 0.1);
        pairs.extend([made(), made().turned()]);
    }
    pairs
}

/// A bent pair: neither side flat, nothing parallel.
pub fn bent(mut pair: Pair, random: &mut Random, size: f64) -> Pair {
    for x in &mut pair.x {
        x[pair.dim - 1] += 0.3 * x[0] * x[0]
            - if pair.dim == 3 {
                0.2 * x[0] * x[1]
            } else {
                0.0
            };
        for x in &mut x[..pair.dim] {
            *x += size * random.next();
        }
    }
    pair
}

impl Pair {
    /// Distance of flat sides, m.
    pub fn gap(&self) -> f64 {
        self.pairing(Basis::Standard).rows.gap(0)
    }

    /// Normal of the plane of the secondary surface, from the primary to it.
    pub fn pairing_normal(&self) -> [f64; 3] {
        let x = carom_contact::Point::of_faces(&self.secondary, &self.x, |_| 1.0);
        assert!(!x.is_empty());
        let face = &self.secondary[0];
        let corners: Vec<[f64; 3]> = face.corners().iter().map(|&a| self.x[a as usize]).collect();
        carom_mesh::project(face, &corners, &corners[0])
            .normal
            .map(|n| -n)
    }
}
