//! Which boxes are near a point or a box: a tree of bounding boxes that can be refitted.
//!
//! Every node has eight children, in single precision rounded outwards, side by side so that one pass of vector operations
//! looks at all of them. Items are in an order in which each aligned group of 8, 64, 512 ... is compact, from splits of
//! the centres along the longest side; a node is known by its place, so that there are no links. When the items move,
//! [`BoxTree::refit`] keeps the order and recomputes the boxes from the items up: answers stay right whatever the motion, only speed
//! suffers, and [`BoxTree::looseness`] tells how much. Answers are sorted by item, so they do not depend on the shape of
//! the tree.

use rayon::prelude::*;

use self::wide::{Around, WIDTH, Wide};
use crate::Bounds;

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
        let mut tree = BoxTree {
            items,
            boxes: boxes.to_vec(),
            levels,
            origin: [0, 1, 2].map(|i| match bounds.centre(i) {
                centre if centre.is_finite() => centre,
                _ => 0.0,
            }),
            reach: 0.0,
            built: 0.0,
        };
        tree.refit(boxes);
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

    /// Takes new boxes of the same items, as many as before, and recomputes the tree's boxes in linear time.
    pub fn refit(&mut self, boxes: &[Bounds]) {
        debug_assert_eq!(boxes.len(), self.items.len());
        self.reach = around(boxes).reach();
        let origin = self.origin;
        let Some((leaves, upper)) = self.levels.split_first_mut() else {
            return;
        };
        let own = self.boxes.par_chunks_mut(WIDTH * CHUNK);
        let chunks = leaves
            .par_chunks_mut(CHUNK)
            .zip(own)
            .zip(self.items.par_chunks(WIDTH * CHUNK));
        chunks.for_each(|((nodes, own), items)| {
            for (own, &item) in own.iter_mut().zip(items) {
                *own = boxes[item as usize];
            }
            for (node, own) in nodes.iter_mut().zip(own.chunks(WIDTH)) {
                for (at, bounds) in own.iter().enumerate() {
                    node.set(at, bounds, &origin);
                }
            }
        });
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
        nodes.sum::<usize>() + size_of_val(&self.items[..]) + size_of_val(&self.boxes[..])
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
        let slack = moved + self.rounding(point);
        let from = self.from(&Bounds::of(&[*point]));
        let mut best: Option<(u32, f64)> = None;
        let mut limit = from.limit(within + slack);
        self.descend(&from, &mut limit, |item| {
            let distance = measure(item);
            let better =
                |(first, least): (u32, f64)| distance < least || distance == least && item < first;
            if distance <= within && best.is_none_or(better) {
                best = Some((item, distance));
                return Some(from.limit(distance + slack));
            }
            None
        });
        best
    }

    /// Bound of the rounding of distances between a point and places in the tree, m.
    pub fn rounding(&self, point: &[f64; 3]) -> f64 {
        // a foot is a sum of some ten products: this is a hundred times what it can err
        1e-13 * (self.reach + Bounds::of(&[*point]).reach())
    }

    fn from(&self, bounds: &Bounds) -> Around {
        let reach = self.reach + Bounds::of(&[self.origin]).reach();
        Around::new(bounds, &self.origin, reach)
    }

    /// Visits the items whose box is not farther than the limit, a square in m², nearer ones first; a visit may lower it. Returns how
    /// many nodes were looked at.
    fn descend(
        &self,
        from: &Around,
        limit: &mut f32,
        mut visit: impl FnMut(u32) -> Option<f32>,
    ) -> usize {
        // the children of a node replace it: seven more at most on each level
        let mut waiting = [(0.0_f32, 0_u32, 0_u32); WIDTH * LEVELS];
        let mut count = 0;
        if let Some(top) = self.levels.len().checked_sub(1) {
            (waiting[0], count) = ((0.0, top as u32, 0), 1);
        }
        let mut looks = 0;
        while count > 0 {
            count -= 1;
            let (square, level, node) = waiting[count];
            if square > *limit {
                continue;
            }
            looks += 1;
            let squares = self.levels[level as usize][node as usize].squares(from);
            let mut near = [(0.0_f32, 0_u32); WIDTH];
            let found = sorted(&squares, *limit, &mut near);
            let first = node * WIDTH as u32;
            if level > 0 {
                for &(square, child) in near[..found].iter().rev() {
                    waiting[count] = (square, level - 1, first + child);
                    count += 1;
                }
                continue;
            }
            for &(square, child) in &near[..found] {
                if square > *limit {
                    break;
                }
                if let Some(less) = visit(self.items[(first + child) as usize]) {
                    *limit = less;
                }
            }
        }
        looks
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

/// The entries not above a limit with their places, smaller ones first, into `near`; how many they are.
#[inline]
fn sorted(squares: &[f32; WIDTH], limit: f32, near: &mut [(f32, u32); WIDTH]) -> usize {
    let mut left = 0_u32;
    for (place, square) in squares.iter().enumerate() {
        left |= u32::from(*square <= limit) << place;
    }
    let mut found = 0;
    while left != 0 {
        let place = left.trailing_zeros();
        left &= left - 1;
        let square = squares[place as usize % WIDTH];
        let mut at = found;
        while at > 0 && near[at - 1].0 > square {
            near[at] = near[at - 1];
            at -= 1;
        }
        near[at] = (square, place);
        found += 1;
    }
    found
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn random_boxes(random: &mut Random, n: usize) -> Vec<Bounds> {
        let boxes = (0..n).map(|_| Bounds::of(&[random.point(1.0)]).widened(0.1 * random.unit()));
        boxes.collect()
    }

    fn assert_equals_brute_force(tree: &BoxTree, boxes: &[Bounds], random: &mut Random) {
        let mut found = vec![7];
        for _ in 0..50 {
            let (point, distance) = (random.point(1.5), random.unit());
            tree.near(&point, distance, &mut found);
            let near = |b: &Bounds| b.distance_squared(&point) <= distance * distance;
            assert_eq!(found, brute_force(boxes, near));
            // items are the corners of their boxes, but every third does not count
            let corner = |i: u32| match i % 3 {
                0 => f64::INFINITY,
                _ => Bounds::of(&[boxes[i as usize].min])
                    .distance_squared(&point)
                    .sqrt(),
            };
            let all = (0..boxes.len() as u32).map(|i| (i, corner(i)));
            let closest = all
                .filter(|(_, d)| *d <= distance)
                .min_by(|a, b| a.1.total_cmp(&b.1));
            assert_eq!(tree.closest(&point, distance, 0.0, corner), closest);
            let query = Bounds::of(&[random.point(1.0), random.point(1.0)]);
            tree.overlapping(&query, &mut found);
            assert_eq!(found, brute_force(boxes, |b| b.overlaps(&query)));
        }
    }

    fn brute_force(boxes: &[Bounds], test: impl Fn(&Bounds) -> bool) -> Vec<u32> {
        (0..boxes.len() as u32)
            .filter(|&i| test(&boxes[i as usize]))
            .collect()
    }

    #[test]
    fn answers_equal_brute_force_before_and_after_motion() {
        let mut random = Random::new(1);
        for n in [0, 1, 3, 4, 5, 9, 64, 333] {
            let boxes = random_boxes(&mut random, n);
            let mut tree = BoxTree::new(&boxes);
            assert_eq!((tree.len(), tree.is_empty()), (n, n == 0));
            assert_equals_brute_force(&tree, &boxes, &mut random);
            let moved = random_boxes(&mut random, n);
            tree.refit(&moved);
            assert_equals_brute_force(&tree, &moved, &mut random);
        }
    }

    #[test]
    fn boxes_with_one_centre_are_all_found() {
        let boxes = vec![Bounds::of(&[[1.0; 3]]); 100];
        let tree = BoxTree::new(&boxes);
        let mut found = Vec::new();
        tree.near(&[1.0, 1.0, 3.0], 2.0, &mut found);
        assert_eq!(found, (0..100).collect::<Vec<u32>>());
        tree.near(&[1.0, 1.0, 3.0], 1.999, &mut found);
        assert!(found.is_empty());
    }

    #[test]
    fn a_search_looks_at_a_small_part_of_the_boxes() {
        // 32 x 32 unit squares; a point sees the four around it, and the nodes it takes grow with the depth of the
        // tree, not with the number of boxes.
        let boxes: Vec<Bounds> = (0..1024)
            .map(|i| [(i % 32) as f64, (i / 32) as f64, 0.0])
            .map(|x| Bounds::of(&[x, [x[0] + 1.0, x[1] + 1.0, 0.0]]))
            .collect();
        let tree = BoxTree::new(&boxes);
        let mut found = Vec::new();
        let place = [16.0, 16.0, 0.0];
        let test = |b: &Bounds| b.distance_squared(&place) <= 0.25;
        let looks = tree.collect(&Bounds::of(&[place]), 0.5, test, &mut found);
        assert_eq!(found, [495, 496, 527, 528]);
        // on each of four levels the four squares are in four nodes at most
        assert_eq!(tree.levels.len(), 4);
        assert!(looks <= 16, "{looks}");
    }

    #[test]
    fn boxes_of_before_serve_items_that_moved_by_less_than_the_slack() {
        let mut random = Random::new(5);
        let boxes = random_boxes(&mut random, 200);
        let tree = BoxTree::new(&boxes);
        let step = random.point(0.1);
        let moved = 0.1 * 3.0_f64.sqrt();
        let place = |i: u32| [0, 1, 2].map(|k| boxes[i as usize].max[k] + step[k]);
        for _ in 0..100 {
            let point = random.point(1.5);
            let measure = |i: u32| Bounds::of(&[place(i)]).distance_squared(&point).sqrt();
            let all = (0..200).map(|i| (i, measure(i)));
            let closest = all.min_by(|a, b| a.1.total_cmp(&b.1));
            assert_eq!(tree.closest(&point, f64::INFINITY, moved, measure), closest);
        }
    }

    #[test]
    fn the_first_of_equals_is_the_closest() {
        let boxes = vec![Bounds::of(&[[1.0; 3]]); 100];
        let tree = BoxTree::new(&boxes);
        let far = |i: u32| if i < 37 { 2.5 } else { 2.0 };
        let from = [1.0, 1.0, 3.0];
        assert_eq!(tree.closest(&from, 5.0, 0.0, far), Some((37, 2.0)));
        assert_eq!(tree.closest(&from, 1.9, 0.0, far), None);
    }

    #[test]
    fn looks_for_the_closest_grow_with_the_logarithm_of_the_number_of_boxes() {
        let looks = |side: usize| {
            let boxes: Vec<Bounds> = (0..side * side)
                .map(|i| [(i % side) as f64, (i / side) as f64, 0.0])
                .map(|x| Bounds::of(&[x, [x[0] + 1.0, x[1] + 1.0, 0.0]]))
                .collect();
            let tree = BoxTree::new(&boxes);
            let mut random = Random::new(6);
            let (mut looks, queries) = (0, 200);
            for _ in 0..queries {
                let p = random.point(0.5 * side as f64);
                let p = [p[0] + 0.5 * side as f64, p[1] + 0.5 * side as f64, 0.3];
                let from = tree.from(&Bounds::of(&[p]));
                let (mut limit, mut least) = (f32::MAX, f64::INFINITY);
                looks += tree.descend(&from, &mut limit, |i| {
                    least = least.min(boxes[i as usize].distance_squared(&p).sqrt());
                    Some(from.limit(least))
                });
                assert!(least < f64::INFINITY);
            }
            looks as f64 / f64::from(queries)
        };
        // 3 levels and 6: a place is in one node of each, and now and then near a few others
        let (few, many) = (looks(16), looks(256));
        assert!(many - few < 3.0 * 3.0, "{few} {many}");
        assert!(many < 3.0 * 6.0, "{many}");
    }

    #[test]
    fn a_tree_whose_items_part_gets_loose() {
        let mut random = Random::new(7);
        let boxes = random_boxes(&mut random, 300);
        let mut tree = BoxTree::new(&boxes);
        assert_eq!(tree.looseness(), 1.0);
        let turned: Vec<Bounds> = (0..300).map(|i| boxes[(i * 7) % 300]).collect();
        tree.refit(&turned);
        assert!(tree.looseness() > 2.0, "{}", tree.looseness());
        assert_eq!(tree.bytes(), BoxTree::new(&turned).bytes());
    }
}
