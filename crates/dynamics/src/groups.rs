//! Contact points that act on each other only through the unknowns that they share, as those of a diagonal matrix do: which of them
//! belong together.

use std::ops::Range;

use carom_contact::Rows;

/// Nobody.
const NONE: u32 = u32::MAX;

/// Groups of candidates that share no unknown.
#[derive(Default)]
pub(crate) struct Groups {
    /// The first candidate that has an unknown, by unknown; nobody outside of [`Groups::split`].
    owner: Vec<u32>,
    /// A candidate of the same group that comes before, or itself, by candidate.
    before: Vec<u32>,
    /// Places of the candidates, group after group, ascending in each.
    order: Vec<u32>,
    /// Where groups begin in it, and one end more.
    starts: Vec<u32>,
}

impl Groups {
    /// Splits candidates. `unknowns`: of the rows of one; `fixed`: held unknowns, through which nothing acts.
    pub(crate) fn split<'a, I: Iterator<Item = &'a u32>>(
        &mut self,
        candidates: &[u32],
        unknowns: impl Fn(u32) -> I,
        fixed: &[bool],
    ) {
        self.owner.resize(fixed.len(), NONE);
        self.before.clear();
        self.before.extend(0..candidates.len() as u32);
        for (k, &candidate) in candidates.iter().enumerate() {
            for &dof in unknowns(candidate) {
                match self.owner[dof as usize] {
                    _ if fixed[dof as usize] => {}
                    NONE => self.owner[dof as usize] = k as u32,
                    other => self.join(k as u32, other),
                }
            }
        }
        for &candidate in candidates {
            for &dof in unknowns(candidate) {
                self.owner[dof as usize] = NONE;
            }
        }
        for k in 0..candidates.len() as u32 {
            self.before[k as usize] = self.first(k);
        }
        let before = &self.before;
        self.order.clear();
        self.order.extend(0..candidates.len() as u32);
        self.order
            .sort_unstable_by_key(|&k| (before[k as usize], k));
        self.starts.clear();
        for (place, &k) in self.order.iter().enumerate() {
            if before[k as usize] == k {
                self.starts.push(place as u32);
            }
        }
        self.starts.push(candidates.len() as u32);
    }

    fn first(&mut self, mut k: u32) -> u32 {
        while self.before[k as usize] != k {
            let one = self.before[k as usize];
            self.before[k as usize] = self.before[one as usize];
            k = self.before[k as usize];
        }
        k
    }

    fn join(&mut self, one: u32, other: u32) {
        let (one, other) = (self.first(one), self.first(other));
        let (low, high) = (one.min(other), one.max(other));
        self.before[high as usize] = low;
    }

    /// Places of the candidates, group after group.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// The groups, as ranges of [`Groups::order`].
    pub(crate) fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        let ends = self.starts.windows(2);
        ends.map(|ends| ends[0] as usize..ends[1] as usize)
    }

    /// Candidates of the largest.
    pub(crate) fn largest(&self) -> usize {
        self.ranges().map(|range| range.len()).max().unwrap_or(0)
    }
}

/// D = N M⁻¹ Nᵀ over some rows, row-major.
pub(crate) fn compliance(
    of: impl Iterator<Item = u32> + Clone,
    rows: &Rows,
    (mass, fixed): (&[f64], &[bool]),
    matrix: &mut Vec<f64>,
) {
    matrix.clear();
    for one in of.clone() {
        let (dofs, coefficients) = rows.row(one as usize);
        for other in of.clone() {
            let (others, factors) = rows.row(other as usize);
            let mut sum = 0.0;
            for (i, n) in dofs.iter().zip(coefficients) {
                for (j, m) in others.iter().zip(factors) {
                    let at = *i as usize;
                    if i == j && !fixed[at] {
                        sum += n * m / mass[at];
                    }
                }
            }
            matrix.push(sum);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on pairs of the unknowns of a chain: those that share a free unknown are together.
    #[test]
    fn points_that_share_a_free_unknown_are_together() {
        let pairs = [[0, 1], [4, 5], [1, 2], [6, 7], [2, 3], [5, 6]];
        let mut fixed = vec![false; 8];
        let mut groups = Groups::default();
        let split = |groups: &mut Groups, fixed: &[bool]| -> Vec<Vec<u32>> {
            groups.split(&[0, 1, 2, 3, 4, 5], |k| pairs[k as usize].iter(), fixed);
            let ranges = groups.ranges();
            ranges.map(|range| groups.order()[range].to_vec()).collect()
        };
        assert_eq!(split(&mut groups, &fixed), [vec![0, 2, 4], vec![1, 3, 5]]);
        fixed[5] = true;
        let parts = [vec![0, 2, 4], vec![1], vec![3, 5]];
        assert_eq!(split(&mut groups, &fixed), parts);
        assert_eq!(groups.largest(), 3);
    }
}
