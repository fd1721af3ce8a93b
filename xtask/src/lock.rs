//! The Python package, a workspace of its own: its lock file, with which it is built (`--locked`), is stale once a manifest of a crate changes;
//! and its crates are compiled once with those of the workspace only if both have the same profiles.

use std::collections::BTreeMap;
use std::fs;
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

/// Whether the manifests ask for what the lock file does not have, and which packages have another profile than in the workspace.
pub fn check(root: &Path) -> Vec<String> {
    let mut problems = stale(root);
    let read = |name: &str| fs::read_to_string(root.join(name)).unwrap_or_default();
    let [ours, python] = ["Cargo.toml", "python/Cargo.toml"].map(|name| profiles(&read(name)));
    problems.extend(differences(&ours, &python, &read("python/Cargo.lock")));
    problems
}

/// Lines of the release profile of each package.
type Profiles = BTreeMap<String, String>;

fn profiles(manifest: &str) -> Profiles {
    let tables = manifest.split("\n[").filter_map(|table| {
        let (name, lines) = table.split_once("]\n")?;
        let name = name.strip_prefix("profile.release.package.")?;
        let lines = lines.lines().filter(|line| line.contains('='));
        Some((name.to_owned(), lines.collect::<Vec<_>>().join("\n")))
    });
    tables.collect()
}

/// Packages of the Python package with another profile than in the workspace: they, and all that use them, are compiled twice.
fn differences(ours: &Profiles, python: &Profiles, lock: &str) -> Vec<String> {
    let locked = |name: &str| lock.contains(&format!("\nname = \"{name}\"\n"));
    let names = ours
        .keys()
        .chain(python.keys().filter(|name| !ours.contains_key(*name)));
    let differ = names.filter(|name| locked(name) && ours.get(*name) != python.get(*name));
    let told = differ.map(|name| {
        format!("python/Cargo.toml: [profile.release.package.{name}] is not as in Cargo.toml: it would be compiled twice")
    });
    told.collect()
}

/// Whether the manifests ask for what the lock file does not have.
fn stale(root: &Path) -> Vec<String> {
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
    use super::{differences, is_stale, profiles};

    #[test]
    fn a_stale_lock_differs_from_a_missing_network() {
        assert!(is_stale(
            "error: cannot update the lock file /c/python/Cargo.lock because --locked was passed to prevent this"
        ));
        assert!(!is_stale("error: failed to download from `https://x`"));
    }

    #[test]
    fn packages_of_both_workspaces_have_one_profile() {
        let ours = profiles(
            "[profile.release]\nlto = false\n\n[profile.release.package.a]\nopt-level = 0\n\n# why\n[profile.release.package.b]\nopt-level = 0\n\n[profile.release.package.c]\nopt-level = 0\n",
        );
        let python = profiles(
            "[x]\n\n[profile.release.package.a]\nopt-level = 0\n\n[profile.release.package.d]\nopt-level = 1\n",
        );
        let lock =
            "[[package]]\nname = \"a\"\n[[package]]\nname = \"b\"\n[[package]]\nname = \"d\"\n";
        let told = differences(&ours, &python, lock);
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(
            told[0].contains("package.b]") && told[1].contains("package.d]"),
            "{told:?}"
        );
    }
}
