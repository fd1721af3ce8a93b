//! What is drawn of the mesh: triangles, edges and lines over the nodes that were kept; of a large mesh fewer of them.

use std::collections::{BTreeMap, BTreeSet};

use carom_dynamics::System;

use crate::results::outlines::Outlines;
use crate::results::page::decimate::{decimate, ordered};
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

    /// Draws the surface with some `most` nodes, `x` their places in m and `body` their bodies ([`decimate`]). Nodes of lines, and those that
    /// are `held`, stay. Returns for each node the one that it became; `None` where there are no more nodes than these.
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
        let became = decimate(&self.triangles, (x, body), (most, &fixed));
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::page::decimate::{length, normal};

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

    /// m².
    fn area(surface: &Surface, x: &[[f64; 3]]) -> f64 {
        let of = |corners: &[u32; 3]| 0.5 * length(&normal(corners, x));
        surface.triangles.iter().map(of).sum()
    }

    #[test]
    fn a_square_with_fewer_nodes_keeps_its_rim_its_area_and_what_is_held() {
        let (mut surface, x) = square(100);
        let body = vec![0; x.len()];
        let held = BTreeSet::from([5050, 5051, 5152]);
        let became = surface.decimate(&x, &body, (1500, &held));
        let became = became.unwrap_or_default();
        let left: BTreeSet<u32> = surface.triangles.iter().flatten().copied().collect();
        assert_eq!(left.len(), 1500);
        assert!(left.iter().all(|node| became[*node as usize] == *node));
        assert!(held.is_subset(&left));
        // nothing leaves the rim, and no triangle is folded: rounding of ten thousand areas
        assert!((area(&surface, &x) / 1e4 - 1.0).abs() < 1e-9);
        // even distances: a node stands for 6.7 squares, an edge of regular triangles is 2.8 long
        let longest = surface.edges.iter().map(|[a, b]| {
            let off = [0, 1, 2].map(|i| x[*a as usize][i] - x[*b as usize][i]);
            length(&off)
        });
        assert!(longest.fold(0.0, f64::max) < 4.0 * 2.8);
    }

    #[test]
    fn the_faces_of_a_thin_wall_stay_apart() {
        // a plate of 60 by 60 with a thickness of a tenth of an edge: its faces and its rim
        let (mut surface, mut x) = square(60);
        let count = x.len() as u32;
        x.extend(x.clone().iter().map(|x| [x[0], x[1], 0.1]));
        let upper = surface.triangles.clone();
        surface.triangles.extend(
            upper
                .iter()
                .map(|t| [t[2] + count, t[1] + count, t[0] + count]),
        );
        for k in 0..60 {
            let rim = [
                [k, k + 1],
                [61 * 60 + k + 1, 61 * 60 + k],
                [61 * (k + 1), 61 * k],
                [61 * k + 60, 61 * (k + 1) + 60],
            ];
            for [a, b] in rim {
                surface
                    .triangles
                    .extend([[b, a, a + count], [b, a + count, b + count]]);
            }
        }
        let all = surface.triangles.len();
        (surface.cells, surface.faces) = (vec![0; all], vec![0; all]);
        let body = vec![0; x.len()];
        let exact = area(&surface, &x);
        assert!((exact - (2.0 * 3600.0 + 4.0 * 6.0)).abs() < 1e-6);
        surface.decimate(&x, &body, (900, &BTreeSet::new()));
        // what is as thin as the wall may go, both faces stay
        assert!(
            (area(&surface, &x) / 7200.0 - 1.0).abs() < 5e-3,
            "{}",
            area(&surface, &x)
        );
        // only at the rim do triangles have nodes of both
        let heights = |t: &[u32; 3]| t.map(|node| x[node as usize][2]);
        let across = |t: &&[u32; 3]| heights(t) != [heights(t)[0]; 3];
        let on_rim = |node: &u32| (0..2).any(|i| [0.0, 60.0].contains(&x[*node as usize][i]));
        let mut across = surface.triangles.iter().filter(across);
        assert!(across.all(|t| t.iter().any(on_rim)));
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
