//! What a rank other than the first writes: its pieces of the fields.

use std::path::PathBuf;
use std::sync::Arc;

use carom_dynamics::{Observer, Scope, Stepper, System};

use crate::Error;
use crate::results::fields::Sent;
use crate::results::grids::Volume;
use crate::results::settings::{Fields, Settings};
use crate::results::snapshot::Snapshot;

/// The observer of a rank other than the first, which writes its pieces of the fields.
pub struct Pieces {
    folder: PathBuf,
    system: Arc<System>,
    fields: Fields,
    volume: Volume,
    sent: Sent,
    snapshot: Snapshot,
}

impl Pieces {
    /// Of a run that begins; none where there is nothing to write.
    pub fn create(settings: &Settings, system: Arc<System>) -> Option<Pieces> {
        Pieces::with(settings, system, Sent::default())
    }

    /// Of a run that goes on after what was sent.
    pub(super) fn with(settings: &Settings, system: Arc<System>, sent: Sent) -> Option<Pieces> {
        let fields = settings.fields.as_ref()?;
        let piece = settings.own_piece()?;
        Some(Pieces {
            folder: settings.folder.clone(),
            volume: Volume::of_piece(&system, piece),
            fields: fields.clone(),
            system,
            sent,
            snapshot: Snapshot::default(),
        })
    }

    fn write(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        let state = run.state();
        let name = self.sent.next(&self.system, Some(0));
        let path = self.folder.join(&name[0]);
        // the first rank may come to it later
        if let Some(fields) = path.parent() {
            std::fs::create_dir_all(fields).map_err(Error::file("create", fields))?;
        }
        self.snapshot.fill(&self.fields, state);
        self.sent.push(state.time, Some(0));
        self.volume
            .write(&path, &self.system, &self.fields, &self.snapshot)
    }
}

impl Observer for Pieces {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        let time = run.state().time;
        let due = self.sent.is_due(&self.fields, self.system.dt, time);
        self.sent.see(time);
        match due {
            true => self.write(run).map_err(Error::of_observer),
            false => Ok(()),
        }
    }

    fn finish(&mut self, run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        match self.sent.has(run.state().time) {
            true => Ok(()),
            false => self.write(run).map_err(Error::of_observer),
        }
    }

    fn looks(&self, _: &dyn Stepper) -> Scope {
        Scope::Watched
    }
}
