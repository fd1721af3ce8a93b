//! The observer that turns a run into its results folder.
//!
//! [`Results`] is told of every accepted state: it adds a row to `histories.csv`, a row to `impacts.csv` when an
//! impact ends, hands fields to the background thread, and keeps what the figures need in bounded memory. After the
//! run, whether it came to its end or not, [`Results::conclude`] writes the figures, `report.html` and
//! `summary.json`. It is configured by plain data; the case file is not known here.
//!
//! What a run writes is complete whenever it is cut: tables grow by whole rows, all other files appear by one rename.

mod allowables;
mod beams;
mod bolts;
mod cells;
mod columns;
mod conclusion;
mod contacts;
mod costs;
mod derived;
mod discrete;
mod due;
pub mod exact;
mod fields;
mod figures;
mod film;
mod filtered;
mod grids;
mod histories;
mod impacts;
pub(crate) mod inspect;
mod instants;
mod keeping;
mod largest;
mod lines;
mod loads;
mod names;
pub mod outlines;
pub(crate) mod page;
mod pieces;
mod principal;
mod probed;
mod rank_pieces;
mod reduced;
pub mod sensor;
mod settings;
mod signs;
mod snapshot;
mod spectra;
pub(crate) mod stills;
mod stressed;
mod support_peaks;
mod totals;
pub mod trace;
mod zoning;

use std::sync::Arc;
use std::time::{Duration, Instant};

use carom_dynamics::{Observer, Scope, State, StepReport, Stepper, System, Watched};

use crate::{Error, Folder, atomic, checkpoint};
use bolts::BoltForces;
use discrete::DiscretePeaks;
use due::Due;
use exact::Comparison;
use fields::FieldOutput;
use figures::Curves;
use filtered::Filtered;
use histories::Histories;
use impacts::Impacts;
pub use inspect::model_picture;
use instants::Instants;
use loads::Loads;
pub use names::{Quantity, columns_with_units, quantities};
pub use page::quality::{BodyQuality, qualities};
use page::raster::RasterOf;
use page::series::SeriesOf;
pub use page::tiles::Tile;
pub use pieces::Piece;
pub use rank_pieces::Pieces;
use sensor::ContactPoint;
pub use settings::{
    AllowableSettings, Bearer, Checkpoints, Ending, Fields, LevelSettings, Probe, Reference,
    Settings, Spectrum,
};
use spectra::Spectra;
use stills::Stills;
use stressed::Stressed;
use support_peaks::SupportPeaks;
use totals::{Last, Totals};
pub use zoning::Zoning;

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
    stills: Stills,
    stressed: Stressed,
    series: SeriesOf,
    raster: RasterOf,
    instants: Instants,
    discrete: DiscretePeaks,
    bolts: BoltForces,
    supports: SupportPeaks,
    loads: Loads,
    spectra: Spectra,
    filtered: Filtered,
    comparison: Option<Comparison>,
    totals: Totals,
    /// Mean velocity of the bodies at the start, m/s.
    start: Vec<[f64; 3]>,
    last: Last,
    due: Due,
    /// Whether an accepted state has not been taken whole: no checkpoint is written any more.
    broken: bool,
    /// Whether tables and checkpoints stay as they are ([`Results::review`]).
    reviews: bool,
    /// When this part of the run began, and the wall time of those before.
    begin: Instant,
    earlier: Duration,
}

/// What is done with the tables of the folder.
enum Tables {
    /// They are made.
    New,
    /// Those of a run that goes on are appended to, and so are the fields.
    GoOn(histories::Kept, impacts::Kept, fields::Sent),
    /// They stay as they are.
    Closed(impacts::Told),
}

impl Results {
    /// Creates the folder, copies the case into it and opens the tables.
    ///
    /// # Errors
    /// A probe without a node of a body; two columns of one name; a folder that cannot be made or is not a results
    /// folder. Only the last may leave something on the disk.
    pub fn create(settings: Settings, system: Arc<System>) -> Result<Results, Error> {
        let point = sensor::contact_point(&system, settings.reference.as_ref(), None);
        for probe in &settings.probes {
            sensor::of_probe(&system, probe)?;
        }
        columns::columns(&system, &settings, point.as_ref())?;
        // what is wrong with the settings is found before there is a folder
        let folder = Folder::create(&settings.folder)?;
        Results::with((settings, system), folder, Tables::New)
    }

    /// Opens the tables; writes the case into the folder, unless they are closed.
    fn with(
        (settings, system): (Settings, Arc<System>),
        mut folder: Folder,
        tables: Tables,
    ) -> Result<Results, Error> {
        let point = sensor::contact_point(&system, settings.reference.as_ref(), None);
        let probes = settings.probes.iter();
        let probes = probes.map(|probe| sensor::of_probe(&system, probe));
        let probes = probes.collect::<Result<Vec<_>, Error>>()?;
        let columns = columns::columns(&system, &settings, point.as_ref())?;
        let reviews = matches!(tables, Tables::Closed(_));
        if !reviews {
            atomic::write_text(&folder.file("case.toml")?, &settings.case_text)?;
        }
        for place in 0..settings.checkpoints.keep {
            folder.file(&checkpoint::name(place))?;
        }
        let curves = Curves::new(&system, &settings, point.as_ref(), &probes);
        let spectra = Spectra::new(&settings, &probes);
        let filtered = Filtered::new(&system, &settings, &probes);
        let series = SeriesOf::new(&system, &probes);
        let beside = (&*system, &settings);
        let (histories, impacts, sent) = match tables {
            Tables::New => (
                Histories::create(&mut folder, &columns, beside, (probes, None))?,
                Impacts::create(&mut folder, &system, settings.zoning.as_ref())?,
                fields::Sent::default(),
            ),
            Tables::GoOn(kept, told, sent) => (
                Histories::create(&mut folder, &columns, beside, (probes, Some(kept)))?,
                Impacts::go_on(&mut folder, told)?,
                sent,
            ),
            Tables::Closed(told) => (
                Histories::closed(&settings, probes),
                Impacts::closed(told),
                fields::Sent::default(),
            ),
        };
        let fields = match &settings.fields {
            Some(fields) => Some(FieldOutput::create(
                &mut folder,
                &system,
                (&settings, fields),
                sent,
            )?),
            None => None,
        };
        Ok(Results {
            curves,
            stills: Stills::new(&system, settings.end),
            stressed: Stressed::new(&system),
            series,
            raster: RasterOf::new(&system, settings.end),
            instants: Instants::new(&system, &settings.levels),
            discrete: DiscretePeaks::default(),
            bolts: BoltForces::default(),
            supports: SupportPeaks::default(),
            loads: Loads::default(),
            spectra,
            filtered,
            comparison: settings.reference.clone().map(Comparison::new),
            totals: Totals::default(),
            start: velocities(&system, &system.initial.velocity),
            last: Last::default(),
            due: Due::from(0.0),
            broken: false,
            reviews,
            begin: Instant::now(),
            earlier: Duration::ZERO,
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
        self.totals.notice(report);
        let point = self.point.as_ref();
        self.loads.push(&self.system, state, report);
        let beside = (point, &self.loads.now[..]);
        self.histories.push(&self.system, (state, report), beside)?;
        self.impacts.take(&self.system, state, report)?;
        self.curves.push(&self.system, state, report);
        self.stills.push(&self.system, state, report);
        if !report.partial {
            self.stressed.push(&self.system, state);
        }
        self.series
            .push(&self.system, (state, report), &self.impacts.told.contacts);
        self.series.push_loads(report.time, &self.loads.now);
        self.raster.push(&self.system, state, report);
        if !report.partial {
            self.instants.push(&self.system, state, report);
        }
        self.discrete.push(&self.system, state);
        self.bolts.push(&self.system, state);
        self.supports.push(report);
        self.spectra.push(&self.system, state, report);
        self.filtered.push(&self.system, state, report);
        if let (Some(comparison), Some(point)) = (&mut self.comparison, point) {
            comparison.push((&self.system, point), state, report);
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
        // before the last rows and fields, which a run that goes on has not
        let kept = match self.broken || self.reviews {
            true => Ok(()),
            false => self.keep(run),
        };
        let forces = |k: usize| {
            let points = self.system.points_of(k);
            state.interface.force[points].iter().any(|f| *f != 0.0)
        };
        let crush = |k: usize| {
            let points = self.system.points_of(k);
            let law = &self.system.contacts[k].law;
            let own = state.interface.crush[points]
                .iter()
                .map(|deepest| law.stays(*deepest));
            own.fold(0.0, f64::max)
        };
        self.last = Last {
            step: state.step,
            time: state.time,
            control: state.control,
            ledger: state.ledger.clone(),
            assemblies: state.assemblies.clone(),
            records: state.records.clone(),
            exchange: (state.exchange.largest_momentum > 0.0).then_some([
                state.exchange.largest_residual,
                state.exchange.largest_momentum,
            ]),
            velocities: velocities(&self.system, &state.motion.v),
            crossings: run
                .certificate()
                .map(|certificate| certificate.findings(state)),
            closed: (0..self.system.contacts.len()).map(forces).collect(),
            crushes: (0..self.system.contacts.len()).map(crush).collect(),
        };
        self.stills.finish(&self.system, state);
        let outcomes = [
            self.histories.finish(),
            self.impacts.finish(&self.system, state),
            match &mut self.fields {
                Some(fields) => fields.finish(&mut self.folder, &self.system, state),
                None => Ok(()),
            },
            kept,
        ];
        outcomes.into_iter().collect()
    }

    /// Writes one more file into the folder, atomically.
    ///
    /// # Errors
    /// A name that leaves the folder; the file cannot be written.
    pub fn attach(&mut self, name: &str, text: &str) -> Result<(), Error> {
        atomic::write_text(&self.folder.file(name)?, text)
    }
}

/// What the results follow from step to step: the motion of the nodes of probes and of the contact point that is drawn, and the statuses of
/// the points in the picture of statuses.
///
/// # Errors
/// A probe without a node of a body.
pub fn watched(settings: &Settings, system: &System) -> Result<Watched, Error> {
    let point = sensor::contact_point(system, settings.reference.as_ref(), None);
    let sides = point.iter().flat_map(|point| &point.sides);
    let mut nodes: Vec<u32> = sides.flat_map(|(_, sensor)| sensor.nodes()).collect();
    for probe in &settings.probes {
        let sensors = sensor::of_probe(system, probe)?;
        nodes.extend(sensors.iter().flat_map(sensor::Sensor::nodes));
        let of_cells = probe
            .cells()
            .flat_map(|cell| system.mesh.element_nodes(cell));
        nodes.extend(of_cells.map(|&node| system.number[node as usize]));
    }
    nodes.retain(|node| *node != u32::MAX);
    nodes.sort_unstable();
    nodes.dedup();
    let contacts = 0..system.contacts.len();
    let points = contacts.flat_map(|contact| page::raster::points(system, contact));
    Ok(Watched {
        nodes,
        points: points.map(|(_, point)| point as u32).collect(),
    })
}

impl Observer for Results {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        let begin = Instant::now();
        let taken = self.take(run.state(), run.report());
        self.broken |= taken.is_err();
        let outcome = taken.and_then(|()| self.keep_if_due(run));
        self.totals.spent += begin.elapsed();
        outcome.map_err(Error::of_observer)
    }

    fn looks(&self, run: &dyn Stepper) -> Scope {
        let (time, report) = (run.state().time, run.report());
        let fields = self.fields.as_ref();
        // the stress of a cell is a function of its history
        let mut probes = self.settings.probes.iter();
        let cells = probes.any(|probe| probe.cells().next().is_some());
        let all = fields.is_some_and(|fields| fields.wants_all(&self.system, time))
            || self.stills.wants(time, report).contains(&true)
            || self.stressed.wants(run.state().step)
            || self.instants.wants(report)
            || self
                .due
                .is_due(&self.settings.checkpoints, time, self.system.dt)
            || cells && !run.state().motion.history.is_empty();
        match all {
            true => Scope::All,
            false if self.raster.wants(report) => Scope::Points,
            false => Scope::Watched,
        }
    }

    fn finish(&mut self, run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        let begin = Instant::now();
        let outcome = self.end(run);
        self.totals.spent += begin.elapsed();
        outcome.map_err(Error::of_observer)
    }
}

/// Mean velocity of each body, m/s.
fn velocities(system: &System, v: &[f64]) -> Vec<[f64; 3]> {
    let bodies = 0..system.bodies.len();
    bodies.map(|body| system.mean_velocity(body, v)).collect()
}
