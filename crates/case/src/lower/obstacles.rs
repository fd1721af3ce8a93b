//! Rigid obstacles: shape and motion.

use carom_contact::{
    Cylinder, Motion, Obstacle, Plane, RigidSurface, Shape, Side, Sphere, Translation, Turn,
};
use carom_mesh::{Mesh, Surface};

use super::context::Context;
use super::problems::Problems;
use super::{course, lookup, profiles};
use crate::error::Problem;
use crate::schema::{self, ObstacleMotion};

/// The obstacle of the contact at `path`.
pub(super) fn obstacle(
    context: &Context,
    mesh: &Mesh,
    path: &str,
    obstacle: &schema::Obstacle,
    problems: &mut Problems,
) -> Option<Obstacle> {
    let (path, shape, moves) = match obstacle {
        schema::Obstacle::Plane(plane) => {
            let path = format!("{path}.obstacle.plane");
            let point = problems.vector(mesh, &format!("{path}.point"), &plane.point);
            let normal = lookup::normal(mesh, &format!("{path}.normal"), &plane.normal, problems)?;
            (path, Shape::Plane(Plane { point, normal }), &plane.motion)
        }
        schema::Obstacle::Sphere(sphere) => {
            let path = format!("{path}.obstacle.sphere");
            let shape = Shape::Sphere(Sphere {
                centre: problems.vector(mesh, &format!("{path}.centre"), &sphere.centre),
                radius: sphere.radius.0,
                side: side(sphere.side),
            });
            (path, shape, &sphere.motion)
        }
        schema::Obstacle::Cylinder(cylinder) => {
            let path = format!("{path}.obstacle.cylinder");
            let shape = Shape::Cylinder(Cylinder {
                point: problems.vector(mesh, &format!("{path}.point"), &cylinder.point),
                axis: lookup::axis(mesh, &format!("{path}.axis"), &cylinder.axis, problems)?,
                radius: cylinder.radius.0,
                side: side(cylinder.side),
            });
            (path, shape, &cylinder.motion)
        }
        schema::Obstacle::Profile(profile) => {
            let path = format!("{path}.obstacle.profile");
            let shape = profiles::profile(context, mesh, &path, profile, problems)?;
            (path, Shape::Profile(Box::new(shape)), &profile.motion)
        }
        schema::Obstacle::Surface(surface) => {
            let path = format!("{path}.obstacle.surface");
            let shape = rigid_surface(mesh, &format!("{path}.group"), surface, problems)?;
            (path, Shape::Surface(Box::new(shape)), &surface.motion)
        }
    };
    let motion = match moves {
        None => Motion::default(),
        Some(given) => motion(mesh, &format!("{path}.motion"), given, problems)?,
    };
    Some(Obstacle { shape, motion })
}

fn rigid_surface(
    mesh: &Mesh,
    path: &str,
    given: &schema::Surface,
    problems: &mut Problems,
) -> Option<RigidSurface> {
    let group = problems.group(mesh, path, &given.group)?;
    match Surface::of_facets(mesh, group, given.turned) {
        Ok(surface) => Some(RigidSurface::new(mesh, &surface)),
        Err(error) => {
            let problem = Problem::new(path, error.to_string()).found(&given.group);
            problems.refuse(problem.accepted(["a group of faces with normals to one side"]))
        }
    }
}

fn motion(
    mesh: &Mesh,
    path: &str,
    given: &ObstacleMotion,
    problems: &mut Problems,
) -> Option<Motion> {
    let translation = match (&given.velocity, &given.displacement) {
        (Some(velocity), _) => {
            let velocity = problems.vector(mesh, &format!("{path}.velocity"), velocity);
            Some(Translation::Velocity(velocity))
        }
        (None, Some(points)) => {
            let path = format!("{path}.displacement");
            let times: Vec<f64> = points.iter().map(|point| point.time.0).collect();
            course::ascending(&path, &times, problems);
            let mut table = Vec::new();
            for (k, point) in points.iter().enumerate() {
                let path = format!("{path}[{k}].displacement");
                table.push((
                    point.time.0,
                    problems.vector(mesh, &path, &point.displacement),
                ));
            }
            Some(Translation::Table(table))
        }
        (None, None) => None,
    };
    let turn = match &given.turn {
        None => None,
        Some(turn) => Some(Turn {
            point: problems.vector(mesh, &format!("{path}.turn.point"), &turn.point),
            axis: lookup::axis(mesh, &format!("{path}.turn.axis"), &turn.axis, problems)?,
            rate: turn.rate.0,
        }),
    };
    Some(Motion { translation, turn })
}

fn side(given: schema::Side) -> Side {
    match given {
        schema::Side::Outside => Side::Outside,
        schema::Side::Inside => Side::Inside,
    }
}
