//! From a state to the next one: the place where bodies, contacts and time schemes meet.
//!
//! [`System`] never changes, [`State`] holds everything that influences the next step or the results, and the
//! [`Driver`] owns factors and scratch. [`march`] is the loop; observers see accepted states only. No files, no
//! printing.

mod between;
mod compliance;
mod condensed;
mod contacts;
mod control;
mod driver;
mod error;
mod exchange;
mod impact;
mod initial;
mod ledger;
mod loads;
mod maps;
mod march;
mod mass;
mod massless;
mod model;
mod nonlinear;
mod operator;
mod records;
mod refused;
mod resultant;
mod rigid;
mod small;
mod stability;
mod state;
mod sum;
mod system;
mod zones;

use carom_nonsmooth::{coulomb, interface};
pub use carom_schemes as scheme;
use carom_schemes::step_map;

pub use carom_signals::Amplitude;
pub use control::{Adaptive, Closing, Control};
pub use coulomb::{FrictionFailure, FrictionProblem, FrictionSolution, Slip, Tangential};
pub use driver::{Costs, Driver, Phases, Work};
pub use error::Error;
pub use exchange::Exchange;
pub use impact::Impact;
pub use interface::{Candidate, Failure, InterfaceProblem, InterfaceSolution};
pub use ledger::{Balance, Ledger, Tolerated};
pub use loads::{Load, LoadKind, NodalLoad};
pub use march::{FailedProblem, Observer, Outcome, Stepper, march, step_count};
pub use mass::Mass;
pub use model::{
    Model, ModelBody, ModelContact, ModelDiscrete, ModelLink, ModelRigid, ModelScheme, ModelTarget,
    Support,
};
pub use nonlinear::{Damping, Iteration, Nonlinear, Preload, Prescribed, PrescribedTurn};
pub use records::{ContactRecord, Records};
pub use refused::Refused;
pub use resultant::Resultant;
pub use rigid::Order;
pub use scheme::{EnergyIdentity, Scheme, TimeScheme};
pub use small::{Largest, SmallSliding, SmallStrain, Smallness};
pub use state::{ContactReport, ContactSample, InterfaceState, Motion, State, StepReport};
pub use step_map::{Impulse, Row, StepMap};
pub use system::System;
pub use zones::{
    LinkKind, ModelZone, Origin, Sample, Whole, Zoned, Zones, ZonesState, mortar_rows,
};
