//! The observer that turns a run into its results folder.
//!
//! [`Results`] is told of every accepted state: it adds a row to `histories.csv`, a row to `impacts.csv` when an
//! impact ends, hands fields to the background thread, and keeps what the figures need in bounded memory. After the
//! run, whether it came to its end or not, [`Results::conclude`] writes the figures, `report.html` and
//! `summary.json`. It is configured by plain data; the case file is not known here.
//!
//! What a run writes is complete whenever it is cut: tables grow by whole rows, all other files appear by one rename.

mod cells;
mod conclusion;
mod costs;
pub(crate) mod exact;
mod fields;
mod figures;
mod film;
mod histories;
mod impacts;
mod lines;
pub(crate) mod sensor;
pub(crate) mod trace;
mod zoning;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use carom_dynamics::{
    Control, Costs, Ledger, Observer, Records, State, StepReport, Stepper, System,
};
use carom_exact::Solution;

use crate::summary::{self, Summary, Zones};
use crate::{Error, Folder, atomic, checkpoint};
use exact::Comparison;
use fields::FieldOutput;
use figures::Curves;
use film::Film;
use histories::Histories;
use impacts::Impacts;
use sensor::ContactPoint;

pub use zoning::Zoning;

/// What is written and where.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The results folder; an earlier one is replaced, any other folder refused ([`Folder::create`]).
    pub folder: PathBuf,
    /// Title of the case.
    pub title: String,
    /// Text of the case file: copied to `case.toml` and shown in the report.
    pub case_text: String,
    /// Version of the program.
    pub version: String,
    /// Time scheme with its parameters, as text: `theta, theta = 0.5`.
    pub scheme: String,
    /// Histories of groups of nodes.
    pub probes: Vec<Probe>,
    /// Fields for ParaView; `None`: none.
    pub fields: Option<Fields>,
    /// Exact solution to compare with.
    pub reference: Option<Reference>,
    /// Zones and weights of a model in zones.
    pub zoning: Option<Zoning>,
    /// Warnings of the check.
    pub warnings: Vec<String>,
}

/// A history of the mean motion of a group of nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name as in the case file.
    pub name: String,
    /// Nodes of the mesh, each with its weight in the mean, relative to the others; nodes that no body uses are left out.
    pub nodes: Vec<(u32, f64)>,
    /// Whether the displacement is written, m.
    pub displacement: bool,
    /// Whether the velocity is written, m/s.
    pub velocity: bool,
    /// Whether the acceleration is written, m/s².
    pub acceleration: bool,
}

impl Probe {
    /// Displacement, velocity, acceleration.
    fn recorded(&self) -> [bool; 3] {
        [self.displacement, self.velocity, self.acceleration]
    }
}

/// Fields on the bodies, chosen here, and on the contact surfaces, always.
#[derive(Clone, Debug, PartialEq)]
pub struct Fields {
    /// Time between two of them, s. The first is at the start, the last at the end, whatever this is.
    pub every: f64,
    /// Displacement of the nodes, m.
    pub displacement: bool,
    /// Velocity of the nodes, m/s.
    pub velocity: bool,
    /// Acceleration of the nodes, m/s².
    pub acceleration: bool,
    /// Mean stress of the cells and its von Mises equivalent, Pa.
    pub stress: bool,
}

/// An exact solution of a contact, from time 0 of the run.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Name as in the case file: `two-bars`.
    pub name: String,
    /// The solution; it is compared as far as it goes.
    pub solution: Solution,
    /// Index of the contact in the system.
    pub contact: usize,
    /// Unit vector from the secondary to the primary side.
    pub axis: [f64; 3],
}

/// How the run ended.
#[derive(Clone, Debug)]
pub struct Ending<'a> {
    /// Why it did not come to its end time, in a sentence; `None` if it did.
    pub unfinished: Option<String>,
    /// What the steps cost.
    pub costs: &'a Costs,
    /// What the zones of a run in zones did.
    pub zones: Option<Zones>,
    /// Wall time of the whole run, reading and factorisation included.
    pub wall: Duration,
}

/// The observer that writes the results folder.
///
/// Create it after [`carom_dynamics::Driver::new`], so that a model which cannot start leaves no folder.
#[derive(Debug)]
pub struct Results {
    system: Arc<System>,
    settings: Settings,
    folder: Folder,
    point: Option<ContactPoint>,
    histories: Histories,
    impacts: Impacts,
    fields: Option<FieldOutput>,
    curves: Curves,
    film: Film,
    comparison: Option<Comparison>,
    totals: Totals,
    /// Mean velocity of the bodies at the start, m/s.
    start: Vec<[f64; 3]>,
    last: Last,
}

/// What is counted over the steps.
#[derive(Debug, Default)]
struct Totals {
    /// Passes of the status loop.
    passes: u64,
    /// Most passes in a step.
    most_passes: u64,
    /// Accepted states with an energy or a force that is not finite.
    not_finite: u64,
    /// Time spent in here by the run itself.
    spent: Duration,
}

/// The last accepted state, as far as the summary needs it.
#[derive(Debug, Default)]
struct Last {
    step: u64,
    time: f64,
    control: Control,
    ledger: Ledger,
    records: Records,
    /// Largest residual of the momentum that contacts give to a body, and largest momentum of one, N s; `None` where nothing moves.
    exchange: Option<[f64; 2]>,
    /// Mean velocity of the bodies, m/s.
    velocities: Vec<[f64; 3]>,
    /// Whether each contact has a force.
    closed: Vec<bool>,
}

impl Results {
    /// Creates the folder, copies the case into it and opens the tables.
    ///
    /// # Errors
    /// A probe without a node of a body; two columns of one name; a folder that cannot be made or is not a results
    /// folder. Only the last may leave something on the disk.
    pub fn create(settings: Settings, system: Arc<System>) -> Result<Results, Error> {
        let point = sensor::contact_point(&system, settings.reference.as_ref(), None);
        let probes = settings.probes.iter();
        let probes = probes.map(|probe| sensor::of_probe(&system, probe));
        let probes = probes.collect::<Result<Vec<_>, Error>>()?;
        let columns = histories::columns(&system, &settings, point.as_ref())?;
        // what is wrong with the settings is found before there is a folder
        let mut folder = Folder::create(&settings.folder)?;
        atomic::write_text(&folder.file("case.toml")?, &settings.case_text)?;
        let curves = Curves::new(&system, &settings, point.as_ref(), &probes);
        let histories = Histories::create(&mut folder, &columns, (&system, &settings), probes)?;
        let impacts = Impacts::create(&mut folder, &system, settings.zoning.as_ref())?;
        let fields = match &settings.fields {
            Some(fields) => Some(FieldOutput::create(
                &mut folder,
                &system,
                (fields, settings.zoning.as_ref()),
            )?),
            None => None,
        };
        Ok(Results {
            curves,
            film: Film::default(),
            comparison: settings.reference.clone().map(Comparison::new),
            totals: Totals::default(),
            start: velocities(&system, &system.initial_velocity),
            last: Last::default(),
            system,
            settings,
            folder,
            point,
            histories,
            impacts,
            fields,
        })
    }

    fn take(&mut self, state: &State, report: &StepReport) -> Result<(), Error> {
        self.totals.passes += report.passes as u64;
        self.totals.most_passes = self.totals.most_passes.max(report.passes as u64);
        let force = |contact: &carom_dynamics::ContactReport| contact.force;
        let forces: f64 = report.contacts.iter().map(force).sum();
        let finite = (report.balance.energy_residual + forces).is_finite();
        self.totals.not_finite += u64::from(!finite);
        let point = self.point.as_ref();
        self.histories.push(&self.system, (state, report), point)?;
        self.impacts.take(&self.system, state, report)?;
        self.curves.push(state, report);
        self.film.push(&self.system, state);
        if let (Some(comparison), Some(point)) = (&mut self.comparison, point) {
            comparison.push(point, state, report);
        }
        match &mut self.fields {
            Some(fields) => fields.take(&mut self.folder, &self.system, state),
            None => Ok(()),
        }
    }

    /// Whether the run has taken static steps alone: its time is none.
    fn is_static(&self) -> bool {
        let steps = self.system.static_steps();
        steps > 0 && self.last.step <= steps
    }

    /// Ends the tables and the thread, and keeps what the summary needs. Everything is tried, whatever fails.
    fn end(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        let state = run.state();
        let forces = |k: usize| {
            let points = self.system.first_point[k]..self.system.first_point[k + 1];
            state.interface.force[points].iter().any(|f| *f != 0.0)
        };
        self.last = Last {
            step: state.step,
            time: state.time,
            control: state.control,
            ledger: state.ledger.clone(),
            records: state.records.clone(),
            exchange: (state.exchange.largest_momentum > 0.0).then_some([
                state.exchange.largest_residual,
                state.exchange.largest_momentum,
            ]),
            velocities: velocities(&self.system, &state.motion.v),
            closed: (0..self.system.contacts.len()).map(forces).collect(),
        };
        self.film.finish(&self.system, state);
        let outcomes = [
            self.histories.finish(),
            self.impacts.finish(&self.system, state),
            match &mut self.fields {
                Some(fields) => fields.finish(&mut self.folder, &self.system, state),
                None => Ok(()),
            },
            self.keep(run),
        ];
        outcomes.into_iter().collect()
    }

    /// The last good state on disk.
    fn keep(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        let path = self.folder.file("checkpoints/last.state")?;
        let bytes = run.saved().map_err(|cause| Error::Checkpoint {
            path: path.clone(),
            cause: cause.to_string(),
        })?;
        checkpoint::write(&path, &summary::hash(&self.settings.case_text), &bytes)
    }

    /// Writes one more file into the folder, atomically.
    ///
    /// # Errors
    /// A name that leaves the folder; the file cannot be written.
    pub fn attach(&mut self, name: &str, text: &str) -> Result<(), Error> {
        atomic::write_text(&self.folder.file(name)?, text)
    }

    /// Writes figures, report and summary, after the run has told its end to the observers
    /// ([`carom_dynamics::march`] does, after a failed run too).
    ///
    /// # Errors
    /// The first file that could not be written; the others are written nevertheless.
    pub fn conclude(self, ending: &Ending) -> Result<Summary, Error> {
        conclusion::conclude(self, ending)
    }
}

impl Observer for Results {
    fn accepted(
        &mut self,
        _system: &System,
        state: &State,
        report: &StepReport,
    ) -> Result<(), carom_dynamics::Error> {
        let begin = Instant::now();
        let outcome = self.take(state, report);
        self.totals.spent += begin.elapsed();
        outcome.map_err(observer)
    }

    fn finish(&mut self, run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        let begin = Instant::now();
        let outcome = self.end(run);
        self.totals.spent += begin.elapsed();
        outcome.map_err(observer)
    }
}

/// Mean velocity of each body, m/s.
fn velocities(system: &System, v: &[f64]) -> Vec<[f64; 3]> {
    let bodies = 0..system.bodies.len();
    bodies.map(|body| system.mean_velocity(body, v)).collect()
}

fn observer(cause: Error) -> carom_dynamics::Error {
    carom_dynamics::Error::Observer(Box::new(cause))
}
