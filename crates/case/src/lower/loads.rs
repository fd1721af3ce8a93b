//! Loads: gravity, base accelerations, pressures, tractions, forces and moments at nodes.

use carom_dynamics::{Amplitude, Load, LoadKind, ModelBody, NodalLoad};
use carom_mesh::{ElementId, Mesh, Surface};
use carom_signals::{Error, RandomField};

use super::Builder;
use super::probes::integrals;
use super::shells::shell_cells;
use super::supports::AXES;
use crate::error::Problem;
use crate::schema::{self, AmplitudeCourse};

impl Builder<'_> {
    /// The sum of all accelerations of free fall, m/s².
    pub(super) fn gravity(&mut self, mesh: &Mesh) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (name, load) in self.case.load.iter() {
            if let Some(acceleration) = &load.acceleration {
                let path = format!("load.{name}.acceleration");
                let of_load = self.vector(mesh, &path, acceleration);
                sum.iter_mut().zip(of_load).for_each(|(sum, g)| *sum += g);
            }
        }
        sum
    }

    /// Loads on surfaces.
    pub(super) fn loads(&mut self, mesh: &Mesh, bodies: &[ModelBody]) -> Vec<Load> {
        let cells: Vec<ElementId> = bodies.iter().flat_map(|b| b.spec.cells.clone()).collect();
        let shells = shell_cells(bodies);
        let mut loads = Vec::new();
        for (name, load) in self.case.load.iter() {
            let path = format!("load.{name}");
            let Some(kind) = self.kind(mesh, &path, load) else {
                continue;
            };
            let amplitude = self.load_amplitude(&path, load);
            let on = load.on.as_deref().unwrap_or_default();
            let middle = mesh
                .groups
                .get(on)
                .filter(|group| group.dim == 2 && mesh.dim == 3);
            let middle = middle.and_then(|group| Surface::of_shells(mesh, group, &shells).ok());
            let surface = middle.or_else(|| self.surface(mesh, &cells, &format!("{path}.on"), on));
            let Some(surface) = surface else {
                continue;
            };
            self.of_one_body(&path, on, &surface, bodies);
            if let Some(amplitude) = amplitude {
                loads.push(Load {
                    name: name.to_string(),
                    surface,
                    kind,
                    amplitude,
                });
            }
        }
        loads
    }

    /// Forces and moments at nodes.
    pub(super) fn nodal_loads(&mut self, mesh: &Mesh) -> Vec<NodalLoad> {
        let mut loads = Vec::new();
        for (name, load) in self.case.load.iter() {
            let path = format!("load.{name}");
            if let Some(random) = &load.random {
                loads.extend(self.random_loads(mesh, (name, load), random));
                continue;
            }
            let (force, moment) = match (&load.force, &load.moment) {
                (Some(force), _) => {
                    let path = format!("{path}.force");
                    (self.vector(mesh, &path, force), [0.0; 3])
                }
                (None, Some(moment)) => ([0.0; 3], moment.si()),
                (None, None) => continue,
            };
            let amplitude = self.load_amplitude(&path, load);
            let on = load.on.as_deref().unwrap_or_default();
            let group = self.group(mesh, &format!("{path}.on"), on);
            if let (Some(amplitude), Some(group)) = (amplitude, group) {
                loads.push(NodalLoad {
                    name: name.to_string(),
                    nodes: mesh.group_nodes(group),
                    force,
                    moment,
                    amplitude,
                });
            }
        }
        loads
    }

    /// A random force along a line: one load for each node, with its own function of time.
    fn random_loads(
        &mut self,
        mesh: &Mesh,
        (name, load): (&str, &schema::Load),
        random: &schema::RandomForce,
    ) -> Vec<NodalLoad> {
        let path = format!("load.{name}");
        let directions = [("direction", &random.direction), ("along", &random.along)];
        let [direction, along] = directions
            .map(|(key, given)| self.normal(mesh, &format!("{path}.random.{key}"), given));
        let on = load.on.as_deref().unwrap_or_default();
        let group = self.group(mesh, &format!("{path}.on"), on);
        let (Some(direction), Some(along), Some(group)) = (direction, along, group) else {
            return Vec::new();
        };
        let mut nodes: Vec<(f64, u32, f64)> = integrals(mesh, group, &|_| 1.0)
            .into_iter()
            .map(|(node, measure)| {
                let x = mesh.nodes[node as usize];
                ((0..3).map(|i| along[i] * x[i]).sum(), node, measure)
            })
            .collect();
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let field = RandomField {
            spectrum: random
                .spectrum
                .iter()
                .map(|point| [point.frequency.0, point.density])
                .collect(),
            correlation_length: random.correlation_length.0,
            duration: self.case.time.end.0,
            seed: u64::from(random.seed),
        };
        let places: Vec<f64> = nodes.iter().map(|(place, ..)| *place).collect();
        match field.at(&places) {
            Ok(amplitudes) => {
                let loads = nodes.iter().zip(amplitudes);
                loads
                    .map(|(&(_, node, measure), amplitude)| NodalLoad {
                        name: name.to_owned(),
                        nodes: vec![node],
                        force: direction.map(|n| measure * n),
                        moment: [0.0; 3],
                        amplitude,
                    })
                    .collect()
            }
            Err(error) => {
                let path = match &error {
                    Error::NotADensity { at } => format!("{path}.random.spectrum[{at}]"),
                    _ => format!("{path}.random.spectrum"),
                };
                self.problems.push(Problem::new(path, error.to_string()));
                Vec::new()
            }
        }
    }

    /// Acceleration of the ground by direction.
    pub(super) fn base_acceleration(&mut self, mesh: &Mesh) -> [Option<Amplitude>; 3] {
        let mut base = [None, None, None];
        for (name, load) in self.case.load.iter() {
            let Some(given) = &load.base_acceleration else {
                continue;
            };
            for (axis, signal) in [&given.x, &given.y, &given.z].into_iter().enumerate() {
                let Some(signal) = signal else { continue };
                let path = format!("load.{name}.base-acceleration.{}", AXES[axis]);
                self.within(mesh, &path, axis);
                if base[axis].is_some() {
                    let message = "the ground has an acceleration in this direction already";
                    let problem = Problem::new(&path, message).found(signal);
                    self.problems
                        .push(problem.accepted(["one base acceleration for each direction"]));
                }
                base[axis] = self.acceleration_signal(&path, signal);
            }
        }
        base
    }

    /// Factor of a load in time.
    fn load_amplitude(&mut self, path: &str, load: &schema::Load) -> Option<Amplitude> {
        let path = format!("{path}.amplitude");
        match &load.amplitude {
            None => Some(Amplitude::constant(1.0)),
            Some(AmplitudeCourse::Signal(name)) => self.factor_signal(&path, name),
            Some(AmplitudeCourse::Points(points)) => {
                let points = points.iter();
                let points = points.map(|point| [point.time.0, point.factor]);
                self.amplitude(&path, points.collect())
            }
        }
    }

    /// What acts on the surface; none for what acts elsewhere.
    fn kind(&mut self, mesh: &Mesh, path: &str, load: &schema::Load) -> Option<LoadKind> {
        match (&load.pressure, &load.traction) {
            (Some(pressure), _) => Some(LoadKind::Pressure(pressure.0)),
            (None, Some(traction)) => {
                let path = format!("{path}.traction");
                Some(LoadKind::Traction(self.vector(mesh, &path, traction)))
            }
            (None, None) => None,
        }
    }

    /// Refuses a loaded surface of several bodies.
    fn of_one_body(&mut self, path: &str, on: &str, surface: &Surface, bodies: &[ModelBody]) {
        let owns = |body: &&ModelBody| {
            let cells = &body.spec.cells;
            let mut faces = surface.faces.iter();
            faces.any(|face| cells.binary_search(&face.parent).is_ok())
        };
        let owners: Vec<&str> = bodies
            .iter()
            .filter(owns)
            .map(|body| body.spec.name.as_str())
            .collect();
        if owners.len() > 1 {
            let message = "a load acts on one body";
            let problem = Problem::new(format!("{path}.on"), message)
                .found(format!("{on}, of the bodies {}", owners.join(", ")));
            self.problems
                .push(problem.accepted(["a group of sides of one body"]));
        }
    }
}
