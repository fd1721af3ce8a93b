//! Fields of a run on several ranks, each of which writes its own elements.
//!
//! A piece is complete when its file is there, since files appear by one rename. The first rank lists the pieces of an instant once all of
//! them are, so that what is listed can be read, and a checkpoint has the fields up to it.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::vtu::{self, Grid};
use crate::{Error, atomic};

/// Elements that one of several ranks writes.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// This rank.
    pub rank: usize,
    /// Number of all.
    pub ranks: usize,
    /// Places of its elements among those of each body, ascending.
    pub elements: Vec<Vec<u32>>,
}

/// How long the first rank waits for the piece of another, which is late by a step at most.
const PATIENCE: Duration = Duration::from_secs(60);

/// Time between two looks for a piece.
const PAUSE: Duration = Duration::from_millis(2);

/// The file of a rank of what is listed as `bodies-000000.pvtu`: `bodies-000000-rank-0.vtu`.
pub(super) fn path(listed: &Path, rank: usize) -> PathBuf {
    listed.with_file_name(name_of(listed, rank))
}

fn name_of(listed: &Path, rank: usize) -> String {
    let stem = listed.file_stem().unwrap_or_default().to_string_lossy();
    format!("{stem}-rank-{rank}.vtu")
}

/// Lists the pieces of an instant, with the fields of one of them, once all are there.
///
/// # Errors
/// A piece that has not come; [`Error::File`].
pub(super) fn join(listed: &Path, grid: &Grid, ranks: usize) -> Result<(), Error> {
    let begin = Instant::now();
    for rank in 1..ranks {
        let path = path(listed, rank);
        while !path.exists() {
            if begin.elapsed() > PATIENCE {
                return Err(Error::Piece { path });
            }
            std::thread::sleep(PAUSE);
        }
    }
    let names: Vec<String> = (0..ranks).map(|rank| name_of(listed, rank)).collect();
    atomic::write_text(listed, &vtu::list(grid, &names))
}
