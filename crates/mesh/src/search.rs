//! Which boxes are near a point or a box: a tree of bounding boxes that can be refitted.
//!
//! Every node has eight children, in single precision, side by side so that one pass of vector operations
//! looks at all of them. Items are in an order in which each aligned group of 8, 64, 512 ... is compact, from splits of
//! the centres along the longest side; a node is known by its place, so that there are no links. When the items move,
//! [`BoxTree::refit`] keeps the order and recomputes the boxes from the items up: answers stay right whatever the motion, only speed
//! suffers, and [`BoxTree::looseness`] tells how much. Answers are sorted by item, so they do not depend on the shape of
//! the tree.

use rayon::prelude::*;

use self::scan::Scan;
use self::wide::{Around, WIDTH, Wide, sorted};
use crate::Bounds;
use crate::bounds::size;

mod scan;
#[cfg(test)]
mod tests;
mod wide;

/// The most levels: 8¹¹ items are more than numbers of 32 bits.
const LEVELS: usize = 11;

/// Nodes that one thread refits at a time.
const CHUNK: usize = 512;

/// A tree over numbered boxes, one per face of a surface for instance.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxTree {
    /// Items in the order of the leaves.
    items: Vec<u32>,
    /// Place of each item in `items`.
    places: Vec<u32>,
    /// Box of each entry of `items`.
    boxes: Vec<Bounds>,
    /// Nodes by level: those of the first have the items, eight each; node k of the next has nodes 8 k to 8 k + 7.
    levels: Vec<Vec<Wide>>,
    /// Largest coordinate of an item, m.
    reach: f64,
    /// Where coordinates of nodes begin, m.
    origin: [f64; 3],
    /// Sides of the boxes of all nodes when the tree was built, m.
    built: f64,
}

impl BoxTree {
    /// The tree over these boxes; an item is the index of its box.
    pub fn new(boxes: &[Bounds]) -> BoxTree {
        let mut items: Vec<u32> = (0..boxes.len() as u32).collect();
        split(boxes, &mut items);
        let mut levels = Vec::new();
        let mut nodes = boxes.len();
        while nodes > 1 || levels.is_empty() && nodes > 0 {
            nodes = nodes.div_ceil(WIDTH);
            levels.push(vec![Wide::EMPTY; nodes]);
        }
        let bounds = around(boxes);
        let mut places = vec![0; items.len()];
        for (place, &item) in (0..).zip(&items) {
            places[item as usize] = place;
        }
        let mut tree = BoxTree {
            items,
            places,
            boxes: boxes.to_vec(),
            levels,
            origin: [0, 1, 2].map(|i| match bounds.centre(i) {
                centre if centre.is_finite() => centre,
                _ => 0.0,
            }),
            reach: 0.0,
            built: 0.0,
        };
        tree.refit(|item| boxes[item as usize]);
        tree.built = tree.sides();
        tree
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether the tree has no items.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// The box of an item.
    pub fn bounds(&self, item: u32) -> &Bounds {
        &self.boxes[self.places[item as usize] as usize]
    }

    /// Mean diagonal of the boxes of the items, m; zero without any.
    pub fn mean_diagonal(&self) -> f64 {
        let diagonals = self.boxes.iter().map(Bounds::diagonal);
        diagonals.sum::<f64>() / self.len().max(1) as f64
    }

    /// Takes new boxes of the same items, and recomputes the tree's boxes in linear time. `bounds`: the box of an item.
    pub fn refit(&mut self, bounds: impl Fn(u32) -> Bounds + Sync) {
        let origin = self.origin;
        let Some((leaves, upper)) = self.levels.split_first_mut() else {
            return;
        };
        let own = self.boxes.par_chunks_mut(WIDTH * CHUNK);
        let chunks = leaves
            .par_chunks_mut(CHUNK)
            .zip(own)
            .zip(self.items.par_chunks(WIDTH * CHUNK));
        let around = chunks.map(|((nodes, own), items)| {
            let mut all = Bounds::EMPTY;
            let groups = own.chunks_mut(WIDTH).zip(items.chunks(WIDTH));
            for (node, (own, items)) in nodes.iter_mut().zip(groups) {
                for (at, (own, &item)) in own.iter_mut().zip(items).enumerate() {
                    *own = bounds(item);
                    all = all.union(own);
                    node.set(at, own, &origin);
                }
            }
            all
        });
        // least and largest values do not depend on the order
        let around = around.reduce(|| Bounds::EMPTY, |a, b| a.union(&b));
        self.reach = around.reach();
        let mut below = &leaves[..];
        for level in upper {
            for (node, children) in level.iter_mut().zip(below.chunks(WIDTH)) {
                for (at, child) in children.iter().enumerate() {
                    node.set_around(at, child);
                }
            }
            below = level;
        }
    }

    /// How far a place of an item in its new box may be from the box that the tree has of it, m; none where that is more than `most`.
    /// `bounds`: the new box of an item.
    pub fn motion(&self, most: f64, bounds: impl Fn(u32) -> Bounds + Sync) -> Option<f64> {
        let pairs = self
            .boxes
            .par_chunks(CHUNK)
            .zip(self.items.par_chunks(CHUNK));
        let largest = pairs.map(|(boxes, items)| {
            let pairs = boxes.iter().zip(items);
            let beyond = pairs.map(|(old, &item)| bounds(item).beyond_squared(old));
            let largest = beyond.fold(0.0, f64::max).sqrt();
            (largest <= most).then_some(largest)
        });
        largest.try_reduce(|| 0.0, |a, b| Some(f64::max(a, b)))
    }

    /// Sides of the boxes of all nodes over what they were when the tree was built: 1 then, larger where items that were
    /// together have parted. Speed suffers in about this proportion.
    pub fn looseness(&self) -> f64 {
        match self.built > 0.0 {
            true => self.sides() / self.built,
            false => 1.0,
        }
    }

    /// Memory of the tree, bytes.
    pub fn bytes(&self) -> usize {
        let nodes = self.levels.iter().map(|level| size_of_val(&level[..]));
        let own = size_of_val(&self.items[..]) + size_of_val(&self.places[..]);
        nodes.sum::<usize>() + own + size_of_val(&self.boxes[..])
    }

    /// Sides of the boxes around the nodes.
    fn sides(&self) -> f64 {
        let upper = self.levels.iter().skip(1).flatten();
        upper.map(Wide::sides).sum()
    }

    /// The item closest to a point, and its distance in m: the first of equals; `None` if none is within `within` (m,
    /// boundary included).
    ///
    /// `measure` gives the distance of an item in m, infinite for one that does not count; an item lies in its box to the
    /// rounding of coordinates. `moved`: how far in m items may have moved since the boxes were taken.
    ///
    /// Branch and bound, nearer boxes first: those further than the best item so far are passed by.
    pub fn closest(
        &self,
        point: &[f64; 3],
        within: f64,
        moved: f64,
        mut measure: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let top = self.levels.len().checked_sub(1)?;
        let slack = moved + self.rounding(point);
        let from = self.from(&Bounds {
            min: *point,
            max: *point,
        });
        let mut best: Option<(u32, f64)> = None;
        let mut limit = from.limit(within + slack);
        let mut visit = |item| {
            let distance = measure(item);
            let better =
                |(first, least): (u32, f64)| distance < least || distance == least && item < first;
            if distance <= within && best.is_none_or(better) {
                best = Some((item, distance));
                return Some(from.limit(distance + slack));
            }
            None
        };
        self.descend(&from, &mut limit, (top, 0), &mut visit);
        best
    }

    /// Whether the boxes of others than its own item are within a distance (m) of each of some points; told of all points where these are
    /// so far from each other that one look for all does not pay.
    pub fn others(
        &self,
        points: &[[f64; 3]; WIDTH],
        distances: &[f64; WIDTH],
        own: &[u32; WIDTH],
    ) -> [bool; WIDTH] {
        let from = self.from(&Bounds::of(points));
        let mut scan = Scan::new((&from, &self.origin), points, distances);
        match self.levels.len().checked_sub(1) {
            Some(top) if scan.goes_through((&self.levels, &self.items), (top, 0), own) => {
                scan.others
            }
            Some(_) => [true; WIDTH],
            None => [false; WIDTH],
        }
    }

    /// Bound of the rounding of distances between a point and places in the tree, m.
    pub fn rounding(&self, point: &[f64; 3]) -> f64 {
        // a foot is a sum of some ten products: this is a hundred times what it can err
        1e-13 * (self.reach + size(point))
    }

    fn from(&self, bounds: &Bounds) -> Around {
        Around::new(bounds, &self.origin, self.reach + size(&self.origin))
    }

    /// Visits the items below a node whose box is not farther than the limit, a square in m², nearer ones first; a visit may lower it.
    /// Returns how many nodes were looked at.
    fn descend(
        &self,
        from: &Around,
        limit: &mut f32,
        (mut level, mut node): (usize, u32),
        visit: &mut impl FnMut(u32) -> Option<f32>,
    ) -> usize {
        let mut looks = 0;
        loop {
            looks += 1;
            let squares = self.levels[level][node as usize].squares(from);
            let mut near = [(0.0_f32, 0_u32); WIDTH];
            let found = sorted(&squares, *limit, &mut near);
            let first = node * WIDTH as u32;
            if let (&[(_, child)], 1..) = (&near[..found], level) {
                (level, node) = (level - 1, first + child);
                continue;
            }
            for &(square, child) in &near[..found] {
                if square > *limit {
                    break;
                }
                if level > 0 {
                    let below = (level - 1, first + child);
                    looks += self.descend(from, limit, below, visit);
                } else if let Some(less) = visit(self.items[(first + child) as usize]) {
                    *limit = less;
                }
            }
            return looks;
        }
    }

    /// Items whose box is within a distance (in m, boundary included) of a point, sorted, into `found`, which is
    /// cleared first.
    pub fn near(&self, point: &[f64; 3], distance: f64, found: &mut Vec<u32>) {
        let limit = distance * distance;
        let test = |bounds: &Bounds| bounds.distance_squared(point) <= limit;
        self.collect(&Bounds::of(&[*point]), distance, test, found);
    }

    /// Items whose box has a point in common with a box, sorted, into `found`, which is cleared first.
    pub fn overlapping(&self, bounds: &Bounds, found: &mut Vec<u32>) {
        self.collect(bounds, 0.0, |other| other.overlaps(bounds), found);
    }

    /// Items within a distance (m) of a box whose own box passes a test; how many nodes were looked at.
    fn collect(
        &self,
        bounds: &Bounds,
        distance: f64,
        test: impl Fn(&Bounds) -> bool,
        found: &mut Vec<u32>,
    ) -> usize {
        found.clear();
        let from = self.from(bounds);
        let limit = from.limit(distance);
        let mut looks = 0;
        let mut waiting = [(0_u32, 0_u32); WIDTH * LEVELS];
        let mut count = 0;
        if let Some(top) = self.levels.len().checked_sub(1) {
            (waiting[0], count) = ((top as u32, 0), 1);
        }
        while count > 0 {
            count -= 1;
            let (level, node) = waiting[count];
            looks += 1;
            let squares = self.levels[level as usize][node as usize].squares(&from);
            for (child, _) in (0..).zip(squares).filter(|(_, square)| *square <= limit) {
                let place = node * WIDTH as u32 + child;
                if level > 0 {
                    waiting[count] = (level - 1, place);
                    count += 1;
                } else if test(&self.boxes[place as usize]) {
                    found.push(self.items[place as usize]);
                }
            }
        }
        found.sort_unstable();
        looks
    }
}

/// The box around some.
fn around(boxes: &[Bounds]) -> Bounds {
    let chunks = boxes.par_chunks(WIDTH * CHUNK);
    let around = |all: Bounds, bounds: &Bounds| all.union(bounds);
    // least and largest values do not depend on the order
    chunks
        .map(|boxes| boxes.iter().fold(Bounds::EMPTY, around))
        .reduce(|| Bounds::EMPTY, |a, b| a.union(&b))
}

/// Orders items so that each aligned group of 8, 64, 512 ... of them is compact.
fn split(boxes: &[Bounds], items: &mut [u32]) {
    if items.len() <= WIDTH {
        return;
    }
    // the largest power of eight that is less than their number: its multiples are where groups end
    let mut unit = WIDTH;
    while unit * WIDTH < items.len() {
        unit *= WIDTH;
    }
    let middle = unit * items.len().div_ceil(unit).div_euclid(2);
    let axis = longest_side(boxes, items);
    // equal centres are told apart by number: the tree is the same on every machine
    items.select_nth_unstable_by(middle, |&a, &b| {
        let centre = |item: u32| boxes[item as usize].centre(axis);
        centre(a).total_cmp(&centre(b)).then(a.cmp(&b))
    });
    let (first, second) = items.split_at_mut(middle);
    split(boxes, first);
    split(boxes, second);
}

/// The axis along which the centres of some boxes spread most.
fn longest_side(boxes: &[Bounds], items: &[u32]) -> usize {
    let centres = items.iter().fold(Bounds::EMPTY, |all, &item| {
        let x = [0, 1, 2].map(|i| boxes[item as usize].centre(i));
        all.union(&Bounds { min: x, max: x })
    });
    let side = |i: usize| centres.max[i] - centres.min[i];
    (1..3).fold(0, |best, i| if side(i) > side(best) { i } else { best })
}
