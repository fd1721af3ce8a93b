//! One element at finite strain: geometry in the reference configuration, computed where it is wanted.

use carom_elements::{MAX_NODES, map};

use super::Formulation;
use super::hourglass::Hourglass;
use crate::Kinematics;
use crate::block::Block;
use crate::chunk::Chunk;

/// Unknowns of the largest element.
pub(super) const MAX_UNKNOWNS: usize = 3 * MAX_NODES;
/// Points of the largest rule.
pub(super) const MAX_POINTS: usize = 27;

/// What the elements of a body have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    pub(crate) kinematics: Kinematics,
    pub(crate) formulation: Formulation,
    /// Shear modulus of the undeformed material in Pa.
    pub(crate) shear_modulus: f64,
}

impl Shape {
    /// Unknowns of a node.
    pub(super) fn dim(&self) -> usize {
        self.kinematics.dim()
    }

    /// Factor 2 κ μ (Pa) of the hourglass stiffness of a kind whose points are made one; none of others.
    pub(super) fn hourglass(&self, block: &Block) -> Option<f64> {
        let rule = block.stiffness_points.points.len();
        match self.formulation {
            Formulation::Reduced { hourglass } if rule > 1 => {
                Some(2.0 * hourglass * self.shear_modulus)
            }
            _ => None,
        }
    }

    /// Integration points of an element.
    pub(super) fn points(&self, block: &Block) -> usize {
        match self.hourglass(block) {
            Some(_) => 1,
            None => block.stiffness_points.points.len(),
        }
    }

    /// Area or length that the missing dimensions stand for at a place: thickness, 2πR or 1.
    fn section(&self, place: &[f64; 3]) -> f64 {
        match self.kinematics {
            Kinematics::Bar { .. } | Kinematics::Solid => 1.0,
            plane => plane.surface_factor(place),
        }
    }
}

/// An element with gradients and volumes of its integration points.
pub(super) struct Element {
    pub(super) dim: usize,
    pub(super) axisymmetric: bool,
    /// Nodes.
    pub(super) nodes: usize,
    /// Integration points.
    pub(super) points: usize,
    /// First unknowns of the nodes.
    first: [u32; MAX_NODES],
    /// dN_a/dX of each point and node, in 1/m; in axisymmetry the third entry is N_a/R.
    gradients: [[[f64; 3]; MAX_NODES]; MAX_POINTS],
    /// dV of each point, m³.
    volumes: [f64; MAX_POINTS],
    /// δ dV: what multiplies energies.
    weighted: [f64; MAX_POINTS],
    pub(super) dilatation: bool,
    pub(super) hourglass: Option<Hourglass>,
    /// Coefficients of the bulk viscosity.
    pub(super) viscosity: Option<[f64; 2]>,
}

impl Element {
    /// Room for any element.
    pub(super) fn room() -> Element {
        Element {
            dim: 0,
            axisymmetric: false,
            nodes: 0,
            points: 0,
            first: [0; MAX_NODES],
            gradients: [[[0.0; 3]; MAX_NODES]; MAX_POINTS],
            volumes: [0.0; MAX_POINTS],
            weighted: [0.0; MAX_POINTS],
            dilatation: false,
            hourglass: None,
            viscosity: None,
        }
    }

    /// Becomes an element of a chunk.
    pub(super) fn set(&mut self, shape: &Shape, block: &Block, chunk: &Chunk, place: usize) {
        let nodes = block.kind.table().nodes;
        let element = &chunk.connectivity[nodes * place..][..nodes];
        self.dim = shape.dim();
        self.axisymmetric = shape.kinematics == Kinematics::Axisymmetric;
        self.nodes = nodes;
        self.dilatation = shape.formulation == Formulation::BBar;
        self.viscosity = chunk.viscosity.get(place).copied();
        let mut x = [[0.0; 3]; MAX_NODES];
        for ((x, first), &node) in x.iter_mut().zip(&mut self.first).zip(element) {
            *x = chunk.x[node as usize];
            *first = chunk.first[node as usize];
        }
        let x = &x[..nodes];
        self.measure(shape, block, x, |point| chunk.weight(place, point));
        self.hourglass = shape.hourglass(block).map(|modulus| {
            self.make_one_point();
            let (gradient, volume) = (&self.gradients[0][..nodes], self.weighted[0]);
            Hourglass::new(block.kind, modulus, x, gradient, volume)
        });
    }

    /// Gradients and volumes at the points of the stiffness rule.
    fn measure(
        &mut self,
        shape: &Shape,
        block: &Block,
        x: &[[f64; 3]],
        weight: impl Fn(usize) -> f64,
    ) {
        let points = &block.stiffness_points.points;
        self.points = points.len();
        let nodes = x.len();
        for (place, point) in points.iter().enumerate() {
            let (n, dn) = (&point.n[..nodes], &point.dn[..nodes]);
            let (jacobian, det) = map::jacobian(x, dn, block.kind.table().dim);
            let at = map::point(x, n);
            let gradient = &mut self.gradients[place][..nodes];
            map::physical_gradient(&jacobian, det, dn, gradient);
            if self.axisymmetric {
                for (gradient, n) in gradient.iter_mut().zip(n) {
                    gradient[2] = n / at[0];
                }
            }
            self.volumes[place] = det * point.weight * shape.section(&at);
            self.weighted[place] = weight(place) * self.volumes[place];
        }
    }

    /// One point in place of all: mean gradients, whole volume, mean weight.
    ///
    /// With the mean of the gradients, and not those at the centre, distorted elements pass the patch test. Flanagan and
    /// Belytschko (1981).
    fn make_one_point(&mut self) {
        let volume: f64 = self.volumes[..self.points].iter().sum();
        let weighted: f64 = self.weighted[..self.points].iter().sum();
        let mut mean = [[0.0; 3]; MAX_NODES];
        for (gradient, own) in self.gradients[..self.points].iter().zip(&self.volumes) {
            for (sum, dn) in mean[..self.nodes].iter_mut().zip(gradient) {
                for j in 0..3 {
                    sum[j] += dn[j] * own / volume;
                }
            }
        }
        self.gradients[0] = mean;
        (self.volumes[0], self.weighted[0], self.points) = (volume, weighted, 1);
    }

    /// Unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.dim * self.nodes
    }

    /// First unknowns of the nodes.
    pub(super) fn first(&self) -> &[u32] {
        &self.first[..self.nodes]
    }

    pub(super) fn gradients(&self, point: usize) -> &[[f64; 3]] {
        &self.gradients[point][..self.nodes]
    }

    /// dV, m³.
    pub(super) fn volume(&self, point: usize) -> f64 {
        self.volumes[point]
    }

    /// δ dV, m³.
    pub(super) fn weighted(&self, point: usize) -> f64 {
        self.weighted[point]
    }

    /// Entries of a system vector at the nodes.
    pub(super) fn gather(&self, u: &[f64]) -> [f64; MAX_UNKNOWNS] {
        let mut u_e = [0.0; MAX_UNKNOWNS];
        for (u_a, &first) in u_e.chunks_exact_mut(self.dim).zip(self.first()) {
            u_a.copy_from_slice(&u[first as usize..][..self.dim]);
        }
        u_e
    }
}
