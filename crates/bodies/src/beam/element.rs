//! Stiffness and mass of a beam element in its own axes: x along it, y and z the principal axes of the section.
//!
//! Unknowns of a node: u v w, rotations θx θy θz. Extension and torsion are linear in x. In the plane x y the deflection v and
//! the rotation θ of the section take the shape of a beam without load between its nodes, so that the element is exact
//! there for end loads and cannot lock in shear: with `Φ = 12 E I_z/(G A_y L²)`, zero for Euler-Bernoulli, and ξ = x/L
//!
//! `N_v = [2ξ³ - 3ξ² - Φξ + 1 + Φ, L(ξ³ - (2 + Φ/2)ξ² + (1 + Φ/2)ξ), -2ξ³ + 3ξ² + Φξ, L(ξ³ - (1 - Φ/2)ξ² - (Φ/2)ξ)]/(1 + Φ)`
//! `N_θ = [6(ξ² - ξ)/L, 3ξ² - (4 + Φ)ξ + 1 + Φ, -6(ξ² - ξ)/L, 3ξ² - (2 - Φ)ξ]/(1 + Φ)`
//!
//! for (v₁, θ₁, v₂, θ₂). In the plane x z it is (w₁, -θy₁, w₂, -θy₂), with I_y and A_z. Friedman and Kosmatka (1993), Computers &
//! Structures 47.
//!
//! Mass: `∫ ρA N_v N_vᵀ + ρI N_θ N_θᵀ dx`, the second term for Timoshenko only, is the exact dynamic stiffness to the order ω². Of the
//! order ω⁴ is the motion of the inside beyond these shapes under its inertia q = ω² ρA v, μ = ω² ρI θ: with clamped ends
//! `∫ q v = q² L⁵ (Φ + 1/5)/(144 E I)` and `∫ μ θ = μ² Φ L³/(12 E I (1 + Φ))`. The equations of a beam, -q = Q' and -μ = M' + Q, turn one factor of
//! each square into forces of the element, Q = 12 E I g/(L²(1 + Φ)) and M = E I κ, and an integration by parts along the
//! beam the derivative of Q into that of v. So the order ω⁴ becomes a part of the mass,
//!
//! `ρA L³ (Φ + 1/5)/(12 (1 + Φ)) g d + ρI Φ L³/(12 (1 + Φ)) (κ² - 12/(L² (1 + Φ)) g t)`,
//!
//! `d = (v₂ - v₁)/L`, `t = (θ₁ + θ₂)/2`, `g = d - t`, `κ = (θ₂ - θ₁)/L`. It vanishes in rigid motions. Without it errors of both waves are of
//! second order in L wherever L is not long against the height of the section, with it of fourth order.

use carom_materials::Elastic;

use super::section::{BeamSection, BeamTheory};

/// A matrix over the twelve unknowns of an element.
pub(super) type Matrix = [[f64; 12]; 12];

/// The four points of Gauss on [0, 1] and their weights: exact to degree 7.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// What bends in one of the two planes.
struct Bending {
    /// Places of the four unknowns, and their signs.
    unknowns: [(usize, f64); 4],
    /// E I, N m².
    stiffness: f64,
    /// ρ I, kg m; zero where it is neglected.
    rotary: f64,
    /// Φ.
    shear: f64,
}

/// An element of a length (m) with a section and a material.
pub(super) struct Element<'a> {
    pub(super) length: f64,
    pub(super) section: &'a BeamSection,
    pub(super) material: &'a Elastic,
}

impl Element<'_> {
    /// K in N/m, N and N m.
    pub(super) fn stiffness(&self) -> Matrix {
        let (l, section) = (self.length, &self.section.properties);
        let mut k = [[0.0; 12]; 12];
        let along = self.material.young * section.area / l;
        let about = self.material.shear_modulus() * section.torsion / l;
        for (i, value) in [(0, along), (3, about)] {
            for (a, b, sign) in [
                (i, i, 1.0),
                (i, i + 6, -1.0),
                (i + 6, i, -1.0),
                (i + 6, i + 6, 1.0),
            ] {
                k[a][b] = sign * value;
            }
        }
        for plane in self.planes() {
            let phi = plane.shear;
            let factor = plane.stiffness / (l.powi(3) * (1.0 + phi));
            let (near, far) = ((4.0 + phi) * l * l, (2.0 - phi) * l * l);
            let own = [
                [12.0, 6.0 * l, -12.0, 6.0 * l],
                [6.0 * l, near, -6.0 * l, far],
                [-12.0, -6.0 * l, 12.0, -6.0 * l],
                [6.0 * l, far, -6.0 * l, near],
            ];
            plane.add(factor, &own, &mut k);
        }
        k
    }

    /// Consistent mass in kg, kg m and kg m².
    pub(super) fn mass(&self) -> Matrix {
        let mut m = [[0.0; 12]; 12];
        for (i, whole) in [(0, self.weight()), (3, self.polar())] {
            for (a, b, part) in [
                (i, i, 3.0),
                (i, i + 6, 6.0),
                (i + 6, i, 6.0),
                (i + 6, i + 6, 3.0),
            ] {
                m[a][b] = whole / part;
            }
        }
        for plane in self.planes() {
            plane.add(1.0, &self.mass_of(&plane), &mut m);
            plane.add(1.0, &self.inside(&plane), &mut m);
        }
        m
    }

    /// The diagonal of the lumped mass: half the mass at each node, half the inertia about x, and in bending the diagonal of the
    /// consistent mass scaled to the mass of the element. Hinton, Rock and Zienkiewicz (1976).
    pub(super) fn lumped(&self) -> [f64; 12] {
        let half = 0.5 * self.weight();
        let mut lumped = [half; 12];
        (lumped[3], lumped[9]) = (0.5 * self.polar(), 0.5 * self.polar());
        for plane in self.planes() {
            let own = self.mass_of(&plane);
            let scale = self.weight() / (own[0][0] + own[2][2]);
            for k in [1, 3] {
                lumped[plane.unknowns[k].0] = scale * own[k][k];
            }
        }
        lumped
    }

    /// Mass, kg.
    fn weight(&self) -> f64 {
        self.material.density * self.section.properties.area * self.length
    }

    /// Moment of inertia about x, kg m².
    fn polar(&self) -> f64 {
        let [y, z] = self.section.properties.second_moments;
        self.material.density * (y + z) * self.length
    }

    fn planes(&self) -> [Bending; 2] {
        let Element {
            length,
            section,
            material,
        } = self;
        let properties = &section.properties;
        let plane = |unknowns, second: f64, area: f64| {
            let stiffness = material.young * second;
            let (shear, rotary) = match section.theory {
                BeamTheory::EulerBernoulli => (0.0, 0.0),
                BeamTheory::Timoshenko => (
                    12.0 * stiffness / (material.shear_modulus() * area * length * length),
                    material.density * second,
                ),
            };
            Bending {
                unknowns,
                stiffness,
                rotary,
                shear,
            }
        };
        let ([about_y, about_z], [along_y, along_z]) =
            (properties.second_moments, properties.shear_areas);
        [
            plane([(1, 1.0), (5, 1.0), (7, 1.0), (11, 1.0)], about_z, along_y),
            plane(
                [(2, 1.0), (4, -1.0), (8, 1.0), (10, -1.0)],
                about_y,
                along_z,
            ),
        ]
    }

    fn mass_of(&self, plane: &Bending) -> [[f64; 4]; 4] {
        let (l, phi) = (self.length, plane.shear);
        let line = self.material.density * self.section.properties.area;
        let mut m = [[0.0; 4]; 4];
        for (xi, weight) in GAUSS {
            let (square, cube) = (xi * xi, xi * xi * xi);
            let v = [
                2.0 * cube - 3.0 * square - phi * xi + 1.0 + phi,
                l * (cube - (2.0 + 0.5 * phi) * square + (1.0 + 0.5 * phi) * xi),
                -2.0 * cube + 3.0 * square + phi * xi,
                l * (cube - (1.0 - 0.5 * phi) * square - 0.5 * phi * xi),
            ];
            let theta = [
                6.0 * (square - xi) / l,
                3.0 * square - (4.0 + phi) * xi + 1.0 + phi,
                -6.0 * (square - xi) / l,
                3.0 * square - (2.0 - phi) * xi,
            ];
            let dx = weight * l / (1.0 + phi).powi(2);
            for a in 0..4 {
                for b in 0..4 {
                    m[a][b] += (line * v[a] * v[b] + plane.rotary * theta[a] * theta[b]) * dx;
                }
            }
        }
        m
    }
}

impl Element<'_> {
    /// What the motion of the inside beyond the shapes adds to the consistent mass.
    fn inside(&self, plane: &Bending) -> [[f64; 4]; 4] {
        let (l, phi) = (self.length, plane.shear);
        let line = self.material.density * self.section.properties.area;
        let d = [-1.0 / l, 0.0, 1.0 / l, 0.0];
        let t = [0.0, 0.5, 0.0, 0.5];
        let kappa = [0.0, -1.0 / l, 0.0, 1.0 / l];
        let g = [0, 1, 2, 3].map(|i| d[i] - t[i]);
        let cube = l.powi(3) / (12.0 * (1.0 + phi));
        let of_translation = line * (phi + 0.2) * cube;
        let of_rotation = plane.rotary * phi * cube;
        let across = 12.0 / (l * l * (1.0 + phi));
        let mut m = [[0.0; 4]; 4];
        for a in 0..4 {
            for b in 0..4 {
                let with = |other: &[f64; 4]| 0.5 * (g[a] * other[b] + other[a] * g[b]);
                m[a][b] = of_translation * with(&d)
                    + of_rotation * (kappa[a] * kappa[b] - across * with(&t));
            }
        }
        m
    }
}

impl Bending {
    fn add(&self, factor: f64, own: &[[f64; 4]; 4], to: &mut Matrix) {
        for (row, &(a, sign)) in own.iter().zip(&self.unknowns) {
            for (value, &(b, other)) in row.iter().zip(&self.unknowns) {
                to[a][b] += factor * sign * other * value;
            }
        }
    }
}
