//! The row of `histories.csv` that every accepted state adds, and the rows of `contact.csv`.
//!
//! `contact.csv` is there where steps have parts, as in a run in zones: its rows are at the ends of the parts, its columns
//! the contacts' ones, every cell filled. The forces in `histories.csv` are then means over the step, so that in both
//! files the sum of a column of forces times the step is the impulse. Where steps may end with impulses that are in no force, a
//! column has these. Springs and dashpots have the sum of their forces, and the mean of their elongations or rates, at the end
//! of the step. (One file with both would be half blank.)

use std::collections::BTreeSet;
use std::path::Path;

use carom_dynamics::{ContactReport, Order, State, StepReport, System};
use serde::{Deserialize, Serialize};

use crate::history::column;
use crate::results::bolts;
use crate::results::columns::{contact_columns, deletes, files, moments, turns};
use crate::results::probed::Cells;
use crate::results::sensor::{ContactPoint, Sensor};
use crate::results::{Probe, Settings, Zoning};
use crate::rows::Cell;
use crate::{Error, Folder, History};

/// The file with what its rows need.
#[derive(Debug)]
pub(crate) struct Histories {
    file: Option<History>,
    contact: Option<History>,
    links: bool,
    probes: Vec<(Probe, Vec<Sensor>)>,
    /// The cells of each probe.
    cells: Vec<Cells>,
    /// The contact points of each probe, with the parts of their forces there, if it follows them.
    points: Vec<Option<Vec<(usize, f64)>>>,
    row: Vec<Cell<'static>>,
    every: Option<f64>,
    since: Since,
}

/// What is gathered since the last row, where not every step has one.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Since {
    /// Of each contact.
    means: Vec<ContactReport>,
    /// Time of these, and of the last row, s.
    gathered: f64,
    last: Option<f64>,
}

/// Lengths of the two files, and what is gathered.
pub(crate) type Kept = ([u64; 2], Since);

impl Histories {
    /// Creates the files, or goes on with them; `columns`: of [`columns()`]; `sensors`: of each probe.
    pub(crate) fn create(
        folder: &mut Folder,
        columns: &[String],
        (system, settings): (&System, &Settings),
        (sensors, kept): (Vec<Vec<Sensor>>, Option<Kept>),
    ) -> Result<Histories, Error> {
        let (lengths, since) = kept.unzip();
        let open = |path: &Path, columns: &[String], file: usize| match lengths {
            Some(lengths) => History::go_on(path, columns.len(), lengths[file]),
            None => History::create(path, columns),
        };
        let [name, contact_name] = files(settings);
        let path = folder.file(&name)?;
        let zoning = settings.zoning.as_ref();
        let contact = match zoning.is_some_and(Zoning::has_parts) && !system.contacts.is_empty() {
            true => {
                let mut names = vec![column(&["time"], "s")];
                for k in 0..system.contacts.len() {
                    names.extend(contact_columns(system, k));
                }
                Some(open(&folder.file(&contact_name)?, &names, 1)?)
            }
            false => None,
        };
        let probes = settings.probes.iter();
        Ok(Histories {
            file: Some(open(&path, columns, 0)?),
            contact,
            row: Vec::with_capacity(columns.len()),
            cells: probes.clone().map(|of| Cells::new(system, of)).collect(),
            points: probes.map(|of| points(system, of)).collect(),
            since: since.unwrap_or_default(),
            ..Histories::closed(settings, sensors)
        })
    }

    /// Without files: those that are there stay as they are. `sensors`: of each probe.
    pub(crate) fn closed(settings: &Settings, sensors: Vec<Vec<Sensor>>) -> Histories {
        let probes = settings.probes.iter().cloned();
        Histories {
            file: None,
            contact: None,
            links: settings.zoning.is_some(),
            probes: probes.zip(sensors).collect(),
            cells: Vec::new(),
            points: Vec::new(),
            row: Vec::new(),
            every: settings.history_every,
            since: Since::default(),
        }
    }

    /// Forces all rows to the disk; what the files go on from.
    pub(crate) fn keep(&mut self) -> Result<([u64; 2], &Since), Error> {
        let length = |file: &mut Option<History>| file.as_mut().map_or(Ok(0), History::sync);
        let lengths = [length(&mut self.file)?, length(&mut self.contact)?];
        Ok((lengths, &self.since))
    }

    /// Adds the rows of an accepted state.
    pub(crate) fn push(
        &mut self,
        system: &System,
        (state, report): (&State, &StepReport),
        (point, loads): (Option<&ContactPoint>, &[[f64; 3]]),
    ) -> Result<(), Error> {
        if !self.is_due(report) {
            return Ok(());
        }
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        let contacts = match self.every {
            Some(_) => &self.since.means,
            None => &report.contacts,
        };
        let (row, dim) = (&mut self.row, system.dim);
        let motion = &state.motion;
        row.clear();
        row.push(report.time.into());
        for (k, contact) in contacts.iter().enumerate() {
            put(system, (k, contact), row);
            if let Some(point) = point.filter(|point| point.contact == k) {
                for (_, sensor) in &point.sides {
                    let of = |order| Cell::from(sensor.of(system, motion, order));
                    row.extend(Order::ALL.map(of));
                }
            }
        }
        for discrete in system.bodies.iter().filter_map(|body| body.as_discrete()) {
            for direction in 0..discrete.told_directions() {
                let response = discrete.response(direction, [&motion.u, &motion.v]);
                row.extend(response.map(Cell::Number));
            }
        }
        for (bolt, kept) in bolts::each(system, state) {
            row.push(Cell::Number(bolt.tension(&motion.u, kept)));
        }
        for (probe, sensors) in &self.probes {
            let recorded = Order::ALL.into_iter().zip(probe.recorded());
            for (order, _) in recorded.filter(|(_, on)| *on) {
                let of = |sensor: &Sensor| Cell::from(sensor.of(system, motion, order));
                row.extend(sensors.iter().map(of));
            }
            if probe.absolute_acceleration {
                let frame = system.frame_acceleration(report.time, report.dt);
                let of = |(sensor, frame): (&Sensor, f64)| {
                    Cell::from(frame + sensor.of(system, motion, Order::Acceleration))
                };
                row.extend(sensors.iter().zip(frame).map(of));
            }
        }
        for ((probe, _), cells) in self.probes.iter().zip(&self.cells) {
            cells.push((system, probe), state, row);
        }
        for points in self.points.iter().flatten() {
            row.extend(at_points(system, points, state));
        }
        push_supports(system, report, row);
        for load in loads {
            row.extend(load[..dim].iter().copied().map(Cell::Number));
        }
        let balance = &report.balance;
        let energies = [
            balance.kinetic,
            balance.strain,
            balance.scheme_energy,
            balance.work_loads,
            balance.work_contact,
            balance.dissipation_scheme,
            balance.energy_residual,
        ];
        row.extend(energies.map(Cell::Number));
        row.extend(self.links.then_some(Cell::Number(balance.work_links)));
        if system.is_nonlinear() {
            let further = [
                balance.hardening,
                balance.work_supports,
                balance.dissipation_material,
                balance.dissipation_damping,
                balance.dissipation_friction,
                balance.work_obstacles,
                balance.dissipation_viscosity,
                balance.hourglass,
            ];
            row.extend(further.map(Cell::Number));
        }
        if deletes(system) {
            let deleted = state.ledger.deleted as f64;
            row.extend([balance.dissipation_deletion, deleted].map(Cell::Number));
        }
        let momenta = [&balance.momentum, &balance.momentum_residual];
        let linear = momenta.iter().flat_map(|momentum| &momentum.linear[..dim]);
        row.extend(linear.copied().map(Cell::Number));
        let turns = turns(system);
        let angular = momenta
            .iter()
            .flat_map(|momentum| &momentum.angular[turns.clone()]);
        row.extend(angular.copied().map(Cell::Number));
        row.push(Cell::Number(report.passes as f64));
        file.push(row)?;
        let Some(file) = &mut self.contact else {
            return Ok(());
        };
        for (end, _, contacts) in report.parts() {
            row.clear();
            row.push(end.into());
            for (k, contact) in contacts.iter().enumerate() {
                put(system, (k, contact), row);
            }
            file.push(row)?;
        }
        Ok(())
    }

    /// Whether a row is due; gathers the contacts for it. Forces of a row are means since the one before, so that their sum times
    /// the time between rows is the impulse.
    fn is_due(&mut self, report: &StepReport) -> bool {
        let since = &mut self.since;
        let Some(every) = self.every else {
            since.last = Some(report.time);
            return true;
        };
        let fresh = since.gathered == 0.0;
        since
            .means
            .resize(report.contacts.len(), ContactReport::default());
        since.gathered += report.dt;
        for (mean, contact) in since.means.iter_mut().zip(&report.contacts) {
            if fresh {
                *mean = ContactReport::default();
            }
            gather(mean, contact, report.dt);
        }
        let due = since
            .last
            .is_none_or(|last| report.time >= (last + every) * (1.0 - 1e-12));
        if !due {
            return false;
        }
        since.last = Some(report.time);
        let time = std::mem::take(&mut since.gathered);
        for mean in since.means.iter_mut().filter(|_| time > 0.0) {
            mean.force /= time;
            mean.friction /= time;
            mean.resultant = mean.resultant.map(|f| f / time);
            mean.moment = mean.moment.map(|m| m / time);
        }
        true
    }

    /// Forces all rows to the disk and closes the files. Nothing to do the second time.
    pub(crate) fn finish(&mut self) -> Result<(), Error> {
        let files = [self.file.take(), self.contact.take()];
        let closed = files.map(|file| file.map_or(Ok(()), History::finish));
        closed.into_iter().collect()
    }
}

/// Adds a step of `dt` (s) to what is gathered: forces times time, impulses, and the end of the step.
fn gather(mean: &mut ContactReport, contact: &ContactReport, dt: f64) {
    mean.force += dt * contact.force;
    mean.friction += dt * contact.friction;
    mean.impulsive += contact.impulsive;
    for (sum, force) in mean.resultant.iter_mut().zip(contact.resultant) {
        *sum += dt * force;
    }
    for (sum, moment) in mean.moment.iter_mut().zip(contact.moment) {
        *sum += dt * moment;
    }
    (mean.gap, mean.rate) = (contact.gap, contact.rate);
    mean.closed = mean.closed.max(contact.closed);
    mean.slipping = mean.slipping.max(contact.slipping);
}

/// Adds what a contact did to a row, in the order of [`contact_columns`].
fn put(system: &System, (k, contact): (usize, &ContactReport), row: &mut Vec<Cell>) {
    row.push(contact.force.into());
    row.extend(
        system
            .has_impulses(k)
            .then_some(Cell::Number(contact.impulsive)),
    );
    row.extend(
        contact.resultant[..system.dim]
            .iter()
            .copied()
            .map(Cell::Number),
    );
    if system.contacts[k].moment.is_some() {
        row.extend(moments(system).map(|i| Cell::Number(contact.moment[i])));
    }
    // the gap of what faces nothing does not exist
    row.push(Some(contact.gap).filter(|gap| *gap != f64::INFINITY).into());
    row.extend([contact.rate, contact.closed as f64].map(Cell::Number));
    if system.contacts[k].friction.acts() {
        row.extend([contact.friction, contact.slipping as f64].map(Cell::Number));
    }
}

/// The contact points at the nodes of a probe that follows them, each with the part of its force there.
fn points(system: &System, probe: &Probe) -> Option<Vec<(usize, f64)>> {
    if !probe.contact {
        return None;
    }
    let nodes = probe.nodes.iter();
    let nodes: BTreeSet<u32> = nodes
        .map(|(node, _)| system.number[*node as usize])
        .collect();
    let all = system.contacts.iter().flat_map(|contact| &contact.points);
    let parts = all.enumerate().map(|(number, point)| {
        let own = point.carriers().filter(|(node, _)| nodes.contains(node));
        (number, own.map(|(_, weight)| weight).sum())
    });
    Some(parts.filter(|(_, weight)| *weight > 0.0).collect())
}

/// Force, pressure and least gap of contact points.
fn at_points(system: &System, points: &[(usize, f64)], state: &State) -> [Cell<'static>; 3] {
    let interface = &state.interface;
    let (mut force, mut area, mut gap) = (0.0, 0.0, f64::INFINITY);
    for &(number, weight) in points {
        let (contact, own) = system.point(number);
        force += weight * interface.force[number];
        // nodes stand for the whole surface
        if !contact.points[own].stands_between() {
            area += weight * contact.points[own].area;
        }
        gap = gap.min(interface.gap[number]);
    }
    let pressure = (area > 0.0).then_some(force / area);
    // the gap of what faces nothing does not exist
    let gap = Some(gap).filter(|gap| *gap != f64::INFINITY);
    [Cell::Number(force), pressure.into(), gap.into()]
}

/// Adds the forces and moments of the supports; nothing is known of them before the first step.
fn push_supports(system: &System, report: &StepReport, row: &mut Vec<Cell>) {
    for support in 0..system.supports.len() {
        let told = report.supports.get(support);
        let force = |i: usize| Cell::from(told.map(|r| r.linear[i]));
        let moment = |i: usize| Cell::from(told.map(|r| r.angular[i]));
        row.extend((0..system.dim).map(force));
        row.extend(moments(system).map(moment));
    }
}
