//! Which edge of the target the edge of a point touches.

use carom_mesh::Projection;

use crate::crossing::{Opposite, between};
use crate::edges::{Meeting, ends_of, meeting, ordered};
use crate::faced::Faced;
use crate::search::faces::FaceTree;
use crate::search::lines::Lines;
use crate::{Contact, Places};

impl Contact {
    /// The edge of the target that the edge of a point touches, within a distance (m): the first of the nearest that meet it. `tree`: of the
    /// edges in this configuration.
    pub(crate) fn opposite_edge(
        &self,
        (places, lines): (&Places, &Lines),
        point: usize,
        within: f64,
    ) -> Option<Opposite<'_>> {
        let (edges, tree) = (self.edges.as_ref()?, &lines.tree);
        let met = self.edges_met((places, tree), (point, &|point| lines.faced(point)), within);
        let place = usize::from(self.points[point].is_second());
        let (item, found) = met[place]?;
        if self.is_told((places, tree), (point, item), within) {
            return None;
        }
        let foot = Projection {
            xi: [found.xi[1], 0.0, 0.0],
            point: found.place,
            normal: found.normal,
            // rows take the radius of the point themselves
            gap: found.gap + self.points[point].radius,
            distance: found.gap.abs(),
            inside: true,
        };
        Some(Opposite {
            point: self.points[point].moved_to(found.xi[0]),
            foot,
            face: &edges.lines[item as usize],
            faced: Some(edges.faced(item, found.is_reversed)),
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
        let line = edges.line_of(places, (&self.points[point], point))?;
        let view = self.view(point);
        let (middle, half) = line.middle();
        let measure = |item: u32| match edges.is_beside(item, (&own.ends, view)) {
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
        let Some(line) = edges.line_of(places, (&self.points[point], point)) else {
            return Vec::new();
        };
        let view = self.view(point);
        let (middle, half) = line.middle();
        let near = tree.near(&middle, half + limit + 2.0 * motion).into_iter();
        let others = near.filter(|&item| !edges.is_beside(item, (&own.ends, view)));
        let with_rest = others.map(|item| {
            let apart = between(&line.ends, &edges.line(places, item).ends).distance;
            (item, (0.5 * (apart - limit)).max(0.0))
        });
        with_rest.filter(|(_, rest)| *rest < motion).collect()
    }

    /// The nearest of the edges of the target that meet the edge of a point, and where: two if the edge has two points, then in the order of the target. A
    /// second one alone is none.
    fn edges_met(
        &self,
        target: (&Places, &FaceTree),
        (point, faced): (usize, &dyn Fn(u32) -> Option<Faced>),
        within: f64,
    ) -> [Option<(u32, Meeting)>; 2] {
        let Some(edges) = &self.edges else {
            return [None, None];
        };
        let (one, two) = edges.firsts[point];
        let stays = |item: u32| {
            let of = |point: u32| edges.remembered(item, faced(point));
            of(one).or_else(|| two.and_then(of))
        };
        let first = self.nearest_edge(target, (point, &stays), (within, None));
        let second = match &first {
            Some((item, _)) if two.is_some() => {
                self.nearest_edge(target, (point, &stays), (within, Some(*item)))
            }
            _ => None,
        };
        match (&first, &second) {
            (Some(one), Some(other)) if other.0 < one.0 => [second, first],
            _ => [first, second],
        }
    }

    /// The first of the edges of the target that meet the edge of a point and are nearest to it, but for one of them, and where.
    fn nearest_edge(
        &self,
        (places, tree): (&Places, &FaceTree),
        (point, stays): (usize, &dyn Fn(u32) -> Option<bool>),
        (within, without): (f64, Option<u32>),
    ) -> Option<(u32, Meeting)> {
        let (edges, own) = (self.edges.as_ref()?, self.points[point].edge()?);
        let line = edges.line_of(places, (&self.points[point], point))?;
        let view = self.view(point);
        let (middle, half) = line.middle();
        let at = |item: u32| match without == Some(item) || edges.is_beside(item, (&own.ends, view))
        {
            true => None,
            false => meeting((&line, &edges.line(places, item)), edges.depth, stays(item)),
        };
        let measure = |item: u32| at(item).map_or(f64::INFINITY, |found| found.distance);
        // no place of the edge is farther from its middle than its half
        let within = within.min(edges.reach);
        let (item, _) = tree.nearest_within((&middle, half), within, measure)?;
        Some((item, at(item)?))
    }

    /// Whether a point of the edge that a point faces faces its edge too by the cones of both, and comes first: both would tell the same.
    fn is_told(
        &self,
        target: (&Places, &FaceTree),
        (point, item): (usize, u32),
        within: f64,
    ) -> bool {
        let Some(edges) = &self.edges else {
            return false;
        };
        let Some(other) = edges.sides[item as usize].point else {
            return false;
        };
        let own = self.points[point].edge();
        let is_own = |(item, _): &(u32, Meeting)| {
            own.is_some_and(|own| ordered(own.ends) == ends_of(&edges.lines[*item as usize]))
        };
        other < edges.firsts[point].0
            && self
                .edges_met(target, (other as usize, &|_| None), within)
                .iter()
                .flatten()
                .any(is_own)
    }
}
