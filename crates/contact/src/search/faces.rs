//! The faces of a target in a tree of boxes, and the questions that points ask of them.

use carom_elements::Kind;
use carom_mesh::{Bounds, BoxTree, Face, Projection, QUADS};

use super::corners::Taken;
use super::foot::{Own, Stand, faces_point, foot_on, hull};
use super::kept::{Guess, Kept, Query, squared};
use crate::sight::{Corners, View};
use crate::{Places, Sight};

/// Renewals of an unmoved tree from which on points keep their faces.
const SLOW: u32 = 3;

/// Sides of the tree's boxes, over those when it was built, from which on it is built anew.
const LOOSE: f64 = 2.0;

/// Size of a block of points, over half the mean diagonal of the faces, beyond which one look for all does not pay: points over faces in
/// a row are within twelve.
const SPREAD: f64 = 32.0;

/// Faces over the points that do not know which they look at, below which the corners of all are taken.
const MANY: usize = 16;

/// Longest rest of a point that sees its own surface, over the farthest limit: about as much as its normals allow.
const LONGEST: f64 = 0.4;

/// Faces in a tree of boxes that may be older than the faces, and what is known of their motion since.
#[derive(Debug, Default)]
pub(crate) struct FaceTree {
    tree: Option<BoxTree>,
    /// Counts how often boxes were taken.
    epoch: u32,
    /// The most that a place on a face can have moved since, m.
    moved: f64,
    /// Translation of all since then that `moved` leaves out, m.
    shift: [f64; 3],
    /// Half the mean diagonal of the boxes when the tree was built, m.
    skin: f64,
    /// Renewals since the boxes were taken.
    age: u32,
    /// Unit normals of the secondary faces, where sight asks for them.
    normals: Vec<[f64; 3]>,
    /// In which call of [`FaceTree::begin_sight`] each was computed, and which call was the last.
    seen: (Vec<u32>, u32),
    /// Corners of the faces in this configuration, where sight asks for many of them.
    corners: Taken,
}

/// What a point asks.
#[derive(Clone, Copy)]
pub(crate) struct Question<'a> {
    /// Place, m.
    pub x: [f64; 3],
    /// The surface of the point that is there.
    pub of: Own<'a>,
    /// What is seen from there; all if none.
    pub view: Option<View<'a>>,
    /// Distance beyond which nothing is looked for, m.
    pub within: f64,
    /// A face that is likely the closest, projected on.
    pub guess: Option<Guess>,
}

/// What a point sees, if that is not all, and the least height around it.
struct Outlook<'a>(Option<(View<'a>, f64)>);

impl<'a> Outlook<'a> {
    fn new(view: Option<View<'a>>, places: &Places) -> Outlook<'a> {
        Outlook(view.map(|view| (view, view.height_around(places))))
    }
}

/// What questions that follow each other share.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    near: Vec<u32>,
    /// Projections that they made.
    pub projections: usize,
    /// The number of the face of the last one that had another before, less the number of that.
    pub step: i64,
}

impl FaceTree {
    /// Brings the boxes to a configuration of the faces, unless they have moved by less than the skin allows.
    pub fn renew(&mut self, places: &Places, faces: &[Face]) {
        let tree = self.tree.as_ref();
        let tree = tree.filter(|tree| tree.len() == faces.len() && self.has_places());
        let bounds = |item: u32| hull(places, &faces[item as usize]);
        match tree.and_then(|tree| tree.motion(0.5 * self.skin, bounds)) {
            Some(moved) => {
                (self.moved, self.shift) = (moved, [0.0; 3]);
                self.age = self.age.saturating_add(1);
            }
            None => self.take_boxes(places, faces),
        }
    }

    /// Tells how far faces may have moved since the boxes were taken, over a translation of all; whether the boxes still serve.
    pub fn has_moved(&mut self, faces: usize, moved: f64, shift: [f64; 3]) -> bool {
        let count = self.tree.as_ref().map_or(0, BoxTree::len);
        let within = (0.0..=0.5 * self.skin).contains(&moved);
        let serves = count == faces && within && self.has_places();
        if serves {
            (self.moved, self.shift) = (moved, shift);
            self.age = self.age.saturating_add(1);
        }
        serves
    }

    /// Whether the tree was built of places that are numbers: not so those of iterations that lead nowhere, whose boxes would serve for ever.
    fn has_places(&self) -> bool {
        self.skin.is_finite()
    }

    /// Takes the boxes of the faces where they are.
    pub fn take_boxes(&mut self, places: &Places, faces: &[Face]) {
        (self.moved, self.shift, self.age) = (0.0, [0.0; 3], 0);
        self.epoch = self.epoch.wrapping_add(1);
        let bounds = |item: u32| hull(places, &faces[item as usize]);
        let has_places = self.has_places();
        if let Some(tree) = self.tree.as_mut().filter(|tree| tree.len() == faces.len()) {
            tree.refit(bounds);
            if tree.looseness() <= LOOSE && has_places {
                return;
            }
        }
        let boxes: Vec<Bounds> = (0..faces.len() as u32).map(bounds).collect();
        let tree = BoxTree::new(&boxes);
        self.skin = 0.5 * tree.mean_diagonal();
        self.tree = Some(tree);
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.tree.as_ref().map_or(0, BoxTree::bytes)
            + size_of_val(&self.normals[..])
            + self.corners.bytes()
            + size_of_val(&self.seen.0[..])
    }

    /// Takes all normals and corners that views ask for.
    pub fn see_all(&mut self, sight: Option<&Sight>, (places, faces): (&Places, &[Face])) {
        self.normals.clear();
        self.corners.begin(faces.len());
        if let Some(sight) = sight {
            self.normals.extend(sight.normals(places));
            (0..faces.len() as u32).for_each(|item| self.corners.ask(item));
            self.corners.take(places, faces);
        }
    }

    /// Begins a configuration in which normals are taken one after the other, for points with what they remember. Corners are taken of
    /// the faces that these have listed, or of all where many points have no list.
    pub fn begin_sight<'a>(
        &mut self,
        points: impl Iterator<Item = &'a Kept>,
        (places, faces): (&Places, &[Face]),
    ) {
        self.corners.begin(faces.len());
        let mut without = 0;
        for kept in points {
            match kept.listed(self.epoch) {
                Some(items) => items.for_each(|item| self.corners.ask(item)),
                None => without += 1,
            }
        }
        if without > faces.len() / MANY {
            (0..faces.len() as u32).for_each(|item| self.corners.ask(item));
        }
        self.corners.take(places, faces);
        let (seen, now) = &mut self.seen;
        *now = now.wrapping_add(1);
        if *now == 0 {
            seen.fill(0);
            *now = 1;
        }
    }

    /// Unit normals of the secondary faces, where a view has asked for them.
    pub(super) fn normals(&self) -> &[[f64; 3]] {
        &self.normals
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
        let stand = Stand { x, of: question.of };
        // where the place was when the boxes were taken, but for what `moved` bounds
        let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
        let mut count = 0;
        let mut nearest = question.guess.map(|guess| (guess.item, guess.foot));
        let known = nearest.map(|(item, foot)| (item, foot.distance));
        let measure = |item: u32| {
            let face = &faces[item as usize];
            if view.is_some_and(|view| self.is_blind(view, (item, face), x, places)) {
                return f64::INFINITY;
            }
            count += 1;
            let foot = foot_on(places, faces, item, x).0;
            let foot = match view {
                None => foot,
                Some(view) => {
                    let seen = view.seen((places, stand), (item, face), foot, &self.normals);
                    let seen = seen.filter(|foot| {
                        faces_point((stand, foot), face, false, || places.of_face(face))
                            && !view.is_over_neighbour((item, foot), stand, (places, faces))
                    });
                    match seen {
                        Some(foot) => foot,
                        None => return f64::INFINITY,
                    }
                }
            };
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
        let sure = question.guess.is_some_and(|guess| guess.sure)
            && known.is_some_and(|(_, distance)| distance <= within);
        let found = self.tree.as_ref().and_then(|tree| {
            if sure {
                return known;
            }
            // where all is seen, no face need be projected on for a bound; that found last is likely right where faces are kept
            let bound = match (view, last) {
                (None, Some(last)) if known.is_none() && kept.is_open() => {
                    Some(some_distance(places, last, x) + tree.rounding(x))
                }
                _ => None,
            };
            let query = Query {
                known,
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
            if let Some(view) = view {
                scratch.near.retain(|&item| !view.is_beside(item));
            }
            kept.list(&there, reach, &scratch.near, tree);
        }
        if let (Some(before), Some((item, _))) = (kept.face, found) {
            scratch.step = i64::from(item) - i64::from(before);
        }
        kept.face = found.map(|(item, _)| item);
        scratch.projections += count;
        let (item, _) = found?;
        // what was found is the nearest of those that were measured
        let (_, foot) = nearest.filter(|(nearest, _)| *nearest == item)?;
        Some((foot, &faces[item as usize]))
    }

    /// Whether others than its own face may be as near to each of some places as the foot on that is.
    pub fn others(
        &self,
        xs: &[[f64; 3]; QUADS],
        feet: &[Projection; QUADS],
        own: &[u32; QUADS],
    ) -> [bool; QUADS] {
        let around = Bounds::of(xs);
        let apart = squared(&around.min, &around.max).sqrt() > SPREAD * self.skin;
        let Some(tree) = self.tree.as_ref().filter(|_| !apart) else {
            return [true; QUADS];
        };
        let there = xs.map(|x| [0, 1, 2].map(|i| x[i] - self.shift[i]));
        let (mut distances, mut rounding) = ([0.0; QUADS], 0.0);
        for x in &there {
            rounding = f64::max(rounding, tree.rounding(x));
        }
        for (distance, foot) in distances.iter_mut().zip(feet) {
            *distance = foot.distance + self.moved + rounding;
        }
        tree.others(&there, &distances, own)
    }

    /// A box where it was when the boxes of the faces were taken, but for what `moved` bounds.
    fn back(&self, bounds: &Bounds) -> Bounds {
        let back = |x: &[f64; 3]| [0, 1, 2].map(|i| x[i] - self.shift[i]);
        Bounds {
            min: back(&bounds.min),
            max: back(&bounds.max),
        }
    }

    /// The first of the items that are closest to a place, or to what is at most `beside` (m) from it, by their distances.
    pub fn nearest(
        &self,
        x: &[f64; 3],
        beside: f64,
        measure: impl FnMut(u32) -> f64,
    ) -> Option<u32> {
        let found = self.nearest_within((x, beside), f64::INFINITY, measure);
        found.map(|(item, _)| item)
    }

    /// The same with the distance, of the items that are no further away than `within` (m).
    pub fn nearest_within(
        &self,
        (x, beside): (&[f64; 3], f64),
        within: f64,
        measure: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let tree = self.tree.as_ref()?;
        let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
        tree.closest(&there, within, self.moved + beside, measure)
    }

    /// The foot of a place on a face that it stays with.
    pub fn held<'a>(
        &self,
        (places, faces): (&Places, &'a [Face]),
        (stand, view): (Stand, Option<View>),
        item: u32,
    ) -> (Projection, &'a Face) {
        let (foot, face) = foot_on(places, faces, item, stand.x);
        let turned = view.filter(|_| face.is_round());
        let turned =
            turned.and_then(|view| view.seen((places, stand), (item, face), foot, &self.normals));
        (turned.unwrap_or(foot), face)
    }

    /// Items whose boxes are within a distance (m) of a place.
    pub fn near(&self, x: &[f64; 3], within: f64) -> Vec<u32> {
        let mut near = Vec::new();
        if let Some(tree) = &self.tree {
            let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
            let around = within + self.moved + tree.rounding(&there);
            tree.near(&there, around, &mut near);
        }
        near
    }

    /// The most that nodes may move, m, before a face that is beyond the `limit` (m) of a place, or out of its view, may come into
    /// view within the limit; at most a part of the `farthest` limit (m).
    pub fn rest_of(
        &self,
        target: (&Places, &[Face]),
        (view, x): (Option<View>, &[f64; 3]),
        [limit, farthest]: [f64; 2],
    ) -> f64 {
        let Some(tree) = &self.tree else {
            return f64::INFINITY;
        };
        let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
        let most = LONGEST * farthest;
        let outlook = Outlook::new(view, target.0);
        let measure = |item: u32| self.rest_from(target, (&outlook, x), item, [limit, most]);
        // a distance is at most the limit and twice its measure
        let found = tree.closest(&there, most, self.moved + limit + most, measure);
        found.map_or(most, |(_, rest)| rest.max(0.0))
    }

    /// Faces that may come into view within the `limit` (m) of a place while nodes move by less than `motion` (m), ascending, each with how far
    /// they may move before it does, m.
    pub fn in_reach(
        &self,
        target: (&Places, &[Face]),
        (view, x): (Option<View>, &[f64; 3]),
        [limit, motion]: [f64; 2],
    ) -> Vec<(u32, f64)> {
        let Some(tree) = &self.tree else {
            return Vec::new();
        };
        let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
        let around = limit + 2.0 * motion + self.moved + tree.rounding(&there);
        let mut near = Vec::new();
        tree.near(&there, around, &mut near);
        let outlook = Outlook::new(view, target.0);
        let rest = |item: u32| self.rest_from(target, (&outlook, x), item, [limit, motion]);
        let faces = near.into_iter().map(|item| (item, rest(item).max(0.0)));
        faces.filter(|(_, rest)| *rest < motion).collect()
    }

    /// The most that nodes may move, m, before a face may come into view within the `limit` (m) of a place; that or less where it
    /// is less than `most` (m), and otherwise no less than `most`.
    fn rest_from(
        &self,
        (places, faces): (&Places, &[Face]),
        (outlook, x): (&Outlook, &[f64; 3]),
        item: u32,
        [limit, most]: [f64; 2],
    ) -> f64 {
        let face = &faces[item as usize];
        let mut rest = match &self.tree {
            // bounds that need no foot come first: they tell it of most faces
            Some(tree) => {
                let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
                let slack = self.moved + tree.rounding(&there);
                let apart = tree.bounds(item).distance_squared(&there).sqrt() - slack;
                0.5 * (apart - limit)
            }
            None => 0.0,
        };
        if let Some((view, height)) = outlook.0.filter(|_| rest < most) {
            self.with_corners((item, face), places, |corners| {
                rest = rest.max(view.hidden((item, face), corners, height, &self.normals));
                if rest < most {
                    rest = rest.max(view.behind(face, corners, x));
                }
            });
        }
        if rest < most {
            let (foot, _) = foot_on(places, faces, item, x);
            rest = rest.max(0.5 * (foot.distance - limit));
        }
        rest
    }

    /// Whether a face is out of a view wherever the foot on it is.
    fn is_blind(
        &self,
        view: View,
        (item, face): (u32, &Face),
        x: &[f64; 3],
        places: &Places,
    ) -> bool {
        self.with_corners((item, face), places, |corners| {
            corners.is_some_and(|corners| view.is_blind((item, face), corners, x, &self.normals))
        })
    }

    /// Uses the corners of a face, those that were taken if they were; none of a curved one.
    fn with_corners<R>(
        &self,
        (item, face): (u32, &Face),
        places: &Places,
        with: impl FnOnce(Option<&Corners>) -> R,
    ) -> R {
        match self.corners.of(item) {
            Some(taken) => with(taken),
            None => with(Corners::of(face, places).as_ref()),
        }
    }

    /// Whether a face is in a view.
    pub fn shows(
        &self,
        places: &Places,
        view: Option<View>,
        of: (u32, &Face),
        foot: &Projection,
    ) -> bool {
        let stand = Stand {
            x: &foot.point,
            of: None,
        };
        let seen = |view: View| view.seen((places, stand), of, *foot, &self.normals);
        view.is_none_or(|view| seen(view).is_some())
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
        let there = self.back(bounds);
        tree.overlapping(&there.widened(self.moved), found);
        // widened, the box may meet faces that it does not meet where they are now
        if self.moved > 0.0 || self.shift != [0.0; 3] {
            found.retain(|&item| hull(places, &faces[item as usize]).overlaps(bounds));
        }
    }
}

/// Distance of a place on a face from a point, with a margin for its rounding, m: of the mean of the corners, which is on a face that is
/// straight, or of its first node.
fn some_distance(places: &Places, face: &Face, x: &[f64; 3]) -> f64 {
    let of_face = places.of_face(face);
    match face.kind {
        Kind::Point1 | Kind::Bar2 | Kind::Tri3 | Kind::Quad4 => {
            middle_distance(&of_face[..face.corners().len()], x)
        }
        _ => middle_distance(&of_face[..1], x),
    }
}

/// Distance of the mean of some places from a point, with a margin for its rounding, m.
#[inline]
pub(super) fn middle_distance(corners: &[[f64; 3]], x: &[f64; 3]) -> f64 {
    let mut middle = [0.0; 3];
    for place in corners {
        for i in 0..3 {
            middle[i] += place[i];
        }
    }
    let share = 1.0 / corners.len() as f64;
    let middle = [middle[0] * share, middle[1] * share, middle[2] * share];
    squared(&middle, x).sqrt() * (1.0 + 1e-12)
}
