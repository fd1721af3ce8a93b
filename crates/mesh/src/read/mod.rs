//! Reading meshes from files.
//!
//! [`read`] chooses the format by the extension; each format has its own module. What a file says is checked here
//! as far as the file goes (syntax, counts, node tags, finite coordinates); whether the elements are fit for
//! computation is [`Mesh::check`]. Coordinates are taken as they stand: [`Mesh::scale`] makes them metres.

mod error;
pub mod file;
pub mod flatten;
pub mod gmsh;
pub mod groups;
pub mod inp;
pub mod stl;
pub mod vtu;

use std::path::Path;

use crate::Mesh;
pub use error::{Place, ReadError};

/// Extensions of the files that [`read`] takes.
pub const EXTENSIONS: &[&str] = &["msh", "inp", "stl", "vtu", "med"];

/// Most bytes of a mesh file: 16 GiB, some hundred million nodes.
const LARGEST: u64 = 16 << 30;

/// Reads the mesh in a file; the extension, in any case, says the format: `.msh` is Gmsh's ([`gmsh`]), `.inp` that of
/// Abaqus and CalculiX ([`inp`]), `.stl` a surface of triangles ([`stl`]), `.vtu` an unstructured grid of VTK ([`vtu`]), `.med` a mesh of
/// Salome and code_aster, which this crate alone refuses (the crate `med` reads it).
///
/// Fails if the file cannot be read or its content refused; see [`ReadError`].
pub fn read(path: &Path) -> Result<Mesh, ReadError> {
    read_with(path, |path, _| {
        Err(ReadError::Feature {
            path: path.to_owned(),
        })
    })
}

/// The same, with a reader of the bytes of MED files.
///
/// Fails if the file cannot be read or its content refused; see [`ReadError`].
pub fn read_with(
    path: &Path,
    med: fn(&Path, Vec<u8>) -> Result<Mesh, ReadError>,
) -> Result<Mesh, ReadError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let format = extension.to_lowercase();
    if !EXTENSIONS.contains(&format.as_str()) {
        return Err(ReadError::Extension {
            path: path.to_owned(),
            found: extension.into_owned(),
            expected: EXTENSIONS,
        });
    }
    let bytes = file::regular(path, LARGEST).map_err(|source| ReadError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    match format.as_str() {
        "inp" => inp::parse(path, &bytes),
        "stl" => stl::parse(path, &bytes),
        "vtu" => vtu::parse(path, &bytes),
        "med" => med(path, bytes),
        _ => gmsh::parse(path, &bytes),
    }
}
