//! The lock file of the Python package, a workspace of its own that is built with `--locked`: it is stale once a manifest of a crate changes.

use std::path::Path;
use std::process::Command;

/// Mends it.
const MEND: &str = "cargo update --workspace --manifest-path python/Cargo.toml";

const ASK: [&str; 6] = [
    "metadata",
    "--locked",
    "--format-version",
    "1",
    "--manifest-path",
    "python/Cargo.toml",
];

/// Whether the manifests ask for what the lock file does not have.
pub fn check(root: &Path) -> Vec<String> {
    let output = match Command::new("cargo").args(ASK).current_dir(root).output() {
        Ok(output) => output,
        Err(cause) => return vec![format!("cargo could not be started: {cause}")],
    };
    if output.status.success() {
        return Vec::new();
    }
    let message = String::from_utf8_lossy(&output.stderr);
    match is_stale(&message) {
        true => vec![format!(
            "python/Cargo.lock is stale: `{MEND}` mends it; commit it"
        )],
        // cargo reads the manifests of all packages and may have to download them
        false => {
            println!("python/Cargo.lock: LEFT OUT: {message}");
            Vec::new()
        }
    }
}

fn is_stale(message: &str) -> bool {
    message.contains("lock file") && message.contains("--locked")
}

#[cfg(test)]
mod tests {
    use super::is_stale;

    #[test]
    fn a_stale_lock_differs_from_a_missing_network() {
        assert!(is_stale(
            "error: cannot update the lock file /c/python/Cargo.lock because --locked was passed to prevent this"
        ));
        assert!(!is_stale("error: failed to download from `https://x`"));
    }
}
