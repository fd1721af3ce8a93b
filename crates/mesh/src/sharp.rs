//! Sharp edges of solids: where two faces of a surface meet convexly.

use std::collections::BTreeMap;

use carom_elements::Kind;

use crate::axes::{FOLD, normal};
use crate::{Face, Mesh, Rim, Surface, face_nodes};

/// A sharp convex edge between two straight faces of a solid, the axis of a beam or a sharp edge of a shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SharpEdge {
    /// The edge as a line of two nodes, which bounds the cell of the first of its faces.
    pub line: Face,
    /// Of each of its faces the further nodes next to its first and to its second end, of a triangle the same one; none of a line around which the
    /// surface is round.
    pub beside: Option<[[u32; 2]; 2]>,
    /// Its faces, by their places in the surface.
    pub faces: [u32; 2],
}

impl SharpEdge {
    /// The same edge with its nodes in other numbers.
    pub fn renumbered(self, number: impl Fn(u32) -> u32) -> SharpEdge {
        SharpEdge {
            line: self.line.renumbered(&number),
            beside: self
                .beside
                .map(|beside| beside.map(|nodes| nodes.map(&number))),
            ..self
        }
    }

    /// Length, m. `x`: coordinates by the numbers of its nodes.
    pub fn length(&self, x: &[[f64; 3]]) -> f64 {
        self.line.length(x)
    }
}

/// An edge as one of its faces has it.
struct Side {
    /// Place of the face in the surface.
    face: u32,
    /// Ends of the edge, in the order of the face.
    ends: [u32; 2],
    /// The nodes of the face before and after them.
    beside: [u32; 2],
}

impl Surface {
    /// Edges that exactly two straight faces of solids have, which meet convexly and at more than 40°, in the order of their nodes.
    pub fn sharp_edges_of_solids(&self, mesh: &Mesh) -> Vec<SharpEdge> {
        let mut of_edge: BTreeMap<[u32; 2], Vec<Side>> = BTreeMap::new();
        let is_straight =
            |face: &Face| face.radius.is_none() && matches!(face.kind, Kind::Tri3 | Kind::Quad4);
        let faces = self.faces.iter().zip(0..);
        for (face, number) in faces.filter(|(face, _)| is_straight(face)) {
            let nodes = face.corners();
            let at = |k: usize| nodes[k % nodes.len()];
            for k in 0..nodes.len() {
                let ends = [at(k), at(k + 1)];
                let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                of_edge.entry(key).or_default().push(Side {
                    face: number,
                    ends,
                    beside: [at(k + nodes.len() - 1), at(k + 2)],
                });
            }
        }
        let sharp = of_edge.values().filter_map(|sides| match &sides[..] {
            [one, other] if self.is_sharp(mesh, [one, other]) => Some([one, other]),
            _ => None,
        });
        sharp.map(|sides| self.sharp_edge(sides)).collect()
    }

    /// The edges of a surface that lines may cross between their nodes: sharp ones of solids, of a surface around axes and middles these and
    /// the sharp edges of shells.
    pub fn edges_to_cross(&self, mesh: &Mesh) -> Vec<SharpEdge> {
        if self.faces.iter().all(|face| face.radius.is_none()) {
            return self.sharp_edges_of_solids(mesh);
        }
        let axes = self.faces.iter().zip(0..);
        let axes = axes.filter(|(face, _)| face.is_round() && face.corners().len() == 2);
        let axes = axes.map(|(face, number)| (*face, number));
        let edges = self.sharp_edges(mesh).into_iter().filter_map(|line| {
            let has = |face: &Face| face.parent == line.parent;
            let number = self.faces.iter().position(has)?;
            Some((line, number as u32))
        });
        let lines = axes.chain(edges).map(|(line, number)| SharpEdge {
            line,
            beside: None,
            faces: [number; 2],
        });
        lines.collect()
    }

    /// Whether two faces meet convexly at an edge and at more than 40°.
    fn is_sharp(&self, mesh: &Mesh, sides: [&Side; 2]) -> bool {
        let normals = sides.map(|side| normal(mesh, &self.faces[side.face as usize]));
        let dot = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        let place = |node: u32| mesh.nodes[node as usize];
        // each face lies behind the plane of the other
        let is_behind = |k: usize| {
            let (from, to) = (place(sides[k].ends[0]), place(sides[1 - k].beside[1]));
            dot(&normals[k], &[0, 1, 2].map(|i| to[i] - from[i])) < 0.0
        };
        dot(&normals[0], &normals[1]) < FOLD && is_behind(0) && is_behind(1)
    }

    fn sharp_edge(&self, [one, other]: [&Side; 2]) -> SharpEdge {
        let [first, second] = other.beside;
        let of_other = match other.ends == one.ends {
            true => [first, second],
            false => [second, first],
        };
        SharpEdge {
            line: Face {
                kind: Kind::Bar2,
                nodes: face_nodes(&one.ends),
                parent: self.faces[one.face as usize].parent,
                axis: [0.0; 3],
                radius: None,
                rim: Rim::default(),
            },
            beside: Some([one.beside, of_other]),
            faces: [one.face, other.face],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;

    /// Two cubes side by side have the edges of a bar: 4 of 2 cells and 8 at the ends.
    #[test]
    fn edges_of_a_box_are_sharp_and_those_within_its_sides_are_not() {
        let mesh = generate::box_("a", [0.0; 3], [2.0, 1.0, 1.0], [2, 1, 1], false);
        let surface = Surface::outer(&mesh, &mesh.groups["a"].elements);
        let edges = surface.sharp_edges_of_solids(&mesh);
        assert_eq!(edges.len(), 16);
        for edge in &edges {
            assert!((edge.length(&mesh.nodes) - 1.0).abs() < 1e-15);
            for (face, beside) in edge.faces.iter().zip(edge.beside.unwrap()) {
                let nodes = surface.faces[*face as usize].corners();
                let ends = edge.line.corners();
                assert!(ends.iter().all(|node| nodes.contains(node)));
                for (end, node) in ends.iter().zip(beside) {
                    assert!(nodes.contains(&node) && !ends.contains(&node));
                    let apart = |axis: usize| {
                        mesh.nodes[*end as usize][axis] - mesh.nodes[node as usize][axis]
                    };
                    let length = (0..3).map(|axis| apart(axis).powi(2)).sum::<f64>().sqrt();
                    // a side of the face, not its diagonal
                    assert!((length - 1.0).abs() < 1e-15);
                }
            }
        }
    }

    /// A cell in the corner of an L of three makes an edge that is sharp and not convex.
    #[test]
    fn an_edge_that_is_not_convex_is_left_out() {
        let mesh = generate::box_("a", [0.0; 3], [2.0, 2.0, 1.0], [2, 2, 1], false);
        let all = mesh.groups["a"].elements.clone();
        let of_all = Surface::outer(&mesh, &all).sharp_edges_of_solids(&mesh);
        let three = Surface::outer(&mesh, &all[..3]).sharp_edges_of_solids(&mesh);
        // around both ends 8 edges, and upright ones: four of the square, five of the L
        assert_eq!((of_all.len(), three.len()), (16 + 4, 16 + 5));
    }
}
