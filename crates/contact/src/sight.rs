//! Which faces a point of the secondary surface may touch: those in front of it, not the far side of its own body.
//!
//! Needed where a surface faces itself, and where parts are so thin that the closest face can be the far one. A face is
//! in the view of a point if
//!
//! - it is not beside it: it shares no node with a face that has a node of the point;
//! - it is turned against it: its normal makes more than 120° with that of one of the secondary faces around the point,
//!   in the current configuration, or the point is a sharp corner and no node around it is nearer to the plane of the face along its normal. The
//!   normals of two surfaces that touch are opposite; a corner touches with any of its
//!   faces, or with its tip alone. Where a surface is smooth the faces further along it are turned the same way, so they are not in view;
//! - the point is not deeper behind it than the *depth*: on a surface that faces itself at most half the thickness of the
//!   body there, so that the far side, at the whole thickness, is out of view until the body is pressed together to half
//!   of it.
//!
//! A surface around axes of beams or middles of shells has no far side: of itself all faces are in view but those that are near along
//! the surface, which any point would touch. On which side of the middle of a shell a point of another body belongs, that body tells ([`middles`]).

use carom_algebra::unknowns::Unknowns;
use carom_elements::{MAX_FACE_NODES, map};
use carom_mesh::{Bounds, BoxTree, Face, Projection};
use rayon::prelude::*;

use self::across::Across;
use self::lists::{Incidence, Lists};
pub use self::parts::{Part, Parts};
pub(crate) use self::sides::Sides;
pub(crate) use self::turned::Corners;
use crate::search::Stand;
use crate::{Frames, Places, Point};

mod across;
mod along;
mod lists;
mod middles;
mod over;
mod parts;
mod sides;
mod turned;

/// Faces whose corners one thread takes at a time, at least.
const CHUNK: usize = 512;

/// Cosine of the angle between the normals of a point and of a face up to which the face is in view.
const OPPOSED: f64 = -0.5;

/// Cosine of the angle between the normals of two faces around a point in the reference configuration from which on it is a sharp corner.
const SHARP: f64 = 0.5;

/// Part of the length of an edge by which its end may be nearer to a plane than the corner, 1°: of a sharp edge along a plane one node is
/// always pressed up a little more than the next.
const LEVEL: f64 = 0.02;

/// Cosine of the angle between the normal of a face and those around a corner, more than which all make as long as the corner does not point at the face.
const POINTED: f64 = 0.05;

/// Distance along a surface around axes or middles up to which a face is near, over the thickness: three, since gaps of points further on
/// are open until the surface is bent to a radius of its thickness.
const NEAR: f64 = 3.0;

/// How far sideways the other side of a wall may be, over its depth behind the plane of a face: 63°.
const BEND: f64 = 2.0;

/// Views of the points of a contact.
#[derive(Clone, Debug)]
pub struct Sight {
    /// Faces of the secondary surface, their nodes by system number.
    faces: Vec<Face>,
    /// Secondary faces around each point.
    around: Lists,
    /// Faces of the target beside each point, ascending.
    beside: Lists,
    /// Faces of the target across the edges of each.
    across: Across,
    /// The node of each point at a sharp corner, by system number; of others none.
    sharp: Vec<Option<u32>>,
    /// Largest penetration of each point, m.
    depth: Vec<f64>,
    /// Gap beyond which nothing is looked for, m.
    reach: f64,
    /// Whether points are on both sides.
    both: bool,
    /// Which points tell a contact that two would tell; none where no surface faces itself, or points are no nodes.
    sides: Option<Sides>,
    /// Whether the surface lies around axes or middles, without a far side.
    round: bool,
    /// Whether two surfaces face each other of which one lies around middles, or both do.
    has_middles: bool,
    /// Parts that do not touch each other, if there are any.
    parts: Option<Parts>,
}

/// What one point sees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View<'a> {
    sight: &'a Sight,
    point: usize,
}

impl Sight {
    /// Whether two surfaces share nodes: one faces itself.
    pub fn is_needed(secondary: &[Face], target: &[Face]) -> bool {
        let nodes = Incidence::new(target);
        let mut own = secondary.iter().flat_map(Face::corners);
        own.any(|&node| nodes.of(node).next().is_some())
    }

    /// The views of the points of a secondary surface on a target.
    ///
    /// `x`: reference coordinates by system number, m. `depth`: largest penetration that is a contact, m; by default half
    /// the smallest diagonal of the faces around a point. On a surface that faces itself it is half the thickness of the body
    /// at the point if that is less, the thickness being the way back to the closest face turned against it in the reference
    /// configuration, which has to be free of penetration; gaps beyond four times the largest diagonal are then not looked
    /// for: in a step parts must come closer by less than that.
    pub fn new(
        of: (&[Point], &[Face]),
        target: &[Face],
        x: &[[f64; 3]],
        depth: Option<f64>,
    ) -> Sight {
        let mut sight = Sight::up_to(of, target, x, depth);
        if sight.both && !sight.round {
            sight.limit_to_thickness(of.0, target, x);
            sight.take_sides(of.0, x);
        }
        sight
    }

    /// The views of the points of two surfaces on each other, whose faces are the target together, those of the first before those of the second.
    /// `lines` of the second surface are behind the faces in the target. `x` and `depth` as in [`Sight::new`], the default of the depth too; `parts`:
    /// of both ([`Parts::both_ways`]).
    pub fn both_ways(
        points: &[Point],
        (faces, lines): (&[Face], &[Face]),
        x: &[[f64; 3]],
        (depth, parts): (Option<f64>, &Parts),
    ) -> Sight {
        let target = [faces, lines].concat();
        let sight = Sight::up_to((points, faces), &target, x, depth);
        let mut sight = Sight {
            reach: f64::INFINITY,
            both: true,
            round: faces.iter().all(Face::is_round),
            has_middles: faces.iter().any(Face::is_round),
            ..sight.with_parts(parts)
        };
        if sight.has_middles && !sight.round {
            sight.take_corners(points, x);
        }
        sight.take_sides(points, x);
        sight
    }

    /// The views up to a depth, whatever the thickness is.
    fn up_to(
        (points, secondary): (&[Point], &[Face]),
        target: &[Face],
        x: &[[f64; 3]],
        depth: Option<f64>,
    ) -> Sight {
        let (own, other) = (Incidence::new(secondary), Incidence::new(target));
        let (mut around, mut beside) = (Lists::default(), Lists::default());
        for point in points {
            let carriers: Vec<u32> = point.carriers().map(|(node, _)| node).collect();
            let has_all = |k: &u32| {
                let nodes = secondary[*k as usize].corners();
                carriers.iter().all(|node| nodes.contains(node))
            };
            around.push(own.of(carriers[0]).filter(has_all));
            let first = carriers.iter().flat_map(|&node| other.of(node));
            let nodes = first.flat_map(|k| target[k as usize].corners());
            let mut second: Vec<u32> = nodes.flat_map(|&node| other.of(node)).collect();
            second.sort_unstable();
            second.dedup();
            beside.push(second);
        }
        let round = target.iter().any(Face::is_round);
        if round {
            let widest = secondary.iter().chain(target);
            let widest = widest.filter_map(|face| face.radius).fold(0.0, f64::max);
            beside = along::near(points, target, x, NEAR * 2.0 * widest);
        }
        let itself = !beside.numbers.is_empty();
        let diagonal = |face: &Face| bounds(face, x).diagonal();
        // a point without faces sees nothing
        let size = |k: usize| {
            let sizes = around.of(k).iter();
            let sizes = sizes.map(|&k| diagonal(&secondary[k as usize]));
            sizes.reduce(f64::min).unwrap_or(0.0)
        };
        let largest = secondary.iter().chain(target).map(diagonal);
        let largest = largest.fold(0.0, f64::max);
        let mut sight = Sight {
            depth: (0..points.len())
                .map(|k| match points[k].edge() {
                    // a point of an edge sees no faces
                    Some(_) => 0.0,
                    None => depth.unwrap_or_else(|| 0.5 * size(k)),
                })
                .collect(),
            faces: secondary.to_vec(),
            around,
            beside,
            across: Across::new(target),
            sharp: Vec::new(),
            reach: if itself { 4.0 * largest } else { f64::INFINITY },
            both: itself,
            sides: None,
            round,
            has_middles: false,
            parts: None,
        };
        if !round {
            sight.take_corners(points, x);
        }
        sight
    }

    /// The views without faces of parts that do not touch. `parts`: of the faces that the views were made with.
    pub fn with_parts(self, parts: &Parts) -> Sight {
        let parts = parts.keep_any_apart().then(|| parts.clone());
        Sight { parts, ..self }
    }

    /// The views with nodes in other numbers.
    pub(crate) fn renumbered(&self, number: impl Fn(u32) -> u32) -> Sight {
        let faces = self.faces.iter();
        Sight {
            faces: faces.map(|face| face.renumbered(&number)).collect(),
            sides: self.sides.as_ref().map(|sides| sides.renumbered(&number)),
            sharp: self.sharp.iter().map(|own| own.map(&number)).collect(),
            ..self.clone()
        }
    }

    /// The views of some faces of the target alone, by their numbers, ascending.
    pub(crate) fn with_some_faces(&self, kept: &[u32]) -> Sight {
        let parts = self.parts.as_ref().map(|parts| Parts {
            // lines that were added to the target are the last, and of no part
            primary: kept
                .iter()
                .map_while(|&face| parts.primary.get(face as usize).copied())
                .collect(),
            ..parts.clone()
        });
        let mut beside = Lists::default();
        for point in 0..self.depth.len() {
            let own = self.beside.of(point).iter();
            let places = own.filter_map(|face| kept.binary_search(face).ok());
            beside.push(places.map(|place| place as u32));
        }
        Sight {
            beside,
            across: self.across.of_some(kept),
            parts,
            ..self.clone()
        }
    }

    /// Secondary faces around a point.
    pub(crate) fn faces_around(&self, point: usize) -> impl Iterator<Item = &Face> {
        let around = self.around.of(point).iter();
        around.map(|&face| &self.faces[face as usize])
    }

    /// Whether points are on both sides, of a surface that faces itself or of two that face each other: two of them may then say the same.
    pub fn has_both_sides(&self) -> bool {
        self.both
    }

    /// Parts that do not touch each other, if there are any.
    pub(crate) fn parts(&self) -> Option<&Parts> {
        self.parts.as_ref()
    }

    /// Which points tell a contact that two would tell.
    pub(crate) fn sides(&self) -> Option<&Sides> {
        self.sides.as_ref()
    }

    /// Largest penetration that is a contact at some point, m.
    pub(crate) fn deepest(&self) -> f64 {
        self.depth.iter().fold(0.0, |most, depth| most.max(*depth))
    }

    /// The least penetration that is a contact at any point that sees anything, m.
    pub(crate) fn least_depth(&self) -> f64 {
        let depths = self.depth.iter().copied().filter(|depth| *depth > 0.0);
        depths.fold(f64::INFINITY, f64::min)
    }

    /// The corners of some faces where they are, in the order of their numbers; of curved faces none.
    pub(crate) fn corners(
        places: &Places,
        (faces, items): (&[Face], &[u32]),
        corners: &mut [Option<Corners>],
    ) {
        let pairs = corners.par_iter_mut().zip(items);
        pairs.with_min_len(CHUNK).for_each(|(corners, &item)| {
            *corners = Corners::of(&faces[item as usize], places);
        });
    }

    /// The normals of the secondary faces, at their centres.
    pub(crate) fn normals(&self, places: &Places) -> impl Iterator<Item = [f64; 3]> {
        let places = *places;
        self.faces.iter().map(move |face| normal(face, &places))
    }

    /// The view of a point.
    pub(crate) fn of(&self, point: usize) -> View<'_> {
        View { sight: self, point }
    }

    /// Finds the sharp corners.
    fn take_corners(&mut self, points: &[Point], x: &[[f64; 3]]) {
        let normals = self.normals_at_rest(x);
        let corner = |(k, point): (usize, &Point)| {
            let around = self.around.of(k);
            let apart = |&one: &u32| {
                around.iter().any(|&other| {
                    let [a, b] = [one, other].map(|face| &normals[face as usize]);
                    (0..3).map(|i| a[i] * b[i]).sum::<f64>() < SHARP
                })
            };
            point.as_node().filter(|_| around.iter().any(apart))
        };
        self.sharp = points.iter().enumerate().map(corner).collect();
    }

    /// The normals of the secondary faces in the reference configuration.
    fn normals_at_rest(&self, x: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let rest = vec![0.0; 3 * x.len()];
        let places = Places {
            unknowns: &Unknowns::translations(3, x.len()),
            time: 0.0,
            x,
            u: &rest,
            frames: Frames::default(),
        };
        self.normals(&places).collect()
    }

    /// Decides which points tell a contact that two would tell.
    fn take_sides(&mut self, points: &[Point], x: &[[f64; 3]]) {
        // points of edges follow the nodes, and no other point yields to them
        let nodes = points.iter().filter(|point| !point.crosses());
        let nodes = nodes.map(Point::as_node);
        let Some(nodes) = nodes.collect::<Option<Vec<u32>>>() else {
            return;
        };
        let normals = self.normals_at_rest(x);
        let diagonals: Vec<f64> = self
            .faces
            .iter()
            .map(|face| bounds(face, x).diagonal())
            .collect();
        let surface = (&self.faces[..], &normals[..], &diagonals[..]);
        let parts = self.parts.as_ref();
        let is_secondary =
            |face: usize| parts.is_none_or(|parts| parts.secondary[face].is_first != Some(false));
        self.sides = Some(Sides::new(&nodes, &self.around, surface, is_secondary));
    }

    /// Takes half the way back to the closest face turned against a point as depth where that is less.
    fn limit_to_thickness(&mut self, points: &[Point], target: &[Face], x: &[[f64; 3]]) {
        let rest = vec![0.0; 3 * x.len()];
        let places = Places {
            unknowns: &Unknowns::translations(3, x.len()),
            time: 0.0,
            x,
            u: &rest,
            frames: Frames::default(),
        };
        let normals: Vec<[f64; 3]> = self.normals(&places).collect();
        let boxes: Vec<Bounds> = target.iter().map(|face| bounds(face, x)).collect();
        let tree = BoxTree::new(&boxes);
        let mut depth = self.depth.clone();
        for (k, (point, depth)) in points.iter().zip(&mut depth).enumerate() {
            let place = point.place(&places);
            let view = self.of(k);
            let behind = |item: u32| {
                let face = &target[item as usize];
                let x = places.of_face(face);
                let foot = carom_mesh::project(face, &x[..face.corners().len()], &place);
                // where a wall bends sharply the closest point is an edge, which none of its faces may face
                let sideways = foot.distance.powi(2) - foot.gap.powi(2);
                let back = foot.gap < 0.0
                    && sideways <= (BEND * foot.gap).powi(2)
                    && view.opposes(&foot.normal, &normals);
                if back { foot.distance } else { f64::INFINITY }
            };
            if let Some((_, thickness)) = tree.closest(&place, 2.0 * *depth, 0.0, behind) {
                *depth = depth.min(0.5 * thickness);
            }
        }
        self.depth = depth;
    }
}

impl View<'_> {
    /// Gap in m beyond which nothing is looked for.
    pub(crate) fn reach(&self) -> f64 {
        self.sight.reach
    }

    /// The foot on a face of the target that is in view, the closest point to the viewer; none of one that is not. `normals`: of the
    /// secondary faces, at this configuration.
    pub(crate) fn seen(
        &self,
        (places, stand): (&Places, Stand),
        (item, face): (u32, &Face),
        foot: Projection,
        normals: &[[f64; 3]],
    ) -> Option<Projection> {
        let seen = self.faced((places, stand), (face, foot), normals)?;
        (!self.is_beside(item)).then_some(seen)
    }

    /// Takes the normals of the faces around the viewer among those of all, unless they are of this configuration: `seen` tells
    /// in which one each was taken, and which one is `now`.
    pub(crate) fn see(
        &self,
        places: &Places,
        normals: &mut Vec<[f64; 3]>,
        (seen, now): (&mut Vec<u32>, u32),
    ) {
        normals.resize(self.sight.faces.len(), [0.0; 3]);
        seen.resize(normals.len(), 0);
        for &k in self.sight.around.of(self.point) {
            let k = k as usize;
            if seen[k] != now {
                seen[k] = now;
                normals[k] = normal(&self.sight.faces[k], places);
            }
        }
    }

    /// The least height of the triangles at the corners of the faces around the viewer, m; zero if one is curved.
    pub(crate) fn height_around(&self, places: &Places) -> f64 {
        let around = self.sight.around.of(self.point).iter();
        let around = around.map(|&k| &self.sight.faces[k as usize]);
        turned::least_height(around, places)
    }

    /// The most that nodes may move, m, before a face that is out of view, wherever the foot on it is, may come into it; zero of one
    /// that may be in view. Normals as in [`View::seen`], `height` that of [`View::height_around`], no corners of a curved face.
    pub(crate) fn hidden(
        &self,
        (item, face): (u32, &Face),
        corners: Option<&Corners>,
        height: f64,
        normals: &[[f64; 3]],
    ) -> f64 {
        if self.is_beside(item) {
            return f64::INFINITY;
        }
        let Some(corners) = corners.filter(|_| self.are_solids(face)) else {
            return 0.0;
        };
        let around = self.sight.around.of(self.point).iter();
        let around = around.map(|&k| &normals[k as usize]);
        // a corner points at a face only where a face around it makes more than 90° with that
        let opposed = match self.corner() {
            Some(_) => POINTED,
            None => OPPOSED,
        };
        turned::until_opposed(corners, (around, height), opposed)
    }

    /// The most that nodes may move, m, before the viewer, at `x` (m) and deep behind a face, may be within the depth or before the face; no
    /// corners of a curved one.
    pub(crate) fn behind(&self, face: &Face, corners: Option<&Corners>, x: &[f64; 3]) -> f64 {
        let corners = corners.filter(|_| self.are_solids(face));
        let depth = self.sight.depth[self.point];
        corners.map_or(0.0, |corners| turned::until_behind(corners, (x, depth)))
    }

    /// Whether a face is beside the viewer, or of a part that it does not touch, and so never in view.
    pub(crate) fn is_beside(&self, item: u32) -> bool {
        let beside = self.sight.beside.of(self.point);
        let around = self.sight.around.of(self.point);
        let parts = self.sight.parts.as_ref();
        beside.binary_search(&item).is_ok()
            || parts.is_some_and(|parts| parts.keep_apart(around, item))
    }

    /// Whether a face is out of view wherever the foot on it is: beside the viewer at `x` (m), with the viewer too deep behind it, or with normals
    /// that make less than 90° with those of all faces around it. Normals as in [`View::seen`].
    pub(crate) fn is_blind(
        &self,
        (item, face): (u32, &Face),
        corners: &Corners,
        x: &[f64; 3],
        normals: &[[f64; 3]],
    ) -> bool {
        let around = self.sight.around.of(self.point).iter();
        let normals = around.map(|&k| &normals[k as usize]);
        let depth = self.sight.depth[self.point];
        let faced = !self.are_solids(face) || !corners.is_blind(normals, (x, depth));
        !faced || self.is_beside(item)
    }

    /// Its node, where it is a sharp corner.
    fn corner(&self) -> Option<u32> {
        self.sight.sharp.get(self.point).copied().flatten()
    }

    /// Whether the viewer is a corner with no node around it nearer to the plane of a face with the normal n: -n is in the cone of the normals of
    /// the corner.
    fn points_at(&self, places: &Places, n: &[f64; 3]) -> bool {
        let Some(corner) = self.corner() else {
            return false;
        };
        let around = self.sight.around.of(self.point);
        let tip = places.of(corner);
        let mut nodes = around
            .iter()
            .flat_map(|&face| self.sight.faces[face as usize].corners());
        nodes.all(|&node| {
            let x = places.of(node);
            let way = [0, 1, 2].map(|i| x[i] - tip[i]);
            let along: f64 = (0..3).map(|i| way[i] * n[i]).sum();
            let length = way.iter().map(|w| w * w).sum::<f64>().sqrt();
            along >= -LEVEL * length
        })
    }

    /// Whether a normal n makes more than 120° with that of a face around the viewer.
    fn opposes(&self, n: &[f64; 3], normals: &[[f64; 3]]) -> bool {
        let opposed = |&k: &u32| {
            let own = &normals[k as usize];
            (0..3).map(|i| own[i] * n[i]).sum::<f64>() < OPPOSED
        };
        self.sight.around.of(self.point).iter().any(opposed)
    }
}

pub(crate) fn bounds(face: &Face, x: &[[f64; 3]]) -> Bounds {
    let places: Vec<[f64; 3]> = face.corners().iter().map(|&n| x[n as usize]).collect();
    Bounds::of_face(face.kind, &places)
}

/// Unit normal of a face at the mean of its reference corners.
fn normal(face: &Face, places: &Places) -> [f64; 3] {
    let (table, x) = (face.kind.table(), places.of_face(face));
    if table.dim == 0 {
        return face.axis;
    }
    let mut centre = [0.0; 3];
    for xi in table.reference {
        for i in 0..3 {
            centre[i] += xi[i] / table.nodes as f64;
        }
    }
    let mut dn = [[0.0; 3]; MAX_FACE_NODES];
    (table.gradient)(&centre, &mut dn[..table.nodes]);
    map::measure(&x[..table.nodes], &dn[..table.nodes], table.dim).1
}
