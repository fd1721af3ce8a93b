//! Which faces the points of a contact may touch before anything has moved far: what lets several processes share a contact.

use carom_mesh::Face;
use rayon::prelude::*;

use crate::search::faces::{Question, Scratch};
use crate::search::kept::Kept;
use crate::{Contact, Places, Search, Target};

impl Contact {
    /// For each point the faces of the target, ascending, that [`Contact::pair_near`] may pair it with within `reach` (m) while no place on
    /// the contact moves by `motion` (m) or more. `inside`: whether a point, by its number, is behind the other side; none of the
    /// others may get deeper than the reach meanwhile, which they do not where `motion` is at most half of it. Without faces on an obstacle.
    pub fn in_reach(
        &self,
        places: &Places,
        search: &mut Search,
        [reach, motion]: [f64; 2],
        inside: impl Fn(usize) -> bool + Sync,
    ) -> Vec<Vec<u32>> {
        let Target::Surface(faces) = &self.target else {
            return vec![Vec::new(); self.points.len()];
        };
        self.renew(places, search);
        let tree = &search.faces;
        let points = self.points.par_iter().enumerate();
        let of_point = |(k, point): (usize, &crate::Point)| {
            let (x, view) = (point.place(places), self.view(k));
            let mut limit = self.limit(k, reach);
            if inside(k) {
                let question = Question {
                    x,
                    view,
                    within: f64::INFINITY,
                    guess: None,
                };
                let room = (&mut Kept::default(), &mut Scratch::default());
                let found = tree.closest((places, faces), &question, room.0, room.1);
                let all = view.map_or(f64::INFINITY, |view| view.reach());
                limit = limit.max(found.map_or(all, |(foot, _)| foot.distance));
            }
            let mut found = Vec::new();
            tree.in_reach((places, faces), (view, &x), [limit, motion], &mut found);
            found
        };
        points.map(of_point).collect()
    }

    /// The contact with some faces of its target alone, by their numbers, ascending. Points see of these what they see of all.
    pub fn with_some_faces(&self, kept: &[u32]) -> Contact {
        let Target::Surface(faces) = &self.target else {
            return self.clone();
        };
        let some = kept.iter().map(|&face| faces[face as usize].clone());
        let sight = self.sight.as_ref().map(|sight| sight.with_some_faces(kept));
        Contact {
            target: Target::Surface(some.collect()),
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
