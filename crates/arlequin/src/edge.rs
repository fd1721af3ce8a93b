//! The edge of a shell on faces of a solid that it continues.

use std::collections::BTreeMap;

use carom_mesh::{Face, Mesh};

use crate::cell::norm;
use crate::coupling::Sum;
use crate::error::Error;
use crate::faces::{each_point, unit};
use crate::polytope::{cross, dot, sub};
use crate::rows::{Row, Rows, Term};

/// Part of the largest face around a node of the edge below which it has none of its own.
const SLIVER: f64 = 0.02;
/// Relative difference of the height of the faces and the thickness up to which they count as the same.
const SAME: f64 = 0.12;
/// Largest distance of the middle of the faces from the middle surface, in thicknesses.
const CENTRED: f64 = 0.05;

/// A piece of the edge of a shell between two of its nodes.
#[derive(Clone, Copy, Debug)]
pub struct EdgeCell {
    /// The nodes.
    pub nodes: [u32; 2],
    /// Places of the middle surface there, m.
    pub x: [[f64; 3]; 2],
    /// Unit directors.
    pub directors: [[f64; 3]; 2],
    /// From the nodes to the middle surface along the directors, m.
    pub offset: f64,
    /// Thickness, m.
    pub thickness: f64,
}

/// A place beside the edge.
struct Place<'a> {
    cell: &'a EdgeCell,
    /// Shape functions of both nodes.
    n: [f64; 2],
    /// From the edge.
    r: [f64; 3],
}

impl EdgeCell {
    /// The foot of a place on the piece, with its distance.
    fn place(&self, x: &[f64; 3]) -> (f64, Place<'_>) {
        let along = sub(&self.x[1], &self.x[0]);
        let t = dot(&sub(x, &self.x[0]), &along) / dot(&along, &along);
        let t = t.clamp(0.0, 1.0);
        let r = [0, 1, 2].map(|i| x[i] - self.x[0][i] - t * along[i]);
        let n = [1.0 - t, t];
        (norm(&r), Place { cell: self, n, r })
    }
}

impl Place<'_> {
    /// Calls `term` with the unknowns of the edge and their coefficients in v·(u + θ × r), the edge bent without shear between its nodes.
    fn motion(&self, v: &[f64; 3], term: &mut dyn FnMut(u32, f64)) {
        let cell = self.cell;
        let edge = sub(&cell.x[1], &cell.x[0]);
        let bubble = 0.5 * self.n[0] * self.n[1];
        for b in 0..2 {
            let d = &cell.directors[b];
            let arm = [0, 1, 2].map(|i| self.r[i] + cell.offset * d[i]);
            // v·(θ × arm) = θ·(arm × v); the deflection in the middle of the edge is (θ₁·(d₁ × e) - θ₀·(d₀ × e))/8
            let turned = cross(&arm, v);
            let bent = cross(d, &edge);
            let sign = if b == 0 { -bubble } else { bubble };
            for i in 0..3 {
                term(6 * cell.nodes[b] + i as u32, self.n[b] * v[i]);
                let value = self.n[b] * turned[i] + sign * dot(d, v) * bent[i];
                term(6 * cell.nodes[b] + 3 + i as u32, value);
            }
        }
    }
}

/// The nearest place of the edge.
fn nearest<'a>(edge: &'a [EdgeCell], x: &[f64; 3]) -> Option<Place<'a>> {
    let places = edge.iter().map(|cell| cell.place(x));
    places
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, place)| place)
}

/// A node of the edge: its axes across the director, and ∫ N_A dA.
struct Node {
    axes: [(usize, [f64; 3]); 2],
    gyration: f64,
    area: f64,
    sums: Vec<[Sum; 2]>,
}

/// Rows that give the edge of a shell the mean motion of some faces: `∫ N_A (v - u - θ × r) dA = 0` and, over h/√12, `∫ N_A (t × r)·(v - u - θ × r) dA = 0`
/// for each node A of the edge with its shape function along the edge and the two axes t across the director, r from the edge. The faces are free
/// to deform otherwise.
///
/// Terms of the faces are the inner ones, those of the edge the outer ones.
///
/// Errors: faces that are not as high as the shell is thick, or lie beside its middle surface; a node of the edge without a face.
pub fn edge_mean_motion(mesh: &Mesh, faces: &[Face], edge: &[EdgeCell]) -> Result<Rows, Error> {
    check(mesh, faces, edge)?;
    let mut nodes: BTreeMap<u32, Node> = BTreeMap::new();
    for (cell, b) in edge.iter().flat_map(|cell| [(cell, 0), (cell, 1)]) {
        nodes.entry(cell.nodes[b]).or_insert_with(|| Node {
            axes: across(&cell.directors[b]),
            gyration: cell.thickness / 12.0_f64.sqrt(),
            area: 0.0,
            sums: (0..5).map(|_| Default::default()).collect(),
        });
    }
    for face in faces {
        each_point(mesh, face, |x, n, weight| {
            let Some(place) = nearest(edge, x) else {
                return;
            };
            for (b, node) in place.cell.nodes.iter().enumerate() {
                let Some(own) = nodes.get_mut(node) else {
                    continue;
                };
                let part = weight * place.n[b];
                own.area += part;
                let turned = own.axes.map(|(_, axis)| {
                    let axis = axis.map(|x| x / own.gyration);
                    cross(&axis, &place.r)
                });
                let modes = [0, 1, 2].map(unit).into_iter().chain(turned);
                for (sums, mode) in own.sums.iter_mut().zip(modes) {
                    let [of_face, of_edge] = sums;
                    let mu = mode.map(|x| part * x);
                    for (&node, n) in face.corners().iter().zip(n) {
                        for (i, mu) in mu.iter().enumerate().filter(|(_, mu)| **mu != 0.0) {
                            of_face.add(6 * node + i as u32, mu * n);
                        }
                    }
                    place.motion(&mu, &mut |key, value| of_edge.add(key, value));
                }
            }
        });
    }
    let largest = nodes.values().fold(0.0_f64, |m, node| m.max(node.area));
    let mut rows = Vec::new();
    for (node, mut own) in nodes {
        if own.area < SLIVER * largest {
            return Err(Error::EdgeWithoutFace { node });
        }
        let [(first, _), (second, _)] = own.axes;
        for (sums, component) in own.sums.iter_mut().zip([0, 1, 2, 3 + first, 3 + second]) {
            let [inner, outer] = [0, 1].map(|side| terms(&mut sums[side]));
            rows.push(Row {
                node,
                component: component as u32,
                inner,
                outer,
                ..Row::default()
            });
        }
    }
    Ok(Rows {
        rows,
        slivers: Vec::new(),
    })
}

/// Rows that move every node of some faces as a part of the section of a shell at its edge.
///
/// Errors: those of [`edge_mean_motion`] that regard the faces.
pub fn edge_rigid_motion(mesh: &Mesh, faces: &[Face], edge: &[EdgeCell]) -> Result<Rows, Error> {
    check(mesh, faces, edge)?;
    let mut nodes: Vec<u32> = faces
        .iter()
        .flat_map(|face| face.corners())
        .copied()
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    let mut rows = Vec::new();
    for node in nodes {
        let Some(place) = nearest(edge, &mesh.nodes[node as usize]) else {
            continue;
        };
        for i in 0..3 {
            let mut sum = Sum::default();
            place.motion(&unit(i), &mut |key, value| sum.add(key, value));
            let inner = Term {
                node,
                component: i as u32,
                coefficient: 1.0,
            };
            rows.push(Row {
                node,
                component: i as u32,
                inner: vec![inner],
                outer: terms(&mut sum),
                ..Row::default()
            });
        }
    }
    Ok(Rows {
        rows,
        slivers: Vec::new(),
    })
}

/// Compares the height of the faces with the thickness.
fn check(mesh: &Mesh, faces: &[Face], edge: &[EdgeCell]) -> Result<(), Error> {
    let (mut area, mut first) = (0.0, 0.0);
    for face in faces {
        each_point(mesh, face, |x, _, weight| {
            if let Some(place) = nearest(edge, x) {
                let d = [0, 1, 2].map(|i| {
                    let [a, b] = &place.cell.directors;
                    place.n[0] * a[i] + place.n[1] * b[i]
                });
                area += weight;
                first += weight * dot(&place.r, &d);
            }
        });
    }
    let lengths = edge.iter().map(|cell| norm(&sub(&cell.x[1], &cell.x[0])));
    let length: f64 = lengths.sum();
    let thickness = edge.first().map_or(0.0, |cell| cell.thickness);
    let (height, beside) = (area / length, first / area);
    let same = (height / thickness - 1.0).abs() <= SAME && beside.abs() <= CENTRED * thickness;
    match same {
        true => Ok(()),
        false => Err(Error::FaceOfEdge {
            height,
            beside,
            thickness,
        }),
    }
}

/// The axes of coordinates least along a director, less their parts along it.
pub(crate) fn across(d: &[f64; 3]) -> [(usize, [f64; 3]); 2] {
    let normal = (1..3).fold(
        0,
        |best, i| if d[i].abs() > d[best].abs() { i } else { best },
    );
    let axis = |i: usize| {
        let along = [0, 1, 2].map(|k| f64::from(k == i) - d[i] * d[k]);
        let length = norm(&along);
        (i, along.map(|x| x / length))
    };
    match normal {
        0 => [axis(1), axis(2)],
        1 => [axis(0), axis(2)],
        _ => [axis(0), axis(1)],
    }
}

/// The terms of a sum whose keys are six times the node plus the component.
pub(crate) fn terms(sum: &mut Sum) -> Vec<Term> {
    let sum = sum.sorted();
    let largest = sum.iter().fold(0.0_f64, |m, t| m.max(t.1.abs()));
    let kept = sum.iter().filter(|t| t.1.abs() > 1e-18 * largest);
    let term = |&(key, coefficient): &(u32, f64)| Term {
        node: key / 6,
        component: key % 6,
        coefficient,
    };
    kept.map(term).collect()
}
