//! From a state to the next one: the place where bodies, contacts and time schemes meet.
//!
//! [`System`] never changes, [`State`] holds everything that influences the next step or the results, and the
//! [`Driver`] owns factors and scratch. [`march`] is the loop; observers see accepted states only. No files, no
//! printing.

mod assembly_energy;
mod at_rows;
mod blocks;
mod body_energies;
mod certificate;
mod chatter;
mod choice;
mod columns;
mod compliance;
pub mod condensed;
mod contact_sums;
mod control;
mod costs;
mod distributed;
mod driver;
mod error;
mod exchange;
mod groups;
mod impact;
mod iterated;
pub mod landing;
mod ledger;
mod lent;
mod load_forces;
mod low_rank;
mod march;
mod moment;
mod on_ranks;
pub mod operator;
pub mod records;
mod replicated;
mod report;
mod resultant;
pub(crate) mod shapes;
mod shared;
mod small;
pub mod state;
mod step_forces;
mod step_terms;
mod sum;
mod tolerated;
mod update;
mod watch;

pub use assembly_energy::{AssemblyEnergies, AssemblyEnergy};
pub use carom_algebra::Interrupt;
use carom_nonsmooth::{coulomb, interface};
pub use carom_schemes as scheme;
use carom_schemes::step_map;
use carom_system as system;
pub use replicated::Alike;

pub use carom_signals::{Amplitude, Held};
pub use certificate::{Certificate, Crossing, Findings, Told};
pub use control::{Attempts, Control, Event, adapt};
pub use costs::{Costs, LONGEST, Phases, Work};
pub use coulomb::{FrictionFailure, FrictionProblem, FrictionSolution, Slip, Tangential};
pub use driver::Rubbing;
pub use driver::linearised;
pub use driver::linked;
pub use driver::paired;
pub use driver::record::contact_report;
pub use driver::{Driver, RankShare, why_not_on_ranks};
pub use error::{Error, MeshNode};
pub use exchange::Exchange;
pub use impact::{Impact, NoRestitution};
pub use interface::{Candidate, Failure, InterfaceProblem, InterfaceSolution};
pub use ledger::{Balance, Ledger};
pub use load_forces::load_forces;
pub use march::{
    FailedProblem, Going, Observer, Outcome, Scope, Silent, Stepper, Watched, go_on, is_at_end,
    march, step_count,
};
pub use moment::moment;
pub use on_ranks::OnRanks;
pub use records::{ContactRecord, Records};
pub use report::{ContactReport, ContactSample, Notice, Notices, StepReport};
pub use resultant::Resultant;
pub use scheme::{EnergyIdentity, Scheme, TimeScheme};
pub use shared::SharedNodes;
pub use small::{Largest, Locking, SmallSliding, SmallStrain, Smallness};
pub use state::{InterfaceState, State};
pub use step_map::{Impulse, Row, StepMap};
pub use system::{
    Adaptive, Closing, ContactPair, Damping, Iteration, Load, LoadKind, Mass, Model, ModelBody,
    ModelConstraint, ModelContact, ModelDiscrete, ModelLink, ModelRigid, ModelScheme, ModelTarget,
    MomentAbout, Motion, NamedSupport, NodalLoad, Nonlinear, NumberedForce, Order, Preload,
    Prescribed, PrescribedTurn, Refused, ReportedSupport, Solver, Support, System,
};
pub use tolerated::Tolerated;
