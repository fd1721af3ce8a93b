//! The results folder: which files in it are ours.
//!
//! The folder keeps a list of what the run wrote, in [`LIST`]. A later run of the same case finds the list, removes
//! exactly those files and starts afresh; whatever else lies there (a state file of a viewer, notes) is left alone,
//! and a folder without the list is never touched.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Component, Path, PathBuf};

use crate::{Error, atomic};

/// Name of the list of files in the results folder.
pub const LIST: &str = "files.txt";

/// First line of the list: what tells a results folder from any other.
const HEADING: &str = "# results of carom: the files below are replaced by the next run";

/// A results folder, open for writing.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    list: File,
    names: BTreeSet<String>,
}

impl Folder {
    /// Creates the folder and its parents, or clears an earlier results folder of the files that its run wrote, so
    /// that nothing in it can be taken for a result of this run.
    ///
    /// # Errors
    /// [`Error::NotAFolder`] if a file stands there; [`Error::ForeignFolder`] if a folder stands there which holds
    /// files and is not a results folder; [`Error::File`] if the system refuses.
    pub fn create(path: &Path) -> Result<Folder, Error> {
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => clear(path)?,
            Ok(_) => {
                return Err(Error::NotAFolder {
                    path: path.to_owned(),
                });
            }
            Err(cause) if cause.kind() == ErrorKind::NotFound => {
                fs::create_dir_all(path).map_err(Error::file("create the results folder", path))?;
            }
            Err(cause) => return Err(Error::file("create the results folder", path)(cause)),
        }
        let list_path = path.join(LIST);
        atomic::write_text(&list_path, &format!("{HEADING}\n"))?;
        let list = File::options()
            .append(true)
            .open(&list_path)
            .map_err(Error::file("write", &list_path))?;
        Ok(Folder {
            path: path.to_owned(),
            list,
            names: BTreeSet::new(),
        })
    }

    /// Where the folder is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Announces a file, by its name relative to the folder with forward slashes (`plots/contact.svg`), creates the
    /// subfolder it needs and returns where to write it. To be called before the file is made: what is on the disk
    /// is then always on the list.
    ///
    /// # Errors
    /// [`Error::FileName`] for a name that leaves the folder; [`Error::File`] if the system refuses.
    pub fn file(&mut self, name: &str) -> Result<PathBuf, Error> {
        if !is_inside(name) {
            return Err(Error::FileName {
                name: name.to_owned(),
            });
        }
        let path = self.path.join(name);
        if self.names.contains(name) {
            return Ok(path);
        }
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(Error::file("create the folder", parent))?;
        }
        let list_path = self.path.join(LIST);
        self.list
            .write_all(format!("{name}\n").as_bytes())
            .map_err(Error::file("write", &list_path))?;
        self.names.insert(name.to_owned());
        Ok(path)
    }

    /// Announces a results folder inside this one, which keeps a list of its own: the next run clears it by that list.
    /// Returns where it is to be.
    ///
    /// # Errors
    /// As [`Folder::file`].
    pub fn nested(&mut self, name: &str) -> Result<PathBuf, Error> {
        self.file(&format!("{name}/{LIST}"))?;
        Ok(self.path.join(name))
    }

    /// The files announced so far, sorted.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }
}

/// Whether a name, taken from the folder, stays in it and fits on one line of the list.
fn is_inside(name: &str) -> bool {
    let plain = |part: Component| matches!(part, Component::Normal(_));
    !name.is_empty()
        && !name.contains(['\n', '\r', '\\'])
        && Path::new(name).components().all(plain)
}

/// Removes what the list of an earlier run names, and the subfolders that this leaves empty.
fn clear(folder: &Path) -> Result<(), Error> {
    let list = folder.join(LIST);
    let text = match fs::read_to_string(&list) {
        Ok(text) if text.starts_with(HEADING) => text,
        _ if is_empty(folder)? => return Ok(()),
        _ => {
            return Err(Error::ForeignFolder {
                path: folder.to_owned(),
            });
        }
    };
    // A last line without its end was cut while it was written: its file was not made yet.
    let complete = text
        .split_inclusive('\n')
        .filter(|line| line.ends_with('\n'));
    let names: Vec<&str> = complete
        .skip(1)
        .map(str::trim_end)
        .filter(|name| is_inside(name))
        .collect();
    for name in &names {
        let path = folder.join(name);
        if *name != LIST
            && path.ends_with(LIST)
            && path.is_file()
            && let Some(nested) = path.parent()
        {
            clear(nested)?;
        }
        match fs::remove_file(&path) {
            Err(cause) if cause.kind() != ErrorKind::NotFound => {
                return Err(Error::file("remove the earlier result", &path)(cause));
            }
            _ => {}
        }
    }
    let parents: BTreeSet<&Path> = names
        .iter()
        .filter_map(|name| Path::new(name).parent())
        .collect();
    for parent in parents
        .into_iter()
        .rev()
        .filter(|parent| !parent.as_os_str().is_empty())
    {
        // Refused when something of the user's is in it, which is the wish.
        let _ = fs::remove_dir(folder.join(parent));
    }
    Ok(())
}

fn is_empty(folder: &Path) -> Result<bool, Error> {
    let mut entries = fs::read_dir(folder).map_err(Error::file("read the folder", folder))?;
    Ok(entries.next().is_none())
}
