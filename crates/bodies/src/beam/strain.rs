//! Strains of a geometrically exact beam element as functions of six invariants of its places and directors.
//!
//! The columns d_iᵃ of a matrix are the axes of the section at node a. With
//! `g_i = ½ (d_i¹ + d_i²)·(x₂ - x₁)/L`, `Q_ij = d_i¹·d_j²`, `a = ½ (Q₃₂ - Q₂₃, Q₁₃ - Q₃₁, Q₂₁ - Q₁₂)`
//! a is n sin φ, of the relative rotation φ about n. The axes in the middle between both rotations are the means of the directors,
//! divided by cos(φ/2) across n: there
//!
//! `Γ = g/c + h a (a·g) - e₁`, `κ = f a/L`, `c = cos(φ/2)`, `h = -1/(4 c³ (1 + c))`, `f = φ/sin φ`.
//!
//! κ is exact for any rotation below 90° between the nodes. All invariants are bilinear in places and directors.
//!
//! Where the stiffness across the axis is for the most part that of the bending between the nodes, `12 E I/L²`, Γ_y and Γ_z are angles between the section
//! and the chord, and the section in the middle is no normal of the axis. The axis between the nodes is longer than the projection of the chord
//! on that normal. With β the part of Γ_y that is bending, the shape of a cubic with these angles at both ends has the extension
//!
//! `ε = Γ_x + c_y Γ_y² + c_z Γ_z²`, `c = β - 2 β²/5`.
//!
//! Without it a tension N above the stiffness across the axis would turn the section away from the chord: cables of elements longer than
//! √(12 E I/N) would be unstable. Pure shear (β = 0) has the normal force along the normal of the section, as Reissner's beam.

use carom_algebra::tensor::{Mat3, Vec3};

use super::functions::Functions;

use crate::flowing::Strains;

/// The invariants g and a.
pub(super) type Invariants = [f64; 6];

/// A matrix over the invariants.
pub(super) type Matrix6 = [[f64; 6]; 6];

/// Places of Gauss's rule on [0, 1] and weights: exact to degree 7.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Two nodes of an element: the way between them (m) and the directors of both, also means over a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) way: Vec3,
    pub(super) directors: [Mat3; 2],
}

/// An element: its length (m), the stiffness of each strain, N and N m², and c_y and c_z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elastic {
    pub(super) length: f64,
    pub(super) stiffness: [f64; 6],
    pub(super) extends: [f64; 2],
}

/// c of a part β of bending.
pub(super) fn extension(bending: f64) -> f64 {
    bending * (1.0 - 0.4 * bending)
}

impl Pair {
    /// The mean of two.
    pub(super) fn mean(&self, other: &Pair) -> Pair {
        let mean = |a: usize| (self.directors[a] + other.directors[a]) * 0.5;
        Pair {
            way: (self.way + other.way) * 0.5,
            directors: [mean(0), mean(1)],
        }
    }

    pub(super) fn invariants(&self, length: f64) -> Invariants {
        let [one, two] = &self.directors;
        let g = (one + two).tr_mul(&self.way) * (0.5 / length);
        let q = one.tr_mul(two);
        [
            g.x,
            g.y,
            g.z,
            0.5 * (q[(2, 1)] - q[(1, 2)]),
            0.5 * (q[(0, 2)] - q[(2, 0)]),
            0.5 * (q[(1, 0)] - q[(0, 1)]),
        ]
    }

    /// Derivatives of the invariants by the motion x₁, w₁, x₂, w₂ of the nodes, w turns of the directors in space.
    pub(super) fn derivatives(&self, length: f64) -> [[f64; 12]; 6] {
        let [one, two] = &self.directors;
        let mut rows = [[0.0; 12]; 6];
        let put = |row: &mut [f64; 12], place: usize, v: &Vec3| {
            for i in 0..3 {
                row[place + i] += v[i];
            }
        };
        for i in 0..3 {
            let (d, e) = (one.column(i).into_owned(), two.column(i).into_owned());
            let along = (d + e) * (0.5 / length);
            put(&mut rows[i], 0, &-along);
            put(&mut rows[i], 6, &along);
            put(&mut rows[i], 3, &(d.cross(&self.way) * (0.5 / length)));
            put(&mut rows[i], 9, &(e.cross(&self.way) * (0.5 / length)));
            // δQ_jk = (w₁ - w₂)·(d_j¹ × d_k²)
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let cross = |j: usize, k: usize| one.column(j).cross(&two.column(k));
            let turn = (cross(k, j) - cross(j, k)) * 0.5;
            put(&mut rows[3 + i], 3, &turn);
            put(&mut rows[3 + i], 9, &-turn);
        }
        rows
    }

    /// Derivative of the forces `∂sᵀ D` of given D by the motion of the nodes, its symmetric part.
    pub(super) fn curvature(&self, length: f64, d: &Invariants) -> [[f64; 12]; 12] {
        let [one, two] = &self.directors;
        let g = Vec3::new(d[0], d[1], d[2]) * (0.5 / length);
        let s = Vec3::new(d[3], d[4], d[5]).cross_matrix() * 0.5;
        let way = self.way.cross_matrix();
        let mut k = [[0.0; 12]; 12];
        let mut put = |row: usize, column: usize, m: &Mat3| {
            for i in 0..3 {
                for j in 0..3 {
                    k[row + i][column + j] += 0.5 * m[(i, j)];
                    k[column + j][row + i] += 0.5 * m[(i, j)];
                }
            }
        };
        for (a, directors) in self.directors.iter().enumerate() {
            let pull = (directors * g).cross_matrix();
            // of f₂ = Σ d_i g_i, and of the moments d_i × way g_i by the way
            put(6, 3 + 6 * a, &(pull * -2.0));
            put(0, 3 + 6 * a, &(pull * 2.0));
            put(3 + 6 * a, 3 + 6 * a, &(way * pull));
        }
        let (mut own, mut between) = ([Mat3::zeros(); 2], Mat3::zeros());
        for i in 0..3 {
            for j in 0..3 {
                let (d, e) = (one.column(i).cross_matrix(), two.column(j).cross_matrix());
                own[0] += e * d * s[(i, j)];
                own[1] += d * e * s[(i, j)];
                between -= d * e * s[(i, j)];
            }
        }
        put(3, 3, &own[0]);
        put(9, 9, &own[1]);
        put(3, 9, &(between * 2.0));
        k
    }
}

impl Elastic {
    /// ε, Γ_y, Γ_z and κ.
    pub(super) fn strains(&self, s: &Invariants) -> [f64; 6] {
        let (g, a) = (Vec3::new(s[0], s[1], s[2]), Vec3::new(s[3], s[4], s[5]));
        let functions = Functions::of(a.norm_squared());
        let gamma = g * functions.inverse[0] + a * (functions.h[0] * a.dot(&g));
        let kappa = a * (functions.f[0] / self.length);
        let [y, z] = self.extends;
        let extension = gamma.x - 1.0 + y * gamma.y * gamma.y + z * gamma.z * gamma.z;
        [extension, gamma.y, gamma.z, kappa.x, kappa.y, kappa.z]
    }

    /// Derivatives of the strains by the invariants.
    fn slopes(&self, s: &Invariants) -> Matrix6 {
        let (g, a) = (Vec3::new(s[0], s[1], s[2]), Vec3::new(s[3], s[4], s[5]));
        let Functions { f, inverse, h } = Functions::of(a.norm_squared());
        let along = a.dot(&g);
        let by_g = Mat3::identity() * inverse[0] + a * a.transpose() * h[0];
        let by_a = g * a.transpose() * (2.0 * inverse[1])
            + a * a.transpose() * (2.0 * h[1] * along)
            + (Mat3::identity() * along + a * g.transpose()) * h[0];
        let turn = (Mat3::identity() * f[0] + a * a.transpose() * (2.0 * f[1])) / self.length;
        let mut slopes = [[0.0; 6]; 6];
        for i in 0..3 {
            for j in 0..3 {
                slopes[i][j] = by_g[(i, j)];
                slopes[i][3 + j] = by_a[(i, j)];
                slopes[3 + i][3 + j] = turn[(i, j)];
            }
        }
        let gamma = g * inverse[0] + a * (h[0] * along);
        for (across, c) in [1, 2].into_iter().zip(self.extends) {
            for j in 0..6 {
                slopes[0][j] += 2.0 * c * gamma[across] * slopes[across][j];
            }
        }
        slopes
    }

    /// Forces and moments in the section, N and N m, in the axes in the middle.
    pub(super) fn stresses(&self, s: &Invariants) -> [f64; 6] {
        let strains = self.strains(s);
        [0, 1, 2, 3, 4, 5].map(|i| self.stiffness[i] * strains[i])
    }

    /// U in J.
    pub(super) fn energy(&self, s: &Invariants) -> f64 {
        let pairs = self.strains(s).into_iter().zip(self.stiffness);
        0.5 * self.length * pairs.map(|(e, c)| c * e * e).sum::<f64>()
    }

    /// ∂U/∂s.
    pub(super) fn gradient(&self, s: &Invariants) -> Invariants {
        self.gradient_of(s, &self.stresses(s))
    }

    /// Forces over the invariants, of these forces and moments in the section: L ∂(Γ, κ)/∂s transposed, times them.
    pub(super) fn gradient_of(&self, s: &Invariants, stresses: &[f64; 6]) -> Invariants {
        let slopes = self.slopes(s);
        [0, 1, 2, 3, 4, 5]
            .map(|j| self.length * (0..6).map(|i| stresses[i] * slopes[i][j]).sum::<f64>())
    }

    /// The mean of ∂U/∂s on the straight way between two: its product with the way is the change of U.
    pub(super) fn mean_gradient(&self, [from, to]: [&Invariants; 2]) -> Invariants {
        let mut sum = [0.0; 6];
        for (t, weight) in GAUSS {
            let s = [0, 1, 2, 3, 4, 5].map(|i| from[i] + t * (to[i] - from[i]));
            for (sum, value) in sum.iter_mut().zip(self.gradient(&s)) {
                *sum += weight * value;
            }
        }
        sum
    }

    /// Twice the derivative of [`Elastic::mean_gradient`] by the end of the way: the mean of 2 t ∂²U/∂s².
    pub(super) fn mean_tangent(&self, [from, to]: [&Invariants; 2]) -> Matrix6 {
        let mut sum = [[0.0; 6]; 6];
        for (t, weight) in GAUSS {
            let s = [0, 1, 2, 3, 4, 5].map(|i| from[i] + t * (to[i] - from[i]));
            let own = self.tangent(&s);
            for (sum, own) in sum.as_flattened_mut().iter_mut().zip(own.as_flattened()) {
                *sum += 2.0 * t * weight * own;
            }
        }
        sum
    }

    /// ∂²U/∂s².
    pub(super) fn tangent(&self, s: &Invariants) -> Matrix6 {
        let slopes = self.slopes(s);
        let mut k = [[0.0; 6]; 6];
        for (row, c) in slopes.iter().zip(self.stiffness) {
            for i in 0..6 {
                for j in 0..6 {
                    k[i][j] += self.length * c * row[i] * row[j];
                }
            }
        }
        self.add_of_stresses(s, &self.stresses(s), &mut k);
        k
    }
}

impl Elastic {
    /// Forces and moments that do the work of Γ and κ, of those of ε, Γ_y, Γ_z and κ: the normal force has a part across, as the chord has.
    pub(super) fn across_the_chord(&self, strains: &[f64; 6], stresses: &[f64; 6]) -> [f64; 6] {
        let mut all = *stresses;
        for (across, c) in [1, 2].into_iter().zip(self.extends) {
            all[across] += 2.0 * c * stresses[0] * strains[across];
        }
        all
    }

    /// The chord over L in the axes in the middle, e₁ + Γ.
    pub(super) fn chord(&self, strains: &[f64; 6]) -> Vec3 {
        let [y, z] = self.extends;
        let [extension, along_y, along_z, ..] = *strains;
        let projected = extension - y * along_y * along_y - z * along_z * along_z;
        Vec3::new(1.0 + projected, along_y, along_z)
    }

    /// Adds what forces and moments in the section make of the second derivatives of the strains: without them a tension above 4 E I/L² makes a matrix that is not
    /// positive definite.
    fn add_of_stresses(&self, s: &Invariants, stresses: &[f64; 6], k: &mut Matrix6) {
        let (strains, slopes) = (self.strains(s), self.slopes(s));
        for (across, c) in [1, 2].into_iter().zip(self.extends) {
            let factor = 2.0 * self.length * c * stresses[0];
            let row = &slopes[across];
            for i in 0..6 {
                for j in 0..6 {
                    k[i][j] += factor * row[i] * row[j];
                }
            }
        }
        let all = self.across_the_chord(&strains, stresses);
        let [mixed, own] = self.second_derivatives(s, &all);
        for i in 0..3 {
            for j in 0..3 {
                k[i][3 + j] += mixed[(i, j)];
                k[3 + j][i] += mixed[(i, j)];
                k[3 + i][3 + j] += own[(i, j)];
            }
        }
    }

    /// Second derivatives of L (n·Γ + m·κ) by g and a, and by a and a, for given n and m (Γ is linear in g).
    fn second_derivatives(&self, s: &Invariants, all: &[f64; 6]) -> [Mat3; 2] {
        let (g, a) = (Vec3::new(s[0], s[1], s[2]), Vec3::new(s[3], s[4], s[5]));
        let (n, m) = (
            Vec3::new(all[0], all[1], all[2]),
            Vec3::new(all[3], all[4], all[5]),
        );
        let Functions { f, inverse, h } = Functions::of(a.norm_squared());
        let [n_a, n_g, a_g, m_a] = [n.dot(&a), n.dot(&g), a.dot(&g), m.dot(&a)];
        let (one, twice) = (Mat3::identity(), a * a.transpose());
        let both = |u: &Vec3, v: &Vec3| u * v.transpose() + v * u.transpose();
        let mixed = n * a.transpose() * (2.0 * inverse[1])
            + twice * (2.0 * h[1] * n_a)
            + (a * n.transpose() + one * n_a) * h[0];
        let by_a = one * (2.0 * (inverse[1] * n_g + h[1] * n_a * a_g))
            + twice * (4.0 * (inverse[2] * n_g + h[2] * n_a * a_g))
            + both(&a, &(n * a_g + g * n_a)) * (2.0 * h[1])
            + both(&n, &g) * h[0];
        let bent = (one * m_a + both(&a, &m)) * (2.0 * f[1]) + twice * (4.0 * f[2] * m_a);
        [mixed * self.length, by_a * self.length + bent]
    }
}

/// Places of ε, κ_y and κ_z among the strains.
const FLOWING: [usize; 3] = [0, 4, 5];

/// Elements in which extension and bending flow, at one section; the rest is elastic.
impl Elastic {
    /// Strain of the axis, and curvatures.
    pub(super) fn flowing(strains: &[f64; 6]) -> Strains {
        FLOWING.map(|i| strains[i])
    }

    /// Forces and moments in the section, with these of extension and bending.
    pub(super) fn stresses_with(&self, strains: &[f64; 6], flowing: &Strains) -> [f64; 6] {
        let mut stresses = [0, 1, 2, 3, 4, 5].map(|i| self.stiffness[i] * strains[i]);
        for (place, force) in FLOWING.into_iter().zip(flowing) {
            stresses[place] = *force;
        }
        stresses
    }

    /// Energy of what stays elastic, J.
    pub(super) fn energy_beside(&self, strains: &[f64; 6]) -> f64 {
        let beside = (0..6).filter(|i| !FLOWING.contains(i));
        let parts = beside.map(|i| self.stiffness[i] * strains[i] * strains[i]);
        0.5 * self.length * parts.sum::<f64>()
    }

    /// [`Elastic::tangent`] with these forces and moments in the section, and this tangent of extension and bending.
    pub(super) fn tangent_with(
        &self,
        s: &Invariants,
        (stresses, flowing): (&[f64; 6], &[Strains; 3]),
    ) -> Matrix6 {
        let slopes = self.slopes(s);
        let mut moduli = [[0.0; 6]; 6];
        for (i, c) in self.stiffness.into_iter().enumerate() {
            moduli[i][i] = c;
        }
        for (&i, row) in FLOWING.iter().zip(flowing) {
            for (&j, value) in FLOWING.iter().zip(row) {
                moduli[i][j] = *value;
            }
        }
        let mut k = [[0.0; 6]; 6];
        for (row, moduli) in slopes.iter().zip(&moduli) {
            for (other, modulus) in slopes.iter().zip(moduli).filter(|(_, c)| **c != 0.0) {
                for i in 0..6 {
                    for j in 0..6 {
                        k[i][j] += self.length * modulus * row[i] * other[j];
                    }
                }
            }
        }
        self.add_of_stresses(s, stresses, &mut k);
        k
    }
}

#[cfg(test)]
mod tests {
    use carom_algebra::rotation::Rotation;
    use carom_testing::Random;

    use super::*;

    const ELEMENT: Elastic = Elastic {
        length: 0.1,
        stiffness: [1e4, 4e3, 5e3, 1.0, 2.0, 3.0],
        extends: [0.6, 0.3],
    };

    fn vector(random: &mut Random, size: f64) -> Vec3 {
        Vec3::from([0; 3].map(|_| random.between(-size, size)))
    }

    /// A pair, turned by about `turn` from one node to the other.
    fn pair(random: &mut Random, turn: f64) -> Pair {
        let turn = vector(random, turn);
        turned(random, &turn)
    }

    fn turned(random: &mut Random, turn: &Vec3) -> Pair {
        let first = Rotation::cayley(&vector(random, 1.0)).matrix();
        let second = first * Rotation::cayley(turn).matrix();
        Pair {
            way: first * Vec3::new(0.1, 0.0, 0.0) + vector(random, 1e-3),
            directors: [first, second],
        }
    }

    #[test]
    fn strains_are_those_of_the_axes_in_the_middle_and_their_derivatives_are_right() {
        let mut random = Random(3);
        for size in [1e-9, 0.05, 0.6] {
            let turn = vector(&mut random, size);
            let pair = turned(&mut random, &turn);
            let s = pair.invariants(0.1);
            let found = ELEMENT.strains(&s);
            let (axis, angle) = (turn.normalize(), 2.0 * (0.5 * turn.norm()).atan());
            let psi = axis * angle;
            let half = Rotation::cayley(&(axis * Rotation::increment(0.5 * angle))).matrix();
            let mut gamma = (pair.directors[0] * half).tr_mul(&pair.way) / 0.1 - Vec3::x();
            gamma.x += 0.6 * gamma.y * gamma.y + 0.3 * gamma.z * gamma.z;
            for i in 0..3 {
                assert!((found[i] - gamma[i]).abs() < 1e-13);
                assert!((found[3 + i] - psi[i] / 0.1).abs() < 1e-12);
            }
            let slopes = ELEMENT.slopes(&s);
            for j in 0..6 {
                let at = |step: f64| {
                    let mut s = s;
                    s[j] += step;
                    ELEMENT.strains(&s)
                };
                let (after, before) = (at(1e-6), at(-1e-6));
                for i in 0..6 {
                    // rounding over the step, and its square times third derivatives
                    let slope = (after[i] - before[i]) / 2e-6;
                    assert!((slope - slopes[i][j]).abs() < 1e-7 * (1.0 + slope.abs()));
                }
            }
        }
    }

    #[test]
    fn the_second_derivative_of_the_energy_is_right_under_large_forces() {
        let mut random = Random(6);
        for size in [1e-6, 1e-3, 0.1, 0.7] {
            let turn = vector(&mut random, size);
            let mut pair = turned(&mut random, &turn);
            // a tension and shear forces of a tenth of the stiffness
            pair.way *= 1.1;
            pair.way += vector(&mut random, 1e-2);
            let s = pair.invariants(0.1);
            let tangent = ELEMENT.tangent(&s);
            let most = tangent
                .iter()
                .flatten()
                .fold(0.0, |most: f64, k| most.max(k.abs()));
            for j in 0..6 {
                let at = |step: f64| {
                    let mut s = s;
                    s[j] += step;
                    ELEMENT.gradient(&s)
                };
                let (after, before) = (at(1e-5), at(-1e-5));
                for i in 0..6 {
                    // third derivatives of all, some hundred, times the square of the step, and rounding over the step
                    let slope = (after[i] - before[i]) / 2e-5;
                    assert!((slope - tangent[i][j]).abs() < 1e-8 * most, "{i} {j}");
                }
            }
        }
    }

    #[test]
    fn the_derivative_of_the_mean_gradient_is_right() {
        let mut random = Random(7);
        let [from, to] = [0.3, 0.5].map(|size| {
            let turn = vector(&mut random, size);
            turned(&mut random, &turn).invariants(0.1)
        });
        let tangent = ELEMENT.mean_tangent([&from, &to]);
        let all = tangent.as_flattened().iter();
        let most = all.fold(0.0, |most: f64, k| most.max(k.abs()));
        for j in 0..6 {
            let at = |step: f64| {
                let mut to = to;
                to[j] += step;
                ELEMENT.mean_gradient([&from, &to])
            };
            let (after, before) = (at(1e-5), at(-1e-5));
            for i in 0..6 {
                // as above; the rule of Gauss is the same in both
                let slope = (after[i] - before[i]) / 1e-5;
                assert!((slope - tangent[i][j]).abs() < 1e-8 * most, "{i} {j}");
            }
        }
    }

    #[test]
    fn the_derivatives_of_invariants_and_of_forces_are_right() {
        let mut random = Random(4);
        let pair = pair(&mut random, 0.3);
        let d = [0; 6].map(|_| random.between(-1.0, 1.0));
        let moved = |k: usize, step: f64| {
            let mut pair = pair;
            let mut turn = Vec3::zeros();
            turn[k % 3] = step;
            match k / 3 {
                0 => pair.way -= turn,
                2 => pair.way += turn,
                node => {
                    let turned = Rotation::cayley(&turn).matrix();
                    pair.directors[node / 2] = turned * pair.directors[node / 2];
                }
            }
            pair
        };
        let rows = pair.derivatives(0.1);
        let force = |pair: &Pair| {
            let rows = pair.derivatives(0.1);
            let of = |k: usize| (0..6).map(|i| rows[i][k] * d[i]).sum::<f64>();
            (0..12).map(of).collect::<Vec<_>>()
        };
        let mut slopes = vec![vec![0.0; 12]; 12];
        for k in 0..12 {
            let (after, before) = (moved(k, 1e-6), moved(k, -1e-6));
            let (s, t) = (after.invariants(0.1), before.invariants(0.1));
            for i in 0..6 {
                assert!(((s[i] - t[i]) / 2e-6 - rows[i][k]).abs() < 1e-8);
            }
            let (f, g) = (force(&after), force(&before));
            for i in 0..12 {
                slopes[i][k] = (f[i] - g[i]) / 2e-6;
            }
        }
        let curvature = pair.curvature(0.1, &d);
        for i in 0..12 {
            for j in 0..12 {
                let mean = 0.5 * (slopes[i][j] + slopes[j][i]);
                assert!(
                    (mean - curvature[i][j]).abs() < 1e-7,
                    "{i} {j} {mean} {}",
                    curvature[i][j]
                );
            }
        }
    }

    #[test]
    fn forces_between_two_configurations_do_the_work_of_the_energy_and_have_no_moment() {
        let mut random = Random(5);
        for size in [1e-3, 1e-2] {
            let before = pair(&mut random, 0.1);
            let common = vector(&mut random, 0.5);
            let mut turns = [common, common].map(|turn| turn + vector(&mut random, size));
            // about the axes of each node: a common turn in space
            turns[1] = before.directors[1].transpose() * before.directors[0] * turns[1];
            let later = |a: usize| before.directors[a] * Rotation::cayley(&turns[a]).matrix();
            let after = Pair {
                way: later(0) * (Vec3::new(0.1, 0.0, 0.0) + vector(&mut random, 1e-4)),
                directors: [later(0), later(1)],
            };
            let (s, t) = (before.invariants(0.1), after.invariants(0.1));
            let d = ELEMENT.mean_gradient([&s, &t]);
            let middle = before.mean(&after);
            let rows = middle.derivatives(0.1);
            let force = |k: usize| {
                Vec3::from([0, 1, 2].map(|i| (0..6).map(|j| rows[j][k + i] * d[j]).sum()))
            };
            let work = force(6).dot(&(after.way - before.way))
                + (0..2)
                    .map(|a| force(3 + 6 * a).dot(&(before.directors[a] * turns[a])))
                    .sum::<f64>();
            let change = ELEMENT.energy(&t) - ELEMENT.energy(&s);
            let scale = ELEMENT.energy(&t).max(ELEMENT.energy(&s));
            assert!((work - change).abs() < 1e-13 * scale, "{work} {change}");
            let moment = middle.way.cross(&force(6)) + force(3) + force(9);
            assert!(moment.norm() < 1e-13 * force(3).norm());
        }
    }
}
