//! What can be wrong with a mesh that was read or generated without fault.

/// Failure of an operation on a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Two merged meshes define a group of the same name.
    #[error("mesh `{mesh}` has a group `{group}`, and so has a mesh before it")]
    GroupClash {
        /// Name of the mesh that came second.
        mesh: String,
        /// The name both use.
        group: String,
    },
}
