//! The texts that make up a case: the file, and the overrides of the command line.

use std::path::{Path, PathBuf};

use carom_mesh::read::file;
use carom_quantities::nearest;

use crate::error::Problem;

/// Most bytes of a case file, 16 MiB: cases are written by people, and meshes stand in files of their own.
const LARGEST: u64 = 16 << 20;

/// A text with a name to show in messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// Path of the file as the user gave it, or `--set`.
    pub name: String,
    /// The text, UTF-8.
    pub text: String,
}

/// The case file and its overrides, unread as TOML.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// The case file first, then one source per override.
    pub sources: Vec<Source>,
    /// Folder that the paths of the case file start from.
    pub folder: PathBuf,
}

impl Input {
    /// Reads the case file at `path`; each of `overrides` is one `key.path=value`, which replaces the value at that key path.
    ///
    /// # Errors
    /// One [`Problem`] without a place: the file is missing, is a folder, cannot be read, is not UTF-8, or is empty.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Input, Vec<Problem>> {
        let name = path.display().to_string();
        if path.is_dir() {
            let inside = path.join("case.toml");
            let problem = Problem::new("", format!("`{name}` is a folder, not a case file"));
            return Err(vec![if inside.is_file() {
                problem.note(format!("it holds a case file: {}", inside.display()))
            } else {
                problem
            }]);
        }
        let bytes = file::regular(path, LARGEST).map_err(|cause| {
            let problem = Problem::new("", format!("cannot read the case file `{name}`: {cause}"));
            let nearest = meant(path).map(|near| near.display().to_string());
            vec![Problem { nearest, ..problem }]
        })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let bytes = error.as_bytes();
            let at = error.utf8_error().valid_up_to();
            let line = 1 + bytes[..at].iter().filter(|&&byte| byte == b'\n').count();
            let problem = Problem::new("", format!("the case file `{name}` is not UTF-8 text"));
            let found = format!(
                "the byte 0x{:02x} on line {line}, at offset {at}",
                bytes[at]
            );
            vec![
                problem
                    .found(found)
                    .accepted(["a TOML file, saved as UTF-8"]),
            ]
        })?;
        if text.trim().is_empty() {
            return Err(vec![Problem::new(
                "",
                format!("the case file `{name}` is empty"),
            )]);
        }
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        Ok(Input {
            folder,
            ..Input::from_text(&name, &text, overrides)
        })
    }

    /// The same from a text: paths in it start from the working folder.
    pub fn from_text(name: &str, text: &str, overrides: &[String]) -> Input {
        let file = Source {
            name: name.to_owned(),
            text: text.strip_prefix('\u{feff}').unwrap_or(text).to_owned(),
        };
        let overrides = overrides.iter().map(|text| Source {
            name: "--set".to_owned(),
            text: text.clone(),
        });
        Input {
            sources: std::iter::once(file).chain(overrides).collect(),
            folder: PathBuf::new(),
        }
    }
}

/// The file that a path was meant to be: with the nearest name there is in place of the first part that is missing.
fn meant(path: &Path) -> Option<PathBuf> {
    let missing = path.ancestors().filter(|part| *part != Path::new(""));
    let missing = missing.take_while(|part| !part.exists()).last()?;
    let folder = missing.parent()?;
    let names = names_in(folder);
    let found = missing.file_name()?.to_str()?;
    let near = folder.join(nearest(found, names.iter().map(String::as_str))?);
    let rest = path.strip_prefix(missing).ok()?;
    let near = match rest == Path::new("") {
        true => near,
        false => near.join(rest),
    };
    near.is_file().then_some(near)
}

/// Names of what is in a folder, in their order; none if it cannot be read.
pub(crate) fn names_in(folder: &Path) -> Vec<String> {
    // the folder of a name alone is the one at hand
    let folder = match folder == Path::new("") {
        true => Path::new("."),
        false => folder,
    };
    let entries = folder.read_dir().into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<String> = names.collect();
    names.sort_unstable();
    names
}
