//! Which boxes are near a point or a box: a tree of bounding boxes that can be refitted.
//!
//! Built by median splits of the centres along the longest side, with leaves of a fixed number of items. When the
//! items move, [`BoxTree::refit`] keeps the tree and recomputes its boxes from the leaves up: answers stay right
//! whatever the motion, only speed suffers, and [`BoxTree::looseness`] tells how much. Answers are sorted by item, so they
//! do not depend on the shape of the tree.

use std::ops::Range;

use crate::Bounds;

/// Items in a leaf.
const LEAF: usize = 4;

/// A tree over numbered boxes, one per face of a surface for instance.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxTree {
    /// Nodes in preorder: a node's first child follows it.
    nodes: Vec<Node>,
    /// Items in the order of the leaves.
    items: Vec<u32>,
    /// Box of each entry of `items`.
    boxes: Vec<Bounds>,
    /// Sides of the boxes of all nodes when the tree was built, m.
    built: f64,
}

#[derive(Clone, Debug, PartialEq)]
struct Node {
    bounds: Bounds,
    /// The node after the whole subtree of this one.
    next: u32,
    /// Range of `items` below it.
    first: u32,
    last: u32,
    /// Second child; [`NO_CHILD`] for a leaf.
    second: u32,
}

const NO_CHILD: u32 = u32::MAX;

impl Node {
    fn is_leaf(&self) -> bool {
        self.second == NO_CHILD
    }

    fn range(&self) -> Range<usize> {
        self.first as usize..self.last as usize
    }
}

impl BoxTree {
    /// The tree over these boxes; an item is the index of its box.
    pub fn new(boxes: &[Bounds]) -> BoxTree {
        let mut tree = BoxTree {
            nodes: Vec::new(),
            items: (0..boxes.len() as u32).collect(),
            boxes: Vec::new(),
            built: 0.0,
        };
        tree.split(boxes, 0, boxes.len());
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
        self.boxes.clear();
        self.boxes
            .extend(self.items.iter().map(|&item| boxes[item as usize]));
        for i in (0..self.nodes.len()).rev() {
            let node = &self.nodes[i];
            self.nodes[i].bounds = match node.is_leaf() {
                false => {
                    let second = &self.nodes[node.second as usize];
                    self.nodes[i + 1].bounds.union(&second.bounds)
                }
                true => self.boxes[node.range()]
                    .iter()
                    .fold(Bounds::EMPTY, |all, b| all.union(b)),
            };
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
        size_of_val(&self.nodes[..]) + size_of_val(&self.items[..]) + size_of_val(&self.boxes[..])
    }

    fn sides(&self) -> f64 {
        self.nodes.iter().map(|node| node.bounds.sides()).sum()
    }

    /// The item closest to a point, and its distance in m: the first of equals; `None` if none is within `within` (m,
    /// boundary included).
    ///
    /// `measure` gives the distance of an item in m, infinite for one that does not count; an item lies in its box to the
    /// rounding of coordinates. `moved`: how far in m items may have moved since the boxes were taken.
    ///
    /// Branch and bound, the nearer child first: boxes further than the best item so far are passed by.
    pub fn closest(
        &self,
        point: &[f64; 3],
        within: f64,
        moved: f64,
        measure: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let look = |bounds: &Bounds| bounds.distance_squared(point).sqrt();
        self.descend(within, moved + self.rounding(point), look, measure)
    }

    /// Bound of the rounding of distances between a point and places in the tree, m.
    pub fn rounding(&self, point: &[f64; 3]) -> f64 {
        let tree = self.nodes.first().map_or(0.0, |root| root.bounds.reach());
        // a foot is a sum of some ten products: this is a hundred times what it can err
        1e-13 * (tree + Bounds::of(&[*point]).reach())
    }

    fn descend(
        &self,
        within: f64,
        slack: f64,
        mut look: impl FnMut(&Bounds) -> f64,
        mut measure: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let mut best: Option<(u32, f64)> = None;
        let mut limit = within + slack;
        // a median split halves the items: no path is longer than the number of bits of their count
        let mut waiting = [(0u32, 0.0); 40];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let (at, far) = waiting[count];
            if far > limit {
                continue;
            }
            let node = &self.nodes[at as usize];
            if !node.is_leaf() {
                let children = [at + 1, node.second]
                    .map(|child| (child, look(&self.nodes[child as usize].bounds)));
                let [one, other] = children;
                let (near, later) = match other.1 < one.1 {
                    true => (other, one),
                    false => (one, other),
                };
                waiting[count] = later;
                waiting[count + 1] = near;
                count += 2;
                continue;
            }
            let leaf = self.items[node.range()]
                .iter()
                .zip(&self.boxes[node.range()]);
            for (&item, bounds) in leaf {
                if look(bounds) > limit {
                    continue;
                }
                let distance = measure(item);
                let better = |(first, least): (u32, f64)| {
                    distance < least || distance == least && item < first
                };
                if distance <= within && best.is_none_or(better) {
                    best = Some((item, distance));
                    limit = distance + slack;
                }
            }
        }
        best
    }

    /// Items whose box is within a distance (in m, boundary included) of a point, sorted, into `found`, which is
    /// cleared first.
    pub fn near(&self, point: &[f64; 3], distance: f64, found: &mut Vec<u32>) {
        let limit = distance * distance;
        self.collect(|bounds| bounds.distance_squared(point) <= limit, found);
    }

    /// Items whose box has a point in common with a box, sorted, into `found`, which is cleared first.
    pub fn overlapping(&self, bounds: &Bounds, found: &mut Vec<u32>) {
        self.collect(|other| other.overlaps(bounds), found);
    }

    /// Items whose box passes a test that every box around it passes too.
    fn collect(&self, test: impl Fn(&Bounds) -> bool, found: &mut Vec<u32>) {
        found.clear();
        let mut i = 0;
        while let Some(node) = self.nodes.get(i) {
            if !test(&node.bounds) {
                i = node.next as usize;
                continue;
            }
            if node.is_leaf() {
                let range = node.range();
                let leaf = self.items[range.clone()].iter().zip(&self.boxes[range]);
                found.extend(leaf.filter(|(_, b)| test(b)).map(|(&item, _)| item));
            }
            i += 1;
        }
        found.sort_unstable();
    }

    /// Adds the subtree over a range of items, which it reorders.
    fn split(&mut self, boxes: &[Bounds], first: usize, last: usize) {
        let here = self.nodes.len();
        self.nodes.push(Node {
            bounds: Bounds::EMPTY,
            next: 0,
            first: first as u32,
            last: last as u32,
            second: NO_CHILD,
        });
        if last - first > LEAF {
            let items = &mut self.items[first..last];
            let axis = longest_side(boxes, items);
            let middle = items.len() / 2;
            // Equal centres are told apart by number: the tree is the same on every machine.
            items.select_nth_unstable_by(middle, |&a, &b| {
                let centre = |item: u32| boxes[item as usize].centre(axis);
                centre(a).total_cmp(&centre(b)).then(a.cmp(&b))
            });
            self.split(boxes, first, first + middle);
            self.nodes[here].second = self.nodes.len() as u32;
            self.split(boxes, first + middle, last);
        }
        self.nodes[here].next = self.nodes.len() as u32;
    }
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
        // 32 x 32 unit squares; a point sees the four around it, and the tests it takes grow with the depth of the
        // tree, not with the number of boxes.
        let boxes: Vec<Bounds> = (0..1024)
            .map(|i| [(i % 32) as f64, (i / 32) as f64, 0.0])
            .map(|x| Bounds::of(&[x, [x[0] + 1.0, x[1] + 1.0, 0.0]]))
            .collect();
        let tree = BoxTree::new(&boxes);
        let (count, mut found) = (std::cell::Cell::new(0), Vec::new());
        let test = |b: &Bounds| {
            count.set(count.get() + 1);
            b.distance_squared(&[16.0, 16.0, 0.0]) <= 0.25
        };
        tree.collect(test, &mut found);
        assert_eq!(found, [495, 496, 527, 528]);
        assert!(count.get() < 120, "{}", count.get());
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
                let look = |b: &Bounds| {
                    looks += 1;
                    b.distance_squared(&p).sqrt()
                };
                let measure = |i: u32| boxes[i as usize].distance_squared(&p).sqrt();
                assert!(tree.descend(f64::INFINITY, 0.0, look, measure).is_some());
            }
            looks as f64 / f64::from(queries)
        };
        // 256 times as many boxes are 8 levels more: two boxes looked at in each, and now and then a neighbour
        let (few, many) = (looks(16), looks(256));
        assert!(many - few < 4.0 * 8.0, "{few} {many}");
        assert!(many < 4.0 * 16.0 + 16.0, "{many}");
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
