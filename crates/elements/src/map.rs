//! The map from the reference cell to space, x(ξ) = Σ_a N_a(ξ) x_a, and its derivatives.
//!
//! Cells that fill their space (lines on the first axis, plane cells in the first two, solids) have a square
//! Jacobian; faces and embedded lines have a measure and a normal instead.

use crate::{Element, MAX_NODES};

/// Point of the cell, x = Σ_a N_a x_a, in the unit of the node coordinates `x`.
#[inline]
pub fn point(x: &[[f64; 3]], n: &[f64]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (x, &n) in x.iter().zip(n) {
        for i in 0..3 {
            sum[i] += n * x[i];
        }
    }
    sum
}

/// Jacobian J_ij = ∂x_i/∂ξ_j = Σ_a x_ai dN_a/dξ_j and its determinant.
///
/// `x`: node coordinates; `dn`: reference gradients; `dim`: dimension of the cell, which must be that of the space
/// spanned (first axis, first two axes, all three). Rows and columns beyond `dim` are those of the identity, so J
/// can be inverted as it stands. det J is positive where the nodes have the orientation of the reference cell, and
/// is in units of length^dim.
#[inline]
pub fn jacobian(x: &[[f64; 3]], dn: &[[f64; 3]], dim: usize) -> ([[f64; 3]; 3], f64) {
    let mut sum = [[0.0; 3]; 3];
    for (x, dn) in x.iter().zip(dn) {
        for row in 0..3 {
            for column in 0..3 {
                sum[row][column] += x[row] * dn[column];
            }
        }
    }
    let mut j = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for row in 0..dim {
        j[row][..dim].copy_from_slice(&sum[row][..dim]);
    }
    let det = dot(&j[0], &cross(&j[1], &j[2]));
    (j, det)
}

/// Gradients in space, dN_a/dx = J^-T dN_a/dξ, in 1/length.
///
/// `jacobian` and `det` from [`jacobian`], `det` not zero; `out` has the length of `dn`.
#[inline]
pub fn physical_gradient(
    jacobian: &[[f64; 3]; 3],
    det: f64,
    dn: &[[f64; 3]],
    out: &mut [[f64; 3]],
) {
    // The rows of J^-T times det J are the cross products of the other two rows of J.
    let [a, b, c] = jacobian;
    let cofactor = [cross(b, c), cross(c, a), cross(a, b)];
    for (out, dn) in out.iter_mut().zip(dn) {
        *out = [0, 1, 2].map(|i| dot(&cofactor[i], dn) / det);
    }
}

/// Second derivatives of the shape functions of a line or a face, (∂²N_a/∂ξ², ∂²N_a/∂η², ∂²N_a/∂ξ∂η).
///
/// `out` has the length of the nodes. By central differences of the gradients, which are of degree two at most in each
/// variable: exact but for round-off. Not for the pyramid, whose gradients are rational.
pub fn second_gradient(element: &Element, xi: &[f64; 3], out: &mut [[f64; 3]]) {
    let (mut up, mut down) = ([[0.0; 3]; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    for axis in 0..2 {
        let at = |side: f64| {
            let mut xi = *xi;
            xi[axis] += side;
            xi
        };
        (element.gradient)(&at(1.0), &mut up[..element.nodes]);
        (element.gradient)(&at(-1.0), &mut down[..element.nodes]);
        for (out, (up, down)) in out.iter_mut().zip(up.iter().zip(&down)) {
            out[axis] = 0.5 * (up[axis] - down[axis]);
            out[2] = 0.5 * (up[1 - axis] - down[1 - axis]);
        }
    }
}

/// Measure factor and unit normal of a face or an embedded line.
///
/// With t_j = ∂x/∂ξ_j: dim 0: (1, 0); dim 1: (|t_1|, (t_1y, -t_1x, 0)/|t_1|), the normal being meaningful in the
/// plane of the first two axes; dim 2: (|t_1 × t_2|, t_1 × t_2 / |t_1 × t_2|). The factor times a quadrature weight
/// is a piece of length or area. For a face of [`Element::faces`](crate::Element::faces) the normal points out of
/// the cell. A degenerate face has factor zero and normal zero.
#[inline]
pub fn measure(x: &[[f64; 3]], dn: &[[f64; 3]], dim: usize) -> (f64, [f64; 3]) {
    let tangent =
        |j: usize| [0, 1, 2].map(|i| x.iter().zip(dn).map(|(x, dn)| x[i] * dn[j]).sum::<f64>());
    let (factor, normal) = match dim {
        0 => return (1.0, [0.0; 3]),
        1 => {
            let t = tangent(0);
            (dot(&t, &t).sqrt(), [t[1], -t[0], 0.0])
        }
        _ => {
            let normal = cross(&tangent(0), &tangent(1));
            (dot(&normal, &normal).sqrt(), normal)
        }
    };
    if factor == 0.0 {
        return (0.0, [0.0; 3]);
    }
    (factor, normal.map(|n| n / factor))
}

#[inline]
fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
