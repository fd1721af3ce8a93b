//! How far the ends of springs, dashpots and fluid gaps move across their axis, which is fixed in space.

use carom_mesh::Mesh;

/// The element whose ends have moved farthest across its axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Across {
    /// Their relative displacement across the axis, m.
    pub across: f64,
    /// Size of that along it, m.
    pub along: f64,
    /// Place of the element among those of its body.
    pub place: u32,
}

/// Lengths of elements, m: between their ends, where these are apart; otherwise, as on the ground, the size of the mesh, which is zero of a
/// single point.
pub(super) fn lengths(mesh: &Mesh, ends: impl Iterator<Item = [u32; 2]>) -> Vec<f64> {
    let [mut low, mut high] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for x in &mesh.nodes {
        for i in 0..3 {
            (low[i], high[i]) = (low[i].min(x[i]), high[i].max(x[i]));
        }
    }
    let size = distance(&low, &high);
    let length = |ends: [u32; 2]| {
        let [a, b] = ends.map(|node| &mesh.nodes[node as usize]);
        match distance(a, b) {
            apart if apart > TOUCHING * size => apart,
            _ => size,
        }
    };
    ends.map(length).collect()
}

/// Distance of two ends, over the size of the mesh, up to which they stand at the same place.
const TOUCHING: f64 = 1e-9;

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (b - a) * (b - a));
    squares.sum::<f64>().sqrt()
}

/// The farthest across the axis of some relative displacements, m.
pub(super) fn farthest(axis: &[f64; 3], ways: impl Iterator<Item = [f64; 3]>) -> Across {
    let mut found = Across::default();
    for (place, way) in ways.enumerate() {
        let along: f64 = (0..3).map(|i| axis[i] * way[i]).sum();
        let aside = [0, 1, 2].map(|i| way[i] - along * axis[i]);
        let across = distance(&[0.0; 3], &aside);
        if across > found.across {
            found = Across {
                across,
                along: along.abs(),
                place: place as u32,
            };
        }
    }
    found
}
