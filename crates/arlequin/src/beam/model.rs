//! A beam and a solid that overlap, as they are given.

use carom_mesh::{ElementId, Mesh};

use crate::error::{Error, Model};

/// Translation of the centroid and rotation of a section by the displacement and the rotation of the first node of an element, then
/// of the second, all in the axes of coordinates: six rows of twelve.
pub type SectionMotion = [[f64; 12]; 6];

/// Least thickness of a piece of the axis, in lengths of cells: below it is rounding.
pub(super) const NOTHING: f64 = 1e-9;
/// An element of a beam.
#[derive(Clone, Debug)]
pub struct BeamCell {
    /// The cell.
    pub cell: ElementId,
    /// Centroids of its sections at both ends, m.
    pub ends: [[f64; 3]; 2],
    /// Area of the section, m².
    pub area: f64,
    /// ∫ r ⊗ r dA about the centroid, m⁴.
    pub second_moment: [[f64; 3]; 3],
}

/// A body of beams and a solid of one material, with no node in common.
#[derive(Clone, Copy)]
pub struct BeamModels<'a> {
    /// The mesh of both, of two or three dimensions.
    pub mesh: &'a Mesh,
    /// Cells of the solid, of any kind that fills the space.
    pub solid: &'a [ElementId],
    /// Thickness of the solid in the plane, m; 1 in space.
    pub thickness: f64,
    /// Elements of the beam.
    pub beam: &'a [BeamCell],
    /// Motion of the section at ξ in [0, 1] of an element.
    pub motion: &'a dyn Fn(usize, f64) -> SectionMotion,
    /// Which of the two models the beam is.
    pub beam_is: Model,
}

/// What two ranges have in common.
pub(super) fn common(a: [f64; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let both = [a[0].max(b[0]), a[1].min(b[1])];
    (both[1] - both[0] > NOTHING * (a[1] - a[0]).min(b[1] - b[0])).then_some(both)
}

/// Polar radius of gyration of a section, m: in the plane of its height.
pub(super) fn radius(cell: &BeamCell) -> f64 {
    let trace: f64 = (0..3).map(|i| cell.second_moment[i][i]).sum();
    (trace / cell.area).sqrt()
}

impl BeamModels<'_> {
    /// Which of the two models the solid is.
    pub(super) fn solid_is(&self) -> Model {
        match self.beam_is {
            Model::Inner => Model::Outer,
            Model::Outer => Model::Inner,
        }
    }
}

/// Refuses models without cells, or with unfit ones, and nodes of both.
pub(super) fn check(models: &BeamModels) -> Result<(), Error> {
    let solid_is = models.solid_is();
    if models.beam.is_empty() {
        return Err(Error::NoCells {
            model: models.beam_is,
        });
    }
    if models.solid.is_empty() {
        return Err(Error::NoCells { model: solid_is });
    }
    let dim = models.mesh.dim;
    for &cell in models.solid {
        let found = models.mesh.kind(cell).table().dim;
        if found != dim {
            return Err(Error::Dimension {
                model: solid_is,
                cell,
                found,
                expected: dim,
            });
        }
    }
    if let Some(&defect) = models.mesh.check(models.solid).first() {
        return Err(Error::Defect(defect));
    }
    let mut used = vec![false; models.mesh.nodes.len()];
    for &cell in models.solid {
        let nodes = models.mesh.element_nodes(cell);
        nodes.iter().for_each(|&node| used[node as usize] = true);
    }
    let mut nodes = models.beam.iter();
    let shared = nodes.find_map(|beam| {
        let mut own = models.mesh.element_nodes(beam.cell).iter();
        own.find(|&&node| used[node as usize])
    });
    match shared {
        Some(&node) => Err(Error::SharedNode { node }),
        None => Ok(()),
    }
}
