//! The modes of a case.

use std::path::{Path, PathBuf};

use carom_output::{Folder, table::Table};
use carom_reduction::Modes;
use carom_studies::modes::ModeSet;

use crate::lower::Built;

/// Why the modes of a case could not be had.
#[derive(Debug, thiserror::Error)]
pub enum ModesError {
    /// More modes were asked for than there are. Nothing was written.
    #[error(
        "--count {asked}: no part of the model has more than {exist} modes, as many as unknowns with mass that are not held"
    )]
    Count {
        /// The number asked for.
        asked: usize,
        /// The largest number that a part has.
        exist: usize,
    },
    /// They could not be computed.
    #[error(transparent)]
    Modes(#[from] carom_reduction::Error),
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] carom_output::Error),
}

/// What is shown of the modes of a case.
#[derive(Debug)]
pub struct Modal {
    /// Name, table and facts of each part.
    pub parts: Vec<(String, Table, Vec<String>)>,
    /// What was left out or linearised.
    pub notes: Vec<String>,
    /// The page.
    pub page: PathBuf,
}

/// Computes the lowest modes of each part of a case and writes them into a folder. `count`: how many, by default ten, or as many
/// as there are. `told`: called with the number of parts done, and of all.
///
/// # Errors
/// A count above what exists; modes that cannot be computed; files that cannot be written.
pub fn modes(
    built: &Built,
    (title, folder): (&str, &Path),
    count: Option<usize>,
    told: &mut dyn FnMut(usize, usize),
) -> Result<Modal, ModesError> {
    const COUNT: usize = 10;
    let system = &*built.system;
    let parts = carom_reduction::modes(system, count.unwrap_or(COUNT), told)?;
    let exist = parts.iter().map(Modes::existing).max().unwrap_or(0);
    if let Some(asked) = count.filter(|asked| *asked > exist) {
        return Err(ModesError::Count { asked, exist });
    }
    let notes = notes(built);
    let set = ModeSet {
        title,
        system,
        parts: &parts,
        notes: &notes,
    };
    let page = set.write(&mut Folder::create(folder)?)?;
    let shown = |part: &Modes| (set.name(part), set.table(part), set.facts(part));
    Ok(Modal {
        parts: parts.iter().map(shown).collect(),
        page,
        notes,
    })
}

/// What modes do not show of this case.
fn notes(built: &Built) -> Vec<String> {
    let system = &*built.system;
    let curved = system.bodies.iter().filter(|body| !body.is_linear());
    let curved: Vec<&str> = curved
        .filter(|body| body.as_rigid().is_none())
        .map(|body| body.name())
        .collect();
    let mut notes = Vec::new();
    if !curved.is_empty() {
        notes.push(format!(
            "Linearised about the undeformed state: {}.",
            curved.join(", ")
        ));
    }
    let linked = built
        .zoned
        .as_ref()
        .is_some_and(|zoned| !zoned.links.is_empty());
    if built.apart && linked {
        notes.push("Links between zones with unequal steps are left out.".to_owned());
    }
    notes
}
