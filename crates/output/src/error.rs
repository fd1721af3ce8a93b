//! Why an output could not be written.

use std::io;
use std::path::{Path, PathBuf};

use carom_elements::Kind;

/// Why an output could not be written. Each variant names the file or the datum and the cause.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refused: disk full, no permission, a folder standing where a file should be.
    #[error("cannot {action} '{path}': {source}", path = path.display())]
    File {
        /// What was tried, as a verb: `write`, `create`.
        action: &'static str,
        /// The file or folder meant, as the user knows it (never the name of a temporary file).
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// Something that is not a folder stands where the results folder should be.
    #[error("cannot create the results folder '{path}': a file of that name exists", path = path.display())]
    NotAFolder {
        /// Where the results folder should be.
        path: PathBuf,
    },
    /// The folder exists, holds files, and none of them says that it is a results folder: it is left alone.
    #[error("'{path}' holds files and is not a results folder of carom; choose another, or remove it", path = path.display())]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
    },
    /// The folder that a run should go on in has no list of results.
    #[error("'{path}' is not a results folder of carom", path = path.display())]
    NoResults {
        /// The folder.
        path: PathBuf,
    },
    /// Another run writes into the results folder.
    #[error("another run of carom writes into '{path}'; wait for its end, or choose another folder", path = path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A symbolic link stands inside the results folder where a file list or a subfolder should be.
    #[error("'{path}' is a symbolic link: nothing inside a results folder is written through one; remove it", path = path.display())]
    Link {
        /// The link.
        path: PathBuf,
    },
    /// A file name that would leave the results folder or cannot be kept in its list.
    #[error("'{name}' is not the name of a file inside the results folder")]
    FileName {
        /// The name as given.
        name: String,
    },
    /// A checkpoint that cannot be written or taken.
    #[error("the checkpoint '{path}': {cause}", path = path.display())]
    Checkpoint {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: String,
    },
    /// A file of an earlier part of the run that is shorter than it was at the checkpoint.
    #[error("'{path}' has {found} bytes, at the checkpoint it had {expected}; run the case again", path = path.display())]
    Cut {
        /// The file.
        path: PathBuf,
        /// Its length at the checkpoint.
        expected: u64,
        /// Its length now.
        found: u64,
    },
    /// Two columns of one table have the same name.
    #[error("two columns of '{path}' are called '{name}'", path = path.display())]
    TwinColumns {
        /// The table.
        path: PathBuf,
        /// The name that occurs twice.
        name: String,
    },
    /// A row has not as many values as the table has columns.
    #[error("a row of '{path}' has {found} values for {expected} columns", path = path.display())]
    RowLength {
        /// The table.
        path: PathBuf,
        /// Number of columns.
        expected: usize,
        /// Number of values.
        found: usize,
    },
    /// A field has not one value per point or per cell.
    #[error("field '{name}' has {found} values for {expected} {of}")]
    FieldLength {
        /// Name of the field.
        name: String,
        /// `points` or `cells`.
        of: &'static str,
        /// Number of points or cells.
        expected: usize,
        /// Number of values.
        found: usize,
    },
    /// Node numbers of a block that do not make whole cells.
    #[error("{found} node numbers do not make whole cells of kind {kind:?}")]
    Connectivity {
        /// Kind of the cells.
        kind: Kind,
        /// Number of node numbers.
        found: usize,
    },
    /// A cell names a point that does not exist.
    #[error("a cell of kind {kind:?} names point {node} of {points}")]
    MissingPoint {
        /// Kind of the cell.
        kind: Kind,
        /// The point named, counted from zero.
        node: u32,
        /// Number of points.
        points: usize,
    },
    /// A probe on a group without a node of a body.
    #[error("probe '{name}' follows no node of a body")]
    Probe {
        /// Name of the probe.
        name: String,
    },
    /// A figure or a page that cannot be made.
    #[error(transparent)]
    Page(#[from] carom_pages::Error),
    /// The thread that writes fields could not be started.
    #[error("cannot start the thread that writes fields: {0}")]
    Thread(#[source] io::Error),
    /// Another rank has not written its piece of the fields.
    #[error("the piece of the fields of another rank has not come: {}", path.display())]
    Piece {
        /// The file that is missing.
        path: PathBuf,
    },
    /// The thread that writes fields ended before its work.
    #[error("the thread that writes fields is gone")]
    Writer,
    /// The summary could not be put into JSON, or be read from it.
    #[error("summary: {0}")]
    Json(#[from] serde_json::Error),
}

impl Error {
    /// Wraps an error of the operating system: for `map_err`.
    pub(crate) fn file(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Error {
        move |source| Error::File {
            action,
            path: path.to_owned(),
            source,
        }
    }

    /// As the error of an observer of a run: for `map_err`.
    pub(crate) fn of_observer(self) -> carom_dynamics::Error {
        carom_dynamics::Error::Observer(Box::new(self))
    }
}
