//! Finds the rims and sharp ridges of surfaces, and the faces across the edges of each.

use std::collections::{BTreeMap, BTreeSet};

use carom_elements::{MAX_FACE_NODES, map};

use crate::rim::{Marks, edges};
use crate::vector::{difference, dot};
use crate::{Face, Rim};

/// Cosine of the angle from which on a rim turns, 45°: what a rim that turns less lets beside it along one of its edges is no further over the other.
const TURN: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The largest number of edges of a face.
const EDGES: usize = 4;

/// Cosine of the angle by which a ridge is sharp, 45°: what falls beside a face along its normal, not further from it than it is above it, passes the
/// face across the edge of a flatter ridge no deeper than that.
const SHARP: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Rim {
    /// Finds the rims and sharp ridges of all faces of a surface. `x`: place of a node in the reference configuration, m; `same`: a number that
    /// nodes at one place share, if they never part; the node itself otherwise. Points have none.
    pub fn mark(faces: &mut [Face], x: impl Fn(u32) -> [f64; 3], same: impl Fn(u32) -> u32) {
        let mut of_edge: BTreeMap<[u32; 2], Vec<(u32, usize)>> = BTreeMap::new();
        for (face, number) in faces.iter().zip(0..) {
            for edge in 0..edges(face.kind) {
                let all = of_edge.entry(ends(face, edge, &same)).or_default();
                all.push((number, edge));
            }
        }
        let is_sharp = |all: &[(u32, usize)]| match *all {
            [one, other] => {
                let sides =
                    [one, other].map(|(face, edge)| Side::of(&faces[face as usize], edge, &x));
                sides[0].is_sharp_with(&sides[1])
            }
            _ => false,
        };
        let border = of_edge.iter().filter(|(_, all)| all.len() == 1);
        let border = Marked::new(border.map(|(ends, _)| *ends));
        let ridge = of_edge.iter().filter(|(_, all)| is_sharp(all));
        let ridge = Marked::new(ridge.map(|(ends, _)| *ends));
        let turns = turns(faces, &border, &x, &same);
        for face in faces {
            let turned = |corner: &usize| turns.contains(&same(face.nodes[*corner]));
            face.rim = Rim {
                border: border.of(face, &same),
                ridge: ridge.of(face, &same),
                turns: bits((0..edges(face.kind)).filter(turned)),
            };
        }
    }
}

/// Edges of a surface, and the nodes at their ends.
struct Marked {
    edges: BTreeSet<[u32; 2]>,
    nodes: BTreeSet<u32>,
}

impl Marked {
    fn new(edges: impl Iterator<Item = [u32; 2]>) -> Marked {
        let edges: BTreeSet<[u32; 2]> = edges.collect();
        Marked {
            nodes: edges.iter().flatten().copied().collect(),
            edges,
        }
    }

    fn of(&self, face: &Face, same: &impl Fn(u32) -> u32) -> Marks {
        let all = 0..edges(face.kind);
        let has_edge = |edge: &usize| self.edges.contains(&ends(face, *edge, same));
        let has_node = |corner: &usize| self.nodes.contains(&same(face.nodes[*corner]));
        Marks {
            edges: bits(all.clone().filter(has_edge)),
            corners: bits(all.filter(has_node)),
        }
    }
}

/// The nodes at which the rim of a surface of faces turns: those of its lines that meet there are not two, or not in line.
fn turns(
    faces: &[Face],
    border: &Marked,
    x: &impl Fn(u32) -> [f64; 3],
    same: &impl Fn(u32) -> u32,
) -> BTreeSet<u32> {
    let mut ways: BTreeMap<u32, Vec<[f64; 3]>> = BTreeMap::new();
    for face in faces.iter().filter(|face| face.kind.table().dim == 2) {
        for edge in 0..edges(face.kind) {
            if !border.edges.contains(&ends(face, edge, same)) {
                continue;
            }
            let nodes = face.kind.table().faces[edge].nodes;
            let [a, b] = [nodes[0], nodes[1]].map(|k| face.nodes[k]);
            for (from, to) in [(a, b), (b, a)] {
                let way = difference(&x(to), &x(from));
                ways.entry(same(from)).or_default().push(way);
            }
        }
    }
    let is_turn = |ways: &[[f64; 3]]| match ways {
        [one, other] => {
            let lengths = (dot(one, one) * dot(other, other)).sqrt();
            dot(one, other) > -TURN * lengths
        }
        _ => true,
    };
    let turning = ways.into_iter().filter(|(_, ways)| is_turn(ways));
    turning.map(|(node, _)| node).collect()
}

/// A face at the middle of one of its edges.
struct Side {
    at: [f64; 3],
    normal: [f64; 3],
    /// Mean of its nodes, m.
    middle: [f64; 3],
}

impl Side {
    fn of(face: &Face, edge: usize, x: &impl Fn(u32) -> [f64; 3]) -> Side {
        let table = face.kind.table();
        let mut places = [[0.0; 3]; MAX_FACE_NODES];
        for (place, &node) in places.iter_mut().zip(face.corners()) {
            *place = x(node);
        }
        let places = &places[..table.nodes];
        let nodes = table.faces[edge].nodes;
        let last = nodes[1.min(nodes.len() - 1)];
        let [a, b] = [nodes[0], last].map(|k| table.reference[k]);
        let xi = [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]));
        let (mut n, mut dn) = ([0.0; MAX_FACE_NODES], [[0.0; 3]; MAX_FACE_NODES]);
        (table.shape)(&xi, &mut n[..table.nodes]);
        (table.gradient)(&xi, &mut dn[..table.nodes]);
        Side {
            at: map::point(places, &n[..table.nodes]),
            normal: map::measure(places, &dn[..table.nodes], table.dim).1,
            middle: map::point(
                places,
                &[1.0 / table.nodes as f64; MAX_FACE_NODES][..table.nodes],
            ),
        }
    }

    /// Whether the surface falls off sharply from here to the face across the edge.
    fn is_sharp_with(&self, other: &Side) -> bool {
        let falls = dot(&self.normal, &difference(&other.middle, &other.at)) < 0.0;
        falls && dot(&self.normal, &other.normal) < SHARP
    }
}

/// Numbers of the faces across each edge of the faces of a surface, the first of several; none at the rim.
pub fn across(faces: &[Face]) -> Vec<[Option<u32>; EDGES]> {
    let mut of_edge: BTreeMap<[u32; 2], [Option<u32>; 2]> = BTreeMap::new();
    for (face, number) in faces.iter().zip(0..) {
        for edge in 0..edges(face.kind) {
            let both = of_edge.entry(ends(face, edge, &|node| node)).or_default();
            match both {
                [None, _] => both[0] = Some(number),
                [_, None] => both[1] = Some(number),
                _ => {}
            }
        }
    }
    let other = |face: &Face, own: u32, edge: usize| {
        let both = of_edge.get(&ends(face, edge, &|node| node))?;
        both.iter().flatten().copied().find(|number| *number != own)
    };
    let with = faces.iter().zip(0..);
    with.map(|(face, own)| {
        std::array::from_fn(|edge| (edge < edges(face.kind)).then(|| other(face, own, edge))?)
    })
    .collect()
}

/// Nodes at the ends of an edge, the lower number first; of an end of a line that node twice.
fn ends(face: &Face, edge: usize, same: &impl Fn(u32) -> u32) -> [u32; 2] {
    let nodes = face.kind.table().faces[edge].nodes;
    let [a, b] = [nodes[0], nodes[1.min(nodes.len() - 1)]].map(|k| same(face.nodes[k]));
    [a.min(b), a.max(b)]
}

fn bits(numbers: impl Iterator<Item = usize>) -> u8 {
    numbers.fold(0, |bits, number| bits | 1 << number)
}

#[cfg(test)]
mod tests {
    use carom_elements::Kind;

    use super::*;
    use crate::{ElementId, face_nodes};

    fn face(kind: Kind, nodes: &[u32]) -> Face {
        Face {
            kind,
            nodes: face_nodes(nodes),
            parent: ElementId { block: 0, index: 0 },
            axis: [0.0; 3],
            radius: None,
            rim: Rim::default(),
        }
    }

    fn holds(face: &Face, xi: [f64; 2]) -> bool {
        face.rim.holds(face.kind, &[xi[0], xi[1], 0.0])
    }

    #[test]
    fn the_rim_of_a_line_is_the_end_that_no_other_line_has() {
        let mut faces = [face(Kind::Bar2, &[1, 0]), face(Kind::Bar3, &[2, 1, 3])];
        let x = |node: u32| [f64::from(node.min(2)), 0.0, 0.0];
        Rim::mark(&mut faces, x, |node| node);
        assert_eq!(
            [-1.0, 1.0].map(|xi| holds(&faces[0], [xi, 0.0])),
            [false, true]
        );
        assert_eq!(
            [-1.0, 1.0].map(|xi| holds(&faces[1], [xi, 0.0])),
            [true, false]
        );
        let mut closed = [[0, 1], [1, 2], [2, 0]].map(|nodes| face(Kind::Bar2, &nodes));
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        Rim::mark(&mut closed, |node| corners[node as usize], |node| node);
        assert!(closed.iter().all(|face| !holds(face, [1.0, 0.0])));
    }

    #[test]
    fn the_rim_of_a_sheet_is_its_border_with_the_corners_that_touch_it_alone() {
        // two quadrilaterals side by side, a triangle on both: of its edges one is bare
        //   5 - 4 - 3
        //   |   |   |
        //   0 - 1 - 2
        let mut faces = [
            face(Kind::Quad4, &[0, 1, 4, 5]),
            face(Kind::Quad4, &[1, 2, 3, 4]),
            face(Kind::Tri3, &[4, 3, 6]),
        ];
        let flat = |node: u32| {
            let x = [0.0, 1.0, 2.0, 2.0, 1.0, 0.0, 1.5][node as usize];
            [x, f64::from(node / 3), 0.0]
        };
        Rim::mark(&mut faces, flat, |node| node);
        let [left, right, top] = faces;
        assert!(holds(&left, [0.3, -1.0]) && holds(&left, [-1.0, 0.3]) && holds(&left, [0.3, 1.0]));
        assert!(
            !holds(&left, [1.0, 0.3]) && !holds(&right, [-1.0, 0.0]) && !holds(&right, [0.1, 1.0])
        );
        // the corners at the ends of the edge between both are on the border
        assert!(
            holds(&left, [1.0, 1.0]) && holds(&left, [1.0, -1.0]) && holds(&right, [-1.0, 1.0])
        );
        assert!(!holds(&top, [0.5, 0.0]) && holds(&top, [0.4, 0.6]) && holds(&top, [0.0, 0.2]));
        assert_eq!(across(&faces)[1], [None, None, Some(2), Some(0)]);
        assert_eq!(across(&faces)[2], [Some(1), None, None, None]);
    }

    #[test]
    fn a_rim_turns_at_its_corners_and_where_it_meets_itself() {
        // two triangles share the corner 1 of a square, whose side 1-2 goes on straight to 4 beside a third
        //   3 - 2
        //   | / |
        //   0 - 1
        //    \\ |
        //     (4, below 1)
        let mut faces = [
            face(Kind::Tri3, &[0, 1, 2]),
            face(Kind::Tri3, &[0, 2, 3]),
            face(Kind::Tri3, &[0, 4, 1]),
        ];
        let x = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0, -0.3, 0.0],
        ];
        Rim::mark(&mut faces, |node| x[node as usize], |node| node);
        let edge = |k: usize, xi: [f64; 2]| faces[k].rim.edge(Kind::Tri3, &[xi[0], xi[1], 0.0]);
        // in the middle of the side, and at 1, where it goes straight on
        assert_eq!(edge(0, [0.5, 0.5]), Some(1));
        assert_eq!(edge(0, [1.0, 0.0]), Some(1));
        assert_eq!(edge(2, [0.0, 1.0]), Some(1));
        // the corner 2, and a diagonal inside
        assert_eq!(edge(0, [0.0, 1.0]), None);
        assert_eq!(edge(1, [1.0, 0.0]), None);
        assert_eq!(edge(0, [0.3, 0.0]), None);
    }

    #[test]
    fn nodes_at_one_place_join_faces_that_share_no_node() {
        let mut faces = [face(Kind::Bar2, &[1, 0]), face(Kind::Bar2, &[3, 2])];
        let x = |node: u32| [f64::from(node), 0.0, 0.0];
        Rim::mark(&mut faces, x, |node| if node == 2 { 1 } else { node });
        assert!(!holds(&faces[0], [-1.0, 0.0]) && !holds(&faces[1], [1.0, 0.0]));
    }

    #[test]
    fn a_ridge_is_sharp_from_45_degrees_on_and_a_fold_never() {
        // the second line turns down by this angle, in degrees, from the first; up if negative
        let ridge = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let x = [[-1.0, 0.0, 0.0], [0.0; 3], [cos, -sin, 0.0]];
            // seen from above lines run to the left
            let mut faces = [face(Kind::Bar2, &[1, 0]), face(Kind::Bar2, &[2, 1])];
            Rim::mark(&mut faces, |node| x[node as usize], |node| node);
            let [one, other] = faces.map(|face| face.rim);
            let is_ridge = |rim: Rim, xi: f64| rim.is_ridge(Kind::Bar2, &[xi, 0.0, 0.0]);
            assert!(!is_ridge(one, 1.0) && !is_ridge(other, -1.0));
            assert_eq!(is_ridge(one, -1.0), is_ridge(other, 1.0));
            is_ridge(one, -1.0)
        };
        assert_eq!(
            [30.0, 44.0, 46.0, 90.0, 150.0].map(ridge),
            [false, false, true, true, true]
        );
        assert_eq!([-30.0, -46.0, -90.0, -150.0].map(ridge), [false; 4]);
    }
}
