//! The core of a body: its surface a little further inside, in pieces that cannot pass those of another core without meeting them.
//!
//! A vertex of a core is a mean of nodes with fixed weights, so it moves by no more than these do. Cores instead of surfaces: bodies that touch,
//! slide and part again have surfaces that rounding and laws with a compliance let into each other.

use std::collections::BTreeSet;
use std::ops::Range;

use carom_elements::Kind;
use carom_mesh::Bounds;
use carom_mesh::surface::pieces;

type Vec3 = [f64; 3];

/// Half the size of an element over how far a vertex is below its surface.
const OF_INSET: f64 = 10.0;

/// Half a thickness over how deep others may come.
const OF_DEPTH: f64 = 4.0;

/// The core of a body or of a rigid shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Core {
    /// Nodes that move it, by system number, ascending.
    nodes: Vec<u32>,
    vertices: Vec<Vertex>,
    /// Places in `nodes` and weights of all vertices.
    weights: Vec<(u32, f64)>,
    pieces: Vec<Piece>,
    /// Where the pieces of each patch end.
    ends: Vec<u32>,
    /// Mean diagonal of the box around a patch in the reference configuration, m.
    size: f64,
    /// Farthest that a vertex is below its node in the reference configuration, m.
    inset: f64,
    /// How deep others may come below the surface, m.
    depth: f64,
}

/// A vertex of a core.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Vertex {
    /// Where its weights end.
    end: u32,
    /// Distance that others are to keep from it, m.
    keeps: f64,
}

/// A node, an edge or a triangle, in the patch of a face. A node or an edge of several patches belongs to the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    corners: [u32; 3],
    count: u8,
}

impl Piece {
    /// Numbers of its vertices.
    pub(super) fn corners(&self) -> &[u32] {
        &self.corners[..usize::from(self.count)]
    }
}

impl Core {
    /// A core of patches: of each its kind and its vertices, in the order of the nodes of the kind. Of each vertex the nodes (system numbers) with
    /// their weights, whose sum is 1, first that of the surface above it, and the distance that others are to keep from it, m. `place`: of a node in the reference configuration, m.
    pub fn new(
        vertices: &[(Vec<(u32, f64)>, f64)],
        patches: &[(Kind, Vec<u32>)],
        place: impl Fn(u32) -> Vec3,
    ) -> Core {
        let moving = vertices.iter().flat_map(|(weights, _)| weights);
        let mut nodes: Vec<u32> = moving.map(|(node, _)| *node).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut core = Core {
            nodes,
            ..Core::default()
        };
        for (weights, keeps) in vertices {
            let known = &core.nodes;
            let places = weights.iter().map(|(node, weight)| {
                let place = known.binary_search(node).unwrap_or_default();
                (place as u32, *weight)
            });
            core.weights.extend(places);
            core.vertices.push(Vertex {
                end: core.weights.len() as u32,
                keeps: *keeps,
            });
        }
        let mut told = BTreeSet::new();
        for (kind, corners) in patches {
            core.push_patch(*kind, corners, &mut told);
        }
        let places: Vec<Vec3> = core.nodes.iter().map(|&node| place(node)).collect();
        let mut at = Vec::new();
        core.place(&places, &mut at);
        let sizes = (0..core.ends.len()).map(|patch| core.bounds(patch, &at).diagonal());
        core.size = sizes.sum::<f64>() / core.ends.len().max(1) as f64;
        core.inset = core.most_inset(&places, &at);
        core.depth = core.inset;
        core
    }

    /// Of a body whose surface is not that of its vertices: others may come so deep below it, m.
    #[must_use]
    pub fn with_depth(self, depth: f64) -> Core {
        Core { depth, ..self }
    }

    /// Part of the way from its nodes to its vertices at which the latter are, against another core: nothing is to go through a thin body before that is
    /// told. Without an end to what others may do, all of it.
    pub fn part_against(&self, other: &Core) -> f64 {
        match other.depth > 0.0 && other.depth < self.inset {
            true => other.depth / self.inset,
            false => 1.0,
        }
    }

    /// How deep another may come before the two meet, m, where the vertices are at a part of the way to them.
    pub fn margin(&self, part: f64) -> f64 {
        match self.inset > 0.0 {
            true => part * self.inset,
            false => self.depth,
        }
    }

    /// Half the thickness of what is below the surface, m: of an element of a solid, of a shell or a beam, or the like.
    pub fn half(&self) -> f64 {
        match self.inset > 0.0 {
            true => OF_INSET * self.inset,
            false => OF_DEPTH * self.depth,
        }
    }

    fn most_inset(&self, places: &[Vec3], vertices: &[Vec3]) -> f64 {
        let mut begin = 0;
        let mut most = 0.0_f64;
        for (vertex, x) in self.vertices.iter().zip(vertices) {
            if let Some((node, _)) = self.weights.get(begin) {
                let node = &places[*node as usize];
                let square: f64 = (0..3).map(|i| (x[i] - node[i]).powi(2)).sum();
                most = most.max(square.sqrt());
            }
            begin = vertex.end as usize;
        }
        most
    }

    fn push_patch(&mut self, kind: Kind, corners: &[u32], told: &mut BTreeSet<[u32; 3]>) {
        for part in pieces(kind) {
            let of: Vec<u32> = part.places.iter().map(|&place| corners[place]).collect();
            let triangles: &[[usize; 3]] = match of.len() {
                3 => &[[0, 1, 2]],
                4 => &[[0, 1, 2], [0, 2, 3]],
                _ => &[],
            };
            for triangle in triangles {
                self.push(&triangle.map(|k| of[k]), told);
            }
            let edges: &[[usize; 2]] = match of.len() {
                2 => &[[0, 1]],
                3 => &[[0, 1], [1, 2], [2, 0]],
                4 => &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
                _ => &[],
            };
            for edge in edges {
                self.push(&edge.map(|k| of[k]), told);
            }
            for node in of {
                self.push(&[node], told);
            }
        }
        self.ends.push(self.pieces.len() as u32);
    }

    fn push(&mut self, corners: &[u32], told: &mut BTreeSet<[u32; 3]>) {
        let mut key = [u32::MAX; 3];
        key[..corners.len()].copy_from_slice(corners);
        key.sort_unstable();
        if told.insert(key) {
            let mut own = [corners[0]; 3];
            own[..corners.len()].copy_from_slice(corners);
            self.pieces.push(Piece {
                corners: own,
                count: corners.len() as u8,
            });
        }
    }

    /// Nodes that move it, by system number, ascending; none of a rigid shape, whose vertices are given.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Moves vertices (m) to a part of the way to them from the nodes above them, which are at `places` (m).
    pub fn shrink(&self, places: &[Vec3], part: f64, vertices: &mut [Vec3]) {
        let mut begin = 0;
        for (vertex, x) in self.vertices.iter().zip(vertices) {
            let node = &places[self.weights[begin].0 as usize];
            *x = [0, 1, 2].map(|i| node[i] + part * (x[i] - node[i]));
            begin = vertex.end as usize;
        }
    }

    /// Places of its vertices (m) where its nodes are at `places`.
    pub fn place(&self, places: &[Vec3], vertices: &mut Vec<Vec3>) {
        vertices.clear();
        let mut begin = 0;
        for vertex in &self.vertices {
            let mut place = [0.0; 3];
            for &(node, weight) in &self.weights[begin..vertex.end as usize] {
                let x = &places[node as usize];
                place = [0, 1, 2].map(|i| place[i] + weight * x[i]);
            }
            begin = vertex.end as usize;
            vertices.push(place);
        }
    }

    /// Mean diagonal of the box around a patch, m.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Number of patches.
    pub(super) fn patches(&self) -> usize {
        self.ends.len()
    }

    /// Numbers of the pieces of a patch.
    pub(super) fn pieces_of(&self, patch: usize) -> Range<usize> {
        let begin = patch.checked_sub(1).map_or(0, |before| self.ends[before]);
        begin as usize..self.ends[patch] as usize
    }

    pub(super) fn piece(&self, number: usize) -> &Piece {
        &self.pieces[number]
    }

    /// Distance that others are to keep from a piece, m.
    pub(super) fn keeps(&self, piece: &Piece) -> f64 {
        let keeps = piece.corners().iter();
        let keeps = keeps.map(|&vertex| self.vertices[vertex as usize].keeps);
        keeps.fold(f64::INFINITY, f64::min)
    }

    /// The largest distance that others are to keep from a vertex, m.
    pub fn most_kept(&self) -> f64 {
        let keeps = self.vertices.iter().map(|vertex| vertex.keeps);
        keeps.fold(0.0, f64::max)
    }

    /// The box around a patch with its vertices at these places.
    pub(super) fn bounds(&self, patch: usize, at: &[Vec3]) -> Bounds {
        let pieces = self.pieces_of(patch).map(|number| self.piece(number));
        pieces.fold(Bounds::EMPTY, |bounds, piece| {
            bounds.union(&self.bounds_of(piece, at))
        })
    }

    /// The box around a piece.
    pub(super) fn bounds_of(&self, piece: &Piece, at: &[Vec3]) -> Bounds {
        let corners = piece.corners().iter();
        corners.fold(Bounds::EMPTY, |bounds, &corner| {
            bounds.union(&Bounds::of(&[at[corner as usize]]))
        })
    }

    /// Most corners of a piece of a patch.
    pub(super) fn most_corners(&self, patch: usize) -> usize {
        let counts = self.pieces_of(patch);
        counts
            .map(|number| self.piece(number).corners().len())
            .max()
            .unwrap_or(0)
    }
}
