//! Elements of one kind at finite strain: what the reference configuration gives once and for all.

use carom_elements::{Kind, MAX_NODES, map};

use super::Formulation;
use super::hourglass::Hourglass;
use crate::Kinematics;
use crate::nodes::Nodes;
use crate::weights::CellWeights;

/// Unknowns of the largest element.
pub(super) const MAX_UNKNOWNS: usize = 3 * MAX_NODES;

/// Elements of one kind with gradients and volumes of their integration points.
#[derive(Debug)]
pub(crate) struct Cells {
    pub(super) dim: usize,
    pub(super) axisymmetric: bool,
    /// Nodes of an element.
    pub(super) nodes: usize,
    /// Integration points of an element.
    pub(super) points: usize,
    /// System numbers of the nodes, element after element.
    pub(super) number: Vec<u32>,
    /// First unknowns of these nodes.
    pub(super) first: Vec<u32>,
    /// dN_a/dX of each element, point and node, in 1/m; in axisymmetry the third entry is N_a/R.
    gradients: Vec<[f64; 3]>,
    /// dV of each element and point, m³.
    volumes: Vec<f64>,
    /// δ dV: what multiplies energies.
    weighted: Vec<f64>,
    pub(super) dilatation: bool,
    pub(super) hourglass: Option<Hourglass>,
}

/// What the elements of a body have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    pub(crate) kinematics: Kinematics,
    pub(crate) formulation: Formulation,
    /// Shear modulus of the undeformed material in Pa.
    pub(crate) shear_modulus: f64,
}

/// Geometry of one integration point.
struct Point {
    gradient: [[f64; 3]; MAX_NODES],
    volume: f64,
    /// δ.
    weight: f64,
}

impl Cells {
    /// `weights`: those of these elements.
    pub(crate) fn new(
        kind: Kind,
        shape: &Shape,
        of: &Nodes,
        weights: Option<&CellWeights>,
    ) -> Cells {
        let table = kind.table();
        let reduced = matches!(shape.formulation, Formulation::Reduced { .. })
            && table.stiffness_rule.points.len() > 1;
        let mut cells = Cells {
            dim: shape.kinematics.dim(),
            axisymmetric: shape.kinematics == Kinematics::Axisymmetric,
            nodes: table.nodes,
            points: if reduced {
                1
            } else {
                table.stiffness_rule.points.len()
            },
            gradients: Vec::new(),
            volumes: Vec::new(),
            weighted: Vec::new(),
            dilatation: shape.formulation == Formulation::BBar,
            hourglass: match shape.formulation {
                Formulation::Reduced { hourglass } if reduced => {
                    Some(Hourglass::new(kind, 2.0 * hourglass * shape.shear_modulus))
                }
                _ => None,
            },
            number: of.elements.to_vec(),
            first: of
                .elements
                .iter()
                .map(|&node| of.unknowns.first(node) as u32)
                .collect(),
        };
        for place in 0..cells.len() {
            let x_e: Vec<[f64; 3]> = cells
                .element_nodes(place)
                .iter()
                .map(|&node| of.x[node as usize])
                .collect();
            let nodal = weights.map(|w| &w.stiffness[place * table.nodes..][..table.nodes]);
            let mut points = points(kind, shape.kinematics, &x_e, nodal);
            if let Some(hourglass) = &mut cells.hourglass {
                points = vec![mean(&points)];
                let gradient = &points[0].gradient[..table.nodes];
                hourglass.push(&x_e, gradient, points[0].weight * points[0].volume);
            }
            for point in points {
                cells.gradients.extend(&point.gradient[..table.nodes]);
                cells.volumes.push(point.volume);
                cells.weighted.push(point.weight * point.volume);
            }
        }
        cells
    }

    /// Number of elements.
    pub(crate) fn len(&self) -> usize {
        self.number.len() / self.nodes
    }

    /// Unknowns of an element.
    pub(super) fn unknowns(&self) -> usize {
        self.dim * self.nodes
    }

    pub(super) fn element_nodes(&self, element: usize) -> &[u32] {
        &self.number[element * self.nodes..][..self.nodes]
    }

    /// First unknowns of the nodes of an element.
    pub(super) fn element_first(&self, element: usize) -> &[u32] {
        &self.first[element * self.nodes..][..self.nodes]
    }

    pub(super) fn gradients(&self, element: usize, point: usize) -> &[[f64; 3]] {
        &self.gradients[(element * self.points + point) * self.nodes..][..self.nodes]
    }

    /// dV, m³.
    pub(super) fn volume(&self, element: usize, point: usize) -> f64 {
        self.volumes[element * self.points + point]
    }

    /// δ dV, m³.
    pub(super) fn weighted(&self, element: usize, point: usize) -> f64 {
        self.weighted[element * self.points + point]
    }

    /// Entries of a system vector at the nodes of an element.
    pub(super) fn gather(&self, element: usize, u: &[f64]) -> [f64; MAX_UNKNOWNS] {
        let mut u_e = [0.0; MAX_UNKNOWNS];
        let all = self.element_first(element);
        for (u_a, &first) in u_e.chunks_exact_mut(self.dim).zip(all) {
            u_a.copy_from_slice(&u[first as usize..][..self.dim]);
        }
        u_e
    }
}

/// Points of the stiffness rule. `weights`: δ at the nodes.
fn points(
    kind: Kind,
    kinematics: Kinematics,
    x: &[[f64; 3]],
    weights: Option<&[f64]>,
) -> Vec<Point> {
    let table = kind.table();
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    let (n, dn) = (&mut n[..table.nodes], &mut dn[..table.nodes]);
    let rule = table.stiffness_rule;
    let points = rule.points.iter().zip(rule.weights).map(|(xi, weight)| {
        (table.shape)(xi, n);
        (table.gradient)(xi, dn);
        let (jacobian, det) = map::jacobian(x, dn, table.dim);
        let place = map::point(x, n);
        let mut gradient = [[0.0; 3]; MAX_NODES];
        map::physical_gradient(&jacobian, det, dn, &mut gradient[..table.nodes]);
        if kinematics == Kinematics::Axisymmetric {
            for (gradient, n) in gradient.iter_mut().zip(n.iter()) {
                gradient[2] = n / place[0];
            }
        }
        let delta = |nodal: &[f64]| nodal.iter().zip(n.iter()).map(|(w, n)| w * n).sum();
        Point {
            gradient,
            volume: det * weight * section(kinematics, &place),
            weight: weights.map_or(1.0, delta),
        }
    });
    points.collect()
}

/// Area or length that the missing dimensions stand for at a place: thickness, 2πR or 1.
fn section(kinematics: Kinematics, place: &[f64; 3]) -> f64 {
    match kinematics {
        Kinematics::Bar { .. } | Kinematics::Solid => 1.0,
        plane => plane.surface_factor(place),
    }
}

/// One point in place of all: mean gradients, whole volume, mean weight.
///
/// With the mean of the gradients, and not those at the centre, distorted elements pass the patch test. Flanagan and
/// Belytschko (1981).
fn mean(points: &[Point]) -> Point {
    let volume: f64 = points.iter().map(|point| point.volume).sum();
    let weighted: f64 = points.iter().map(|p| p.weight * p.volume).sum();
    let mut gradient = [[0.0; 3]; MAX_NODES];
    for point in points {
        for (sum, dn) in gradient.iter_mut().zip(&point.gradient) {
            for j in 0..3 {
                sum[j] += dn[j] * point.volume / volume;
            }
        }
    }
    Point {
        gradient,
        volume,
        weight: weighted / volume,
    }
}
