//! The wish of somebody that a computation ends before its result.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether a computation is to end early: a flag that all copies share. Loops that may last look at it, and end without a result where it is
/// set. Once set it stays so.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Asks for the end; whether somebody had asked before.
    pub fn set(&self) -> bool {
        self.0.swap(true, Ordering::Relaxed)
    }

    /// Whether somebody has asked for the end.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_copies_are_one_flag() {
        let (one, other) = (Interrupt::default(), Interrupt::default());
        let copy = one.clone();
        assert!(!copy.is_set() && !copy.set());
        assert!(one.is_set() && one.set() && !other.is_set());
    }
}
