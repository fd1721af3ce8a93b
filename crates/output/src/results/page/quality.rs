//! The scaled Jacobian of the cells: how far their corners are from those of the regular element.
//!
//! The determinant of the unit vectors along the edges that meet in a corner, over that of the regular element, least over the
//! corners: 1 of a square, an equilateral triangle, a cube, a regular tetrahedron; 0 or less of a cell that is flat or inverted in a corner. Middle nodes
//! are left out. Knupp (2000), *Achieving finite element mesh quality via optimization of the Jacobian matrix norm*; as in the library
//! Verdict.

use std::f64::consts::SQRT_2;

use carom_dynamics::System;
use carom_elements::Kind;
use serde::Serialize;

/// The quality of the cells of a body.
#[derive(Clone, Debug, Serialize)]
pub struct BodyQuality {
    /// Name of the body.
    pub body: String,
    /// Cells that have a quality: those with an area or a volume.
    pub cells: usize,
    /// Least scaled Jacobian, and mean.
    pub least: f64,
    /// See `least`.
    pub mean: f64,
    /// Kind of the worst cell and its number among those of its kind in the mesh, and its middle, m.
    pub worst: String,
    /// See `worst`.
    pub place: [f64; 3],
    /// Longest over shortest edge of all cells.
    pub edges: f64,
}

/// The corners of a kind of element with the ends of their edges, turning to the inside, and the determinant of the regular element.
fn corners(kind: Kind) -> Option<(&'static [[usize; 4]], f64)> {
    // of an area the last entry is not used
    const TRI: &[[usize; 4]] = &[[0, 1, 2, 0], [1, 2, 0, 0], [2, 0, 1, 0]];
    const QUAD: &[[usize; 4]] = &[[0, 1, 3, 0], [1, 2, 0, 0], [2, 3, 1, 0], [3, 0, 2, 0]];
    const TET: &[[usize; 4]] = &[[0, 1, 2, 3], [1, 2, 0, 3], [2, 0, 1, 3], [3, 0, 2, 1]];
    const PYRAMID: &[[usize; 4]] = &[[0, 1, 3, 4], [1, 2, 0, 4], [2, 3, 1, 4], [3, 0, 2, 4]];
    const WEDGE: &[[usize; 4]] = &[
        [0, 1, 2, 3],
        [1, 2, 0, 4],
        [2, 0, 1, 5],
        [3, 5, 4, 0],
        [4, 3, 5, 1],
        [5, 4, 3, 2],
    ];
    const HEX: &[[usize; 4]] = &[
        [0, 1, 3, 4],
        [1, 2, 0, 5],
        [2, 3, 1, 6],
        [3, 0, 2, 7],
        [4, 7, 5, 0],
        [5, 4, 6, 1],
        [6, 5, 7, 2],
        [7, 6, 4, 3],
    ];
    let triangle = 0.75_f64.sqrt();
    match kind.table().linear {
        Kind::Tri3 => Some((TRI, triangle)),
        Kind::Quad4 => Some((QUAD, 1.0)),
        Kind::Tet4 => Some((TET, 1.0 / SQRT_2)),
        Kind::Pyramid5 => Some((PYRAMID, 1.0 / SQRT_2)),
        Kind::Wedge6 => Some((WEDGE, triangle)),
        Kind::Hex8 => Some((HEX, 1.0)),
        _ => None,
    }
}

/// Scaled Jacobian of a cell with these places of its nodes, m, at most 1; `None` of lines and points.
pub(crate) fn scaled_jacobian(kind: Kind, x: &[[f64; 3]]) -> Option<f64> {
    let (corners, regular) = corners(kind)?;
    let is_area = kind.table().dim == 2;
    let unit = |from: usize, to: usize| {
        let way = [0, 1, 2].map(|i| x[to][i] - x[from][i]);
        let length = way.iter().map(|w| w * w).sum::<f64>().sqrt();
        way.map(|w| w / length)
    };
    let normals = corners.iter().map(|&[at, a, b, c]| {
        let (a, b) = (unit(at, a), unit(at, b));
        let n = cross(&a, &b);
        (n, if is_area { n } else { unit(at, c) })
    });
    let normals: Vec<_> = normals.collect();
    // an area is turned as the sum of its corners is
    let sum = normals
        .iter()
        .fold([0.0; 3], |sum, (n, _)| [0, 1, 2].map(|i| sum[i] + n[i]));
    let length = dot(&sum, &sum).sqrt();
    let of = |(n, c): &([f64; 3], [f64; 3])| match is_area {
        true => dot(n, &sum) / length,
        false => dot(n, c),
    };
    let least = normals
        .iter()
        .map(of)
        .fold(f64::INFINITY, |least, value| match value.is_nan() {
            true => 0.0_f64.min(least),
            false => least.min(value),
        });
    Some((least / regular).min(1.0))
}

/// Of all cells of all bodies, 1 of lines and points, and of the bodies.
pub fn qualities(system: &System) -> (Vec<f64>, Vec<BodyQuality>) {
    let (mut all, mut bodies) = (Vec::new(), Vec::new());
    for body in &system.bodies {
        let (mut count, mut sum, mut worst) = (0, 0.0, (f64::INFINITY, String::new(), [0.0; 3]));
        let mut lengths = [f64::INFINITY, 0.0_f64];
        for &cell in body.cells() {
            let nodes = system.mesh.element_nodes(cell);
            let x: Vec<[f64; 3]> = nodes
                .iter()
                .map(|n| system.mesh.nodes[*n as usize])
                .collect();
            let Some(quality) = scaled_jacobian(system.mesh.kind(cell), &x) else {
                all.push(1.0);
                continue;
            };
            all.push(quality);
            (count, sum) = (count + 1, sum + quality);
            if quality < worst.0 {
                let n = x.len() as f64;
                let middle = x
                    .iter()
                    .fold([0.0; 3], |m, x| [0, 1, 2].map(|i| m[i] + x[i] / n));
                let name = system.mesh.kind(cell).table().name;
                worst = (quality, format!("{name} {}", cell.index), middle);
            }
            for [at, a, b, _] in corners(system.mesh.kind(cell)).map_or(&[][..], |c| c.0) {
                for other in [a, b] {
                    let way = [0, 1, 2].map(|i| x[*other][i] - x[*at][i]);
                    let length = dot(&way, &way).sqrt();
                    lengths = [lengths[0].min(length), lengths[1].max(length)];
                }
            }
        }
        if count > 0 {
            bodies.push(BodyQuality {
                body: body.name().to_owned(),
                cells: count,
                least: worst.0,
                mean: sum / count as f64,
                worst: worst.1,
                place: worst.2,
                edges: lengths[1] / lengths[0],
            });
        }
    }
    (all, bodies)
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quality(kind: Kind, x: &[[f64; 3]]) -> f64 {
        scaled_jacobian(kind, x).unwrap_or(f64::NAN)
    }

    #[test]
    fn regular_elements_have_quality_one() {
        let (h, r) = (0.75_f64.sqrt(), 1.0 / SQRT_2);
        let triangle = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, h, 0.0]];
        let mut wedge = triangle.to_vec();
        wedge.extend(triangle.map(|[x, y, _]| [x, y, 3.0]));
        let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mut hex = square.to_vec();
        hex.extend(square.map(|[x, y, _]| [x, y, 1.0]));
        let mut pyramid = square.to_vec();
        pyramid.push([0.5, 0.5, r]);
        let tet = [
            [1.0, 1.0, 1.0],
            [-1.0, 1.0, -1.0],
            [1.0, -1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ];
        for (kind, x) in [
            (Kind::Tri3, &triangle[..]),
            (Kind::Quad4, &square),
            (Kind::Tet4, &tet),
            (Kind::Wedge6, &wedge),
            (Kind::Pyramid5, &pyramid),
            (Kind::Hex8, &hex),
        ] {
            assert!(
                (quality(kind, x) - 1.0).abs() < 1e-12,
                "{kind:?} {}",
                quality(kind, x)
            );
        }
    }

    #[test]
    fn a_sheared_square_has_the_sine_of_its_angle_and_a_bent_quadrilateral_less_than_nothing() {
        let angle: f64 = 0.3;
        let (sin, cos) = angle.sin_cos();
        let sheared = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [1.0 + cos, sin, 0.0],
            [cos, sin, 0.0],
        ];
        assert!((quality(Kind::Quad4, &sheared) - sin).abs() < 1e-12);
        let bent = [[0.0; 3], [1.0, 0.0, 0.0], [0.3, 0.3, 0.0], [0.0, 1.0, 0.0]];
        assert!(quality(Kind::Quad4, &bent) < 0.0);
    }
}
