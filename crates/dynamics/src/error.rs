//! Why a system could not be built or a step not be taken.

use std::fmt;

use carom_ranks::memory::Short;
use thiserror::Error as ThisError;

use crate::system::System;

/// A node of the mesh that a message names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshNode {
    /// Its number in the mesh, from 0.
    pub number: u32,
    /// Its place in the mesh, m.
    pub x: [f64; 3],
}

impl MeshNode {
    /// Of a node by its system number.
    pub(crate) fn of(system: &System, node: u32) -> Box<MeshNode> {
        Box::new(MeshNode {
            number: system.mesh_node[node as usize],
            x: system.x[node as usize],
        })
    }
}

impl fmt::Display for MeshNode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.x;
        let number = self.number;
        write!(
            f,
            "node {number} of the mesh at ({x:.4e}, {y:.4e}, {z:.4e}) m"
        )
    }
}

/// Errors of this crate.
#[derive(Debug, ThisError)]
pub enum Error {
    /// A system could not be built.
    #[error(transparent)]
    System(#[from] carom_system::Error),
    /// A body could not be built.
    #[error(transparent)]
    Body(#[from] carom_bodies::Error),
    /// A matrix could not be factorised.
    #[error("the {matrix} of the part that holds {node}: {cause}")]
    Factor {
        /// Which matrix.
        matrix: &'static str,
        /// A node in the part.
        node: Box<MeshNode>,
        /// Cause.
        cause: carom_algebra::Error,
    },
    /// The small factor of the interface problem failed: its rows are redundant.
    #[error("step {step}: the contact problem of {points} points is singular: {cause}")]
    Interface {
        /// Number of the step.
        step: u64,
        /// Closed points.
        points: usize,
        /// Cause.
        cause: carom_algebra::Error,
    },
    /// The statuses of the contact points did not settle.
    #[error(
        "step {step}: the contact statuses did not converge in {passes} passes; point {point} of contact '{contact}' still changes"
    )]
    Statuses {
        /// Number of the step.
        step: u64,
        /// Passes made.
        passes: usize,
        /// Name of the contact.
        contact: String,
        /// A point that still changes.
        point: usize,
    },
    /// The contact problem with friction was not solved.
    #[error("step {step}: {point}: the contact problem with friction was not solved: {cause}")]
    Friction {
        /// Number of the step.
        step: u64,
        /// The point that is furthest from its laws.
        point: String,
        /// Cause.
        cause: crate::coulomb::FrictionFailure,
    },
    /// A displacement, velocity or force is infinite or not a number.
    #[error(
        "step {step}, t = {time:e} s: the {quantity} is not finite at {node}, in body '{body}', cell {} of block {}; the step is too large for the scheme, or the model is not supported",
        cell.index, cell.block
    )]
    NotFinite {
        /// Number of the step.
        step: u64,
        /// Time at its end, s.
        time: f64,
        /// What is not finite.
        quantity: &'static str,
        /// The first node where it is not.
        node: Box<MeshNode>,
        /// Its body.
        body: Box<str>,
        /// The first cell of the body at the node.
        cell: carom_mesh::ElementId,
    },
    /// Energy grows with the smallest step too.
    #[error(
        "step {step}, t = {time:e} s: the energy grows without a load, with the smallest step of {dt:.4e} s too; \
         another contact law or scheme is needed"
    )]
    EnergyGrowth {
        /// Number of the step.
        step: u64,
        /// Time at its start, s.
        time: f64,
        /// Its size, s.
        dt: f64,
    },
    /// Elements have shortened so far that no part of an explicit step is stable.
    #[error(
        "step {step}, t = {time:e} s: elements have shortened or bulk viscosity acts: the critical step, that of {place}, is now {critical:.4e} s; \
         the step that fits, {fitting:.4e} s, is below the smallest part of a step, {dt:.4e} s"
    )]
    Shortened {
        /// Number of the step.
        step: u64,
        /// Time at its start, s.
        time: f64,
        /// The smallest part of it, s.
        dt: f64,
        /// The critical step 2/ω, s.
        critical: f64,
        /// The largest step that leaves its margin, or is the part of the critical step that was asked for, s.
        fitting: f64,
        /// The element that bounds it, in words.
        place: Box<str>,
    },
    /// The bulk viscosity of a step is stronger than its size is stable with.
    #[error(
        "step {step}, t = {time:e} s: the compression in it is so fast that bulk viscosity makes the critical step {critical:.4e} s, below \
         the smallest part of a step, {dt:.4e} s; give a smaller step"
    )]
    Viscous {
        /// Number of the step.
        step: u64,
        /// Time at its start, s.
        time: f64,
        /// Size of the attempt, s.
        dt: f64,
        /// The critical step with the viscosity of the attempt, s.
        critical: f64,
    },
    /// A secondary surface without area.
    #[error("contact '{contact}': the matrix of the multiplier on the secondary surface: {cause}")]
    WeakForm {
        /// Name of the contact.
        contact: String,
        /// Cause.
        cause: carom_algebra::Error,
    },
    /// Rows of links that say the same twice.
    #[error("the {rows} rows of the links are redundant: {cause}")]
    Redundant {
        /// Number of rows.
        rows: usize,
        /// Cause.
        cause: carom_algebra::Error,
    },
    /// A function of time that is none.
    #[error(transparent)]
    Signal(#[from] carom_signals::Error),
    /// The equations of a step were not solved.
    #[error(
        "step {step}, t = {time:e} s: no equilibrium in {passes} iterations with a step of {dt:.4e} s; \
         the residual is largest at {node}, in body '{body}', cell {} of block {}{contact}; residuals relative to the forces: {history}",
        cell.index, cell.block
    )]
    Equilibrium {
        /// Number of the step.
        step: u64,
        /// Time at its start, s.
        time: f64,
        /// Size of the last attempt, s.
        dt: f64,
        /// Iterations of the last attempt.
        passes: usize,
        /// Node with the largest residual.
        node: Box<MeshNode>,
        /// Its body.
        body: Box<str>,
        /// The first cell of the body at the node.
        cell: carom_mesh::ElementId,
        /// The contact point that agrees least, as a text; empty without contact.
        contact: Box<str>,
        /// Residuals of the last iterations.
        history: Box<str>,
    },
    /// A part of the model that can move without any force, and that no contact could hold.
    #[error(
        "the static stage: body '{body}' can {motion} without any force{}; hold it by supports or a contact, or remove the static stage",
        beside(.constraints)
    )]
    FreeMotion {
        /// Name of the body.
        body: String,
        /// The motion.
        motion: String,
        /// Names of the constraints that join the body to others and leave this motion free.
        constraints: Vec<String>,
    },
    /// A part of the model that supports leave free, and whose loads no contact takes.
    #[error(
        "step {step}, t = {time:e} s: the static stage has no equilibrium: body '{body}' can {motion}, its loads act in this direction, \
         and no contact is ahead; hold it by supports or friction, or remove the static stage"
    )]
    Unheld {
        /// Number of the step.
        step: u64,
        /// Time at its end, s.
        time: f64,
        /// Name of the body.
        body: String,
        /// The motion.
        motion: String,
    },
    /// A static step without equilibrium, near which the stiffness is not positive definite.
    #[error(
        "{cause}; the stiffness near it is not positive definite, as beyond a limit point or a bifurcation, from where bodies snap to another \
         equilibrium: take more iterations (passes), or end the static stage before it and go on with the dynamics"
    )]
    Unstable {
        /// The error of the last attempt.
        cause: Box<Error>,
    },
    /// A step failed on one of several ranks, and so on all.
    #[error("rank {rank}: {cause}")]
    OnRank {
        /// The first rank on which it failed.
        rank: usize,
        /// Its error, in words.
        cause: String,
    },
    /// Ranks that take the same steps have come to different motions.
    #[error(
        "ranks have come to different motions at {time:e} s: they must run the same program on processors of one kind"
    )]
    RanksDiffer {
        /// End of the step, s.
        time: f64,
    },
    /// The first rank ended the run: its results could not be written.
    #[error("rank 0 could not write the results")]
    FirstRank,
    /// A saved state that does not belong to this system.
    #[error("the saved state cannot be read: {cause}")]
    State {
        /// Cause.
        cause: String,
    },
    /// What a step needs has no room.
    #[error("step {step}: {cause}")]
    Memory {
        /// Number of the step.
        step: u64,
        /// What, and how much.
        cause: Short,
    },
    /// Somebody asked for the end of the step under way; the state is the one before it.
    #[error("interrupted")]
    Interrupted,
    /// A stepper of another crate failed.
    #[error(transparent)]
    Stepper(Box<dyn std::error::Error + Send + Sync>),
    /// The library that shares out the elements does not.
    #[error("elements are not shared out over the ranks: {0}")]
    Partition(String),
    /// An observer failed: the results could not be written.
    #[error("{0}")]
    Observer(#[source] Box<dyn std::error::Error + Send + Sync>),
}

impl Error {
    /// The step from a state has no room.
    pub(crate) fn no_room(step: u64, cause: Short) -> Error {
        Error::Memory {
            step: step + 1,
            cause,
        }
    }

    /// Whether a smaller step would end in the same way.
    pub(crate) fn is_of_any_step(&self) -> bool {
        matches!(self, Error::Interrupted | Error::Memory { .. })
    }
}

/// Constraints that leave a motion free, as an end of a message.
fn beside(constraints: &[String]) -> String {
    match constraints {
        [] => String::new(),
        names => format!(", which constraint '{}' leaves free", names.join("', '")),
    }
}
