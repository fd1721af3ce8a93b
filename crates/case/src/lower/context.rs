//! What all sections of a case may read.

use std::path::Path;

use super::course::Signals;
use super::plan::Plan;
use crate::schema::{Case, Scheme};

/// The case, and what the sections before the mesh come to.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    pub(super) case: &'a Case,
    /// Functions of time.
    pub(super) signals: &'a Signals,
    /// The zones of the case.
    pub(super) plan: &'a Plan,
    /// Path of the case file, and the folder that its paths start from.
    pub(super) file: &'a Path,
    pub(super) folder: &'a Path,
    /// Whether a reduction that is made anew is saved in its file.
    pub(super) saves: bool,
}

impl Context<'_> {
    /// The scheme of a body: that of its zone.
    pub(super) fn scheme_of(&self, body: usize) -> Scheme {
        let zone = self.plan.zone_of(body);
        zone.map_or(self.case.time.scheme(), |zone| self.plan.zones[zone].scheme)
    }
}
