//! How far a body at small strain is from it: rotation and strain of its elements.
//!
//! With `H = ∂u/∂x` small strain drops ½ HᵀH beside `ε = sym H`. Both of its causes are measured:
//!
//! - the strain, as the principal value of ε that is largest in size;
//! - the rotation of F = I + H. In the plane that of the polar decomposition, tan θ = (H_21 - H_12)/(2 + tr H), exactly; in
//!   space tan θ = |w|/(1 + ½ tr H) with the axial vector w of the antisymmetric part, exact for a rotation, and else wrong by the
//!   product of rotation and strain. The antisymmetric part alone would not do: w is an angle only while it is small, and
//!   grows without bound in a body whose linear motion is a rotation at constant rate; the iterations of a polar
//!   decomposition in space cost more than they tell below the 10° that matter.
//!
//! One integration point an element, which the caller changes from look to look: the middle would not see an element that bends.
//! A sweep then costs less than one of the internal forces.

use carom_algebra::tensor::Mat3;

use rayon::prelude::*;

use crate::Solid;
use crate::bar::Bar;
use crate::block::{Block, Physics, by_nodes, call_by_nodes};
use crate::chunk::Chunk;
use crate::continuum::{Law, Point};

/// The largest value of something over the elements of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// Where: place in [`Solid::cells`].
    pub cell: u32,
}

impl Extreme {
    /// The larger; of equals the first.
    pub(crate) fn or(self, other: Extreme) -> Extreme {
        let first = other.value == self.value && other.cell < self.cell;
        match other.value > self.value || first {
            true => other,
            false => self,
        }
    }
}

/// Distance from small strain.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distortion {
    /// Angle by which an element has turned, rad, 0 to π.
    pub rotation: Extreme,
    /// Size of its largest principal strain.
    pub strain: Extreme,
}

impl Distortion {
    fn or(self, other: Distortion) -> Distortion {
        Distortion {
            rotation: self.rotation.or(other.rotation),
            strain: self.strain.or(other.strain),
        }
    }
}

/// The largest values while elements pass by.
#[derive(Clone, Copy)]
struct Search {
    found: Distortion,
    /// Tangent of the rotation found, infinite from a right angle on: most elements then need no angle.
    tangent: f64,
    /// Square of the strain found: most elements then need no principal values.
    square: f64,
}

impl Search {
    fn new(found: Distortion) -> Search {
        let mut search = Search {
            found,
            tangent: 0.0,
            square: 0.0,
        };
        search.renew();
        search
    }

    fn renew(&mut self) {
        let angle = self.found.rotation.value;
        self.tangent = match angle < std::f64::consts::FRAC_PI_2 {
            true => angle.tan(),
            false => f64::INFINITY,
        };
        self.square = self.found.strain.value.powi(2);
    }

    /// Takes a rotation of tan θ = sine/cosine if it is larger.
    #[inline]
    fn turn(&mut self, cell: u32, sine: f64, cosine: f64) {
        if sine > self.tangent * cosine {
            let value = sine.atan2(cosine);
            self.found.rotation = self.found.rotation.or(Extreme { value, cell });
            self.renew();
        }
    }

    fn stretch(&mut self, cell: u32, value: f64) {
        self.found.strain = self.found.strain.or(Extreme { value, cell });
        self.renew();
    }

    /// Takes H of an element. `hoop`: strain about an axis.
    #[inline]
    fn take(&mut self, dim: usize, cell: u32, h: &Mat3, hoop: f64) {
        let half = |i: usize, j: usize| 0.5 * (h[(i, j)] - h[(j, i)]);
        let (a, b, c) = (half(2, 1), half(0, 2), half(1, 0));
        let sine = (a * a + b * b + c * c).sqrt();
        self.turn(cell, sine, 1.0 + 0.5 * h.trace());
        let sum = |i: usize, j: usize| 0.5 * (h[(i, j)] + h[(j, i)]);
        let shear = [sum(0, 1), sum(1, 2), sum(0, 2)];
        let squares = h[(0, 0)].powi(2) + h[(1, 1)].powi(2) + h[(2, 2)].powi(2);
        let shears = shear[0].powi(2) + shear[1].powi(2) + shear[2].powi(2);
        // no principal value is above the norm
        if squares + 2.0 * shears + hoop * hoop > self.square {
            let largest = match dim {
                3 => Mat3::from_fn(sum).symmetric_eigenvalues().amax(),
                _ => {
                    let mean = 0.5 * (h[(0, 0)] + h[(1, 1)]);
                    let apart = 0.5 * (h[(0, 0)] - h[(1, 1)]);
                    mean.abs() + apart.hypot(shear[0])
                }
            };
            self.stretch(cell, largest.max(hoop.abs()));
        }
    }
}

impl Solid {
    /// The largest rotation and strain of the elements in the displacement `u` (m, system vector), or those of `before` where
    /// they are larger; none at finite strain. `point`: which integration point of each element is looked at, in rounds.
    /// Allocates nothing, and gives the same for any number of threads.
    pub fn distortion(&self, u: &[f64], point: usize, before: &Distortion) -> Option<Distortion> {
        if self.has_finite_strain() {
            return None;
        }
        let (mut largest, mut first) = (*before, 0);
        for block in self.blocks() {
            largest = largest.or(block.distortion((self.dim(), u), point, (first, before)));
            first += block.len() as u32;
        }
        Some(largest)
    }
}

impl Block {
    /// `first`: place of the first element in the body.
    fn distortion(
        &self,
        u: (usize, &[f64]),
        point: usize,
        (first, before): (u32, &Distortion),
    ) -> Distortion {
        let mut largest = *before;
        by_nodes!(self.kind => self.distort(u, point, (first, &mut largest)));
        largest
    }

    fn distort<const N: usize>(
        &self,
        u: (usize, &[f64]),
        point: usize,
        (first, out): (u32, &mut Distortion),
    ) {
        let points = &self.stiffness_points.points;
        let point = &points[point % points.len()];
        let (before, each) = (*out, self.chunk_length() as u32);
        let of = |(k, chunk): (usize, &Chunk)| {
            let mut search = Search::new(before);
            let place = first + each * k as u32;
            chunk.distort::<N>((&self.physics, point), u, (place, &mut search));
            search.found
        };
        let chunks = &self.chunks;
        *out = match chunks.len() {
            1 => of((0, &chunks[0])),
            _ => chunks
                .par_iter()
                .enumerate()
                .map(of)
                .reduce(|| before, Distortion::or),
        };
    }
}

impl Chunk {
    fn distort<const N: usize>(
        &self,
        (physics, point): (&Physics, &Point),
        (dim, u): (usize, &[f64]),
        (first, out): (u32, &mut Search),
    ) {
        for (element, cell) in self.connectivity.chunks_exact(N).zip(first..) {
            let (x, u) = self.gather::<N>(element, dim, u);
            match physics {
                Physics::Bar(_) => of_bar(dim, cell, (&x, &u), out),
                Physics::Continuum(law) => of_cell(law, point, cell, (&x, &u), out),
            }
        }
    }
}

/// The slope of a bar against its axis, and its strain.
fn of_bar(dim: usize, cell: u32, (x, u): (&[[f64; 3]], &[[f64; 3]]), out: &mut Search) {
    let (axis, length) = Bar::axis(x);
    let d = [0, 1, 2].map(|i| (u[1][i] - u[0][i]) / length);
    let along: f64 = (0..3).map(|i| axis[i] * d[i]).sum();
    out.stretch(cell, along.abs());
    if dim > 1 {
        let across = [0, 1, 2].map(|i| d[i] - along * axis[i]);
        let across = across.iter().map(|d| d * d).sum::<f64>().sqrt();
        out.turn(cell, across, 1.0 + along);
    }
}

/// H = (Σ u_a ⊗ dN_a/dξ) J⁻¹.
#[inline]
fn of_cell<const N: usize>(
    law: &Law,
    point: &Point,
    cell: u32,
    (x, u): (&[[f64; 3]; N], &[[f64; 3]; N]),
    out: &mut Search,
) {
    let (mut jacobian, mut slope) = (Mat3::zeros(), Mat3::zeros());
    for a in 0..N {
        for k in 0..3 {
            let dn = point.dn[a][k];
            for i in 0..3 {
                jacobian[(i, k)] += x[a][i] * dn;
                // without the translation, whose strain would be nothing but round-off
                slope[(i, k)] += (u[a][i] - u[0][i]) * dn;
            }
        }
    }
    for k in law.dim..3 {
        jacobian[(k, k)] = 1.0;
    }
    let Some(inverse) = jacobian.try_inverse() else {
        return;
    };
    let hoop = match law.axisymmetric {
        true => {
            let mean = |x: &[[f64; 3]; N]| (0..N).map(|a| point.n[a] * x[a][0]).sum::<f64>();
            mean(u) / mean(x)
        }
        false => 0.0,
    };
    out.take(law.dim, cell, &(slope * inverse), hoop);
}
