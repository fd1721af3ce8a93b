//! Sharp edges of solids that cross between their nodes.
//!
//! Nodes of one side see faces of the other. Two sharp edges that cross between two nodes of each touch where no node is: there is one more
//! point for each edge of the secondary surface, at the place x that is nearest to an edge of the target. With the nearest place y on that,
//! and e and f along both,
//!
//! `n = ± e × f/|e × f|`, `g = n · (x - y)`, `N = Σ φ_a n` at the ends of its own edge less `Σ N_b n` at those of the other,
//!
//! exact derivatives, since n is normal to both edges. The gap is positive when open. The normal is that of a contact of two convex
//! edges: n lies between the normals of the two faces of the edge of the target, and -n between those of the own edge. This gives its sign, and
//! lets out edges that pass behind the other body: an edge there has one of the two cones on the wrong side. Gaps below a *depth* are none,
//! since the far edge of a thin part may be seen so, nor are those beyond a *reach*.
//!
//! Axes of beams and sharp edges of shells may cross sharp edges of solids too. What is around them is round: they have no cone, the gap is less by their radius,
//! and n is that of the edge of the solid.
//!
//! Edges that run along each other, and those that cross at an end of one where no edge goes on, are left to the nodes. Where an edge goes on in another
//! one, the first of both has what crosses at the node between them. Of what two points tell of each other, where
//! a surface faces itself, the first one tells. A point faces one edge, the nearest; an edge that may cross two on the other side, as a long face
//! of a coarse mesh over a narrow bar does, has a second point for the other.

use std::collections::BTreeMap;

use carom_algebra::tensor::Vec3;
use carom_mesh::{Face, SharpEdge};

use crate::crossing::{ALONG, AT_END, between};
use crate::faced::Faced;
use crate::point::EdgeNodes;
use crate::sight::View;
use crate::{Places, Point};

/// Part of the length of a face by which its further node may be on the wrong side of the normal plane, for rounding.
const LEVEL: f64 = 1e-6;

/// Cosine of the angle of two edges at a node from which on they are one edge that goes on.
const STRAIGHT: f64 = -0.98;

/// Gap beyond which nothing is looked for, over the longest edge: in a step bodies must come closer by less than that.
const REACH: f64 = 4.0;

/// Sharp edges of a target that points of other edges may touch ([`Point::at_edge`]).
#[derive(Clone, Debug)]
pub struct Edges {
    /// The edges as lines, their nodes by system number.
    pub(super) lines: Vec<Face>,
    /// What else is known of each.
    pub(super) sides: Vec<Side>,
    /// Of the edge of each point, whether what crosses at its first and at its second end is its own; of other points neither.
    pub(super) own: Vec<[bool; 2]>,
    /// Of each point of an edge the first point of the edge, and the second one if there is one; of others themselves.
    pub(super) firsts: Vec<(u32, Option<u32>)>,
    /// Penetration beyond which nothing is a contact, m.
    pub(super) depth: f64,
    /// Gap beyond which nothing is looked for, m.
    pub(super) reach: f64,
    /// The most that the surface is away from an edge, m.
    widest: f64,
}

/// What is known of an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// Of each of its faces the further nodes next to both ends, by system number; none of a line around which the surface is round.
    pub(super) beside: Option<[[u32; 2]; 2]>,
    /// Its number among all edges of the target.
    number: u32,
    /// Its faces, by their numbers in the target.
    pub(super) faces: [u32; 2],
    /// The first point of the same edge, where the surface faces itself.
    pub(super) point: Option<u32>,
    /// Whether what crosses at its first and at its second end is its own.
    pub(super) own: [bool; 2],
}

/// An edge where it is, m.
pub(super) struct Line {
    pub(super) ends: [[f64; 3]; 2],
    /// Of each of its faces the ways from both ends into it; none of a line around which the surface is round.
    ways: Option<[[Vec3; 2]; 2]>,
    /// Distance of the surface, m.
    radius: f64,
    /// Whether what crosses at its ends is its own.
    own: [bool; 2],
}

/// Where two edges meet.
#[derive(Clone, Copy)]
pub(super) struct Meeting {
    /// Reference coordinates of the nearest places of both.
    pub(super) xi: [f64; 2],
    /// Place on the edge of the target, m.
    pub(super) place: [f64; 3],
    /// Unit normal out of the target.
    pub(super) normal: [f64; 3],
    /// Whether that is -e × f.
    pub(super) is_reversed: bool,
    /// Of the surfaces, m.
    pub(super) gap: f64,
    /// Distance of the nearest places of the lines, m: that of the gap and the radii but for rounding, and at an end for what the edges cross beside it.
    pub(super) distance: f64,
}

impl Edges {
    /// The edges of a target; none if there are none. `points`: of the contact, with those of edges; `x`: reference coordinates by system
    /// number, m; `depth`: penetration beyond which nothing is a contact, m.
    pub fn new(edges: &[SharpEdge], points: &[Point], x: &[[f64; 3]], depth: f64) -> Option<Edges> {
        let first_ends = |point: &Point| match point.edge() {
            Some(edge) if !point.is_second() => edge.ends,
            _ => [u32::MAX; 2],
        };
        let of_points: Vec<[u32; 2]> = points.iter().map(first_ends).collect();
        let lines: Vec<[u32; 2]> = edges
            .iter()
            .map(|edge| [edge.line.nodes[0], edge.line.nodes[1]])
            .collect();
        let own_ends = owned(&lines, x);
        let own = points.iter().zip(0..);
        let own = own.filter(|(point, _)| !point.is_second());
        let own = own.filter_map(|(point, k)| Some((ordered(point.edge()?.ends), k)));
        let own: BTreeMap<[u32; 2], u32> = own.collect();
        let mut firsts: Vec<(u32, Option<u32>)> =
            (0..points.len() as u32).map(|k| (k, None)).collect();
        for (k, point) in points
            .iter()
            .enumerate()
            .filter(|(_, point)| point.is_second())
        {
            let first = point.edge().and_then(|edge| own.get(&ordered(edge.ends)));
            if let Some(&first) = first {
                firsts[k] = (first, Some(k as u32));
                firsts[first as usize].1 = Some(k as u32);
            }
        }
        let mut own_of_points = owned(&of_points, x);
        for k in 0..points.len() {
            own_of_points[k] = own_of_points[firsts[k].0 as usize];
        }
        let length = |[a, b]: [u32; 2]| {
            let (a, b) = (x[a as usize], x[b as usize]);
            (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
        };
        let of_target = edges.iter().map(|edge| edge.length(x));
        let longest = own.keys().map(|ends| length(*ends)).chain(of_target);
        let side = |((edge, ends), number): ((&SharpEdge, &[bool; 2]), u32)| Side {
            number,
            beside: edge.beside,
            faces: edge.faces,
            point: own.get(&ends_of(&edge.line)).copied(),
            own: *ends,
        };
        (!edges.is_empty()).then(|| Edges {
            lines: edges.iter().map(|edge| edge.line).collect(),
            sides: edges.iter().zip(&own_ends).zip(0..).map(side).collect(),
            own: own_of_points,
            firsts,
            depth,
            reach: REACH * longest.fold(0.0, f64::max),
            widest: edges
                .iter()
                .filter_map(|edge| edge.line.radius)
                .fold(0.0, f64::max),
        })
    }

    /// An edge, and which of the two normals of both is the one.
    pub(super) fn faced(&self, item: u32, is_reversed: bool) -> Faced {
        Faced {
            edge: self.sides[item as usize].number,
            is_reversed,
        }
    }

    /// Which normal an edge has where it stays with the edge of a point, of which this is remembered.
    pub(super) fn remembered(&self, item: u32, faced: Option<Faced>) -> Option<bool> {
        let number = self.sides[item as usize].number;
        let is_reversed = faced.filter(|faced| faced.edge == number);
        is_reversed.map(|faced| faced.is_reversed)
    }

    /// The edges as lines.
    pub(crate) fn lines(&self) -> &[Face] {
        &self.lines
    }

    /// Penetration beyond which nothing is a contact, m.
    pub(crate) fn depth(&self) -> f64 {
        self.depth
    }

    /// Gap beyond which nothing is looked for, m.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// The most that the surface is away from an edge, m.
    pub(crate) fn widest(&self) -> f64 {
        self.widest
    }

    /// The same with nodes in other numbers.
    pub(crate) fn renumbered(&self, number: impl Fn(u32) -> u32) -> Edges {
        let lines = self.lines.iter();
        let sides = self.sides.iter().map(|side| Side {
            beside: side
                .beside
                .map(|beside| beside.map(|nodes| nodes.map(&number))),
            ..*side
        });
        Edges {
            lines: lines.map(|line| line.renumbered(&number)).collect(),
            sides: sides.collect(),
            own: self.own.clone(),
            firsts: self.firsts.clone(),
            ..*self
        }
    }

    /// Those that have both faces among some of the target, which are then numbered by their places; none if there are none. `kept`: the faces,
    /// ascending.
    pub(crate) fn with_some_faces(&self, kept: &[u32]) -> Option<Edges> {
        let place = |face: u32| kept.binary_search(&face).ok().map(|place| place as u32);
        let all = self.lines.iter().zip(&self.sides);
        let some = all.filter_map(|(line, side)| {
            let [one, other] = side.faces.map(place);
            let faces = [one?, other?];
            Some((*line, Side { faces, ..*side }))
        });
        let (lines, sides): (Vec<Face>, Vec<Side>) = some.unzip();
        (!lines.is_empty()).then_some(Edges {
            lines,
            sides,
            own: self.own.clone(),
            firsts: self.firsts.clone(),
            ..*self
        })
    }

    /// Whether an edge shares a node with that of a point, or is beside it on the surface, or of a part that it does not touch.
    pub(super) fn is_beside(&self, item: u32, (ends, view): (&[u32; 2], Option<View>)) -> bool {
        let (line, side) = (&self.lines[item as usize], &self.sides[item as usize]);
        let shares = line.corners().iter().any(|node| ends.contains(node));
        shares || view.is_some_and(|view| side.faces.iter().any(|&face| view.is_beside(face)))
    }

    pub(super) fn line(&self, places: &Places, item: u32) -> Line {
        let line = &self.lines[item as usize];
        let [a, b, ..] = line.nodes;
        let side = &self.sides[item as usize];
        let nodes = EdgeNodes {
            ends: [a, b],
            beside: side.beside,
        };
        let radius = line.radius.unwrap_or(0.0);
        Line::new(places, (nodes, radius), side.own)
    }

    /// The line of a point that faces the edges.
    pub(super) fn line_of(
        &self,
        places: &Places,
        (point, number): (&Point, usize),
    ) -> Option<Line> {
        let nodes = point.edge()?;
        Some(Line::new(places, (nodes, point.radius), self.own[number]))
    }
}

impl Line {
    fn new(places: &Places, (nodes, radius): (EdgeNodes, f64), own: [bool; 2]) -> Line {
        let of = |nodes: [u32; 2]| nodes.map(|node| places.of(node));
        let ends = of(nodes.ends);
        let ways = |beside: [u32; 2]| {
            let beside = of(beside);
            [0, 1].map(|end| Vec3::from(beside[end]) - Vec3::from(ends[end]))
        };
        Line {
            own,
            ends,
            ways: nodes.beside.map(|beside| beside.map(ways)),
            radius,
        }
    }

    /// Middle and half the length, m.
    pub(super) fn middle(&self) -> ([f64; 3], f64) {
        let [a, b] = &self.ends;
        let half = [0, 1, 2].map(|i| 0.5 * (b[i] - a[i]));
        let length = half.iter().map(|h| h * h).sum::<f64>().sqrt();
        ([0, 1, 2].map(|i| a[i] + half[i]), length)
    }

    fn along(&self) -> Vec3 {
        Vec3::from(self.ends[1]) - Vec3::from(self.ends[0])
    }

    /// Whether a place of it, by its reference coordinate, is its own, where `way` (m) leads from it to the other edge: inside, or at an end that is its own
    /// and where the way is across it. Beyond its ends the way leads along it.
    fn holds(&self, xi: f64, way: &Vec3) -> bool {
        let along = self.along();
        let across = way.dot(&along).abs() <= 0.5 * AT_END * along.norm_squared();
        xi.abs() < 1.0 - AT_END || across && self.own[usize::from(xi > 0.0)]
    }

    /// Whether both faces leave the place at ξ of the edge behind the plane that is normal to n, to rounding: n is in the cone of the normals there. A face of
    /// four nodes is bilinear: its way from there is between those from the ends. Any n is in the cone of a round line.
    fn faces(&self, n: &Vec3, xi: f64) -> bool {
        let way_at = |[first, second]: &[Vec3; 2]| (first * (1.0 - xi) + second * (1.0 + xi)) * 0.5;
        self.ways.iter().flatten().all(|ways| {
            let way = way_at(ways);
            n.dot(&way) <= LEVEL * way.norm()
        })
    }
}

/// Where an edge meets one of a target, if it does. `stays`: where they were closed, whether with the reversed normal.
pub(super) fn meeting(
    (own, other): (&Line, &Line),
    depth: f64,
    stays: Option<bool>,
) -> Option<Meeting> {
    let nearest = between(&own.ends, &other.ends);
    let on = |line: &Line, xi: f64| Vec3::from(line.ends[0]) + line.along() * (0.5 * (1.0 + xi));
    let (x, y) = (on(own, nearest.xi[0]), on(other, nearest.xi[1]));
    let way = x - y;
    let within = own.holds(nearest.xi[0], &way) && other.holds(nearest.xi[1], &way);
    if !within || nearest.angle <= ALONG {
        return None;
    }
    let across = own.along().cross(&other.along()).normalize();
    let [xi, of_other] = nearest.xi;
    let fits = [across, -across].map(|n| other.faces(&n, of_other) && own.faces(&-n, xi));
    let is_reversed = match (stays, fits) {
        (Some(is_reversed), _) => is_reversed,
        (None, [true, false]) => false,
        (None, [false, true]) => true,
        (None, _) => return None,
    };
    let n = if is_reversed { -across } else { across };
    let gap = n.dot(&way) - own.radius - other.radius;
    (gap >= -depth).then(|| Meeting {
        xi: nearest.xi,
        place: y.into(),
        normal: n.into(),
        is_reversed,
        gap,
        distance: nearest.distance,
    })
}

/// Of each edge whether what crosses at its ends is its own: at a node where another edge goes on straight, that of the first of both. `x`: as in
/// [`Edges::new`].
fn owned(edges: &[[u32; 2]], x: &[[f64; 3]]) -> Vec<[bool; 2]> {
    let mut at: BTreeMap<u32, Vec<(usize, usize)>> = BTreeMap::new();
    for (k, ends) in edges.iter().enumerate() {
        for (end, &node) in ends
            .iter()
            .enumerate()
            .filter(|(_, node)| **node != u32::MAX)
        {
            at.entry(node).or_default().push((k, end));
        }
    }
    let mut owned = vec![[false; 2]; edges.len()];
    for all in at.values() {
        let away = |&(k, end): &(usize, usize)| {
            let [from, to] =
                [edges[k][end], edges[k][1 - end]].map(|node| Vec3::from(x[node as usize]));
            (to - from).normalize()
        };
        for (place, one) in all.iter().enumerate() {
            let goes_on = |other: &(usize, usize)| away(one).dot(&away(other)) < STRAIGHT;
            let first = !all[..place].iter().any(goes_on);
            owned[one.0][one.1] = first && all[place + 1..].iter().any(goes_on);
        }
    }
    owned
}

/// The ends of a line, ascending.
pub(super) fn ends_of(line: &Face) -> [u32; 2] {
    ordered([line.nodes[0], line.nodes[1]])
}

pub(super) fn ordered([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
