//! Fields as VTU and PVD: copied by the run into one of two buffers, derived and written by the background thread.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use carom_dynamics::{State, System};
use serde::{Deserialize, Serialize};

use crate::results::grids::{SurfaceGrid, Volume};
use crate::results::snapshot::Snapshot;
use crate::results::{Fields, Settings, pieces};
use crate::writer::Writer;
use crate::{Collection, Error, Folder};

/// The run's side: when a state is due, and the buffers.
#[derive(Debug)]
pub(crate) struct FieldOutput {
    fields: Fields,
    /// In how many pieces the fields are; none where they are whole.
    pieces: Option<usize>,
    writer: Writer<Snapshot>,
    sent: Sent,
    failed: bool,
}

/// What was sent to the thread so far.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Sent {
    /// Times of the states sent, s, and in how many pieces each is; none where it is whole.
    times: Vec<(f64, Option<usize>)>,
    /// Time of the last state seen, s.
    seen: f64,
}

impl Sent {
    /// Whether a state of this time (s) is due.
    pub(super) fn is_due(&self, fields: &Fields, dt: f64, time: f64) -> bool {
        // instants are sums of steps: a millionth of one is rounding
        let rounding = 1e-6 * dt;
        let number = |time: f64| ((time + rounding) / fields.every).floor();
        self.times.is_empty() || number(time) > number(self.seen)
    }

    /// That a state of this time (s) was seen.
    pub(super) fn see(&mut self, time: f64) {
        self.seen = time;
    }

    /// Whether the last state sent is of this time, s.
    pub(super) fn has(&self, time: f64) -> bool {
        self.times.last().is_some_and(|(last, _)| *last == time)
    }

    /// That the state of this time (s) is sent.
    pub(super) fn push(&mut self, time: f64, pieces: Option<usize>) {
        self.times.push((time, pieces));
    }

    /// Names of the files of the instant that is sent next.
    pub(super) fn next(&self, system: &System, pieces: Option<usize>) -> Vec<String> {
        names(system, self.times.len(), pieces)
    }

    /// Times (s) of the instants, and the names of their files.
    fn instants(&self, system: &System) -> Vec<(f64, Vec<String>)> {
        let instants = self.times.iter().enumerate();
        instants
            .map(|(number, (time, pieces))| (*time, names(system, number, *pieces)))
            .collect()
    }
}

/// Buffers of the thread.
const BUFFERS: usize = 2;

impl FieldOutput {
    /// Begins, or goes on after what was sent.
    pub(crate) fn create(
        folder: &mut Folder,
        system: &Arc<System>,
        (settings, fields): (&Settings, &Fields),
        sent: Sent,
    ) -> Result<FieldOutput, Error> {
        let instants = sent.instants(system);
        let collection = Collection::go_on(&folder.file("fields.pvd")?, &instants)?;
        let mut files = Files {
            folder: folder.path().to_owned(),
            collection,
            fields: fields.clone(),
            bodies: match settings.own_piece() {
                Some(piece) => Volume::of_piece(system, piece),
                None => Volume::new(system, settings.zoning.as_ref()),
            },
            surfaces: (0..system.contacts.len())
                .map(|contact| SurfaceGrid::new(system, contact))
                .collect(),
            system: Arc::clone(system),
        };
        Ok(FieldOutput {
            fields: fields.clone(),
            pieces: settings.own_piece().map(|piece| piece.ranks),
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
        self.sent.see(state.time);
        let outcome = match due {
            true => self.send(folder, system, state),
            false => self.writer.check(),
        };
        self.failed |= outcome.is_err();
        outcome
    }

    /// Whether a state of this time (s) is due.
    fn is_due(&self, system: &System, time: f64) -> bool {
        self.sent.is_due(&self.fields, system.dt, time)
    }

    /// Whether the first of several ranks needs all of a state of this time (s).
    pub(crate) fn wants_all(&self, system: &System, time: f64) -> bool {
        self.pieces.is_none() && self.is_due(system, time)
    }

    /// Hands over the last state, unless it is there already, waits for the thread, and writes the files of all instants.
    pub(crate) fn finish(
        &mut self,
        folder: &mut Folder,
        system: &System,
        state: &State,
    ) -> Result<(), Error> {
        let sent = match self.failed || self.sent.has(state.time) {
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
        let instants = self.sent.instants(system);
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
        snapshot.names = self.sent.next(system, self.pieces);
        for name in &snapshot.names {
            folder.file(name)?;
        }
        for rank in 0..self.pieces.unwrap_or(0) {
            let piece = pieces::path(Path::new(&snapshot.names[0]), rank);
            folder.file(&piece.to_string_lossy())?;
        }
        snapshot.fill(&self.fields, state);
        snapshot.first = self.sent.times.is_empty();
        self.sent.push(state.time, self.pieces);
        self.writer.send(snapshot)
    }
}

/// Names of the files of one instant; that of the bodies lists their pieces, if there are some.
fn names(system: &System, number: usize, pieces: Option<usize>) -> Vec<String> {
    let ending = |part: usize| match (part, pieces) {
        (0, Some(_)) => "pvtu",
        _ => "vtu",
    };
    let parts = parts(system).enumerate();
    parts
        .map(|(k, part)| format!("fields/{part}-{number:06}.{}", ending(k)))
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
