//! The table of impacts: one row from the first closing of a contact to the last release before a flight that lasts.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::Error;
use crate::rows::{Cell, Rows};

/// One impact: from the first closing of a contact to its last release before a flight that lasts ([`carom_dynamics::Impact`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImpactRow {
    /// Name of the contact.
    pub pair: String,
    /// Beginning of the first step with contact force, s.
    pub start: f64,
    /// From `start` to the release, s; `None` while still closed at the end of the run.
    pub duration: Option<f64>,
    /// Largest contact force of a single step, N. The raw peak does not converge with the mesh: read it beside
    /// `peak_mean_force`.
    pub peak_force: f64,
    /// Steps of the closed interval in which it is: below some ten, the peak is one of the step.
    pub peak_steps: u64,
    /// Largest mean of the contact force over a window of `window` seconds, N; `None` without a window.
    pub peak_mean_force: Option<f64>,
    /// Length of that window, s; zero of a secondary body without waves, which gives no time to take a mean over.
    pub window: f64,
    /// Impulse of the impact, N s.
    pub impulse: f64,
    /// Speed at which the two bodies near each other before the impact, m/s, positive: of the mean velocities (momentum /
    /// mass) of what no support holds; `None` where a side has several bodies, and of a body against itself.
    pub approach_speed: Option<f64>,
    /// Speed at which they part after it, m/s, positive when parting; `None` while still closed, and where links join
    /// further bodies to one of the two, whose motion it would leave out.
    pub rebound_speed: Option<f64>,
    /// Rebound over approach, from the momenta of the bodies before and after the impact; `None` with `rebound_speed`, and
    /// where it means nothing ([`carom_dynamics::Impact::restitution`]).
    pub restitution: Option<f64>,
    /// Kinetic energy of the approach, ½ m w² with w the approach speed and m the reduced mass of the two bodies
    /// (the mass of the one on an obstacle; without what supports hold and what links join to them), J; `None` with `approach_speed`.
    pub energy_given: Option<f64>,
    /// Most energy that the contact has taken up at one time, J.
    pub energy_taken: f64,
    /// Energy lost in the contact, minus the work of its forces, J, positive when lost.
    pub energy_lost: f64,
    /// The part of it that is lost in crush, J; zero of laws without memory.
    pub energy_crushed: f64,
    /// Energy that friction takes beside it, J: its work on what slides, which wears it off.
    #[serde(default)]
    pub friction_loss: f64,
    /// Intervals with a force: more than one where the contact opens and closes within the impact.
    pub intervals: u64,
    /// The part of the impulse that is in no force, N s: of a projection, or of another stage after a step.
    pub impulsive: f64,
}

/// Names of the columns of `impacts.csv`, with their units.
pub const COLUMNS: [&str; 18] = [
    "pair",
    "start_s",
    "duration_s",
    "peak_force_n",
    "peak_mean_force_n",
    "window_s",
    "impulse_n_s",
    "approach_speed_m_s",
    "rebound_speed_m_s",
    "restitution",
    "energy_given_j",
    "energy_taken_j",
    "energy_lost_j",
    "energy_crushed_j",
    "intervals",
    "impulsive_n_s",
    "peak_steps",
    "friction_loss_j",
];

/// The file `impacts.csv`, open for appending.
#[derive(Debug)]
pub struct ImpactTable {
    rows: Rows,
}

impl ImpactTable {
    /// Creates the file with its line of column names ([`COLUMNS`]).
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn create(path: &Path) -> Result<ImpactTable, Error> {
        Ok(ImpactTable {
            rows: Rows::create(path, &COLUMNS)?,
        })
    }

    /// Opens the table of a run that goes on, cut back to this length.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Cut`].
    pub fn go_on(path: &Path, length: u64) -> Result<ImpactTable, Error> {
        Ok(ImpactTable {
            rows: Rows::go_on(path, COLUMNS.len(), length)?,
        })
    }

    /// Forces all rows to the disk; the length of the file.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn sync(&mut self) -> Result<u64, Error> {
        self.rows.sync()
    }

    /// Adds an impact and hands it to the operating system at once: impacts are rare and worth keeping.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn push(&mut self, impact: &ImpactRow) -> Result<(), Error> {
        let cells = [
            Cell::Text(&impact.pair),
            Cell::Number(impact.start),
            impact.duration.into(),
            Cell::Number(impact.peak_force),
            impact.peak_mean_force.into(),
            Cell::Number(impact.window),
            Cell::Number(impact.impulse),
            impact.approach_speed.into(),
            impact.rebound_speed.into(),
            impact.restitution.into(),
            impact.energy_given.into(),
            Cell::Number(impact.energy_taken),
            Cell::Number(impact.energy_lost),
            Cell::Number(impact.energy_crushed),
            Cell::Number(impact.intervals as f64),
            Cell::Number(impact.impulsive),
            Cell::Number(impact.peak_steps as f64),
            Cell::Number(impact.friction_loss),
        ];
        self.rows.push(cells.into_iter())?;
        self.rows.flush()
    }

    /// Closes the table, forced to the disk.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn finish(self) -> Result<(), Error> {
        self.rows.finish()
    }
}
