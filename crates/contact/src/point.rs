//! The points at which a contact is looked at: nodes of the secondary surface or of both, Gauss points of faces, places between nodes.

use carom_elements::{Kind, MAX_FACE_NODES, map};
use carom_mesh::{Face, SharpEdge};

use crate::Places;

/// What of the target a line or a face of the secondary surface may meet between its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Crossed {
    /// Axes of beams and sharp edges of shells among the faces of the target.
    Lines,
    /// The edges of the contact ([`Contact::edges`](crate::Contact::edges)): of two that it meets one, of which is the first or the second.
    Edges { is_second: bool },
    /// A ball or a cylinder: the point is the place of a line or a face that is nearest to it.
    Round,
}

/// The nodes of the line of a point that faces the edges of the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct EdgeNodes {
    pub(crate) ends: [u32; 2],
    /// Of each of its two faces the further nodes next to both ends; none of the axis of a beam and of the edge of a shell.
    pub(crate) beside: Option<[[u32; 2]; 2]>,
}

/// A point of the secondary surface that carries a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Nodes of its face, by system number; the first `count` are used. For a node, itself; behind it `beside` others of its faces. Behind the
    /// ends of a sharp edge the further nodes of each of its two faces next to them.
    nodes: [u32; MAX_FACE_NODES],
    beside: usize,
    /// Values of their shape functions in the point.
    shape: [f64; MAX_FACE_NODES],
    count: usize,
    /// Surface that it stands for, in m²: ∫ N_a dΓ of a node, the weight w of a Gauss point.
    pub area: f64,
    /// Its share in the surface of the contact; the shares add up to 1.
    pub share: f64,
    /// Distance of the surface from the place of the point, m: zero but around axes of beams. Gaps are less by it, and friction
    /// acts at this distance.
    pub radius: f64,
    /// What of the target it is nearest to, of the places between its two nodes, if it is the nearest of these.
    crosses: Option<Crossed>,
    /// Whether it is on the primary side of a contact that looks both ways: its force acts on the secondary side with the opposite sign.
    on_primary: bool,
}

impl Point {
    /// A node (`integration = "node"`). `area` in m².
    pub fn at_node(node: u32, area: f64, share: f64) -> Point {
        let mut point = Point {
            nodes: [0; MAX_FACE_NODES],
            beside: 0,
            shape: [0.0; MAX_FACE_NODES],
            count: 1,
            area,
            share,
            radius: 0.0,
            crosses: None,
            on_primary: false,
        };
        (point.nodes[0], point.shape[0]) = (node, 1.0);
        point
    }

    /// The point at another distance from the surface, m.
    pub fn around(self, radius: f64) -> Point {
        Point { radius, ..self }
    }

    /// The point on the primary side of a contact that looks both ways.
    pub fn on_primary(self) -> Point {
        Point {
            on_primary: true,
            ..self
        }
    }

    /// Whether it is on the primary side of a contact that looks both ways.
    pub fn is_on_primary(&self) -> bool {
        self.on_primary
    }

    /// What the sum of its row over its own nodes is on the secondary side.
    pub(crate) fn on_secondary(&self, sum: [f64; 3]) -> [f64; 3] {
        match self.on_primary {
            true => sum.map(|s| -s),
            false => sum,
        }
    }

    /// Lets a node know a face that it is on, by the nodes of the face: it keeps as many as there is room for.
    pub fn add_face(&mut self, face: &[u32]) {
        for &node in face {
            let known = self.count + self.beside;
            if known < MAX_FACE_NODES && !self.nodes[..known].contains(&node) {
                self.nodes[known] = node;
                self.beside += 1;
            }
        }
    }

    /// The mean place of the other nodes of its faces, m: the side of the point on which its surface lies. `None` of a node without a face
    /// that it knows.
    pub(crate) fn behind(&self, places: &Places) -> Option<[f64; 3]> {
        let known = &self.nodes[..self.count + self.beside];
        let others = if self.count == 1 { &known[1..] } else { known };
        let mut sum = [0.0; 3];
        for &node in others {
            let x = places.of(node);
            (0..3).for_each(|i| sum[i] += x[i]);
        }
        let count = others.len() as f64;
        (!others.is_empty()).then(|| sum.map(|sum| sum / count))
    }

    /// The place of the axis of a beam that is nearest to another one which it crosses. `area` in m².
    pub fn crossing(axis: &Face, area: f64) -> Point {
        Point {
            area,
            radius: axis.radius.unwrap_or(0.0),
            crosses: Some(Crossed::Lines),
            ..Point::on_face(axis, &[0.0; 3])
        }
    }

    /// The place of a sharp edge of a solid, of an axis or of the edge of a shell that is nearest to an edge of the target which it crosses.
    /// `area` in m²; it has no share in the surface, whose nodes stand for all of it.
    pub fn at_edge(edge: &SharpEdge, area: f64) -> Point {
        let mut point = Point {
            crosses: Some(Crossed::Edges { is_second: false }),
            ..Point::crossing(&edge.line, area)
        };
        if let Some(beside) = edge.beside {
            point.nodes[2..6].copy_from_slice(beside.as_flattened());
            point.beside = 4;
        }
        point
    }

    /// The second point of the same edge: an edge that is long against the other body crosses two edges of it.
    pub fn second(self) -> Point {
        Point {
            crosses: Some(Crossed::Edges { is_second: true }),
            ..self
        }
    }

    /// Whether it stands for no part of the surface, which nodes stand for: it faces edges or what is round from between these.
    pub fn stands_between(&self) -> bool {
        self.is_at_edge() || self.faces_round()
    }

    /// Whether it is the second point of an edge.
    pub(crate) fn is_second(&self) -> bool {
        self.crosses == Some(Crossed::Edges { is_second: true })
    }

    /// The place of a line of two nodes, or of a face of three or four, that is nearest to a ball or a cylinder. `beside`: of a line between faces a
    /// further node of each, two at most; `radius`, `area` and `share` as those of nodes.
    pub fn near_round(
        nodes: &[u32],
        beside: &[u32],
        (radius, area, share): (f64, f64, f64),
    ) -> Point {
        let mut point = Point::at_node(0, area, share).around(radius);
        (point.count, point.beside) = (nodes.len(), beside.len());
        point.crosses = Some(Crossed::Round);
        point.nodes[..nodes.len()].copy_from_slice(nodes);
        point.nodes[nodes.len()..nodes.len() + beside.len()].copy_from_slice(beside);
        point.shape[..nodes.len()].fill(1.0 / nodes.len() as f64);
        point
    }

    /// Whether it faces a ball or a cylinder from between nodes ([`Point::near_round`]).
    pub fn faces_round(&self) -> bool {
        self.crosses == Some(Crossed::Round)
    }

    /// Nodes of its faces that do not carry it.
    pub(crate) fn nodes_beside(&self) -> &[u32] {
        &self.nodes[self.count..self.count + self.beside]
    }

    /// The point at another place of its face.
    pub(crate) fn moved_on(mut self, kind: Kind, xi: &[f64; 3]) -> Point {
        (kind.table().shape)(xi, &mut self.shape[..self.count]);
        self
    }

    /// Whether it faces the edges of the target ([`Point::at_edge`]).
    pub fn is_at_edge(&self) -> bool {
        matches!(self.crosses, Some(Crossed::Edges { .. }))
    }

    /// Of a point of a sharp edge of a solid the further nodes of each of its two faces, which decide what it faces; none of others.
    pub fn beside_edge(&self) -> &[u32] {
        match self.is_at_edge() {
            true => self.nodes_beside(),
            false => &[],
        }
    }

    /// The nodes of its line, of a point that faces the edges of the target ([`Point::at_edge`]).
    pub(crate) fn edge(&self) -> Option<EdgeNodes> {
        let [a, b, c, d, e, f, ..] = self.nodes;
        self.is_at_edge().then(|| EdgeNodes {
            ends: [a, b],
            beside: (self.beside == 4).then_some([[c, d], [e, f]]),
        })
    }

    /// The point with its nodes in other numbers.
    pub(crate) fn renumbered(mut self, number: impl Fn(u32) -> u32) -> Point {
        for node in &mut self.nodes[..self.count + self.beside] {
            *node = number(*node);
        }
        self
    }

    /// Its node, if it is one.
    pub(crate) fn as_node(&self) -> Option<u32> {
        (self.count == 1).then_some(self.nodes[0])
    }

    /// Whether it stands at no fixed place between its nodes ([`Point::crossing`]).
    pub fn crosses(&self) -> bool {
        self.crosses.is_some()
    }

    /// The point at another place between its two nodes, by the reference coordinate of the line.
    pub(crate) fn moved_to(mut self, xi: f64) -> Point {
        (self.shape[0], self.shape[1]) = (0.5 * (1.0 - xi), 0.5 * (1.0 + xi));
        self
    }

    /// The Gauss points of faces, face after face: those of the rule that is exact for N_a N_b on an affine face, as
    /// many as the face has nodes. The end of a bar has one point of weight 1.
    ///
    /// `x`: reference coordinates by system number, m. `factor`: area in m² that a unit of the measure of the faces
    /// stands for at a place: a thickness in m, 2πr, the section of a bar, 1.
    pub fn of_faces(
        faces: &[Face],
        x: &[[f64; 3]],
        factor: impl Fn(&[f64; 3]) -> f64,
    ) -> Vec<Point> {
        let mut points = Vec::new();
        for face in faces {
            let (table, corners) = (face.kind.table(), face.corners());
            let mut places = [[0.0; 3]; MAX_FACE_NODES];
            for (place, &node) in places.iter_mut().zip(corners) {
                *place = x[node as usize];
            }
            let rule = table.mass_rule;
            for (xi, weight) in rule.points.iter().zip(rule.weights) {
                let mut point = Point::on_face(face, xi).around(face.radius.unwrap_or(0.0));
                let mut gradients = [[0.0; 3]; MAX_FACE_NODES];
                (table.gradient)(xi, &mut gradients[..corners.len()]);
                let places = &places[..corners.len()];
                let (measure, _) = map::measure(places, &gradients[..corners.len()], table.dim);
                let place = map::point(places, &point.shape[..corners.len()]);
                point.area = weight * measure * factor(&place);
                points.push(point);
            }
        }
        let total: f64 = points.iter().map(|point| point.area).sum();
        for point in &mut points {
            point.share = point.area / total;
        }
        points
    }

    /// A place of a face, by its reference coordinates; it stands for no area.
    pub(crate) fn on_face(face: &Face, xi: &[f64; 3]) -> Point {
        let nodes = face.corners();
        let mut point = Point {
            nodes: [0; MAX_FACE_NODES],
            beside: 0,
            shape: [0.0; MAX_FACE_NODES],
            count: nodes.len(),
            area: 0.0,
            share: 0.0,
            radius: 0.0,
            crosses: None,
            on_primary: false,
        };
        point.nodes[..nodes.len()].copy_from_slice(nodes);
        (face.kind.table().shape)(xi, &mut point.shape[..nodes.len()]);
        point
    }

    /// Values of the shape functions of its nodes in the point, zero beyond their number.
    pub(crate) fn shape(&self) -> &[f64; MAX_FACE_NODES] {
        &self.shape
    }

    /// Nodes that carry the point, by system number, and the values of their shape functions in it.
    pub fn carriers(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let nodes = self.nodes[..self.count].iter().copied();
        nodes.zip(self.shape.iter().copied())
    }

    /// The node whose shape function is largest in the point; the first of equals.
    pub fn node(&self) -> u32 {
        let larger = |best: usize, k: usize| match self.shape[k] > self.shape[best] {
            true => k,
            false => best,
        };
        self.nodes[(1..self.count).fold(0, larger)]
    }

    /// Current position in m.
    pub fn place(&self, places: &Places) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (node, n) in self.carriers() {
            let x = places.of(node);
            for i in 0..3 {
                sum[i] += n * x[i];
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use carom_algebra::unknowns::Unknowns;
    use carom_mesh::{ElementId, Rim, face_nodes};

    use super::*;
    use crate::Frames;

    fn face(kind: Kind, nodes: &[u32]) -> Face {
        Face {
            kind,
            nodes: face_nodes(nodes),
            parent: ElementId { block: 0, index: 0 },
            axis: [1.0, 0.0, 0.0],
            radius: None,
            rim: Rim::default(),
        }
    }

    #[test]
    fn gauss_points_measure_a_surface_and_its_first_moments() {
        // a trapezoid: its map is not affine, but area and first moments are of degree 3 in each variable
        let x = [
            [0.0, 0.0, 1.0],
            [3.0, 0.0, 1.0],
            [2.0, 2.0, 1.0],
            [0.0, 2.0, 1.0],
        ];
        let points = Point::of_faces(&[face(Kind::Quad4, &[0, 1, 2, 3])], &x, |_| 0.5);
        let places = Places {
            unknowns: &Unknowns::translations(3, 4),
            time: 0.0,
            x: &x,
            u: &[0.0; 12],
            frames: Frames::default(),
        };
        let moment = |i: usize| -> f64 {
            points
                .iter()
                .map(|point| point.area * point.place(&places)[i])
                .sum()
        };
        let area: f64 = points.iter().map(|point| point.area).sum();
        // a square of 2 m and a triangle of 1 m x 2 m beside it, times 0.5
        assert!((area - 0.5 * 5.0).abs() < 1e-14);
        assert!((moment(0) - 0.5 * (4.0 + 7.0 / 3.0)).abs() < 1e-14);
        assert!((moment(1) - 0.5 * (4.0 + 2.0 / 3.0)).abs() < 1e-14);
        let shares: f64 = points.iter().map(|point| point.share).sum();
        assert!((shares - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_end_of_a_bar_is_one_point_and_the_node_itself() {
        let x = [[0.0; 3], [2.0, 0.0, 0.0]];
        let points = Point::of_faces(&[face(Kind::Point1, &[1])], &x, |_| 3.0);
        assert_eq!(points, [Point::at_node(1, 3.0, 1.0)]);
    }
}
