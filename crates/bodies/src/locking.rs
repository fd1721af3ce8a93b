//! How much of the strain energy of linear quadrilaterals and hexahedra with full integration goes into strains by which they lock in
//! bending.
//!
//! Where such an element bends, u = q ξη, it shears beside it: γ = q ξ over half its height, of which a body that bends has nothing. An
//! element with incompatible modes α (1 - ξ²)/2 in each direction has not got it: its modes take the shear away, and the stress across that
//! Poisson's ratio makes too. What they would take is measured. With the centre's g^i = ∂ξ_i/∂x, the amplitudes q_ij of the motions
//! ξ_i ξ_j, and C the moduli of the law at rest, the gradient that varies with ξ_i is A_i = Σ_j≠i q_ij ⊗ g^j, and a mode adds α ⊗ g^i to it.
//! The energy ½ V/3 (A_i + α ⊗ g^i) : C : (A_i + α ⊗ g^i) is least with Q α = -t, of the traction t = (C : A_i) g^i and the acoustic tensor
//! Q = μ |g|² 1 + (λ + μ) g ⊗ g, and is less by
//!
//! ½ V/3 t · Q⁻¹ t = V/6 (|t|² - (λ + μ)/(λ + 2μ) (t · g)²/|g|²) / (μ |g|²).
//!
//! In pure bending of a layer of rectangles, L long and h high, in plane stress the whole energy is
//! 1/(1 - ν²) (1 + ½ (1 - ν) (L/h)²) of what is left: the factor by which such a layer is too stiff. Of n layers the excess is divided by n².
//! A strain that is constant in an element gives nothing.
//!
//! The map of the element is taken as that of its centre; patterns are freed of their linear part (Flanagan and Belytschko 1981). At
//! finite strain the gradients are pulled back by F of the centre, so that rotations give nothing (E = sym F₀ᵀH, Green's strain at the centre).
//! With mean dilatation the varying strains are deviatoric: λ = -2μ/3.
//!
//! Incompatible modes: Wilson, Taylor, Doherty and Ghaboussi (1973); Taylor, Beresford and Wilson (1976). Their condensed energy as a measure
//! is ours.

use carom_elements::{Kind, map};
use rayon::prelude::*;

use crate::Solid;
use crate::block::{Block, Physics};
use crate::chunk::Chunk;
use crate::continuum::{Law, Point};
use crate::finite::{Formulation, pattern, patterns};

/// Energies of the elements of a body that may lock in bending.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bending {
    /// Their strain energy by the moduli at rest, J.
    pub energy: f64,
    /// The part of it that incompatible modes would take away, J.
    pub locked: f64,
}

impl Bending {
    /// Both sums.
    pub fn with(self, other: Bending) -> Bending {
        Bending {
            energy: self.energy + other.energy,
            locked: self.locked + other.locked,
        }
    }
}

/// Groups of chunks whose sums are taken side by side: their number is fixed, so that sums are the same for any number of threads.
const GROUPS: usize = 64;

/// Vectors and tensors.
type Vector = [f64; 3];
type Tensor = [[f64; 3]; 3];

/// What elements of a block have in common.
struct Element<'a> {
    law: &'a Law,
    /// λ of the strains that vary in an element, Pa.
    varying: f64,
    /// Whether strains are finite.
    finite: bool,
    kind: Kind,
    centre: Point,
    patterns: &'static [&'static [usize]],
}

impl Solid {
    /// Energies of its linear quadrilaterals and hexahedra at the displacement `u` (m, system vector); none where it has none with full
    /// integration. Allocates nothing, and gives the same for any number of threads.
    pub fn bending(&self, u: &[f64]) -> Option<Bending> {
        let formulation = self.finite.as_ref().map(|finite| finite.formulation());
        if matches!(formulation, Some(Formulation::Reduced { .. })) {
            return None;
        }
        let mut all: Option<Bending> = None;
        for block in self.blocks() {
            let Physics::Continuum(law) = &block.physics else {
                continue;
            };
            if !matches!(block.kind, Kind::Quad4 | Kind::Hex8) {
                continue;
            }
            let varying = match formulation {
                Some(Formulation::BBar) => -2.0 / 3.0 * law.shear_modulus,
                _ => law.lame_1,
            };
            let element = Element {
                law,
                varying,
                finite: formulation.is_some(),
                kind: block.kind,
                centre: Point::new(block.kind, &[0.0; 3], 0.0),
                patterns: patterns(block.kind),
            };
            let found = block.bending(&element, u);
            all = Some(all.map_or(found, |all| all.with(found)));
        }
        all
    }
}

impl Block {
    fn bending(&self, of: &Element, u: &[f64]) -> Bending {
        let chunk = |chunk: &Chunk| match of.kind {
            Kind::Quad4 => chunk.bending::<4>(of, u),
            _ => chunk.bending::<8>(of, u),
        };
        let mut sums = [Bending::default(); GROUPS];
        let each = self.chunks.len().div_ceil(GROUPS).max(1);
        let group = |(sum, chunks): (&mut Bending, &[Chunk])| {
            let all = chunks.iter().map(chunk);
            *sum = all.fold(Bending::default(), Bending::with);
        };
        match self.chunks.len() {
            // waking a thread takes as long as the work
            1 => group((&mut sums[0], &self.chunks)),
            _ => sums
                .par_iter_mut()
                .zip(self.chunks.par_chunks(each))
                .for_each(group),
        }
        sums.into_iter().fold(Bending::default(), Bending::with)
    }
}

impl Chunk {
    fn bending<const N: usize>(&self, of: &Element, u: &[f64]) -> Bending {
        let elements = self.connectivity.chunks_exact(N).enumerate();
        elements.fold(Bending::default(), |sum, (place, nodes)| {
            let (x, u) = self.gather::<N>(nodes, of.law.dim, u);
            let own = of.bending(&x, &u);
            let weight = self.weight(place, 0);
            sum.with(Bending {
                energy: weight * own.energy,
                locked: weight * own.locked,
            })
        })
    }
}

impl Element<'_> {
    /// Energies of an element with nodes at `x` that move by `u`, m.
    fn bending<const N: usize>(&self, x: &[Vector; N], u: &[Vector; N]) -> Bending {
        let dim = self.law.dim;
        let (jacobian, det) = map::jacobian(x, &self.centre.dn[..N], dim);
        let mut base = [[0.0; 3]; 3];
        map::physical_gradient(&jacobian, det, &UNITS[..dim], &mut base[..dim]);
        let slope = self.slope(&base, u);
        let volume = self.volume(x, det);
        let hoop = match self.law.axisymmetric {
            true => {
                let mean =
                    |of: &[Vector; N]| (0..N).map(|a| self.centre.n[a] * of[a][0]).sum::<f64>();
                mean(u) / mean(x)
            }
            false => 0.0,
        };
        let strain = self.strain(&slope, hoop);
        let (lame, mu) = (self.law.lame_1, self.law.shear_modulus);
        let mut sum = Bending {
            energy: 0.5 * volume * product(&stress((lame, mu), &strain), &strain),
            locked: 0.0,
        };
        let amplitudes = self.amplitudes((x, u), &slope);
        for i in 0..dim {
            let mut gradient = [[0.0; 3]; 3];
            for j in (0..dim).filter(|&j| j != i) {
                let number = if dim == 2 { 0 } else { 3 - i - j };
                add(&mut gradient, &amplitudes[number], &base[j]);
            }
            let stress = stress((self.varying, mu), &gradient);
            sum.energy += volume / 6.0 * product(&stress, &gradient);
            sum.locked += volume / 6.0 * self.released(&stress, &base[i]);
        }
        // the pattern ξηζ: no bending, and orthogonal to the others
        for i in (0..dim).filter(|_| dim == 3) {
            let mut gradient = [[0.0; 3]; 3];
            add(&mut gradient, &amplitudes[3], &base[i]);
            sum.energy +=
                volume / 18.0 * product(&stress((self.varying, mu), &gradient), &gradient);
        }
        sum
    }

    /// t · Q⁻¹ t of the traction t of a stress across the direction g.
    fn released(&self, stress: &Tensor, g: &Vector) -> f64 {
        let (lame, mu) = (self.varying, self.law.shear_modulus);
        let t = stress.map(|row| dot(&row, g));
        let square = dot(g, g);
        let along = (lame + mu) / (lame + 2.0 * mu) * dot(&t, g).powi(2) / square;
        (dot(&t, &t) - along) / (mu * square)
    }

    /// ∂u/∂x at the centre.
    fn slope<const N: usize>(&self, base: &Tensor, u: &[Vector; N]) -> Tensor {
        let mut slope = [[0.0; 3]; 3];
        for k in 0..self.law.dim {
            let along = [0, 1, 2].map(|i| {
                // without the translation, whose strain would be nothing but round-off
                let terms = (0..N).map(|a| (u[a][i] - u[0][i]) * self.centre.dn[a][k]);
                terms.sum::<f64>()
            });
            add(&mut slope, &along, &base[k]);
        }
        slope
    }

    /// Strain at the centre.
    fn strain(&self, slope: &Tensor, hoop: f64) -> Tensor {
        let mut strain = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                strain[i][j] = 0.5 * (slope[i][j] + slope[j][i]);
                if self.finite {
                    let square = (0..3).map(|k| slope[k][i] * slope[k][j]).sum::<f64>();
                    strain[i][j] += 0.5 * square;
                }
            }
        }
        strain[2][2] += hoop + if self.finite { 0.5 * hoop * hoop } else { 0.0 };
        strain
    }

    /// Amplitudes of the patterns, m, pulled back by F of the centre at finite strain.
    fn amplitudes<const N: usize>(
        &self,
        (x, u): (&[Vector; N], &[Vector; N]),
        slope: &Tensor,
    ) -> [Vector; 4] {
        let mut amplitudes = [[0.0; 3]; 4];
        for (amplitude, axes) in amplitudes.iter_mut().zip(self.patterns) {
            let h = |a: usize| pattern(axes, &self.kind.table().reference[a]) / N as f64;
            let of = |field: &[Vector; N], i: usize| {
                (0..N)
                    .map(|a| h(a) * (field[a][i] - field[0][i]))
                    .sum::<f64>()
            };
            let skew = [0, 1, 2].map(|j| of(x, j));
            let own = [0, 1, 2].map(|i| of(u, i) - dot(&slope[i], &skew));
            *amplitude = match self.finite {
                true => {
                    [0, 1, 2].map(|i| own[i] + (0..3).map(|k| slope[k][i] * own[k]).sum::<f64>())
                }
                false => own,
            };
        }
        amplitudes
    }

    /// By the map of the centre, m³.
    fn volume<const N: usize>(&self, x: &[Vector; N], det: f64) -> f64 {
        let measure = f64::from(1 << self.law.dim) * det * self.law.thickness;
        match self.law.axisymmetric {
            true => {
                let radius: f64 = (0..N).map(|a| self.centre.n[a] * x[a][0]).sum();
                std::f64::consts::TAU * radius * measure
            }
            false => measure,
        }
    }
}

const UNITS: Tensor = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A : B.
fn product(a: &Tensor, b: &Tensor) -> f64 {
    dot(&a[0], &b[0]) + dot(&a[1], &b[1]) + dot(&a[2], &b[2])
}

/// Adds a ⊗ b.
fn add(sum: &mut Tensor, a: &Vector, b: &Vector) {
    for i in 0..3 {
        for j in 0..3 {
            sum[i][j] += a[i] * b[j];
        }
    }
}

/// λ tr H 1 + μ (H + Hᵀ), Pa.
fn stress((lame, mu): (f64, f64), h: &Tensor) -> Tensor {
    let pressure = lame * (h[0][0] + h[1][1] + h[2][2]);
    let mut stress = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            stress[i][j] = mu * (h[i][j] + h[j][i]);
        }
        stress[i][i] += pressure;
    }
    stress
}
