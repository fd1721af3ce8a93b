//! Discretised bodies: mass, internal forces, stiffness, energies, stresses and their stability limit.
//!
//! A body does not know what touches it, nor how time goes on. Vectors of unknowns are those of the whole system;
//! which of their entries belong to a node is told by the map of [`unknowns`](carom_algebra::unknowns).

mod bar;
mod beam;
mod block;
mod body;
mod chunk;
mod continuum;
mod discrete;
mod distortion;
mod error;
mod finite;
mod flowing;
mod force;
mod frequency;
mod gather;
mod gyroscopic;
mod kinematics;
mod layering;
mod layers;
mod locking;
mod nodes;
mod peak;
mod pretension;
mod reduced;
mod reducible;
mod release;
mod rigid;
mod scaling;
mod scratch;
mod share;
mod shell;
mod single;
mod size;
mod solid;
mod spec;
mod stability;
mod stresses;
mod together;
mod turning;
mod weights;

pub use beam::{
    Beam, BeamAxis, BeamSection, BeamTheory, Extremes, LAYERS, LargeBeam, Rotations, SectionForces,
    SectionProperties, SectionShape, SectionStress,
};
pub use block::by_kind;
pub use body::Body;
pub use discrete::{
    Across, Curve, CurveError, Discrete, DiscreteKind, DiscreteSpec, FluidGap, Link, PointMass,
    Tightened, VisitRow,
};
pub use distortion::{Distortion, Extreme};
pub use error::Error;
pub use finite::{
    BulkViscosity, Deleted, FollowerPressure, Formulation, FrequencyBound, Looks, Placement, Seen,
    Stored,
};
pub use flowing::Fibre;
pub use kinematics::{Kinematics, MassKind};
pub use layers::TightenedLayer;
pub use locking::Bending;
pub use peak::{LookCost, PeakStress, StressedState};
pub use pretension::{Bolt, TightenedCell};
pub use reduced::{Reduced, ReducedMass, ReducedMatrices, Reduction};
pub use reducible::Reducible;
pub use release::Release;
pub use rigid::{Inertia, Rigid};
pub use scaling::{MARGIN, MassScaling};
pub use scratch::Scratch;
pub use share::{NotShared, Share};
pub use shell::{
    LAYERS as SHELL_LAYERS, Ply, Resultants, Shell, ShellDefect, ShellPlate, ShellSection, plates,
    shell_defects,
};
pub use size::{height, smallest as smallest_size};
pub use solid::Solid;
pub use spec::BodySpec;
pub use turning::balanced;
pub use weights::CellWeights;
