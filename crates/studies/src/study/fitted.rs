//! What a fit looked for, and what it found.

use serde_json::json;

use super::quantities::Quantity;
use super::run::Run;
use crate::compare::StepForce;

/// What is wanted.
#[derive(Clone, Debug, PartialEq)]
pub enum Goal {
    /// This value of a quantity.
    Quantity(Quantity, f64),
    /// The least distance ([`StepForce::distance`]) of the contact force from this history.
    Force(StepForce),
}

/// A key that was fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// Its key path.
    pub key: String,
    /// What it was fitted to.
    pub goal: Goal,
    /// What was found. `Err`: why nothing was.
    pub found: Result<Found, String>,
}

/// The run that came nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Its number among the runs, from 0.
    pub run: usize,
    /// The value of the key.
    pub value: f64,
    /// What the case gives with it: the quantity, or the distance of the force.
    pub reached: f64,
}

impl Goal {
    /// What it is a value of, for people.
    pub fn name(&self) -> &'static str {
        match self {
            Goal::Quantity(quantity, _) => quantity.name(),
            Goal::Force(_) => "relative distance of the force",
        }
    }

    /// The history that is wanted, if one is.
    pub fn history(&self) -> Option<&StepForce> {
        match self {
            Goal::Quantity(..) => None,
            Goal::Force(history) => Some(history),
        }
    }

    /// What a run gives; `None` where it has no such thing.
    pub fn of(&self, run: &Run) -> Option<f64> {
        match self {
            Goal::Quantity(quantity, _) => quantity.of(run).map(|measure| measure.value),
            Goal::Force(history) => run.variant.done()?.history.force.distance(history),
        }
    }
}

impl Fitted {
    /// What was found among these runs, in a line for people; `None` where nothing was.
    pub(super) fn text(&self, runs: &[Run]) -> Option<String> {
        let found = self.found.as_ref().ok()?;
        let (key, name) = (&self.key, self.goal.name());
        let run = &runs.get(found.run)?.variant.name;
        Some(format!(
            "{key} = {:.7}: {name} {:.7}, run {run}",
            found.value, found.reached
        ))
    }

    /// `fit.json`: key, goal, value, what it gives, and the run; or why no value was found.
    pub(super) fn json(&self, runs: &[Run]) -> String {
        let goal = match &self.goal {
            Goal::Quantity(quantity, value) => json!({ quantity.column(): value }),
            Goal::Force(_) => json!("force"),
        };
        let text = match &self.found {
            Ok(found) => json!({
                "key": self.key,
                "goal": goal,
                "value": found.value,
                "reached": found.reached,
                "run": runs.get(found.run).map(|run| run.variant.name.clone()),
            }),
            Err(reason) => json!({ "key": self.key, "goal": goal, "reason": reason }),
        };
        format!("{text:#}\n")
    }
}
