//! Checkpoints: all that a run goes on from, in a ring of files.
//!
//! A checkpoint is one file: a line `carom-checkpoint 21 <checksum>`, a line of JSON ([`Head`]), then the parts that the head
//! counts: the text that tells which case it is of, the state of the run, what it has cost, and what the results have gathered.
//! The checksum is that of everything after the first line. The newest one is `last.state`, those before it `earlier-1.state`,
//! `earlier-2.state`, .... A new one is forced to the disk before the others move by one place, and appears by a rename.

use std::io;
use std::path::{Path, PathBuf};

use carom_algebra::fingerprint::Fingerprint;
use serde::{Deserialize, Serialize};

use crate::{Error, atomic};

/// Folder of the checkpoints in the results folder.
pub const FOLDER: &str = "checkpoints";

/// First word and version of the format. Raise the version when the content of a state or of what results gather changes.
const FORMAT: &str = "carom-checkpoint 21";

/// Version of the program: another one may compute other bits.
const PROGRAM: &str = env!("CARGO_PKG_VERSION");

/// What a checkpoint says of itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// Version of the program that wrote it.
    pub program: String,
    /// Steps taken.
    pub step: u64,
    /// Simulated time, s.
    pub time: f64,
    /// Bytes of each part.
    pub parts: [usize; 4],
}

/// A checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// What it says of itself.
    pub head: Head,
    /// Which case it is of.
    pub origin: String,
    /// Bytes of the state ([`saved`](carom_dynamics::Stepper::saved)).
    pub state: Vec<u8>,
    /// Bytes of the costs of the run until then.
    pub(crate) costs: Vec<u8>,
    /// Bytes of what the results have gathered.
    pub(crate) gathered: Vec<u8>,
}

impl Checkpoint {
    /// What the run cost until then.
    ///
    /// # Errors
    /// [`Error::Checkpoint`], of a file whose checksum is right and content wrong.
    pub fn costs(&self) -> Result<carom_dynamics::Costs, Error> {
        let costs: carom_dynamics::Costs = decode(&self.costs)?;
        match costs.are_times() {
            true => Ok(costs),
            false => Err(refused(Path::new(FOLDER), "it has times that no run takes")),
        }
    }

    /// What the results have gathered.
    pub(crate) fn gathered<T: for<'de> Deserialize<'de>>(&self) -> Result<T, Error> {
        decode(&self.gathered)
    }
}

fn decode<T: for<'de> Deserialize<'de>>(bytes: &[u8]) -> Result<T, Error> {
    postcard::from_bytes(bytes).map_err(|cause| refused(Path::new(FOLDER), &cause.to_string()))
}

/// Name of a checkpoint in the results folder, the newest being 0.
pub fn name(place: usize) -> String {
    match place {
        0 => format!("{FOLDER}/last.state"),
        _ => format!("{FOLDER}/earlier-{place}.state"),
    }
}

/// Whether this is the name of a checkpoint that is not the newest.
pub(crate) fn is_earlier(file: &str) -> bool {
    file.starts_with(FOLDER) && file != name(0)
}

/// Writes a checkpoint as the newest of a ring of `keep`, in the results folder; returns its bytes.
///
/// # Errors
/// [`Error::File`]; those before are then untouched.
pub fn write(
    folder: &Path,
    keep: usize,
    (step, time): (u64, f64),
    parts: [&[u8]; 4],
) -> Result<u64, Error> {
    let head = Head {
        program: PROGRAM.to_owned(),
        step,
        time,
        parts: parts.map(<[u8]>::len),
    };
    let head = serde_json::to_string(&head)? + "\n";
    let checksum = parts.iter().fold(
        Fingerprint::default().bytes(head.as_bytes()),
        |sum, part| sum.bytes(part),
    );
    let first = format!("{FORMAT} {}\n", checksum.digits());
    atomic::write_after(
        &folder.join(name(0)),
        |file| {
            file.write_all(first.as_bytes())?;
            file.write_all(head.as_bytes())?;
            parts.iter().try_for_each(|part| file.write_all(part))
        },
        || shift(folder, keep),
    )?;
    let bytes = first.len() + head.len() + parts.iter().map(|part| part.len()).sum::<usize>();
    Ok(bytes as u64)
}

/// Moves the checkpoints by one place; the last one of the ring is replaced.
fn shift(folder: &Path, keep: usize) -> io::Result<()> {
    for place in (1..keep).rev() {
        match std::fs::rename(folder.join(name(place - 1)), folder.join(name(place))) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(cause),
            _ => {}
        }
    }
    Ok(())
}

/// The newest checkpoint in a results folder that can be used, and why newer ones cannot.
///
/// # Errors
/// [`Error::Checkpoint`] of the newest one if none can be used, or if there is none.
pub fn latest(folder: &Path) -> Result<(Checkpoint, Vec<Error>), Error> {
    let mut paths: Vec<PathBuf> = Vec::new();
    // a run that was killed while it moved them may have left a gap in their numbers
    if let Ok(entries) = std::fs::read_dir(folder.join(FOLDER)) {
        paths.extend(entries.flatten().map(|entry| entry.path()));
    }
    paths.retain(|path| path.extension().is_some_and(|end| end == "state"));
    let place = |path: &PathBuf| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let number = stem.strip_prefix("earlier-").unwrap_or("0");
        number.parse::<usize>().unwrap_or(usize::MAX)
    };
    paths.sort_by_key(place);
    let mut unusable = Vec::new();
    for path in &paths {
        match read(path) {
            Ok(checkpoint) => return Ok((checkpoint, unusable)),
            Err(error) => unusable.push(error),
        }
    }
    let none = "there is none: the run was cut before the first one; run the case again";
    let none = || refused(&folder.join(FOLDER), none);
    Err(unusable.into_iter().next().unwrap_or_else(none))
}

/// Reads a checkpoint.
///
/// # Errors
/// [`Error::File`]; [`Error::Checkpoint`] if the file is none, was damaged, or is of another version.
pub fn read(path: &Path) -> Result<Checkpoint, Error> {
    let content = std::fs::read(path).map_err(Error::file("read", path))?;
    let (first, rest) = line(&content);
    let first = String::from_utf8_lossy(first);
    let Some(checksum) = first.strip_prefix(FORMAT).and_then(|s| s.strip_prefix(' ')) else {
        let cause = match first.starts_with("carom-") {
            true => format!("it has another format than those of carom {PROGRAM}"),
            false => "it is no checkpoint of carom".to_owned(),
        };
        return Err(refused(path, &cause));
    };
    if checksum != Fingerprint::default().bytes(rest).digits() {
        return Err(refused(path, "it was damaged: its checksum differs"));
    }
    let (head, rest) = line(rest);
    let head: Head =
        serde_json::from_slice(head).map_err(|cause| refused(path, &cause.to_string()))?;
    if head.program != PROGRAM {
        let cause = format!(
            "it was written by carom {}; go on with that version, or run the case again",
            head.program
        );
        return Err(refused(path, &cause));
    }
    let mut rest = rest;
    let mut parts = head.parts.iter().map(|bytes| {
        let (part, others) = rest.split_at_checked(*bytes)?;
        rest = others;
        Some(part.to_vec())
    });
    let mut part = || {
        let next = parts.next().flatten();
        next.ok_or_else(|| refused(path, "it is cut short"))
    };
    Ok(Checkpoint {
        origin: String::from_utf8_lossy(&part()?).into_owned(),
        state: part()?,
        costs: part()?,
        gathered: part()?,
        head: head.clone(),
    })
}

/// A checkpoint whose content is not of the run in whose folder it is.
pub(crate) fn of_another_run(folder: &Path) -> Error {
    refused(
        &folder.join(FOLDER),
        "what the results had gathered belongs to another run",
    )
}

/// The first line without its end, and what follows it.
fn line(bytes: &[u8]) -> (&[u8], &[u8]) {
    let end = bytes.iter().position(|byte| *byte == b'\n');
    let end = end.unwrap_or(bytes.len());
    (&bytes[..end], bytes.get(end + 1..).unwrap_or(&[]))
}

fn refused(path: &Path, cause: &str) -> Error {
    Error::Checkpoint {
        path: path.to_owned(),
        cause: cause.to_owned(),
    }
}
