//! ParaView's collection file: which field file belongs to which instant.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use carom_pages::escape;

use crate::{Error, atomic};

/// A PVD collection. The file is rewritten whole at each addition, so that it names exactly the field files which
/// are complete, whenever the run is cut. (60 bytes an entry: cheap beside the field file itself.)
#[derive(Debug)]
pub struct Collection {
    path: PathBuf,
    entries: String,
}

impl Collection {
    /// An empty collection, written at once.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn create(path: &Path) -> Result<Collection, Error> {
        Collection::go_on(path, &[])
    }

    /// The collection of a run that goes on, with what it has: times (s), and the files of each, as in [`Collection::add`].
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn go_on(path: &Path, instants: &[(f64, Vec<String>)]) -> Result<Collection, Error> {
        let mut collection = Collection {
            path: path.to_owned(),
            entries: String::new(),
        };
        for (time, parts) in instants {
            let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
            collection.append(*time, &parts);
        }
        collection.write()?;
        Ok(collection)
    }

    /// Adds field files of one instant: `time` in s, and the files relative to the folder of the collection, one per
    /// part (bodies, contact surfaces). The files must be complete already.
    ///
    /// # Errors
    /// [`Error::File`]; the collection on the disk is then the one before.
    pub fn add(&mut self, time: f64, parts: &[&str]) -> Result<(), Error> {
        self.append(time, parts);
        self.write()
    }

    fn append(&mut self, time: f64, parts: &[&str]) {
        for (part, file) in parts.iter().enumerate() {
            let file = escape(file);
            // Writing to a String cannot fail.
            let _ = writeln!(
                self.entries,
                r#"    <DataSet timestep="{time:?}" part="{part}" file="{file}"/>"#
            );
        }
    }

    fn write(&self) -> Result<(), Error> {
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
             <Collection>\n{}  </Collection>\n</VTKFile>\n",
            self.entries
        );
        atomic::write_text(&self.path, &text)
    }
}
