//! What a model whose forces are not all linear does not accept.

use thiserror::Error as ThisError;

/// What is refused in a model whose forces are not all linear.
#[derive(Clone, Debug, PartialEq, Eq, ThisError)]
pub enum Refused {
    /// Where the law of a contact, by its name, holds.
    #[error("integration of contact '{0}'")]
    Integration(String),
    /// A body of beams or shells with finite rotations, by its name.
    #[error("body '{0}' with finite rotations")]
    FiniteRotations(String),
    /// A link whose rows turn, by its name.
    #[error("link '{0}' of bodies with finite rotations")]
    TurningLink(String),
    /// The damping of a body, by its name.
    #[error("damping of body '{0}'")]
    Damping(String),
    /// The damping of modes of a body, by its name.
    #[error("damping of the modes of body '{0}'")]
    ModalDamping(String),
    /// The solution of steps by iterations.
    #[error("an iterative solver")]
    Iterative,
    /// A static stage.
    #[error("a static stage")]
    StaticStage,
    /// A load on a rigid body.
    #[error("a pressure or a traction on node {node} of the mesh, which a rigid body carries")]
    Load {
        /// Node of the mesh.
        node: u32,
    },
    /// A load at nodes, by its name.
    #[error("the load '{0}'")]
    NodalLoad(String),
    /// Something of a rigid body, by its name.
    #[error("the rigid body '{0}'")]
    Rigid(String),
    /// A prescribed motion.
    #[error("the motion of node {node} of the mesh in direction {direction}")]
    Motion {
        /// Node of the mesh.
        node: u32,
        /// Direction, from 0.
        direction: usize,
    },
}
