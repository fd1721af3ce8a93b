//! Loads and motions in time, damping, a static stage before the dynamics, and how the equations of a step are solved.

use carom_signals::Amplitude;

use crate::loads::{Load, NodalLoad};
use crate::solver::Solver;

/// Nodes that move as prescribed.
#[derive(Clone, Debug)]
pub struct Prescribed {
    /// Nodes of the mesh.
    pub nodes: Vec<u32>,
    /// Displacement in m as a function of time, by direction; none where the direction is free.
    pub displacement: [Option<Amplitude>; 3],
}

/// A rotation that follows a function of time about one axis of the frame of a node, which no other rotation moves; where
/// rotations are small about an axis of coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribedTurn {
    /// Node of the mesh.
    pub node: u32,
    /// Axis, from 0: the third one in the plane.
    pub axis: usize,
    /// Angle in rad.
    pub angle: Amplitude,
}

/// Rayleigh damping of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// Factor of the mass, 1/s. It brakes rigid motion too.
    pub mass: f64,
    /// Factor of the stiffness, s; for small strain only.
    pub stiffness: f64,
}

/// A static stage before the dynamics: loads and contacts find their equilibrium, without inertia. Contact laws in the rate
/// hold in the gap there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preload {
    /// End of the stage, s.
    pub end: f64,
    /// Equal steps to it, over which gravity and constant loads grow from nothing.
    pub steps: u64,
}

/// How the equations of a step are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Residual, relative to the largest of the forces that balance, at which a step is solved.
    pub tolerance: f64,
    /// Iterations after which a step has failed.
    pub passes: usize,
    /// Times that a step that failed is halved before the run ends.
    pub halvings: u32,
    /// How linear equations are solved.
    pub solver: Solver,
}

impl Default for Iteration {
    fn default() -> Iteration {
        Iteration {
            tolerance: 1e-10,
            passes: 30,
            halvings: 6,
            solver: Solver::Auto,
        }
    }
}

/// Loads and motions in time, damping, a static stage, and the rules of the iterations.
#[derive(Clone, Debug, Default)]
pub struct Nonlinear {
    /// Loads on surfaces.
    pub loads: Vec<Load>,
    /// Forces and moments at nodes.
    pub nodal: Vec<NodalLoad>,
    /// Acceleration of the frame of coordinates, m/s², by direction: displacements, velocities and accelerations of the run are
    /// relative to it, and each body feels the inertia force -M r a(t), with r a unit translation of all nodes.
    pub base: [Option<Amplitude>; 3],
    /// Prescribed motions.
    pub motions: Vec<Prescribed>,
    /// Prescribed rotations.
    pub turns: Vec<PrescribedTurn>,
    /// Damping by body; empty for none.
    pub damping: Vec<Damping>,
    /// The static stage.
    pub preload: Option<Preload>,
    /// Nodes of the mesh that are held over the static stage: their bodies wait for the dynamics.
    pub waiting: Vec<u32>,
    /// How steps are solved.
    pub iteration: Iteration,
}

impl Nonlinear {
    /// Whether the energy of the steps is balanced by works because of anything in here.
    pub(crate) fn asks(&self) -> bool {
        !self.loads.is_empty()
            || !self.nodal.is_empty()
            || self.base.iter().any(Option::is_some)
            || !self.motions.is_empty()
            || !self.turns.is_empty()
            || self.damping.iter().any(|d| *d != Damping::default())
            || self.preload.is_some()
    }
}
