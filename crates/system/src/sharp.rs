//! Nodes of contacts at the sharp edges and corners of their surface.

use carom_contact::Integration;
use carom_mesh::Face;

use crate::contact_pair::ContactPair;
use crate::system::System;

/// Cosine of the angle between the normals of two faces from which on their common edge is sharp: 45°. Faces of a round surface that
/// are so far apart are four to a right angle, and fewer.
const SHARP: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Whether each contact point is at a sharp edge or corner of its surface, by the number of the point: a body that touches there touches in
/// a point or a line whatever the elements. Only of points that are nodes; the rim of a surface is none, where the body may go on smoothly.
pub(crate) fn points(contacts: &[ContactPair], x: &[[f64; 3]]) -> Vec<bool> {
    let of_contact = |contact: &ContactPair| -> Vec<bool> {
        if contact.integration != Integration::Node {
            return vec![false; contact.points.len()];
        }
        let nodes = sharp_nodes(contact.faces_of_points(), x);
        let points = contact.points.iter();
        let is_sharp = points.map(|point| nodes.binary_search(&point.node()).is_ok());
        is_sharp.collect()
    };
    contacts.iter().flat_map(of_contact).collect()
}

/// Ascending.
fn sharp_nodes(faces: &[Face], x: &[[f64; 3]]) -> Vec<u32> {
    let mut normals: Vec<(u32, [f64; 3])> = Vec::new();
    for face in faces.iter().filter(|face| face.radius.is_none()) {
        if let Some(normal) = normal(face, x) {
            normals.extend(face.corners().iter().map(|&node| (node, normal)));
        }
    }
    normals.sort_by_key(|(node, _)| *node);
    let around = normals.chunk_by(|a, b| a.0 == b.0);
    let turns = |around: &&[(u32, [f64; 3])]| {
        let mut pairs = around.iter().enumerate().flat_map(|(k, (_, a))| {
            let others = around[k + 1..].iter();
            others.map(move |(_, b)| (0..3).map(|i| a[i] * b[i]).sum::<f64>())
        });
        pairs.any(|cosine| cosine < SHARP)
    };
    around.filter(turns).map(|around| around[0].0).collect()
}

/// Unit normal of a face by its corners; none of a point.
fn normal(face: &Face, x: &[[f64; 3]]) -> Option<[f64; 3]> {
    let linear = face.kind.table().linear.table();
    let corners = &face.corners()[..linear.nodes];
    let way = |from: usize, to: usize| {
        let [a, b] = [from, to].map(|k| x[corners[k] as usize]);
        [0, 1, 2].map(|i| b[i] - a[i])
    };
    let normal = match corners.len() {
        2 => {
            let [x, y, _] = way(0, 1);
            [y, -x, 0.0]
        }
        3 => cross(way(0, 1), way(0, 2)),
        4 => cross(way(0, 2), way(1, 3)),
        _ => return None,
    };
    let size = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    (size > 0.0).then(|| normal.map(|n| n / size))
}

fn cross([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> [f64; 3] {
    [b * f - c * e, c * d - a * f, a * e - b * d]
}

impl System {
    /// Whether a contact point is at a sharp edge or corner of its surface.
    pub fn is_sharp(&self, point: usize) -> bool {
        self.sharp[point]
    }
}

#[cfg(test)]
mod tests {
    use carom_mesh::{ElementId, Group, Mesh, Surface, generate};

    use super::*;

    /// Faces of the lower and left sides of a square of eight elements a side.
    fn sides(mesh: &Mesh) -> Vec<Face> {
        let group = |name: &str| mesh.groups[name].elements.iter().copied();
        let sides: Vec<ElementId> = group("b.bottom").chain(group("b.left")).collect();
        let cells = &mesh.groups["b"].elements;
        Surface::new(mesh, &Group::new(1, sides), cells)
            .unwrap()
            .faces
    }

    #[test]
    fn a_corner_is_sharp_and_a_round_side_of_some_elements_is_not() {
        let mut mesh = generate::rectangle("b", [0.0; 2], [1.0, 1.0], [8, 8], false);
        let corner = |x: &[f64; 3]| x[0] == 0.0 && x[1] == 0.0;
        let node = mesh.nodes.iter().position(corner).unwrap() as u32;
        assert_eq!(sharp_nodes(&sides(&mesh), &mesh.nodes), [node]);
        // on a quarter of a circle: 90° over 16 elements
        for x in &mut mesh.nodes {
            let [s, t, _] = *x;
            let angle = std::f64::consts::PI * (1.25 + 0.25 * (s - t));
            let radius = 1.0 - 0.5 * s.min(t);
            *x = [radius * angle.cos(), radius * angle.sin(), 0.0];
        }
        assert!(sharp_nodes(&sides(&mesh), &mesh.nodes).is_empty());
    }
}
