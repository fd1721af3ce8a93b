//! Rigid bodies: one node at the centre of mass with all its unknowns, axes along the principal axes of inertia.
//!
//! The unknowns of the rotations are, in `u`, the increment θ of the step about the axes that turn with the body, zero at its
//! start, and in `v` and `a` the angular velocity W and its rate about the same axes. So the mass is the constant diagonal
//! (m, m, m, J₁, J₂, J₃), and what is left of the balance of moments is a force of the velocity, W × J W.
//!
//! The mid-point rule `J (W₊ - W)/dt + W_m × J W_m = T`, `θ = dt W_m`, `R₊ = R cay(θ)` keeps the energy ½ W·J W and the
//! angular momentum R J W of a free body exactly: with `A = I - θ̂/2`, `A (cay(θ) y - x) = y - x + ½ θ × (x + y)`, so that
//! `R₊ J W₊ - R J W = dt R A⁻¹ T`, and W_m is orthogonal to W_m × J W_m.

use carom_algebra::csr::Csr;
use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::Unknowns;
use carom_mesh::{ElementId, Mesh};

use crate::gyroscopic;
use crate::solid::Solid;
use crate::spec::BodySpec;
use crate::{Error, Kinematics, Placement};

/// Mass, centre and inertia of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the reference position, m.
    pub centre: [f64; 3],
    /// Principal moments of inertia about the centre, kg m²; in the plane the third one counts.
    pub moments: [f64; 3],
    /// Principal axes in the reference position: the columns of its matrix.
    pub axes: Rotation,
}

/// Off-diagonal moments of inertia over the trace below which they are rounding.
const ROUNDING: f64 = 1e-12;

impl Inertia {
    /// That of the cells of a body with the density of its material: ∫ ρ dV, ∫ ρ x dV and ∫ ρ x ⊗ x dV by the rule of the
    /// mass matrix, exact for cells with straight sides. The axes are those nearest to the axes of coordinates.
    ///
    /// # Errors
    /// Cells that make no body.
    pub fn of_cells(mesh: &Mesh, spec: &BodySpec) -> Result<Inertia, Error> {
        let number: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
        let unknowns = Unknowns::translations(mesh.dim, number.len());
        let solid = Solid::new(mesh, spec.clone(), &number, &unknowns)?;
        let (mut mass, mut first) = (0.0, Vec3::zeros());
        solid.each_matrix(false, &mut |element| {
            let n = element.nodes.len();
            for (row, &a) in element.mass.chunks_exact(n).zip(element.nodes) {
                let m: f64 = row.iter().sum();
                mass += m;
                first += Vec3::from(mesh.nodes[a as usize]) * m;
            }
        });
        let mut centre = first / mass;
        if spec.kinematics == Kinematics::Axisymmetric {
            centre.x = 0.0;
        }
        let mut second = Mat3::zeros();
        solid.each_matrix(false, &mut |element| {
            let n = element.nodes.len();
            let from = |node: u32| Vec3::from(mesh.nodes[node as usize]) - centre;
            for (row, &a) in element.mass.chunks_exact(n).zip(element.nodes) {
                for (m, &b) in row.iter().zip(element.nodes) {
                    second += from(a) * from(b).transpose() * *m;
                }
            }
        });
        let (moments, axes) = principal(&(Mat3::identity() * second.trace() - second));
        Ok(Inertia {
            mass,
            centre: centre.into(),
            moments,
            axes: if mesh.dim < 3 {
                Rotation::IDENTITY
            } else {
                axes
            },
        })
    }
}

/// Principal moments of a tensor of inertia and its axes, those nearest to the axes of coordinates.
fn principal(inertia: &Mat3) -> ([f64; 3], Rotation) {
    let off = [inertia[(0, 1)], inertia[(1, 2)], inertia[(0, 2)]];
    if off.iter().all(|i| i.abs() <= ROUNDING * inertia.trace()) {
        return ([0, 1, 2].map(|i| inertia[(i, i)]), Rotation::IDENTITY);
    }
    let eigen = ((inertia + inertia.transpose()) * 0.5).symmetric_eigen();
    let mut left = vec![0, 1, 2];
    let (mut moments, mut axes) = ([0.0; 3], Mat3::identity());
    for axis in 0..3 {
        let along = |k: &usize| eigen.eigenvectors[(axis, *k)].abs();
        let place = (0..left.len()).fold(0, |best, k| match along(&left[k]) > along(&left[best]) {
            true => k,
            false => best,
        });
        let k = left.remove(place);
        let direction = eigen.eigenvectors.column(k);
        moments[axis] = eigen.eigenvalues[k];
        axes.set_column(axis, &(direction * direction[axis].signum()));
    }
    if axes.determinant() < 0.0 {
        let last = -axes.column(2);
        axes.set_column(2, &last);
    }
    (moments, Rotation::of_matrix(&axes))
}

/// A rigid body on a system.
#[derive(Debug)]
pub struct Rigid {
    name: String,
    cells: Vec<ElementId>,
    /// System number of its node.
    node: u32,
    /// First unknown of the node, and how many it has.
    first: usize,
    count: usize,
    dim: usize,
    inertia: Inertia,
}

impl Rigid {
    /// A body whose node has this system number. `cells`: those of the mesh that it carries, to be drawn.
    pub fn new(
        name: impl Into<String>,
        cells: Vec<ElementId>,
        inertia: Inertia,
        (node, unknowns): (u32, &Unknowns),
    ) -> Rigid {
        Rigid {
            name: name.into(),
            cells,
            node,
            first: unknowns.first(node),
            count: unknowns.of(node).len(),
            dim: unknowns.dim(),
            inertia,
        }
    }

    /// Name as in the case file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Cells of the mesh that it carries.
    pub fn cells(&self) -> &[ElementId] {
        &self.cells
    }

    /// System number of its node.
    pub fn node(&self) -> u32 {
        self.node
    }

    /// Mass, centre and moments of inertia.
    pub fn inertia(&self) -> &Inertia {
        &self.inertia
    }

    /// Adds mass and moments of inertia to the entries of a system vector.
    pub(crate) fn add_mass(&self, mass: &mut [f64]) {
        for m in &mut mass[self.first..self.first + self.dim] {
            *m += self.inertia.mass;
        }
        let [.., last] = self.inertia.moments;
        let moments = if self.dim == 2 {
            [last; 3]
        } else {
            self.inertia.moments
        };
        let rotations = &mut mass[self.first + self.dim..self.first + self.count];
        for (m, moment) in rotations.iter_mut().zip(moments) {
            *m += moment;
        }
    }

    /// Adds W × J W.
    pub(crate) fn add_force(&self, at: &Placement, f: &mut [f64]) {
        if self.dim == 3 {
            gyroscopic::add_moment(&self.inertia.moments, (at.v, self.first + 3), f);
        }
    }

    /// Adds `by_v` times the symmetric part of the derivative of [`Rigid::add_force`].
    pub(crate) fn add_tangent(&self, at: &Placement, by_v: f64, matrix: &mut Csr) {
        if self.dim == 3 {
            let of = (at.v, self.first + 3);
            gyroscopic::add_slope(&self.inertia.moments, of, by_v, matrix);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_of_a_turned_inertia_are_found_nearest_to_those_of_coordinates() {
        let turn = Rotation::cayley(&Vec3::new(0.2, -0.3, 0.1)).matrix();
        let given = turn * Mat3::from_diagonal(&Vec3::new(1.0, 2.0, 3.0)) * turn.transpose();
        let (moments, axes) = principal(&given);
        for (found, expected) in moments.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-14);
        }
        assert!((axes.matrix() - turn).norm() < 1e-13);
    }
}
