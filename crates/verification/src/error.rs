//! Why a check could not be made.

/// Errors of this crate: a model that cannot be built or run, never a wrong number.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A matrix that has no factor or no eigenvalues.
    #[error(transparent)]
    Algebra(#[from] carom_algebra::Error),
    /// A body that could not be made.
    #[error(transparent)]
    Body(#[from] carom_bodies::Error),
    /// A mesh could not be generated or its surfaces not be found.
    #[error(transparent)]
    Mesh(#[from] carom_mesh::Error),
    /// A mesh file could not be read.
    #[error(transparent)]
    Read(#[from] carom_mesh::read::ReadError),
    /// Modes that could not be computed.
    #[error(transparent)]
    Reduction(#[from] carom_reduction::Error),
    /// Models that cannot be coupled.
    #[error(transparent)]
    Arlequin(#[from] carom_arlequin::Error),
    /// A system was refused or a step failed.
    #[error(transparent)]
    Dynamics(#[from] carom_dynamics::Error),
    /// Zones were refused or an outer step failed.
    #[error(transparent)]
    Zones(#[from] carom_zones::Error),
    /// A system could not be built.
    #[error(transparent)]
    System(#[from] carom_system::Error),
    /// The exact solution was refused.
    #[error(transparent)]
    Exact(#[from] carom_exact::Error),
    /// A pool of threads could not be started.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// Points that make no curve of a stop.
    #[error(transparent)]
    Curve(#[from] carom_contact::law::CurveError),
    /// Points that make no curve of a spring.
    #[error(transparent)]
    Spring(#[from] carom_bodies::CurveError),
    /// Points that make no function of time.
    #[error(transparent)]
    Signal(#[from] carom_signals::Error),
    /// Zones of equal steps that are not one system.
    #[error("the zones step apart")]
    Apart,
    /// A mesh file of a case is not embedded.
    #[error("no mesh '{name}' is embedded")]
    NoMesh {
        /// Its name in the folder of the cases.
        name: String,
    },
    /// A case of the project could not be built, run or judged.
    #[error("{cause}")]
    Case {
        /// Why.
        cause: String,
    },
    /// A mesh lacks a group.
    #[error("the mesh has no group '{name}'")]
    Group {
        /// Name of the group.
        name: String,
    },
}
