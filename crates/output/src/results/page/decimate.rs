//! Fewer nodes for a large surface: edges are collapsed, those first whose collapse changes the shape least.
//!
//! The change of a collapse is measured by quadrics, sums of squared distances from the planes of the triangles that a node stands for
//! (Garland and Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997). A collapse moves a node to a neighbour, so
//! that every node that is left is one of the mesh, with its motion and its fields. The faces of a thin wall
//! have no edge in common but at its rim, and stay apart.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

/// Part of the area that a node stands for times the squared length of an edge, in the cost of its collapse: where the surface is flat,
/// nodes are left at even distances, as fields and motions need them there too.
const EVEN: f64 = 0.02;

/// Cosine of the angle by which a collapse may turn a triangle.
const TURN: f64 = 0.2;

/// Sum of weighted squared distances from planes, as the upper half of a symmetric matrix of homogeneous coordinates.
#[derive(Clone, Copy, Default)]
struct Quadric([f64; 10]);

impl Quadric {
    /// `weight` times the squared distance from the plane through `x` of the unit normal `n`.
    fn plane(n: &[f64; 3], x: &[f64; 3], weight: f64) -> Quadric {
        let p = [n[0], n[1], n[2], -dot(n, x)];
        let mut entries = [0.0; 10];
        let mut k = 0;
        for i in 0..4 {
            for j in i..4 {
                entries[k] = weight * p[i] * p[j];
                k += 1;
            }
        }
        Quadric(entries)
    }

    fn add(&mut self, other: &Quadric) {
        self.0.iter_mut().zip(other.0).for_each(|(a, b)| *a += b);
    }

    fn at(&self, x: &[f64; 3]) -> f64 {
        let p = [x[0], x[1], x[2], 1.0];
        let (mut sum, mut k) = (0.0, 0);
        for i in 0..4 {
            for j in i..4 {
                let twice = if i == j { 1.0 } else { 2.0 };
                sum += twice * self.0[k] * p[i] * p[j];
                k += 1;
            }
        }
        sum.max(0.0)
    }
}

/// The collapse of a node into a neighbour; the cheapest is the largest.
struct Collapse {
    cost: f64,
    nodes: [u32; 2],
    /// Changes of both nodes when the cost was found.
    age: u32,
}

impl Ord for Collapse {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_cost = other.cost.total_cmp(&self.cost);
        by_cost.then_with(|| other.nodes.cmp(&self.nodes))
    }
}

impl PartialOrd for Collapse {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Collapse {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Collapse {}

/// The surface while edges collapse.
struct Decimation<'a> {
    x: &'a [[f64; 3]],
    body: &'a [u32],
    held: &'a BTreeSet<u32>,
    triangles: Vec<[u32; 3]>,
    there: Vec<bool>,
    /// Triangles of each node, those that are gone among them.
    around: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    /// Area that each node stands for, m².
    areas: Vec<f64>,
    became: Vec<u32>,
    ages: Vec<u32>,
    heap: BinaryHeap<Collapse>,
    /// Whether collapses may fold the surface.
    folds: bool,
}

/// For each node the one that it became, where the triangles are to have `most` nodes. Nodes of different bodies are not joined; those
/// that are `held` stay.
pub(super) fn decimate(
    triangles: &[[u32; 3]],
    (x, body): (&[[f64; 3]], &[u32]),
    (most, held): (usize, &BTreeSet<u32>),
) -> Vec<u32> {
    let used: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let mut count = used.len();
    let mut surface = Decimation::new(triangles, (x, body), held);
    // surfaces that are no manifold, as those that deletion lays bare, cannot be simplified without a fold
    for folds in [false, true] {
        surface.folds = folds;
        surface.ask_all();
        while count > most {
            let Some(collapse) = surface.heap.pop() else {
                break;
            };
            if surface.is_due(&collapse) && surface.may(collapse.nodes) {
                surface.collapse(collapse.nodes);
                count -= 1;
            }
        }
    }
    let became = &surface.became;
    let last = |mut node: u32| {
        while became[node as usize] != node {
            node = became[node as usize];
        }
        node
    };
    (0..x.len() as u32).map(last).collect()
}

impl<'a> Decimation<'a> {
    fn new(
        triangles: &[[u32; 3]],
        (x, body): (&'a [[f64; 3]], &'a [u32]),
        held: &'a BTreeSet<u32>,
    ) -> Decimation<'a> {
        let count = x.len();
        let mut surface = Decimation {
            x,
            body,
            held,
            triangles: triangles.to_vec(),
            there: vec![true; triangles.len()],
            around: vec![Vec::new(); count],
            quadrics: vec![Quadric::default(); count],
            areas: vec![0.0; count],
            became: (0..count as u32).collect(),
            ages: vec![0; count],
            heap: BinaryHeap::new(),
            folds: false,
        };
        let mut sides: BTreeMap<[u32; 2], (u32, u32)> = BTreeMap::new();
        for (number, corners) in triangles.iter().enumerate() {
            let normal = surface.normal(corners);
            let area = 0.5 * length(&normal);
            let unit = normal.map(|n| n / (2.0 * area).max(f64::MIN_POSITIVE));
            for (k, node) in corners.iter().enumerate() {
                let node = *node as usize;
                let quadric = Quadric::plane(&unit, &x[node], area / 3.0);
                surface.quadrics[node].add(&quadric);
                surface.areas[node] += area / 3.0;
                surface.around[node].push(number as u32);
                let side = ordered(corners[k], corners[(k + 1) % 3]);
                sides.entry(side).or_insert((0, number as u32)).0 += 1;
            }
        }
        for (side, (_, triangle)) in sides.iter().filter(|(_, (count, _))| *count == 1) {
            surface.hold_rim(*side, *triangle);
        }
        surface
    }

    /// Keeps the end of the surface where it is: the plane through it, normal to its triangle.
    fn hold_rim(&mut self, side: [u32; 2], triangle: u32) {
        let [p, q] = side.map(|node| self.x[node as usize]);
        let along = [0, 1, 2].map(|i| q[i] - p[i]);
        let across = cross(&along, &self.normal(&self.triangles[triangle as usize]));
        let size = length(&across).max(f64::MIN_POSITIVE);
        let unit = across.map(|n| n / size);
        let quadric = Quadric::plane(&unit, &p, dot(&along, &along));
        side.iter()
            .for_each(|node| self.quadrics[*node as usize].add(&quadric));
    }

    /// Twice the area, along the normal.
    fn normal(&self, corners: &[u32; 3]) -> [f64; 3] {
        normal(corners, self.x)
    }

    fn triangles_of(&self, node: u32) -> impl Iterator<Item = &[u32; 3]> {
        let own = self.around[node as usize].iter().map(|t| *t as usize);
        own.filter(|t| self.there[*t]).map(|t| &self.triangles[t])
    }

    fn neighbours(&self, node: u32) -> BTreeSet<u32> {
        let corners = self.triangles_of(node).flatten().copied();
        corners.filter(|other| *other != node).collect()
    }

    /// All collapses there may be.
    fn ask_all(&mut self) {
        self.heap.clear();
        for node in 0..self.x.len() as u32 {
            for other in self.neighbours(node) {
                self.ask([node, other]);
            }
        }
    }

    fn ask(&mut self, nodes: [u32; 2]) {
        let [from, to] = nodes.map(|node| node as usize);
        if self.held.contains(&nodes[0]) || self.body[from] != self.body[to] {
            return;
        }
        let x = &self.x[to];
        let off = [0, 1, 2].map(|i| self.x[from][i] - x[i]);
        let even = EVEN * (self.areas[from] + self.areas[to]) * dot(&off, &off);
        self.heap.push(Collapse {
            cost: self.quadrics[from].at(x) + self.quadrics[to].at(x) + even,
            nodes,
            age: self.ages[from] + self.ages[to],
        });
    }

    /// Whether nothing has changed since the cost was found.
    fn is_due(&self, collapse: &Collapse) -> bool {
        let [from, to] = collapse.nodes.map(|node| node as usize);
        let is_there = |node: usize| self.became[node] == node as u32;
        is_there(from) && is_there(to) && collapse.age == self.ages[from] + self.ages[to]
    }

    /// Whether the collapse leaves a surface that is folded nowhere.
    fn may(&self, [from, to]: [u32; 2]) -> bool {
        if self.folds {
            return true;
        }
        let common = self.neighbours(from);
        let common = common.intersection(&self.neighbours(to)).count();
        let between = self.triangles_of(from).filter(|t| t.contains(&to)).count();
        let turns = |corners: &&[u32; 3]| {
            let moved = corners.map(|node| if node == from { to } else { node });
            let [before, after] = [*corners, &moved].map(|corners| self.normal(corners));
            dot(&before, &after) <= TURN * length(&before) * length(&after)
        };
        let mut others = self.triangles_of(from).filter(|t| !t.contains(&to));
        common == between && !others.any(|corners| turns(&corners))
    }

    fn collapse(&mut self, [from, to]: [u32; 2]) {
        for triangle in std::mem::take(&mut self.around[from as usize]) {
            let own = triangle as usize;
            if self.triangles[own].contains(&to) {
                self.there[own] = false;
            }
            if !self.there[own] {
                continue;
            }
            let corners = self.triangles[own].iter_mut();
            corners
                .filter(|node| **node == from)
                .for_each(|node| *node = to);
            self.around[to as usize].push(triangle);
        }
        let (quadric, area) = (self.quadrics[from as usize], self.areas[from as usize]);
        self.quadrics[to as usize].add(&quadric);
        self.areas[to as usize] += area;
        self.became[from as usize] = to;
        self.ages[to as usize] += 1;
        for other in self.neighbours(to) {
            self.ask([to, other]);
            self.ask([other, to]);
        }
    }
}

/// Normal of a triangle, of twice its area in length, m².
pub(super) fn normal(corners: &[u32; 3], x: &[[f64; 3]]) -> [f64; 3] {
    let [a, b, c] = corners.map(|node| x[node as usize]);
    let [p, q] = [b, c].map(|end| [0, 1, 2].map(|i| end[i] - a[i]));
    cross(&p, &q)
}

pub(super) fn length(v: &[f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

pub(super) fn ordered(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn cross(p: &[f64; 3], q: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        p[j] * q[k] - p[k] * q[j]
    })
}

fn dot(p: &[f64; 3], q: &[f64; 3]) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}
