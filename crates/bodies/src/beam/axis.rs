//! The line of the centroids of an element, and how its sections move.

use carom_algebra::tensor::{Mat3, Vec3};
use carom_materials::Elastic;
use carom_mesh::{ElementId, Mesh};

use super::element::{Element, EndWeights};
use super::{BeamSection, axes, unit};

/// The centroids of the sections of an element, a straight line, with the motion of the sections by the unknowns of its two nodes.
#[derive(Clone, Debug)]
pub struct BeamAxis {
    /// Centroids of the sections at the two ends, m.
    pub ends: [[f64; 3]; 2],
    /// Axes x, y, z of the element, as rows.
    axes: Mat3,
    length: f64,
    dim: usize,
    section: BeamSection,
    material: Elastic,
}

impl BeamAxis {
    /// The axis of a cell of two nodes.
    ///
    /// # Errors
    /// What is wrong with the cell, as words that follow its name: no length, or an orientation that is missing or along it.
    pub fn new(
        mesh: &Mesh,
        cell: ElementId,
        section: BeamSection,
        material: Elastic,
    ) -> Result<BeamAxis, &'static str> {
        let nodes = mesh.element_nodes(cell);
        let [from, to] = [nodes[0], nodes[1]].map(|node| Vec3::from(mesh.nodes[node as usize]));
        let along = to - from;
        if along.norm() <= 1e-12 * from.norm().max(to.norm()) {
            return Err("has no length");
        }
        let axes = axes(&along.normalize(), &section, mesh.dim)?;
        let [y, z] = section.offset;
        let beside = axes.tr_mul(&Vec3::new(0.0, y, z));
        Ok(BeamAxis {
            ends: [from, to].map(|x| (x + beside).into()),
            axes,
            length: along.norm(),
            dim: mesh.dim,
            section,
            material,
        })
    }

    /// ∫ r ⊗ r dA about the centroid, in the axes of coordinates, m⁴; in the plane without the part out of it.
    pub fn second_moment(&self) -> [[f64; 3]; 3] {
        let [about_y, about_z] = self.section.properties.second_moments;
        let [y, z] = self.across();
        let along_z = if self.dim == 2 { 0.0 } else { about_y };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| about_z * y[i] * y[j] + along_z * z[i] * z[j]))
    }

    /// Unit directions of the principal axes y and z of its sections.
    pub fn across(&self) -> [[f64; 3]; 2] {
        [1, 2].map(|i| self.axes.row(i).transpose().into())
    }

    /// [`BeamAxis::motion`] of elements with finite rotations, linear in places and directors: `x = Σ N_a (x_a + R_a r) + L ξ (1 - ξ)/2 (R₁ - R₂) e`,
    /// e along the axis, here for small turns. Uniform tension and pure bending are in it; the axis of an element has no offset.
    pub fn motion_of_directors(&self, xi: f64) -> [[f64; 12]; 6] {
        let n = [1.0 - xi, xi];
        let along = self.axes.row(0).transpose() * (0.5 * self.length * n[0] * n[1]);
        let mut rows = [[0.0; 12]; 6];
        for (node, sign) in [(0, 1.0), (1, -1.0)] {
            for i in 0..3 {
                rows[i][6 * node + i] = n[node];
                rows[3 + i][6 * node + 3 + i] = n[node];
                let bent = unit(i).cross(&along) * sign;
                (0..3).for_each(|k| rows[k][6 * node + 3 + i] = bent[k]);
            }
        }
        rows
    }

    /// Translation of the centroid and rotation at ξ in [0, 1] along the element, in the axes of coordinates, by the displacement
    /// and the rotation of the first node, then of the second one: six rows of twelve. The shapes are those of the stiffness, so
    /// a rotation is N_θ: with Euler and Bernoulli's theory the slope of the axis.
    pub fn motion(&self, xi: f64) -> [[f64; 12]; 6] {
        let element = Element {
            length: self.length,
            section: &self.section,
            material: &self.material,
            weights: EndWeights::ONE,
        };
        let local = element.motion(xi);
        let [y, z] = self.section.offset;
        let beside = self.axes.tr_mul(&Vec3::new(0.0, y, z));
        let mut rows = [[0.0; 12]; 6];
        for (node, i) in [0, 1].into_iter().flat_map(|n| (0..3).map(move |i| (n, i))) {
            let turned = unit(i).cross(&beside);
            for (column, moved, turned) in [
                (6 * node + i, unit(i), Vec3::zeros()),
                (6 * node + 3 + i, turned, unit(i)),
            ] {
                let (moved, turned) = (self.axes * moved, self.axes * turned);
                let by = |row: &[f64; 12]| -> f64 {
                    (0..3)
                        .map(|k| row[6 * node + k] * moved[k] + row[6 * node + 3 + k] * turned[k])
                        .sum()
                };
                let own = local.map(|row| by(&row));
                for half in [0, 3] {
                    let global =
                        self.axes
                            .tr_mul(&Vec3::new(own[half], own[half + 1], own[half + 2]));
                    (0..3).for_each(|k| rows[half + k][column] = global[k]);
                }
            }
        }
        rows
    }
}
