//! Second derivative of the gap between a point, or the axis of a beam, and another axis with a round surface, or an edge or a corner of a shell;
//! and of that between two sharp edges of solids.
//!
//! The gap is the least distance d = |r| less the radii, r = x(ζ_A) - y(ζ_B), over the places ζ on the lines that are free to move:
//! not held at an end, and of the secondary side only where it crosses. With n = r/d, τ̃_k = ∂r/∂ζ_k, r·τ̃_k = 0, and r̂ the relative
//! motion of places that are held
//!
//! `d″ = (r̂ · (I - n ⊗ n) r̂ - q_k (τ̃_k·τ̃_l)⁻¹ q_l)/d`, `q_k = τ̃_k·r̂ + r·δτ̃_k`.
//!
//! Where both places are free, τ̃_1 and τ̃_2 span the plane normal to n, and I - n ⊗ n = τ̃_k (τ̃_k·τ̃_l)⁻¹ τ̃_l. The distance then cancels, and of
//! the gap g of two sharp edges, r = g n, of either sign,
//!
//! `g″ = -(2 τ̃_k·r̂ + g ω_k) (τ̃_k·τ̃_l)⁻¹ ω_l`, `ω_k = n·δτ̃_k`,
//!
//! also where it is zero.

use carom_algebra::tensor::Vec3;
use carom_elements::MAX_FACE_NODES as NODES;

use super::block::{Block, Form};
use super::foothold::Foothold;
use crate::Point;

/// Adds factor · d″ to a block over the nodes of the point and then of the face. In the axis, where there is no normal, nothing.
pub fn add_curvature(point: &Point, foot: &Foothold, factor: f64, block: &mut Block) {
    let r = Vec3::from(foot.r);
    let d = r.norm();
    if d == 0.0 {
        return;
    }
    let count = point.carriers().count() + foot.element().nodes;
    let shares = relative(point, foot);
    let relative = &shares[..count];
    let across = (carom_algebra::tensor::Mat3::identity() - r * r.transpose() / (d * d)) / d;
    let across = [0, 1, 2].map(|i| [0, 1, 2].map(|j| across[(i, j)]));
    for (a, s) in relative.iter().enumerate() {
        for (b, t) in relative.iter().enumerate() {
            block.add_nodes(a, b, factor * s * t, &across);
        }
    }
    let lines = [own_line(point, foot), line_of_face(point, foot)];
    let forms = lines.map(|line| line.map(|line| (line.tangent, line.form(relative, &r))));
    let add = |value: f64, one: &Form, other: &Form, block: &mut Block| {
        block.add(-0.5 * factor * value / d, one, other);
    };
    match &forms {
        [None, None] => {}
        [Some((t, q)), None] | [None, Some((t, q))] => add(1.0 / t.norm_squared(), q, q, block),
        [Some((t, q)), Some((s, p))] => {
            let (tt, ts, ss) = (t.norm_squared(), t.dot(s), s.norm_squared());
            let det = tt * ss - ts * ts;
            add(ss / det, q, q, block);
            add(-2.0 * ts / det, q, p, block);
            add(tt / det, p, p, block);
        }
    }
}

/// Adds factor · g″ to a block over the nodes of a point of a sharp edge and of the edge that it crosses. `gap` in m, `normal` a unit vector.
pub fn add_edge_curvature(
    (point, foot): (&Point, &Foothold),
    (gap, normal): (f64, Vec3),
    factor: f64,
    block: &mut Block,
) {
    let (Some(own), Some(other)) = (own_line(point, foot), line_of_face(point, foot)) else {
        return;
    };
    let relative = relative(point, foot);
    let (tt, ts) = (own.tangent.norm_squared(), own.tangent.dot(&other.tangent));
    let ss = other.tangent.norm_squared();
    let det = tt * ss - ts * ts;
    let inverse = [[ss / det, -ts / det], [-ts / det, tt / det]];
    let forms = [own, other].map(|line| {
        let turn = line.turn(&normal);
        let mut moved = [Vec3::zeros(); 2 * NODES];
        for (moved, (share, turn)) in moved.iter_mut().zip(relative.iter().zip(&turn)) {
            *moved = line.tangent * (2.0 * share) + turn * gap;
        }
        (moved, turn)
    });
    for ((moved, _), row) in forms.iter().zip(&inverse) {
        for ((_, turn), entry) in forms.iter().zip(row) {
            block.add(-0.5 * factor * entry, moved, turn);
        }
    }
}

/// Coefficients of the relative motion x - y of places that are held, over the nodes of the point and then of the face; zero of others.
fn relative(point: &Point, foot: &Foothold) -> [f64; 2 * NODES] {
    let mut relative = [0.0; 2 * NODES];
    let shares = point.carriers().map(|(_, s)| s);
    let opposite = foot.shape[..foot.element().nodes].iter().map(|n| -n);
    for (to, share) in relative.iter_mut().zip(shares.chain(opposite)) {
        *to = share;
    }
    relative
}

/// A line along which a place of the gap is free to move.
struct Line {
    /// τ̃ in m.
    tangent: Vec3,
    /// Its two nodes in the stencil.
    ends: [usize; 2],
    /// ∂τ̃/∂x of the second node; of the first one it is the opposite.
    share: f64,
}

impl Line {
    /// q over the nodes of the stencil.
    fn form(&self, relative: &[f64], r: &Vec3) -> Form {
        let mut form = [Vec3::zeros(); 2 * NODES];
        for (form, share) in form.iter_mut().zip(relative) {
            *form = self.tangent * *share;
        }
        form[self.ends[0]] -= r * self.share;
        form[self.ends[1]] += r * self.share;
        form
    }

    /// r·δτ̃ over the nodes of the stencil.
    fn turn(&self, r: &Vec3) -> Form {
        let mut form = [Vec3::zeros(); 2 * NODES];
        form[self.ends[0]] -= r * self.share;
        form[self.ends[1]] += r * self.share;
        form
    }
}

/// That of a point that crosses.
fn own_line(point: &Point, foot: &Foothold) -> Option<Line> {
    point.crosses().then(|| Line {
        tangent: Vec3::from(foot.along),
        ends: [0, 1],
        share: 0.5,
    })
}

/// That of the face, or of the edge of it on which the foot is, unless the foot is held at an end.
fn line_of_face(point: &Point, foot: &Foothold) -> Option<Line> {
    let [a, b] = match foot.dim() {
        1 if foot.xi[0].abs() < 1.0 => [0, 1],
        2 => edge(foot)?,
        _ => return None,
    };
    let first = point.carriers().count();
    Some(Line {
        tangent: (Vec3::from(foot.x[a]) - Vec3::from(foot.x[b])) * 0.5,
        ends: [first + a, first + b],
        share: -0.5,
    })
}

/// Distance in the reference cell below which a foot is on an edge.
const ON: f64 = 1e-12;

/// How far a foot on a plane cell is from each of its edges, in the reference cell; edge k joins the nodes k and k + 1.
fn from_edges(foot: &Foothold) -> [f64; 4] {
    let [r, s, _] = foot.xi;
    match foot.element().nodes {
        3 => [s, 1.0 - r - s, r, f64::INFINITY],
        _ => [1.0 + s, 1.0 - r, 1.0 - s, 1.0 + r],
    }
}

/// Whether the foot is inside of a plane cell.
pub fn is_inside(foot: &Foothold) -> bool {
    foot.dim() == 2 && from_edges(foot).iter().all(|way| *way > ON)
}

/// The nodes of the edge on which the foot is; none in a corner.
fn edge(foot: &Foothold) -> Option<[usize; 2]> {
    let ways = from_edges(foot);
    let mut on = (0..4).filter(|&k| ways[k] <= ON);
    match (on.next(), on.next()) {
        (Some(k), None) => Some([k, (k + 1) % foot.element().nodes]),
        _ => None,
    }
}
