//! Which faces the points of a contact may touch before anything has moved far: what lets several processes share a contact.

use std::f64::consts::SQRT_2;

use carom_mesh::Face;
use rayon::prelude::*;

use crate::search::faces::{FaceTree, Question, Scratch};
use crate::search::kept::Kept;
use crate::sight::View;
use crate::{Contact, Edges, Places, Search, Target};

/// Distance up to which clearances are told, over the largest at which anything is looked at: further, a look costs more than it saves.
const FARTHER: f64 = 2.0;

/// What a point may touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InReach {
    /// Faces of the target, by their numbers, ascending, each with how far nodes may move before it may be touched, m.
    pub faces: Vec<(u32, f64)>,
    /// How far nodes may move before there is any, m; zero where there is.
    pub clearance: f64,
}

impl Contact {
    /// What [`Contact::pair_near`] may pair the points `due` (by number, ascending) with within `reach` (m) while no place on
    /// the contact moves by `motion` (m) or more. `inside`: whether a point is behind the other side; `travelled`: a bound of the motion so far, m,
    /// since the search was new; `most`: the largest reach, m, which bounds the clearances. Nothing on an obstacle.
    pub fn in_reach(
        &self,
        (places, travelled): (&Places, f64),
        search: &mut Search,
        [reach, most, motion]: [f64; 3],
        (due, inside): (&[u32], impl Fn(usize) -> bool + Sync),
    ) -> Vec<InReach> {
        let Target::Surface(faces) = &self.target else {
            return vec![InReach::default(); due.len()];
        };
        let unknown = Kept::default();
        let lines = self.edges.as_ref().map_or(&[][..], Edges::lines);
        search.renew_near(places, (faces, lines), (travelled, [0.0; 3]));
        if self.sight.is_some() {
            let nothing = std::iter::repeat_n(&unknown, due.len());
            search.faces.begin_sight(nothing, (places, faces));
        }
        for &point in due {
            if let Some(view) = self.view(point as usize) {
                search.faces.see(view, places);
            }
        }
        let (tree, lines) = (&search.faces, &search.lines.tree);
        let wide = self.widest();
        let of_point = |&point: &u32| {
            let k = point as usize;
            if self.points[k].is_at_edge() {
                return self.edge_in_reach((places, lines), k, [reach, most, motion]);
            }
            let (x, view) = (self.points[k].place(places), self.view(k));
            // whoever is outside gets no deeper than both sides move
            let mut limit = self.limit(k, reach, wide).max(2.0 * SQRT_2 * motion);
            if inside(k) {
                let question = Question {
                    x,
                    of: Some(&|| self.points[k].behind(places)),
                    view,
                    within: f64::INFINITY,
                    guess: None,
                };
                let room = (&mut Kept::default(), &mut Scratch::default());
                let found = tree.closest((places, faces), &question, room.0, room.1);
                let all = view.map_or(f64::INFINITY, |view| view.reach());
                limit = limit.max(found.map_or(all, |(foot, _)| foot.distance));
            }
            let of = (view, &x);
            let mut found = InReach {
                faces: tree.in_reach((places, faces), of, [limit, motion]),
                clearance: 0.0,
            };
            if let Some(view) = view {
                add_across(&mut found.faces, &view);
            }
            if found.faces.is_empty() {
                found.clearance = tree
                    .rest_of(
                        (places, faces),
                        of,
                        [limit, FARTHER * self.limit(k, most, wide)],
                    )
                    .max(motion);
            }
            found
        };
        due.par_iter().map(of_point).collect()
    }

    /// What the point of a sharp edge may touch; distances as in [`Contact::in_reach`].
    fn edge_in_reach(
        &self,
        target: (&Places, &FaceTree),
        point: usize,
        [reach, most, motion]: [f64; 3],
    ) -> InReach {
        let depth = self.edges.as_ref().map_or(0.0, Edges::depth);
        let wide = SQRT_2 * self.edges.as_ref().map_or(0.0, Edges::widest);
        let limit = (self.limit(point, reach, 0.0) + wide).max(depth);
        let faces = self.edges_in_reach(target, point, [limit, motion]);
        let clearance = || {
            let farthest = limit + FARTHER * self.limit(point, most, 0.0);
            let apart = self.distance_of_edges(target, point, farthest);
            (0.5 * (apart.unwrap_or(farthest) - limit)).max(motion)
        };
        InReach {
            clearance: if faces.is_empty() { clearance() } else { 0.0 },
            faces,
        }
    }

    /// The contact with some faces of its target alone, by their numbers, ascending. Points see of these what they see of all, and of the sharp edges
    /// between them.
    pub fn with_some_faces(&self, kept: &[u32]) -> Contact {
        let Target::Surface(faces) = &self.target else {
            return self.clone();
        };
        let some = kept.iter().map(|&face| faces[face as usize]);
        let sight = self.sight.as_ref().map(|sight| sight.with_some_faces(kept));
        Contact {
            target: Target::Surface(some.collect()),
            edges: self
                .edges
                .as_ref()
                .and_then(|edges| edges.with_some_faces(kept)),
            sight,
            ..self.clone()
        }
    }

    /// The secondary faces around a point that decide what it sees.
    pub fn faces_around(&self, point: usize) -> impl Iterator<Item = &Face> {
        let sight = self.sight.iter();
        sight.flat_map(move |sight| sight.faces_around(point))
    }
}

/// Adds the faces across the edges of some, with the same bound of the motion: they say whether a point beyond an edge is beside the body.
fn add_across(faces: &mut Vec<(u32, f64)>, view: &View) {
    for k in 0..faces.len() {
        let (face, rest) = faces[k];
        faces.extend(view.across(face).map(|other| (other, rest)));
    }
    faces.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    faces.dedup_by_key(|(face, _)| *face);
}
