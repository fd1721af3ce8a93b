//! The middle surface of shells, and the volume around it.

use carom_mesh::Mesh;

use super::ShellSection;
use super::build::{check, geometry};
use super::products::DIRECTOR;
use crate::Error;
use crate::spec::BodySpec;

/// An element of a shell: where its middle surface is. Directors turn with the nodes, with the shape functions of the element.
#[derive(Clone, Debug, PartialEq)]
pub struct ShellPlate {
    /// Places of the middle surface at the nodes, three or four, m.
    pub x: Vec<[f64; 3]>,
    /// Unit directors there.
    pub directors: Vec<[f64; 3]>,
    /// Thickness, m.
    pub thickness: f64,
    /// From the nodes to the middle surface along the directors, m.
    pub offset: f64,
}

/// The elements of a body of shells, in the order of its cells.
///
/// # Errors
/// Cells or a body that no shell can be built on.
pub fn plates(
    mesh: &Mesh,
    spec: &BodySpec,
    section: &ShellSection,
) -> Result<Vec<ShellPlate>, Error> {
    check(mesh, spec, section)?;
    let geometry = geometry(mesh, spec)?;
    let plates = geometry.iter().zip(&spec.cells).map(|(reference, &cell)| {
        let nodes = 0..mesh.element_nodes(cell).len();
        let middle = reference.beside(section.offset);
        ShellPlate {
            x: nodes.clone().map(|a| middle.x[a].into()).collect(),
            directors: nodes.map(|a| reference.axes[a][DIRECTOR].into()).collect(),
            thickness: spec.mean_thickness(section, mesh.element_nodes(cell)),
            offset: section.offset,
        }
    });
    Ok(plates.collect())
}
