//! Meshes from files of all formats: those of the crate `mesh`, and MED with the feature `hdf5`.
//!
//! The feature is here and not in `mesh`: most crates use that one, and all of them would be compiled anew for a program with HDF5.

#[cfg(feature = "hdf5")]
pub mod med;

use std::path::Path;

use carom_mesh::Mesh;
use carom_mesh::read::ReadError;

/// Reads the mesh in a file, as [`carom_mesh::read::read`] does, and MED files with the feature `hdf5`.
///
/// Fails if the file cannot be read or its content refused; see [`ReadError`].
pub fn read(path: &Path) -> Result<Mesh, ReadError> {
    #[cfg(feature = "hdf5")]
    return carom_mesh::read::read_with(path, med::parse);
    #[cfg(not(feature = "hdf5"))]
    carom_mesh::read::read(path)
}
