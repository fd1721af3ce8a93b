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
//! `d = (v₂ - v₁)/L`, `t = (θ₁ + θ₂)/2`, `g = d - t`, `κ = (θ₂ - θ₁)/L`. It vanishes in rigid motions.
//! Where an element is long against the height of its section its mass may then not be positive definite: the least multiple of g² that
//! makes it so is added, at most ρA L³/48. There g is of the order L² ∂³v/∂x³, and its square of a higher order. Without it errors of both waves are of
//! second order in L wherever L is not long against the height of the section, with it of fourth order.
//!
//! Weights w of inertia and of internal work are linear along the element: K = ∫ δ Bᵀ D B dx, M = ∫ α ρ N Nᵀ dx with the same shapes, both
//! integrated exactly. Where α varies the motion of the inside is left out of the mass, which stays positive definite.

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

/// By how much more than needed a mass is made positive definite, of what is needed.
const MARGIN: f64 = 0.05;

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

/// Weights at the two ends of an element, linear between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EndWeights {
    /// α of the inertia.
    pub(super) inertia: [f64; 2],
    /// δ of the internal work.
    pub(super) stiffness: [f64; 2],
}

impl EndWeights {
    /// No other body in the same volume.
    pub(super) const ONE: EndWeights = EndWeights {
        inertia: [1.0; 2],
        stiffness: [1.0; 2],
    };

    /// `∫ α N_a dξ` of the linear functions of both ends.
    pub(super) fn shares(&self) -> [f64; 2] {
        let [a, b] = self.inertia;
        [a / 3.0 + b / 6.0, a / 6.0 + b / 3.0]
    }

    /// `∫ α N_a N_b dξ`.
    pub(super) fn products(&self) -> [[f64; 2]; 2] {
        let [a, b] = self.inertia;
        let mixed = (a + b) / 12.0;
        [[a / 4.0 + b / 12.0, mixed], [mixed, a / 12.0 + b / 4.0]]
    }
}

/// An element of a length (m) with a section, a material and weights.
#[derive(Clone, Copy)]
pub(super) struct Element<'a> {
    pub(super) length: f64,
    pub(super) section: &'a BeamSection,
    pub(super) material: &'a Elastic,
    pub(super) weights: EndWeights,
}

impl Element<'_> {
    /// K in N/m, N and N m.
    pub(super) fn stiffness(&self) -> Matrix {
        match self.weights.stiffness == [1.0; 2] {
            true => self.full_stiffness(),
            false => self.weighted_stiffness(),
        }
    }

    /// ∫ δ Bᵀ D B dx: extension and bending at two points of Gauss, exact for a linear δ; the strain of shear and torsion is constant.
    fn weighted_stiffness(&self) -> Matrix {
        let [first, second] = self.weights.stiffness;
        let mut k = self.shear_and_torsion();
        k.iter_mut()
            .flatten()
            .for_each(|k| *k *= 0.5 * (first + second));
        let properties = &self.section.properties;
        let [about_y, about_z] = properties.second_moments;
        let moduli = [properties.area, about_y, about_z].map(|i| self.material.young * i);
        for xi in super::fibres::GAUSS {
            let delta = (1.0 - xi) * first + xi * second;
            for (row, modulus) in self.strain_rows(xi).iter().zip(moduli) {
                let factor = 0.5 * self.length * delta * modulus;
                for (k, a) in k.iter_mut().zip(row) {
                    for (k, b) in k.iter_mut().zip(row) {
                        *k += factor * a * b;
                    }
                }
            }
        }
        k
    }

    fn full_stiffness(&self) -> Matrix {
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

    /// Strain of the axis, κ_y and κ_z (1/m) at ξ by the unknowns: `κ = N_θ'/L`, linear in ξ. Two points of Gauss give K of
    /// extension and bending.
    pub(super) fn strain_rows(&self, xi: f64) -> [[f64; 12]; 3] {
        let l = self.length;
        let mut rows = [[0.0; 12]; 3];
        (rows[0][0], rows[0][6]) = (-1.0 / l, 1.0 / l);
        let [about_z, about_y] = self.planes();
        // the plane x z turns by -θ_y
        for (row, plane, turn) in [(2, &about_z, 1.0), (1, &about_y, -1.0)] {
            for ((place, sign), slope) in plane.unknowns.iter().zip(plane.curvature(l, xi)) {
                rows[row][*place] = turn * sign * slope;
            }
        }
        rows
    }

    /// K of what extension and bending leave: shear and torsion. `κ G A L (Φ/(1 + Φ))² g gᵀ` of the shear strain Φ/(1 + Φ) g.
    pub(super) fn shear_and_torsion(&self) -> Matrix {
        let (l, mut k) = (self.length, [[0.0; 12]; 12]);
        let about = self.material.shear_modulus() * self.section.properties.torsion / l;
        (k[3][3], k[3][9], k[9][3], k[9][9]) = (about, -about, -about, about);
        let g = [-1.0 / l, -0.5, 1.0 / l, -0.5];
        for plane in self.planes() {
            let factor = 12.0 * plane.stiffness * plane.shear / (l * (1.0 + plane.shear).powi(2));
            plane.add(factor, &g.map(|a| g.map(|b| a * b)), &mut k);
        }
        k
    }

    /// Consistent mass in kg, kg m and kg m².
    pub(super) fn mass(&self) -> Matrix {
        let mut m = [[0.0; 12]; 12];
        let [first, second] = self.weights.inertia;
        for (i, whole) in [(0, self.weight()), (3, self.polar())] {
            for (a, b, part) in [
                (i, i, 12.0 / (3.0 * first + second)),
                (i, i + 6, 12.0 / (first + second)),
                (i + 6, i, 12.0 / (first + second)),
                (i + 6, i + 6, 12.0 / (first + 3.0 * second)),
            ] {
                m[a][b] = whole / part;
            }
        }
        for plane in self.planes() {
            plane.add(1.0, &self.whole_mass(&plane), &mut m);
        }
        m
    }

    /// The diagonal of the lumped mass: half the mass at each node, half the inertia about x, and in bending the diagonal of the
    /// consistent mass scaled to the mass of the element. Hinton, Rock and Zienkiewicz (1976). With weights the halves are ∫ α N dx/L.
    pub(super) fn lumped(&self) -> [f64; 12] {
        let [first, second] = self.weights.inertia;
        let halves = [(2.0 * first + second) / 6.0, (first + 2.0 * second) / 6.0];
        let mut lumped = [0.0; 12];
        let added = 0.5 * self.section.added_mass * self.length;
        for (end, half) in halves.iter().enumerate() {
            lumped[6 * end] = half * self.weight();
            lumped[6 * end + 3] = half * self.polar();
        }
        let across = halves.map(|half| half * self.weight() + added);
        for plane in self.planes() {
            let own = self.mass_of(&plane);
            let scale = (across[0] + across[1]) / (own[0][0] + own[2][2]);
            for (k, (place, _)) in plane.unknowns.iter().enumerate() {
                lumped[*place] = match k % 2 {
                    0 => across[k / 2],
                    _ => scale * own[k][k],
                };
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
            ..
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
        let l = self.length;
        let [first, second] = self.weights.inertia;
        let mut m = [[0.0; 4]; 4];
        for (xi, weight) in GAUSS {
            let (v, theta) = (plane.deflection(l, xi), plane.rotation(l, xi));
            let dx = weight * l;
            let alpha = (1.0 - xi) * first + xi * second;
            let (line, rotary) = (self.across(alpha), alpha * plane.rotary);
            for a in 0..4 {
                for b in 0..4 {
                    m[a][b] += (line * v[a] * v[b] + rotary * theta[a] * theta[b]) * dx;
                }
            }
        }
        m
    }

    /// Mass per length that moves across the axis, kg/m, where the weight is α. The fluid has no other body to share with.
    fn across(&self, alpha: f64) -> f64 {
        alpha * self.material.density * self.section.properties.area + self.section.added_mass
    }

    /// ∫ k N Nᵀ dx of the foundation.
    pub(super) fn foundation(&self) -> Matrix {
        let mut k = [[0.0; 12]; 12];
        self.each_foundation_row(&mut |row, stiffness| {
            for (k, a) in k.iter_mut().zip(row) {
                for (k, b) in k.iter_mut().zip(row) {
                    *k += stiffness * a * b;
                }
            }
        });
        k
    }

    /// Visits the displacements that the foundation opposes, as coefficients of the unknowns, and the stiffness of each, N/m.
    pub(super) fn each_foundation_row(&self, visit: &mut dyn FnMut(&[f64; 12], f64)) {
        let [along, rest @ ..] = self.section.foundation;
        for (xi, weight) in GAUSS {
            let dx = weight * self.length;
            let mut row = [0.0; 12];
            (row[0], row[6]) = (1.0 - xi, xi);
            if along != 0.0 {
                visit(&row, along * dx);
            }
            for (plane, stiffness) in self.planes().iter().zip(rest) {
                let mut row = [0.0; 12];
                let shapes = plane.deflection(self.length, xi);
                for (&(place, sign), value) in plane.unknowns.iter().zip(shapes) {
                    row[place] = sign * value;
                }
                if stiffness != 0.0 {
                    visit(&row, stiffness * dx);
                }
            }
        }
    }

    /// Translation and rotation of the section at ξ by the unknowns, six rows.
    pub(super) fn motion(&self, xi: f64) -> [[f64; 12]; 6] {
        let mut rows = [[0.0; 12]; 6];
        for i in [0, 3] {
            (rows[i][i], rows[i][i + 6]) = (1.0 - xi, xi);
        }
        let [about_z, about_y] = self.planes();
        // the plane x z turns by -θ_y
        for (moved, turned, plane, turn) in [(1, 5, &about_z, 1.0), (2, 4, &about_y, -1.0)] {
            let shapes = plane.deflection(self.length, xi).into_iter();
            let shapes = shapes.zip(plane.rotation(self.length, xi));
            for ((place, sign), (v, theta)) in plane.unknowns.iter().zip(shapes) {
                rows[moved][*place] = sign * v;
                rows[turned][*place] = turn * sign * theta;
            }
        }
        rows
    }

    /// The part of the consistent mass that is of the fluid around the section.
    pub(super) fn fluid_mass(&self) -> Matrix {
        let section = BeamSection {
            added_mass: 0.0,
            ..*self.section
        };
        let (mut mass, dry) = (
            self.mass(),
            Element {
                section: &section,
                ..*self
            }
            .mass(),
        );
        let BeamSection {
            added_mass,
            displaced_mass,
            ..
        } = self.section;
        let factor = 1.0 + displaced_mass / added_mass;
        for (row, dry) in mass.iter_mut().zip(dry) {
            for (m, dry) in row.iter_mut().zip(dry) {
                *m = factor * (*m - dry);
            }
        }
        mass
    }
}

impl Element<'_> {
    /// The consistent mass of a plane with the motion of the inside.
    fn whole_mass(&self, plane: &Bending) -> [[f64; 4]; 4] {
        if self.weights.inertia != [1.0; 2] {
            return self.mass_of(plane);
        }
        let (mut m, inside) = (self.mass_of(plane), self.inside(plane));
        for (m, inside) in m.iter_mut().flatten().zip(inside.iter().flatten()) {
            *m += inside;
        }
        let l = self.length;
        let g = [-1.0 / l, -0.5, 1.0 / l, -0.5];
        // det(M + c g gᵀ) = (1 + c g·M⁻¹g) det M, and M has one negative eigenvalue at most
        let inverse: f64 = solved(m, g).iter().zip(g).map(|(x, g)| x * g).sum();
        if inverse < 0.0 {
            let c = -(1.0 + MARGIN) / inverse;
            for (row, a) in m.iter_mut().zip(g) {
                for (m, b) in row.iter_mut().zip(g) {
                    *m += c * a * b;
                }
            }
        }
        m
    }

    /// What the motion of the inside beyond the shapes adds to the consistent mass.
    fn inside(&self, plane: &Bending) -> [[f64; 4]; 4] {
        let (l, phi) = (self.length, plane.shear);
        let line = self.across(1.0);
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

/// Solution of four equations, by elimination with exchanges of rows.
fn solved(mut m: [[f64; 4]; 4], mut right: [f64; 4]) -> [f64; 4] {
    for k in 0..4 {
        let largest = (k..4).fold(k, |best, i| match m[i][k].abs() > m[best][k].abs() {
            true => i,
            false => best,
        });
        m.swap(k, largest);
        right.swap(k, largest);
        let pivot = m[k];
        for i in k + 1..4 {
            let factor = m[i][k] / pivot[k];
            for (m, pivot) in m[i].iter_mut().zip(pivot) {
                *m -= factor * pivot;
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..4).rev() {
        let known: f64 = (k + 1..4).map(|j| m[k][j] * right[j]).sum();
        right[k] = (right[k] - known) / m[k][k];
    }
    right
}

impl Bending {
    /// N_v at ξ of an element of a length, m.
    fn deflection(&self, l: f64, xi: f64) -> [f64; 4] {
        let phi = self.shear;
        let (square, cube) = (xi * xi, xi * xi * xi);
        [
            2.0 * cube - 3.0 * square - phi * xi + 1.0 + phi,
            l * (cube - (2.0 + 0.5 * phi) * square + (1.0 + 0.5 * phi) * xi),
            -2.0 * cube + 3.0 * square + phi * xi,
            l * (cube - (1.0 - 0.5 * phi) * square - 0.5 * phi * xi),
        ]
        .map(|n| n / (1.0 + phi))
    }

    /// N_θ at ξ, 1/m for translations.
    fn rotation(&self, l: f64, xi: f64) -> [f64; 4] {
        let (phi, square) = (self.shear, xi * xi);
        [
            6.0 * (square - xi) / l,
            3.0 * square - (4.0 + phi) * xi + 1.0 + phi,
            -6.0 * (square - xi) / l,
            3.0 * square - (2.0 - phi) * xi,
        ]
        .map(|n| n / (1.0 + phi))
    }

    /// N_θ'/L at ξ, 1/m for translations.
    fn curvature(&self, l: f64, xi: f64) -> [f64; 4] {
        let phi = self.shear;
        [
            6.0 * (2.0 * xi - 1.0) / l,
            6.0 * xi - (4.0 + phi),
            -6.0 * (2.0 * xi - 1.0) / l,
            6.0 * xi - (2.0 - phi),
        ]
        .map(|n| n / (l * (1.0 + phi)))
    }

    fn add(&self, factor: f64, own: &[[f64; 4]; 4], to: &mut Matrix) {
        for (row, &(a, sign)) in own.iter().zip(&self.unknowns) {
            for (value, &(b, other)) in row.iter().zip(&self.unknowns) {
                to[a][b] += factor * sign * other * value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::SectionShape;

    /// Whether Gauss's pivots, each over the diagonal, are above a bound.
    fn is_positive(mut m: Matrix) -> bool {
        let diagonal: Vec<f64> = (0..12).map(|i| m[i][i]).collect();
        for k in 0..12 {
            if m[k][k] <= 1e-9 * diagonal[k] {
                return false;
            }
            for i in k + 1..12 {
                let factor = m[i][k] / m[k][k];
                for j in 0..12 {
                    m[i][j] -= factor * m[k][j];
                }
            }
        }
        true
    }

    #[test]
    fn extension_and_bending_at_two_points_with_shear_and_torsion_are_the_stiffness() {
        let material = Elastic {
            density: 1.0,
            young: 3.0,
            poisson: 0.3,
        };
        let shape = SectionShape::Rectangle {
            height: 0.3,
            width: 0.2,
        };
        for theory in [BeamTheory::EulerBernoulli, BeamTheory::Timoshenko] {
            let section = BeamSection::new(theory, shape.properties(0.3));
            let properties = section.properties;
            let [about_y, about_z] = properties.second_moments;
            let element = Element {
                length: 0.7,
                section: &section,
                material: &material,
                weights: EndWeights::ONE,
            };
            let (whole, mut k) = (element.stiffness(), element.shear_and_torsion());
            let moduli = [properties.area, about_y, about_z].map(|i| 3.0 * i);
            for xi in super::super::fibres::GAUSS {
                for (row, modulus) in element.strain_rows(xi).iter().zip(moduli) {
                    for (i, k) in k.iter_mut().enumerate() {
                        for (j, k) in k.iter_mut().enumerate() {
                            *k += 0.5 * 0.7 * modulus * row[i] * row[j];
                        }
                    }
                }
            }
            for i in 0..12 {
                for j in 0..12 {
                    let scale = (whole[i][i] * whole[j][j]).sqrt();
                    assert!((k[i][j] - whole[i][j]).abs() < 1e-13 * scale, "{i} {j}");
                }
            }
        }
    }

    #[test]
    fn the_mass_of_an_element_is_positive_definite_however_long_it_is() {
        for theory in [BeamTheory::EulerBernoulli, BeamTheory::Timoshenko] {
            for poisson in [0.0, 0.3, 0.49] {
                let material = Elastic {
                    density: 1.0,
                    young: 1.0,
                    poisson,
                };
                let shape = SectionShape::Circle { diameter: 1.0 };
                let section = BeamSection::new(theory, shape.properties(poisson));
                for k in -20..20 {
                    let element = Element {
                        length: 1.5_f64.powi(k),
                        section: &section,
                        material: &material,
                        weights: EndWeights::ONE,
                    };
                    assert!(is_positive(element.mass()), "{theory:?} {poisson} {k}");
                }
            }
        }
    }
}
