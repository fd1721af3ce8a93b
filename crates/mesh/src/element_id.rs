//! The number of an element in its mesh.

/// An element of a mesh: its block and its place there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ElementId {
    /// Index in [`Mesh::blocks`](crate::Mesh::blocks).
    pub block: u32,
    /// Index of the element in its block.
    pub index: u32,
}
