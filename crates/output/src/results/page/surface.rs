//! What is drawn of the mesh: triangles, edges and lines over the nodes that were kept; of a large mesh fewer of them.

use std::collections::{BTreeMap, BTreeSet};

use carom_dynamics::System;

use crate::results::outlines::Outlines;
use crate::results::stills::{Seen, Still};

/// Triangles, edges and lines. Nodes and cells by their place in [`Seen`].
#[derive(Debug, Default)]
pub(crate) struct Surface {
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Of each triangle.
    pub(crate) cells: Vec<u32>,
    /// Of each triangle the face to which it belongs.
    faces: Vec<usize>,
    pub(crate) edges: BTreeSet<[u32; 2]>,
    pub(crate) lines: Vec<[u32; 2]>,
    /// Of each line.
    pub(crate) line_cells: Vec<u32>,
    /// Nodes of elements that are points.
    pub(crate) points: Vec<u32>,
    /// Faces that are there at each instant; none where all always are.
    pub(crate) visible: Option<Vec<Vec<bool>>>,
}

impl Surface {
    /// Of a system, with the faces that the deletion of elements lays bare at the instants.
    pub(crate) fn new(system: &System, seen: &Seen, stills: &[&Still]) -> Surface {
        let mut faces: BTreeMap<(usize, Vec<u32>), (usize, Vec<u32>)> = BTreeMap::new();
        let mut add = |outlines: &Outlines| -> Vec<usize> {
            let number = |(ring, cell): (&[u32], usize)| {
                let mut key = ring.to_vec();
                key.sort_unstable();
                let next = faces.len();
                let entry = faces.entry((cell, key)).or_insert((next, ring.to_vec()));
                entry.0
            };
            outlines.patches().map(number).collect()
        };
        let deleted: Option<Vec<&Vec<bool>>> = stills.iter().map(|s| s.deleted.as_ref()).collect();
        let shown: Option<Vec<Vec<usize>>> = deleted.filter(|d| !d.is_empty()).map(|deleted| {
            let of = |deleted: &&Vec<bool>| add(&Outlines::new(system, |_, cell| !deleted[cell]));
            deleted.iter().map(of).collect()
        });
        if shown.is_none() {
            add(&Outlines::new(system, |_, _| true));
        }
        let count = faces.len();
        let mut surface = Surface {
            visible: shown.map(|instants| {
                let of = |there: Vec<usize>| {
                    let mut visible = vec![false; count];
                    there.into_iter().for_each(|face| visible[face] = true);
                    visible
                };
                instants.into_iter().map(of).collect()
            }),
            ..Surface::default()
        };
        for ((cell, _), (face, ring)) in faces {
            surface.add_face(seen, face, cell, &ring);
        }
        surface.add_lines(system, seen);
        surface
    }

    fn add_face(&mut self, seen: &Seen, face: usize, cell: usize, ring: &[u32]) {
        let ring: Option<Vec<u32>> = ring.iter().map(|n| Some(seen.node(*n)? as u32)).collect();
        let (Some(ring), Some(cell)) = (ring, seen.cell(cell)) else {
            return;
        };
        for k in 0..ring.len() {
            self.edges
                .insert(ordered(ring[k], ring[(k + 1) % ring.len()]));
        }
        for k in 2..ring.len() {
            self.triangles.push([ring[0], ring[k - 1], ring[k]]);
            self.cells.push(cell as u32);
            self.faces.push(face);
        }
    }

    /// Elements that are lines or points: bars, beams, springs, masses.
    fn add_lines(&mut self, system: &System, seen: &Seen) {
        let elements = system.bodies.iter().flat_map(|body| body.cells());
        for (cell, element) in elements.enumerate() {
            let nodes = system.mesh.element_nodes(*element).iter();
            let nodes = nodes.filter_map(|n| seen.node(system.number[*n as usize]));
            let nodes: Vec<u32> = nodes.map(|n| n as u32).collect();
            let dim = system.mesh.kind(*element).table().dim;
            let cell = seen.cell(cell).unwrap_or(0) as u32;
            match (dim, &nodes[..]) {
                (0 | 1, [only]) => self.points.push(*only),
                (1, [from, to, middle]) => {
                    self.lines.extend([[*from, *middle], [*middle, *to]]);
                    self.line_cells.extend([cell, cell]);
                }
                (1, [from, to, ..]) => {
                    self.lines.push([*from, *to]);
                    self.line_cells.push(cell);
                }
                _ => {}
            }
        }
    }

    /// Whether there is nothing to draw.
    pub(crate) fn is_blank(&self) -> bool {
        self.triangles.is_empty() && self.lines.is_empty() && self.points.is_empty()
    }

    /// Whether each triangle is there at an instant.
    pub(crate) fn visible(&self, instant: usize) -> Option<Vec<u8>> {
        let visible = self.visible.as_ref()?;
        let there = self
            .faces
            .iter()
            .map(|face| u8::from(visible[instant][*face]));
        Some(there.collect())
    }

    /// Draws the surface with some `most` nodes, `x` their places in m and `body` their bodies: nodes of one body that lie in one cube of a grid become the
    /// sharpest of them, triangles that keep no area are left out. Nodes of lines, and those that are `held`, stay. Returns for each node the one that it became;
    /// `None` where there are no more nodes than these.
    pub(crate) fn decimate(
        &mut self,
        x: &[[f64; 3]],
        body: &[u32],
        (most, held): (usize, &BTreeSet<u32>),
    ) -> Option<Vec<u32>> {
        let used: BTreeSet<u32> = self.triangles.iter().flatten().copied().collect();
        if used.len() <= most {
            return None;
        }
        let lines = self.lines.iter().flatten();
        let fixed: BTreeSet<u32> = lines.chain(held).copied().collect();
        let used: Vec<u32> = used.difference(&fixed).copied().collect();
        let mut side = (self.area(x) / most as f64).sqrt();
        let mut groups = grouped(&used, x, body, side);
        while groups.len() > most {
            side *= 1.02 * (groups.len() as f64 / most as f64).sqrt();
            groups = grouped(&used, x, body, side);
        }
        let mut became: Vec<u32> = (0..x.len() as u32).collect();
        let sharpness = self.sharpness(x);
        for group in groups.values() {
            let one = representative(group, x, &sharpness);
            group.iter().for_each(|node| became[*node as usize] = one);
        }
        self.join(&became);
        Some(became)
    }

    /// Replaces nodes by those that they became.
    fn join(&mut self, became: &[u32]) {
        let mut there = BTreeSet::new();
        let (mut triangles, mut cells, mut faces) = (Vec::new(), Vec::new(), Vec::new());
        self.edges.clear();
        for (k, corners) in self.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|node| became[node as usize]);
            let mut key = [a, b, c];
            key.sort_unstable();
            if a == b || b == c || c == a || !there.insert(key) {
                continue;
            }
            triangles.push([a, b, c]);
            cells.push(self.cells[k]);
            faces.push(self.faces[k]);
            self.edges
                .extend([ordered(a, b), ordered(b, c), ordered(c, a)]);
        }
        (self.triangles, self.cells, self.faces) = (triangles, cells, faces);
    }

    /// m².
    fn area(&self, x: &[[f64; 3]]) -> f64 {
        let of = |corners: &[u32; 3]| 0.5 * length(&normal(corners, x));
        self.triangles.iter().map(of).sum()
    }

    /// How far the surface is bent at each node, in tenths of 1 - |mean of the unit normals around it|: 0 where it is flat, 3 on the edge of
    /// a cube, 4 in its corner; 10 more where it ends.
    fn sharpness(&self, x: &[[f64; 3]]) -> Vec<u8> {
        let mut sums = vec![([0.0; 3], 0.0); x.len()];
        let mut sides: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        for corners in &self.triangles {
            let n = normal(corners, x);
            let size = length(&n);
            for (k, node) in corners.iter().enumerate() {
                let (sum, count) = &mut sums[*node as usize];
                *sum = [0, 1, 2].map(|i| sum[i] + n[i] / size);
                *count += 1.0;
                *sides
                    .entry(ordered(*node, corners[(k + 1) % 3]))
                    .or_default() += 1;
            }
        }
        let of = |(sum, count): ([f64; 3], f64)| match count > 0.0 {
            true => (10.0 * (1.0 - length(&sum) / count)).round() as u8,
            false => 0,
        };
        let mut sharpness: Vec<u8> = sums.into_iter().map(of).collect();
        let ends = sides.iter().filter(|(_, triangles)| **triangles == 1);
        for node in ends.flat_map(|(side, _)| side) {
            let own = &mut sharpness[*node as usize];
            *own = 10 + *own % 10;
        }
        sharpness
    }
}

/// Normal of a triangle, of twice its area in length, m².
fn normal(corners: &[u32; 3], x: &[[f64; 3]]) -> [f64; 3] {
    let [a, b, c] = corners.map(|node| x[node as usize]);
    let [p, q] = [b, c].map(|end| [0, 1, 2].map(|i| end[i] - a[i]));
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        p[j] * q[k] - p[k] * q[j]
    })
}

fn length(v: &[f64; 3]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn ordered(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

type Cube = (u32, [i64; 3]);

/// Nodes by their body and the cube of this side (m) in which they lie.
fn grouped(nodes: &[u32], x: &[[f64; 3]], body: &[u32], side: f64) -> BTreeMap<Cube, Vec<u32>> {
    let mut groups: BTreeMap<Cube, Vec<u32>> = BTreeMap::new();
    for &node in nodes {
        let cube = x[node as usize].map(|x| (x / side).floor() as i64);
        let group = groups.entry((body[node as usize], cube)).or_default();
        group.push(node);
    }
    groups
}

/// The sharpest node of a group, of equals the nearest to the centre of these.
fn representative(group: &[u32], x: &[[f64; 3]], sharpness: &[u8]) -> u32 {
    let rank = |node: &u32| sharpness[*node as usize];
    let sharpest = group.iter().map(rank).max();
    let equals = || group.iter().filter(|node| Some(rank(node)) == sharpest);
    let place = |node: &u32| x[*node as usize];
    let count = equals().count() as f64;
    let centre = equals().map(place).fold([0.0; 3], |centre, x| {
        [0, 1, 2].map(|i| centre[i] + x[i] / count)
    });
    let off = |node: &u32| length(&[0, 1, 2].map(|i| place(node)[i] - centre[i]));
    let closer = |best: u32, node: &u32| if off(node) < off(&best) { *node } else { best };
    equals().fold(equals().next().map_or(group[0], |node| *node), closer)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of n by n squares of side 1, each in two triangles.
    fn square(n: u32) -> (Surface, Vec<[f64; 3]>) {
        let mut surface = Surface::default();
        let node = |i: u32, j: u32| i + (n + 1) * j;
        for i in 0..n {
            for j in 0..n {
                let [a, b, c, d] = [
                    node(i, j),
                    node(i + 1, j),
                    node(i + 1, j + 1),
                    node(i, j + 1),
                ];
                surface.triangles.extend([[a, b, c], [a, c, d]]);
                surface.cells.extend([0, 0]);
                surface.faces.extend([0, 0]);
            }
        }
        let x =
            (0..(n + 1) * (n + 1)).map(|k| [f64::from(k % (n + 1)), f64::from(k / (n + 1)), 0.0]);
        (surface, x.collect())
    }

    #[test]
    fn a_square_with_fewer_nodes_keeps_its_rim_and_what_is_held() {
        let (mut surface, x) = square(100);
        let body = vec![0; x.len()];
        let exact = surface.area(&x);
        assert!((exact - 1e4).abs() < 1e-8);
        let held = BTreeSet::from([5050, 5051, 5152]);
        let became = surface.decimate(&x, &body, (1500, &held));
        let became = became.unwrap_or_default();
        let left: BTreeSet<u32> = surface.triangles.iter().flatten().copied().collect();
        assert!(left.len() <= 1500 + held.len(), "{}", left.len());
        assert!(left.iter().all(|node| became[*node as usize] == *node));
        assert!(held.is_subset(&left));
        // the rim is flat, and its nodes are chosen before those inside: what is lost is cut off at the four corners
        let cube = (exact / 1500.0).sqrt() * 1.2;
        assert!(exact - surface.area(&x).min(exact) < 4.0 * cube * cube);
    }

    #[test]
    fn bodies_that_touch_are_not_joined() {
        let (mut surface, x) = square(20);
        let body: Vec<u32> = x.iter().map(|x| u32::from(x[0] > 10.0)).collect();
        let became = surface
            .decimate(&x, &body, (60, &BTreeSet::new()))
            .unwrap_or_default();
        for (node, to) in became.iter().enumerate() {
            assert_eq!(body[node], body[*to as usize]);
        }
    }

    #[test]
    fn a_small_surface_stays_as_it_is() {
        let (mut surface, x) = square(3);
        assert!(
            surface
                .decimate(&x, &[0; 16], (16, &BTreeSet::new()))
                .is_none()
        );
        assert_eq!(surface.triangles.len(), 18);
    }
}
