//! The state of a run on disk: its bytes, with a head that tells whose they are and whether they are whole.
//!
//! One line of text, `carom-state 2 <case hash> <checksum>`, then the bytes that the run goes on from: those of
//! `State`, or of all zones.

use std::path::Path;

use crate::summary::hash_bytes;
use crate::{Error, atomic};

/// First word and version of the head.
const HEAD: &str = "carom-state 2";

/// Writes the bytes of a state ([`saved`](carom_dynamics::Stepper::saved)) atomically. `case_hash`: [`hash`](crate::summary::hash) of the case file.
///
/// # Errors
/// [`Error::File`].
pub fn write(path: &Path, case_hash: &str, bytes: &[u8]) -> Result<(), Error> {
    let head = format!("{HEAD} {case_hash} {}\n", hash_bytes(bytes));
    atomic::write(path, |file| {
        file.write_all(head.as_bytes())?;
        file.write_all(bytes)
    })
}

/// Reads back the bytes of the state of a run of the case with this hash.
///
/// # Errors
/// [`Error::File`]; [`Error::Checkpoint`] if the file is no state, was damaged, or belongs to another case.
pub fn read(path: &Path, case_hash: &str) -> Result<Vec<u8>, Error> {
    let content = std::fs::read(path).map_err(Error::file("read", path))?;
    let line = content
        .iter()
        .position(|byte| *byte == b'\n')
        .unwrap_or(content.len());
    let head = String::from_utf8_lossy(&content[..line]);
    let words: Vec<&str> = head
        .strip_prefix(HEAD)
        .unwrap_or("")
        .split_whitespace()
        .collect();
    let [case, checksum] = words[..] else {
        return Err(refused(path, "it is no state of this version of carom"));
    };
    let bytes = content.get(line + 1..).unwrap_or(&[]);
    if checksum != hash_bytes(bytes) {
        return Err(refused(path, "it was damaged: its checksum differs"));
    }
    if case != case_hash {
        return Err(refused(path, "it belongs to another case file"));
    }
    Ok(bytes.to_vec())
}

fn refused(path: &Path, cause: &str) -> Error {
    Error::Checkpoint {
        path: path.to_owned(),
        cause: cause.to_owned(),
    }
}
