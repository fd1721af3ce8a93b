//! Loads: gravity, base accelerations, pressures, tractions, forces and moments at nodes.

use carom_dynamics::{Amplitude, Load, LoadKind, ModelBody, NodalLoad};
use carom_mesh::{ElementId, Mesh, Surface};
use carom_signals::{Error, RandomField};

use super::context::Context;
use super::course;
use super::lookup::{self, AXES};
use super::probes::integrals;
use super::problems::Problems;
use super::shells::shell_cells;
use super::signals::{self, Follower};
use crate::error::Problem;
use crate::schema::{self, AmplitudeCourse};

/// What acts on a model.
pub(super) struct Loads {
    /// Acceleration of free fall, m/s².
    pub(super) gravity: [f64; 3],
    /// On surfaces.
    pub(super) surfaces: Vec<Load>,
    /// Forces and moments at nodes.
    pub(super) nodal: Vec<NodalLoad>,
    /// Accelerations of the ground.
    pub(super) base: [Option<Amplitude>; 3],
}

/// The loads of a case.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    problems: &mut Problems,
) -> Loads {
    Loads {
        gravity: gravity(context, mesh, problems),
        surfaces: on_surfaces(context, mesh, bodies, problems),
        nodal: nodal_loads(context, mesh, problems),
        base: base_acceleration(context, mesh, problems),
    }
}

/// The sum of all accelerations of free fall, m/s².
fn gravity(context: &Context, mesh: &Mesh, problems: &mut Problems) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (name, load) in context.case.load.iter() {
        if let Some(acceleration) = &load.acceleration {
            let path = format!("load.{name}.acceleration");
            let of_load = problems.vector(mesh, &path, acceleration);
            sum.iter_mut().zip(of_load).for_each(|(sum, g)| *sum += g);
        }
    }
    sum
}

/// Loads on surfaces.
fn on_surfaces(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    problems: &mut Problems,
) -> Vec<Load> {
    let cells: Vec<ElementId> = bodies.iter().flat_map(|b| b.spec.cells.clone()).collect();
    let shells = shell_cells(bodies);
    let surface = |path: &str, on: &str, problems: &mut Problems| {
        let group = mesh.groups.get(on);
        let middle = group.filter(|group| group.dim == 2 && mesh.dim == 3);
        let middle = middle.and_then(|group| Surface::of_shells(mesh, group, &shells).ok());
        middle.or_else(|| lookup::surface(mesh, &cells, path, on, problems))
    };
    let mut loads = Vec::new();
    for (name, load) in context.case.load.iter() {
        let path = format!("load.{name}");
        let Some(kind) = kind(mesh, &path, load, problems) else {
            continue;
        };
        let amplitude = load_amplitude(context, &path, load, problems);
        let (path, on) = (format!("{path}.on"), load.on.as_deref().unwrap_or_default());
        let Some(surface) = surface(&path, on, problems) else {
            continue;
        };
        of_one_body(&path, on, &surface, bodies, problems);
        loads.extend(amplitude.map(|amplitude| Load {
            name: name.to_string(),
            surface,
            kind,
            amplitude,
        }));
    }
    loads
}

/// Forces and moments at nodes.
fn nodal_loads(context: &Context, mesh: &Mesh, problems: &mut Problems) -> Vec<NodalLoad> {
    let mut loads = Vec::new();
    for (name, load) in context.case.load.iter() {
        match &load.random {
            Some(random) => {
                let random = random_loads(context, mesh, (name, load), random, problems);
                loads.extend(random.into_iter().flatten());
            }
            None => loads.extend(nodal_load(context, mesh, (name, load), problems)),
        }
    }
    loads
}

/// A force or a moment, if the load is one.
fn nodal_load(
    context: &Context,
    mesh: &Mesh,
    (name, load): (&str, &schema::Load),
    problems: &mut Problems,
) -> Option<NodalLoad> {
    let path = format!("load.{name}");
    let (force, moment) = match (&load.force, &load.moment) {
        (Some(force), _) => {
            let path = format!("{path}.force");
            (problems.vector(mesh, &path, force), [0.0; 3])
        }
        (None, Some(moment)) => ([0.0; 3], moment.si()),
        (None, None) => return None,
    };
    let amplitude = load_amplitude(context, &path, load, problems);
    let on = load.on.as_deref().unwrap_or_default();
    let group = problems.group(mesh, &format!("{path}.on"), on);
    let (amplitude, group) = (amplitude?, group?);
    Some(NodalLoad {
        name: name.to_string(),
        nodes: mesh.group_nodes(group),
        force,
        moment,
        amplitude,
    })
}

/// A random force along a line: one load for each node, with its own function of time.
fn random_loads(
    context: &Context,
    mesh: &Mesh,
    (name, load): (&str, &schema::Load),
    random: &schema::RandomForce,
    problems: &mut Problems,
) -> Option<Vec<NodalLoad>> {
    let path = format!("load.{name}");
    let directions = [("direction", &random.direction), ("along", &random.along)];
    let [direction, along] = directions
        .map(|(key, given)| lookup::normal(mesh, &format!("{path}.random.{key}"), given, problems));
    let on = load.on.as_deref().unwrap_or_default();
    let group = problems.group(mesh, &format!("{path}.on"), on);
    let (direction, along) = (direction?, along?);
    let nodes = integrals(mesh, group?, &|_| 1.0).into_iter();
    let nodes = nodes.map(|(node, measure)| {
        let x = mesh.nodes[node as usize];
        ((0..3).map(|i| along[i] * x[i]).sum(), node, measure)
    });
    let mut nodes: Vec<(f64, u32, f64)> = nodes.collect();
    nodes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let field = RandomField {
        spectrum: random
            .spectrum
            .iter()
            .map(|point| [point.frequency.0, point.density])
            .collect(),
        correlation_length: random.correlation_length.0,
        duration: context.case.time.end.0,
        seed: u64::from(random.seed),
    };
    let places: Vec<f64> = nodes.iter().map(|(place, ..)| *place).collect();
    let amplitudes = match field.at(&places) {
        Ok(amplitudes) => amplitudes,
        Err(error) => {
            let path = match &error {
                Error::NotADensity { at } => format!("{path}.random.spectrum[{at}]"),
                _ => format!("{path}.random.spectrum"),
            };
            return problems.refuse(Problem::new(path, error.to_string()));
        }
    };
    let load = |(&(_, node, measure), amplitude): (&(f64, u32, f64), Amplitude)| NodalLoad {
        name: name.to_owned(),
        nodes: vec![node],
        force: direction.map(|n| measure * n),
        moment: [0.0; 3],
        amplitude,
    };
    Some(nodes.iter().zip(amplitudes).map(load).collect())
}

/// Acceleration of the ground by direction.
fn base_acceleration(
    context: &Context,
    mesh: &Mesh,
    problems: &mut Problems,
) -> [Option<Amplitude>; 3] {
    let mut base = [None, None, None];
    for (name, load) in context.case.load.iter() {
        let Some(given) = &load.base_acceleration else {
            continue;
        };
        for (axis, signal) in [&given.x, &given.y, &given.z].into_iter().enumerate() {
            let Some(signal) = signal else { continue };
            let path = format!("load.{name}.base-acceleration.{}", AXES[axis]);
            lookup::within(mesh, &path, axis, problems);
            if base[axis].is_some() {
                let message = "the ground has an acceleration in this direction already";
                let problem = Problem::new(&path, message).found(signal);
                problems.push(problem.accepted(["one base acceleration for each direction"]));
            }
            base[axis] =
                signals::followed(context, &path, signal, Follower::Acceleration, problems);
        }
    }
    base
}

/// Factor of a load in time.
fn load_amplitude(
    context: &Context,
    path: &str,
    load: &schema::Load,
    problems: &mut Problems,
) -> Option<Amplitude> {
    let path = format!("{path}.amplitude");
    match &load.amplitude {
        None => Some(Amplitude::constant(1.0)),
        Some(AmplitudeCourse::Signal(name)) => {
            signals::followed(context, &path, name, Follower::Factor, problems)
        }
        Some(AmplitudeCourse::Points(points)) => {
            let points = points.iter();
            let points = points.map(|point| [point.time.0, point.factor]);
            course::amplitude(&path, points.collect(), problems)
        }
    }
}

/// What acts on the surface; none for what acts elsewhere.
fn kind(mesh: &Mesh, path: &str, load: &schema::Load, problems: &mut Problems) -> Option<LoadKind> {
    match (&load.pressure, &load.traction) {
        (Some(pressure), _) => Some(LoadKind::Pressure(pressure.0)),
        (None, Some(traction)) => {
            let path = format!("{path}.traction");
            Some(LoadKind::Traction(problems.vector(mesh, &path, traction)))
        }
        (None, None) => None,
    }
}

/// Refuses a loaded surface of several bodies.
fn of_one_body(
    path: &str,
    on: &str,
    surface: &Surface,
    bodies: &[ModelBody],
    problems: &mut Problems,
) {
    let owns = |body: &&ModelBody| {
        let cells = &body.spec.cells;
        let mut faces = surface.faces.iter();
        faces.any(|face| cells.binary_search(&face.parent).is_ok())
    };
    let owners = bodies.iter().filter(owns);
    let owners: Vec<&str> = owners.map(|body| body.spec.name.as_str()).collect();
    if owners.len() > 1 {
        let message = "a load acts on one body";
        let found = format!("{on}, of the bodies {}", owners.join(", "));
        let problem = Problem::new(path, message).found(found);
        problems.push(problem.accepted(["a group of sides of one body"]));
    }
}
