//! What a query remembers of its last answers, so that the next one asks few faces.

use carom_mesh::{BoxTree, Projection};

/// The most faces that a point keeps.
const MANY: usize = 32;

/// A face that a query is likely closest to, and the closest point on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Guess {
    pub item: u32,
    pub foot: Projection,
    /// Whether no other face is as near.
    pub sure: bool,
}

/// What one query remembers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kept {
    /// The face found last.
    pub face: Option<u32>,
    /// Which boxes it has asked.
    pub epoch: u32,
    /// The place when the faces were listed, m.
    x: [f64; 3],
    /// All faces within `reach` (m) of that place that may be in view, and the distances of their boxes, nearer ones first; none if not listed.
    faces: Vec<(u32, f64)>,
    reach: Option<f64>,
    /// Whether there were too many to be listed.
    crowded: bool,
}

impl Kept {
    /// Forgets the faces that were listed by boxes of before.
    pub fn begin(&mut self, epoch: u32) {
        if self.epoch != epoch {
            (self.reach, self.crowded, self.epoch) = (None, false, epoch);
        }
    }

    /// Whether faces may be listed and are not.
    pub fn is_open(&self) -> bool {
        self.reach.is_none() && !self.crowded
    }

    /// Lists the faces `near` a place, those within a reach, unless they are too many.
    pub fn list(&mut self, x: &[f64; 3], reach: f64, near: &[u32], tree: &BoxTree) {
        self.crowded = near.len() > MANY;
        if self.crowded {
            return;
        }
        self.faces.clear();
        let distance = |&item: &u32| (item, tree.bounds(item).distance_squared(x).sqrt());
        self.faces.extend(near.iter().map(distance));
        self.faces
            .sort_unstable_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        (self.x, self.reach) = (*x, Some(reach));
    }

    /// The faces that were listed by these boxes, if they were.
    pub fn listed(&self, epoch: u32) -> Option<impl Iterator<Item = u32> + '_> {
        let listed = self.reach.is_some() && self.epoch == epoch;
        listed.then(|| self.faces.iter().map(|(item, _)| *item))
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Kept>() + self.faces.capacity() * size_of::<(u32, f64)>()
    }
}

/// One question to a tree whose items have moved by `moved` at most.
pub(super) struct Query<'a> {
    pub tree: &'a BoxTree,
    pub moved: f64,
    pub x: &'a [f64; 3],
    pub within: f64,
    /// An item and its distance, m, if one has been measured.
    pub known: Option<(u32, f64)>,
    /// A bound of the distance of the item found last, m; none if it is to be measured unless one has been.
    pub bound: Option<f64>,
}

impl Query<'_> {
    /// The first of the closest items and its distance.
    pub fn closest(
        &self,
        kept: &mut Kept,
        count: usize,
        mut measure: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        // what was closest last bounds the distance of what is closest now
        let last = kept.face.filter(|&item| (item as usize) < count);
        let last = last.filter(|_| self.bound.is_none());
        let measured = self
            .known
            .or_else(|| last.map(|item| (item, measure(item))));
        let bound = match measured {
            Some((_, distance)) => distance,
            None => self.bound.unwrap_or(f64::INFINITY),
        };
        let mut measure = |item: u32| match measured {
            Some((known, distance)) if known == item => distance,
            _ => measure(item),
        };
        let within = self.within.min(bound);
        if let Some(answer) = self.among_kept(kept, within, &mut measure) {
            return answer;
        }
        kept.reach = None;
        self.tree.closest(self.x, within, self.moved, measure)
    }

    /// The answer from the kept faces; `None` if another face may be closer than they are.
    fn among_kept(
        &self,
        kept: &Kept,
        within: f64,
        mut measure: impl FnMut(u32) -> f64,
    ) -> Option<Option<(u32, f64)>> {
        let gone = squared(self.x, &kept.x).sqrt();
        let slack = self.moved + gone + self.tree.rounding(self.x);
        let sure = kept.reach? - slack;
        let mut best: Option<(u32, f64)> = None;
        let mut limit = within;
        for &(item, lower) in &kept.faces {
            if lower - slack > limit {
                break;
            }
            let distance = measure(item);
            let better =
                |(first, least): (u32, f64)| distance < least || distance == least && item < first;
            if distance <= limit && best.is_none_or(better) {
                best = Some((item, distance));
                limit = distance;
            }
        }
        (limit <= sure).then_some(best)
    }
}

/// Square of the distance of two places, m².
pub(super) fn squared(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum()
}
