//! Quadrature rules on the reference cells.
//!
//! Gauss-Legendre products on [-1, 1]^d, the classical low-degree rules of the simplex, their products for the wedge and
//! conical products for the pyramid. Which rule an element uses is said in the element's own file.

/// A quadrature rule ∫ f dξ ≈ Σ_q w_q f(ξ_q) on a reference cell.
#[derive(Debug)]
pub struct Rule {
    /// Points in the reference cell; components beyond its dimension are zero.
    pub points: &'static [[f64; 3]],
    /// Weights, positive; their sum is the measure of the reference cell.
    pub weights: &'static [f64],
    /// Polynomials integrated exactly: on simplices and the pyramid those of this total degree, on [-1, 1]^d those of
    /// this degree in each variable, on the wedge those of this total degree in the triangle and this degree across.
    pub degree: usize,
}

/// 1/√3, the abscissa of the two-point Gauss rule.
const G: f64 = 0.577_350_269_189_625_8;
/// √(3/5), the outer abscissa of the three-point Gauss rule.
const G3: f64 = 0.774_596_669_241_483_4;
/// Abscissae and weights of the three-point Gauss rule.
const GAUSS_3: [(f64, f64); 3] = [(-G3, 5.0 / 9.0), (0.0, 8.0 / 9.0), (G3, 5.0 / 9.0)];
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

/// Three Gauss points on [-1, 1].
pub static LINE_3: Rule = Rule {
    points: &[[-G3, 0.0, 0.0], [0.0; 3], [G3, 0.0, 0.0]],
    weights: &[5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0],
    degree: 5,
};

/// Three by three Gauss points on [-1, 1]².
pub static SQUARE_9: Rule = Rule {
    points: &SQUARE_9_TABLE.0,
    weights: &SQUARE_9_TABLE.1,
    degree: 5,
};

const SQUARE_9_TABLE: ([[f64; 3]; 9], [f64; 9]) = {
    let (mut points, mut weights) = ([[0.0; 3]; 9], [0.0; 9]);
    let mut q = 0;
    while q < 9 {
        let ((x, wx), (y, wy)) = (GAUSS_3[q % 3], GAUSS_3[q / 3]);
        points[q] = [x, y, 0.0];
        weights[q] = wx * wy;
        q += 1;
    }
    (points, weights)
};

/// Three by three by three Gauss points on [-1, 1]³.
pub static CUBE_27: Rule = Rule {
    points: &CUBE_27_TABLE.0,
    weights: &CUBE_27_TABLE.1,
    degree: 5,
};

const CUBE_27_TABLE: ([[f64; 3]; 27], [f64; 27]) = {
    let (mut points, mut weights) = ([[0.0; 3]; 27], [0.0; 27]);
    let mut q = 0;
    while q < 27 {
        let (z, wz) = GAUSS_3[q / 9];
        let [x, y, _] = SQUARE_9_TABLE.0[q % 9];
        points[q] = [x, y, z];
        weights[q] = SQUARE_9_TABLE.1[q % 9] * wz;
        q += 1;
    }
    (points, weights)
};

/// (8 - √10 ± √(38 - 44 √(2/5)))/18: coordinates of the six-point rule of the triangle.
const C: f64 = 0.445_948_490_915_964_9;
const D: f64 = 0.091_576_213_509_770_74;
/// (620 ± √(213125 - 53320 √10))/7440: its weights.
const WC: f64 = 0.111_690_794_839_005_73;
const WD: f64 = 0.054_975_871_827_660_935;

/// Six interior points of the unit triangle. Cowper (1973).
pub static TRIANGLE_6: Rule = Rule {
    points: &TRIANGLE_6_POINTS,
    weights: &TRIANGLE_6_WEIGHTS,
    degree: 4,
};

const TRIANGLE_6_POINTS: [[f64; 3]; 6] = [
    [C, C, 0.0],
    [1.0 - 2.0 * C, C, 0.0],
    [C, 1.0 - 2.0 * C, 0.0],
    [D, D, 0.0],
    [1.0 - 2.0 * D, D, 0.0],
    [D, 1.0 - 2.0 * D, 0.0],
];

const TRIANGLE_6_WEIGHTS: [f64; 6] = [WC, WC, WC, WD, WD, WD];

/// Coordinates and weights of the fourteen-point rule of the tetrahedron, whose moment equations have no closed solution:
/// Newton's method on these equations, from the published values.
const E: f64 = 0.310_885_919_263_300_6;
const F: f64 = 0.092_735_250_310_891_23;
const H: f64 = 0.045_503_704_125_649_634;
const WE: f64 = 0.018_781_320_953_002_645;
const WF: f64 = 0.012_248_840_519_393_66;
const WH: f64 = 0.007_091_003_462_846_909;

/// Fourteen interior points of the unit tetrahedron. Walkington (2000).
pub static TETRAHEDRON_14: Rule = Rule {
    points: &[
        [E, E, E],
        [1.0 - 3.0 * E, E, E],
        [E, 1.0 - 3.0 * E, E],
        [E, E, 1.0 - 3.0 * E],
        [F, F, F],
        [1.0 - 3.0 * F, F, F],
        [F, 1.0 - 3.0 * F, F],
        [F, F, 1.0 - 3.0 * F],
        [H, H, 0.5 - H],
        [H, 0.5 - H, H],
        [0.5 - H, H, H],
        [0.5 - H, 0.5 - H, H],
        [0.5 - H, H, 0.5 - H],
        [H, 0.5 - H, 0.5 - H],
    ],
    weights: &[WE, WE, WE, WE, WF, WF, WF, WF, WH, WH, WH, WH, WH, WH],
    degree: 5,
};

/// Three points of the triangle times two Gauss points across.
pub static WEDGE_6: Rule = Rule {
    points: &[
        [SIXTH, SIXTH, -G],
        [4.0 * SIXTH, SIXTH, -G],
        [SIXTH, 4.0 * SIXTH, -G],
        [SIXTH, SIXTH, G],
        [4.0 * SIXTH, SIXTH, G],
        [SIXTH, 4.0 * SIXTH, G],
    ],
    weights: &[SIXTH; 6],
    degree: 2,
};

/// Six points of the triangle times three Gauss points across.
pub static WEDGE_18: Rule = Rule {
    points: &WEDGE_18_TABLE.0,
    weights: &WEDGE_18_TABLE.1,
    degree: 4,
};

const WEDGE_18_TABLE: ([[f64; 3]; 18], [f64; 18]) = {
    let (mut points, mut weights) = ([[0.0; 3]; 18], [0.0; 18]);
    let mut q = 0;
    while q < 18 {
        let (z, wz) = GAUSS_3[q / 6];
        let [x, y, _] = TRIANGLE_6_POINTS[q % 6];
        points[q] = [x, y, z];
        weights[q] = TRIANGLE_6_WEIGHTS[q % 6] * wz;
        q += 1;
    }
    (points, weights)
};

/// Two by two Gauss points of (x, y) = (ξ, η)/(1 - ζ) at the height of the centroid, 1/4. Exact for the products of
/// gradients of the pyramid's shape functions, bilinear in (x, y).
pub static PYRAMID_4: Rule = Rule {
    points: &[
        [-0.75 * G, -0.75 * G, 0.25],
        [0.75 * G, -0.75 * G, 0.25],
        [0.75 * G, 0.75 * G, 0.25],
        [-0.75 * G, 0.75 * G, 0.25],
    ],
    weights: &[THIRD; 4],
    degree: 1,
};

/// Widths 1 - ζ = 2/3 ± √10/15 and weights 1/6 ± √10/48 of the two-point rule for ∫ (1 - ζ)² f(ζ) dζ on [0, 1], exact
/// for cubics (from its moments).
const WIDTH: [(f64, f64); 2] = [
    (0.877_485_177_344_558_6, 0.232_547_451_253_507_9),
    (0.455_848_155_988_774_7, 0.100_785_882_079_825_43),
];

/// Two by two Gauss points of (x, y) = (ξ, η)/(1 - ζ) at each of two heights, a conical product. Also exact for what is
/// of degree three in each of x, y and ζ. Stroud (1971).
pub static PYRAMID_8: Rule = Rule {
    points: &PYRAMID_8_TABLE.0,
    weights: &PYRAMID_8_TABLE.1,
    degree: 3,
};

const PYRAMID_8_TABLE: ([[f64; 3]; 8], [f64; 8]) = {
    let (mut points, mut weights) = ([[0.0; 3]; 8], [0.0; 8]);
    let mut q = 0;
    while q < 8 {
        let (width, weight) = WIDTH[q / 4];
        let (x, y) = ([-G, G][q % 2], [-G, G][q / 2 % 2]);
        points[q] = [x * width, y * width, 1.0 - width];
        weights[q] = weight;
        q += 1;
    }
    (points, weights)
};
