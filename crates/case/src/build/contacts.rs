//! Contacts: surfaces on the bodies, laws with their defaults from the material, no penetration at the start.

use carom_bodies::height;
use carom_contact::law::{Adhesion, Capture, Damped, Displacement, Reading, Velocity};
use carom_contact::{Law, Plane, Sliding};
use carom_dynamics::{ModelBody, ModelContact, ModelTarget, System};
use carom_mesh::{ElementId, Mesh, Surface};

use super::Builder;
use crate::error::Problem;
use crate::schema::{self, Contact, DampedLaw, Obstacle, Scheme};

impl Builder<'_> {
    pub(super) fn contacts(&mut self, mesh: &Mesh, bodies: &[ModelBody]) -> Vec<ModelContact> {
        let mut contacts = Vec::new();
        let cells: Vec<ElementId> = bodies
            .iter()
            .flat_map(|body| body.spec.cells.iter().copied())
            .collect();
        for (name, contact) in self.case.contact.iter() {
            let path = format!("contact.{name}");
            let secondary = self.surface(
                mesh,
                &cells,
                &format!("{path}.secondary"),
                &contact.secondary,
            );
            let primary = match (&contact.primary, &contact.obstacle) {
                (Some(primary), _) => self
                    .surface(mesh, &cells, &format!("{path}.primary"), primary)
                    .map(ModelTarget::Surface),
                (None, Some(Obstacle::Plane(plane))) => {
                    self.plane(mesh, &path, plane).map(ModelTarget::Plane)
                }
                (None, None) => None,
            };
            let (Some(secondary), Some(primary)) = (secondary, primary) else {
                continue;
            };
            let law = self.law(mesh, bodies, contact, &secondary, &primary);
            let sliding = match contact.sliding {
                schema::Sliding::Small => Sliding::Small,
                schema::Sliding::Finite => Sliding::Finite,
            };
            contacts.push(ModelContact {
                name: name.to_string(),
                secondary,
                primary,
                law,
                sliding,
            });
        }
        contacts
    }

    fn surface(
        &mut self,
        mesh: &Mesh,
        cells: &[ElementId],
        path: &str,
        name: &str,
    ) -> Option<Surface> {
        let group = self.group(mesh, path, name)?;
        match Surface::new(mesh, group, cells) {
            Ok(surface) => Some(surface),
            Err(error) => {
                let problem = Problem::new(path, error.to_string()).found(name);
                self.problems
                    .push(problem.accepted(["a group of outer sides of bodies"]));
                None
            }
        }
    }

    fn plane(&mut self, mesh: &Mesh, path: &str, plane: &schema::Plane) -> Option<Plane> {
        let point = self.vector(mesh, &format!("{path}.obstacle.plane.point"), &plane.point);
        let normal = plane.normal.components();
        if normal[mesh.dim..].iter().any(|n| *n != 0.0) {
            let message = format!(
                "a normal beyond the {} of the mesh",
                super::dimensions(mesh.dim)
            );
            let problem = Problem::new(format!("{path}.obstacle.plane.normal"), message);
            self.problems.push(
                problem
                    .found(format!("{normal:?}"))
                    .accepted(["a normal in the space of the mesh"]),
            );
            return None;
        }
        let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        Some(Plane {
            point,
            normal: normal.map(|n| n / length),
        })
    }

    fn law(
        &self,
        mesh: &Mesh,
        bodies: &[ModelBody],
        contact: &Contact,
        secondary: &Surface,
        primary: &ModelTarget,
    ) -> Law {
        match &contact.law {
            schema::Law::Displacement(_) => Law::Displacement(Displacement),
            schema::Law::Velocity(velocity) => Law::Velocity(Velocity {
                capture: match velocity.capture {
                    Some(schema::Capture::Now) => Capture::Now,
                    Some(schema::Capture::Half) => Capture::Half,
                    Some(schema::Capture::Full) => Capture::Full,
                    None => default_capture(&self.case.time.scheme),
                },
                reading: match velocity.sign {
                    schema::Sign::Closed => Reading::Closed,
                    schema::Sign::AsPrinted => Reading::AsPrinted,
                },
            }),
            schema::Law::Damped(damped) => {
                let mut sides = vec![side(mesh, bodies, secondary)];
                if let ModelTarget::Surface(primary) = primary {
                    sides.push(side(mesh, bodies, primary));
                }
                Law::Damped(damped_law(damped, &sides))
            }
        }
    }

    /// Refuses contacts that penetrate at the start, in the initial displacement.
    pub(super) fn penetration(&mut self, system: &System) {
        let mut rows = carom_contact::Rows::default();
        for contact in &system.contacts {
            rows.clear();
            let places = carom_contact::Places {
                dim: system.dim,
                x: &system.x,
                u: &system.initial_displacement,
            };
            contact.pair(&places, &mut carom_contact::Search::default(), &mut rows);
            let slack = system.tolerance.max(1e-9 * system.mesh.size());
            let deep: Vec<usize> = (0..rows.len())
                .filter(|&point| rows.gap(point) < -slack)
                .collect();
            let Some(&deepest) = deep
                .iter()
                .min_by(|&&a, &&b| rows.gap(a).total_cmp(&rows.gap(b)))
            else {
                continue;
            };
            let node = contact.points[deepest].node;
            let x = places.of(node);
            let path = format!("contact.{}", contact.name);
            let verb = if deep.len() == 1 {
                "penetrates"
            } else {
                "penetrate"
            };
            let message = format!("{} {verb} at the start", super::plural(deep.len(), "point"));
            let problem = Problem::new(path, message)
                .found(format!(
                    "a gap of {:.4e} m at node {}, ({:.6}, {:.6}, {:.6}) m",
                    rows.gap(deepest),
                    system.mesh_node[node as usize],
                    x[0],
                    x[1],
                    x[2]
                ))
                .accepted([format!("gaps of at least -{slack:.1e} m")]);
            self.problems.push(problem);
        }
    }

    /// What is strange about contacts and schemes, without being wrong.
    pub(super) fn advise(&mut self, system: &System) {
        for contact in &system.contacts {
            let name = &contact.name;
            if let Law::Velocity(Velocity {
                reading: Reading::AsPrinted,
                ..
            }) = contact.law
            {
                self.warnings.push(format!(
                    "contact `{name}`: with sign = \"as-printed\" bodies pass through each other"
                ));
            }
            if let (Law::Displacement(_), Scheme::Newmark(newmark)) =
                (contact.law, &self.case.time.scheme)
                && newmark.beta == 0.25
            {
                self.warnings.push(format!("contact `{name}`: the trapezoid with the displacement law gains energy below a Courant number of about 4; look at the ledger"));
            }
        }
    }
}

/// Half for theta = 1/2, now otherwise: what each scheme needs to close without a false start.
fn default_capture(scheme: &Scheme) -> Capture {
    match scheme {
        Scheme::Theta(theta) if theta.theta == 0.5 => Capture::Half,
        Scheme::Theta(_) | Scheme::Newmark(_) | Scheme::CentralDifference(_) => Capture::Now,
    }
}

/// One side of a contact: Young's modulus (Pa), impedance per area rho c (Pa s/m), element size normal to it (m).
struct Side {
    young: f64,
    impedance: f64,
    size: f64,
}

/// The side with the thickest cells and the material of the first.
fn side(mesh: &Mesh, bodies: &[ModelBody], surface: &Surface) -> Side {
    let mut side = Side {
        young: 0.0,
        impedance: 0.0,
        size: 0.0,
    };
    for face in &surface.faces {
        side.size = side
            .size
            .max(height(mesh, face.parent, face.kind, face.corners()));
    }
    let owner = surface.faces.first().and_then(|face| {
        bodies
            .iter()
            .find(|body| body.spec.cells.binary_search(&face.parent).is_ok())
    });
    if let Some(body) = owner {
        let material = &body.spec.material;
        side.young = material.young;
        side.impedance = material.density * material.wave_speed(body.spec.kinematics.plane());
    }
    side
}

/// k_p = E/h_e and C_n = c_f sqrt(k_p h_e / E) rho c of the softer side, unless the case gives them.
fn damped_law(law: &DampedLaw, sides: &[Side]) -> Damped {
    let softness = |side: &Side| side.size / side.young;
    let soft = sides
        .iter()
        .max_by(|a, b| softness(a).total_cmp(&softness(b)));
    let stiffness = law
        .stiffness
        .map(|k| k.0)
        .or(soft.map(|side| side.young / side.size))
        .unwrap_or(0.0);
    let damping = law.damping.map(|c| c.0).or(soft.map(|side| {
        law.damping_factor.unwrap_or(0.5)
            * (stiffness * side.size / side.young).sqrt()
            * side.impedance
    }));
    Damped {
        stiffness,
        damping: damping.unwrap_or(0.0),
        adhesion: match law.adhesion {
            schema::Adhesion::Clip => Adhesion::Clip,
            schema::Adhesion::AsPrinted => Adhesion::AsPrinted,
        },
    }
}
