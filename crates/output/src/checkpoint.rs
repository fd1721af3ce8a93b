//! The state of a run on disk: what `State` holds, with a head that tells whose it is and whether it is whole.
//!
//! One line of text, `carom-state 2 <case hash> <checksum>`, then the bytes of the state.

use std::path::Path;

use carom_dynamics::{State, System};

use crate::summary::hash_bytes;
use crate::{Error, atomic};

/// First word and version of the head.
const HEAD: &str = "carom-state 2";

/// Writes a state atomically. `case_hash`: [`hash`](crate::summary::hash) of the case file.
///
/// # Errors
/// [`Error::File`]; [`Error::Checkpoint`] if the state cannot be encoded.
pub fn write(path: &Path, case_hash: &str, state: &State) -> Result<(), Error> {
    let bytes = state.to_bytes().map_err(|cause| refused(path, cause))?;
    let head = format!("{HEAD} {case_hash} {}\n", hash_bytes(&bytes));
    atomic::write(path, |file| {
        file.write_all(head.as_bytes())?;
        file.write_all(&bytes)
    })
}

/// Reads back the state of a system built from the case with this hash.
///
/// # Errors
/// [`Error::File`]; [`Error::Checkpoint`] if the file is no state, was damaged, or belongs to another case.
pub fn read(path: &Path, case_hash: &str, system: &System) -> Result<State, Error> {
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
    State::from_bytes(system, bytes).map_err(|cause| refused(path, cause))
}

fn refused(path: &Path, cause: impl std::fmt::Display) -> Error {
    Error::Checkpoint {
        path: path.to_owned(),
        cause: cause.to_string(),
    }
}
