//! The results folder: which files in it are ours, and who writes to it.
//!
//! The folder keeps a list of what the run wrote, in [`LIST`]. A later run of the same case finds the list, removes
//! exactly those files and starts afresh; whatever else lies there (a state file of a viewer, notes) is left alone,
//! and a folder without the list is never touched. Temporary files that a killed run left go too.
//!
//! The list is open and locked while a run writes into the folder, so that a second run is refused; the system takes the
//! lock away with the process, however it ends. Nothing inside the folder is reached through a symbolic link: a link among
//! the files is removed and not its target, a link among the subfolders is an error, and a list names nothing behind one.

use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Component, Path, PathBuf};

use crate::{Error, atomic};

/// Name of the list of files in the results folder.
pub const LIST: &str = "files.txt";

/// First line of the list: what tells a results folder from any other.
const HEADING: &str = "# results of carom: the files below are replaced by the next run\n";

/// A results folder, open for writing.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    /// Locked until it is closed.
    list: File,
    names: BTreeSet<String>,
}

impl Folder {
    /// Creates the folder and its parents, or clears an earlier results folder of the files that its run wrote, so
    /// that nothing in it can be taken for a result of this run.
    ///
    /// # Errors
    /// [`Error::NotAFolder`] if a file stands there; [`Error::ForeignFolder`] if a folder stands there which holds
    /// files and is not a results folder; [`Error::Busy`] if another run writes into it; [`Error::Link`] if the list is a
    /// symbolic link; [`Error::File`] if the system refuses.
    pub fn create(path: &Path) -> Result<Folder, Error> {
        let refused = |cause| Error::file("create the results folder", path)(cause);
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => {}
            Ok(_) => {
                return Err(Error::NotAFolder {
                    path: path.to_owned(),
                });
            }
            Err(cause) if cause.kind() == ErrorKind::NotFound => {
                fs::create_dir_all(path).map_err(refused)?;
            }
            Err(cause) => return Err(refused(cause)),
        }
        Ok(Folder {
            path: path.to_owned(),
            list: clear(path)?,
            names: BTreeSet::new(),
        })
    }

    /// Opens the results folder of an earlier run, which goes on; nothing in it is changed yet ([`Folder::cut_back`]).
    ///
    /// # Errors
    /// [`Error::NoResults`] if there is no such folder; [`Error::Busy`], [`Error::Link`], [`Error::File`] as of
    /// [`Folder::create`].
    pub fn open(path: &Path) -> Result<Folder, Error> {
        let list_path = path.join(LIST);
        let none = || Error::NoResults {
            path: path.to_owned(),
        };
        match fs::symlink_metadata(&list_path) {
            Ok(found) if found.is_symlink() => return Err(Error::Link { path: list_path }),
            Ok(found) if found.is_file() => {}
            _ => return Err(none()),
        }
        let list = File::options().read(true).write(true).open(&list_path);
        let mut list = list.map_err(Error::file("open", &list_path))?;
        lock(&list, path)?;
        let text = read(&mut list, &list_path)?;
        match text.starts_with(HEADING) {
            true => Ok(Folder {
                path: path.to_owned(),
                list,
                names: BTreeSet::new(),
            }),
            false => Err(none()),
        }
    }

    /// Bytes of the list so far: what it is cut back to when a run goes on from now.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn listed(&self) -> Result<u64, Error> {
        let data = self.list.metadata();
        let data = data.map_err(Error::file("read", &self.path.join(LIST)))?;
        Ok(data.len())
    }

    /// Removes the files that were announced after the list had this length, and the list of them.
    ///
    /// # Errors
    /// [`Error::Cut`] if the list is shorter; [`Error::File`].
    pub fn cut_back(&mut self, length: u64) -> Result<(), Error> {
        let path = self.path.join(LIST);
        let found = self.listed()?;
        let text = read(&mut self.list, &path)?;
        let kept = usize::try_from(length).ok();
        let Some((kept, dropped)) = kept.and_then(|length| text.split_at_checked(length)) else {
            return Err(Error::Cut {
                path,
                expected: length,
                found,
            });
        };
        remove(&self.path, &format!("{HEADING}{dropped}"))?;
        self.names = kept.lines().skip(1).map(str::to_owned).collect();
        self.list
            .set_len(length)
            .and_then(|()| self.list.seek(SeekFrom::Start(length)))
            .map_err(Error::file("write", &path))?;
        Ok(())
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
    /// [`Error::FileName`] for a name that leaves the folder; [`Error::Link`] if a symbolic link stands where a subfolder should
    /// be; [`Error::File`] if the system refuses.
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
        for folder in folders(name) {
            let folder = self.path.join(folder);
            if fs::symlink_metadata(&folder).is_ok_and(|found| found.is_symlink()) {
                return Err(Error::Link { path: folder });
            }
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

/// The subfolders that lead to a name, the outermost first.
fn folders(name: &str) -> Vec<&Path> {
    let above = Path::new(name).ancestors().skip(1);
    let mut above: Vec<&Path> = above.filter(|path| !path.as_os_str().is_empty()).collect();
    above.reverse();
    above
}

/// Whether a subfolder on the way to a name is a symbolic link: what it leads to is not ours.
fn through_a_link(folder: &Path, name: &str) -> bool {
    let link = |path: &Path| fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink());
    folders(name).iter().any(|part| link(&folder.join(part)))
}

/// Removes what the list of an earlier run names, and the subfolders that this leaves empty. Returns the list, locked, with
/// nothing but its heading.
fn clear(folder: &Path) -> Result<File, Error> {
    let path = folder.join(LIST);
    let known = fs::symlink_metadata(&path);
    if known.as_ref().is_ok_and(|found| found.is_symlink()) {
        return Err(Error::Link { path });
    }
    let foreign = || Error::ForeignFolder {
        path: folder.to_owned(),
    };
    if !known.is_ok_and(|found| found.is_file()) && !is_empty(folder)? {
        return Err(foreign());
    }
    let mut list = File::options()
        .read(true)
        .write(true)
        .create(true)
        .truncate(false)
        .open(&path)
        .map_err(Error::file("write", &path))?;
    lock(&list, folder)?;
    let text = read(&mut list, &path)?;
    // a run that was killed at once left the beginning of a heading, and nothing else
    let begun =
        HEADING.starts_with(&text) && fs::read_dir(folder).is_ok_and(|all| all.count() == 1);
    if !begun && !text.starts_with(HEADING) {
        return Err(foreign());
    }
    remove(folder, &text)?;
    let fresh = |list: &mut File| {
        // the heading stays whole at any moment: it says whose folder this is
        list.seek(SeekFrom::Start(0))?;
        list.write_all(HEADING.as_bytes())?;
        list.set_len(HEADING.len() as u64)
    };
    fresh(&mut list).map_err(Error::file("write", &path))?;
    Ok(list)
}

/// The text of the list, from its beginning.
fn read(list: &mut File, path: &Path) -> Result<String, Error> {
    let mut bytes = Vec::new();
    list.seek(SeekFrom::Start(0))
        .and_then(|_| list.read_to_end(&mut bytes))
        .map_err(Error::file("read", path))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Takes the lock, which goes with the process.
fn lock(list: &File, folder: &Path) -> Result<(), Error> {
    match list.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(Error::Busy {
            path: folder.to_owned(),
        }),
        Err(TryLockError::Error(cause)) if cause.kind() == ErrorKind::Unsupported => {
            let folder = folder.display();
            tracing::warn!(
                "the file system has no locks: a second run into {folder} would not be refused"
            );
            Ok(())
        }
        Err(TryLockError::Error(cause)) => Err(Error::file("lock", &folder.join(LIST))(cause)),
    }
}

/// Removes the files that a list names, and what a killed run left beside them.
fn remove(folder: &Path, list: &str) -> Result<(), Error> {
    // A last line without its end was cut while it was written: its file was not made yet.
    let complete = list
        .split_inclusive('\n')
        .filter(|line| line.ends_with('\n'));
    let names: Vec<&str> = complete
        .skip(1)
        .map(str::trim_end)
        .filter(|name| is_inside(name) && *name != LIST && !through_a_link(folder, name))
        .collect();
    for name in &names {
        let path = folder.join(name);
        let is_file = fs::symlink_metadata(&path).is_ok_and(|found| found.is_file());
        if is_file
            && path.ends_with(LIST)
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
    let parents: BTreeSet<&Path> = names.iter().flat_map(|name| folders(name)).collect();
    atomic::remove_parts(folder);
    for parent in parents.into_iter().rev() {
        let parent = folder.join(parent);
        atomic::remove_parts(&parent);
        // Refused when something of the user's is in it, which is the wish.
        let _ = fs::remove_dir(parent);
    }
    Ok(())
}

fn is_empty(folder: &Path) -> Result<bool, Error> {
    let mut entries = fs::read_dir(folder).map_err(Error::file("read the folder", folder))?;
    Ok(entries.next().is_none())
}
