//! Points that leave their contact to others, and do so for a whole attempt or not at all.
//!
//! Whether those opposite to a point are watched may depend on its force: it pushes them open, they no longer tell, and once it tells in their
//! place they are pushed shut again. A point that comes back after it has left does not leave again in the attempt.

/// What points have done in an attempt; both ascending.
#[derive(Debug, Default)]
pub(super) struct Telling {
    left: Vec<u32>,
    back: Vec<u32>,
}

impl Telling {
    /// Begins an attempt.
    pub(super) fn begin(&mut self) {
        self.left.clear();
        self.back.clear();
    }

    /// Whether a point leaves its contact to others, where it `may`.
    pub(super) fn leaves(&mut self, point: u32, may: bool) -> bool {
        match (may, self.left.binary_search(&point)) {
            (false, Err(_)) => false,
            (true, Err(place)) => {
                self.left.insert(place, point);
                true
            }
            (may, Ok(_)) => {
                let place = self.back.binary_search(&point);
                if let (false, Err(place)) = (may, place) {
                    self.back.insert(place, point);
                }
                may && place.is_err()
            }
        }
    }

    /// Whether a point has left its contact, and is not back.
    pub(super) fn has_left(&self, point: u32) -> bool {
        self.left.binary_search(&point).is_ok() && self.back.binary_search(&point).is_err()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_that_comes_back_stays_for_the_attempt() {
        let mut telling = Telling::default();
        let mut told: Vec<bool> = Vec::new();
        for may in [false, true, true, false, true, false, true] {
            told.push(!telling.leaves(3, may));
        }
        assert_eq!(told, [true, false, false, true, true, true, true]);
        assert!(!telling.has_left(3));
        assert!(telling.leaves(4, true), "of others nothing is known");
        assert!(telling.has_left(4));
        telling.begin();
        assert!(telling.leaves(3, true));
    }
}
