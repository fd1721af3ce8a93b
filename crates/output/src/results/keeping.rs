//! Checkpoints of a run and its results: what they hold, and how results go on from one.

use std::sync::Arc;
use std::time::{Duration, Instant as Clock};

use carom_dynamics::{LONGEST, Stepper, System};
use serde::Deserialize;

use super::due::Due;
use super::{
    Pieces, Results, bolts, columns, discrete, exact, fields, figures, histories, impacts,
    instants, loads, page, stills, stressed, support_peaks, totals,
};
use crate::checkpoint::{self, Checkpoint};
use crate::results::{Settings, Tables};
use crate::{Error, Folder};

/// What the results have gathered: of the files, and beside them.
#[derive(Deserialize)]
struct Gathered(Files, Beside);

/// Bytes of the list of files, histories, impacts, fields.
type Files = (u64, histories::Kept, impacts::Kept, Option<fields::Sent>);

/// Figures, kept instants with the largest stresses, instants of largest forces, springs and dashpots with bolts and supports, loads, spectra, filtered accelerations, series and statuses
/// of the page, errors against the exact solution, totals, wall time of the run.
#[derive(Deserialize)]
struct Beside(
    figures::Traces,
    (stills::Kept, stressed::Kept),
    Vec<instants::Instant>,
    (
        discrete::DiscretePeaks,
        bolts::BoltForces,
        support_peaks::SupportPeaks,
    ),
    Vec<loads::LoadTotals>,
    Vec<Vec<Vec<[f64; 2]>>>,
    (Vec<f64>, Vec<Vec<f64>>),
    page::series::Series,
    page::raster::RasterOf,
    Option<exact::Errors>,
    totals::Totals,
    Duration,
);

impl Pieces {
    /// Of a run that goes on from a checkpoint; none where there is nothing to write.
    ///
    /// # Errors
    /// [`Error::Checkpoint`].
    pub fn resume(
        settings: &Settings,
        system: Arc<System>,
        checkpoint: &Checkpoint,
    ) -> Result<Option<Pieces>, Error> {
        let Gathered((_, _, _, sent), _) = checkpoint.gathered()?;
        Ok(Pieces::with(settings, system, sent.unwrap_or_default()))
    }
}

impl Results {
    /// Opens the results of a run that goes on from a checkpoint: tables and lists are cut back to it, and what was written after it is
    /// removed. `run` of the same checkpoint is to be gone on with by [`carom_dynamics::go_on`].
    ///
    /// # Errors
    /// [`Error::Checkpoint`], [`Error::Cut`] if the folder has less than the checkpoint says; [`Error::File`].
    pub fn resume(
        mut folder: Folder,
        checkpoint: &Checkpoint,
        settings: Settings,
        system: Arc<System>,
    ) -> Result<Results, Error> {
        let Gathered((listed, histories, impacts, sent), beside) = checkpoint.gathered()?;
        is_of(&impacts, (&folder, &system))?;
        let [history, contact] = columns::files(&settings);
        let tables = [
            (history.as_str(), histories.0[0]),
            (contact.as_str(), histories.0[1]),
            (impacts::FILE, impacts.0),
        ];
        for (name, expected) in tables {
            let path = folder.path().join(name);
            let found = std::fs::metadata(&path).map_or(0, |data| data.len());
            if found < expected {
                return Err(Error::Cut {
                    path,
                    expected,
                    found,
                });
            }
        }
        folder.cut_back(listed)?;
        let tables = Tables::GoOn(histories, impacts, sent.unwrap_or_default());
        let mut results = Results::with((settings, system), folder, tables)?;
        results.recall(beside, checkpoint)?;
        Ok(results)
    }

    /// Opens the results of a run at a checkpoint to write its figures, report and summary anew. Tables and fields stay as they are,
    /// those after the checkpoint included, and no checkpoint is written. `run` of the same checkpoint is to be gone on with to no further
    /// time.
    ///
    /// # Errors
    /// [`Error::Checkpoint`]; [`Error::File`].
    pub fn review(
        mut folder: Folder,
        checkpoint: &Checkpoint,
        mut settings: Settings,
        system: Arc<System>,
    ) -> Result<Results, Error> {
        let Gathered((_, _, impacts, _), beside) = checkpoint.gathered()?;
        is_of(&impacts, (&folder, &system))?;
        let listed = folder.listed()?;
        folder.cut_back(listed)?;
        settings.fields = None;
        let tables = Tables::Closed(impacts.1);
        let mut results = Results::with((settings, system), folder, tables)?;
        results.recall(beside, checkpoint)?;
        Ok(results)
    }

    /// Whether what was gathered is of this run: what was written by it always is.
    fn takes(&self, beside: &Beside) -> bool {
        let Beside(
            traces,
            (kept, stressed),
            instants,
            (_, bolts, supports),
            loads,
            spectra,
            filtered,
            series,
            raster,
            _,
            totals,
            wall,
        ) = beside;
        self.curves.takes(traces)
            && self.stills.takes(&self.system, kept)
            && self.stressed.takes(&self.system, stressed)
            && self.instants.takes(&self.system, instants)
            && bolts.is_of(&self.system)
            && supports.is_of(self.system.supports.len())
            && [0, self.system.nonlinear.load_names.len()].contains(&loads.len())
            && self.spectra.takes(spectra)
            && self.filtered.takes(filtered)
            && self.series.takes(series)
            && self.raster.takes(raster)
            && totals.spent < LONGEST
            && *wall < LONGEST
    }

    /// Takes what was gathered until a checkpoint.
    fn recall(&mut self, beside: Beside, checkpoint: &Checkpoint) -> Result<(), Error> {
        if !self.takes(&beside) {
            return Err(checkpoint::of_another_run(self.folder.path()));
        }
        let Beside(
            traces,
            (kept, stressed),
            instants,
            (discrete, bolts, supports),
            loads,
            spectra,
            filtered,
            series,
            raster,
            errors,
            totals,
            wall,
        ) = beside;
        self.curves.go_on(traces);
        self.stills.go_on(kept);
        self.stressed.kept = stressed;
        self.instants.go_on(instants);
        self.discrete = discrete;
        self.bolts = bolts;
        self.supports = supports;
        self.loads.totals = loads;
        self.spectra.go_on(spectra);
        self.filtered.go_on(filtered);
        self.series.series = series;
        self.raster.go_on(raster);
        if let (Some(comparison), Some(errors)) = (&mut self.comparison, errors) {
            comparison.errors = errors;
        }
        self.totals = totals;
        self.earlier = wall;
        self.due = Due::from(checkpoint.head.time);
        Ok(())
    }

    /// Writes a checkpoint if one is due.
    pub(super) fn keep_if_due(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        let state = run.state();
        let is_due = self
            .due
            .take(&self.settings.checkpoints, state.time, self.system.dt);
        // what is due by the wall since it was asked for the state is due after the next step too
        match is_due && !run.report().partial {
            true => self.keep(run),
            false => Ok(()),
        }
    }

    /// Writes a checkpoint, unless there is one of this step.
    pub(super) fn keep(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        let state = run.state();
        if self.due.is_of(state.step) {
            return Ok(());
        }
        let begin = Clock::now();
        let fields = self.fields.as_mut().map(fields::FieldOutput::keep);
        let gathered = (
            self.folder.listed()?,
            self.histories.keep()?,
            self.impacts.keep()?,
            fields.transpose()?,
            self.curves.kept(),
            (self.stills.settled(&self.system), &self.stressed.kept),
            self.instants.kept(),
            (&self.discrete, &self.bolts, &self.supports),
            &self.loads.totals,
            self.spectra.kept(),
            self.filtered.kept(),
            &self.series.series,
            &self.raster,
            self.comparison.as_ref().map(|c| &c.errors),
            &self.totals,
            self.earlier + self.begin.elapsed(),
        );
        let refused = |cause: String| Error::Checkpoint {
            path: self.folder.path().join(checkpoint::name(0)),
            cause,
        };
        let encoded = |bytes: postcard::Result<Vec<u8>>| bytes.map_err(|e| refused(e.to_string()));
        let gathered = encoded(postcard::to_stdvec(&gathered))?;
        let costs = encoded(postcard::to_stdvec(&run.costs()))?;
        let saved = run.saved().map_err(|cause| refused(cause.to_string()))?;
        let settings = &self.settings.checkpoints;
        let bytes = checkpoint::write(
            self.folder.path(),
            settings.keep,
            (state.step, state.time),
            [settings.origin.as_bytes(), &saved, &costs, &gathered],
        )?;
        let spent = begin.elapsed();
        tracing::debug!(
            "checkpoint of step {}: {bytes} bytes in {spent:?}",
            state.step
        );
        self.due.written(state.step, spent);
        Ok(())
    }
}

/// Refuses what was told of impacts of other contacts.
fn is_of(impacts: &impacts::Kept, (folder, system): (&Folder, &System)) -> Result<(), Error> {
    match impacts.1.is_of(system.contacts.len()) {
        true => Ok(()),
        false => Err(checkpoint::of_another_run(folder.path())),
    }
}
