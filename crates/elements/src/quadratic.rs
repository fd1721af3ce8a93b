//! Quadratic bases that several kinds share: Lagrange polynomials of the line, serendipity functions of the square and
//! the cube, and the functions of the simplex in barycentric coordinates.

/// The Lagrange polynomial of degree two on the nodes -1, 0, 1 that is one at `node`: value and slope at `xi`.
pub(crate) fn lagrange(node: f64, xi: f64) -> (f64, f64) {
    if node == 0.0 {
        (1.0 - xi * xi, -2.0 * xi)
    } else {
        (0.5 * xi * (xi + node), xi + 0.5 * node)
    }
}

/// Products of Lagrange polynomials, N_a = Π_i ℓ_(a_i)(ξ_i) over the first `dim` coordinates of each node.
pub(crate) fn product_shape(dim: usize, nodes: &[[f64; 3]], xi: &[f64; 3], n: &mut [f64]) {
    for (n, a) in n.iter_mut().zip(nodes) {
        *n = (0..dim).map(|i| lagrange(a[i], xi[i]).0).product();
    }
}

/// Gradients of [`product_shape`].
pub(crate) fn product_gradient(dim: usize, nodes: &[[f64; 3]], xi: &[f64; 3], dn: &mut [[f64; 3]]) {
    for (dn, a) in dn.iter_mut().zip(nodes) {
        *dn = gradient_of_product(dim, |i| lagrange(a[i], xi[i]));
    }
}

/// Serendipity functions in `dim` = d variables. With f_i = 1 + a_i ξ_i, or 1 - ξ_i² where a_i = 0: at a corner
/// N_a = 2^-d Π f_i (Σ a_i ξ_i - d + 1), at the middle of an edge N_a = 2^(1-d) Π f_i.
pub(crate) fn serendipity_shape(dim: usize, nodes: &[[f64; 3]], xi: &[f64; 3], n: &mut [f64]) {
    for (n, a) in n.iter_mut().zip(nodes) {
        let product: f64 = (0..dim).map(|i| factor(a[i], xi[i]).0).product();
        let (scale, rest) = scale_and_rest(dim, a, xi);
        *n = scale * product * rest;
    }
}

/// Gradients of [`serendipity_shape`].
pub(crate) fn serendipity_gradient(
    dim: usize,
    nodes: &[[f64; 3]],
    xi: &[f64; 3],
    dn: &mut [[f64; 3]],
) {
    for (dn, a) in dn.iter_mut().zip(nodes) {
        let product: f64 = (0..dim).map(|i| factor(a[i], xi[i]).0).product();
        let (scale, rest) = scale_and_rest(dim, a, xi);
        let slopes = gradient_of_product(dim, |i| factor(a[i], xi[i]));
        for i in 0..3 {
            let own = if is_corner(dim, a) { a[i] } else { 0.0 };
            dn[i] = scale * (slopes[i] * rest + product * own);
        }
    }
}

/// Functions of the quadratic simplex: L(2L - 1) at the corners, 4 L L' in the middle of the `edges`. `l`: barycentric
/// coordinates.
pub(crate) fn simplex_shape(l: &[f64], edges: &[[usize; 2]], n: &mut [f64]) {
    for (n, l) in n.iter_mut().zip(l) {
        *n = l * (2.0 * l - 1.0);
    }
    for (n, [a, b]) in n[l.len()..].iter_mut().zip(edges) {
        *n = 4.0 * l[*a] * l[*b];
    }
}

/// Gradients of [`simplex_shape`]. `dl`: those of the barycentric coordinates.
pub(crate) fn simplex_gradient(
    l: &[f64],
    dl: &[[f64; 3]],
    edges: &[[usize; 2]],
    dn: &mut [[f64; 3]],
) {
    for ((dn, l), dl) in dn.iter_mut().zip(l).zip(dl) {
        *dn = dl.map(|dl| (4.0 * l - 1.0) * dl);
    }
    for (dn, &[a, b]) in dn[l.len()..].iter_mut().zip(edges) {
        *dn = [0, 1, 2].map(|i| 4.0 * (l[a] * dl[b][i] + dl[a][i] * l[b]));
    }
}

/// Π_j f_j with one factor at a time replaced by its slope. `factor`: value and slope.
fn gradient_of_product(dim: usize, factor: impl Fn(usize) -> (f64, f64)) -> [f64; 3] {
    let mut out = [0.0; 3];
    for (i, out) in out.iter_mut().enumerate().take(dim) {
        let factors = (0..dim).map(|j| {
            let (value, slope) = factor(j);
            if i == j { slope } else { value }
        });
        *out = factors.product();
    }
    out
}

fn factor(node: f64, xi: f64) -> (f64, f64) {
    if node == 0.0 {
        (1.0 - xi * xi, -2.0 * xi)
    } else {
        (1.0 + node * xi, node)
    }
}

fn is_corner(dim: usize, a: &[f64; 3]) -> bool {
    a[..dim].iter().all(|&a| a != 0.0)
}

/// The power of two and the last factor of a serendipity function.
fn scale_and_rest(dim: usize, a: &[f64; 3], xi: &[f64; 3]) -> (f64, f64) {
    let scale = 0.5_f64.powi(dim as i32);
    if is_corner(dim, a) {
        let sum: f64 = (0..dim).map(|i| a[i] * xi[i]).sum();
        (scale, sum - (dim as f64 - 1.0))
    } else {
        (2.0 * scale, 1.0)
    }
}
