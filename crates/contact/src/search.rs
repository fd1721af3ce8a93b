//! Which face of a deformable surface is closest to a point: the memory that makes this cheap from step to step.
//!
//! The tree of boxes stays as it is while no corner has moved by more than a quarter of a face, the *skin* being half a
//! face: boxes then count as wider by that motion. Moved further it is refitted, and built anew once refits have made it
//! loose. A point that has been looked up in a slow surface keeps the faces around its foot; as long as the motions since
//! then cannot have brought another face closer, only these are asked.
//!
//! None of this changes results, bit for bit: the closest face is always the first of those whose projection is
//! closest, as if all had been asked.

use carom_elements::Kind;
use carom_mesh::{Bounds, BoxTree, Face, Projection, project};

use crate::rest::Rest;
use crate::sight::View;
use crate::{Places, Sight};

/// Renewals of an unmoved tree from which on points keep their faces.
const SLOW: u32 = 3;

/// The most faces that a point keeps.
const MANY: usize = 32;

/// Sides of the tree's boxes, over those when it was built, from which on it is built anew.
const LOOSE: f64 = 2.0;

/// Returns of a point, within one step, to a face that it has left in it, after which it stays with that face.
const RETURNS: u32 = 2;

/// Longest rest of a point that sees its own surface, over the limit: about as much as its normals allow.
const LONGEST: f64 = 0.1;

/// Gap beyond which a point between two faces is left alone, over the diagonal of the face.
const NEAR: f64 = 0.1;

/// Memory of the search of one contact, renewed at each pairing. What it holds does not matter to results, but for the points
/// that [`Search::begin_step`] lets it hold.
#[derive(Debug, Default)]
pub struct Search {
    tree: Option<BoxTree>,
    boxes: Vec<Bounds>,
    /// Places of the nodes of all faces when the boxes were taken, face after face, m.
    taken: Vec<[f64; 3]>,
    /// The most that a place on a face can have moved since, m.
    moved: f64,
    /// Translation of all since then that `moved` leaves out, m.
    shift: [f64; 3],
    /// Half the mean diagonal of the boxes, m.
    skin: f64,
    /// Renewals since the boxes were taken.
    age: u32,
    /// The memory of each query since the renewal, in their order.
    kept: Vec<Kept>,
    next: usize,
    /// Unit normals of the secondary faces, where sight asks for them.
    normals: Vec<[f64; 3]>,
    near: Vec<u32>,
    /// Projections made since the last renewal.
    projections: usize,
    /// For each query its way over the faces in the step; empty where none is looked at.
    ways: Vec<Way>,
    watches: bool,
    /// When points that are far are looked at again.
    pub(crate) rest: Rest,
    pub(crate) due: Vec<u32>,
    /// Bound of the motion, and drift, when the boxes were taken while points rested, m; none if they were not.
    rested: Option<(f64, [f64; 3])>,
}

/// The way of a point over the faces in the iterations of a step.
#[derive(Clone, Debug, Default)]
struct Way {
    /// The faces, each once, that of the last iteration last.
    faces: Vec<u32>,
    returns: u32,
    /// The face that it stays with.
    held: Option<u32>,
}

/// A point that stays with a face until the step ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Its place in the contact.
    pub point: usize,
    /// Gap to the plane of the face, or to the point of its rim where the point is beyond it, less that to the closest face,
    /// over the diagonal of the face.
    pub error: f64,
}

/// What one query remembers.
#[derive(Clone, Debug, Default)]
struct Kept {
    /// The face found last.
    face: Option<u32>,
    /// The place when the faces were listed, m.
    x: [f64; 3],
    /// All faces within `reach` (m) of that place and the distances of their boxes; none if not listed.
    faces: Vec<(u32, f64)>,
    reach: Option<f64>,
    /// Whether there were too many to be listed.
    crowded: bool,
}

impl Search {
    /// Brings the search to a configuration of the faces of the target; `sight` as in the contact.
    pub(crate) fn renew(&mut self, places: &Places, faces: &[Face], sight: Option<&Sight>) {
        self.next = 0;
        self.projections = 0;
        self.normals.clear();
        if let Some(sight) = sight {
            self.normals.extend(sight.normals(places));
        }
        self.rested = None;
        self.shift = [0.0; 3];
        self.moved = self.motion(places, faces);
        if self.tree.is_some() && self.moved <= 0.5 * self.skin {
            self.age = self.age.saturating_add(1);
            return;
        }
        self.take_boxes(places, faces);
    }

    /// Brings the search to a configuration whose motion since another one is bounded by the difference of what points at rest have
    /// `travelled`, over the drift.
    pub(crate) fn renew_near(
        &mut self,
        places: &Places,
        faces: &[Face],
        (travelled, shift): (f64, [f64; 3]),
    ) {
        self.watches = false;
        self.ways.clear();
        if let Some((before, from)) = self.rested
            && self.boxes.len() == faces.len()
            && travelled >= before
            && travelled - before <= 0.5 * self.skin
        {
            self.moved = travelled - before;
            self.shift = [0, 1, 2].map(|i| shift[i] - from[i]);
            self.age = self.age.saturating_add(1);
            return;
        }
        self.shift = [0.0; 3];
        self.rested = Some((travelled, shift));
        self.take_boxes(places, faces);
    }

    /// Counts projections from here on.
    pub(crate) fn begin_count(&mut self) {
        self.projections = 0;
    }

    /// The next query is that of this number.
    pub(crate) fn seat(&mut self, query: usize) {
        self.next = query;
    }

    /// Takes the normals that a view asks for.
    pub(crate) fn see(&mut self, view: View, places: &Places) {
        view.see(places, &mut self.normals);
    }

    /// Takes all normals.
    pub(crate) fn see_all(&mut self, sight: &Sight, places: &Places) {
        self.normals.clear();
        self.normals.extend(sight.normals(places));
    }

    fn take_boxes(&mut self, places: &Places, faces: &[Face]) {
        self.moved = 0.0;
        self.age = 0;
        for kept in &mut self.kept {
            (kept.reach, kept.crowded) = (None, false);
        }
        self.take(places, faces);
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
        let lists = self
            .kept
            .iter()
            .map(|kept| size_of::<Kept>() + kept.faces.capacity() * size_of::<(u32, f64)>());
        self.tree.as_ref().map_or(0, BoxTree::bytes)
            + size_of_val(&self.boxes[..])
            + size_of_val(&self.taken[..])
            + size_of_val(&self.normals[..])
            + lists.sum::<usize>()
    }

    /// Projections on faces since the last renewal: what the search cost.
    pub fn projections(&self) -> usize {
        self.projections
    }

    /// The most that a place on a face can have moved since the boxes were taken, m; infinite if these are other faces.
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

    fn take(&mut self, places: &Places, faces: &[Face]) {
        self.boxes.clear();
        self.taken.clear();
        for face in faces {
            self.boxes.push(hull(places, face));
            let nodes = face.corners().iter();
            self.taken.extend(nodes.map(|&node| places.of(node)));
        }
        let diagonals = self.boxes.iter().map(|b| squared(&b.min, &b.max).sqrt());
        self.skin = 0.5 * diagonals.sum::<f64>() / self.boxes.len().max(1) as f64;
    }

    /// Begins a step of several pairings. In a fold between two faces whose normals push a point each towards the other it
    /// would go to and fro for ever: a point near its face that comes back a second time stays with the face, also where
    /// its foot is beyond the rim, until the next call. Surfaces with a sight are left alone.
    pub fn begin_step(&mut self) {
        self.watches = true;
        self.ways.clear();
    }

    /// The closest point of a surface, if the point faces it; on the face that holds it, if one does.
    pub(crate) fn facing<'a>(
        &mut self,
        places: &Places,
        faces: &'a [Face],
        view: Option<View>,
        x: &[f64; 3],
    ) -> Option<(Projection, &'a Face)> {
        let slot = self.next;
        if let Some(held) = self.ways.get(slot).and_then(|way| way.held) {
            self.next += 1;
            return Some(foot_on(places, faces, held, x));
        }
        let watched = self.watches && view.is_none();
        let found = self
            .closest((places, faces), view, x, f64::INFINITY)
            .filter(|(foot, face)| faces_point(foot, face));
        if let (true, Some((foot, face)), Some(item)) = (watched, &found, self.kept[slot].face)
            && foot.gap.abs() < NEAR * diagonal(places, face)
        {
            if self.ways.len() <= slot {
                self.ways.resize(slot + 1, Way::default());
            }
            self.ways[slot].goes(item);
        }
        found
    }

    /// The points that stay with a face, and how far off they are in this configuration.
    pub(crate) fn held(
        &self,
        places: &Places,
        faces: &[Face],
        place: impl Fn(usize) -> [f64; 3],
    ) -> Vec<Held> {
        let held = self.ways.iter().enumerate();
        let of = |(point, way): (usize, &Way)| {
            let x = place(point);
            let (foot, face) = foot_on(places, faces, way.held?, &x);
            let measure = |item| foot_on(places, faces, item, &x).0.distance;
            let tree = self.tree.as_ref()?;
            let (closest, _) = tree.closest(&x, f64::INFINITY, self.moved, measure)?;
            let off = foot.gap - foot_on(places, faces, closest, &x).0.gap;
            Some(Held {
                point,
                error: off / diagonal(places, face),
            })
        };
        held.filter_map(of).collect()
    }

    /// The closest point of a surface, on the first of the faces that are closest; with a view, on the first of those that
    /// are in view and that the point faces. None further away than `within`, m.
    ///
    /// Queries keep their memory by their order after a renewal.
    pub(crate) fn closest<'a>(
        &mut self,
        (places, faces): (&Places, &'a [Face]),
        view: Option<View>,
        x: &[f64; 3],
        within: f64,
    ) -> Option<(Projection, &'a Face)> {
        let slot = self.next;
        self.next += 1;
        if self.kept.len() <= slot {
            self.kept.resize_with(slot + 1, Kept::default);
        }
        // where the place was when the boxes were taken, but for what `moved` bounds
        let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
        let mut kept = std::mem::take(&mut self.kept[slot]);
        let mut count = 0;
        let foot = |item: u32| foot_on(places, faces, item, x).0;
        let measure = |item: u32| {
            let face = &faces[item as usize];
            if view.is_some_and(|view| view.is_blind((item, face), places, &self.normals)) {
                return f64::INFINITY;
            }
            count += 1;
            let foot = foot(item);
            let seen = view.is_none_or(|view| {
                view.shows(item, &foot, &self.normals) && faces_point(&foot, face)
            });
            if seen { foot.distance } else { f64::INFINITY }
        };
        let within = view.map_or(within, |view| view.reach().min(within));
        let found = self.tree.as_ref().and_then(|tree| {
            let query = Query {
                tree,
                moved: self.moved,
                x: &there,
                within,
            };
            query.closest(&mut kept, faces.len(), measure)
        });
        if let Some(tree) = &self.tree
            && self.age >= SLOW
            && kept.reach.is_none()
            && !kept.crowded
        {
            let distance = found.map_or(within, |(_, distance)| distance);
            let reach = distance + self.moved + self.skin;
            tree.near(&there, reach, &mut self.near);
            kept.list(&there, reach, &self.near, &self.boxes);
        }
        kept.face = found.map(|(item, _)| item);
        self.kept[slot] = kept;
        self.projections += count;
        let (item, _) = found?;
        Some((foot(item), &faces[item as usize]))
    }

    /// The first of the items that are closest to a place, or to what is at most `beside` (m) from it, by their distances.
    pub(crate) fn nearest(
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
    /// view within the limit; at most a part of the limit.
    pub(crate) fn rest_of(
        &self,
        (places, faces): (&Places, &[Face]),
        view: View,
        x: &[f64; 3],
        limit: f64,
    ) -> f64 {
        let Some(tree) = &self.tree else {
            return f64::INFINITY;
        };
        let there = [0, 1, 2].map(|i| x[i] - self.shift[i]);
        let measure = |item: u32| {
            let (foot, face) = foot_on(places, faces, item, x);
            let far = 0.5 * (foot.distance - limit);
            far.max(view.hidden((item, face), &foot, places, &self.normals))
        };
        // a distance is at most the limit and twice its measure
        let most = LONGEST * limit;
        let found = tree.closest(&there, most, self.moved + limit + most, measure);
        found.map_or(most, |(_, rest)| rest.max(0.0))
    }

    /// Whether a face is in a view.
    pub(crate) fn shows(&self, view: Option<View>, item: u32, foot: &Projection) -> bool {
        view.is_none_or(|view| view.shows(item, foot, &self.normals))
    }

    /// Faces whose boxes have a point in common with a box, sorted, into `found`, which is cleared first.
    pub(crate) fn overlapping(
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

/// One question to a tree whose items have moved by `moved` at most.
struct Query<'a> {
    tree: &'a BoxTree,
    moved: f64,
    x: &'a [f64; 3],
    within: f64,
}

impl Query<'_> {
    /// The first of the closest items and its distance.
    fn closest(
        &self,
        kept: &mut Kept,
        count: usize,
        mut measure: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        // what was closest last bounds the distance of what is closest now
        let last = kept.face.filter(|&item| (item as usize) < count);
        let bound = last.map_or(f64::INFINITY, &mut measure);
        let mut measure = |item: u32| match Some(item) == last {
            true => bound,
            false => measure(item),
        };
        let within = self.within.min(bound);
        if let Some(answer) = self.among_kept(kept, within, &mut measure) {
            return answer;
        }
        kept.reach = None;
        self.tree.closest(self.x, within, self.moved, measure)
    }

    /// The answer from the kept faces; `None` if another face may be closer than they are.
    fn among_kept(
        &self,
        kept: &Kept,
        within: f64,
        mut measure: impl FnMut(u32) -> f64,
    ) -> Option<Option<(u32, f64)>> {
        let gone = squared(self.x, &kept.x).sqrt();
        let slack = self.moved + gone + self.tree.rounding(self.x);
        let sure = kept.reach? - slack;
        let mut best: Option<(u32, f64)> = None;
        let mut limit = within;
        for &(item, lower) in &kept.faces {
            if lower - slack > limit {
                continue;
            }
            let distance = measure(item);
            // in the order of their numbers: a later one has to be closer
            if distance <= limit && best.is_none_or(|(_, least)| distance < least) {
                best = Some((item, distance));
                limit = distance;
            }
        }
        (limit <= sure).then_some(best)
    }
}

impl Kept {
    /// Lists the faces `near` a place, those within a reach, unless they are too many.
    fn list(&mut self, x: &[f64; 3], reach: f64, near: &[u32], boxes: &[Bounds]) {
        self.crowded = near.len() > MANY;
        if self.crowded {
            return;
        }
        self.faces.clear();
        let distance = |&item: &u32| (item, boxes[item as usize].distance_squared(x).sqrt());
        self.faces.extend(near.iter().map(distance));
        (self.x, self.reach) = (*x, Some(reach));
    }
}

impl Way {
    fn goes(&mut self, item: u32) {
        if self.faces.last() == Some(&item) {
            return;
        }
        if let Some(before) = self.faces.iter().position(|&face| face == item) {
            self.faces.remove(before);
            self.returns += 1;
            self.held = (self.returns >= RETURNS).then_some(item);
        }
        self.faces.push(item);
    }
}

/// The closest point of one of the faces.
pub(crate) fn foot_on<'a>(
    places: &Places,
    faces: &'a [Face],
    item: u32,
    x: &[f64; 3],
) -> (Projection, &'a Face) {
    let face = &faces[item as usize];
    let positions = places.of_face(face);
    (project(face, &positions[..face.corners().len()], x), face)
}

/// Diagonal of the box of a face, m.
fn diagonal(places: &Places, face: &Face) -> f64 {
    let bounds = hull(places, face);
    squared(&bounds.min, &bounds.max).sqrt()
}

/// A box that holds a face.
fn hull(places: &Places, face: &Face) -> Bounds {
    Bounds::of_face(face.kind, &places.of_face(face)[..face.corners().len()])
}

/// Whether a point faces the face on which its closest point lies: whether the way to it runs sideways by no more than
/// it runs along the normal.
pub(crate) fn faces_point(foot: &Projection, face: &Face) -> bool {
    if foot.inside || face.kind == Kind::Point1 {
        return true;
    }
    let sideways = (foot.distance.powi(2) - foot.gap.powi(2)).max(0.0).sqrt();
    // Matching rims coincide only to rounding: a foot that close to the rim counts as inside.
    let rounding = 1e-9
        * foot
            .point
            .iter()
            .fold(1e-300_f64, |size, x| size.max(x.abs()));
    sideways <= foot.gap.abs().max(rounding)
}

/// The most that Σ |N_a| is on a face: places between its nodes move by that times the motion of the nodes at most.
pub(crate) fn spread(kind: Kind) -> f64 {
    match kind {
        Kind::Point1 | Kind::Bar2 | Kind::Tri3 | Kind::Quad4 => 1.0,
        // eight nodes, at the centre: four times 1/4 and four times 1/2; other kinds have less
        _ => 3.0,
    }
}

fn squared(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum()
}
