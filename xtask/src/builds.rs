//! The README's two commands and the lints share one build of the dependencies.
//!
//! If a test dependency switches on a feature that faer or a crate of ours sees, `cargo test` compiles that and all above it a second time.
//! A file of a compiled crate carries a hash of its features: the same crate in two files is the same crate built twice.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::{Command, Stdio};

/// Beginnings of the names of crates that are dear to build: all below faer is built with it, and ours are above all others.
const DEAR: [&str; 2] = ["faer", "carom_"];

/// Compiled files by name of the crate.
type Compiled = BTreeMap<String, BTreeSet<String>>;

/// Whether the tests compile again what the program has compiled.
pub fn check(root: &Path) -> Vec<String> {
    let built = compiled(root, "cargo build --release");
    let tested = compiled(root, "cargo test --release --workspace --no-run");
    let (built, tested) = match (built, tested) {
        (Ok(built), Ok(tested)) => (built, tested),
        (Err(problem), _) | (_, Err(problem)) => return vec![problem],
    };
    if let Some(missing) = DEAR
        .iter()
        .find(|dear| !built.keys().any(|name| name.starts_with(**dear)))
    {
        return vec![format!(
            "`cargo build` did not name {missing}: has cargo changed its messages?"
        )];
    }
    let twice = twice(&built, &tested);
    match twice.is_empty() {
        true => Vec::new(),
        false => vec![format!(
            "compiled twice, for `cargo build` and for `cargo test`: {}; a test dependency switches on a feature of them or of a crate \
             below (docs/src/developer/build.md)",
            twice.join(", ")
        )],
    }
}

/// Dear crates of the program that the tests take from other files.
fn twice<'a>(built: &'a Compiled, tested: &Compiled) -> Vec<&'a str> {
    let dear = |name: &str| DEAR.iter().any(|dear| name.starts_with(dear));
    let same = |name, first| {
        tested
            .get(name)
            .is_some_and(|second: &BTreeSet<_>| second.is_subset(first))
    };
    let twice = built
        .iter()
        .filter(|(name, first)| dear(name) && !same(*name, *first));
    twice.map(|(name, _)| name.as_str()).collect()
}

/// Libraries that a command compiles or finds compiled.
fn compiled(root: &Path, line: &str) -> Result<Compiled, String> {
    let output = Command::new("cargo")
        .args(line.split(' ').skip(1))
        .arg("--message-format=json-render-diagnostics")
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|cause| format!("`{line}` could not be started: {cause}"))?;
    if !output.status.success() {
        return Err(format!("`{line}` failed: {}", output.status));
    }
    let mut compiled = Compiled::new();
    for message in String::from_utf8_lossy(&output.stdout).lines() {
        if let Some((name, file)) = artifact(message) {
            compiled.entry(name).or_default().insert(file);
        }
    }
    Ok(compiled)
}

/// Name and file of the library that a line of cargo's messages is about. Cargo writes one compact JSON object a line; test
/// programs have no library.
fn artifact(message: &str) -> Option<(String, String)> {
    if !message.contains(r#""reason":"compiler-artifact""#) {
        return None;
    }
    let target = message.split(r#""target":"#).nth(1)?;
    let name = target.split(r#""name":""#).nth(1)?.split('"').next()?;
    let files = message
        .split(r#""filenames":["#)
        .nth(1)?
        .split(']')
        .next()?;
    let library = files.split('"').find(|file| file.ends_with(".rlib"))?;
    Some((name.to_owned(), library.to_owned()))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{Compiled, artifact, twice};

    #[test]
    fn a_dear_crate_in_another_file_is_compiled_twice() {
        let of = |files: [&str; 3]| -> Compiled {
            let names = ["carom_mesh", "faer", "csv"].map(str::to_owned);
            let files = files.map(|file| BTreeSet::from([file.to_owned()]));
            names.into_iter().zip(files).collect()
        };
        let built = of(["mesh-1", "faer-1", "csv-1"]);
        assert!(twice(&built, &of(["mesh-1", "faer-1", "csv-2"])).is_empty());
        assert_eq!(
            twice(&built, &of(["mesh-2", "faer-1", "csv-1"])),
            ["carom_mesh"]
        );
    }

    #[test]
    fn libraries_are_found_in_the_messages_of_cargo() {
        let message = r#"{"reason":"compiler-artifact","package_id":"x#faer@0.24.0","target":{"kind":["lib"],"name":"faer","test":true},"profile":{"test":false},"features":["std"],"filenames":["/t/libfaer-1.rlib","/t/libfaer-1.rmeta"],"fresh":true}"#;
        assert_eq!(
            artifact(message),
            Some(("faer".to_owned(), "/t/libfaer-1.rlib".to_owned()))
        );
        assert_eq!(artifact(r#"{"reason":"build-finished"}"#), None);
    }
}
