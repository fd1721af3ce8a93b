//! The exact solution of bars, with the sizes, speeds and gap of the case.

use std::collections::BTreeSet;

use carom_bodies::{Body, Kinematics, Solid};
use carom_contact::{Rows, Search};
use carom_dynamics::{System, step_count};
use carom_exact::{Bar, Impact, Solution};
use carom_materials::Plane;

use super::context::Context;
use super::plan;
use super::problems::Problems;
use crate::error::Problem;
use crate::schema::{Case, Reference, Sides};

/// An exact solution and the contact that it belongs to.
#[derive(Clone, Debug)]
pub struct ExactReference {
    /// Name as in the case file.
    pub name: &'static str,
    /// The solution up to the end of the run.
    pub solution: Solution,
    /// Index of the contact.
    pub contact: usize,
    /// Unit vector along the bars, from the secondary side to the primary one.
    pub axis: [f64; 3],
}

pub(super) fn lower(
    context: &Context,
    system: &System,
    end: f64,
    problems: &mut Problems,
) -> Option<ExactReference> {
    let (name, sides, two) = match context.case.reference.as_ref()? {
        Reference::TwoBars(bars) => ("two-bars", bars.sides, true),
        Reference::BarOnWall(bar) => ("bar-on-wall", bar.sides, false),
    };
    let path = format!("reference.{name}");
    let solved = match foreign(context.case) {
        Some(what) => Err(format!("the exact solution has no {what}")),
        None => solve(system, (sides, two), end, |body| {
            joined(context, system, body)
        }),
    };
    match solved {
        Ok((solution, normal)) => Some(ExactReference {
            name,
            solution,
            contact: 0,
            axis: normal.map(|n| -n),
        }),
        Err(message) => {
            let problem = Problem::new(path, format!("the case is not this problem: {message}"));
            problems.refuse(problem)
        }
    }
}

/// The bodies that joints make one with a body, itself first.
fn joined(context: &Context, system: &System, body: usize) -> Vec<usize> {
    let case = context.case;
    let names: Vec<&str> = case.body.names().collect();
    let number = |name: &str| names.iter().position(|one| *one == name);
    let joints = plan::pairs(case).map(|pair| pair.bodies);
    let pairs: Vec<(usize, usize)> = joints
        .filter_map(|[inner, outer]| Some((number(inner)?, number(outer)?)))
        .chain(tied_bodies(context, system))
        .collect();
    let mut all = vec![body];
    let mut next = 0;
    while let Some(&one) = all.get(next) {
        next += 1;
        for &(inner, outer) in &pairs {
            for (from, to) in [(inner, outer), (outer, inner)] {
                if from == one && !all.contains(&to) {
                    all.push(to);
                }
            }
        }
    }
    all
}

/// The bodies whose surfaces are tied, by pairs.
fn tied_bodies(context: &Context, system: &System) -> Vec<(usize, usize)> {
    let owner = |group: &String| {
        let first = *system.mesh.groups.get(group)?.elements.first()?;
        let node = system.number[system.mesh.element_nodes(first)[0] as usize];
        let mut bodies = system.body_masses.iter();
        bodies.position(|masses| masses.iter().any(|(own, _)| *own == node))
    };
    let transitions = context.case.transition.iter();
    let surfaces = transitions.filter_map(|(_, given)| given.surfaces.as_ref());
    surfaces
        .filter_map(|[one, other]| Some((owner(one)?, owner(other)?)))
        .collect()
}

/// What a case has that acts on its bars and that the exact solution does not know.
fn foreign(case: &Case) -> Option<&'static str> {
    let mut bodies = case.body.iter();
    let mut supports = case.support.iter();
    let mut loads = case.load.iter();
    let mut contacts = case.contact.iter();
    let all = [
        (
            bodies.any(|(_, body)| body.damping.is_some()),
            "damping of a body",
        ),
        (
            supports.any(|(_, support)| support.motion.is_some()),
            "support that moves",
        ),
        (
            loads.any(|(_, load)| load.acceleration.is_none()),
            "load but gravity",
        ),
        (case.time.stage.is_some(), "static stage"),
        (
            contacts.any(|(_, contact)| contact.friction.is_some()),
            "friction",
        ),
    ];
    let (_, what) = all.into_iter().find(|(there, _)| *there)?;
    Some(what)
}

/// The solution, and the contact normal, which points from the primary side to the secondary one. `joined`:
/// the bodies that are one with a body.
fn solve(
    system: &System,
    (sides, two): (Sides, bool),
    end: f64,
    joined: impl Fn(usize) -> Vec<usize>,
) -> Result<(Solution, [f64; 3]), String> {
    let [contact] = &system.contacts[..] else {
        return Err(format!(
            "it has {} contacts instead of one",
            system.contacts.len()
        ));
    };
    let (secondary, primary) = (contact.secondary_body, contact.primary_body);
    match (two, primary) {
        (true, None) => return Err("its contact is with a rigid obstacle".to_string()),
        (false, Some(_)) => return Err("its contact is between two bodies".to_string()),
        (true, Some(_)) | (false, None) => {}
    }
    let one = joined(secondary);
    let other = primary.map(joined).unwrap_or_default();
    if one.iter().any(|body| other.contains(body)) {
        return Err("its two sides are joined".to_string());
    }
    let others = system.bodies.len() - one.len() - other.len();
    if others > 0 {
        let bars = if two { "the two bars" } else { "the bar" };
        return Err(format!(
            "it has {others} bodies besides {bars} in contact, which nothing joins to them"
        ));
    }
    let mut rows = Rows::default();
    rows.clear();
    contact.pair(
        &system.places(0.0, &system.initial.displacement, &system.initial.frames),
        &mut Search::default(),
        &mut rows,
    );
    let gap = (0..rows.len())
        .map(|point| rows.gap(point))
        .fold(f64::INFINITY, f64::min);
    if !gap.is_finite() {
        return Err("the bars do not face each other".to_string());
    }
    // the reference's contact begins with gap zero to the rounding of the mesh
    let gap = if gap.abs() <= 1e-9 * system.mesh.size() {
        0.0
    } else {
        gap
    };
    let normal = rows.normal(0);
    let own = contact.points.iter();
    let own = own.filter(|point| !point.is_on_primary() && !point.crosses());
    let area: f64 = own.map(|point| point.area).sum();
    let solid = |body: usize| system.bodies[body].as_solid();
    let width = |body: usize| solid(body).map_or(1.0, |solid| width(solid.kinematics()));
    let one = bar(system, &one, normal, (sides, area))?;
    let impact = match primary {
        None => Impact::Wall { bar: one, gap },
        Some(primary) => {
            let area = area * width(primary) / width(secondary);
            Impact::TwoBars {
                secondary: one,
                primary: bar(system, &other, normal.map(|n| -n), (sides, area))?,
                gap,
            }
        }
    };
    // unequal steps end within one step of the end time
    let unequal = system.adaptive.is_some() || system.critical_fraction.is_some();
    let extra = u64::from(unequal);
    let last = (step_count(end, system.dt) + extra) as f64 * system.dt;
    let solution =
        carom_exact::solve(&impact, last * (1.0 + 1e-9)).map_err(|error| error.to_string())?;
    Ok((solution, normal))
}

/// Area in m² that a unit of the end face of a body stands for, as far as a section does not vary over that face: two bars
/// whose faces cover each other have sections in this ratio.
fn width(kinematics: Kinematics) -> f64 {
    match kinematics {
        Kinematics::Axisymmetric | Kinematics::Solid => 1.0,
        other => other.surface_factor(&[0.0; 3]),
    }
}

/// The bar of the section `area` (m²) that bodies make, whose contact end lies against `inward`, the unit vector from the contact into the bar.
fn bar(
    system: &System,
    indices: &[usize],
    inward: [f64; 3],
    (sides, area): (Sides, f64),
) -> Result<Bar, String> {
    let solid = |index: usize| system.bodies[index].as_solid();
    let body: &Body = &system.bodies[indices[0]];
    let Some(material) = solid(indices[0]).map(Solid::material) else {
        return Err(format!("body `{}` is not a bar", body.name()));
    };
    if material.dissipates() {
        return Err(format!(
            "body `{}` has the material {}, and the exact bars are elastic",
            body.name(),
            material.key()
        ));
    }
    let alike = |&index: &usize| solid(index).map(Solid::material) == Some(material);
    if !indices.iter().all(alike) {
        return Err(format!(
            "the bodies joined to `{}` have other materials",
            body.name()
        ));
    }
    let along = |vector: &[f64]| {
        (0..vector.len())
            .map(|i| inward[i] * vector[i])
            .sum::<f64>()
    };
    let masses = indices.iter().flat_map(|&index| &system.body_masses[index]);
    let places = masses.map(|&(node, _)| (along(&system.x[node as usize]), node));
    let (mut near, mut far) = (f64::INFINITY, f64::NEG_INFINITY);
    places
        .clone()
        .for_each(|(s, _)| (near, far) = (near.min(s), far.max(s)));
    let length = far - near;
    let mass: f64 = indices.iter().map(|&index| system.body_mass(index)).sum();
    let density = material.density();
    if (mass - density * area * length).abs() > 1e-6 * mass {
        return Err(format!(
            "body `{}` is not a bar whose section, {area} m², meets the other side everywhere",
            body.name()
        ));
    }
    let held = |node: u32, i: usize| system.fixed[system.unknowns.first(node) + i];
    let clamped = |node: u32| (0..system.dim).any(|i| inward[i].abs() > 0.5 && held(node, i));
    let at_far = |s: f64| far - s < 1e-6 * length;
    if places.clone().any(|(s, node)| clamped(node) && !at_far(s)) {
        return Err(format!(
            "body `{}` is held along its axis elsewhere than at its far end",
            body.name()
        ));
    }
    let modulus = match sides {
        Sides::Free => material.initial().young,
        Sides::Blocked => material.initial().wave_modulus(Plane::Full),
    };
    let mut bar = Bar::new(length, area, modulus, density);
    if places.clone().any(|(s, node)| at_far(s) && clamped(node)) {
        bar = bar.clamped();
    }
    let first = places
        .clone()
        .find(|&(_, node)| !clamped(node))
        .map_or(0, |(_, node)| node);
    let velocity = along(&system.unknowns.vector(first, &system.initial.velocity));
    let gravity: f64 = along(&gravity(system, indices));
    Ok(bar.with_velocity(velocity).with_gravity(-gravity))
}

/// Acceleration of the dead load of bodies, m/s².
fn gravity(system: &System, indices: &[usize]) -> Vec<f64> {
    let masses = indices.iter().flat_map(|&index| &system.body_masses[index]);
    let mass: f64 = masses.clone().map(|(_, m)| m).sum();
    // bodies may have nodes in common
    let nodes: BTreeSet<u32> = masses.map(|(node, _)| *node).collect();
    let mut force = vec![0.0; system.dim];
    for node in nodes {
        let load = system.unknowns.vector(node, &system.load);
        for (force, load) in force.iter_mut().zip(load) {
            *force += load;
        }
    }
    force.iter().map(|f| f / mass).collect()
}
