//! Which boxes are near a point or a box: a tree of bounding boxes that can be refitted.
//!
//! Built by median splits of the centres along the longest side, with leaves of a fixed number of items. When the
//! items move, [`BoxTree::refit`] keeps the tree and recomputes its boxes from the leaves up: answers stay right
//! whatever the motion, only speed suffers. Answers are sorted by item, so they do not depend on the shape of the
//! tree.

use std::ops::Range;

use carom_elements::{Kind, MAX_FACE_NODES};

/// Items in a leaf.
const LEAF: usize = 4;

/// A box with sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub min: [f64; 3],
    /// Largest coordinates.
    pub max: [f64; 3],
}

impl Bounds {
    /// The box that holds nothing; a union with it is the other box.
    pub const EMPTY: Bounds = Bounds {
        min: [f64::INFINITY; 3],
        max: [f64::NEG_INFINITY; 3],
    };

    /// The smallest box around some points.
    pub fn of(points: &[[f64; 3]]) -> Bounds {
        points.iter().fold(Bounds::EMPTY, |bounds, &x| {
            bounds.union(&Bounds { min: x, max: x })
        })
    }

    /// A box around the whole of a face with these node positions, curved or not: around its Bézier points.
    ///
    /// A quadratic face bulges out of the box of its nodes, but not out of that of the coefficients of its Bernstein
    /// polynomials, which are positive and sum to one. Farin (2002).
    pub fn of_face(kind: Kind, nodes: &[[f64; 3]]) -> Bounds {
        let mut points = [[0.0; 3]; MAX_FACE_NODES];
        let points = &mut points[..nodes.len()];
        points.copy_from_slice(nodes);
        bezier(kind, points);
        let mut bounds = Bounds::of(points);
        if kind == Kind::Quad8 {
            // the coefficient that belongs to the middle, for which there is no node
            let sum =
                |range: Range<usize>, i: usize| -> f64 { nodes[range].iter().map(|x| x[i]).sum() };
            let middle = [0, 1, 2].map(|i| sum(4..8, i) - 0.75 * sum(0..4, i));
            bounds = bounds.union(&Bounds::of(&[middle]));
        }
        bounds
    }

    /// The smallest box around two.
    pub fn union(&self, other: &Bounds) -> Bounds {
        Bounds {
            min: [0, 1, 2].map(|i| self.min[i].min(other.min[i])),
            max: [0, 1, 2].map(|i| self.max[i].max(other.max[i])),
        }
    }

    /// The box moved outward by `margin` on every side, in m.
    pub fn widened(&self, margin: f64) -> Bounds {
        Bounds {
            min: self.min.map(|x| x - margin),
            max: self.max.map(|x| x + margin),
        }
    }

    /// Whether two boxes have a point in common, their boundaries included.
    pub fn overlaps(&self, other: &Bounds) -> bool {
        (0..3).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// Squared distance from a point to the box, in m²; zero inside.
    pub fn distance_squared(&self, point: &[f64; 3]) -> f64 {
        (0..3)
            .map(|i| {
                let out = (self.min[i] - point[i]).max(point[i] - self.max[i]);
                out.max(0.0).powi(2)
            })
            .sum()
    }

    fn centre(&self, axis: usize) -> f64 {
        0.5 * (self.min[axis] + self.max[axis])
    }
}

/// Replaces the nodes between the corners of a quadratic face by the coefficients of its Bernstein polynomials.
fn bezier(kind: Kind, points: &mut [[f64; 3]]) {
    const LINE: [[usize; 3]; 1] = [[0, 1, 2]];
    const TRIANGLE: [[usize; 3]; 3] = [[0, 1, 3], [1, 2, 4], [2, 0, 5]];
    const SQUARE: [[usize; 3]; 4] = [[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]];
    let edges: &[[usize; 3]] = match kind {
        Kind::Bar3 => &LINE,
        Kind::Tri6 => &TRIANGLE,
        Kind::Quad8 | Kind::Quad9 => &SQUARE,
        _ => &[],
    };
    let mean = |a: &[f64; 3], b: &[f64; 3]| [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]));
    if kind == Kind::Quad9 {
        // along ξ in the middle row, then along η in the middle column
        let rows = [[3, 2, 6], [0, 1, 4]]
            .map(|[a, b, m]| beyond(&points[m], &mean(&points[a], &points[b])));
        let row = beyond(&points[8], &mean(&points[5], &points[7]));
        points[8] = beyond(&row, &mean(&rows[0], &rows[1]));
    }
    for &[a, b, m] in edges {
        points[m] = beyond(&points[m], &mean(&points[a], &points[b]));
    }
}

/// The coefficient of 2 t (1 - t) of a parabola through `middle` whose ends have this mean.
fn beyond(middle: &[f64; 3], ends: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| 2.0 * middle[i] - ends[i])
}

/// A tree over numbered boxes, one per face of a surface for instance.
#[derive(Clone, Debug)]
pub struct BoxTree {
    /// Nodes in preorder: a node's first child follows it.
    nodes: Vec<Node>,
    /// Items in the order of the leaves.
    items: Vec<u32>,
    /// Box of each entry of `items`.
    boxes: Vec<Bounds>,
}

#[derive(Clone, Debug)]
struct Node {
    bounds: Bounds,
    /// The node after the whole subtree of this one.
    next: usize,
    /// Range of `items` below it.
    first: usize,
    last: usize,
    /// Second child; `None` for a leaf.
    second: Option<usize>,
}

impl BoxTree {
    /// The tree over these boxes; an item is the index of its box.
    pub fn new(boxes: &[Bounds]) -> BoxTree {
        let mut tree = BoxTree {
            nodes: Vec::new(),
            items: (0..boxes.len() as u32).collect(),
            boxes: Vec::new(),
        };
        tree.split(boxes, 0, boxes.len());
        tree.refit(boxes);
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
            self.nodes[i].bounds = match node.second {
                Some(second) => self.nodes[i + 1].bounds.union(&self.nodes[second].bounds),
                None => self.boxes[node.first..node.last]
                    .iter()
                    .fold(Bounds::EMPTY, |all, b| all.union(b)),
            };
        }
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
                i = node.next;
                continue;
            }
            if node.second.is_none() {
                let range = node.first..node.last;
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
            first,
            last,
            second: None,
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
            self.nodes[here].second = Some(self.nodes.len());
            self.split(boxes, first + middle, last);
        }
        self.nodes[here].next = self.nodes.len();
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
    fn the_box_of_a_face_holds_all_of_it_and_no_more_if_it_is_straight() {
        let mut random = Random::new(5);
        for kind in [
            Kind::Bar2,
            Kind::Bar3,
            Kind::Tri3,
            Kind::Tri6,
            Kind::Quad4,
            Kind::Quad8,
            Kind::Quad9,
        ] {
            let table = kind.table();
            for _ in 0..100 {
                let x: Vec<[f64; 3]> = (0..table.nodes).map(|_| random.point(1.0)).collect();
                let bounds = Bounds::of_face(kind, &x).widened(1e-13);
                for _ in 0..200 {
                    let xi = random.point(1.0);
                    if (table.contains)(&xi, 0.0) {
                        let mut n = vec![0.0; table.nodes];
                        (table.shape)(&xi, &mut n);
                        let point = carom_elements::map::point(&x, &n);
                        assert_eq!(bounds.distance_squared(&point), 0.0, "{kind:?}");
                    }
                }
            }
            // a straight face is in the box of its corners
            let flat = Bounds::of_face(kind, table.reference);
            assert_eq!(flat, Bounds::of(table.reference), "{kind:?}");
        }
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
}
