//! Contacts in the numbers of a system: bodies of each side, points, and which law may hold where.

use carom_contact::{Contact, Integration, Mortar, Point, Sight, Target};
use carom_mesh::{ElementId, Face, Mesh, Surface};

use crate::error::Error;
use crate::model::{Model, ModelContact, ModelTarget};
use crate::system::System;

const WHICH_LAWS: &str = "at Gauss points hold, in their weak form, the displacement law without projection and the velocity law, and, in each point by itself, the compliance, and penalty and stop without damping; the other laws hold at nodes";

impl System {
    /// Tangents of a contact point in problems with friction: none where no contact has any.
    pub fn tangents(&self) -> usize {
        match self.friction.iter().any(|mu| *mu > 0.0) {
            true => self.dim.saturating_sub(1),
            false => 0,
        }
    }

    /// Whether a contact of finite sliding is paired where the iterations of a dynamic step are: the geometry of bodies at small strain
    /// without friction is that in which the step captures it.
    pub fn pairs_anew(&self, contact: usize) -> bool {
        let (secondary, primary) = self.sides[contact];
        let sides = [Some(secondary), primary];
        let mut sides = sides.into_iter().flatten();
        let finite = sides.any(|body| !self.bodies[body].is_linear());
        let contact = (&self.contacts[contact], self.friction[contact]);
        let mortar = matches!(contact.0.integration, Integration::Mortar { .. });
        finite || mortar || contact.0.moves() || contact.1 > 0.0
    }

    /// Refuses laws that cannot hold where they are asked to.
    pub(crate) fn check_integration(&self) -> Result<(), Error> {
        let cause = |contact: &Contact| match contact.integration {
            Integration::Weak { r } if !(r > 0.0 && r.is_finite()) => {
                Some("r of the weak form must be positive and finite")
            }
            Integration::Weak { .. } if !contact.law.has_weak_form() => Some(WHICH_LAWS),
            Integration::Points if !contact.law.is_function() => Some(WHICH_LAWS),
            Integration::Weak { .. }
            | Integration::Points
            | Integration::Node
            | Integration::Mortar { .. } => None,
        };
        let mut contacts = self.contacts.iter();
        match contacts.find_map(|contact| Some((contact, cause(contact)?))) {
            None => Ok(()),
            Some((contact, cause)) => Err(Error::Integration {
                contact: contact.name.clone(),
                cause,
            }),
        }
    }
}

/// The body of a cell, in the order of the system.
fn owner(model: &Model, cell: ElementId) -> Option<usize> {
    let solids = model.bodies.iter().map(|body| &body.spec.cells);
    let discrete = model.discrete.iter().map(|body| &body.spec.cells);
    solids
        .chain(discrete)
        .position(|cells| cells.contains(&cell))
}

/// Bodies of a contact: the secondary's, and the primary's unless it is rigid.
pub fn sides(contact: &ModelContact, model: &Model) -> (usize, Option<usize>) {
    let body = |surface: &Surface| {
        surface
            .faces
            .first()
            .and_then(|face| owner(model, face.parent))
    };
    let primary = match &contact.primary {
        ModelTarget::Surface(surface) => body(surface),
        ModelTarget::Rigid(_) => None,
    };
    (body(&contact.secondary).unwrap_or(0), primary)
}

/// A contact with its points and its target by system number. `x`: reference coordinates by system number, m.
pub(crate) fn numbered(
    contact: &ModelContact,
    model: &Model,
    number: &[u32],
    x: &[[f64; 3]],
) -> Contact {
    let surface = &contact.secondary;
    let kinematics = surface
        .faces
        .first()
        .and_then(|face| owner(model, face.parent));
    // of a point mass a force stands for itself
    let solid = kinematics.and_then(|body| model.bodies.get(body));
    let kinematics = solid.map(|body| body.spec.kinematics);
    let factor = |x: &[f64; 3]| kinematics.map_or(1.0, |k| k.surface_factor(x));
    let faces = |surface: &Surface| -> Vec<Face> {
        let faces = surface.faces.iter();
        faces.map(|face| renumbered(face, number)).collect()
    };
    let (points, mortar) = match contact.integration {
        Integration::Node => (nodes(surface, &model.mesh, number, factor), None),
        Integration::Points | Integration::Weak { .. } => {
            (Point::of_faces(&faces(surface), x, factor), None)
        }
        Integration::Mortar { .. } => {
            let (mortar, points) = Mortar::new(faces(surface), x, factor);
            (points, Some(mortar))
        }
    };
    let target = match &contact.primary {
        ModelTarget::Rigid(obstacle) => Target::Rigid(obstacle.clone()),
        ModelTarget::Surface(surface) => Target::Surface(faces(surface)),
    };
    let sight = match &target {
        Target::Surface(primary) => {
            let secondary = faces(surface);
            let needed = contact.depth.is_some() || Sight::is_needed(&secondary, primary);
            needed.then(|| Sight::new((&points, &secondary), primary, x, contact.depth))
        }
        Target::Rigid(_) => None,
    };
    Contact {
        name: contact.name.clone(),
        law: contact.law,
        sliding: contact.sliding,
        integration: contact.integration,
        points,
        mortar,
        target,
        sight,
        offsets: Vec::new(),
    }
}

/// The nodes of a surface with the areas that they stand for.
fn nodes(
    surface: &Surface,
    mesh: &Mesh,
    number: &[u32],
    factor: impl Fn(&[f64; 3]) -> f64,
) -> Vec<Point> {
    let areas = surface.tributary_areas(mesh, factor);
    let area = |(&node, area): (&u32, f64)| (number[node as usize], area);
    let areas: Vec<(u32, f64)> = surface.nodes.iter().zip(areas).map(area).collect();
    let total: f64 = areas.iter().map(|(_, area)| area).sum();
    let points = areas.iter();
    points
        .map(|&(node, area)| Point::at_node(node, area, area / total))
        .collect()
}

/// A face with its nodes by system number.
pub(crate) fn renumbered(face: &Face, number: &[u32]) -> Face {
    let mut face = *face;
    for k in 0..face.corners().len() {
        face.nodes[k] = number[face.nodes[k] as usize];
    }
    face
}
