//! Loads in time in the numbers of a system: on surfaces, at nodes, and the inertia force of an accelerated frame.

use carom_algebra::unknowns::{Kind, Unknowns};
use carom_bodies::{Body, FollowerPressure};
use carom_signals::Amplitude;

use crate::error::Error;
use crate::loads::{Load, LoadKind, NodalLoad};
use crate::mass::Mass;
use crate::model::{Model, ModelBody};
use crate::refused::Refused;

/// A load in the numbers of a system.
#[derive(Debug)]
pub struct NumberedLoad {
    /// Place of its name in [`NumberedNonlinear::load_names`](crate::NumberedNonlinear::load_names); none of an accelerated frame.
    pub named: Option<usize>,
    /// Factor in time.
    pub amplitude: Amplitude,
    /// What acts.
    pub force: NumberedForce,
    /// Bodies that it acts on.
    pub bodies: Vec<usize>,
}

/// Forces of a load at amplitude 1.
#[derive(Debug)]
pub enum NumberedForce {
    /// Unknowns and forces, N.
    Dead(Vec<(u32, f64)>),
    /// A pressure in Pa.
    Follower(Box<FollowerPressure>, f64),
}

/// All loads of a model in the numbers of its system.
///
/// `names`: gets the name of each load on surfaces and at nodes once.
///
/// # Errors
/// A load on a node that a rigid body carries, a moment on a node without such a rotation.
pub fn numbered_loads(
    model: &Model,
    (number, unknowns): (&[u32], &Unknowns),
    (bodies, mass): (&[Body], &Mass),
    names: &mut Vec<String>,
) -> Result<Vec<NumberedLoad>, Error> {
    let given = &model.nonlinear;
    let mut numbered = Vec::new();
    let mut named = |name: &String| {
        let place = names.iter().position(|other| other == name);
        Some(place.unwrap_or_else(|| {
            names.push(name.clone());
            names.len() - 1
        }))
    };
    for load in &given.loads {
        not_carried(&load.surface.nodes, (number, unknowns))?;
        numbered.push(NumberedLoad {
            named: named(&load.name),
            amplitude: load.amplitude.clone(),
            force: numbered_force(load, model, (number, unknowns)),
            bodies: loaded(load, model),
        });
    }
    for load in &given.nodal {
        not_carried(&load.nodes, (number, unknowns))?;
        numbered.push(NumberedLoad {
            named: named(&load.name),
            amplitude: load.amplitude.clone(),
            force: NumberedForce::Dead(nodal_forces(load, (number, unknowns))?),
            bodies: Vec::new(),
        });
    }
    for (direction, acceleration) in given.base.iter().enumerate() {
        if let Some(amplitude) = acceleration {
            numbered.push(NumberedLoad {
                named: None,
                amplitude: amplitude.clone(),
                force: NumberedForce::Dead(inertia_forces(direction, (bodies, unknowns), mass)),
                bodies: Vec::new(),
            });
        }
    }
    Ok(numbered)
}

/// -M r, with r a unit translation of all nodes in a direction: the inertia force for a unit acceleration of the frame.
fn inertia_forces(
    direction: usize,
    (bodies, unknowns): (&[Body], &Unknowns),
    mass: &Mass,
) -> Vec<(u32, f64)> {
    let mut unit = [0.0; 3];
    unit[direction] = 1.0;
    let force = mass.weight((bodies, unknowns), unit);
    let forces = (0u32..).zip(force).filter(|(_, force)| *force != 0.0);
    forces.map(|(unknown, force)| (unknown, -force)).collect()
}

/// Refuses loads on nodes that a rigid body carries.
fn not_carried(nodes: &[u32], (number, unknowns): (&[u32], &Unknowns)) -> Result<(), Error> {
    let carries = |node: &&u32| {
        let number = number[**node as usize];
        number != u32::MAX && unknowns.carrier(number).is_some()
    };
    match nodes.iter().find(carries) {
        None => Ok(()),
        Some(&node) => Err(Error::Nonlinear {
            what: Refused::Load { node },
            why: "a rigid body takes gravity, base accelerations, contact forces and prescribed motions",
        }),
    }
}

fn nodal_forces(
    load: &NodalLoad,
    (number, unknowns): (&[u32], &Unknowns),
) -> Result<Vec<(u32, f64)>, Error> {
    let mut forces = Vec::new();
    for &node in &load.nodes {
        let own = number[node as usize];
        if own == u32::MAX {
            continue;
        }
        for axis in 0..3 {
            let parts = [
                (Kind::Translation(axis), load.force[axis]),
                (Kind::Rotation(axis), load.moment[axis]),
            ];
            let turns = unknowns.dim() == 3 && unknowns.frame(own).is_some();
            if turns && load.moment != [0.0; 3] {
                return Err(Error::Nonlinear {
                    what: Refused::NodalLoad(load.name.clone()),
                    why: "in space moments on nodes with finite rotations are not available: they would depend on the rotation",
                });
            }
            for (kind, value) in parts.into_iter().filter(|(_, value)| *value != 0.0) {
                match unknowns.find(own, kind) {
                    Some(unknown) => forces.push((unknown as u32, value)),
                    None => {
                        return Err(Error::Nonlinear {
                            what: Refused::NodalLoad(load.name.clone()),
                            why: "its nodes have no unknown in this direction",
                        });
                    }
                }
            }
        }
    }
    Ok(forces)
}

/// Bodies that a load acts on.
fn loaded(load: &Load, model: &Model) -> Vec<usize> {
    let owns = |body: &ModelBody| {
        let mut faces = load.surface.faces.iter();
        faces.any(|face| body.spec.cells.contains(&face.parent))
    };
    let bodies = model.bodies.iter().enumerate();
    bodies
        .filter(|(_, body)| owns(body))
        .map(|(k, _)| k)
        .collect()
}

fn numbered_force(
    load: &Load,
    model: &Model,
    (number, unknowns): (&[u32], &Unknowns),
) -> NumberedForce {
    let owner = load.surface.faces.first().and_then(|face| {
        let owns = |body: &ModelBody| body.spec.cells.contains(&face.parent);
        model.bodies.iter().position(owns)
    });
    let body = owner.unwrap_or(0);
    match load.kind {
        LoadKind::Pressure(pressure) => {
            let kinematics = model.bodies[body].spec.kinematics;
            let (faces, x) = (&load.surface.faces, &model.mesh.nodes);
            let load = FollowerPressure::new(faces, x, number, unknowns, kinematics);
            NumberedForce::Follower(Box::new(load), pressure)
        }
        LoadKind::Traction(traction) => {
            let kinematics = model.bodies[body].spec.kinematics;
            let unit = |x: &[f64; 3]| kinematics.surface_factor(x);
            let areas = load.surface.node_areas(&model.mesh, unit);
            let mut forces = Vec::new();
            let nodes = load.surface.nodes.iter().map(|node| number[*node as usize]);
            for (node, area) in nodes.zip(areas).filter(|(node, _)| *node != u32::MAX) {
                let own = unknowns.translations_of(node).zip(traction);
                forces.extend(own.map(|(unknown, t)| (unknown as u32, area * t)));
            }
            NumberedForce::Dead(forces)
        }
    }
}
