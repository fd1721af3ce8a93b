//! Mass of shells.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::tensor::Mat3;

use super::Shell;
use super::element::{Element, PER_NODE};
use crate::stability::largest_eigenvalue;

/// Least square of the radius of gyration of lumped rotations over the area of an element: no rotation is then faster than the fastest
/// bending (Hughes, Cohen and Haroun 1978, Nucl. Eng. Des. 46, 203).
const GYRATION: f64 = 1.0 / 8.0;

impl Element {
    /// Area of each point times its weight of inertia, m².
    fn inert(&self) -> impl Iterator<Item = f64> + '_ {
        let points = self.form.inert.iter().zip(&self.weights.inertia);
        points.map(|(area, alpha)| area * alpha)
    }

    /// ∫ ρ h N_a dA of each node, kg.
    pub(super) fn shares(&self) -> [f64; 4] {
        let mut shares = [0.0; 4];
        let points = self.form.shapes.iter().zip(&self.density);
        for ((shapes, density), area) in points.zip(self.inert()) {
            for (share, n) in shares.iter_mut().zip(shapes) {
                *share += density * area * n;
            }
        }
        shares
    }

    /// ∫ ρ h N_a N_b dA, kg.
    fn shared(&self, a: usize, b: usize) -> f64 {
        let points = self.form.shapes.iter().zip(&self.density);
        let points = points.zip(self.inert());
        points
            .map(|((n, density), area)| density * area * n[a] * n[b])
            .sum()
    }

    /// From the nodes to the centre of the mass of a section along the directors, m.
    fn arm(&self) -> f64 {
        self.offset + self.inertia.centre
    }
}

impl Shell {
    /// Adds `mass` M: translations and small rotations with the shape functions; finite rotations at each node, with the moment of inertia of its mass about it.
    pub(super) fn add_mass(&self, mass: f64, part: &Range<usize>, matrix: &mut Csr) {
        for (number, element) in self.elements.iter().enumerate() {
            let n = PER_NODE * element.count;
            let mut own = vec![0.0; n * n];
            let mut add = |(row, column): (usize, usize), block: &Mat3| {
                for i in 0..3 {
                    for j in 0..3 {
                        own[(row + i) * n + column + j] += block[(i, j)];
                    }
                }
            };
            let shares = element.shares();
            let arm = element.arm();
            for a in 0..element.count {
                for b in 0..element.count {
                    let m = element.shared(a, b);
                    let (row, column) = (PER_NODE * a, PER_NODE * b);
                    add((row, column), &(Mat3::identity() * m));
                    let gyration = element.inertia.gyration;
                    let turning = match self.turns() {
                        true if a != b => 0.0,
                        true => shares[a] * (gyration + arm * arm),
                        false => m * gyration,
                    };
                    add((row + 3, column + 3), &(Mat3::identity() * turning));
                    if arm != 0.0 && !self.turns() {
                        // the middle moves by u + θ × e D
                        let [left, right] = [a, b].map(|node| element.reference.axes[node][2]);
                        let (left, right) = (left * arm, right * arm);
                        add((row, column + 3), &(right.cross_matrix() * -m));
                        add((row + 3, column), &(left.cross_matrix() * m));
                        let both = Mat3::identity() * left.dot(&right) - right * left.transpose();
                        add((row + 3, column + 3), &(both * m));
                    }
                }
            }
            self.add(number, mass, &own, part, matrix);
        }
    }

    /// Lumped mass of a translation and of a rotation of each node of an element: all mass is in the nodes, with its moment of inertia about them.
    fn lumped(&self, element: &Element) -> [[f64; 2]; 4] {
        let own = element.inertia.gyration + element.arm().powi(2);
        let gyration = own.max(GYRATION * element.area());
        element.shares().map(|m| [m, m * gyration])
    }

    /// Adds the diagonal of the lumped mass.
    pub(crate) fn add_lumped_mass(&self, mass: &mut [f64]) {
        for element in &self.elements {
            let lumped = self.lumped(element);
            for ([moves, turns], &first) in lumped.iter().zip(&element.first[..element.count]) {
                mass[first..first + 3].iter_mut().for_each(|m| *m += moves);
                mass[first + 3..first + 6]
                    .iter_mut()
                    .for_each(|m| *m += turns);
            }
        }
    }

    /// Upper bound of the angular frequencies (rad/s) with lumped mass: the largest of an element in the reference configuration.
    pub(crate) fn frequency_bound(&self) -> f64 {
        let of = |element: &Element| {
            let mut k = element.stiffness();
            let n = PER_NODE * element.count;
            let lumped = self.lumped(element);
            let root = |i: usize| lumped[i / PER_NODE][i % PER_NODE / 3].sqrt();
            for (entry, k) in k.iter_mut().enumerate() {
                *k /= root(entry / n) * root(entry % n);
            }
            largest_eigenvalue(&mut k)
        };
        self.elements.iter().map(of).fold(0.0, f64::max).sqrt()
    }
}
