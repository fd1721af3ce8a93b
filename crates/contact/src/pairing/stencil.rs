//! A point of the secondary surface and its closest point on what it faces: gap, rows and second derivative.

use carom_algebra::tensor::Vec3;
use carom_elements::MAX_FACE_NODES as NODES;
use carom_mesh::{Face, Projection};

use super::block::{Block, Form, UNKNOWNS};
use super::curvature::Shape;
use super::foothold::Foothold;
use super::round;
use crate::crossing::Opposite;
use crate::faced::Faced;
use crate::nearest::Moves;
use crate::{Obstacle, Places, Point, Rows};

/// A point, its gap, and what is at the other end of it.
#[derive(Clone, Debug)]
pub(crate) struct Stencil {
    point: Point,
    gap: f64,
    normal: [f64; 3],
    foot: Foot,
    /// First unknowns of its nodes, in the order of [`Stencil::relative`].
    first: [u32; 2 * NODES],
    /// Whether other nodes carry some of them.
    pub(super) carried: bool,
    /// The edge at the other end, of a point of an edge.
    pub(super) faced: Option<Faced>,
}

#[derive(Clone, Debug)]
// One pool of entries of one size; those on faces are the rule.
#[allow(clippy::large_enum_variant)]
enum Foot {
    /// On a face that moves.
    Face(Foothold),
    /// On an obstacle.
    Obstacle {
        /// Second derivative of the gap by the place of the point, 1/m.
        hessian: [[f64; 3]; 3],
        /// How the point moves over its line or face, where it does.
        moves: Option<Moves>,
        /// Velocity of the obstacle's particle there, m/s.
        velocity: [f64; 3],
        /// Its mean velocity over the span of the pairing, m/s.
        carried: [f64; 3],
    },
}

impl Stencil {
    /// The stencil of a point and what is opposite to it on a surface.
    pub fn opposite_to(places: &Places, found: &Opposite) -> Stencil {
        let x = found.point.place(places);
        Stencil {
            faced: found.faced,
            ..Stencil::on_face(places, &found.point, &x, &found.foot, found.face)
        }
    }

    /// The stencil of a point against an obstacle, `None` where it faces nothing. `span`: [`Pairing::span`](super::Pairing::span).
    pub fn on_obstacle(
        places: &Places,
        point: &Point,
        obstacle: &Obstacle,
        span: [f64; 2],
    ) -> Option<Stencil> {
        let (point, counts) = obstacle.faced_by(point, places);
        let (x, placed) = (point.place(places), obstacle.at(places.time));
        let found = placed.distance_of(&point, places);
        if !counts || found.gap == f64::INFINITY {
            return None;
        }
        let span = span.map(|after| places.time + after);
        let stencil = Stencil {
            point,
            gap: found.gap - point.radius,
            normal: found.normal,
            first: [0; 2 * NODES],
            carried: false,
            faced: None,
            foot: Foot::Obstacle {
                hessian: found.hessian,
                moves: Moves::of(&point, places),
                velocity: placed.velocity(&x),
                carried: obstacle.mean_velocity(&x, places.time, span),
            },
        };
        Some(stencil.numbered(places))
    }

    /// The stencil of a point at `x` whose closest point on a face is known.
    pub fn on_face(
        places: &Places,
        point: &Point,
        x: &[f64; 3],
        foot: &Projection,
        face: &Face,
    ) -> Stencil {
        let mut foothold = Foothold::new(face, places.of_face(face), along(places, point));
        foothold.place(foot, x);
        let stencil = Stencil {
            point: *point,
            gap: foot.gap - point.radius,
            normal: foot.normal,
            first: [0; 2 * NODES],
            carried: false,
            faced: None,
            foot: Foot::Face(foothold),
        };
        stencil.numbered(places)
    }

    /// Makes this the stencil of another point of the same nodes, which does not cross, at `x`, with its foot on the same face.
    pub fn shift(&mut self, point: &Point, x: &[f64; 3], foot: &Projection) {
        self.point = *point;
        (self.gap, self.normal) = (foot.gap - point.radius, foot.normal);
        if let Foot::Face(foothold) = &mut self.foot {
            foothold.place(foot, x);
        }
    }

    fn numbered(mut self, places: &Places) -> Stencil {
        let (mut first, mut carried) = (self.first, false);
        for (first, (node, _)) in first.iter_mut().zip(self.relative()) {
            *first = places.unknowns.first(node) as u32;
            carried |= places.unknowns.carrier(node).is_some();
        }
        (self.first, self.carried) = (first, carried);
        self
    }

    /// Makes a point of the rows, or the one after the last, that of the stencil.
    pub fn place(&self, places: &Places, at: usize, rows: &mut Rows, tangents: &mut [Rows; 2]) {
        let dim = places.dim();
        rows.begin(at, self.gap, self.normal);
        let turning = self.turning();
        let resultant = self.resultant(turning.as_ref()).into();
        rows.set_resultant(self.point.on_secondary(resultant));
        rows.set_rate(self.rate(&self.normal));
        let frame = tangent_vectors(&self.normal, dim);
        for (rows, t) in tangents.iter_mut().zip(&frame[..dim - 1]) {
            rows.begin(at, 0.0, *t);
            rows.set_resultant(self.point.on_secondary(*t));
            rows.set_rate(self.slide(t));
        }
        let tangents = &mut tangents[..dim - 1];
        for (i, (node, c)) in self.relative().enumerate() {
            let mut n = self.normal.map(|n| c * n);
            if let Some(turning) = &turning {
                n = (Vec3::from(n) + turning[i]).into();
            }
            let scaled = |t: &[f64; 3]| t.map(|t| c * t);
            if !self.carried {
                let first = self.first[i];
                rows.add_translations(first, &n[..dim]);
                for (rows, t) in tangents.iter_mut().zip(&frame) {
                    rows.add_translations(first, &scaled(t)[..dim]);
                }
            } else {
                rows.add_node(places, node, &n);
                for (rows, t) in tangents.iter_mut().zip(&frame) {
                    rows.add_node(places, node, &scaled(t));
                }
            }
            let reach = self.reach(i);
            if reach != 0.0 {
                let arm = Vec3::from(self.normal) * (c * reach);
                for (rows, t) in tangents.iter_mut().zip(&frame) {
                    rows.add_moment(places, node, &arm.cross(&Vec3::from(*t)).into());
                }
            }
        }
    }

    /// Way along the normal from a node of [`Stencil::relative`] to the surface around it, m.
    pub fn reach(&self, node: usize) -> f64 {
        match &self.foot {
            _ if node < self.point.carriers().count() => -self.point.radius,
            Foot::Face(foot) => foot.face.radius.unwrap_or(0.0),
            Foot::Obstacle { .. } => 0.0,
        }
    }

    /// Rate at which the obstacle's motion carries the point off along a direction, m/s.
    pub fn rate(&self, direction: &[f64; 3]) -> f64 {
        match &self.foot {
            Foot::Face(_) => 0.0,
            Foot::Obstacle { velocity, .. } => {
                -(0..3).map(|i| direction[i] * velocity[i]).sum::<f64>()
            }
        }
    }

    /// Rate at which it does so along a tangent in the mean over the span, m/s.
    pub fn slide(&self, tangent: &[f64; 3]) -> f64 {
        match &self.foot {
            Foot::Face(_) => 0.0,
            Foot::Obstacle { carried, .. } => -(0..3).map(|i| tangent[i] * carried[i]).sum::<f64>(),
        }
    }

    /// The gap in m and the unit normal.
    pub fn gap(&self) -> (f64, [f64; 3]) {
        (self.gap, self.normal)
    }

    /// Nodes and shape functions of the point.
    pub fn carriers(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.point.carriers()
    }

    /// Nodes and shape functions N_b of the face at the foot; none on an obstacle.
    pub fn opposite(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let (nodes, shape) = match &self.foot {
            Foot::Face(foot) => (foot.face.corners(), foot.shape.as_slice()),
            Foot::Obstacle { .. } => (&[][..], &[][..]),
        };
        nodes.iter().copied().zip(shape.iter().copied())
    }

    /// Relative motion x₁ - y at a foot that keeps its coordinates: nodes and their coefficients s_a and -N_b.
    pub fn relative(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let primary = self.opposite().map(|(node, n)| (node, -n));
        self.carriers().chain(primary)
    }

    /// What the row N has beside n times the relative motion, for each node of [`Stencil::relative`]: -ρ^α S_α, at a foot
    /// that is held at the rim.
    pub fn turning(&self) -> Option<Form> {
        match &self.foot {
            Foot::Face(foot) if !foot.inside && foot.dim() > 0 => Some(self.shape(foot).turn()),
            _ => None,
        }
    }

    /// Sum of the entries of the row N over the secondary nodes. `turning`: [`Stencil::turning`].
    pub fn resultant(&self, turning: Option<&Form>) -> Vec3 {
        let turning = turning.map(|turning| {
            let own = self.carriers().count();
            turning[..own].iter().sum::<Vec3>()
        });
        Vec3::from(self.normal) + turning.unwrap_or_else(Vec3::zeros)
    }

    /// The unknowns of the stencil's nodes and how many they are.
    pub fn unknowns(&self, dim: usize) -> ([u32; UNKNOWNS], usize) {
        let (mut unknowns, mut n) = ([0; UNKNOWNS], 0);
        for first in &self.first[..self.relative().count()] {
            for unknown in *first..*first + dim as u32 {
                unknowns[n] = unknown;
                n += 1;
            }
        }
        (unknowns, n)
    }

    /// Whether the nodes are the same, in the same order.
    pub fn is_like(&self, other: &Stencil) -> bool {
        let nodes = |stencil| Stencil::relative(stencil).map(|(node, _)| node);
        nodes(self).eq(nodes(other))
    }

    /// Adds factor · ∂²g/∂u² to a block over [`Stencil::unknowns`].
    pub fn add_curvature(&self, factor: f64, block: &mut Block) {
        match &self.foot {
            Foot::Face(foot) if self.point.edge().is_some() => {
                // of the lines, not of the surfaces around them
                let gap = self.gap + self.point.radius + foot.face.radius.unwrap_or(0.0);
                let signed = (gap, Vec3::from(self.normal));
                round::add_edge_curvature((&self.point, foot), signed, factor, block);
            }
            Foot::Face(foot) if foot.face.is_round() && !round::is_inside(foot) => {
                // of a point that is over the middle the distance counts negative
                let along = (0..3).map(|i| self.normal[i] * foot.r[i]).sum::<f64>();
                let factor = if along < 0.0 { -factor } else { factor };
                round::add_curvature(&self.point, foot, factor, block);
            }
            Foot::Face(foot) if foot.dim() == 0 => (),
            Foot::Face(foot) => self.shape(foot).curvature(factor, block),
            Foot::Obstacle { hessian, moves, .. } => {
                self.obstacle_curvature(factor, hessian, block);
                if let Some(moves) = moves {
                    moves.add_curvature(&self.point, (hessian, &self.normal), factor, block);
                }
            }
        }
    }

    fn shape<'a>(&'a self, foot: &'a Foothold) -> Shape<'a> {
        // from the foot to the place of the point, whatever radius is around that
        let height = self.gap + self.point.radius + foot.face.radius.unwrap_or(0.0);
        Shape::new(&self.point, height, &self.normal, foot)
    }

    fn obstacle_curvature(&self, factor: f64, hessian: &[[f64; 3]; 3], block: &mut Block) {
        for (a, (_, s)) in self.point.carriers().enumerate() {
            for (b, (_, t)) in self.point.carriers().enumerate() {
                block.add_nodes(a, b, factor * s * t, hessian);
            }
        }
    }
}

/// Derivative of the place of a point by the reference coordinate of its line, of one that crosses.
fn along(places: &Places, point: &Point) -> [f64; 3] {
    let mut along = [0.0; 3];
    for ((node, _), sign) in point.carriers().zip([-0.5, 0.5]) {
        if point.crosses() {
            let x = places.of(node);
            (0..3).for_each(|i| along[i] += sign * x[i]);
        }
    }
    along
}

/// Unit vectors square to the normal and to each other; `dim - 1` of them are used.
///
/// In the plane the normal turned by a quarter, (-n_y, n_x). In space the rotation that takes a fixed direction e to n
/// the shortest way, applied to two vectors square to e: smooth but for n = -e, where a step is unavoidable and e is
/// chosen so that it is far from the axes. The formula is that of the rotation between two unit vectors.
pub(super) fn tangent_vectors(n: &[f64; 3], dim: usize) -> [[f64; 3]; 2] {
    if dim < 3 {
        return [[-n[1], n[0], 0.0], [0.0; 3]];
    }
    // 2/7, 3/7, 6/7 are the components of a unit vector; the other two complete it to a rotation.
    let [first, second, e] =
        [[3.0, -6.0, 2.0], [6.0, 2.0, -3.0], [2.0, 3.0, 6.0]].map(|v| Vec3::from(v) / 7.0);
    let n = Vec3::from(*n);
    let (middle, height) = (n + e, 1.0 + n.dot(&e));
    let turn = |f: Vec3| match height > 1e-12 {
        true => f - middle * (n.dot(&f) / height),
        false => f,
    };
    [turn(first).into(), turn(second).into()]
}
