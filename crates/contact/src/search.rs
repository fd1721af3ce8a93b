//! Which face of a deformable surface is closest to a point: the memory that makes this cheap from step to step.
//!
//! The tree of boxes stays as it is while no corner has moved by more than a quarter of a face, the *skin* being half a
//! face: boxes then count as wider by that motion. Moved further it is refitted, and built anew once refits have made it
//! loose. A point that has been looked up in a slow surface keeps the faces around its foot; as long as the motions since
//! then cannot have brought another face closer, only these are asked.
//!
//! None of this changes results, bit for bit: the closest face is always the first of those whose projection is
//! closest, as if all had been asked.

use carom_mesh::{Face, Projection, QUADS};

use self::faces::{FaceTree, Question, Scratch};
pub(crate) use self::foot::{Own, Stand, diagonal, faces_point, foot_on, is_beside_rim, spread};
use self::group::Group;
use self::guess::Guesses;
use self::kept::Kept;
use self::lines::Lines;
pub(crate) use self::way::{Way, is_between};
use crate::faced::Faced;
use crate::rest::{BLOCK, Rest};
use crate::sight::View;
use crate::{Places, Point, Sight};

mod corners;
pub(crate) mod faces;
mod foot;
pub(crate) mod group;
pub(crate) mod guess;
pub(crate) mod kept;
pub(crate) mod lines;
pub(crate) mod through;
mod way;

/// Memory of the search of one contact, renewed at each pairing. What it holds does not matter to results, but for the points
/// that [`Search::begin_step`] lets it hold, and for what it is to remember ([`Search::remember`]).
#[derive(Debug, Default)]
pub struct Search {
    /// The faces and their boxes.
    pub(crate) faces: FaceTree,
    /// Sharp edges of the target ([`Edges`](crate::Edges)).
    pub(crate) lines: Lines,
    /// The memory of each query since the renewal, in their order.
    kept: Vec<Kept>,
    next: usize,
    guesses: Guesses,
    /// What the queries share, with the projections since the last renewal.
    pub(crate) scratch: Scratch,
    /// For each query its way over the faces in the step; empty where none is looked at.
    ways: Vec<Way>,
    watches: bool,
    /// When points that are far are looked at again.
    pub(crate) rest: Rest,
    pub(crate) due: Vec<u32>,
    /// Points that are looked at one after the other, with their memory.
    pub(crate) groups: Vec<Group>,
    /// Bound of the motion, and drift, when the boxes were taken while points rested, m; none if they were not.
    rested: Option<(f64, [f64; 3])>,
}

/// A point that stays with a face until the step ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Its place in the contact.
    pub point: usize,
    /// Gap to the plane of the face, or to the point of its rim where the point is beyond it, less that to the closest face, of
    /// surfaces with a sight to the closest of those that it has gone over, over the diagonal of the face.
    pub error: f64,
}

impl Search {
    /// Brings the search to a configuration of the faces of the target; `sight` as in the contact.
    pub(crate) fn renew(&mut self, places: &Places, faces: &[Face], sight: Option<&Sight>) {
        self.begin();
        self.rested = None;
        self.faces.see_all(sight, (places, faces));
        self.faces.renew(places, faces);
    }

    /// Brings the search to a configuration whose motion since another one is bounded by the difference of what points at rest have
    /// `travelled`, over the drift. `lines`: sharp edges of the target, none where edges do not count.
    pub(crate) fn renew_near(
        &mut self,
        places: &Places,
        (faces, lines): (&[Face], &[Face]),
        (travelled, shift): (f64, [f64; 3]),
    ) {
        if let Some((before, from)) = self.rested {
            let (moved, shift) = (travelled - before, [0, 1, 2].map(|i| shift[i] - from[i]));
            let mut serves = self.faces.has_moved(faces.len(), moved, shift);
            if !lines.is_empty() {
                serves &= self.lines.tree.has_moved(lines.len(), moved, shift);
            }
            if serves {
                return;
            }
        }
        self.rested = Some((travelled, shift));
        self.faces.take_boxes(places, faces);
        if !lines.is_empty() {
            self.lines.tree.take_boxes(places, lines);
        }
    }

    /// Takes the boxes of the faces anew in the next pairing of near points.
    pub(crate) fn forget_boxes(&mut self) {
        self.rested = None;
    }

    /// Forgets when points that are far are looked at again.
    pub fn rest_anew(&mut self) {
        self.rest = Rest::default();
    }

    /// The most that a node of the contact has moved from one pairing of near points to the last, m; infinite where there was one alone.
    pub fn motion(&self) -> f64 {
        self.rest.motion()
    }

    /// Counts queries and projections from here on.
    pub(crate) fn begin(&mut self) {
        (self.next, self.scratch.projections) = (0, 0);
        self.guesses.clear();
    }

    /// Guesses what the next points face that see all, at most [`QUADS`] of them.
    pub(crate) fn look_ahead(&mut self, places: &Places, faces: &[Face], points: &[Point]) {
        let points = &points[..points.len().min(QUADS)];
        let from = self.next.min(self.kept.len());
        let own = (from, &self.kept[from..]);
        let places_of = points.iter().filter(|point| !point.crosses());
        let xs = places_of.map(|point| point.place(places));
        let target = (&self.faces, places, faces);
        self.guesses.make(target, own, xs, &mut self.scratch);
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        let lists = self.kept.iter().map(Kept::bytes);
        let groups = self.groups.iter().map(Group::bytes);
        self.faces.bytes() + self.lines.tree.bytes() + lists.sum::<usize>() + groups.sum::<usize>()
    }

    /// Projections on faces since the last renewal: what the search cost.
    pub fn projections(&self) -> usize {
        self.scratch.projections
    }

    /// Remembers the edges that points of edges were closed at, by ascending numbers in the contact, until the next call.
    pub fn remember(&mut self, faced: impl Iterator<Item = (u32, Faced)>) {
        self.lines.remember(faced);
    }

    /// Begins a step of several pairings. In a fold between two faces whose normals push a point each towards the other it
    /// would go to and fro for ever: a point near its face that comes back a second time stays with the face, also where
    /// its foot is beyond the rim, until the next call.
    pub fn begin_step(&mut self) {
        self.watches = true;
        self.ways.clear();
        self.groups.iter_mut().for_each(|group| group.ways.clear());
    }

    /// Ends the step of several pairings.
    pub(crate) fn forget_ways(&mut self) {
        if self.watches {
            self.begin_step();
            self.watches = false;
        }
    }

    /// Whether ways over the faces are looked at.
    pub(crate) fn watches(&self) -> bool {
        self.watches
    }

    /// The closest point of a surface, if the point faces it; on the face that holds it, if one does.
    pub(crate) fn facing<'a>(
        &mut self,
        places: &Places,
        faces: &'a [Face],
        (point, view): (&Point, Option<View>),
    ) -> Option<(Projection, &'a Face)> {
        let x = &point.place(places);
        let stand = Stand {
            x,
            of: Some(&|| point.behind(places)),
        };
        let slot = self.next;
        if let Some(held) = self.ways.get(slot).and_then(|way| way.held) {
            self.next += 1;
            return Some(self.faces.held((places, faces), (stand, view), held));
        }
        let found = self
            .closest((places, faces), view, stand, f64::INFINITY)
            .filter(|(foot, face)| {
                faces_point((stand, foot), face, view.is_none(), || places.of_face(face))
            });
        if let (true, Some((foot, face)), Some(item)) = (self.watches, &found, self.kept[slot].face)
            && is_between(places, foot, face)
        {
            if self.ways.len() <= slot {
                self.ways.resize(slot + 1, Way::default());
            }
            self.ways[slot].goes(item);
        }
        found
    }

    /// The points that stay with a face, and how far off they are in this configuration. `sees`: whether the surface has a sight.
    pub(crate) fn held(
        &self,
        (places, sees): (&Places, bool),
        faces: &[Face],
        place: impl Fn(usize) -> [f64; 3],
    ) -> Vec<Held> {
        let of_groups = self.groups.iter().enumerate().flat_map(|(k, group)| {
            let ways = group.ways.iter().enumerate();
            ways.map(move |(slot, way)| (k * BLOCK + slot, way))
        });
        let held = self.ways.iter().enumerate().chain(of_groups);
        let of = |(point, way): (usize, &Way)| {
            let item = way.held?;
            let x = place(point);
            let (foot, face) = foot_on(places, faces, item, &x);
            let measure = |item: u32| foot_on(places, faces, item, &x).0.distance;
            let closest = match sees {
                // what is closest may be out of view
                true => way.closest(measure),
                false => self.faces.nearest(&x, 0.0, measure),
            };
            let off = foot.gap - foot_on(places, faces, closest?, &x).0.gap;
            Some(Held {
                point,
                error: off / diagonal(places, face),
            })
        };
        held.filter_map(of).collect()
    }

    /// [`FaceTree::closest`] for a query that keeps its memory by its order after a renewal.
    pub(crate) fn closest<'a>(
        &mut self,
        target: (&Places, &'a [Face]),
        view: Option<View>,
        stand: Stand,
        within: f64,
    ) -> Option<(Projection, &'a Face)> {
        let slot = self.next;
        self.next += 1;
        if self.kept.len() <= slot {
            self.kept.resize_with(slot + 1, Kept::default);
        }
        let question = Question {
            x: *stand.x,
            of: stand.of,
            view,
            within,
            guess: self.guesses.take(slot),
        };
        self.faces
            .closest(target, &question, &mut self.kept[slot], &mut self.scratch)
    }
}
