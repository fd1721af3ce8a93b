//! What a body assumes of the dimensions that its elements lack.

use carom_materials::Plane;

use crate::beam::{BeamSection, Rotations};
use crate::shell::ShellSection;

/// How the displacement of an element is restricted, and what its missing dimensions are.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "one of a body, which has thousands of elements"
)]
pub enum Kinematics {
    /// Axial strain only.
    Bar {
        /// Cross-section in m².
        area: f64,
    },
    /// A beam: extension, shear, bending and torsion, with rotations of the nodes.
    Beam(BeamSection),
    /// A plate or shell: membrane, bending and shear, with rotations of the nodes.
    Shell(ShellSection),
    /// No strain out of the plane.
    PlaneStrain {
        /// Thickness in m.
        thickness: f64,
    },
    /// No stress out of the plane.
    PlaneStress {
        /// Thickness in m.
        thickness: f64,
    },
    /// Symmetry of revolution about the second axis: x is the radius, forces and masses are those of the full turn.
    Axisymmetric,
    /// Three dimensions, no restriction.
    Solid,
}

impl Kinematics {
    /// How far its nodes turn, if they have rotations.
    pub fn rotations(self) -> Option<Rotations> {
        match self {
            Kinematics::Beam(section) => Some(section.rotations),
            Kinematics::Shell(section) => Some(section.rotations),
            _ => None,
        }
    }

    /// Dimension of the elements that this kinematics takes.
    pub fn dim(self) -> usize {
        match self {
            Kinematics::Bar { .. } | Kinematics::Beam(_) => 1,
            Kinematics::Shell(_)
            | Kinematics::PlaneStrain { .. }
            | Kinematics::PlaneStress { .. }
            | Kinematics::Axisymmetric => 2,
            Kinematics::Solid => 3,
        }
    }

    /// The state of stress beside the elements.
    pub fn plane(self) -> Plane {
        match self {
            Kinematics::Bar { .. } | Kinematics::Beam(_) => Plane::Uniaxial,
            Kinematics::Shell(_) | Kinematics::PlaneStress { .. } => Plane::Stress,
            Kinematics::PlaneStrain { .. } | Kinematics::Axisymmetric | Kinematics::Solid => {
                Plane::Full
            }
        }
    }

    /// Name as in the case file.
    pub fn name(self) -> &'static str {
        match self {
            Kinematics::Bar { .. } => "bar",
            Kinematics::Beam(_) => "beam",
            Kinematics::Shell(_) => "shell",
            Kinematics::PlaneStrain { .. } => "plane-strain",
            Kinematics::PlaneStress { .. } => "plane-stress",
            Kinematics::Axisymmetric => "axisymmetric",
            Kinematics::Solid => "solid",
        }
    }

    /// Area (m²) that a unit of surface measure at `x` stands for: the section of a bar or a beam (measure 1 at its end), the
    /// thickness of a plane body per length, 2πr, or 1.
    pub fn surface_factor(self, x: &[f64; 3]) -> f64 {
        match self {
            Kinematics::Bar { area } => area,
            Kinematics::Beam(section) => section.properties.area,
            Kinematics::PlaneStrain { thickness } | Kinematics::PlaneStress { thickness } => {
                thickness
            }
            Kinematics::Axisymmetric => std::f64::consts::TAU * x[0],
            // a facet of a shell is one of its cells
            Kinematics::Shell(_) | Kinematics::Solid => 1.0,
        }
    }
}

/// How the mass of an element is spread over its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassKind {
    /// Row sums ∫ ρ N_a dV on the diagonal.
    Lumped,
    /// ∫ ρ N_a N_b dV.
    Consistent,
}
