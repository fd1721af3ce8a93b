//! From a case file to a model, and the run.
//!
//! Stage one, [`parse`], reads the file as TOML and checks it against the one description in [`schema`]: what comes out is complete and
//! in SI units, or every error there is. Stage two resolves names and reads meshes; it finds the places of its errors with the
//! [`Locator`].

pub mod schema;

mod accelerations;
mod compare;
mod complete;
mod convergence;
mod convert;
mod describe;
mod error;
mod estimate;
mod expect;
mod facts;
mod fit;
mod input;
mod keys;
mod locate;
mod lower;
mod mesh_facts;
mod modes;
mod offenders;
mod origin;
mod parse;
mod ranks;
mod reference;
mod repeat;
mod resume;
mod rules;
mod run;
mod simulation;
mod stepping;
mod study;
mod sweep;
mod tree;
mod validate;
mod words;

pub use compare::{Choices, compare};
pub use complete::{build, build_to_look, build_with};
pub use convert::{NotConverted, convert};
pub use error::{Place, Problem};
pub use estimate::{Estimate, estimate};
pub use facts::Fact;
pub use fit::{Fit, fit};
pub use input::{Input, Source};
pub use locate::Locator;
pub use lower::{AddedForce, Built, BuiltOverlap, BuiltProbe, ExactReference, model};
pub use mesh_facts::mesh_facts;
pub use modes::{Modal, ModesError, modes};
pub use offenders::Offenders;
pub use parse::parse;
pub use ranks::{run_on_ranks, whole_on_ranks};
pub use reference::reference_page;
pub use resume::{NotResumed, Resume};
pub use run::{Failed, Finished, run};
pub use simulation::Simulation;
pub use study::{Axis, study};
pub use sweep::{Sweep, SweepError};
pub use words::facts;
