//! Contacts: surfaces on the bodies, no penetration at the start, advice.

use carom_contact::law::Level;
use carom_contact::law::{Displacement, Reading, Restitution, Velocity};
use carom_contact::{Initial, Integration, Law, Plane, Sliding, Sphere};
use carom_dynamics::{ModelBody, ModelContact, ModelTarget, System};
use carom_mesh::{ElementId, Mesh, Surface};

use super::Builder;
use super::laws::{Side, sides};
use crate::error::Problem;
use crate::schema::{self, IntegrationName, IntegrationWith, Obstacle, Scheme};

impl Builder<'_> {
    /// The contacts. `of`: cells of each body.
    pub(super) fn contacts(
        &mut self,
        mesh: &Mesh,
        bodies: &[ModelBody],
        of: &[Vec<ElementId>],
    ) -> Vec<ModelContact> {
        let mut contacts = Vec::new();
        let cells = of.concat();
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
                    self.plane(mesh, &path, plane).map(ModelTarget::rigid)
                }
                (None, Some(Obstacle::Sphere(sphere))) => {
                    let path = format!("{path}.obstacle.sphere.centre");
                    Some(ModelTarget::rigid(Sphere {
                        centre: self.vector(mesh, &path, &sphere.centre),
                        radius: sphere.radius.0,
                        side: carom_contact::Side::Outside,
                    }))
                }
                (None, None) => None,
            };
            let (Some(secondary), Some(primary)) = (secondary, primary) else {
                continue;
            };
            let sides = sides(mesh, bodies, &secondary, &primary);
            let scheme = self.scheme_at(secondary.faces.first().map(|face| face.parent), of);
            let Some(law) = self.law(name, &contact.law, (&sides, &scheme)) else {
                continue;
            };
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
                integration: integration(contact.integration, &law, &sides),
                massless: contact.nodes == schema::Nodes::Massless,
                friction: 0.0,
                initial: Initial::Keep,
                depth: None,
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

    /// Refuses contacts that penetrate at the start, in the initial displacement.
    pub(super) fn penetration(&mut self, system: &System) {
        let mut rows = carom_contact::Rows::default();
        for contact in &system.contacts {
            rows.clear();
            let places = carom_contact::Places {
                dim: system.dim,
                time: 0.0,
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
            let point = &contact.points[deepest];
            let (node, x) = (point.node(), point.place(&places));
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

    /// Warns where a step is too long for the spring of a damped law: 2 sqrt(k h/E) CFL > 2. An explicit scheme has its
    /// critical step.
    fn warn_of_springs(&mut self, system: &System) {
        for (name, rate) in std::mem::take(&mut self.springs) {
            let value = rate * system.dt;
            // h / c, the step of Courant number 1, is at the bound for the default stiffness
            if value > 2.0 * (1.0 + 1e-9) && !system.scheme.get().is_explicit() {
                self.warnings.push(format!(
                    "contact `{name}`: the damped law is too stiff for the step, 2 sqrt(k h/E) CFL = {value:.3} instead of at most 2; take a step of at most {:.4e} s or a stiffness {:.3} times as large",
                    system.dt * 2.0 / value,
                    (2.0 / value).powi(2)
                ));
            }
        }
    }

    /// What is strange about contacts and schemes, without being wrong.
    pub(super) fn advise(&mut self, system: &System) {
        if self.plan.zones.is_empty() {
            self.warn_of_springs(system);
        }
        for (contact, (secondary, _)) in system.contacts.iter().zip(&system.sides) {
            let name = &contact.name;
            let zone = self.plan.zone_of(*secondary);
            let scheme = zone.map_or(self.case.time.scheme, |zone| self.plan.zones[zone].scheme);
            if let Law::Velocity(Velocity {
                reading: Reading::AsPrinted,
                ..
            }) = contact.law
            {
                self.warnings.push(format!(
                    "contact `{name}`: with sign = \"as-printed\" bodies pass through each other"
                ));
            }
            if let (Law::Restitution(Restitution { coefficient, .. }), Scheme::Theta(theta)) =
                (contact.law, &scheme)
                && theta.theta * (1.0 + coefficient) > 1.0
            {
                self.warnings.push(format!(
                    "contact `{name}`: impacts can gain energy where theta is above 1 / (1 + e) = {:.4}",
                    1.0 / (1.0 + coefficient)
                ));
            }
            if let (Law::Displacement(Displacement { projection: false }), Scheme::Newmark(newmark)) =
                (contact.law, &scheme)
                && newmark.beta == 0.25
            {
                self.warnings.push(format!("contact `{name}`: the trapezoid with the displacement law gains energy below a Courant number of about 4; look at the ledger"));
            }
        }
    }
}

/// Where the law holds: at Gauss points in its weak form if there is a multiplier, r from the softer side unless given.
fn integration(given: schema::Integration, law: &Law, sides: &[Side]) -> Integration {
    let given = match given {
        schema::Integration::Named(IntegrationName::Node) => return Integration::Node,
        schema::Integration::Named(IntegrationName::Quadrature) => None,
        schema::Integration::With(IntegrationWith::Quadrature(quadrature)) => Some(quadrature),
    };
    if law.is_function() {
        return Integration::Points;
    }
    let soft = &sides[0];
    let r = match law.get().level() {
        Level::Gap | Level::GapAndRate => given
            .and_then(|quadrature| quadrature.r)
            .map_or(soft.young / soft.size, |r| r.0),
        Level::Rate => given
            .and_then(|quadrature| quadrature.r_v)
            .map_or(soft.impedance, |r| r.0),
    };
    Integration::Weak { r }
}
