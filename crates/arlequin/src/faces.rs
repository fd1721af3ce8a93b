//! The mean motion of the faces of a solid, and the node that has it.

use std::collections::BTreeMap;

use carom_elements::{MAX_FACE_NODES, map};
use carom_mesh::{Face, Mesh};

use crate::error::Error;
use crate::polytope::{cross, sub};
use crate::rows::{Row, Rows, Term};

/// Least moment of the faces about an axis, over the largest, for which their mean rotation about it has a meaning.
const LEAST: f64 = 1e-9;

/// ∫ dA, ∫ r dA and ∫ (r·r I - r ⊗ r) dA of faces, r from a point.
#[derive(Default)]
struct Moments {
    area: f64,
    first: [f64; 3],
    second: [[f64; 3]; 3],
}

/// Rows that give a node with rotations the mean motion of some faces: `∫ (v - u - θ × r) dA = 0` and, over the root of the polar moment
/// times the area, `∫ r × (v - u - θ × r) dA = 0`, with r from the node. The faces are free to deform otherwise.
///
/// The multipliers are uniform and linear tractions, so a node with the forces of uniform tension or pure bending leaves these uniform. Terms
/// of the faces are the inner ones, those of the node the outer ones. In the plane the only rotation is that about z.
///
/// Errors: faces on one line through the node, which have no rotation about it.
pub fn mean_motion(mesh: &Mesh, faces: &[Face], node: u32) -> Result<Rows, Error> {
    let dim = mesh.dim;
    let origin = mesh.nodes[node as usize];
    let mut moments = Moments::default();
    // ∫ N_a dA and ∫ N_a r dA
    let mut sums: BTreeMap<u32, (f64, [f64; 3])> = BTreeMap::new();
    for face in faces {
        each_point(mesh, face, |x, n, weight| {
            let r = sub(x, &origin);
            moments.add(&r, weight);
            for (&own, n) in face.corners().iter().zip(n) {
                let sum = sums.entry(own).or_default();
                sum.0 += weight * n;
                (0..3).for_each(|i| sum.1[i] += weight * n * r[i]);
            }
        });
    }
    let axes: Vec<usize> = if dim == 2 { vec![2] } else { vec![0, 1, 2] };
    let largest = (0..3).fold(0.0_f64, |m, i| m.max(moments.second[i][i]));
    if moments.volume(dim) <= LEAST * largest.powi(axes.len() as i32) {
        return Err(Error::FacesOnLine { node });
    }
    let polar = (0.5 * (0..3).map(|i| moments.second[i][i]).sum::<f64>() * moments.area).sqrt();
    let mut rows = Vec::new();
    for i in 0..dim {
        let inner = sums
            .iter()
            .map(|(&node, sum)| term(node, i, sum.0 / moments.area));
        // θ × ∫ r
        let turned = axes.iter().enumerate().map(|(k, &axis)| {
            let arm = cross(&unit(axis), &moments.first)[i] / moments.area;
            term(node, dim + k, arm)
        });
        let outer = std::iter::once(term(node, i, 1.0)).chain(turned);
        rows.push(row(node, i, inner, outer));
    }
    for (k, &axis) in axes.iter().enumerate() {
        let e = unit(axis);
        // e·(r × v) = (e × r)·v
        let inner = sums.iter().flat_map(|(&node, sum)| {
            let arm = cross(&e, &sum.1);
            (0..dim).map(move |i| term(node, i, arm[i] / polar))
        });
        let arm = cross(&e, &moments.first);
        let moved = (0..dim).map(|i| term(node, i, arm[i] / polar));
        let turned = axes.iter().enumerate();
        let turned =
            turned.map(|(l, &other)| term(node, dim + l, moments.second[axis][other] / polar));
        rows.push(row(node, dim + k, inner, moved.chain(turned)));
    }
    Ok(Rows {
        rows,
        slivers: Vec::new(),
    })
}

impl Moments {
    fn add(&mut self, r: &[f64; 3], weight: f64) {
        self.area += weight;
        let square: f64 = r.iter().map(|x| x * x).sum();
        for i in 0..3 {
            self.first[i] += weight * r[i];
            self.second[i][i] += weight * square;
            (0..3).for_each(|j| self.second[i][j] -= weight * r[i] * r[j]);
        }
    }

    /// Determinant of the second moments about the axes that there are.
    fn volume(&self, dim: usize) -> f64 {
        let [a, b, c] = &self.second;
        match dim {
            2 => c[2],
            _ => (0..3).map(|i| a[i] * cross(b, c)[i]).sum(),
        }
    }
}

/// Positions, shape functions and weights at the points of a face.
pub(crate) fn each_point(mesh: &Mesh, face: &Face, mut each: impl FnMut(&[f64; 3], &[f64], f64)) {
    let table = face.kind.table();
    let mut x = [[0.0; 3]; MAX_FACE_NODES];
    for (x, &node) in x.iter_mut().zip(face.corners()) {
        *x = mesh.nodes[node as usize];
    }
    let x = &x[..table.nodes];
    let (mut n, mut dn) = ([0.0; MAX_FACE_NODES], [[0.0; 3]; MAX_FACE_NODES]);
    for (xi, weight) in table.mass_rule.points.iter().zip(table.mass_rule.weights) {
        (table.shape)(xi, &mut n[..table.nodes]);
        (table.gradient)(xi, &mut dn[..table.nodes]);
        let (measure, _) = map::measure(x, &dn[..table.nodes], table.dim);
        let n = &n[..table.nodes];
        each(&map::point(x, n), n, weight * measure);
    }
}

pub(crate) fn unit(axis: usize) -> [f64; 3] {
    std::array::from_fn(|i| f64::from(i == axis))
}

fn term(node: u32, component: usize, coefficient: f64) -> Term {
    Term {
        node,
        component: component as u32,
        coefficient,
    }
}

fn row(
    node: u32,
    component: usize,
    inner: impl Iterator<Item = Term>,
    outer: impl Iterator<Item = Term>,
) -> Row {
    Row {
        node,
        component: component as u32,
        inner: inner.filter(|t| t.coefficient != 0.0).collect(),
        outer: outer.filter(|t| t.coefficient != 0.0).collect(),
        ..Row::default()
    }
}
