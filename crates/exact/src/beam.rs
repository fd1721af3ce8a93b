//! Free vibrations and waves of a uniform straight beam, after Euler and Bernoulli or Timoshenko.
//!
//! With bending stiffness B = E I, shear stiffness S = κ G A, mass m = ρ A and rotary inertia J = ρ I per length, deflection v and
//! rotation θ of the section: `S (v'' - θ') = m v̈`, `B θ'' + S (v' - θ) = J θ̈`. Waves `e^{sx} cos ωt` have
//! `S B s⁴ + ω² (S J + m B) s² + m ω² (J ω² - S) = 0` and θ = (S s² + m ω²)/(S s) v. Without shear and rotary inertia, S = ∞, J = 0:
//! `B s⁴ = m ω²`, θ = s v.
//!
//! Timoshenko (1921), Phil. Mag. 41.

use std::f64::consts::PI;

/// A uniform beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Length, m.
    pub length: f64,
    /// B in N m².
    pub bending: f64,
    /// m in kg/m.
    pub mass: f64,
    /// S in N and J in kg m; none of Euler and Bernoulli.
    pub shear: Option<[f64; 2]>,
}

/// How an end of a beam is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// v = 0, θ' = 0.
    Pinned,
    /// v = 0, θ = 0.
    Clamped,
    /// θ' = 0, and no shear force.
    Free,
}

/// A part of the solution at a place: v, θ, B θ', and the shear force.
type Values = [f64; 4];

impl Beam {
    /// The first angular frequencies (rad/s) of bending, rigid motions left out: zeros of the determinant of the boundary
    /// conditions, below the cutoff frequency √(S/J).
    pub fn frequencies(&self, ends: [End; 2], count: usize) -> Vec<f64> {
        let scale = (self.bending / self.mass).sqrt() / self.length.powi(2);
        // in terms of β L, in which roots stand about π apart
        let at = |x: f64| self.determinant(ends, scale * x * x);
        let step = 1e-3 * PI;
        let (mut found, mut x) = (Vec::new(), 0.5);
        while found.len() < count && self.is_below_cutoff(scale * (x + step).powi(2)) {
            let (mut low, mut high) = (x, x + step);
            let sign = at(low);
            if sign * at(high) < 0.0 {
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    match sign * at(middle) > 0.0 {
                        true => low = middle,
                        false => high = middle,
                    }
                }
                found.push(scale * (0.5 * (low + high)).powi(2));
            }
            x += step;
        }
        found
    }

    /// Angular frequencies (rad/s) of a wave with this wave number (1/m): of bending, and of shear unless it is left out.
    pub fn of_wave(&self, number: f64) -> Vec<f64> {
        let square = number * number;
        let Some([s, j]) = self.shear else {
            return vec![square * (self.bending / self.mass).sqrt()];
        };
        // m J ω⁴ - ω² (m S + k² (S J + m B)) + S B k⁴ = 0
        let (m, b) = (self.mass, self.bending);
        let half = 0.5 * (m * s + square * (s * j + m * b));
        let larger = half + (half * half - m * j * s * b * square * square).sqrt();
        vec![
            (s * b * square * square / larger).sqrt(),
            (larger / (m * j)).sqrt(),
        ]
    }

    /// θ over v of the wave v = cos kx, θ = -r sin kx with angular frequency ω: r = k - m ω²/(S k).
    pub fn rotation_of_wave(&self, number: f64, frequency: f64) -> f64 {
        match self.shear {
            None => number,
            Some([s, _]) => number - self.mass * frequency * frequency / (s * number),
        }
    }

    fn is_below_cutoff(&self, frequency: f64) -> bool {
        self.shear
            .is_none_or(|[s, j]| j * frequency * frequency < s)
    }

    fn determinant(&self, ends: [End; 2], frequency: f64) -> f64 {
        let mut matrix = [[0.0; 4]; 4];
        for (side, end) in ends.into_iter().enumerate() {
            let values = self.basis(frequency, if side == 0 { 0.0 } else { self.length });
            let conditions = match end {
                End::Pinned => [0, 2],
                End::Clamped => [0, 1],
                End::Free => [2, 3],
            };
            for (row, &condition) in conditions.iter().enumerate() {
                let size: f64 = values.iter().map(|v| v[condition].abs()).sum();
                matrix[2 * side + row] = values.map(|v| v[condition] / size);
            }
        }
        determinant(matrix)
    }

    /// The four solutions e^{-λx}, e^{-λ(L - x)}, cos μx, sin μx at a place.
    fn basis(&self, frequency: f64, x: f64) -> [Values; 4] {
        let square = frequency * frequency;
        let (m, b) = (self.mass, self.bending);
        let (lambda, mu, of_lambda, of_mu, rotary) = match self.shear {
            None => {
                let beta = (m * square / b).powf(0.25);
                (beta, beta, beta, beta, 0.0)
            }
            Some([s, j]) => {
                let half = 0.5 * square * (s * j + m * b) / (s * b);
                let product = m * square * (s - j * square) / (s * b);
                let root = (half * half + product).sqrt();
                let (lambda, mu) = ((product / (root + half)).sqrt(), (root + half).sqrt());
                let of_lambda = lambda + m * square / (s * lambda);
                let of_mu = mu - m * square / (s * mu);
                (lambda, mu, of_lambda, of_mu, j * square)
            }
        };
        // v, θ and its first two derivatives
        let values = |[v, t, t1, t2]: [f64; 4]| [v, t, b * t1, b * t2 + rotary * t];
        let decay = (-lambda * x).exp();
        let growth = (-lambda * (self.length - x)).exp();
        let (sin, cos) = (mu * x).sin_cos();
        [
            values(
                [
                    1.0,
                    -of_lambda,
                    of_lambda * lambda,
                    -of_lambda * lambda * lambda,
                ]
                .map(|q| q * decay),
            ),
            values(
                [
                    1.0,
                    of_lambda,
                    of_lambda * lambda,
                    of_lambda * lambda * lambda,
                ]
                .map(|q| q * growth),
            ),
            values([cos, -of_mu * sin, -of_mu * mu * cos, of_mu * mu * mu * sin]),
            values([sin, of_mu * cos, -of_mu * mu * sin, -of_mu * mu * mu * cos]),
        ]
    }
}

fn determinant(mut a: [[f64; 4]; 4]) -> f64 {
    let mut product = 1.0;
    for k in 0..4 {
        let largest = |best: usize, i: usize| match a[i][k].abs() > a[best][k].abs() {
            true => i,
            false => best,
        };
        let pivot = (k..4).fold(k, largest);
        if pivot != k {
            a.swap(pivot, k);
            product = -product;
        }
        product *= a[k][k];
        if a[k][k] == 0.0 {
            return 0.0;
        }
        for i in k + 1..4 {
            let factor = a[i][k] / a[k][k];
            for j in k..4 {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Roots β L of the textbooks: Blevins (1979), Formulas for natural frequency and mode shape, table 8-1.
    #[test]
    fn slender_beams_have_the_frequencies_of_the_textbook() {
        let beam = Beam {
            length: 2.0,
            bending: 3.0,
            mass: 5.0,
            shear: None,
        };
        use End::{Clamped, Free, Pinned};
        let cases = [
            ([Free, Free], [4.730_040_74, 7.853_204_62, 10.995_607_8]),
            ([Clamped, Free], [1.875_104_07, 4.694_091_13, 7.854_757_44]),
            (
                [Clamped, Pinned],
                [3.926_602_31, 7.068_582_75, 10.210_176_1],
            ),
            (
                [Clamped, Clamped],
                [4.730_040_74, 7.853_204_62, 10.995_607_8],
            ),
            ([Pinned, Pinned], [PI, 2.0 * PI, 3.0 * PI]),
        ];
        for (ends, roots) in cases {
            let found = beam.frequencies(ends, 3);
            for (found, root) in found.iter().zip(roots) {
                let beta = (found / (3.0_f64 / 5.0).sqrt()).sqrt() * 2.0;
                assert!((beta / root - 1.0).abs() < 1e-8, "{ends:?}: {beta} {root}");
            }
        }
    }

    /// A pinned beam has the sine waves of its length; shear and rotary inertia lower its frequencies by about
    /// (nπ/L)² (J/m + B/S)/2 (Rayleigh, Timoshenko).
    #[test]
    fn a_pinned_beam_with_shear_has_waves_of_its_length() {
        let beam = Beam {
            length: 1.0,
            bending: 1.0,
            mass: 1.0,
            shear: Some([4000.0, 1e-4]),
        };
        let found = beam.frequencies([End::Pinned; 2], 4);
        for (n, found) in (1..).zip(found) {
            let number = f64::from(n) * PI;
            let waves = beam.of_wave(number);
            assert!((found / waves[0] - 1.0).abs() < 1e-9);
            let first = 1.0 - number * number * (1e-4 + 1.0 / 4000.0) / 2.0;
            let part = 1.0 - first;
            assert!((found / (number * number) - first).abs() < 2.0 * part * part);
            let cutoff = (4000.0_f64 / 1e-4).sqrt();
            assert!(waves[1] > cutoff && waves[1] < 1.2 * cutoff);
        }
    }
}
