//! Places of files that pages name.

use std::path::{Component, Path, PathBuf};

/// The path of `target` as seen from `file`, without `.` and `..`.
pub fn beside(file: &Path, target: &str) -> PathBuf {
    let mut path = PathBuf::new();
    for part in file
        .parent()
        .unwrap_or(Path::new(""))
        .join(target)
        .components()
    {
        match part {
            Component::ParentDir => {
                path.pop();
            }
            Component::CurDir => {}
            part => path.push(part),
        }
    }
    path
}
