//! What a body is built of.

use carom_materials::Law;
use carom_mesh::ElementId;

use crate::finite::{BulkViscosity, Formulation};
use crate::layers::TightenedLayer;
use crate::release::Release;
use crate::scaling::MassScaling;
use crate::shell::{Ply, ShellSection};
use crate::weights::CellWeights;
use crate::{Kinematics, TightenedCell};

/// What a solid or a bar is made of.
#[derive(Clone, Debug)]
pub struct BodySpec {
    /// Name as in the case file.
    pub name: String,
    /// Cells of the mesh.
    pub cells: Vec<ElementId>,
    /// Kinematics and section.
    pub kinematics: Kinematics,
    /// Material.
    pub material: Law,
    /// How the elements integrate the internal work; anything but [`Formulation::Full`] needs a law at finite strain.
    pub formulation: Formulation,
    /// Weights of inertia and internal work; none for a body that is alone in its volume.
    pub weights: Option<CellWeights>,
    /// Whether the internal work at small strain has a rule that is exact for weights times products of strains in straight cells: needed for the bending patch of quadratic cells that overlap a beam.
    pub exact_products: bool,
    /// Bulk viscosity; needs a law at finite strain.
    pub viscosity: Option<BulkViscosity>,
    /// Mass scaling.
    pub scaling: Option<MassScaling>,
    /// Mean plastic strain over the points of an element at which it is deleted: its forces and energies are none from then on, its mass stays. Needs a law with plastic strain and an explicit scheme. None: no element is deleted.
    pub deletion: Option<f64>,
    /// Hinges of beams.
    pub releases: Vec<Release>,
    /// Layers of shells of several materials, from the side against which the normal points; `material` is then one of them that flows, if any does. None: one material.
    pub plies: Vec<Ply>,
    /// Thickness of shells at each node of the mesh, m, linear between them; a number at nodes of the body. None: that of the section.
    pub nodal_thickness: Option<Vec<f64>>,
    /// Cells of beams that a static stage tightens.
    pub tightened: Vec<TightenedCell>,
    /// Layers of solids at small strain that it tightens.
    pub layers: Vec<TightenedLayer>,
}

impl BodySpec {
    /// A body whose elements are integrated in full, alone in its volume.
    pub fn new(
        name: impl Into<String>,
        cells: Vec<ElementId>,
        kinematics: Kinematics,
        material: impl Into<Law>,
    ) -> BodySpec {
        BodySpec {
            name: name.into(),
            cells,
            kinematics,
            material: material.into(),
            formulation: Formulation::Full,
            weights: None,
            exact_products: false,
            viscosity: None,
            scaling: None,
            deletion: None,
            releases: Vec::new(),
            plies: Vec::new(),
            nodal_thickness: None,
            tightened: Vec::new(),
            layers: Vec::new(),
        }
    }

    /// Thickness of a shell at a node of the mesh, m. `section`: its own.
    pub fn thickness_at(&self, section: &ShellSection, node: u32) -> f64 {
        let nodal = self.nodal_thickness.as_ref();
        nodal.map_or(section.thickness, |all| all[node as usize])
    }

    /// Mean thickness of a shell over some nodes, m. `section`: its own.
    pub fn mean_thickness(&self, section: &ShellSection, nodes: &[u32]) -> f64 {
        let all = nodes.iter().map(|&node| self.thickness_at(section, node));
        all.sum::<f64>() / nodes.len() as f64
    }
}
