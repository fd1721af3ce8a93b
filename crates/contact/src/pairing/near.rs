//! The points of a contact that are within a reach of what they face; the others cost nothing while they are far.

use std::f64::consts::SQRT_2;

use carom_mesh::Face;

use super::Pairing;
use crate::rest::Rest;
use crate::search::{foot_on, spread};
use crate::{Contact, Edges, Integration, Places, Point, Search, Sight, Sliding, Target};

/// What a pairing of the near points of a contact is given.
pub struct Near<'a> {
    /// Number of the contact's first point in the pairing.
    pub first: usize,
    /// Largest gap that is looked at, m.
    pub reach: f64,
    /// The step of this pairing; none where all within reach count, however far nodes have moved.
    pub step: Option<Step>,
    /// Where nodes were at the start of the step; none where no step is under way.
    pub start: Option<&'a Places<'a>>,
    /// Whether a point, by its number in the contact, was inside at the last step: it may then be so at any depth.
    pub inside: &'a (dyn Fn(usize) -> bool + Sync),
    /// Points of a contact of small sliding where all nodes are at their reference places.
    pub initial: &'a Pairing,
    /// What is looked at, the others facing nothing; none for all points. Given some, all within `reach` count: how far others move is
    /// not known ([`Contact::reach`]).
    pub own: Option<OwnPart<'a>>,
}

/// The part of a contact that one of several processes looks at.
#[derive(Clone, Copy, Debug)]
pub struct OwnPart<'a> {
    /// Points that are looked at, by their numbers in the contact, ascending. What they may face is known to the process.
    pub points: &'a [u32],
    /// Nodes whose motion bounds that of the contact, ascending: those of these points and of the faces, and others perhaps.
    pub nodes: &'a [u32],
}

/// The step of a pairing of near points.
#[derive(Clone, Copy)]
pub struct Step {
    /// Whether the last pairing was not that of the step before.
    pub begins: bool,
    /// Whether this is its end: no gap counts that cannot have closed since the start or close in the next step.
    pub at_end: bool,
}

/// Gaps that matter in a pairing, m.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    /// Points up to it are near.
    pub near: f64,
    /// Points beyond it may rest.
    pub watched: f64,
    /// The largest that the first two can be.
    pub most: f64,
    /// The most that a face is thick beyond its place.
    pub wide: f64,
}

impl Pairing {
    /// Makes these the points of contacts that face nothing.
    pub fn open_all<'a>(&mut self, contacts: impl IntoIterator<Item = &'a Contact>, dim: usize) {
        self.clear();
        self.dim = dim;
        let points = contacts.into_iter().flat_map(|contact| &contact.points);
        self.areas.extend(points.map(|point| point.area));
        self.spans.resize(self.areas.len(), [0; 2]);
        self.rows.open_all(self.areas.len());
        for rows in &mut self.tangents[..dim - 1] {
            rows.open_all(self.areas.len());
        }
    }

    /// Appends the points of a contact, which face nothing; the number of the first.
    fn append_open(&mut self, contact: &Contact, dim: usize) -> usize {
        self.dim = dim;
        let first = self.len();
        for (at, point) in (first..).zip(&contact.points) {
            self.begin(at, point.area);
            self.open(at);
        }
        first
    }

    /// Lets the near points face nothing, before the contacts are paired anew.
    pub fn reopen(&mut self) {
        self.rows.reopen(self.near.iter().copied());
        for rows in &mut self.tangents[..self.dim - 1] {
            rows.reopen(self.near.iter().copied());
        }
        for &point in &self.near {
            self.spans[point as usize] = [0; 2];
        }
        self.terms.clear();
        self.stencils.clear();
        self.near.clear();
    }

    /// Points that face something within reach, ascending.
    pub fn near(&self) -> &[u32] {
        &self.near
    }

    /// Keeps a point that was paired if its gap is within reach.
    pub(super) fn keep(&mut self, at: usize, area: f64, reach: f64) {
        if self.rows.gap(at) <= reach {
            self.near.push(at as u32);
        } else if self.rows.gap(at) < f64::INFINITY {
            self.areas[at] = area;
            self.spans[at] = [0; 2];
            self.open(at);
        }
    }
}

impl Contact {
    /// Mean diagonal of the faces of both sides, m; infinite where they have none. `x`: reference coordinates by system number, m.
    pub fn mean_diagonal(&self, secondary: &[Face], x: &[[f64; 3]]) -> f64 {
        let target = match &self.target {
            Target::Surface(faces) => &faces[..],
            Target::Rigid(_) => &[],
        };
        let faces = secondary.iter().chain(target);
        let (mut sum, mut count) = (0.0, 0.0);
        for face in faces.filter(|face| face.kind.table().dim > 0) {
            sum += crate::sight::bounds(face, x).diagonal();
            count += 1.0;
        }
        if count > 0.0 {
            sum / count
        } else {
            f64::INFINITY
        }
    }

    /// Pairs the points whose gap is within reach, in a pairing that has all points of its contacts and in which those of this
    /// one face nothing ([`Pairing::reopen`]). Gap, rows and tangents of a near point are those of [`Contact::pair_fully`], or
    /// with small sliding those of [`Pairing::append_moved`]; all others face nothing, also points that are deeper than the reach
    /// without having been inside. A point that was not, and is behind a face now that it was behind at the start, faces the one that it has come through.
    ///
    /// What `search` holds from before does not matter to the result.
    pub fn pair_near(
        &self,
        places: &Places,
        search: &mut Search,
        near: &Near,
        pairing: &mut Pairing,
    ) {
        search.forget_ways();
        self.pair_due(places, search, near, pairing);
    }

    /// The same, of an iteration of a step: points that it has made stay with a face do.
    fn pair_due(&self, places: &Places, search: &mut Search, near: &Near, pairing: &mut Pairing) {
        let mut rest = std::mem::take(&mut search.rest);
        let mut due = std::mem::take(&mut search.due);
        let small = self.sliding == Sliding::Small;
        let mortar = matches!((self.integration, &self.mortar), (Integration::Mortar { .. }, Some(mortar)) if !mortar.is_ends());
        // with small sliding all depends on the initial pairing; mortar points rest together
        let units = if mortar && !small {
            1
        } else {
            self.points.len()
        };
        search.begin();
        if let (Some(step), Some(start)) = (near.step, near.start)
            && (step.begins || !rest.is_for(units))
        {
            self.travel(&mut rest, (units, near.own), start);
        }
        self.travel(&mut rest, (units, near.own), places);
        let most = near.reach;
        let reach = match (near.step, near.own) {
            (Some(step), None) if step.at_end => self.reach(rest.motion(), most),
            (Some(_), None) if !self.moves() => Rest::least_reach(rest.motion(), most),
            _ => most,
        };
        let most = most.max(reach);
        let watched = rest.watch(reach, most);
        rest.due(&mut due);
        let reach = Reach {
            near: reach,
            watched,
            most,
            wide: if due.is_empty() { 0.0 } else { self.widest() },
        };
        if !due.is_empty() {
            if rest.motion() == f64::INFINITY {
                search.forget_boxes();
            }
            if let (Target::Surface(faces), false) = (&self.target, small) {
                let lines = self.edges.as_ref().map_or(&[][..], Edges::lines);
                search.renew_near(places, (faces, lines), rest.travelled());
            }
            match (small, mortar) {
                (true, _) => self.move_near(
                    (places.u, near, reach),
                    &due,
                    |point, c| rest.lay(point, c),
                    pairing,
                ),
                (false, true) => {
                    let clearance = self.pair_mortar_near(places, search, (near, reach), pairing);
                    rest.lay(0, clearance);
                }
                (false, false) => {
                    let given = (places, near, reach);
                    self.look_at_all(given, (search, &due), &mut rest, pairing);
                }
            }
            rest.close(&due);
        }
        (search.rest, search.due) = (rest, due);
    }

    /// Appends the points of a contact of finite sliding, in a step that began with the places of `start`. Those are looked for whose gap is within `reach` (m), and those that were
    /// `inside` the other side before: they are as [`Contact::pair_fully`] has them. All others face nothing, also those that are deeper
    /// than the reach.
    ///
    /// What `search` holds from before does not matter to the result, but for the points that [`Search::begin_step`] lets it hold.
    pub fn append_near(
        &self,
        places: &Places,
        search: &mut Search,
        (start, reach, inside): (Option<&Places>, f64, &(dyn Fn(usize) -> bool + Sync)),
        pairing: &mut Pairing,
    ) {
        let near = Near {
            first: pairing.append_open(self, places.dim()),
            reach,
            step: None,
            start,
            inside,
            initial: &Pairing::default(),
            own: None,
        };
        self.pair_due(places, search, &near, pairing);
    }

    /// Appends the points of a contact whose sides are known to be apart: all face nothing.
    pub fn append_apart(&self, dim: usize, search: &mut Search, pairing: &mut Pairing) {
        pairing.append_open(self, dim);
        search.rest_anew();
    }

    /// Largest penetration that counts as contact where the points have a sight, m.
    pub fn deepest(&self) -> Option<f64> {
        self.sight.as_ref().map(Sight::deepest)
    }

    /// Distance of the middles of thin bodies whose surfaces touch, m: a point that crosses that of the other side in a step is on
    /// its far side, and was never inside. `None` where the other side is no middle.
    pub fn distance_of_middles(&self) -> Option<f64> {
        let faces = match &self.target {
            Target::Surface(faces) => &faces[..],
            Target::Rigid(_) => &[],
        };
        let round = faces.iter().filter(|face| face.is_round());
        let other = round.filter_map(|face| face.radius).reduce(f64::max)?;
        // of a surface with both kinds of faces shells touch solids
        let own = match faces.iter().all(Face::is_round) || !self.looks_both_ways() {
            true => self
                .points
                .iter()
                .map(|point| point.radius)
                .fold(0.0, f64::max),
            false => 0.0,
        };
        Some(own + other)
    }

    /// Whether points can get behind the other side so far that they are not pushed back: neither those of obstacles nor those that keep their
    /// faces.
    pub fn may_be_passed(&self) -> bool {
        self.sliding == Sliding::Finite && matches!(self.target, Target::Surface(_))
    }

    /// How deep a point may be behind the other side and still be pushed back, m; `None` for any depth.
    pub fn depth_of_hold(&self) -> Option<f64> {
        let middles = || self.distance_of_middles().or_else(|| self.deepest());
        self.may_be_passed().then(middles).flatten()
    }

    /// The most that a point or a face is thick beyond its place, less what is added to gaps, m.
    pub fn thickest(&self) -> f64 {
        let points = self.points.iter().enumerate();
        let beyond = |(k, point): (usize, &Point)| point.radius - self.offset(k);
        points.map(beyond).fold(0.0, f64::max) + self.widest()
    }

    /// The most that a face of the other side is thick beyond its place, m.
    pub(super) fn widest(&self) -> f64 {
        let target = match &self.target {
            Target::Surface(faces) => &faces[..],
            Target::Rigid(_) => &[],
        };
        let radii = target.iter().filter_map(|face| face.radius);
        radii.fold(0.0, f64::max)
    }

    /// Gap up to which points count in a pairing one step after the last, m: at most `most`, or what both sides can have come closer by. `motion`:
    /// the most that a node of either side has moved in the step, m ([`Search::motion`]).
    pub fn reach(&self, motion: f64, most: f64) -> f64 {
        match self.moves() {
            true => most,
            false => Rest::reach(motion, most),
        }
    }

    /// Bounds the motion since the last pairing.
    fn travel(&self, rest: &mut Rest, (units, own): (usize, Option<OwnPart>), places: &Places) {
        let obstacle = match &self.target {
            Target::Rigid(obstacle) => Some(obstacle),
            Target::Surface(_) => None,
        };
        let displacement = obstacle.map(|obstacle| obstacle.displacement(places.time));
        if rest.is_for(units) {
            rest.travel(places, displacement);
        } else {
            let (mut nodes, spread) = self.nodes();
            if let Some(own) = own {
                nodes = own.nodes.to_vec();
            }
            let own = own.map(|own| own.points);
            *rest = Rest::begin((units, own), (nodes, spread), places, displacement);
        }
        // no bound is known of what turns
        if obstacle.is_some_and(|obstacle| obstacle.motion.turn.is_some()) {
            rest.wake_all();
        }
    }

    /// Nodes of both sides, each once, ascending, and the most that Σ |N_a| is on their faces.
    pub fn nodes(&self) -> (Vec<u32>, f64) {
        let own = self.points.iter().flat_map(|point| point.carriers());
        let mut nodes: Vec<u32> = own.map(|(node, _)| node).collect();
        let secondary = self.mortar.iter().flat_map(|mortar| &mortar.faces);
        let target = match &self.target {
            Target::Surface(faces) => &faces[..],
            Target::Rigid(_) => &[],
        };
        let straight = |point: &Point| point.carriers().count() <= 4;
        let mut most: f64 = if self.points.iter().all(straight) {
            1.0
        } else {
            3.0
        };
        for face in secondary.chain(target) {
            nodes.extend(face.corners());
            most = most.max(spread(face.kind));
        }
        nodes.sort_unstable();
        nodes.dedup();
        (nodes, most)
    }

    /// The points of a contact of small sliding, whose gaps are linear in the displacement.
    fn move_near(
        &self,
        (u, near, reach): (&[f64], &Near, Reach),
        due: &[u32],
        mut lay: impl FnMut(u32, f64),
        pairing: &mut Pairing,
    ) {
        let moves = self.moves();
        for &point in due {
            let (k, at) = (point as usize, near.first + point as usize);
            let rows = &near.initial.rows;
            let gap = rows.gap(k) + rows.product(k, u);
            // a row sums up to nothing against a surface: what all nodes share does not move the gap
            let norm: f64 = rows.row(k).1.iter().map(|c| c.abs()).sum();
            let clearance = match moves {
                true => 0.0,
                false if gap == f64::INFINITY => f64::INFINITY,
                false => (gap - reach.watched) / norm.max(1.0),
            };
            lay(point, clearance);
            if gap <= reach.near {
                pairing.rows.place_from(at, rows, k);
                pairing.rows.set_gap(at, gap);
                let tangents = pairing.tangents.iter_mut().zip(&near.initial.tangents);
                for (rows, initial) in tangents.take(pairing.dim - 1) {
                    rows.place_from(at, initial, k);
                }
                pairing.near.push(at as u32);
            }
        }
    }

    /// The multipliers of a mortar contact; how far both sides may come before they are looked at again, m.
    fn pair_mortar_near(
        &self,
        places: &Places,
        search: &mut Search,
        (near, reach): (&Near, Reach),
        pairing: &mut Pairing,
    ) -> f64 {
        let kept = pairing.near.len();
        if let Target::Surface(faces) = &self.target {
            let given = (places, &faces[..]);
            search.faces.see_all(self.sight.as_ref(), given);
        }
        self.pair_points(places, search, (near.first, pairing));
        for (k, point) in self.points.iter().enumerate() {
            let at = near.first + k;
            pairing.rows.shift(at, self.offset(k));
            pairing.keep(at, point.area, reach.near);
        }
        // bounds of distances leave sight out
        match pairing.near.len() > kept || self.has_both_sides() {
            true => 0.0,
            false => self.mortar_clearance(places, search, reach.watched),
        }
    }

    fn mortar_clearance(&self, places: &Places, search: &mut Search, reach: f64) -> f64 {
        let faces = self.mortar.iter().flat_map(|mortar| &mortar.faces);
        let mut least = f64::INFINITY;
        for face in faces {
            let x = places.of_face(face);
            let x = &x[..face.corners().len()];
            let middle = [0, 1, 2].map(|i| x.iter().map(|x| x[i]).sum::<f64>() / x.len() as f64);
            let square = |x: &[f64; 3]| (0..3).map(|i| (x[i] - middle[i]).powi(2)).sum::<f64>();
            let bounds = carom_mesh::Bounds::of_face(face.kind, x);
            let radius = [bounds.min, bounds.max]
                .iter()
                .map(square)
                .fold(0.0, f64::max)
                .sqrt();
            let distance = match &self.target {
                Target::Surface(faces) => {
                    let measure = |item| foot_on(places, faces, item, &middle).0.distance;
                    let item = search.faces.nearest(&middle, 0.0, measure);
                    item.map_or(f64::INFINITY, measure)
                }
                Target::Rigid(obstacle) => {
                    let gap = obstacle.at(places.time).distance(&middle).gap;
                    if gap == f64::INFINITY { 0.0 } else { gap }
                }
            };
            least = least.min(distance - radius);
        }
        0.5 * (least - SQRT_2 * (reach + self.thickest()))
    }
}
