//! Two neo-Hookean bodies from a mesh file, one of which flies against the other.

use carom_bodies::Kinematics;
use carom_contact::{Integration, Law};
use carom_dynamics::{Model, ModelBody, ModelTarget, Nonlinear, Scheme};
use carom_materials::Elastic;
use carom_mesh::Mesh;

use crate::Error;
use crate::build::{contact, neo_hooke, surface};
use crate::meshes;

/// Residual at which iterations end, of the forces.
const TOLERANCE: f64 = 1e-11;

/// What there is to say about such a collision.
#[derive(Clone, Copy)]
pub(crate) struct Collision {
    /// Mesh file below `cases`.
    pub(crate) mesh: &'static str,
    /// Groups of the two bodies; their surfaces are the groups `.outer`.
    pub(crate) bodies: [&'static str; 2],
    /// Kinematics of both.
    pub(crate) kinematics: Kinematics,
    /// Neo-Hookean at small strain, of both.
    pub(crate) material: Elastic,
    /// Velocity of the first body, m/s; the second is at rest.
    pub(crate) velocity: [f64; 3],
    /// Integration of the contact: the second body's surface carries it.
    pub(crate) integration: Integration,
    /// Largest penetration that is a contact, m: about the thickness of the walls, so that shadows end at the near wall.
    pub(crate) depth: f64,
}

impl Collision {
    /// The model, with iterations to [`TOLERANCE`].
    ///
    /// # Errors
    /// No such mesh file.
    pub(crate) fn model(&self, scheme: Scheme, law: Law, dt: f64) -> Result<Model, Error> {
        let mesh = meshes::mesh(self.mesh)?;
        let mut moving = self.body(&mesh, 0)?;
        moving.velocity = self.velocity;
        let resting = self.body(&mesh, 1)?;
        let outer =
            |k: usize, body: &ModelBody| surface(&mesh, &format!("{}.outer", self.bodies[k]), body);
        let mut touch = contact(
            outer(1, &resting)?,
            ModelTarget::Surface(outer(0, &moving)?),
            law,
        );
        touch.integration = self.integration;
        touch.depth = Some(self.depth);
        let mut nonlinear = Nonlinear::default();
        nonlinear.iteration.tolerance = TOLERANCE;
        Ok(Model {
            contacts: vec![touch],
            nonlinear,
            ..Model::new(vec![moving, resting], mesh, scheme, dt)
        })
    }

    fn body(&self, mesh: &Mesh, k: usize) -> Result<ModelBody, Error> {
        neo_hooke(mesh, self.bodies[k], self.kinematics, self.material)
    }
}
