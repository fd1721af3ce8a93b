//! Points between the nodes of a surface that face a ball or a cylinder: one that is small against the faces meets them between nodes.

use std::collections::BTreeMap;

use carom_contact::{Integration, Obstacle, Point, Shape, Sliding};
use carom_elements::Kind;
use carom_mesh::{Face, Mesh, Surface};

use crate::model::{ModelContact, ModelTarget};

/// Diagonal of a face over the radius of what is around obstacle and surface together, from which on it has points between its nodes: the arc over the
/// diagonal d is then d²/8R = d/20 high, as deep as surfaces may go without a force.
const LARGE: f64 = 0.4;

/// The points of a contact between its nodes; none of obstacles that are not round. `own`: its nodes, of which points between them have the mean area
/// and share.
pub(crate) fn points_between(
    contact: &ModelContact,
    (mesh, number): (&Mesh, &[u32]),
    own: &[Point],
) -> Vec<Point> {
    let ModelTarget::Rigid(obstacle) = &contact.primary else {
        return Vec::new();
    };
    let at_nodes = contact.integration == Integration::Node;
    let slides = contact.sliding == Sliding::Finite;
    let Some(radius) = obstacle.round().filter(|_| at_nodes && slides) else {
        return Vec::new();
    };
    let surface = &contact.secondary;
    let large = |face: &Face| {
        let linear = matches!(face.kind, Kind::Bar2 | Kind::Tri3 | Kind::Quad4);
        let around = radius + face.radius.unwrap_or(0.0);
        linear && diagonal(face, mesh) > LARGE * around
    };
    let of_nodes: BTreeMap<u32, &Point> = own.iter().map(|point| (point.node(), point)).collect();
    let point = |nodes: &[u32], beside: &[u32], radius: Option<f64>| {
        let [nodes, beside] =
            [nodes, beside].map(|of| of.iter().map(|&node| number[node as usize]).collect());
        let nodes: Vec<u32> = nodes;
        let known = || nodes.iter().filter_map(|node| of_nodes.get(node));
        let mean = |of: fn(&Point) -> f64| {
            known().map(|point| of(point)).sum::<f64>() / nodes.len() as f64
        };
        let [area, share] = [mean(|point| point.area), mean(|point| point.share)];
        let beside: Vec<u32> = beside;
        Point::near_round(&nodes, &beside, (radius.unwrap_or(0.0), area, share))
    };
    let mut points = Vec::new();
    for face in surface.faces.iter().filter(|face| large(face)) {
        if face.kind == Kind::Bar2 || is_ball(obstacle) {
            points.push(point(face.corners(), &[], face.radius));
        }
    }
    for edge in edges(surface, large) {
        points.push(point(&edge.ends, &edge.beside, edge.radius));
    }
    points
}

fn is_ball(obstacle: &Obstacle) -> bool {
    matches!(obstacle.shape, Shape::Sphere(_))
}

/// m.
fn diagonal(face: &Face, mesh: &Mesh) -> f64 {
    let corners = || face.corners().iter().map(|&node| mesh.nodes[node as usize]);
    let extent = |i: usize| {
        let (least, most) = corners().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(x[i]), b.max(x[i]))
        });
        most - least
    };
    (0..3).map(|i| extent(i).powi(2)).sum::<f64>().sqrt()
}

/// An edge of plane faces.
struct Edge {
    ends: [u32; 2],
    /// A further node of each of its faces.
    beside: Vec<u32>,
    radius: Option<f64>,
}

/// Edges of faces in space of which one at least `is_large`, with two faces at most.
fn edges(surface: &Surface, is_large: impl Fn(&Face) -> bool) -> Vec<Edge> {
    let mut all: BTreeMap<[u32; 2], (Edge, bool)> = BTreeMap::new();
    for face in &surface.faces {
        if !matches!(face.kind, Kind::Tri3 | Kind::Quad4) {
            continue;
        }
        let nodes = face.corners();
        let at = |k: usize| nodes[k % nodes.len()];
        for k in 0..nodes.len() {
            let ends = [at(k), at(k + 1)];
            let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            let (edge, large) = all.entry(key).or_insert_with(|| {
                let edge = Edge {
                    ends,
                    beside: Vec::new(),
                    radius: face.radius,
                };
                (edge, false)
            });
            edge.beside.push(at(k + 2));
            *large |= is_large(face);
        }
    }
    let kept = all.into_values();
    kept.filter(|(edge, large)| *large && edge.beside.len() <= 2)
        .map(|(edge, _)| edge)
        .collect()
}
