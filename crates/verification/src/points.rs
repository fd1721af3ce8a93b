//! Models of point masses, springs and stops.

use carom_bodies::{Curve, DiscreteKind, DiscreteSpec, Link, PointMass};
use carom_contact::law::{Adhesion, Crush, Curve as StopCurve, Stop};
use carom_contact::{Friction, Initial, Law, Obstacle, Plane, Sliding};
use carom_dynamics::{Model, ModelContact, ModelDiscrete, ModelTarget, Scheme, State};
use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh, Surface};

use crate::Error;
use crate::check::Row;

/// A model that grows.
pub(crate) struct Points {
    mesh: Mesh,
    discrete: Vec<ModelDiscrete>,
    contacts: Vec<ModelContact>,
}

/// Node and cell of a point mass.
pub(crate) type Point = (u32, ElementId);

impl Points {
    pub(crate) fn new(dim: usize) -> Points {
        Points {
            mesh: Mesh::new(dim),
            discrete: Vec::new(),
            contacts: Vec::new(),
        }
    }

    /// A point mass (kg) at a place with its initial displacement and velocity.
    pub(crate) fn mass(&mut self, mass: f64, at: [f64; 3], [u, v]: [[f64; 3]; 2]) -> Point {
        let node = self.mesh.nodes.len() as u32;
        self.mesh.nodes.push(at);
        let cell = self.mesh.push(Kind::Point1, &[node]);
        self.discrete.push(ModelDiscrete {
            displacement: Some(u),
            velocity: Some(v),
            ..self.made("mass", cell, DiscreteKind::Mass(mass.into()))
        });
        (node, cell)
    }

    /// A disc in the plane at rest, with its mass (kg) and moment of inertia (kg m²).
    pub(crate) fn disc(&mut self, [mass, inertia]: [f64; 2], at: [f64; 3]) -> Point {
        let point = self.mass(mass, at, [[0.0; 3]; 2]);
        if let Some(made) = self.discrete.last_mut() {
            made.spec.kind = DiscreteKind::Mass(PointMass {
                mass,
                inertia: [0.0, 0.0, inertia],
            });
        }
        point
    }

    /// A spring between a mass and the ground along an axis.
    pub(crate) fn spring(&mut self, at: Point, axis: [f64; 3], curve: Curve) {
        let cell = self.mesh.push(Kind::Point1, &[at.0]);
        let axis = Some(axis);
        let made = self.made("spring", cell, DiscreteKind::Spring(Link { curve, axis }));
        self.discrete.push(made);
    }

    /// A spring between two masses along the unit vector from the first to the second.
    pub(crate) fn between(&mut self, ends: [Point; 2], axis: [f64; 3], curve: Curve) {
        let cell = self.mesh.push(Kind::Bar2, &ends.map(|end| end.0));
        let axis = Some(axis);
        let made = self.made("spring", cell, DiscreteKind::Spring(Link { curve, axis }));
        self.discrete.push(made);
    }

    /// A linear dashpot between a mass and the ground in all directions, N s/m.
    pub(crate) fn dashpot(&mut self, at: Point, damping: f64) {
        let cell = self.mesh.push(Kind::Point1, &[at.0]);
        let link = Link {
            curve: Curve::line(damping),
            axis: None,
        };
        let made = self.made("dashpot", cell, DiscreteKind::Dashpot(link));
        self.discrete.push(made);
    }

    fn made(&self, kind_name: &str, cell: ElementId, kind: DiscreteKind) -> ModelDiscrete {
        ModelDiscrete::new(DiscreteSpec {
            name: format!("{kind_name}-{}", self.discrete.len()),
            cells: vec![cell],
            kind,
        })
    }

    /// A stop of stiffness (N/m) and damping (N s/m) with a gap (m) between a mass and another one, or the ground, along the
    /// unit vector from it to that.
    pub(crate) fn stop(
        &mut self,
        (one, other): (Point, Option<Point>),
        axis: [f64; 3],
        gap: f64,
        [stiffness, damping]: [f64; 2],
    ) -> Result<(), Error> {
        let back = axis.map(|n| -n);
        let target = match other {
            Some(other) => ModelTarget::Surface(Surface::of_points(&[other], back)),
            None => ModelTarget::rigid(Plane {
                point: self.mesh.nodes[one.0 as usize],
                normal: back,
            }),
        };
        let law = spring_stop(stiffness, damping)?;
        self.contacts.push(ModelContact {
            initial: Initial::Gap(gap),
            ..ModelContact::new("stop", Surface::of_points(&[one], axis), target, law)
        });
        Ok(())
    }

    /// Gives the stop made last another law.
    pub(crate) fn law_of_stop(&mut self, law: Law) {
        if let Some(stop) = self.contacts.last_mut() {
            stop.law = law;
        }
    }

    /// Friction of the stop made last, and the radii (m) of the sections of its ends.
    pub(crate) fn rub(&mut self, friction: f64, radii: [f64; 2]) {
        if let Some(stop) = self.contacts.last_mut() {
            stop.friction = friction.into();
            stop.secondary = around(stop.secondary.clone(), radii[0]);
            if let ModelTarget::Surface(primary) = &stop.primary {
                stop.primary = ModelTarget::Surface(around(primary.clone(), radii[1]));
            }
        }
    }

    /// A mass in front of a rigid obstacle, with the radius (m) of its section.
    pub(crate) fn in_front_of(
        &mut self,
        one: Point,
        (obstacle, radius): (Obstacle, f64),
        law: Law,
    ) {
        let target = ModelTarget::Rigid(obstacle);
        self.contacts.push(ModelContact {
            sliding: Sliding::Finite,
            ..ModelContact::new(
                "bore",
                around(Surface::of_points(&[one], [0.0; 3]), radius),
                target,
                law,
            )
        });
    }

    /// Contact of a mass by any law.
    pub(crate) fn contact(
        &mut self,
        one: Point,
        target: ModelTarget,
        law: Law,
        friction: impl Into<Friction>,
    ) {
        self.contacts.push(ModelContact {
            friction: friction.into(),
            ..ModelContact::new("floor", Surface::of_points(&[one], [0.0; 3]), target, law)
        });
    }

    pub(crate) fn model(self, scheme: Scheme, dt: f64) -> Model {
        Model {
            discrete: self.discrete,
            contacts: self.contacts,
            ..Model::new(Vec::new(), self.mesh, scheme, dt)
        }
    }
}

/// Points with the surface of a section (radius in m) around them.
fn around(mut surface: Surface, radius: f64) -> Surface {
    for face in &mut surface.faces {
        face.radius = Some(radius);
    }
    surface
}

/// The law of a stop of stiffness (N/m) and damping (N s/m).
pub(crate) fn spring_stop(stiffness: f64, damping: f64) -> Result<Law, Error> {
    Ok(Law::Stop(Stop {
        clearance: 0.0,
        curve: StopCurve::new(&[[1.0, stiffness]])?,
        crush: Crush::Recovered,
        damping,
        adhesion: Adhesion::Clip,
    }))
}

/// What the balances leave, over the largest energy and over the largest momentum or `scale` (N s), if that is more: round-off
/// of the steps.
pub(crate) fn balances(name: &str, state: &State, scale: f64) -> [Row; 2] {
    let ledger = &state.ledger;
    let energy = ledger.largest_energy_residual / ledger.largest_energy;
    let momentum = ledger.largest_momentum_residual / ledger.largest_momentum.max(scale);
    [("energy", energy), ("momentum", momentum)]
        .map(|(what, found)| Row::at_most(format!("{name}: {what} residual"), found, 1e-11))
}

/// The zero of a line through two points (x, y).
pub(crate) fn crossing([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> f64 {
    x0 + (x1 - x0) * y0 / (y0 - y1)
}

/// Place and value of the vertex of the parabola through three values at equal distances, the middle one at `x`.
pub(crate) fn vertex(x: f64, step: f64, [before, at, after]: [f64; 3]) -> [f64; 2] {
    let (slope, bend) = (0.5 * (after - before), before - 2.0 * at + after);
    [x - step * slope / bend, at - 0.5 * slope * slope / bend]
}
