//! Mesh files of the cases that checks run, embedded: `carom verify` needs no source tree.

use std::path::Path;

use carom_mesh::Mesh;
use carom_mesh::read::gmsh;

use crate::Error;

macro_rules! files {
    ($($name:literal)*) => {
        &[$(($name, include_bytes!(concat!("../../../cases/", $name)))),*]
    };
}

/// Their names in the folder of the cases, and their bytes.
const FILES: &[(&str, &[u8])] = files!(
    "conveyor/crate.msh"
    "crushed-tube/tube.msh"
    "crushed-tube/tube-coarse.msh"
    "ironing/ironing.msh"
    "ironing/ironing-coarse.msh"
    "oblique-bar/bar.msh"
    "oblique-bar/bar-coarse.msh"
    "rings/rings.msh"
    "rings/rings-coarse.msh"
    "taylor-bar/bar-solid-coarse.msh"
    "tori/tori.msh"
    "tori/tori-coarse.msh"
);

/// The mesh of this name, in the unit of its file.
///
/// # Errors
/// No such file, or one that cannot be read.
pub(crate) fn mesh(name: &str) -> Result<Mesh, Error> {
    let found = FILES.iter().find(|(own, _)| *own == name);
    let (_, bytes) = found.ok_or_else(|| Error::NoMesh {
        name: name.to_owned(),
    })?;
    Ok(gmsh::parse(Path::new(name), bytes)?)
}
