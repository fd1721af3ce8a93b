//! Quadrature of any degree on simplices and on the cube.
//!
//! The pieces of a common refinement carry products of the shape functions of two meshes, of higher degree than the
//! tables of `carom-elements` serve.

use carom_elements::Kind;
use carom_elements::quadrature::{TETRAHEDRON_4, TRIANGLE_3};

/// Points and weights on a reference cell: the unit simplex, or [-1, 1]^dim.
#[derive(Clone, Debug)]
pub(crate) struct Rule {
    /// Points; components beyond the dimension are zero.
    pub points: Vec<[f64; 3]>,
    /// Weights; their sum is the measure of the reference cell.
    pub weights: Vec<f64>,
}

impl Rule {
    /// Rule on the unit simplex, exact for polynomials of total degree `degree`; `dim` is 1, 2 or 3.
    ///
    /// Up to degree 2 the classical rules; beyond, the conical product: with x = (1-u)(1-v) ..., Gauss-Jacobi points
    /// of weight (1-t)^k in the k-th collapsed direction. Stroud (1971), chapter 2.
    pub fn simplex(dim: usize, degree: usize) -> Rule {
        let table = match (dim, degree) {
            (2, ..=2) => Some(&TRIANGLE_3),
            (3, ..=2) => Some(&TETRAHEDRON_4),
            _ => None,
        };
        if let Some(rule) = table {
            let (points, weights) = (rule.points.to_vec(), rule.weights.to_vec());
            return Rule { points, weights };
        }
        let n = degree / 2 + 1;
        let axes: Vec<_> = (0..dim).map(|k| unit(&gauss_jacobi(n, k), k)).collect();
        product(&axes, |t| {
            // The direction without a weight function is the innermost.
            let z = if dim > 2 { t[2] } else { 0.0 };
            let y = if dim > 1 { (1.0 - z) * t[1] } else { 0.0 };
            [(1.0 - z - y) * t[0], y, z]
        })
    }

    /// Rule on the reference cell with the corners of a kind, exact for polynomials of total degree `degree`, on cubes of this degree in
    /// each variable. On a pyramid it is exact for such polynomials in (x, y, ζ) with ξ = x(1 - ζ), η = y(1 - ζ).
    pub fn of(corners: Kind, degree: usize) -> Rule {
        let dim = corners.table().dim;
        let n = degree / 2 + 1;
        match corners {
            Kind::Tri3 | Kind::Tet4 => Rule::simplex(dim, degree),
            Kind::Wedge6 => {
                let axes = [
                    unit(&gauss_jacobi(n, 0), 0),
                    unit(&gauss_jacobi(n, 1), 1),
                    gauss_jacobi(n, 0),
                ];
                product(&axes, |t| [(1.0 - t[1]) * t[0], t[1], t[2]])
            }
            Kind::Pyramid5 => {
                let line = gauss_jacobi(n, 0);
                let axes = [line.clone(), line, unit(&gauss_jacobi(n, 2), 2)];
                product(&axes, |t| [t[0] * (1.0 - t[2]), t[1] * (1.0 - t[2]), t[2]])
            }
            _ => Rule::cube(dim, degree),
        }
    }

    /// Gauss product on [-1, 1]^dim, exact for polynomials of degree `degree` in each variable.
    pub fn cube(dim: usize, degree: usize) -> Rule {
        let axes = vec![gauss_jacobi(degree / 2 + 1, 0); dim];
        product(&axes, |t| t)
    }
}

/// Product of rules on a line, its points mapped.
fn product(axes: &[Vec<(f64, f64)>], map: impl Fn([f64; 3]) -> [f64; 3]) -> Rule {
    let mut product = vec![([0.0; 3], 1.0)];
    for (k, axis) in axes.iter().enumerate() {
        let add = |(t, w): &([f64; 3], f64)| {
            let (t, w) = (*t, *w);
            let along = axis.iter().map(move |&(x, v)| {
                let mut t = t;
                t[k] = x;
                (t, w * v)
            });
            along.collect::<Vec<_>>()
        };
        product = product.iter().flat_map(add).collect();
    }
    let (points, weights): (Vec<_>, _) = product.into_iter().unzip();
    Rule {
        points: points.into_iter().map(map).collect(),
        weights,
    }
}

/// A rule on [-1, 1] with weight (1-x)^k, moved to [0, 1] with weight (1-t)^k.
fn unit(rule: &[(f64, f64)], k: usize) -> Vec<(f64, f64)> {
    let factor = 0.5f64.powi(k as i32 + 1);
    rule.iter()
        .map(|&(x, w)| (0.5 * (1.0 + x), factor * w))
        .collect()
}

/// Gauss-Jacobi points and weights on [-1, 1] for the weight (1-x)^a, exact to degree 2n-1:
/// w_i = 2^(a+1) / ((1-x_i²) P_n'(x_i)²), x_i the zeros of P_n^(a,0). Abramowitz and Stegun (1964), 25.4.33.
fn gauss_jacobi(n: usize, a: usize) -> Vec<(f64, f64)> {
    let mut points: Vec<f64> = Vec::with_capacity(n);
    for i in 0..n {
        let angle = (2 * i + 1) as f64 / (2 * n) as f64 * std::f64::consts::PI;
        let mut x = -angle.cos();
        if let Some(&last) = points.last() {
            x = 0.5 * (x + last);
        }
        // Zeros already found are divided out, so that Newton's steps cannot return to one.
        for _ in 0..100 {
            let (p, dp) = jacobi(n, a as f64, x);
            let found: f64 = points.iter().map(|z| 1.0 / (x - z)).sum();
            let step = p / (dp - p * found);
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        points.push(x);
    }
    points.sort_by(f64::total_cmp);
    let weight = |x: f64| {
        let dp = jacobi(n, a as f64, x).1;
        2f64.powi(a as i32 + 1) / ((1.0 - x * x) * dp * dp)
    };
    points.iter().map(|&x| (x, weight(x))).collect()
}

/// Jacobi polynomial P_n^(a,0) and its derivative, by the three-term recurrence.
fn jacobi(n: usize, a: f64, x: f64) -> (f64, f64) {
    let (mut p, mut dp) = ((1.0, 0.5 * (a + (a + 2.0) * x)), (0.0, 0.5 * (a + 2.0)));
    for k in 2..=n {
        let k = k as f64;
        let c = 2.0 * k + a;
        let lead = 2.0 * k * (k + a) * (c - 2.0);
        let (slope, shift) = (c * (c - 1.0) * (c - 2.0), (c - 1.0) * a * a);
        let last = 2.0 * (k + a - 1.0) * (k - 1.0) * c;
        let next = ((slope * x + shift) * p.1 - last * p.0) / lead;
        let d_next = ((slope * x + shift) * dp.1 + slope * p.1 - last * dp.0) / lead;
        (p, dp) = ((p.1, next), (dp.1, d_next));
    }
    if n == 0 { (1.0, 0.0) } else { (p.1, dp.1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factorial(n: usize) -> f64 {
        (1..=n).map(|i| i as f64).product()
    }

    #[test]
    fn a_simplex_rule_integrates_every_monomial_of_its_degree() {
        // ∫ x^i y^j z^k = i! j! k! / (i+j+k+dim)!
        for dim in 1..=3 {
            for degree in 0..=11 {
                let rule = Rule::simplex(dim, degree);
                for i in 0..=degree {
                    for j in 0..=(if dim > 1 { degree - i } else { 0 }) {
                        for k in 0..=(if dim > 2 { degree - i - j } else { 0 }) {
                            let value = |x: &[f64; 3]| {
                                x[0].powi(i as i32) * x[1].powi(j as i32) * x[2].powi(k as i32)
                            };
                            let points = rule.points.iter().zip(&rule.weights);
                            let sum: f64 = points.map(|(x, w)| w * value(x)).sum();
                            let exact = factorial(i) * factorial(j) * factorial(k)
                                / factorial(i + j + k + dim);
                            // Round-off of sums of at most 216 terms.
                            assert!((sum - exact).abs() < 1e-14, "{dim} {degree} {i} {j} {k}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn the_rules_of_wedge_and_pyramid_have_the_moments_of_their_cells() {
        // wedge: ∫ x² y ζ² = 2!1!/5! · 2/3; pyramid: ∫ x² ζ = ∫ (4/3)(1 - ζ)⁴ ζ dζ
        for (kind, power, exact) in [
            (Kind::Wedge6, [2, 1, 2], 2.0 / 120.0 * 2.0 / 3.0),
            (Kind::Pyramid5, [2, 0, 1], 4.0 / 3.0 / 30.0),
        ] {
            let rule = Rule::of(kind, 5);
            let value = |x: &[f64; 3]| (0..3).map(|i| x[i].powi(power[i])).product::<f64>();
            let points = rule.points.iter().zip(&rule.weights);
            let sum: f64 = points.map(|(x, w)| w * value(x)).sum();
            assert!((sum - exact).abs() < 1e-15, "{kind:?}");
        }
    }

    #[test]
    fn a_cube_rule_integrates_every_power_of_its_degree() {
        for degree in 0..=11 {
            let rule = Rule::cube(2, degree);
            for (i, j) in [(degree, degree), (0, degree), (degree, 1)] {
                let j = j.min(degree);
                let points = rule.points.iter().zip(&rule.weights);
                let sum: f64 = points
                    .map(|(x, w)| w * x[0].powi(i as i32) * x[1].powi(j as i32))
                    .sum();
                let line = |i: usize| {
                    if i.is_multiple_of(2) {
                        2.0 / (i + 1) as f64
                    } else {
                        0.0
                    }
                };
                assert!((sum - line(i) * line(j)).abs() < 1e-14);
            }
        }
    }
}
