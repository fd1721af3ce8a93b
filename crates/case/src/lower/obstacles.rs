//! Rigid obstacles: shape and motion.

use carom_contact::{
    Cylinder, Motion, Obstacle, Plane, RigidSurface, Shape, Side, Sphere, Translation, Turn,
};
use carom_mesh::{Mesh, Surface};

use super::Builder;
use crate::error::Problem;
use crate::schema::{self, NormalVector, ObstacleMotion};

impl Builder<'_> {
    /// The obstacle of the contact at `path`.
    pub(super) fn obstacle(
        &mut self,
        mesh: &Mesh,
        path: &str,
        obstacle: &schema::Obstacle,
    ) -> Option<Obstacle> {
        let (path, shape, motion) = match obstacle {
            schema::Obstacle::Plane(plane) => {
                let path = format!("{path}.obstacle.plane");
                let point = self.vector(mesh, &format!("{path}.point"), &plane.point);
                let normal = self.normal(mesh, &format!("{path}.normal"), &plane.normal)?;
                (path, Shape::Plane(Plane { point, normal }), &plane.motion)
            }
            schema::Obstacle::Sphere(sphere) => {
                let path = format!("{path}.obstacle.sphere");
                let shape = Shape::Sphere(Sphere {
                    centre: self.vector(mesh, &format!("{path}.centre"), &sphere.centre),
                    radius: sphere.radius.0,
                    side: side(sphere.side),
                });
                (path, shape, &sphere.motion)
            }
            schema::Obstacle::Cylinder(cylinder) => {
                let path = format!("{path}.obstacle.cylinder");
                let shape = Shape::Cylinder(Cylinder {
                    point: self.vector(mesh, &format!("{path}.point"), &cylinder.point),
                    axis: self.axis(mesh, &format!("{path}.axis"), &cylinder.axis)?,
                    radius: cylinder.radius.0,
                    side: side(cylinder.side),
                });
                (path, shape, &cylinder.motion)
            }
            schema::Obstacle::Profile(profile) => {
                let path = format!("{path}.obstacle.profile");
                let shape = self.profile(mesh, &path, profile)?;
                (path, Shape::Profile(Box::new(shape)), &profile.motion)
            }
            schema::Obstacle::Surface(surface) => {
                let path = format!("{path}.obstacle.surface");
                let shape = self.rigid_surface(mesh, &format!("{path}.group"), surface)?;
                (path, Shape::Surface(Box::new(shape)), &surface.motion)
            }
        };
        let motion = match motion {
            None => Motion::default(),
            Some(motion) => self.motion(mesh, &format!("{path}.motion"), motion)?,
        };
        Some(Obstacle { shape, motion })
    }

    fn rigid_surface(
        &mut self,
        mesh: &Mesh,
        path: &str,
        given: &schema::Surface,
    ) -> Option<RigidSurface> {
        let group = self.group(mesh, path, &given.group)?;
        match Surface::of_facets(mesh, group, given.turned) {
            Ok(surface) => Some(RigidSurface::new(mesh, &surface)),
            Err(error) => {
                let problem = Problem::new(path, error.to_string()).found(&given.group);
                self.problems
                    .push(problem.accepted(["a group of faces with normals to one side"]));
                None
            }
        }
    }

    fn motion(&mut self, mesh: &Mesh, path: &str, given: &ObstacleMotion) -> Option<Motion> {
        let translation = match (&given.velocity, &given.displacement) {
            (Some(velocity), _) => {
                let velocity = self.vector(mesh, &format!("{path}.velocity"), velocity);
                Some(Translation::Velocity(velocity))
            }
            (None, Some(points)) => {
                let path = format!("{path}.displacement");
                let times: Vec<f64> = points.iter().map(|point| point.time.0).collect();
                self.ascending(&path, &times);
                let mut table = Vec::new();
                for (k, point) in points.iter().enumerate() {
                    let path = format!("{path}[{k}].displacement");
                    table.push((point.time.0, self.vector(mesh, &path, &point.displacement)));
                }
                Some(Translation::Table(table))
            }
            (None, None) => None,
        };
        let turn = match &given.turn {
            None => None,
            Some(turn) => Some(Turn {
                point: self.vector(mesh, &format!("{path}.turn.point"), &turn.point),
                axis: self.axis(mesh, &format!("{path}.turn.axis"), &turn.axis)?,
                rate: turn.rate.0,
            }),
        };
        Some(Motion { translation, turn })
    }

    /// A unit vector in the space of the mesh.
    pub(super) fn normal(
        &mut self,
        mesh: &Mesh,
        path: &str,
        given: &NormalVector,
    ) -> Option<[f64; 3]> {
        let normal = given.components();
        if normal[mesh.dim..].iter().any(|n| *n != 0.0) {
            let message = format!(
                "a normal beyond the {} of the mesh",
                super::dimensions(mesh.dim)
            );
            let problem = Problem::new(path, message).found(format!("{normal:?}"));
            self.problems
                .push(problem.accepted(["a normal in the space of the mesh"]));
            return None;
        }
        Some(unit(normal))
    }

    /// A unit vector along an axis: in the plane across it.
    pub(super) fn axis(
        &mut self,
        mesh: &Mesh,
        path: &str,
        given: &NormalVector,
    ) -> Option<[f64; 3]> {
        let axis = given.components();
        let across = axis[0] == 0.0 && axis[1] == 0.0;
        if mesh.dim < 3 && !across {
            let message = "an axis in the plane of the mesh";
            let problem = Problem::new(path, message).found(format!("{axis:?}"));
            self.problems.push(problem.accepted(["[0, 0, 1]"]));
            return None;
        }
        Some(unit(axis))
    }
}

/// The direction of a vector of any length but zero, brought near one first: squares of its components may be no numbers.
fn unit(vector: [f64; 3]) -> [f64; 3] {
    let largest = vector
        .iter()
        .fold(0.0_f64, |largest, n| largest.max(n.abs()));
    // in two steps: one over the smallest numbers is infinite
    let vector = vector.map(|n| n / largest);
    let length = vector.iter().map(|n| n * n).sum::<f64>().sqrt();
    vector.map(|n| n / length)
}

fn side(given: schema::Side) -> Side {
    match given {
        schema::Side::Outside => Side::Outside,
        schema::Side::Inside => Side::Inside,
    }
}
