//! The forces of a step by what they come from, and what their balance is made of.

use serde::{Deserialize, Serialize};

/// One thing of each force in the balance of a step,
/// `load + contact + link + reaction = inertia + internal + damping`; springs are a part of the internal forces, told apart since their sum on a
/// body need not vanish.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepForces<T> {
    /// Of loads and weight.
    pub load: T,
    /// Of contacts, friction included.
    pub contact: T,
    /// Of supports.
    pub reaction: T,
    /// Of inertia.
    pub inertia: T,
    /// Of the bodies.
    pub internal: T,
    /// Of damping.
    pub damping: T,
    /// Of links between zones.
    pub link: T,
    /// Of springs.
    pub spring: T,
}

impl<T> StepForces<T> {
    /// All of them.
    pub fn each(&self) -> [&T; 8] {
        [
            &self.load,
            &self.contact,
            &self.reaction,
            &self.inertia,
            &self.internal,
            &self.damping,
            &self.link,
            &self.spring,
        ]
    }

    /// The same to be changed.
    pub fn each_mut(&mut self) -> [&mut T; 8] {
        [
            &mut self.load,
            &mut self.contact,
            &mut self.reaction,
            &mut self.inertia,
            &mut self.internal,
            &mut self.damping,
            &mut self.link,
            &mut self.spring,
        ]
    }
}

impl StepForces<Vec<f64>> {
    /// Whether none of them is kept.
    pub fn is_empty(&self) -> bool {
        self.each().iter().all(|force| force.is_empty())
    }
}

/// One thing of each force from outside of the bodies, as the balance of momentum takes them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct OutsideForces<T> {
    /// Of loads and weight.
    pub(crate) loads: T,
    /// Of contacts.
    pub(crate) contacts: T,
    /// Of supports.
    pub(crate) supports: T,
    /// Of supports against contact forces, where these have an impulse of their own.
    pub(crate) held: T,
    /// Of links between zones, less damping.
    pub(crate) links: T,
}
