//! Where a line or a face is nearest to a round obstacle: a ball or a cylinder that fits between nodes meets the surface between them.
//!
//! With G(x) the gap of a place, n and H its derivatives, the gap of a face is the least one on it,
//!
//! `g(u) = min over ξ of G(x(ξ, u))`, `N_a = N_a(ξ) n`, `g″ = N_a N_b H - q_k (A⁻¹)_kl q_l`,
//!
//! `q_k = N_a H e_k + N_a,k n`, `A_kl = e_k·H e_l + n·x_,kl`, `e_k = ∂x/∂ξ_k`.
//!
//! Nodes have what is nearest at a node, and what is nearest on an edge has the point of the edge: it counts where the faces around it lead away from the
//! obstacle there. A face between two of whose edges a cylinder lies touches with its edges.

use carom_algebra::tensor::{Mat3, Vec3};
use carom_elements::{Kind, MAX_FACE_NODES};
use carom_mesh::{ElementId, Face, Rim, face_nodes, project};

use crate::crossing::{ALONG, AT_END};
use crate::pairing::block::{Block, Form};
use crate::{Obstacle, Places, Point, Shape, Side};

/// Part of the length of a way by which a face may lead towards the obstacle, for rounding.
const LEVEL: f64 = 1e-6;

/// What the surface of a round obstacle is around, m.
#[derive(Clone, Copy, Debug)]
enum Around {
    Centre([f64; 3]),
    /// A place and the unit vector along it.
    Axis([f64; 3], [f64; 3]),
}

impl Obstacle {
    /// The radius of a ball or a cylinder from which bodies are kept out, m; none of other obstacles.
    pub fn round(&self) -> Option<f64> {
        match &self.shape {
            Shape::Sphere(sphere) => (sphere.side == Side::Outside).then_some(sphere.radius),
            Shape::Cylinder(cylinder) => {
                (cylinder.side == Side::Outside).then_some(cylinder.radius)
            }
            _ => None,
        }
    }

    /// The place of a point that faces the obstacle, which is nearest to it, and whether it counts there: inside of its line or face.
    pub(crate) fn faced_by(&self, point: &Point, places: &Places) -> (Point, bool) {
        let around = match point.faces_round().then_some(&self.shape) {
            Some(Shape::Sphere(sphere)) => Around::Centre(self.moved(&sphere.centre, places.time)),
            Some(Shape::Cylinder(cylinder)) => {
                let end = [0, 1, 2].map(|i| cylinder.point[i] + cylinder.axis[i]);
                let [place, end] = [&cylinder.point, &end].map(|x| self.moved(x, places.time));
                match places.dim() {
                    2 => Around::Centre([place[0], place[1], 0.0]),
                    _ => Around::Axis(place, [0, 1, 2].map(|i| end[i] - place[i])),
                }
            }
            _ => return (*point, true),
        };
        let x = positions(point, places);
        match (point.carriers().count(), around) {
            (2, around) => on_line(point, (&x, places), &around),
            (_, Around::Centre(centre)) => on_face(point, &x, &centre),
            (_, Around::Axis(..)) => (*point, false),
        }
    }
}

fn positions(point: &Point, places: &Places) -> [[f64; 3]; MAX_FACE_NODES] {
    let mut x = [[0.0; 3]; MAX_FACE_NODES];
    for (x, (node, _)) in x.iter_mut().zip(point.carriers()) {
        *x = places.of(node);
    }
    x
}

fn on_line(point: &Point, (x, places): (&[[f64; 3]], &Places), around: &Around) -> (Point, bool) {
    let [a, b] = [x[0], x[1]].map(Vec3::from);
    let along = b - a;
    let (start, way) = match around {
        Around::Centre(centre) => (a - Vec3::from(*centre), along),
        Around::Axis(place, axis) => {
            let axis = Vec3::from(*axis);
            let across = |v: Vec3| v - axis * axis.dot(&v);
            (across(a - Vec3::from(*place)), across(along))
        }
    };
    let turned = way.norm_squared() > ALONG * along.norm_squared();
    let t = match turned {
        true => (-start.dot(&way) / way.norm_squared()).clamp(0.0, 1.0),
        false => 0.5,
    };
    let xi = 2.0 * t - 1.0;
    // from the obstacle's middle to the place
    let out = start + way * t;
    let place = a + along * t;
    let leads_away = |node: &u32| {
        let way = Vec3::from(places.of(*node)) - place;
        let way = way - along * (along.dot(&way) / along.norm_squared());
        out.dot(&way) >= -LEVEL * out.norm() * way.norm()
    };
    let counts = turned && xi.abs() < 1.0 - AT_END && point.nodes_beside().iter().all(leads_away);
    (point.moved_to(xi), counts)
}

fn on_face(point: &Point, x: &[[f64; 3]], centre: &[f64; 3]) -> (Point, bool) {
    let nodes: [u32; 4] = {
        let mut nodes = [0; 4];
        for (to, (node, _)) in nodes.iter_mut().zip(point.carriers()) {
            *to = node;
        }
        nodes
    };
    let (kind, count) = match point.carriers().count() {
        3 => (Kind::Tri3, 3),
        _ => (Kind::Quad4, 4),
    };
    let face = Face {
        kind,
        nodes: face_nodes(&nodes[..count]),
        parent: ElementId { block: 0, index: 0 },
        axis: [0.0; 3],
        radius: None,
        rim: Rim::default(),
    };
    let foot = project(&face, &x[..count], centre);
    let [r, s, _] = foot.xi;
    let least = match kind {
        Kind::Tri3 => r.min(s).min(1.0 - r - s),
        _ => (1.0 - r.abs()).min(1.0 - s.abs()),
    };
    (point.moved_on(kind, &foot.xi), least > AT_END)
}

/// How the place of a point moves over its line or face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moves {
    /// e_k, m; of a line the second one is zero.
    tangents: [Vec3; 2],
    /// N_a,k.
    slopes: [[f64; 4]; 2],
    /// x_,12, m.
    twist: Vec3,
}

impl Moves {
    /// Those of a point that faces a round obstacle, at its place; none of others.
    pub(crate) fn of(point: &Point, places: &Places) -> Option<Moves> {
        if !point.faces_round() {
            return None;
        }
        let x = positions(point, places);
        let count = point.carriers().count();
        let s: Vec3 = Vec3::zeros();
        let mut moves = Moves {
            tangents: [s; 2],
            slopes: [[0.0; 4]; 2],
            twist: s,
        };
        let shape = point.shape();
        match count {
            2 => moves.slopes[0][..2].copy_from_slice(&[-0.5, 0.5]),
            3 => moves.slopes = [[-1.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0]],
            _ => {
                // of a bilinear face: N_2 + N_3 = (1 + ξ)/2, N_3 + N_4 = (1 + η)/2
                let [xi, eta] = [[1, 2], [2, 3]].map(|[a, b]| 2.0 * (shape[a] + shape[b]) - 1.0);
                let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
                for (a, [p, q]) in signs.into_iter().enumerate() {
                    moves.slopes[0][a] = 0.25 * p * (1.0 + q * eta);
                    moves.slopes[1][a] = 0.25 * q * (1.0 + p * xi);
                    moves.twist += Vec3::from(x[a]) * (0.25 * p * q);
                }
            }
        }
        for (tangent, slopes) in moves.tangents.iter_mut().zip(&moves.slopes) {
            *tangent = x.iter().zip(slopes).map(|(x, n)| Vec3::from(*x) * *n).sum();
        }
        Some(moves)
    }

    /// Adds -factor · q_k (A⁻¹)_kl q_l to a block over the nodes of the point. `hessian`: H, 1/m.
    pub(crate) fn add_curvature(
        &self,
        point: &Point,
        (hessian, normal): (&[[f64; 3]; 3], &[f64; 3]),
        factor: f64,
        block: &mut Block,
    ) {
        let h = Mat3::from_fn(|i, j| hessian[i][j]);
        let n = Vec3::from(*normal);
        let [e, f] = &self.tangents;
        let forms = [0, 1].map(|k| {
            let (bent, slopes) = (h * self.tangents[k], &self.slopes[k]);
            let mut form: Form = [Vec3::zeros(); 2 * MAX_FACE_NODES];
            let carriers = point.carriers().zip(slopes);
            for (form, ((_, s), slope)) in form.iter_mut().zip(carriers) {
                *form = bent * s + n * *slope;
            }
            form
        });
        let a = e.dot(&(h * e));
        if f.norm_squared() == 0.0 {
            if a > 0.0 {
                block.add(-0.5 * factor / a, &forms[0], &forms[0]);
            }
            return;
        }
        let (b, c) = (e.dot(&(h * f)) + n.dot(&self.twist), f.dot(&(h * f)));
        let det = a * c - b * b;
        if det > 0.0 && a > 0.0 {
            block.add(-0.5 * factor * c / det, &forms[0], &forms[0]);
            block.add(factor * b / det, &forms[0], &forms[1]);
            block.add(-0.5 * factor * a / det, &forms[1], &forms[1]);
        }
    }
}
