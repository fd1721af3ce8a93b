//! Looks at points that may be near what they face: group after group on several threads, the same groups on any number.
//!
//! A look reads the configuration and writes the memory of its group alone. What it found is put into the pairing afterwards, in
//! the order of the points.

use std::f64::consts::SQRT_2;

use carom_mesh::Face;
use rayon::prelude::*;

use super::found::Look;
use super::near::Reach;
use super::stencil::Stencil;
use super::{Near, Pairing};
use crate::crossing::Opposite;
use crate::rest::{BLOCK, Rest};
use crate::search::faces::{FaceTree, Question};
use crate::search::group::Group;
use crate::search::kept::Kept;
use crate::search::lines::Lines;
use crate::search::through::Start;
use crate::search::{Stand, Way, faces_point, is_between};
use crate::{Contact, Places, Search, Target};

impl Contact {
    /// Looks at the points that are due and takes the near ones into a pairing.
    pub(super) fn look_at_all(
        &self,
        (places, near, reach): (&Places, &Near, Reach),
        (search, due): (&mut Search, &[u32]),
        rest: &mut Rest,
        pairing: &mut Pairing,
    ) {
        let watches = search.watches();
        let groups = &mut search.groups;
        groups.resize_with(self.points.len().div_ceil(BLOCK), Group::default);
        if let (Target::Surface(faces), Some(_)) = (&self.target, &self.sight) {
            let nothing = Kept::default();
            let of_faces = due
                .iter()
                .filter(|&&k| self.points[k as usize].edge().is_none());
            let kept = of_faces.map(|&point| {
                let k = point as usize;
                groups[k / BLOCK].kept.get(k % BLOCK).unwrap_or(&nothing)
            });
            search.faces.begin_sight(kept, (places, faces));
        }
        for &point in due {
            if let Some(view) = self.view(point as usize) {
                search.faces.see(view, places);
            }
        }
        let mut first = 0;
        for points in due.chunk_by(|a, b| *a as usize / BLOCK == *b as usize / BLOCK) {
            let group = &mut groups[points[0] as usize / BLOCK];
            (group.due, group.watches) = (first..first + points.len(), watches);
            first += points.len();
        }
        let (trees, span) = ((&search.faces, &search.lines), pairing.span);
        let mut looks = std::mem::take(&mut pairing.work.looks);
        looks.resize_with(groups.len().max(looks.len()), Vec::new);
        let pieces = groups.par_iter_mut().zip(&mut looks);
        pieces.for_each(|(group, looks)| {
            for &point in &due[std::mem::take(&mut group.due)] {
                looks.push(self.look((places, near, reach), trees, (point, span), group));
            }
        });
        for (group, looks) in groups.iter_mut().zip(&mut looks) {
            search.scratch.projections += std::mem::take(&mut group.scratch.projections);
            for look in looks.iter() {
                let k = look.point as usize;
                rest.lay(look.point, look.clearance);
                if look.stencil.is_some() {
                    let (at, area) = (near.first + k, self.points[k].area);
                    pairing.place(places, (at, area), look.stencil.as_ref());
                    pairing.rows.shift(at, self.offset(k));
                    pairing.keep(at, area, reach.near);
                }
            }
            looks.clear();
        }
        pairing.work.looks = looks;
    }

    fn look(
        &self,
        (places, near, reach): (&Places, &Near, Reach),
        (tree, lines): (&FaceTree, &Lines),
        (number, span): (u32, [f64; 2]),
        group: &mut Group,
    ) -> Look {
        let point = &self.points[number as usize];
        let (stencil, clearance) = match &self.target {
            Target::Rigid(obstacle) => {
                // no place of a line or a face is nearer than this, wherever its nearest one counts
                let (nearest, _) = obstacle.faced_by(point, places);
                let distance = obstacle.at(places.time).distance_of(&nearest, places);
                let gap = distance.gap + self.offset(number as usize) - point.radius;
                let stencil = match gap <= reach.near {
                    true => Stencil::on_obstacle(places, point, obstacle, span),
                    false => None,
                };
                let clearance = if gap == f64::INFINITY {
                    0.0
                } else {
                    gap - reach.watched
                };
                (stencil, clearance)
            }
            Target::Surface(_) if point.edge().is_some() => {
                self.look_at_edge((places, lines), reach, number as usize)
            }
            Target::Surface(faces) if point.crosses() => {
                let found = tree.crossed(places, faces, point);
                let stencil = found.map(|found| Stencil::opposite_to(places, &found));
                (stencil, 0.0)
            }
            Target::Surface(faces) => {
                self.look_at((places, faces), tree, (near, reach, number), group)
            }
        };
        Look {
            point: number,
            clearance,
            stencil,
        }
    }

    /// What a point faces on a surface, and how far both sides may come before it is looked at again, m.
    fn look_at(
        &self,
        target: (&Places, &[Face]),
        tree: &FaceTree,
        (near, reach, number): (&Near, Reach, u32),
        group: &mut Group,
    ) -> (Option<Stencil>, f64) {
        let k = number as usize;
        let (point, view, inside) = (&self.points[k], self.view(k), (near.inside)(k));
        let (x, limit) = (
            point.place(target.0),
            self.limit(k, reach.watched, reach.wide),
        );
        let behind = || point.behind(target.0);
        let stand = Stand {
            x: &x,
            of: Some(&behind),
        };
        let question = Question {
            x,
            of: stand.of,
            view,
            within: match view.is_some() && !inside {
                true => limit,
                false => f64::INFINITY,
            },
            guess: None,
        };
        let slot = k % BLOCK;
        if let Some(held) = group.ways.get(slot).and_then(|way| way.held) {
            let (foot, face) = tree.held(target, (stand, view), held);
            let near = foot.gap - point.radius + self.offset(k) <= reach.near;
            let stencil = near.then(|| Stencil::on_face(target.0, point, &x, &foot, face));
            return (stencil, 0.0);
        }
        if group.kept.len() <= slot {
            group.kept.resize_with(BLOCK, Kept::default);
        }
        let mut found = tree.closest(target, &question, &mut group.kept[slot], &mut group.scratch);
        let start = near.start.filter(|_| !inside).map(|places| Start {
            places,
            x: point.place(places),
        });
        let kept = &mut group.kept[slot].face;
        if let (Some((foot, _)), Some(item), Some(start)) = (&found, *kept, &start)
            && foot.gap < 0.0
            && let Some((item, foot)) = tree.come_through(target, &question, start, item)
        {
            *kept = Some(item);
            found = Some((foot, &target.1[item as usize]));
        }
        if let (true, Some((foot, face)), Some(item)) =
            (group.watches, &found, group.kept[slot].face)
            && faces_point((stand, foot), face, view.is_none(), || {
                target.0.of_face(face)
            })
            && is_between(target.0, foot, face)
        {
            if group.ways.len() <= slot {
                group.ways.resize_with(BLOCK, Way::default);
            }
            group.ways[slot].goes(item);
        }
        let is_near = |distance: f64| inside || distance <= limit;
        match (found, view) {
            (Some((foot, face)), _) if is_near(foot.distance) => {
                let faces = faces_point((stand, &foot), face, view.is_none(), || {
                    target.0.of_face(face)
                });
                let near = faces && foot.gap - point.radius + self.offset(k) <= reach.near;
                let stencil = near.then(|| Stencil::on_face(target.0, point, &x, &foot, face));
                (stencil, 0.0)
            }
            (None, _) if inside => (None, 0.0),
            (_, Some(view)) => (
                None,
                tree.rest_of(
                    target,
                    (Some(view), &x),
                    [limit, self.limit(k, reach.most, reach.wide)],
                ),
            ),
            // both sides move
            (Some((foot, _)), None) => (None, 0.5 * (foot.distance - limit)),
            (None, None) => (None, f64::INFINITY),
        }
    }

    /// What the edge of a point faces, and how far both sides may come before it is looked at again, m.
    fn look_at_edge(
        &self,
        (places, lines): (&Places, &Lines),
        reach: Reach,
        k: usize,
    ) -> (Option<Stencil>, f64) {
        let Some(edges) = &self.edges else {
            return (None, f64::INFINITY);
        };
        let wide = SQRT_2 * edges.widest();
        let limit = (self.limit(k, reach.watched, 0.0) + wide).max(edges.depth());
        let limit = limit.min(edges.reach());
        let most = (self.limit(k, reach.most, 0.0) + wide).max(2.0 * limit);
        // whether edges meet may change with any motion, their distance may not
        let apart = self
            .distance_of_edges((places, &lines.tree), k, most)
            .unwrap_or(most);
        if apart > limit {
            return (None, 0.5 * (apart - limit));
        }
        let found = self.opposite_edge((places, lines), k, limit);
        let is_near = |found: &Opposite| found.foot.gap + self.offset(k) <= reach.near;
        let near = found.filter(is_near);
        let stencil = near.map(|found| Stencil::opposite_to(places, &found));
        (stencil, 0.0)
    }

    /// Distance from which on nothing is looked at, m: a foot may lie as far sideways as along the normal. `wide`: the most that a face is thick beyond
    /// its place, m.
    pub(super) fn limit(&self, point: usize, reach: f64, wide: f64) -> f64 {
        let beside = self.points[point].radius - self.offset(point);
        SQRT_2 * (reach + beside.max(0.0) + wide)
    }
}
