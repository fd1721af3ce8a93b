//! The weak form of exact laws: a multiplier at the nodes of the secondary surface, one sign per Gauss point.

use carom_algebra::Error;
use carom_algebra::dense::DenseCholesky;

/// The multiplier of a contact law in its weak form, `p = Σ φ_a p_a` over the nodes of the secondary surface.
///
/// With q_i what the law constrains in Gauss point i, gap or gap rate, w_i its weight, and
/// `p̂_i = Σ_a φ_ia p_a - r q_i`, the force of the point and the equations of the multiplier are
///
/// ```text
/// P_i = w_i S_i p̂_i,   S_i = 1 where p̂_i > 0,      Σ_i (w_i / r) φ_ia (Σ_b φ_ib p_b - S_i p̂_i) = 0 for all a
/// ```
///
/// The second says `p = M⁻¹ Φᵀ P`, M = Φᵀ W Φ: the multiplier is the projection of the pressure in the points on H. Put
/// into the first,
///
/// ```text
/// 0 <= q + (G / r) P ⟂ P >= 0,      G = W⁻¹ - Φ M⁻¹ Φᵀ
/// ```
///
/// the same complementarity as at the nodes with a compliance more. G is symmetric and positive semi-definite; it
/// vanishes on the pressures of H: r is the stiffness against the rest. Where all points of a support are closed,
/// `Σ w φ_a q = 0` whatever r; where all are open, so is p; where signs differ p depends on r.
///
/// Valid for faces whose points are as many as their nodes (`Point::of_faces` of `carom-contact`): M is then positive definite. Source:
/// Ben Dhia, Zammali, Voldoire, Lamarche (2003), equations (4) and (7); the elimination of the multiplier is derived here.
#[derive(Clone, Debug)]
pub struct Weak {
    r: f64,
    /// For each point the place of its carriers in M, the value of their shape functions, and 1/w.
    points: Vec<(Vec<(u32, f64)>, f64)>,
    /// M⁻¹, row-major, of which the lower triangle is used.
    inverse: Vec<f64>,
    nodes: usize,
}

impl Weak {
    /// The multiplier of these points: of each the nodes that carry it with the values of their shape functions, and its
    /// weight w in m². `r`: in Pa/m for a law in the gap, in Pa s/m for one in the rate, positive.
    ///
    /// # Errors
    /// A matrix M that is not positive definite: faces without area.
    pub fn new<C: Iterator<Item = (u32, f64)>>(
        points: impl Iterator<Item = (C, f64)>,
        r: f64,
    ) -> Result<Weak, Error> {
        let mut locals: Vec<(Vec<(u32, f64)>, f64)> = points
            .map(|(carriers, weight)| (carriers.collect(), 1.0 / weight))
            .collect();
        let nodes = |(carriers, _): &(Vec<(u32, f64)>, f64)| carriers.clone();
        let mut numbers: Vec<u32> = locals
            .iter()
            .flat_map(nodes)
            .map(|(node, _)| node)
            .collect();
        numbers.sort_unstable();
        numbers.dedup();
        let n = numbers.len();
        for (node, _) in locals.iter_mut().flat_map(|(carriers, _)| carriers) {
            *node = numbers.partition_point(|number| *number < *node) as u32;
        }
        let mut mass = vec![0.0; n * n];
        for (carriers, inverse_weight) in &locals {
            for &(a, shape_a) in carriers {
                for &(b, shape_b) in carriers {
                    mass[a as usize * n + b as usize] += shape_a * shape_b / inverse_weight;
                }
            }
        }
        let factor = DenseCholesky::new(n, &mass)?;
        let mut inverse = vec![0.0; n * n];
        for (a, row) in inverse.chunks_exact_mut(n.max(1)).enumerate() {
            row[a] = 1.0;
            factor.solve(row);
        }
        Ok(Weak {
            r,
            points: locals,
            inverse,
            nodes: n,
        })
    }

    /// Entry of G / r between two points, in the quantity of the law per N.
    pub fn compliance(&self, i: usize, j: usize) -> f64 {
        let (one, inverse_weight) = &self.points[i];
        let (other, _) = &self.points[j];
        let mut projected = 0.0;
        for &(a, shape_a) in one {
            for &(b, shape_b) in other {
                let at = a.max(b) as usize * self.nodes + a.min(b) as usize;
                projected += shape_a * shape_b * self.inverse[at];
            }
        }
        let own = if i == j { *inverse_weight } else { 0.0 };
        (own - projected) / self.r
    }

    /// 1 / (w r) of a point: its compliance without any multiplier.
    pub fn own_compliance(&self, point: usize) -> f64 {
        self.points[point].1 / self.r
    }

    /// Writes the multiplier p = M⁻¹ Φᵀ P at the nodes, in Pa. `forces`: some points and their forces in N; the others
    /// have none.
    pub fn multiplier(&self, forces: impl Iterator<Item = (usize, f64)>, p: &mut Vec<f64>) {
        let n = self.nodes;
        p.clear();
        p.resize(2 * n, 0.0);
        let (p, nodal) = p.split_at_mut(n);
        for (point, force) in forces {
            for &(a, shape) in &self.points[point].0 {
                nodal[a as usize] += shape * force;
            }
        }
        for (a, p) in p.iter_mut().enumerate() {
            for (b, force) in nodal.iter().enumerate() {
                *p += self.inverse[a.max(b) * n + a.min(b)] * force;
            }
        }
    }

    /// Σ φ_a p_a / r in a point, for the p of [`Weak::multiplier`]: a point without force closes where its q is below.
    pub fn pull(&self, point: usize, p: &[f64]) -> f64 {
        let carriers = self.points[point].0.iter();
        let pressure: f64 = carriers.map(|&(a, shape)| shape * p[a as usize]).sum();
        pressure / self.r
    }

    /// How many nodes have points with and without a force around them: those where p depends on r. `forces`: of all
    /// points, in N; `marks`: scratch.
    pub fn mixed(&self, forces: &[f64], marks: &mut Vec<[bool; 2]>) -> usize {
        marks.clear();
        marks.resize(self.nodes, [false; 2]);
        for ((carriers, _), force) in self.points.iter().zip(forces) {
            for &(a, _) in carriers {
                marks[a as usize][usize::from(*force != 0.0)] = true;
            }
        }
        marks.iter().filter(|marks| **marks == [true; 2]).count()
    }
}

#[cfg(test)]
mod tests {
    use carom_contact::Point;
    use carom_elements::Kind;
    use carom_mesh::{ElementId, Face, Rim, face_nodes};

    use super::*;

    fn weak(points: &[Point], r: f64) -> Weak {
        Weak::new(points.iter().map(|point| (point.carriers(), point.area)), r).unwrap()
    }

    /// Two triangles and a quadrilateral beside them, none regular.
    fn surface() -> Vec<Point> {
        let x = [
            [0.0, 0.0, 0.0],
            [1.0, 0.1, 0.0],
            [1.1, 1.0, 0.0],
            [0.0, 0.9, 0.0],
            [2.5, 0.0, 0.0],
            [2.0, 1.2, 0.0],
        ];
        let face = |kind, nodes: &[u32]| Face {
            kind,
            nodes: face_nodes(nodes),
            parent: ElementId { block: 0, index: 0 },
            axis: [0.0; 3],
            radius: None,
            rim: Rim::default(),
        };
        let faces = [
            face(Kind::Tri3, &[0, 1, 2]),
            face(Kind::Tri3, &[0, 2, 3]),
            face(Kind::Quad4, &[1, 4, 5, 2]),
        ];
        Point::of_faces(&faces, &x, |_| 1.0)
    }

    #[test]
    fn a_pressure_of_the_multiplier_space_is_its_own_multiplier_and_feels_no_compliance() {
        let points = surface();
        let weak = weak(&points, 2.0);
        let nodal = [3.0, 1.0, -2.0, 0.5, 4.0, 1.5];
        let force = |point: &Point| -> f64 {
            let p: f64 = point.carriers().map(|(a, n)| n * nodal[a as usize]).sum();
            point.area * p
        };
        let forces: Vec<f64> = points.iter().map(force).collect();
        let mut p = Vec::new();
        weak.multiplier(forces.iter().copied().enumerate(), &mut p);
        for (p, expected) in p.iter().zip(nodal) {
            assert!((p - expected).abs() < 1e-12, "{p} {expected}");
        }
        for i in 0..points.len() {
            let row: f64 = (0..points.len())
                .map(|j| weak.compliance(i, j) * forces[j])
                .sum();
            assert!(row.abs() < 1e-12, "{row}");
            let pull = forces[i] / points[i].area / 2.0;
            assert!((weak.pull(i, &p) - pull).abs() < 1e-12);
        }
    }

    #[test]
    fn the_rest_of_a_pressure_has_its_square_over_r() {
        let points = surface();
        let weak = weak(&points, 2.0);
        // P · G P / r = Σ w (P/w - p)² / r by Pythagoras
        let forces: Vec<f64> = (0..points.len()).map(|i| (1 + i * i % 7) as f64).collect();
        let mut p = Vec::new();
        weak.multiplier(forces.iter().copied().enumerate(), &mut p);
        let (mut form, mut squares) = (0.0, 0.0);
        for (i, point) in points.iter().enumerate() {
            let row: f64 = (0..points.len())
                .map(|j| weak.compliance(i, j) * forces[j])
                .sum();
            form += forces[i] * row;
            let rest = forces[i] / point.area - 2.0 * weak.pull(i, &p);
            squares += point.area * rest * rest / 2.0;
        }
        assert!(squares > 1.0 && (form / squares - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nodes_between_closed_and_open_points_are_counted() {
        let points = surface();
        let weak = weak(&points, 1.0);
        let mut marks = Vec::new();
        let mut forces = vec![1.0; points.len()];
        assert_eq!(weak.mixed(&forces, &mut marks), 0);
        // the first triangle open: its three nodes also belong to other faces
        forces[..3].fill(0.0);
        assert_eq!(weak.mixed(&forces, &mut marks), 3);
        // and the second one: nodes 0 and 3 now see open points only
        forces[..6].fill(0.0);
        assert_eq!(weak.mixed(&forces, &mut marks), 2);
    }
}
