//! Loads in time as a model gives them: on surfaces and at nodes.

use carom_mesh::Surface;
use carom_signals::Amplitude;

/// A load on a surface.
#[derive(Clone, Debug)]
pub struct Load {
    /// Name as in the case file.
    pub name: String,
    /// Surface that it acts on.
    pub surface: Surface,
    /// What acts.
    pub kind: LoadKind,
    /// Factor in time.
    pub amplitude: Amplitude,
}

/// What a load is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadKind {
    /// Force per reference area, in Pa, of fixed direction.
    Traction([f64; 3]),
    /// Pressure in Pa on the surface as it moves and stretches, positive towards the body.
    Pressure(f64),
}

/// Forces and moments at nodes, of fixed direction.
#[derive(Clone, Debug)]
pub struct NodalLoad {
    /// Name as in the case file.
    pub name: String,
    /// Nodes of the mesh, each with its own share.
    pub nodes: Vec<u32>,
    /// Force on each node, N.
    pub force: [f64; 3],
    /// Moment on each node, N m; of nodes that have small rotations.
    pub moment: [f64; 3],
    /// Factor in time.
    pub amplitude: Amplitude,
}
