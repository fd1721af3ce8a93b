//! What this process has of a run that several compute.

mod shared_looks;

use crate::shared::Shared;

/// What this process has of a run that several compute.
#[derive(Default)]
pub(crate) struct RankWork {
    /// What this process has of a run that several compute; none of one process.
    shared: Option<Box<Shared>>,
    /// Whether several compute it.
    several: bool,
    /// The last step at which it was asked whether to look at what is assumed small, of such a run.
    looked: u64,
}

impl RankWork {
    /// Begins the work of a run that several compute.
    pub(crate) fn begin(&mut self, shared: Shared) {
        self.shared = Some(Box::new(shared));
        self.several = true;
    }

    /// Whether several compute the run.
    pub(crate) fn are_several(&self) -> bool {
        self.several
    }

    /// What this process has of it; none of one process, or while a step has taken it.
    pub(crate) fn shared(&self) -> Option<&Shared> {
        self.shared.as_deref()
    }

    /// The same, to exchange something.
    pub(crate) fn shared_mut(&mut self) -> Option<&mut Shared> {
        self.shared.as_deref_mut()
    }

    /// Takes it, for a step that keeps it again.
    pub(crate) fn take(&mut self) -> Option<Box<Shared>> {
        self.shared.take()
    }

    /// Keeps what a step had taken.
    pub(crate) fn keep(&mut self, shared: Box<Shared>) {
        self.shared = Some(shared);
    }

    /// Whether it was not asked yet at a step whether to look at what is assumed small; then it is.
    pub(crate) fn asks(&mut self, step: u64) -> bool {
        step > std::mem::replace(&mut self.looked, step)
    }
}
