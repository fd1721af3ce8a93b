//! Models of `features` with a link that turns: a bar of a solid and a beam, glued where they overlap, comes down askew on a rigid plane with the end of the solid, and turns over.

use carom_contact::{Law, Plane};
use carom_dynamics::{Model, ModelTarget, Scheme};
use carom_materials::Elastic;

use crate::Error;
use crate::beam_solid::Spliced;
use crate::beam_solid_large::{model, soft_bar};
use crate::blocks::SPEED;
use crate::build::{contact, surface};
use crate::glued_turning::Joined;

/// Of the bar; plane strain is plane stress.
pub(crate) const SOFT: Elastic = Elastic {
    density: 1000.0,
    young: 2e7,
    poisson: 0.0,
};
/// Length of a cell and lower side of the solid, m and m².
pub(crate) const CELL: f64 = 0.1;
pub(crate) const SIDE: f64 = 0.6 * 0.06;

/// The bar, which meets the plane in the second step; meshes `refinement` times as fine.
pub(crate) fn bar((scheme, law): (Scheme, Law), refinement: usize) -> Result<Model, Error> {
    let whole = soft_bar();
    let bar = Spliced {
        dim: 2,
        cells: [6 * refinement, refinement, 0],
        elements: 6 * refinement,
        quadratic: false,
        material: SOFT,
        ..whole
    };
    // a wave passes 0.28 of a cell, two thirds of the critical step of central differences: outer steps must resolve waves where links turn
    let dt = 2e-4 / refinement as f64;
    let mut model = model(&bar, (scheme, dt), Joined::Turning)?;
    let lowest = -0.5 * bar.section[0] - 1.2 * dt * SPEED;
    let slope = 0.1_f64;
    let plane = Plane {
        point: [0.0, lowest, 0.0],
        normal: [slope.sin(), slope.cos(), 0.0],
    };
    let side = surface(&model.mesh, "solid.bottom", &model.bodies[0])?;
    model.contacts = vec![contact(side, ModelTarget::rigid(plane), law)];
    for body in &mut model.bodies {
        body.velocity = [1.0, -SPEED, 0.0];
    }
    Ok(model)
}
