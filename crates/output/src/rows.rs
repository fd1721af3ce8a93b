//! A CSV file that grows by complete rows, compressed where its name ends with `.gz`.
//!
//! Rows are gathered in memory and appended in one piece. If an append fails half-way (disk full, file-size limit),
//! the file is cut back to the end of its last complete row, so that what is on the disk can always be read; the rows
//! not written stay in memory and the next flush tries them again.
//!
//! A compressed file is a sequence of gzip members (RFC 1952), one for each flush, with complete rows in each: it can be read up to its
//! last complete member whenever the run is cut, and be cut back to any of them. Where the disk is full the last members are small ones.

use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::write::GzEncoder;

use crate::{Error, atomic};

/// Rows are handed to the system when they fill this many bytes ...
const FLUSH_BYTES: usize = 64 * 1024;
/// ... those of a compressed file this many, since each piece is compressed by itself ...
const MEMBER_BYTES: usize = 1024 * 1024;
/// ... or when the last time is this long ago, so that a running case can be watched.
const FLUSH_TIME: Duration = Duration::from_secs(1);

/// A CSV file open for appending.
#[derive(Debug)]
pub struct Rows {
    path: PathBuf,
    file: File,
    columns: usize,
    compressed: bool,
    /// Length of the file, all of it complete rows.
    length: u64,
    pending: Vec<u8>,
    /// Length of each row in `pending`.
    row_lengths: Vec<usize>,
    flushed: Instant,
}

impl Rows {
    /// Creates the file, in the place of an existing one, and writes the line of column names.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::TwinColumns`] if a name occurs twice.
    pub fn create<S: AsRef<str>>(path: &Path, columns: &[S]) -> Result<Rows, Error> {
        unique(path, columns)?;
        let names: Vec<&str> = columns.iter().map(AsRef::as_ref).collect();
        let mut rows = Rows {
            path: path.to_owned(),
            file: atomic::create(path)?,
            columns: names.len(),
            compressed: is_compressed(path),
            length: 0,
            pending: Vec::new(),
            row_lengths: Vec::new(),
            flushed: Instant::now(),
        };
        rows.push(names.iter().map(|name| Cell::Text(name)))?;
        rows.flush()?;
        Ok(rows)
    }

    /// Opens the file of a run that goes on, and cuts it back to the length that it had at the checkpoint.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Cut`] if it is shorter.
    pub fn go_on(path: &Path, columns: usize, length: u64) -> Result<Rows, Error> {
        let mut file = File::options()
            .write(true)
            .open(path)
            .map_err(Error::file("open", path))?;
        let found = file.metadata().map_err(Error::file("open", path))?.len();
        if found < length {
            return Err(Error::Cut {
                path: path.to_owned(),
                expected: length,
                found,
            });
        }
        file.set_len(length)
            .and_then(|()| file.seek(SeekFrom::Start(length)))
            .map_err(Error::file("cut back", path))?;
        Ok(Rows {
            path: path.to_owned(),
            file,
            columns,
            compressed: is_compressed(path),
            length,
            pending: Vec::new(),
            row_lengths: Vec::new(),
            flushed: Instant::now(),
        })
    }

    /// Adds a row; it reaches the file at the next flush, which is never long after.
    ///
    /// # Errors
    /// [`Error::RowLength`] if there is not one value per column (nothing is added then); [`Error::File`] if the
    /// rows were due and could not be written.
    pub fn push<'a>(
        &mut self,
        cells: impl ExactSizeIterator<Item = Cell<'a>>,
    ) -> Result<(), Error> {
        if cells.len() != self.columns {
            return Err(Error::RowLength {
                path: self.path.clone(),
                expected: self.columns,
                found: cells.len(),
            });
        }
        let start = self.pending.len();
        for (column, cell) in cells.enumerate() {
            if column > 0 {
                self.pending.push(b',');
            }
            cell.put(&mut self.pending);
        }
        self.pending.push(b'\n');
        self.row_lengths.push(self.pending.len() - start);
        let most = if self.compressed {
            MEMBER_BYTES
        } else {
            FLUSH_BYTES
        };
        if self.pending.len() >= most || self.flushed.elapsed() >= FLUSH_TIME {
            self.flush()?;
        }
        Ok(())
    }

    /// Hands all rows to the operating system.
    ///
    /// # Errors
    /// [`Error::File`]; the file then ends with the last row that fitted whole.
    pub fn flush(&mut self) -> Result<(), Error> {
        self.flushed = Instant::now();
        if self.compressed {
            return self.flush_members();
        }
        let (written, outcome) = append(&mut self.file, &self.pending);
        let mut complete = 0;
        let mut rows = 0;
        while rows < self.row_lengths.len() && complete + self.row_lengths[rows] <= written {
            complete += self.row_lengths[rows];
            rows += 1;
        }
        self.length += complete as u64;
        self.pending.drain(..complete);
        self.row_lengths.drain(..rows);
        let Err(cause) = outcome else { return Ok(()) };
        // The first cause is the one to report; if cutting fails too, the file ends with a part of a row.
        if written > complete && self.file.set_len(self.length).is_ok() {
            let _ = self.file.seek(SeekFrom::Start(self.length));
        }
        Err(Error::file("write", &self.path)(cause))
    }

    /// Appends all rows as one member. Where the file system does not take it whole, as many rows as it takes, in members of
    /// half the rows, a quarter, and so on.
    fn flush_members(&mut self) -> Result<(), Error> {
        let mut rows = self.row_lengths.len();
        let mut first = None;
        while rows.min(self.row_lengths.len()) > 0 {
            rows = rows.min(self.row_lengths.len());
            if let Err(cause) = self.append_member(rows) {
                first.get_or_insert(cause);
                rows /= 2;
            }
        }
        first.map_or(Ok(()), Err)
    }

    /// Appends the first rows as one member, or nothing.
    fn append_member(&mut self, rows: usize) -> Result<(), Error> {
        let bytes = self.row_lengths[..rows].iter().sum();
        let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
        let member = encoder
            .write_all(&self.pending[..bytes])
            .and_then(|()| encoder.finish());
        let member = member.map_err(Error::file("write", &self.path))?;
        let (written, outcome) = append(&mut self.file, &member);
        let Err(cause) = outcome else {
            self.length += written as u64;
            self.pending.drain(..bytes);
            self.row_lengths.drain(..rows);
            return Ok(());
        };
        // The first cause is the one to report; if cutting fails too, the file ends with a part of a member.
        if written > 0 && self.file.set_len(self.length).is_ok() {
            let _ = self.file.seek(SeekFrom::Start(self.length));
        }
        Err(Error::file("write", &self.path)(cause))
    }

    /// Flushes and forces the file to the disk; its length.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn sync(&mut self) -> Result<u64, Error> {
        self.flush()?;
        let synced = self.file.sync_all();
        synced.map_err(Error::file("write", &self.path))?;
        Ok(self.length)
    }

    /// Forces all rows to the disk and closes the file.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn finish(mut self) -> Result<(), Error> {
        self.sync().map(drop)
    }
}

impl Drop for Rows {
    /// A run that ends by an error elsewhere still leaves its rows; whoever wants to know calls [`Rows::finish`].
    fn drop(&mut self) {
        let _ = self.flush();
    }
}

fn is_compressed(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "gz")
}

/// Refuses two columns of one name.
///
/// # Errors
/// [`Error::TwinColumns`].
pub(crate) fn unique<S: AsRef<str>>(path: &Path, columns: &[S]) -> Result<(), Error> {
    let mut names: Vec<&str> = columns.iter().map(AsRef::as_ref).collect();
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(Error::TwinColumns {
            path: path.to_owned(),
            name: pair[0].to_owned(),
        }),
        None => Ok(()),
    }
}

/// Appends bytes; says how many arrived even when it fails.
fn append(file: &mut File, bytes: &[u8]) -> (usize, io::Result<()>) {
    let mut written = 0;
    while written < bytes.len() {
        match file.write(&bytes[written..]) {
            Ok(0) => return (written, Err(io::ErrorKind::WriteZero.into())),
            Ok(count) => written += count,
            Err(cause) if cause.kind() == io::ErrorKind::Interrupted => {}
            Err(cause) => return (written, Err(cause)),
        }
    }
    (written, Ok(()))
}

/// One value of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// A number, written with the fewest digits that give it back exactly; `NaN`, `inf`, `-inf` as they are.
    Number(f64),
    /// Text, quoted where CSV needs it.
    Text(&'a str),
    /// Nothing: a value that does not exist (yet).
    Empty,
}

impl Cell<'_> {
    pub(crate) fn put(self, to: &mut Vec<u8>) {
        match self {
            // `Debug` switches to powers of ten for very small and very large numbers, `Display` does not.
            Cell::Number(value) => to.extend_from_slice(format!("{value:?}").as_bytes()),
            Cell::Text(text) if text.contains([',', '"', '\n', '\r']) => {
                to.push(b'"');
                to.extend_from_slice(text.replace('"', "\"\"").as_bytes());
                to.push(b'"');
            }
            Cell::Text(text) => to.extend_from_slice(text.as_bytes()),
            Cell::Empty => {}
        }
    }
}

impl From<f64> for Cell<'_> {
    fn from(value: f64) -> Self {
        Cell::Number(value)
    }
}

impl From<Option<f64>> for Cell<'_> {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Cell::Empty, Cell::Number)
    }
}
