//! Fields as VTU and PVD: copied by the run into one of two buffers, derived and written by the background thread.

use std::path::PathBuf;
use std::sync::Arc;

use carom_dynamics::{State, System};
use serde::{Deserialize, Serialize};

use crate::results::grids::{SurfaceGrid, Volume};
use crate::results::snapshot::Snapshot;
use crate::results::{Fields, Zoning};
use crate::writer::Writer;
use crate::{Collection, Error, Folder};

/// The run's side: when a state is due, and the buffers.
#[derive(Debug)]
pub(crate) struct FieldOutput {
    fields: Fields,
    writer: Writer<Snapshot>,
    sent: Sent,
    failed: bool,
}

/// What was sent to the thread so far.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Sent {
    /// Times of the states sent, s.
    times: Vec<f64>,
    /// Time of the last state seen, s.
    seen: f64,
}

/// Buffers of the thread.
const BUFFERS: usize = 2;

impl FieldOutput {
    /// Begins, or goes on after what was sent.
    pub(crate) fn create(
        folder: &mut Folder,
        system: &Arc<System>,
        (fields, zoning): (&Fields, Option<&Zoning>),
        sent: Sent,
    ) -> Result<FieldOutput, Error> {
        let instants = sent.times.iter().enumerate();
        let instants = instants.map(|(number, time)| (*time, names(system, number)));
        let instants: Vec<(f64, Vec<String>)> = instants.collect();
        let collection = Collection::go_on(&folder.file("fields.pvd")?, &instants)?;
        let mut files = Files {
            folder: folder.path().to_owned(),
            collection,
            fields: fields.clone(),
            bodies: Volume::new(system, zoning),
            surfaces: (0..system.contacts.len())
                .map(|contact| SurfaceGrid::new(system, contact))
                .collect(),
            system: Arc::clone(system),
        };
        Ok(FieldOutput {
            fields: fields.clone(),
            writer: Writer::start(vec![Snapshot::default(); BUFFERS], move |s| files.write(s))?,
            sent,
            failed: false,
        })
    }

    /// Waits until all that was sent is on the disk; what it was.
    pub(crate) fn keep(&mut self) -> Result<&Sent, Error> {
        self.writer.wait(BUFFERS)?;
        Ok(&self.sent)
    }

    /// Hands over the state if it is due.
    pub(crate) fn take(
        &mut self,
        folder: &mut Folder,
        system: &System,
        state: &State,
    ) -> Result<(), Error> {
        let due = self.is_due(system, state.time);
        self.sent.seen = state.time;
        let outcome = match due {
            true => self.send(folder, system, state),
            false => self.writer.check(),
        };
        self.failed |= outcome.is_err();
        outcome
    }

    /// Whether a state of this time (s) is due.
    pub(crate) fn is_due(&self, system: &System, time: f64) -> bool {
        // instants are sums of steps: a millionth of one is rounding
        let rounding = 1e-6 * system.dt;
        let number = |time: f64| ((time + rounding) / self.fields.every).floor();
        self.sent.times.is_empty() || number(time) > number(self.sent.seen)
    }

    /// Hands over the last state, unless it is there already, waits for the thread, and writes the files of all instants.
    pub(crate) fn finish(
        &mut self,
        folder: &mut Folder,
        system: &System,
        state: &State,
    ) -> Result<(), Error> {
        let sent = match self.failed || self.sent.times.last() == Some(&state.time) {
            true => Ok(()),
            false => self.send(folder, system, state),
        };
        sent.and(self.writer.finish())?;
        match self.fields.vtkhdf {
            true => self.write_whole(folder, system),
            false => Ok(()),
        }
    }

    /// Writes a file of all instants for the bodies and for each contact.
    #[cfg(feature = "hdf5")]
    fn write_whole(&self, folder: &mut Folder, system: &System) -> Result<(), Error> {
        let instants = self.sent.times.iter().enumerate();
        let instants: Vec<(f64, Vec<String>)> = instants
            .map(|(number, time)| (*time, names(system, number)))
            .collect();
        for (number, part) in parts(system).enumerate() {
            let path = folder.file(&format!("fields/{part}.vtkhdf"))?;
            let files = instants.iter();
            let files = files.map(|(time, names)| (*time, folder.path().join(&names[number])));
            crate::vtkhdf::write(&path, &files.collect::<Vec<_>>())?;
        }
        Ok(())
    }

    /// The case is refused before the run.
    #[cfg(not(feature = "hdf5"))]
    fn write_whole(&self, _: &mut Folder, _: &System) -> Result<(), Error> {
        Ok(())
    }

    fn send(&mut self, folder: &mut Folder, system: &System, state: &State) -> Result<(), Error> {
        let mut snapshot = self.writer.buffer()?;
        snapshot.names = names(system, self.sent.times.len());
        for name in &snapshot.names {
            folder.file(name)?;
        }
        snapshot.fill(&self.fields, state);
        snapshot.first = self.sent.times.is_empty();
        self.sent.times.push(state.time);
        self.writer.send(snapshot)
    }
}

/// Names of the files of one instant.
fn names(system: &System, number: usize) -> Vec<String> {
    parts(system)
        .map(|part| format!("fields/{part}-{number:06}.vtu"))
        .collect()
}

/// What has a file at each instant.
fn parts(system: &System) -> impl Iterator<Item = String> {
    let contacts = system.contacts.iter();
    let contacts = contacts.map(|contact| format!("contact-{}", contact.name));
    std::iter::once("bodies".to_owned()).chain(contacts)
}

/// The thread's side.
struct Files {
    folder: PathBuf,
    collection: Collection,
    fields: Fields,
    bodies: Volume,
    surfaces: Vec<SurfaceGrid>,
    system: Arc<System>,
}

impl Files {
    fn write(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        let (names, folder) = (&snapshot.names, &self.folder);
        if let Some(name) = names.first() {
            let path = folder.join(name);
            self.bodies
                .write(&path, &self.system, &self.fields, snapshot)?;
        }
        for (surface, name) in self.surfaces.iter().zip(names.iter().skip(1)) {
            surface.write(&folder.join(name), &self.system, snapshot)?;
        }
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        self.collection.add(snapshot.time, &names)
    }
}
