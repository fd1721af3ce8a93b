//! `carom new`: templates, most of them cases of the project. A case that shows what is worth a look has a template that ends well.

use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::exit::{BAD_INPUT, FAILED};
use crate::terminal::{err, out};

/// A case to start from.
struct Template {
    name: &'static str,
    shows: &'static str,
    case: &'static str,
    /// What goes beside the case, under the names that it uses: the mesh, and the script it was made from.
    beside: &'static [(&'static str, &'static [u8])],
}

const TEMPLATES: [Template; 10] = [
    Template {
        name: "two-bars",
        shows: "two bars in impact, velocity law",
        case: include_str!("../../../cases/two-bars/case.toml"),
        beside: &[],
    },
    Template {
        name: "two-bars-newmark",
        shows: "two bars, Newmark with the displacement law",
        case: include_str!("../templates/two-bars-newmark.toml"),
        beside: &[],
    },
    Template {
        name: "bar-on-wall",
        shows: "a bar on a rigid wall",
        case: include_str!("../templates/bar-on-wall.toml"),
        beside: &[],
    },
    Template {
        name: "block-drop",
        shows: "a 3D block on a rigid plane, with its Gmsh files",
        case: include_str!("../templates/block-drop.toml"),
        beside: &[
            (
                "block.geo",
                include_bytes!("../../../cases/block-drop/block.geo"),
            ),
            (
                "block.msh",
                include_bytes!("../../../cases/block-drop/block.msh"),
            ),
        ],
    },
    Template {
        name: "drop-test",
        shows: "a box of aluminium sheet that falls on its corner, explicit, shells",
        case: include_str!("../../../cases/dropped-box/case.toml"),
        beside: &[
            (
                "box.geo",
                include_bytes!("../../../cases/dropped-box/box.geo"),
            ),
            (
                "box.msh",
                include_bytes!("../../../cases/dropped-box/box.msh"),
            ),
        ],
    },
    Template {
        name: "friction",
        shows: "a crate on a moving belt in the plane, with friction",
        case: include_str!("../templates/friction.toml"),
        beside: &[
            (
                "crate.geo",
                include_bytes!("../../../cases/conveyor/crate.geo"),
            ),
            (
                "crate.msh",
                include_bytes!("../../../cases/conveyor/crate.msh"),
            ),
        ],
    },
    Template {
        name: "rigid-hammer",
        shows: "a rigid hammer strikes an elastic bar",
        case: include_str!("../../../cases/rigid-hammer/case.toml"),
        beside: &[
            (
                "hammer-and-bar.geo",
                include_bytes!("../../../cases/rigid-hammer/hammer-and-bar.geo"),
            ),
            (
                "hammer-and-bar.msh",
                include_bytes!("../../../cases/rigid-hammer/hammer-and-bar.msh"),
            ),
        ],
    },
    Template {
        name: "seismic-stops",
        shows: "two buildings with stops between their floors in an earthquake",
        case: include_str!("../../../cases/pounding/case.toml"),
        beside: &[],
    },
    Template {
        name: "preload",
        shows: "a static preload, then an impact on it",
        case: include_str!("../templates/preload.toml"),
        beside: &[],
    },
    Template {
        name: "arlequin",
        shows: "two bars with fine tips, in zones that overlap",
        case: include_str!("../templates/arlequin.toml"),
        beside: &[],
    },
];

/// Writes a template to a file, and what it needs to the same folder, where none of them may exist yet; returns the exit
/// code. Leaves all files or none.
pub fn new(template: Option<&str>, file: &Path) -> u8 {
    let Some(name) = template else {
        out!("Templates:");
        for Template { name, shows, .. } in TEMPLATES {
            out!("  {name:<18} {shows}");
        }
        out!("Write one with: carom new TEMPLATE [FILE]");
        return 0;
    };
    let Some(template) = TEMPLATES.iter().find(|known| known.name == name) else {
        let names = TEMPLATES.map(|template| template.name);
        err!(
            "error: no template `{name}`; there are: {}",
            names.join(", ")
        );
        return BAD_INPUT;
    };
    let beside = template.beside.iter();
    let mut files: Vec<(PathBuf, &[u8])> = beside
        .map(|(name, content)| (file.with_file_name(name), *content))
        .collect();
    files.insert(
        0,
        (file.to_path_buf(), without_rows(template.case).as_bytes()),
    );
    let mut made = Vec::new();
    for (path, content) in &files {
        let written = File::create_new(path).and_then(|mut target| {
            made.push(path);
            target.write_all(content)
        });
        if let Err(error) = written {
            for path in made {
                // what cannot be taken away again stays, and the error below says why
                let _ = fs::remove_file(path);
            }
            return refused(path, &error);
        }
    }
    let names: Vec<String> = files
        .iter()
        .map(|(path, _)| path.display().to_string())
        .collect();
    out!(
        "Wrote {}. Next: carom run {}",
        names.join(", "),
        file.display()
    );
    0
}

/// A case without its rows of `[expect]`, which end it: whoever starts from it changes what they are stated for.
fn without_rows(case: &str) -> &str {
    match case.find("\n[expect.") {
        Some(end) => &case[..end],
        None => case,
    }
}

/// Says why a file was not written; returns the exit code.
fn refused(path: &Path, error: &std::io::Error) -> u8 {
    if error.kind() == ErrorKind::AlreadyExists {
        err!(
            "error: {} exists; give another file name or folder",
            path.display()
        );
        BAD_INPUT
    } else {
        err!("error: {}: {error}", path.display());
        FAILED
    }
}
