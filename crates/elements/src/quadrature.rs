//! Quadrature rules on the reference cells.
//!
//! Gauss-Legendre products on [-1, 1]^d and the classical low-degree rules of the simplex. Which rule an element
//! uses is said in the element's own file.

/// A quadrature rule ∫ f dξ ≈ Σ_q w_q f(ξ_q) on a reference cell.
#[derive(Debug)]
pub struct Rule {
    /// Points in the reference cell; components beyond its dimension are zero.
    pub points: &'static [[f64; 3]],
    /// Weights, positive; their sum is the measure of the reference cell.
    pub weights: &'static [f64],
    /// Polynomials integrated exactly: on simplices those of this total degree, on [-1, 1]^d those of this degree
    /// in each variable.
    pub degree: usize,
}

/// 1/√3, the abscissa of the two-point Gauss rule.
const G: f64 = 0.577_350_269_189_625_8;
/// (5 - √5)/20 and (5 + 3√5)/20: barycentric coordinates of the four-point rule of the tetrahedron.
const A: f64 = 0.138_196_601_125_010_5;
const B: f64 = 0.585_410_196_624_968_5;
const SIXTH: f64 = 1.0 / 6.0;
const THIRD: f64 = 1.0 / 3.0;

/// The value at the point itself.
pub static POINT: Rule = Rule {
    points: &[[0.0; 3]],
    weights: &[1.0],
    degree: 0,
};

/// Midpoint of [-1, 1].
pub static LINE_1: Rule = Rule {
    points: &[[0.0; 3]],
    weights: &[2.0],
    degree: 1,
};

/// Two Gauss points on [-1, 1].
pub static LINE_2: Rule = Rule {
    points: &[[-G, 0.0, 0.0], [G, 0.0, 0.0]],
    weights: &[1.0; 2],
    degree: 3,
};

/// Two by two Gauss points on [-1, 1]².
pub static SQUARE_4: Rule = Rule {
    points: &[[-G, -G, 0.0], [G, -G, 0.0], [G, G, 0.0], [-G, G, 0.0]],
    weights: &[1.0; 4],
    degree: 3,
};

/// Two by two by two Gauss points on [-1, 1]³.
pub static CUBE_8: Rule = Rule {
    points: &[
        [-G, -G, -G],
        [G, -G, -G],
        [G, G, -G],
        [-G, G, -G],
        [-G, -G, G],
        [G, -G, G],
        [G, G, G],
        [-G, G, G],
    ],
    weights: &[1.0; 8],
    degree: 3,
};

/// Centroid of the unit triangle.
pub static TRIANGLE_1: Rule = Rule {
    points: &[[THIRD, THIRD, 0.0]],
    weights: &[0.5],
    degree: 1,
};

/// Three interior points of the unit triangle. Strang and Fix (1973).
pub static TRIANGLE_3: Rule = Rule {
    points: &[
        [SIXTH, SIXTH, 0.0],
        [4.0 * SIXTH, SIXTH, 0.0],
        [SIXTH, 4.0 * SIXTH, 0.0],
    ],
    weights: &[SIXTH; 3],
    degree: 2,
};

/// Centroid of the unit tetrahedron.
pub static TETRAHEDRON_1: Rule = Rule {
    points: &[[0.25; 3]],
    weights: &[SIXTH],
    degree: 1,
};

/// Four interior points of the unit tetrahedron. Hammer and Stroud (1956).
pub static TETRAHEDRON_4: Rule = Rule {
    points: &[[A, A, A], [B, A, A], [A, B, A], [A, A, B]],
    weights: &[0.25 * SIXTH; 4],
    degree: 2,
};
