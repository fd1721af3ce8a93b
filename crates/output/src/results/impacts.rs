//! The table of impacts, and the peaks of the mean force.

use carom_dynamics::{Impact, State, StepReport, System};
use serde::{Deserialize, Serialize};

use crate::results::Zoning;
use crate::summary::{PeakMoment, PeakResultant};
use crate::window::PeakOfMean;
use crate::{Error, Folder, ImpactRow, ImpactTable};

/// The window of the mean force, as a part of the time that a wave takes along the secondary body.
const WINDOW: f64 = 0.1;

pub(super) const FILE: &str = "impacts.csv";

/// Most impacts that the report shows.
pub(crate) const SHOWN: usize = 100;

/// The file with what its rows need.
#[derive(Debug)]
pub(crate) struct Impacts {
    file: Option<ImpactTable>,
    /// All impacts, once the run has ended.
    pub(crate) all: Vec<Impact>,
    pub(crate) told: Told,
}

/// What was told of impacts so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Told {
    /// Ended impacts already written.
    written: usize,
    /// The first [`SHOWN`] rows.
    pub(crate) rows: Vec<ImpactRow>,
    /// By contact.
    pub(crate) contacts: Vec<ContactTotals>,
}

/// Length of the file, and what was told.
pub(crate) type Kept = (u64, Told);

/// What is gathered of a contact beside the records of the state.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct ContactTotals {
    /// Mean of the force.
    pub(crate) mean: PeakOfMean,
    /// Length of its window, s.
    pub(crate) window: f64,
    /// Whether links join further bodies to one of its sides: the mean velocities of impacts are without them.
    pub(crate) of_parts: bool,
    /// Time of the steps with a force, s.
    pub(crate) closed: f64,
    /// Largest friction force of a step, N.
    pub(crate) peak_friction: f64,
    /// Force at the end of the static stage, N; `None` without one.
    pub(crate) preload: Option<f64>,
    /// Largest force as a vector.
    pub(crate) resultant: Option<PeakResultant>,
    /// Largest moment about the point that the contact names.
    pub(crate) moment: Option<PeakMoment>,
}

impl ContactTotals {
    /// Keeps the force on the secondary body if it is the largest so far.
    fn follow_resultant(&mut self, force: [f64; 3], time: f64) {
        let magnitude = force.iter().map(|f| f * f).sum::<f64>().sqrt();
        if magnitude > self.resultant.map_or(0.0, |peak| peak.magnitude) {
            self.resultant = Some(PeakResultant {
                magnitude,
                force,
                time,
            });
        }
    }

    /// Keeps the moment on the secondary body about a point if it is the largest so far.
    fn follow_moment(&mut self, about: [f64; 3], moment: [f64; 3], time: f64) {
        let magnitude = moment.iter().map(|m| m * m).sum::<f64>().sqrt();
        if magnitude > self.moment.map_or(0.0, |peak| peak.magnitude) {
            self.moment = Some(PeakMoment {
                magnitude,
                moment,
                about,
                time,
            });
        }
    }
}

impl Told {
    /// Whether it is of so many contacts.
    pub(crate) fn is_of(&self, contacts: usize) -> bool {
        self.contacts.len() == contacts && self.rows.len() <= SHOWN
    }
}

impl Impacts {
    pub(crate) fn create(
        folder: &mut Folder,
        system: &System,
        zoning: Option<&Zoning>,
    ) -> Result<Impacts, Error> {
        let totals = |contact| {
            // of the model alone, so that runs with different steps can be compared
            let window = mean_window(system, zoning, contact);
            ContactTotals {
                mean: PeakOfMean::new(window),
                window,
                of_parts: zoning.is_some_and(|zoning| {
                    let mut bodies = system.contacts[contact].bodies.iter();
                    bodies.any(|body| zoning.is_part(*body))
                }),
                closed: 0.0,
                peak_friction: 0.0,
                preload: None,
                resultant: None,
                moment: None,
            }
        };
        Ok(Impacts {
            file: Some(ImpactTable::create(&folder.file(FILE)?)?),
            all: Vec::new(),
            told: Told {
                contacts: (0..system.contacts.len()).map(totals).collect(),
                ..Told::default()
            },
        })
    }

    /// Forces the file to the disk; its length, and what was told.
    pub(crate) fn keep(&mut self) -> Result<(u64, &Told), Error> {
        let length = self.file.as_mut().map_or(Ok(0), ImpactTable::sync)?;
        Ok((length, &self.told))
    }

    /// Goes on from a length of the file and what was told.
    pub(crate) fn go_on(folder: &mut Folder, (length, told): Kept) -> Result<Impacts, Error> {
        Ok(Impacts {
            file: Some(ImpactTable::go_on(&folder.file(FILE)?, length)?),
            all: Vec::new(),
            told,
        })
    }

    /// Goes on from what was told, without a file: the one that is there stays as it is.
    pub(crate) fn closed(told: Told) -> Impacts {
        Impacts {
            file: None,
            all: Vec::new(),
            told,
        }
    }

    /// Adds the forces of a step, and the rows of the impacts that ended with it.
    pub(crate) fn take(
        &mut self,
        system: &System,
        state: &State,
        report: &StepReport,
    ) -> Result<(), Error> {
        if report.step > 0 && report.step == system.static_steps() {
            for (totals, contact) in self.told.contacts.iter_mut().zip(&report.contacts) {
                totals.preload = Some(contact.force);
            }
        }
        // forces of static steps have a size, but no duration
        let takes_time = report.step > system.static_steps();
        for (time, dt, contacts) in report.parts().filter(|_| report.step > 0) {
            let contacts = system.contacts.iter().zip(contacts);
            for (totals, (pair, contact)) in self.told.contacts.iter_mut().zip(contacts) {
                totals.follow_resultant(contact.resultant, time);
                if let Some(about) = &pair.moment {
                    totals.follow_moment(about.point, contact.moment, time);
                }
                totals.peak_friction = totals.peak_friction.max(contact.friction);
                if !takes_time {
                    continue;
                }
                if totals.window > 0.0 {
                    totals.mean.push(dt, contact.force);
                }
                if contact.closed > 0 {
                    totals.closed += dt;
                }
            }
        }
        let ended = &state.records.impacts;
        while let Some(impact) = ended.get(self.told.written) {
            self.told.written += 1;
            self.push(system, impact)?;
        }
        Ok(())
    }

    /// Adds the impacts that still go on, or whose flight does not last yet, and closes the file. Nothing to do the second time.
    pub(crate) fn finish(&mut self, system: &System, state: &State) -> Result<(), Error> {
        let all = state.impacts(system);
        for impact in all.iter().skip(self.told.written) {
            self.push(system, impact)?;
        }
        self.told.written = all.len();
        self.all = all;
        self.file.take().map_or(Ok(()), ImpactTable::finish)
    }

    fn push(&mut self, system: &System, impact: &Impact) -> Result<(), Error> {
        let totals = &mut self.told.contacts[impact.contact as usize];
        let peak_mean_force = (totals.window > 0.0).then(|| totals.mean.take());
        let pair = &system.contacts[impact.contact as usize];
        let are_two = Some(pair.secondary_body) != pair.primary_body && !pair.is_of_many;
        let of_two = |value: f64| are_two.then_some(value);
        let over = |value: f64| (!impact.unfinished).then_some(value);
        let parting = |value: f64| over(value).and_then(of_two).filter(|_| !totals.of_parts);
        let row = ImpactRow {
            pair: system.contacts[impact.contact as usize].name.clone(),
            start: impact.start,
            duration: over(impact.duration),
            peak_force: impact.peak_force,
            peak_steps: impact.peak_steps,
            peak_mean_force,
            window: totals.window,
            impulse: impact.impulse,
            approach_speed: of_two(impact.approach),
            rebound_speed: parting(impact.rebound),
            restitution: impact.restitution.and_then(parting),
            energy_given: of_two(impact.energy_given),
            energy_taken: impact.energy_taken,
            energy_lost: impact.energy_lost,
            energy_crushed: impact.energy_crushed,
            friction_loss: impact.friction_loss,
            intervals: impact.intervals,
            impulsive: impact.impulsive,
        };
        let file = self.file.as_mut();
        let outcome = file.map_or(Ok(()), |file| file.push(&row));
        if self.told.rows.len() < SHOWN {
            self.told.rows.push(row);
        }
        outcome
    }
}

/// A tenth of the time that a wave takes along the secondary body (the diagonal of its box), s: longer than the
/// oscillations behind a front, which are a matter of the mesh, and shorter than the impact. Bodies joined by links are one.
fn mean_window(system: &System, zoning: Option<&Zoning>, contact: usize) -> f64 {
    let body = system.contacts[contact].secondary_body;
    let own = [body];
    let bodies = zoning.map_or(&own[..], |zoning| &zoning.joined[body]);
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let nodes = bodies.iter().flat_map(|body| &system.body_masses[*body]);
    for (node, _) in nodes {
        let x = system.x[*node as usize];
        for i in 0..3 {
            low[i] = low[i].min(x[i]);
            high[i] = high[i].max(x[i]);
        }
    }
    let diagonal = (0..3).map(|i| (high[i] - low[i]).powi(2)).sum::<f64>();
    // a body without waves has no front
    let speed = system.bodies[body].wave_speed();
    speed.map_or(0.0, |speed| WINDOW * diagonal.sqrt() / speed)
}
