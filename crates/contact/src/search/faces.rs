//! The faces of a target in a tree of boxes, and the questions that points ask of them.

use carom_elements::Kind;
use carom_mesh::{Bounds, BoxTree, Face, Projection};
use rayon::prelude::*;

use super::foot::{faces_point, foot_on, hull, spread};
use super::kept::{Kept, Query, squared};
use crate::sight::{Corners, View};
use crate::{Places, Sight};

/// Faces whose boxes one thread takes at a time.
const CHUNK: usize = 4096;

/// Renewals of an unmoved tree from which on points keep their faces.
const SLOW: u32 = 3;

/// Sides of the tree's boxes, over those when it was built, from which on it is built anew.
const LOOSE: f64 = 2.0;

/// Faces over the points that look at them, below which the corners of all are taken.
const MANY: usize = 16;

/// Longest rest of a point that sees its own surface, over the farthest limit: about as much as its normals allow.
const LONGEST: f64 = 0.4;

/// Faces in a tree of boxes that may be older than the faces, and what is known of their motion since.
#[derive(Debug, Default)]
pub(crate) struct FaceTree {
    tree: Option<BoxTree>,
    boxes: Vec<Bounds>,
    /// Counts how often boxes were taken.
    epoch: u32,
    /// Places of the nodes of all faces when the boxes were taken, face after face, m; none where nobody asks.
    taken: Vec<[f64; 3]>,
    /// The most that a place on a face can have moved since, m.
    moved: f64,
    /// Translation of all since then that `moved` leaves out, m.
    shift: [f64; 3],
    /// Half the mean diagonal of the boxes, m.
    skin: f64,
    /// Renewals since the boxes were taken.
    age: u32,
    /// Unit normals of the secondary faces, where sight asks for them.
    normals: Vec<[f64; 3]>,
    /// Corners of the faces in this configuration, where sight asks for many of them.
    corners: Vec<Option<Corners>>,
    /// In which call of [`FaceTree::begin_sight`] each was computed, and which call was the last.
    seen: (Vec<u32>, u32),
}

/// What a point asks.
#[derive(Clone, Copy)]
pub(crate) struct Question<'a> {
    /// Place, m.
    pub x: [f64; 3],
    /// What is seen from there; all if none.
    pub view: Option<View<'a>>,
    /// Distance beyond which nothing is looked for, m.
    pub within: f64,
}

/// What questions that follow each other share.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    near: Vec<u32>,
    /// Projections that they made.
    pub projections: usize,
}

impl FaceTree {
    /// Brings the boxes to a configuration of the faces, unless they have moved by less than the skin allows.
    pub fn renew(&mut self, places: &Places, faces: &[Face]) {
        self.shift = [0.0; 3];
        self.moved = self.motion(places, faces);
        if self.tree.is_some() && self.moved <= 0.5 * self.skin {
            self.age = self.age.saturating_add(1);
            return;
        }
        self.take_boxes(places, faces);
        self.taken.clear();
        for face in faces {
            let nodes = face.corners().iter();
            self.taken.extend(nodes.map(|&node| places.of(node)));
        }
    }

    /// Tells how far faces may have moved since the boxes were taken, over a translation of all; whether the boxes still serve.
    pub fn has_moved(&mut self, faces: usize, moved: f64, shift: [f64; 3]) -> bool {
        let serves = self.boxes.len() == faces && (0.0..=0.5 * self.skin).contains(&moved);
        if serves {
            (self.moved, self.shift) = (moved, shift);
            self.age = self.age.saturating_add(1);
        }
        serves
    }

    /// Takes the boxes of the faces where they are.
    pub fn take_boxes(&mut self, places: &Places, faces: &[Face]) {
        (self.moved, self.shift, self.age) = (0.0, [0.0; 3], 0);
        self.epoch = self.epoch.wrapping_add(1);
        self.boxes.resize(faces.len(), Bounds::EMPTY);
        let chunks = self.boxes.par_chunks_mut(CHUNK);
        chunks
            .zip(faces.par_chunks(CHUNK))
            .for_each(|(boxes, faces)| {
                for (bounds, face) in boxes.iter_mut().zip(faces) {
                    *bounds = hull(places, face);
                }
            });
        self.taken.clear();
        let diagonals = self.boxes.iter().map(|b| squared(&b.min, &b.max).sqrt());
        self.skin = 0.5 * diagonals.sum::<f64>() / self.boxes.len().max(1) as f64;
        match &mut self.tree {
            Some(tree) if tree.len() == faces.len() => {
                tree.refit(&self.boxes);
                if tree.looseness() > LOOSE {
                    *tree = BoxTree::new(&self.boxes);
                }
            }
            tree => *tree = Some(BoxTree::new(&self.boxes)),
        }
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.tree.as_ref().map_or(0, BoxTree::bytes)
            + size_of_val(&self.boxes[..])
            + size_of_val(&self.taken[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.corners[..])
            + size_of_val(&self.seen.0[..])
    }

    /// The most that a place on a face can have moved since the boxes were taken, m; infinite if that is not known.
    fn motion(&self, places: &Places, faces: &[Face]) -> f64 {
        let mut taken = self.taken.iter();
        let mut largest = 0.0_f64;
        for face in faces {
            let mut of_face = 0.0_f64;
            for &node in face.corners() {
                let Some(before) = taken.next() else {
                    return f64::INFINITY;
                };
                of_face = of_face.max(squared(&places.of(node), before));
            }
            largest = largest.max(of_face.sqrt() * spread(face.kind));
        }
        match taken.next() {
            Some(_) => f64::INFINITY,
            None => largest,
        }
    }

    /// Takes all normals and corners that views ask for.
    pub fn see_all(&mut self, sight: Option<&Sight>, (places, faces): (&Places, &[Face])) {
        self.normals.clear();
        self.corners.clear();
        if let Some(sight) = sight {
            self.normals.extend(sight.normals(places));
            Sight::corners(places, faces, &mut self.corners);
        }
    }

    /// Begins a configuration in which normals are taken one after the other, for so many points; corners are taken all or none.
    pub fn begin_sight(&mut self, points: usize, (places, faces): (&Places, &[Face])) {
        self.corners.clear();
        if points > faces.len() / MANY {
            Sight::corners(places, faces, &mut self.corners);
        }
        let (seen, now) = &mut self.seen;
        *now = now.wrapping_add(1);
        if *now == 0 {
            seen.fill(0);
            *now = 1;
        }
    }

    /// Takes the normals that a view asks for.
    pub fn see(&mut self, view: View, places: &Places) {
        let (seen, now) = &mut self.seen;
        view.see(places, &mut self.normals, (seen, *now));
    }

    /// The closest point of a surface, on the first of the faces that are closest; with a view, on the first of those that
    /// are in view and that the point faces. None further away than `within`.
    pub fn closest<'a>(
        &self,
        (places, faces): (&Places, &'a [Face]),
        question: &Question,
        kept: &mut Kept,
        scratch: &mut Scratch,
    ) -> Option<(Projection, &'a Face)> {
        let (x, view) = (&question.x, question.view);
        // where the place was when the boxes were taken, but for what `moved` bounds
        let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
        let mut count = 0;
        let mut nearest: Option<(u32, Projection)> = None;
        let measure = |item: u32| {
            let face = &faces[item as usize];
            if view.is_some_and(|view| self.is_blind(view, (item, face), x, places)) {
                return f64::INFINITY;
            }
            count += 1;
            let foot = foot_on(places, faces, item, x).0;
            let seen = view.is_none_or(|view| {
                view.shows(item, &foot, &self.normals) && faces_point(&foot, face)
            });
            if !seen {
                return f64::INFINITY;
            }
            let nearer = |(first, best): &(u32, Projection)| {
                foot.distance < best.distance || foot.distance == best.distance && item < *first
            };
            if nearest.as_ref().is_none_or(nearer) {
                nearest = Some((item, foot));
            }
            foot.distance
        };
        let within = view.map_or(question.within, |view| view.reach().min(question.within));
        kept.begin(self.epoch);
        let last = kept.face.and_then(|item| faces.get(item as usize));
        let found = self.tree.as_ref().and_then(|tree| {
            // where all is seen, no face need be projected on for a bound; that found last is likely right where faces are kept
            let bound = match (view, last) {
                (None, Some(last)) if kept.is_open() => {
                    Some(middle_distance(places, last, x) + tree.rounding(x))
                }
                _ => None,
            };
            let query = Query {
                bound,
                tree,
                moved: self.moved,
                x: &there,
                within,
            };
            query.closest(kept, faces.len(), measure)
        });
        if let Some(tree) = &self.tree
            && self.age >= SLOW
            && kept.is_open()
        {
            let distance = found.map_or(within, |(_, distance)| distance);
            let reach = distance + self.moved + self.skin;
            tree.near(&there, reach, &mut scratch.near);
            kept.list(&there, reach, &scratch.near, &self.boxes);
        }
        kept.face = found.map(|(item, _)| item);
        scratch.projections += count;
        let (item, _) = found?;
        // what was found is the nearest of those that were measured
        let (_, foot) = nearest.filter(|(nearest, _)| *nearest == item)?;
        Some((foot, &faces[item as usize]))
    }

    /// The first of the items that are closest to a place, or to what is at most `beside` (m) from it, by their distances.
    pub fn nearest(
        &self,
        x: &[f64; 3],
        beside: f64,
        measure: impl FnMut(u32) -> f64,
    ) -> Option<u32> {
        let tree = self.tree.as_ref()?;
        let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
        let found = tree.closest(&there, f64::INFINITY, self.moved + beside, measure);
        found.map(|(item, _)| item)
    }

    /// The most that nodes may move, m, before a face that is beyond the `limit` (m) of a place, or out of its view, may come into
    /// view within the limit; at most a part of the `farthest` limit (m).
    pub fn rest_of(
        &self,
        (places, faces): (&Places, &[Face]),
        view: View,
        x: &[f64; 3],
        [limit, farthest]: [f64; 2],
    ) -> f64 {
        let Some(tree) = &self.tree else {
            return f64::INFINITY;
        };
        let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
        let most = LONGEST * farthest;
        let slack = self.moved + tree.rounding(&there);
        let measure = |item: u32| {
            // bounds that need no foot come first: they tell it of most faces
            let face = &faces[item as usize];
            let apart = self.boxes[item as usize].distance_squared(&there).sqrt() - slack;
            let mut rest = 0.5 * (apart - limit);
            if rest < most {
                rest = rest.max(view.hidden((item, face), places, &self.normals));
            }
            if rest < most {
                rest = rest.max(view.behind(face, x, places));
            }
            if rest < most {
                let (foot, _) = foot_on(places, faces, item, x);
                rest = rest.max(0.5 * (foot.distance - limit));
            }
            rest
        };
        // a distance is at most the limit and twice its measure
        let found = tree.closest(&there, most, self.moved + limit + most, measure);
        found.map_or(most, |(_, rest)| rest.max(0.0))
    }

    /// Whether a face is out of a view wherever the foot on it is.
    fn is_blind(
        &self,
        view: View,
        (item, face): (u32, &Face),
        x: &[f64; 3],
        places: &Places,
    ) -> bool {
        let made;
        let corners = match self.corners.get(item as usize) {
            Some(kept) => kept,
            None => {
                made = Corners::of(face, places);
                &made
            }
        };
        let corners = corners.as_ref();
        corners.is_some_and(|corners| view.is_blind((item, corners), x, &self.normals))
    }

    /// Whether a face is in a view.
    pub fn shows(&self, view: Option<View>, item: u32, foot: &Projection) -> bool {
        view.is_none_or(|view| view.shows(item, foot, &self.normals))
    }

    /// Faces whose boxes have a point in common with a box, sorted, into `found`, which is cleared first.
    pub fn overlapping(
        &self,
        (places, faces): (&Places, &[Face]),
        bounds: &Bounds,
        found: &mut Vec<u32>,
    ) {
        found.clear();
        let Some(tree) = &self.tree else {
            return;
        };
        let back = |x: [f64; 3]| [0, 1, 2].map(|i| x[i] - self.shift[i]);
        let there = Bounds {
            min: back(bounds.min),
            max: back(bounds.max),
        };
        tree.overlapping(&there.widened(self.moved), found);
        // widened, the box may meet faces that it does not meet where they are now
        if self.moved > 0.0 || self.shift != [0.0; 3] {
            found.retain(|&item| hull(places, &faces[item as usize]).overlaps(bounds));
        }
    }
}

/// Distance of a place on a face from a point, with a margin for its rounding, m: of the mean of the corners, which is on a face that is
/// straight, or of its first node.
fn middle_distance(places: &Places, face: &Face, x: &[f64; 3]) -> f64 {
    let corners = match face.kind {
        Kind::Point1 | Kind::Bar2 | Kind::Tri3 | Kind::Quad4 => face.corners(),
        _ => &face.nodes[..1],
    };
    let mut middle = [0.0; 3];
    for &node in corners {
        let place = places.of(node);
        for i in 0..3 {
            middle[i] += place[i];
        }
    }
    let share = 1.0 / corners.len() as f64;
    let middle = [middle[0] * share, middle[1] * share, middle[2] * share];
    squared(&middle, x).sqrt() * (1.0 + 1e-12)
}
