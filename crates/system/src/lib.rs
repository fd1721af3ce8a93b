//! What never changes during a run, built from a model: bodies, numbering, masses, supports, loads, contacts, schemes.
//!
//! [`Model`] names things as the case file does; [`System`] has them in its own numbers. [`Motion`] holds the vectors of a
//! system. No step is taken here.

mod adaptive;
mod assemblies;
mod assembling;
mod between;
mod both_ways;
mod build;
mod checks;
mod cliques;
mod contact_pair;
mod contacts;
mod cores;
mod error;
mod exposed_faces;
mod extents;
mod initial;
mod integration;
mod link_row;
mod links;
mod loads;
mod made;
mod maps;
mod mass;
mod massless;
mod mid_surfaces;
mod modal;
mod model;
mod moment_arms;
mod moments;
mod motion;
mod needs_factor;
mod nonlinear;
mod numbered;
mod numbered_loads;
mod numbering;
mod part;
mod refused;
mod reported;
mod rigid;
mod round_obstacles;
mod sharp;
mod sliding;
mod solver;
mod stability;
mod system;
mod tolerances;
mod turning;

pub use adaptive::{Adaptive, Closing};
pub use assemblies::{Assemblies, Assembly};
pub use cliques::push_cliques;
pub use contact_pair::ContactPair;
pub use contacts::sides;
pub use cores::{CoreOf, CoreOwner};
pub use error::Error;
pub use link_row::{LinkRow, on};
pub use links::Links;
pub use loads::{Load, LoadKind, NodalLoad};
pub use maps::Maps;
pub use mass::Mass;
pub use modal::{ModalDamping, NumberedModal};
pub use model::{
    Model, ModelBody, ModelConstraint, ModelContact, ModelDiscrete, ModelLink, ModelRigid,
    ModelScheme, ModelTarget, NamedSupport, Support,
};
pub use moment_arms::{Lever, MomentArms};
pub use moments::MomentAbout;
pub use motion::Motion;
pub use nonlinear::{Damping, Iteration, Nonlinear, Preload, Prescribed, PrescribedTurn};
pub use numbered::{Follows, NumberedNonlinear};
pub use numbered_loads::{NumberedForce, NumberedLoad};
pub use part::Kept;
pub use refused::Refused;
pub use reported::{HeldUnknown, ReportedSupport};
pub use rigid::Order;
pub use solver::Solver;
pub use system::{InitialMotion, System};
pub use turning::{Turned, TurningRows};
