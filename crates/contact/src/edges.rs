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
//! Edges that run along each other, and those that cross at an end of one, are left to the nodes. Of what two points tell of each other, where
//! a surface faces itself, the first one tells. A point faces one edge, the nearest: one that crosses two on the other side, as a long face
//! of a coarse mesh over a narrow bar does, faces the other once it is the nearest.

use std::collections::BTreeMap;

use carom_algebra::tensor::Vec3;
use carom_mesh::{Face, Projection, SharpEdge};

use crate::crossing::{ALONG, AT_END, Opposite, between};
use crate::search::faces::FaceTree;
use crate::sight::View;
use crate::{Contact, Places, Point};

/// Part of the length of a face by which its further node may be on the wrong side of the normal plane, for rounding.
const LEVEL: f64 = 1e-6;

/// Gap beyond which nothing is looked for, over the longest edge: in a step bodies must come closer by less than that.
const REACH: f64 = 4.0;

/// Sharp edges of a target that points of other edges may touch ([`Point::at_edge`]).
#[derive(Clone, Debug)]
pub struct Edges {
    /// The edges as lines, their nodes by system number.
    lines: Vec<Face>,
    /// What else is known of each.
    sides: Vec<Side>,
    /// Penetration beyond which nothing is a contact, m.
    depth: f64,
    /// Gap beyond which nothing is looked for, m.
    reach: f64,
}

/// What is known of an edge.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// A further node of each of its faces, by system number.
    beside: [u32; 2],
    /// Its faces, by their numbers in the target.
    faces: [u32; 2],
    /// The point of the same edge, where the surface faces itself.
    point: Option<u32>,
}

/// An edge where it is, m.
struct Line {
    ends: [[f64; 3]; 2],
    /// The further nodes of its faces.
    beside: [[f64; 3]; 2],
}

/// Where two edges meet.
#[derive(Clone, Copy)]
struct Meeting {
    /// Reference coordinates of the nearest places of both.
    xi: [f64; 2],
    /// Place on the edge of the target, m.
    place: [f64; 3],
    /// Unit normal out of the target.
    normal: [f64; 3],
    /// m.
    gap: f64,
}

impl Edges {
    /// The edges of a target; none if there are none. `points`: of the contact, with those of edges; `x`: reference coordinates by system
    /// number, m; `depth`: penetration beyond which nothing is a contact, m.
    pub fn new(edges: &[SharpEdge], points: &[Point], x: &[[f64; 3]], depth: f64) -> Option<Edges> {
        let own = points.iter().zip(0..);
        let own = own.filter_map(|(point, k)| Some((ordered(point.edge()?[0]), k)));
        let own: BTreeMap<[u32; 2], u32> = own.collect();
        let length = |[a, b]: [u32; 2]| {
            let (a, b) = (x[a as usize], x[b as usize]);
            (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
        };
        let of_target = edges.iter().map(|edge| edge.length(x));
        let longest = own.keys().map(|ends| length(*ends)).chain(of_target);
        let side = |edge: &SharpEdge| Side {
            beside: edge.beside,
            faces: edge.faces,
            point: own.get(&ends_of(&edge.line)).copied(),
        };
        (!edges.is_empty()).then(|| Edges {
            lines: edges.iter().map(|edge| edge.line).collect(),
            sides: edges.iter().map(side).collect(),
            depth,
            reach: REACH * longest.fold(0.0, f64::max),
        })
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

    /// The same with nodes in other numbers.
    pub(crate) fn renumbered(&self, number: impl Fn(u32) -> u32) -> Edges {
        let lines = self.lines.iter();
        let sides = self.sides.iter().map(|side| Side {
            beside: side.beside.map(&number),
            ..*side
        });
        Edges {
            lines: lines.map(|line| line.renumbered(&number)).collect(),
            sides: sides.collect(),
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
            ..*self
        })
    }

    /// Whether an edge shares a node with that of a point, or is beside it on the surface, or of a part that it does not touch.
    fn is_beside(&self, item: u32, (ends, view): (&[u32; 2], Option<View>)) -> bool {
        let (line, side) = (&self.lines[item as usize], &self.sides[item as usize]);
        let shares = line.corners().iter().any(|node| ends.contains(node));
        shares || view.is_some_and(|view| side.faces.iter().any(|&face| view.is_beside(face)))
    }

    fn line(&self, places: &Places, item: u32) -> Line {
        let [a, b, ..] = self.lines[item as usize].nodes;
        Line::new(places, [[a, b], self.sides[item as usize].beside])
    }
}

impl Line {
    fn new(places: &Places, [ends, beside]: [[u32; 2]; 2]) -> Line {
        Line {
            ends: ends.map(|node| places.of(node)),
            beside: beside.map(|node| places.of(node)),
        }
    }

    /// Middle and half the length, m.
    fn middle(&self) -> ([f64; 3], f64) {
        let [a, b] = &self.ends;
        let half = [0, 1, 2].map(|i| 0.5 * (b[i] - a[i]));
        let length = half.iter().map(|h| h * h).sum::<f64>().sqrt();
        ([0, 1, 2].map(|i| a[i] + half[i]), length)
    }

    fn along(&self) -> Vec3 {
        Vec3::from(self.ends[1]) - Vec3::from(self.ends[0])
    }

    /// Whether both faces are behind the plane through the edge that is normal to n, to rounding: n is in the cone of the normals of the edge.
    fn faces(&self, n: &Vec3) -> bool {
        self.beside.iter().all(|place| {
            let way = Vec3::from(*place) - Vec3::from(self.ends[0]);
            n.dot(&way) <= LEVEL * way.norm()
        })
    }
}

/// Where an edge meets one of a target, if it does.
fn meeting(own: &Line, other: &Line, depth: f64) -> Option<Meeting> {
    let nearest = between(&own.ends, &other.ends);
    let within = nearest.xi.iter().all(|xi| xi.abs() < 1.0 - AT_END);
    if !within || nearest.angle <= ALONG {
        return None;
    }
    let across = own.along().cross(&other.along()).normalize();
    let fits = [across, -across].map(|n| other.faces(&n) && own.faces(&-n));
    let n = match fits {
        [true, false] => across,
        [false, true] => -across,
        _ => return None,
    };
    let on = |line: &Line, xi: f64| Vec3::from(line.ends[0]) + line.along() * (0.5 * (1.0 + xi));
    let y = on(other, nearest.xi[1]);
    let gap = n.dot(&(on(own, nearest.xi[0]) - y));
    (gap >= -depth).then(|| Meeting {
        xi: nearest.xi,
        place: y.into(),
        normal: n.into(),
        gap,
    })
}

impl Contact {
    /// The edge of the target that the edge of a point touches, within a distance (m): the first of the nearest that meet it. `tree`: of the
    /// edges in this configuration.
    pub(crate) fn opposite_edge(
        &self,
        (places, tree): (&Places, &FaceTree),
        point: usize,
        within: f64,
    ) -> Option<Opposite<'_>> {
        let edges = self.edges.as_ref()?;
        let (item, found) = self.nearest_edge((places, tree), point, within)?;
        if self.is_told((places, tree), (point, item), within) {
            return None;
        }
        let foot = Projection {
            xi: [found.xi[1], 0.0, 0.0],
            point: found.place,
            normal: found.normal,
            gap: found.gap,
            distance: found.gap.abs(),
            inside: true,
        };
        Some(Opposite {
            point: self.points[point].moved_to(found.xi[0]),
            foot,
            face: &edges.lines[item as usize],
        })
    }

    /// Distance of the edge of a point from the nearest edge of the target that it may ever touch, m, if that is `within` (m).
    pub(crate) fn distance_of_edges(
        &self,
        (places, tree): (&Places, &FaceTree),
        point: usize,
        within: f64,
    ) -> Option<f64> {
        let (edges, own) = (self.edges.as_ref()?, self.points[point].edge()?);
        let (line, view) = (Line::new(places, own), self.view(point));
        let (middle, half) = line.middle();
        let measure = |item: u32| match edges.is_beside(item, (&own[0], view)) {
            true => f64::INFINITY,
            false => between(&line.ends, &edges.line(places, item).ends).distance,
        };
        let found = tree.nearest_within((&middle, half), within, measure);
        found.map(|(_, distance)| distance)
    }

    /// Faces of the edges of the target that the edge of a point may touch within the `limit` (m) while nodes move by less than `motion` (m),
    /// ascending, each with how far they may move before, m. They are all that decides which of two points tells.
    pub(crate) fn edges_in_reach(
        &self,
        target: (&Places, &FaceTree),
        point: usize,
        [limit, motion]: [f64; 2],
    ) -> Vec<(u32, f64)> {
        let Some(edges) = &self.edges else {
            return Vec::new();
        };
        let mut found = Vec::new();
        for (item, rest) in self.lines_in_reach(target, point, [limit, motion]) {
            found.push((item, rest));
            // whether the point of that edge tells depends on what it faces
            if let Some(other) = edges.sides[item as usize].point {
                let further = self.lines_in_reach(target, other as usize, [limit, motion]);
                found.extend(further.into_iter().map(|(item, own)| (item, own.max(rest))));
            }
        }
        let of_edge = |(item, rest): (u32, f64)| {
            let faces = edges.sides[item as usize].faces;
            faces.map(|face| (face, rest))
        };
        let mut faces: Vec<(u32, f64)> = found.into_iter().flat_map(of_edge).collect();
        faces.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        faces.dedup_by_key(|(face, _)| *face);
        faces
    }

    /// Edges of the target that the edge of a point may touch within the `limit` (m) while nodes move by less than `motion` (m), each with how
    /// far they may move before, m.
    fn lines_in_reach(
        &self,
        (places, tree): (&Places, &FaceTree),
        point: usize,
        [limit, motion]: [f64; 2],
    ) -> Vec<(u32, f64)> {
        let (Some(edges), Some(own)) = (&self.edges, self.points[point].edge()) else {
            return Vec::new();
        };
        let (line, view) = (Line::new(places, own), self.view(point));
        let (middle, half) = line.middle();
        let near = tree.near(&middle, half + limit + 2.0 * motion).into_iter();
        let others = near.filter(|&item| !edges.is_beside(item, (&own[0], view)));
        let with_rest = others.map(|item| {
            let apart = between(&line.ends, &edges.line(places, item).ends).distance;
            (item, (0.5 * (apart - limit)).max(0.0))
        });
        with_rest.filter(|(_, rest)| *rest < motion).collect()
    }

    /// The first of the edges of the target that meet the edge of a point and are nearest to it, and where.
    fn nearest_edge(
        &self,
        (places, tree): (&Places, &FaceTree),
        point: usize,
        within: f64,
    ) -> Option<(u32, Meeting)> {
        let (edges, own) = (self.edges.as_ref()?, self.points[point].edge()?);
        let (line, view) = (Line::new(places, own), self.view(point));
        let (middle, half) = line.middle();
        let at = |item: u32| match edges.is_beside(item, (&own[0], view)) {
            true => None,
            false => meeting(&line, &edges.line(places, item), edges.depth),
        };
        let measure = |item: u32| at(item).map_or(f64::INFINITY, |found| found.gap.abs());
        // no place of the edge is farther from its middle than its half
        let within = within.min(edges.reach);
        let (item, _) = tree.nearest_within((&middle, half), within, measure)?;
        Some((item, at(item)?))
    }

    /// Whether the point of the edge that a point faces faces its edge too, and comes first: both would tell the same.
    fn is_told(
        &self,
        target: (&Places, &FaceTree),
        (point, item): (usize, u32),
        within: f64,
    ) -> bool {
        let Some(edges) = &self.edges else {
            return false;
        };
        let Some(other) = edges.sides[item as usize].point.map(|other| other as usize) else {
            return false;
        };
        let is_own = |item: u32| {
            let own = self.points[point].edge();
            own.is_some_and(|[ends, _]| ordered(ends) == ends_of(&edges.lines[item as usize]))
        };
        other < point
            && self
                .nearest_edge(target, other, within)
                .is_some_and(|(item, _)| is_own(item))
    }
}

/// The ends of a line, ascending.
fn ends_of(line: &Face) -> [u32; 2] {
    ordered([line.nodes[0], line.nodes[1]])
}

fn ordered([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
