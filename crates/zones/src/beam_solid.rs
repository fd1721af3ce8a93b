//! The overlap of a body of beams and a solid.

use carom_arlequin::{BeamCell, BeamModels, BeamOverlap, Model, Region, Rows, Weighting, Weights};
use carom_bodies::{BeamAxis, BeamSection, BodySpec, Kinematics};
use carom_mesh::{ElementId, Mesh};

use crate::error::Error;

/// A beam and a solid with an overlap: what changes in the two bodies, and the rows between them.
#[derive(Clone, Debug)]
pub struct GluedBeam {
    /// Cells that stay, of the inner and of the outer body.
    pub cells: [Vec<ElementId>; 2],
    /// Weights of these cells.
    pub weights: Weights,
    /// The rows of the coupling condition.
    pub rows: Rows,
    /// Cells of the beam that fall away.
    pub removed: Vec<ElementId>,
    /// Cells of both bodies that the overlap touches.
    pub touched: Vec<ElementId>,
    /// Area or volume of the overlap, m² or m³.
    pub measure: f64,
    /// Length of its shortest part, in cells of the coarser body.
    pub layers: f64,
    /// Mean size along the axis of the cells of the inner and of the outer body, m.
    pub sizes: [f64; 2],
}

/// Glues two bodies, of which one is a body of beams and the other one a solid or plane.
///
/// # Errors
/// Beams whose section has no axes; what [`BeamOverlap::new`] and [`BeamOverlap::weights`] refuse. Two solids, or two beams, are a solid
/// without beams.
pub fn glue_beam(
    mesh: &Mesh,
    [inner, outer]: [&BodySpec; 2],
    region: &Region,
    weighting: &Weighting,
) -> Result<GluedBeam, Error> {
    let (beam_is, section, beam, solid) = match (inner.kinematics, outer.kinematics) {
        (_, Kinematics::Beam(section)) => (Model::Outer, section, outer, inner),
        (Kinematics::Beam(section), _) => (Model::Inner, section, inner, outer),
        _ => {
            return Err(carom_arlequin::Error::NoCells {
                model: Model::Outer,
            }
            .into());
        }
    };
    let axes = axes(mesh, section, beam)?;
    let cells = beam.cells.iter().zip(&axes).map(|(&cell, axis)| BeamCell {
        cell,
        ends: axis.ends,
        area: section.properties.area,
        second_moment: axis.second_moment(),
    });
    let cells: Vec<BeamCell> = cells.collect();
    let motion = |element: usize, xi: f64| axes[element].motion(xi);
    let overlap = BeamOverlap::new(
        BeamModels {
            mesh,
            solid: &solid.cells,
            thickness: solid.kinematics.surface_factor(&[0.0; 3]),
            beam: &cells,
            motion: &motion,
            beam_is,
        },
        region,
    )?;
    Ok(GluedBeam {
        cells: [Model::Inner, Model::Outer].map(|model| overlap.cells(model).to_vec()),
        weights: overlap.weights(weighting)?,
        rows: overlap.rows()?,
        removed: overlap.removed().to_vec(),
        touched: overlap.touched(),
        measure: overlap.measure(),
        layers: overlap.layers(),
        sizes: [Model::Inner, Model::Outer].map(|model| overlap.size(model)),
    })
}

fn axes(mesh: &Mesh, section: BeamSection, beam: &BodySpec) -> Result<Vec<BeamAxis>, Error> {
    let axis = |&cell: &ElementId| {
        let refused = |why| carom_bodies::Error::BeamAxes {
            body: beam.name.clone(),
            cell,
            why,
        };
        BeamAxis::new(mesh, cell, section, beam.material.initial()).map_err(refused)
    };
    let axes: Result<Vec<BeamAxis>, _> = beam.cells.iter().map(axis).collect();
    Ok(axes?)
}
