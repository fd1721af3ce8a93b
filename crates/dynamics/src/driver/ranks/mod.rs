//! What this process has of a run that several compute.

pub(crate) mod shared_looks;

use crate::shared::Shared;

/// What this process has of a run that several compute.
#[derive(Default)]
pub(crate) struct RankWork {
    /// What this process has of a run that several compute; none of one process.
    pub(crate) shared: Option<Box<Shared>>,
    /// Whether several compute it.
    pub(crate) several: bool,
    /// The last step at which it was asked whether to look at what is assumed small, of such a run.
    pub(crate) looked: u64,
}
