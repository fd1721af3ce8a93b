//! `carom new`: templates, most of them cases of the project that need no mesh file.

use std::io::Write;
use std::path::Path;

use crate::{BAD_INPUT, FAILED};

/// Name, what it shows, text.
const TEMPLATES: [(&str, &str, &str); 5] = [
    (
        "two-bars",
        "two bars in impact, velocity law",
        include_str!("../../../cases/two-bars/case.toml"),
    ),
    (
        "two-bars-newmark",
        "two bars, Newmark with the displacement law",
        include_str!("../../../cases/two-bars-newmark/case.toml"),
    ),
    (
        "bar-on-wall",
        "a bar on a rigid wall",
        include_str!("../../../cases/bar-on-wall/case.toml"),
    ),
    (
        "block-drop",
        "a 3D block on a rigid plane",
        include_str!("../../../cases/block-drop/case.toml"),
    ),
    (
        "arlequin",
        "two bars with fine tips, in zones that overlap",
        include_str!("../templates/arlequin.toml"),
    ),
];

/// Writes a template to a file that must not exist yet; returns the exit code.
pub fn new(template: Option<&str>, file: &Path) -> u8 {
    let Some(name) = template else {
        println!("Templates:");
        for (name, shows, _) in TEMPLATES {
            println!("  {name:<18} {shows}");
        }
        println!("Write one with: carom new TEMPLATE [FILE]");
        return 0;
    };
    let Some((_, _, text)) = TEMPLATES.iter().find(|(known, _, _)| *known == name) else {
        let names: Vec<&str> = TEMPLATES.iter().map(|(name, _, _)| *name).collect();
        eprintln!(
            "error: no template `{name}`; there are: {}",
            names.join(", ")
        );
        return BAD_INPUT;
    };
    let written =
        std::fs::File::create_new(file).and_then(|mut target| target.write_all(text.as_bytes()));
    match written {
        Ok(()) => {
            println!(
                "Wrote {}. Next: carom run {}",
                file.display(),
                file.display()
            );
            0
        }
        Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {
            eprintln!("error: {} exists; give another file name", file.display());
            BAD_INPUT
        }
        Err(error) => {
            eprintln!("error: {}: {error}", file.display());
            FAILED
        }
    }
}
