//! The static stage before the dynamics of zones that step apart.
//!
//! Rows of links join velocities, and a static stage has none: there they join displacements, and no zone has a step of its own. So all
//! zones are one system over the stage, with the rows as its constraints. Zones that share nodes share them there, and rows
//! between the same node say nothing. What the stage ends with is where the zones begin.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::error::Error;
use crate::model::Zoned;
use crate::places::Places;
use carom_arlequin::{Row, Term};
use carom_contact::law::{Displacement, Law};
use carom_dynamics::Driver;
use carom_dynamics::state::State;
use carom_schemes::{Scheme, Theta};
use carom_system::{Model, ModelLink, System};

/// The static stage of all zones as one system.
pub(crate) struct Stage {
    system: Arc<System>,
    pub(crate) driver: Driver,
    /// Where its numbers are in the model as a whole.
    pub(crate) places: Places,
}

/// What the dynamics of zones begin with.
pub(crate) struct StageEnd<'a> {
    /// The state of the model as a whole.
    pub(crate) whole: &'a State,
    /// Motion, own contacts and records of each zone, in its numbers.
    pub(crate) zones: Vec<State>,
    /// Points of contacts between zones, in the numbers of the whole.
    pub(crate) between: Vec<usize>,
}

impl Stage {
    /// `None` without a static stage. `whole`: the system that results are of.
    ///
    /// # Errors
    /// A body that nothing holds, elements inside out.
    pub(crate) fn new(zoned: &Zoned, whole: &System) -> Result<Option<Stage>, Error> {
        if zoned.model.nonlinear.preload.is_none() {
            return Ok(None);
        }
        let system = System::new(zoned.staged())?;
        let driver = Driver::new(Arc::clone(&system))?;
        let bodies = zoned.model.bodies.len() + zoned.model.discrete.len();
        let bodies: Vec<usize> = (0..bodies).collect();
        let contacts: Vec<usize> = (0..zoned.model.contacts.len()).collect();
        let mut taken = vec![false; whole.unknowns()];
        let parts = (&bodies[..], &contacts[..]);
        let places = Places::new(driver.system(), parts, whole, &mut taken);
        Ok(Some(Stage {
            system,
            driver,
            places,
        }))
    }

    /// The same from a state of it.
    ///
    /// # Errors
    /// As [`Stage::new`]; a state of another model.
    pub(crate) fn resume(self, state: &State) -> Result<Stage, Error> {
        state.check(self.driver.system())?;
        let system = Arc::clone(&self.system);
        let driver = Driver::resume(system, state.clone())?;
        Ok(Stage { driver, ..self })
    }

    /// Whether the dynamics follow.
    pub(crate) fn is_over(&self) -> bool {
        self.driver.state().step >= self.driver.system().static_steps()
    }
}

impl Zoned {
    /// Refuses a static stage that has no start.
    ///
    /// # Errors
    /// A body that nothing holds, elements inside out.
    pub fn check_stage(&self) -> Result<(), Error> {
        if self.model.nonlinear.preload.is_some() {
            Driver::new(System::new(self.staged())?)?;
        }
        Ok(())
    }

    /// The model of the static stage. Schemes and projections are of the dynamics.
    fn staged(&self) -> Model {
        let mut model = self.model.clone();
        model.scheme = Scheme::Theta(Theta { theta: 0.5 });
        // the dynamics of zones know no forces of named supports either
        model.named_supports.clear();
        for contact in &mut model.contacts {
            if contact.law.get().projects() {
                contact.law = Law::Displacement(Displacement { projection: false });
            }
        }
        let links = self.links.iter().map(|link| ModelLink {
            name: link.name.clone(),
            zones: [0, 0],
            rows: link.rows.iter().filter_map(merged).collect(),
        });
        model.links = links.filter(|link| !link.rows.is_empty()).collect();
        model
    }
}

/// A row between zones that share their nodes; none where both sides are the same.
fn merged(row: &Row) -> Option<Row> {
    let mut sums: BTreeMap<(u32, u32), [f64; 2]> = BTreeMap::new();
    for (side, terms) in [&row.inner, &row.outer].into_iter().enumerate() {
        for term in terms {
            sums.entry((term.node, term.component)).or_default()[side] += term.coefficient;
        }
    }
    if sums
        .values()
        .all(|[inner, outer]| *outer == 0.0 || *inner == 0.0)
    {
        return Some(row.clone());
    }
    let largest = sums.values().flatten().fold(0.0_f64, |m, c| m.max(c.abs()));
    let left: Vec<Term> = sums
        .iter()
        .map(|(&(node, component), [inner, outer])| Term {
            node,
            component,
            coefficient: inner - outer,
        })
        .filter(|term| term.coefficient.abs() > 1e-12 * largest)
        .collect();
    (!left.is_empty()).then(|| Row {
        inner: left,
        outer: Vec::new(),
        ..row.clone()
    })
}
