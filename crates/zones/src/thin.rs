//! The overlap of a body of beams or shells and a solid.

use carom_arlequin::{
    BeamCell, BeamModels, BeamOverlap, Model, Region, Rows, ShellCell, ShellModels, ShellOverlap,
    Weighting, Weights,
};
use carom_bodies::{BeamAxis, BeamSection, BodySpec, Kinematics, Rotations, ShellSection, plates};
use carom_mesh::{ElementId, Mesh};

use crate::error::Error;

/// A body of beams or shells and a solid with an overlap: what changes in the two bodies, and the rows between them.
#[derive(Clone, Debug)]
pub struct Glued {
    /// Cells that stay, of the inner and of the outer body.
    pub cells: [Vec<ElementId>; 2],
    /// Weights of these cells.
    pub weights: Weights,
    /// The rows of the coupling condition.
    pub rows: Rows,
    /// Cells of beams or shells that fall away.
    pub removed: Vec<ElementId>,
    /// Cells of both bodies that the overlap touches.
    pub touched: Vec<ElementId>,
    /// Area or volume of the overlap, m² or m³.
    pub measure: f64,
    /// Its least length or width, in cells of the coarser body.
    pub layers: f64,
    /// Mean size along the axis or the middle surface of the cells of the inner and of the outer body, m.
    pub sizes: [f64; 2],
}

/// Glues two bodies, of which one is a body of beams or shells and the other one a solid or plane.
///
/// # Errors
/// Beams whose section has no axes; cells that no shell can be built on; what [`BeamOverlap::new`], [`BeamOverlap::weights`] and [`ShellOverlap::new`]
/// refuse. Two solids are a solid without beams.
pub fn glue_thin(
    mesh: &Mesh,
    bodies: [&BodySpec; 2],
    region: &Region,
    weighting: &Weighting,
) -> Result<Glued, Error> {
    let glue = (mesh, region, weighting);
    let [inner, outer] = bodies;
    match (inner.kinematics, outer.kinematics) {
        (_, Kinematics::Beam(section)) => beam(glue, bodies, (Model::Outer, section)),
        (Kinematics::Beam(section), _) => beam(glue, bodies, (Model::Inner, section)),
        (_, Kinematics::Shell(section)) => shell(glue, bodies, (Model::Outer, section)),
        (Kinematics::Shell(section), _) => shell(glue, bodies, (Model::Inner, section)),
        _ => Err(carom_arlequin::Error::NoCells {
            model: Model::Outer,
        }
        .into()),
    }
}

/// The thin body and the solid.
fn sides([inner, outer]: [&BodySpec; 2], thin_is: Model) -> [&BodySpec; 2] {
    match thin_is {
        Model::Inner => [inner, outer],
        Model::Outer => [outer, inner],
    }
}

fn beam(
    (mesh, region, weighting): (&Mesh, &Region, &Weighting),
    bodies: [&BodySpec; 2],
    (beam_is, section): (Model, BeamSection),
) -> Result<Glued, Error> {
    let [beam, solid] = sides(bodies, beam_is);
    let axes = axes(mesh, section, beam)?;
    let cells = beam.cells.iter().zip(&axes).map(|(&cell, axis)| BeamCell {
        cell,
        ends: axis.ends,
        area: section.properties.area,
        second_moment: axis.second_moment(),
    });
    let cells: Vec<BeamCell> = cells.collect();
    let motion = |element: usize, xi: f64| match section.rotations {
        Rotations::Small => axes[element].motion(xi),
        Rotations::Finite => axes[element].motion_of_directors(xi),
    };
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
    Ok(Glued {
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

fn shell(
    (mesh, region, weighting): (&Mesh, &Region, &Weighting),
    bodies: [&BodySpec; 2],
    (shell_is, section): (Model, ShellSection),
) -> Result<Glued, Error> {
    let [shell, solid] = sides(bodies, shell_is);
    let plates = plates(mesh, shell, &section)?;
    let cells = shell.cells.iter().zip(plates);
    let cells = cells.map(|(&cell, plate)| ShellCell {
        cell,
        x: plate.x,
        directors: plate.directors,
        thickness: plate.thickness,
        offset: plate.offset,
    });
    let cells: Vec<ShellCell> = cells.collect();
    let models = ShellModels {
        mesh,
        solid: &solid.cells,
        shell: &cells,
        shell_is,
    };
    let overlap = ShellOverlap::new(&models, region, weighting)?;
    Ok(Glued {
        cells: overlap.cells,
        weights: overlap.weights,
        rows: overlap.rows,
        removed: overlap.removed,
        touched: overlap.touched,
        measure: overlap.measure,
        layers: overlap.layers,
        sizes: overlap.sizes,
    })
}
