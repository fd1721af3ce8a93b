//! Contact points that act on each other only through what they share, an unknown of a diagonal matrix or a factor: which of them
//! belong together.

use std::ops::Range;

use carom_algebra::unknowns::Unknowns;
use carom_contact::Rows;
use carom_nonsmooth::{Compliance, Lumped, Unknown};

/// Nobody.
const NONE: u32 = u32::MAX;

/// Groups of candidates that share nothing.
#[derive(Default)]
pub(crate) struct Groups {
    /// The first candidate that has a key, by key; nobody outside of [`Groups::split`].
    owner: Vec<u32>,
    /// A candidate of the same group that comes before, or itself, by candidate.
    before: Vec<u32>,
    /// Places of the candidates, group after group, ascending in each.
    order: Vec<u32>,
    /// Where groups begin in it, and one end more.
    starts: Vec<u32>,
}

impl Groups {
    /// Splits candidates into those that share a key. `keys`: of one, below `count`.
    pub(crate) fn split<I: Iterator<Item = usize>>(
        &mut self,
        candidates: &[u32],
        keys: impl Fn(u32) -> I,
        count: usize,
    ) {
        self.owner.resize(count, NONE);
        self.before.clear();
        self.before.extend(0..candidates.len() as u32);
        for (k, &candidate) in candidates.iter().enumerate() {
            for key in keys(candidate) {
                match self.owner[key] {
                    NONE => self.owner[key] = k as u32,
                    other => self.join(k as u32, other),
                }
            }
        }
        for &candidate in candidates {
            for key in keys(candidate) {
                self.owner[key] = NONE;
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

    /// Takes all candidates as one group.
    pub(crate) fn join_all(&mut self, candidates: usize) {
        self.order.clear();
        self.order.extend(0..candidates as u32);
        self.starts.clear();
        if candidates > 0 {
            self.starts.push(0);
        }
        self.starts.push(candidates as u32);
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

    /// Whether there are several.
    pub(crate) fn several(&self) -> bool {
        self.starts.len() > 2
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
}

/// Rows up to which D of a group is a dense matrix.
const DENSE: usize = 72;

/// The rows of points, numbered point after point: that of the normal, and those of the tangents where there is friction.
#[derive(Clone, Copy)]
pub(crate) struct PointRows<'a> {
    pub(crate) normals: &'a Rows,
    /// None, or one for each tangent.
    pub(crate) tangents: &'a [Rows],
}

impl<'a> PointRows<'a> {
    /// Rows of a point.
    pub(crate) fn width(&self) -> u32 {
        1 + self.tangents.len() as u32
    }

    /// Pool and point of a row.
    fn of(&self, number: u32) -> (&'a Rows, usize) {
        let (point, k) = (number / self.width(), number % self.width());
        let rows = match k {
            0 => self.normals,
            k => &self.tangents[k as usize - 1],
        };
        (rows, point as usize)
    }

    /// Unknowns and entries of a row.
    pub(crate) fn row(&self, number: u32) -> (&'a [u32], &'a [f64]) {
        let (rows, point) = self.of(number);
        rows.row(point)
    }

    /// Product of a row with a system vector.
    pub(crate) fn product(&self, number: u32, x: &[f64]) -> f64 {
        let (rows, point) = self.of(number);
        rows.product(point, x)
    }
}

/// The unknowns of a system with a diagonal mass.
#[derive(Clone, Copy)]
pub(crate) struct Masses<'a> {
    /// Of each unknown, kg or kg m².
    pub(crate) lumped: &'a [f64],
    /// Which are held.
    pub(crate) fixed: &'a [bool],
    pub(crate) unknowns: &'a Unknowns,
}

impl Masses<'_> {
    /// An unknown with those of its node that are translations, or rotations, as it is.
    fn unknown(&self, dof: u32) -> Unknown {
        let at = dof as usize;
        let first = self.unknowns.first(self.unknowns.node(at));
        Unknown {
            first: (at - (at - first) % 3) as u32,
            inverse: match self.fixed[at] {
                true => 0.0,
                false => self.lumped[at].recip(),
            },
        }
    }
}

/// D = N M⁻¹ Nᵀ over the rows of one group, M diagonal.
#[derive(Default)]
pub(crate) struct OfGroup {
    /// All entries, of few rows.
    matrix: Vec<f64>,
    /// The rows, of many.
    lumped: Lumped,
    /// Bytes of the largest so far.
    pub(crate) bytes: usize,
}

impl OfGroup {
    /// D over the first `width` rows of some points.
    pub(crate) fn over(
        &mut self,
        points: &[u32],
        width: u32,
        rows: PointRows,
        masses: Masses,
    ) -> Compliance<'_> {
        let of_point = |point: &u32| point * rows.width()..point * rows.width() + width;
        if points.len() * width as usize <= DENSE {
            let numbers = points.iter().flat_map(of_point);
            entries(numbers, rows, masses, &mut self.matrix);
            self.bytes = self.bytes.max(8 * self.matrix.len());
            return Compliance::Dense(&self.matrix);
        }
        self.lumped.clear(width as usize);
        for point in points {
            let own = of_point(point).map(|number| rows.row(number));
            self.lumped.push(own, |dof| masses.unknown(dof));
        }
        self.lumped.finish();
        self.bytes = self.bytes.max(self.lumped.bytes());
        Compliance::Lumped(&self.lumped)
    }
}

/// All entries of D, row-major.
fn entries(
    of: impl Iterator<Item = u32> + Clone,
    rows: PointRows,
    masses: Masses,
    matrix: &mut Vec<f64>,
) {
    matrix.clear();
    for one in of.clone() {
        let (dofs, coefficients) = rows.row(one);
        for other in of.clone() {
            let (others, factors) = rows.row(other);
            let mut sum = 0.0;
            for (i, n) in dofs.iter().zip(coefficients) {
                for (j, m) in others.iter().zip(factors) {
                    let at = *i as usize;
                    if i == j && !masses.fixed[at] {
                        sum += n * m / masses.lumped[at];
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
            let keys = |k: u32| pairs[k as usize].into_iter().filter(|&key| !fixed[key]);
            groups.split(&[0, 1, 2, 3, 4, 5], keys, 8);
            let ranges = groups.ranges();
            ranges.map(|range| groups.order()[range].to_vec()).collect()
        };
        assert_eq!(split(&mut groups, &fixed), [vec![0, 2, 4], vec![1, 3, 5]]);
        fixed[5] = true;
        let parts = [vec![0, 2, 4], vec![1], vec![3, 5]];
        assert_eq!(split(&mut groups, &fixed), parts);
    }
}
