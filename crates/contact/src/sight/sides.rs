//! Which of two points tells a contact that both would tell, where a surface faces itself.
//!
//! Two smooth pieces of a surface that touch would tell their contact twice: each node of one is paired with a face of the other. The
//! forces of both then differ by what hardly moves anything (with meshes that match, P on one side and -P on the other move nothing at
//! all), and rows are nearly dependent. So one piece tells: that of the lower *rank*. Pieces are grown over the faces in the
//! reference configuration, ranked by the size of their faces, finer ones first; of those that are as fine pieces of the secondary side.

use carom_mesh::Face;

use super::lists::{Incidence, Lists};

/// Cosine of the angle between the normals of a face and of the first one of its piece: two faces of a piece make 90° at most, so that a
/// piece does not face itself before it is bent.
const SMOOTH: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Pieces whose sizes differ by less than the inverse of this, in powers of two, are ranked by their order.
const STEPS: f64 = 64.0;

/// How much larger the faces of the side that tells may be, over those of the other.
const COARSER: f64 = 1.25;

/// No point.
const NONE: u32 = u32::MAX;

/// The pieces of the surface of some nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sides {
    /// Of each point, the least of the faces around it.
    ranks: Vec<u32>,
    /// Least diagonal of the faces around each point, m.
    sizes: Vec<f64>,
    /// The point of each node of the system, up to the last that has one.
    points: Vec<u32>,
}

impl Sides {
    /// `nodes`: of the points; `around`: faces around each; `surface`: the faces, their unit normals and diagonals (m); `is_secondary`: whether a face
    /// is on the secondary side.
    pub(super) fn new(
        nodes: &[u32],
        around: &Lists,
        (faces, normals, diagonals): (&[Face], &[[f64; 3]], &[f64]),
        is_secondary: impl Fn(usize) -> bool,
    ) -> Sides {
        let ranks = ranks((faces, normals, diagonals), is_secondary);
        let of = |k: usize| around.of(k).iter().map(|&face| face as usize);
        let mut points = Vec::new();
        for (&node, point) in nodes.iter().zip(0..) {
            let node = node as usize;
            points.resize(points.len().max(node + 1), NONE);
            points[node] = point;
        }
        let least = |k: usize| {
            of(k)
                .map(|face| diagonals[face])
                .fold(f64::INFINITY, f64::min)
        };
        Sides {
            ranks: (0..nodes.len())
                .map(|k| of(k).map(|face| ranks[face]).min().unwrap_or(0))
                .collect(),
            sizes: (0..nodes.len()).map(least).collect(),
            points,
        }
    }

    /// The same with nodes in other numbers.
    pub(super) fn renumbered(&self, number: impl Fn(u32) -> u32) -> Sides {
        let mut points = Vec::new();
        let with = self.points.iter().zip(0..);
        for (&point, node) in with.filter(|(point, _)| **point != NONE) {
            let node = number(node) as usize;
            points.resize(points.len().max(node + 1), NONE);
            points[node] = point;
        }
        Sides {
            points,
            ..self.clone()
        }
    }

    /// The point of a node.
    pub(crate) fn point_of(&self, node: u32) -> Option<usize> {
        let point = self.points.get(node as usize).copied();
        point
            .filter(|&point| point != NONE)
            .map(|point| point as usize)
    }

    /// Whether a point leaves a contact to another one.
    pub(crate) fn yields(&self, point: usize, to: usize) -> bool {
        self.ranks[to] < self.ranks[point] && self.sizes[to] <= COARSER * self.sizes[point]
    }
}

/// The rank of the piece of each face.
fn ranks(
    (faces, normals, diagonals): (&[Face], &[[f64; 3]], &[f64]),
    is_secondary: impl Fn(usize) -> bool,
) -> Vec<u32> {
    let incidence = Incidence::new(faces);
    let mut pieces = vec![NONE; faces.len()];
    // number and sum of the diagonals of the faces of each piece
    let mut sizes: Vec<(f64, f64)> = Vec::new();
    let mut first_faces = Vec::new();
    let mut open = Vec::new();
    for first in 0..faces.len() {
        if pieces[first] != NONE {
            continue;
        }
        let piece = sizes.len() as u32;
        sizes.push((0.0, 0.0));
        first_faces.push(first);
        pieces[first] = piece;
        open.push(first as u32);
        while let Some(face) = open.pop() {
            let own = &faces[face as usize];
            let size = &mut sizes[piece as usize];
            (size.0, size.1) = (size.0 + 1.0, size.1 + diagonals[face as usize]);
            for next in own.corners().iter().flat_map(|&node| incidence.of(node)) {
                let (at, other) = (next as usize, faces[next as usize].corners());
                let cosine: f64 = (0..3).map(|i| normals[first][i] * normals[at][i]).sum();
                let shared = own.corners().iter().filter(|node| other.contains(node));
                if pieces[at] == NONE && cosine >= SMOOTH && shared.count() >= own.kind.table().dim
                {
                    pieces[at] = piece;
                    open.push(next);
                }
            }
        }
    }
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&piece| {
        let size = (STEPS * (sizes[piece].1 / sizes[piece].0).log2()).round() as i64;
        (size, !is_secondary(first_faces[piece]))
    });
    let mut ranks = vec![0; sizes.len()];
    for (rank, piece) in (0..).zip(order) {
        ranks[piece] = rank;
    }
    pieces.iter().map(|&piece| ranks[piece as usize]).collect()
}
