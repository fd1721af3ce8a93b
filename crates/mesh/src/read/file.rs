//! Bytes of a file that a user names: regular files of a bounded length only.
//!
//! A pipe, a device or a file that grows while it is read may have no end.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Reads a whole file of at most `most` bytes.
///
/// # Errors
/// The file is no regular file (a folder, a pipe, a device), has more than `most` bytes, or the system does not give it.
pub fn regular(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    // before it is opened: that of a pipe waits for a writer
    let found = fs::metadata(path)?;
    if found.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory));
    }
    if !found.is_file() {
        return Err(io::Error::other(
            "it is a pipe or a device, not a regular file",
        ));
    }
    let mut bytes = Vec::new();
    File::open(path)?
        .take(most.saturating_add(1))
        .read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(io::Error::other(format!(
            "it has more than {} MiB, the most that is read",
            most >> 20
        ))),
        false => Ok(bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_bound_and_not_beyond() {
        let path = std::env::temp_dir().join(format!("carom-bound-{}", std::process::id()));
        fs::write(&path, [b'x'; 100]).unwrap();
        assert_eq!(regular(&path, 100).unwrap().len(), 100);
        assert_eq!(regular(&path, 99).unwrap_err().kind(), io::ErrorKind::Other);
        fs::remove_file(&path).unwrap();
        assert_eq!(
            regular(&path, 99).unwrap_err().kind(),
            io::ErrorKind::NotFound
        );
        assert_eq!(
            regular(&std::env::temp_dir(), 99).unwrap_err().kind(),
            io::ErrorKind::IsADirectory
        );
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_device_without_end_is_refused() {
        let error = regular(Path::new("/dev/zero"), 99).unwrap_err();
        assert!(error.to_string().contains("not a regular file"), "{error}");
    }
}
