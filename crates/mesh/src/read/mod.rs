//! Reading meshes from files.
//!
//! [`read`] chooses the format by the extension; each format has its own module. What a file says is checked here
//! as far as the file goes (syntax, counts, node tags, finite coordinates); whether the elements are fit for
//! computation is [`Mesh::check`]. Coordinates are taken as they stand: [`Mesh::scale`] makes them metres.

mod error;
pub mod file;
pub mod gmsh;
pub mod inp;

use std::path::Path;

use crate::Mesh;
pub use error::{Place, ReadError};

/// Extensions of the files that [`read`] takes.
pub const EXTENSIONS: &[&str] = &["msh", "inp"];

/// Most bytes of a mesh file: 16 GiB, some hundred million nodes.
const LARGEST: u64 = 16 << 30;

/// Reads the mesh in a file; the extension, in any case, says the format: `.msh` is Gmsh's ([`gmsh`]), `.inp` that of
/// Abaqus and CalculiX ([`inp`]).
///
/// Fails if the file cannot be read or its content refused; see [`ReadError`].
pub fn read(path: &Path) -> Result<Mesh, ReadError> {
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
        _ => gmsh::parse(path, &bytes),
    }
}

/// Sets to zero what is round-off and gives the dimension of the space: the last direction in which a coordinate is
/// not zero, at least `least` and 1.
fn flatten(nodes: &mut [[f64; 3]], least: usize) -> usize {
    let largest = nodes.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let extends = |&i: &usize| nodes.iter().any(|x| x[i].abs() > 1e-12 * largest);
    let dim = (0..3).rev().find(extends).map_or(1, |i| i + 1).max(least);
    for x in nodes {
        x[dim..].fill(0.0);
    }
    dim
}
