//! The Gmsh reader: files that Gmsh wrote, files of our own writer, files that are wrong.
//!
//! `tests/fixtures` holds six meshes that Gmsh 4.15.2 wrote from the `.geo` files beside them, each in four
//! formats: `gmsh box.geo -3 -format msh41 -bin -o box-41-bin.msh` and so on.

mod cases;
mod damaged;
mod malformed;
mod malformed_binary;
mod malformed_blocks;
mod sound;
mod writer;

use std::path::{Path, PathBuf};

use carom_mesh::Mesh;
use carom_mesh::read::{ReadError, gmsh};

/// Names of the meshes in `tests/fixtures`.
const MESHES: [&str; 6] = ["box", "plane", "line", "mixed", "second", "incomplete"];

/// Endings of their names, one for each format.
const FORMATS: [&str; 4] = ["-22", "-22-bin", "-41", "-41-bin"];

fn fixture(mesh: &str, format: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    folder.join(format!("{mesh}{format}.msh"))
}

fn bytes_of(mesh: &str, format: &str) -> Vec<u8> {
    std::fs::read(fixture(mesh, format)).unwrap()
}

fn parse(content: &[u8]) -> Result<Mesh, ReadError> {
    gmsh::parse(Path::new("mesh.msh"), content)
}
