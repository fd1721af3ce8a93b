//! The row of `histories.csv` that every accepted state adds.

use carom_dynamics::{State, StepReport, System};

use crate::history::column;
use crate::results::sensor::{COMPONENTS, ContactPoint, Sensor};
use crate::results::{Probe, Settings};
use crate::rows::unique;
use crate::{Error, Folder, History};

/// Its name.
const FILE: &str = "histories.csv";

/// Names of a motion with its unit, in the order displacement, velocity, acceleration.
const MOTIONS: [(&str, &str); 3] = [
    ("displacement", "m"),
    ("velocity", "m/s"),
    ("acceleration", "m/s²"),
];

/// The file with what its rows need.
#[derive(Debug)]
pub(crate) struct Histories {
    file: Option<History>,
    probes: Vec<([bool; 3], Vec<Sensor>)>,
    row: Vec<f64>,
}

impl Histories {
    /// Creates the file; `columns`: of [`columns()`]; `sensors`: of each probe.
    pub(crate) fn create(
        folder: &mut Folder,
        columns: &[String],
        probes: &[Probe],
        sensors: Vec<Vec<Sensor>>,
    ) -> Result<Histories, Error> {
        let path = folder.file(FILE)?;
        let recorded = probes.iter().map(Probe::recorded);
        Ok(Histories {
            file: Some(History::create(&path, columns)?),
            probes: recorded.zip(sensors).collect(),
            row: Vec::with_capacity(columns.len()),
        })
    }

    /// Adds the row of an accepted state.
    pub(crate) fn push(
        &mut self,
        system: &System,
        (state, report): (&State, &StepReport),
        point: Option<&ContactPoint>,
    ) -> Result<(), Error> {
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        let (row, dim) = (&mut self.row, system.dim);
        let motion = &state.motion;
        let vectors = [&motion.u, &motion.v, &motion.a];
        row.clear();
        row.push(report.time);
        for (k, contact) in report.contacts.iter().enumerate() {
            row.push(contact.force);
            row.extend(&contact.resultant[..dim]);
            row.extend([contact.gap, contact.rate, contact.closed as f64]);
            if let Some(point) = point.filter(|point| point.contact == k) {
                for (_, sensor) in &point.sides {
                    row.extend(vectors.map(|vector| sensor.of(vector)));
                }
            }
        }
        for (recorded, sensors) in &self.probes {
            for (vector, _) in vectors.iter().zip(recorded).filter(|(_, on)| **on) {
                row.extend(sensors.iter().map(|sensor| sensor.of(vector)));
            }
        }
        let balance = &report.balance;
        row.extend([
            balance.kinetic,
            balance.strain,
            balance.scheme_energy,
            balance.work_loads,
            balance.work_contact,
            balance.dissipation_scheme,
            balance.energy_residual,
        ]);
        row.extend(&balance.momentum.linear[..dim]);
        row.extend(&balance.momentum_residual.linear[..dim]);
        row.push(report.passes as f64);
        file.push(row)
    }

    /// Forces all rows to the disk and closes the file. Nothing to do the second time.
    pub(crate) fn finish(&mut self) -> Result<(), Error> {
        self.file.take().map_or(Ok(()), History::finish)
    }
}

/// Names of the columns.
///
/// # Errors
/// [`Error::TwinColumns`]: two probes, say, whose names differ by a capital only.
pub(crate) fn columns(
    system: &System,
    settings: &Settings,
    point: Option<&ContactPoint>,
) -> Result<Vec<String>, Error> {
    let components = &COMPONENTS[..system.dim];
    let mut names = vec![column(&["time"], "s")];
    for (k, contact) in system.contacts.iter().enumerate() {
        let mut add = |what: &[&str], unit| {
            let path = [&["contact", contact.name.as_str()], what].concat();
            names.push(column(&path, unit));
        };
        add(&["force"], "N");
        for i in components {
            add(&[&format!("resultant {i}")], "N");
        }
        add(&["gap"], "m");
        add(&["gap rate"], "m/s");
        add(&["closed points"], "");
        if let Some(point) = point.filter(|point| point.contact == k) {
            for side in &["secondary", "primary"][..point.sides.len()] {
                for (motion, unit) in MOTIONS {
                    add(&[side, motion], unit);
                }
            }
        }
    }
    for probe in &settings.probes {
        for ((motion, unit), _) in MOTIONS.iter().zip(probe.recorded()).filter(|(_, on)| *on) {
            let of = |i| column(&["probe", &probe.name, &format!("{motion} {i}")], unit);
            names.extend(components.iter().map(of));
        }
    }
    let energies = [
        ["energy", "kinetic"],
        ["energy", "strain"],
        ["energy", "scheme"],
        ["work", "loads"],
        ["work", "contact"],
        ["dissipation", "scheme"],
        ["energy", "residual"],
    ];
    names.extend(energies.map(|path| column(&path, "J")));
    names.extend(components.iter().map(|i| column(&["momentum", i], "N s")));
    let residual = |i: &&str| column(&["momentum", &format!("residual {i}")], "N s");
    names.extend(components.iter().map(residual));
    names.push(column(&["status", "passes"], ""));
    unique(&settings.folder.join(FILE), &names)?;
    Ok(names)
}
