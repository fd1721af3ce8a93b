//! Memory of what fronts leave to their parents.

/// Squares of numbers that fronts take and give back. Free ones are kept, since the system would clear new pages for each: as many as, with
/// those in use, are no more than are in use at once in any case.
pub(super) struct Squares {
    free: Vec<Vec<f64>>,
    /// Numbers in free squares and in those in use.
    held: usize,
    /// Numbers that are in use at once, at the most, where the tree is taken front after front.
    most: usize,
}

impl Squares {
    pub fn new(most: usize) -> Squares {
        Squares {
            free: Vec::new(),
            held: 0,
            most,
        }
    }

    /// A vector of at least `length` numbers, of any value. None without memory.
    pub fn take(&mut self, length: usize) -> Option<Vec<f64>> {
        let free = self.free.iter().map(Vec::len).enumerate();
        let fits = free.filter(|(_, own)| (length..=2 * length).contains(own));
        if let Some((k, _)) = fits.min_by_key(|(_, own)| *own) {
            return Some(self.free.swap_remove(k));
        }
        self.held += length;
        while self.held > self.most && !self.free.is_empty() {
            self.drop_one(self.held - self.most);
        }
        Vec::<f64>::new().try_reserve_exact(length).ok()?;
        // pages that nobody writes to, those of the upper triangle, are not there
        Some(vec![0.0; length])
    }

    /// Leaves the smallest free vector of at least `length` numbers to the system, or the largest of all.
    fn drop_one(&mut self, length: usize) {
        let sizes = self.free.iter().map(Vec::len).enumerate();
        let least = sizes.min_by_key(|(_, own)| match *own >= length {
            true => (0, *own),
            false => (1, usize::MAX - *own),
        });
        if let Some((k, size)) = least {
            self.free.swap_remove(k);
            self.held -= size;
        }
    }

    /// Keeps a vector for another front.
    pub fn give(&mut self, vector: Vec<f64>) {
        if !vector.is_empty() {
            self.free.push(vector);
        }
    }

    /// Tells that a factorisation has ended, well or not: no vector is in use. `keep`: whether free ones stay for the next.
    pub fn end(&mut self, keep: bool) {
        if !keep {
            self.free.clear();
        }
        self.held = self.free.iter().map(Vec::len).sum();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_is_held_than_is_in_use_at_once() {
        let mut squares = Squares::new(100);
        let [a, b] = [60, 40].map(|length| squares.take(length).unwrap());
        squares.give(b);
        squares.give(a);
        // 60 fits; of 40 and 20 new numbers the former find a free place
        let (c, d) = (squares.take(50).unwrap(), squares.take(35).unwrap());
        assert_eq!((c.len(), d.len()), (60, 40));
        squares.give(c);
        // nothing fits, and what is free makes room
        let e = squares.take(10).unwrap();
        assert_eq!((e.len(), squares.held, squares.free.len()), (10, 50, 0));
        // what is in use at once may be more than was known
        let f = squares.take(90).unwrap();
        assert_eq!((f.len(), squares.held), (90, 140));
        squares.give(f);
        squares.give(d);
        // e is lost, as vectors are where a factorisation fails
        squares.end(true);
        assert_eq!((squares.held, squares.free.len()), (130, 2));
        squares.end(false);
        assert_eq!((squares.held, squares.free.len()), (0, 0));
    }
}
