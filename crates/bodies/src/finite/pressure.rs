//! Pressure that follows the faces it acts on.

use std::f64::consts::TAU;

use carom_algebra::csr::Csr;
use carom_algebra::unknowns::Unknowns;
use carom_elements::{Kind, MAX_NODES, map};
use carom_mesh::Face;

use crate::Kinematics;

/// Faces under pressure, in their current position.
///
/// A pressure p (Pa, positive in compression) pushes against the outward normal: f_a = -p ∫ N_a n da, and with the tangents
/// t_1, t_2 of the face ∂x/∂ξ, n da is t_1 × t_2 dξ in space, (t_y, -t_x) times the thickness in plane strain and times 2πr in
/// axisymmetry. The thickness of plane stress and the section of a bar are the reference ones; the end of a bar is pushed
/// along its reference axis.
///
/// **Over a step** it is the mean of these forces on the straight way between two displacements: a discrete gradient, whose work on a closed surface is
/// p times the loss of volume. Forces are polynomials of second degree of the displacement at most, of which two points of Gauss's rule on the way are the
/// exact mean.
///
/// Wriggers (2008), Nonlinear Finite Element Methods, chapter on deformation-dependent loads.
#[derive(Clone, Debug)]
pub struct FollowerPressure {
    kinematics: Kinematics,
    /// Unknowns of a node.
    dim: usize,
    faces: Vec<Loaded>,
}

/// A face on the nodes of the system.
#[derive(Clone, Debug)]
struct Loaded {
    kind: Kind,
    /// First unknowns of its nodes.
    first: Vec<u32>,
    /// Reference positions in m.
    x: Vec<[f64; 3]>,
    axis: [f64; 3],
}

/// The points of Gauss on [0, 1], each of weight 1/2.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// Displacements: one, or a part of the way from another one to it.
#[derive(Clone, Copy)]
struct Way<'a> {
    from: &'a [f64],
    to: &'a [f64],
    part: f64,
}

impl Way<'_> {
    /// The displacement itself, m.
    fn end(u: &[f64]) -> Way<'_> {
        Way {
            from: u,
            to: u,
            part: 1.0,
        }
    }

    fn at(&self, unknown: usize) -> f64 {
        let (from, to) = (self.from[unknown], self.to[unknown]);
        match self.part == 1.0 {
            true => to,
            false => from + self.part * (to - from),
        }
    }
}

/// One integration point of a face.
struct Point<'a> {
    /// N_a.
    n: &'a [f64],
    /// dN_a/dξ.
    dn: &'a [[f64; 3]],
    weight: f64,
    /// ∂x/∂ξ_1 and ∂x/∂ξ_2.
    tangents: [[f64; 3]; 2],
    /// Place on the face.
    place: [f64; 3],
}

impl FollowerPressure {
    /// `faces`: on nodes of the mesh; `x`: their positions in m; `number`: system number of each mesh node;
    /// `unknowns`: of the nodes of the system; `kinematics`: of the body that they bound.
    pub fn new(
        faces: &[Face],
        x: &[[f64; 3]],
        number: &[u32],
        unknowns: &Unknowns,
        kinematics: Kinematics,
    ) -> FollowerPressure {
        let loaded = |face: &Face| Loaded {
            kind: face.kind,
            first: face
                .corners()
                .iter()
                .map(|&n| unknowns.first(number[n as usize]) as u32)
                .collect(),
            x: face.corners().iter().map(|&n| x[n as usize]).collect(),
            axis: face.axis,
        };
        FollowerPressure {
            kinematics,
            dim: unknowns.dim(),
            faces: faces.iter().map(loaded).collect(),
        }
    }

    /// Adds the forces (N) of the pressure `p` (Pa) at the displacement `u` (m) to the system vector `f` of external forces.
    pub fn add_force(&self, p: f64, u: &[f64], f: &mut [f64]) {
        self.add_force_at(p, Way::end(u), f);
    }

    /// Adds the mean of these forces on the way from one displacement to another.
    pub fn add_mean_force(&self, p: f64, [from, to]: [&[f64]; 2], f: &mut [f64]) {
        for part in GAUSS {
            self.add_force_at(0.5 * p, Way { from, to, part }, f);
        }
    }

    fn add_force_at(&self, p: f64, u: Way, f: &mut [f64]) {
        let dim = self.dim;
        for face in &self.faces {
            if face.kind == Kind::Point1 {
                let first = face.first[0] as usize;
                for i in 0..dim {
                    f[first + i] -= p * self.kinematics.surface_factor(&face.x[0]) * face.axis[i];
                }
                continue;
            }
            self.each_point(face, u, &mut |point| {
                let area = self.area(point);
                for (n, &first) in point.n.iter().zip(&face.first) {
                    let f = &mut f[first as usize..][..dim];
                    for (f, area) in f.iter_mut().zip(&area) {
                        *f -= p * point.weight * n * area;
                    }
                }
            });
        }
    }

    /// Adds `factor` ∂f/∂u (N/m) of the forces of [`FollowerPressure::add_force`] to a matrix over all unknowns of the system.
    ///
    /// ∂f/∂u of a uniform pressure is symmetric but for terms on the border of the loaded surface, which vanish where it is
    /// closed or ends on a symmetry plane or the axis.
    pub fn add_tangent(&self, p: f64, u: &[f64], factor: f64, matrix: &mut Csr) {
        self.add_tangent_at(p * factor, Way::end(u), matrix);
    }

    /// Adds `factor` times the derivative of the forces of [`FollowerPressure::add_mean_force`] by the second displacement.
    pub fn add_mean_tangent(&self, p: f64, [from, to]: [&[f64]; 2], factor: f64, matrix: &mut Csr) {
        for part in GAUSS {
            let way = Way { from, to, part };
            self.add_tangent_at(0.5 * part * p * factor, way, matrix);
        }
    }

    fn add_tangent_at(&self, p: f64, u: Way, matrix: &mut Csr) {
        let dim = self.dim;
        let (mut unknowns, mut block) = (Vec::new(), Vec::new());
        for face in self.faces.iter().filter(|face| face.kind != Kind::Point1) {
            let n = dim * face.first.len();
            block.clear();
            block.resize(n * n, 0.0);
            self.each_point(face, u, &mut |point| self.add_point(p, point, &mut block));
            unknowns.clear();
            let of_node = |&first: &u32| first..first + dim as u32;
            unknowns.extend(face.first.iter().flat_map(of_node));
            matrix.add_block(&unknowns, &block);
        }
    }

    /// n da/dξ with thickness or 2πr.
    fn area(&self, point: &Point) -> [f64; 3] {
        let [s, t] = &point.tangents;
        if self.dim == 3 {
            return cross(s, t);
        }
        let factor = self.kinematics.surface_factor(&point.place);
        [s[1] * factor, -s[0] * factor, 0.0]
    }

    /// Adds -p w N_a ∂(n da/dξ)/∂u_b to the block (a, b) of a row-major matrix.
    fn add_point(&self, p: f64, point: &Point, block: &mut [f64]) {
        let (dim, nodes) = (self.dim, point.n.len());
        for b in 0..nodes {
            for j in 0..dim {
                let change = self.area_change(point, b, j);
                for (a, n) in point.n.iter().enumerate() {
                    for (i, change) in change[..dim].iter().enumerate() {
                        let entry = (dim * a + i) * dim * nodes + dim * b + j;
                        block[entry] -= p * point.weight * n * change;
                    }
                }
            }
        }
    }

    /// Derivative of n da/dξ by component `j` of node `b`.
    fn area_change(&self, point: &Point, b: usize, j: usize) -> [f64; 3] {
        let [s, t] = &point.tangents;
        let dn = &point.dn[b];
        let mut unit = [0.0; 3];
        unit[j] = 1.0;
        if self.dim == 3 {
            let (first, second) = (cross(&unit, t), cross(s, &unit));
            return [0, 1, 2].map(|i| dn[0] * first[i] + dn[1] * second[i]);
        }
        let factor = self.kinematics.surface_factor(&point.place);
        let mut change = [unit[1] * dn[0] * factor, -unit[0] * dn[0] * factor, 0.0];
        if self.kinematics == Kinematics::Axisymmetric && j == 0 {
            change[0] += TAU * point.n[b] * s[1];
            change[1] -= TAU * point.n[b] * s[0];
        }
        change
    }

    fn each_point(&self, face: &Loaded, u: Way, visit: &mut dyn FnMut(&Point)) {
        let table = face.kind.table();
        let mut x = face.x.clone();
        for (x, &first) in x.iter_mut().zip(&face.first) {
            let unknowns = first as usize..first as usize + self.dim;
            x.iter_mut().zip(unknowns).for_each(|(x, i)| *x += u.at(i));
        }
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        let (n, dn) = (&mut n[..table.nodes], &mut dn[..table.nodes]);
        let rule = table.mass_rule;
        for (xi, &weight) in rule.points.iter().zip(rule.weights) {
            (table.shape)(xi, n);
            (table.gradient)(xi, dn);
            let tangent = |k: usize| {
                [0, 1, 2].map(|i| x.iter().zip(dn.iter()).map(|(x, dn)| x[i] * dn[k]).sum())
            };
            visit(&Point {
                tangents: [tangent(0), tangent(1)],
                place: map::point(&x, n),
                n,
                dn,
                weight,
            });
        }
    }
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
