//! Whether bodies passed through each other in accepted steps, contact between them or not.
//!
//! Each pair of bodies, or of a body and the rigid shape that it meets, has a distance that both may still move towards each other before their cores can
//! meet. Each step takes the largest relative motion of their nodes from it; the pair is looked at again in the step in which that uses it up.

mod mover;
mod sides;
pub(crate) mod told;

use std::collections::BTreeSet;

use carom_contact::certificate::{Core, Look, Moved, Room, look, overlap};
use carom_contact::law::Level;
use carom_mesh::{Bounds, Face};

use crate::state::State;
use crate::system::{Motion, System};
use mover::{Mover, relative};
use sides::{Side, Sides};
use told::Pair;
pub use told::{Crossing, Told};

/// Part of the depth to which surfaces may go into each other that they move in a step in which a contact sees them meet: a law in the rate acts at
/// the end of the step after the one in which they do.
const SEEN: f64 = 0.25;

/// Pairs up to which all are followed; of more those that are near.
const FOLLOWED: usize = 2000;

/// Looks at the steps of a run: at an attempt, which is then taken or dropped. What it finds is part of the states.
#[derive(Debug)]
pub struct Certificate {
    movers: Vec<Mover>,
    sides: Sides,
    /// What was told when it began, of states before the first look.
    begun: Told,
    /// Farthest that the boxes of a followed pair are apart, m; infinite where all are followed.
    near: f64,
    room: Room,
    /// Room for the vertices of a pair at the start and the end of a step, m.
    shrunk: [[Vec<[f64; 3]>; 2]; 2],
}

/// What a certificate has found in a run, and of whom.
#[derive(Clone, Debug)]
pub struct Findings {
    /// What it has found.
    pub told: Told,
    sides: Sides,
}

impl Findings {
    /// Whether there is a pair of bodies, or of a body and a shape, that is looked at.
    pub fn looks(&self, system: &System) -> bool {
        let overlapping = &self.told.overlapping;
        let mut pairs = self.sides.pairs();
        pairs
            .any(|of| !self.sides.leaves_out(system, of) && overlapping.binary_search(&of).is_err())
    }

    /// The two that a pair of numbers is of, by name.
    pub fn names(&self, system: &System, of: [u32; 2]) -> String {
        self.sides.names(system, of)
    }

    /// Pairs whose cores meet at the start: bodies that go into each other there, or are joined in one place.
    pub fn overlapping(&self) -> &[[u32; 2]] {
        &self.told.overlapping
    }

    /// Pairs of bodies that are not looked at, since links join them or the gaps of their contact count from elsewhere.
    pub fn joined<'a>(&'a self, system: &'a System) -> impl Iterator<Item = [u32; 2]> + 'a {
        self.sides.joined(system)
    }
}

impl Certificate {
    /// Of a run at a state; none where nobody has looked at the steps before that.
    pub fn of(system: &System, state: &State) -> Option<Certificate> {
        if state.crossings.is_none() && state.step > 0 {
            return None;
        }
        let mut certificate = Certificate::at(system, (state.time, &state.motion));
        certificate.begun = match &state.crossings {
            Some(told) => told.clone(),
            None => certificate.told_at_start(system),
        };
        Some(certificate)
    }

    /// What there is to tell of the first state of a run.
    fn told_at_start(&mut self, system: &System) -> Told {
        let mut told = Told::default();
        self.choose(system, &mut told, 0.0);
        let pairs = std::mem::take(&mut told.pairs);
        for pair in pairs {
            match self.overlaps_at_start(system.dim, pair.of) {
                true => told.overlapping.push(pair.of),
                false => told.pairs.push(pair),
            }
        }
        told
    }

    fn at(system: &System, (time, motion): (f64, &Motion)) -> Certificate {
        let cores = system.cores();
        let sides = Sides::of(system, &cores);
        let mut movers: Vec<Mover> = cores.into_iter().map(|of| Mover::new(system, of)).collect();
        for mover in &mut movers {
            mover.take(system, (time, motion));
            mover.earlier.clone_from(&mover.nodes);
        }
        let count = movers.len();
        let near = match count * count.saturating_sub(1) / 2 > FOLLOWED {
            true => {
                let sizes = movers.iter().map(|mover| mover.size_at_rest(system));
                sizes.sum::<f64>() / count as f64
            }
            false => f64::INFINITY,
        };
        Certificate {
            sides,
            near,
            begun: Told::default(),
            room: Room::default(),
            shrunk: Default::default(),
            movers,
        }
    }

    /// Pairs of bodies without a contact that meet within a time `span` (s) if each goes on at its mean velocity at the start, without turning; of
    /// many bodies of those that are near at the start.
    pub fn ahead(system: &System, span: f64) -> Vec<(String, f64)> {
        let start = Motion {
            u: system.initial.displacement.clone(),
            v: system.initial.velocity.clone(),
            frames: system.initial.frames.clone(),
            ..Motion::default()
        };
        let moves = |body: usize| system.mean_velocity(body, &start.v);
        let mut bodies = 0..system.bodies.len();
        if bodies
            .next()
            .is_none_or(|first| bodies.all(|body| moves(body) == moves(first)))
        {
            return Vec::new();
        }
        let mut certificate = Certificate::at(system, (0.0, &start));
        let mut told = Told::default();
        certificate.choose(system, &mut told, 0.0);
        for (number, mover) in certificate.movers.iter_mut().enumerate() {
            let v = certificate
                .sides
                .body(number as u32)
                .map_or([0.0; 3], moves);
            for x in &mut mover.nodes {
                *x = [0, 1, 2].map(|i| x[i] + span * v[i]);
            }
        }
        let mut met = Vec::new();
        for Pair { of, .. } in told.pairs {
            let bodies = of.map(|number| certificate.sides.body(number));
            if bodies.contains(&None) || certificate.overlaps_at_start(system.dim, of) {
                continue;
            }
            let found = certificate.seen(system.dim, of);
            let when = found.met.map(|met| met.part * span);
            let when = when.filter(|_| certificate.contact_of(system, of).is_none());
            met.extend(when.map(|when| (certificate.sides.names(system, of), when)));
        }
        met
    }

    /// What was found until a state, with names.
    pub fn findings(&self, state: &State) -> Findings {
        Findings {
            told: state.crossings.as_ref().unwrap_or(&self.begun).clone(),
            sides: self.sides.clone(),
        }
    }

    /// Looks at the end of an attempt at a step, the state at `time` (s) after the last one that was taken, that at `before` (s) until which this was
    /// `told`; `next`: what is told then. Whether two that a contact is between go through each other, and move by more than surfaces may go into each
    /// other: they may not in a smaller step. How deep they go under the force of a law that yields is for that.
    pub fn look_at(
        &mut self,
        system: &System,
        (told, before): (Option<&Told>, f64),
        (time, end): (f64, &State),
        next: &mut Told,
    ) -> bool {
        next.follow(told.unwrap_or(&self.begun));
        if self.movers.len() < 2 {
            return false;
        }
        let mut all = Bounds::EMPTY;
        for mover in &mut self.movers {
            mover.take(system, (time, &end.motion));
            all = all.union(&mover.motion);
        }
        if self.near.is_finite() {
            next.left -= all.diagonal();
            if next.left <= 0.0 {
                self.choose(system, next, all.diagonal());
            }
        }
        let mut pairs = std::mem::take(&mut next.pairs);
        let mut cuts = false;
        pairs.retain_mut(|pair| {
            let [one, other] = pair.of.map(|number| &self.movers[number as usize].motion);
            pair.left -= relative(one, other);
            if pair.left > 0.0 {
                return true;
            }
            let crossing = self.look(system, (end, [before, time]), (pair, &mut next.tested));
            cuts |= crossing
                .as_ref()
                .is_some_and(|crossing| self.may_be_cut(system, crossing));
            next.crossings.extend(crossing.clone());
            crossing.is_none()
        });
        next.pairs = pairs;
        cuts
    }

    /// The attempt that was looked at last is taken.
    pub fn accept(&mut self) {
        self.movers.iter_mut().for_each(Mover::accept);
    }

    /// Goes back to a state.
    pub(crate) fn go_back(&mut self, system: &System, state: &State) {
        for mover in &mut self.movers {
            mover.start_from(system, state);
        }
    }

    /// The state that was taken, whose frames have been turned since: what they carry starts the next step from its bits.
    pub(crate) fn start_from(&mut self, system: &System, state: &State) {
        for mover in self.movers.iter_mut().filter(|mover| mover.is_carried) {
            mover.start_from(system, state);
        }
    }

    /// Looks at a pair: where and when the two meet, if they do.
    fn look(
        &mut self,
        system: &System,
        (end, [before, time]): (&State, [f64; 2]),
        (pair, tested): (&mut Pair, &mut u64),
    ) -> Option<Crossing> {
        for number in pair.of {
            self.movers[number as usize].place();
        }
        let found = self.seen(system.dim, pair.of);
        *tested += found.tested;
        pair.left = found.apart;
        let met = found.met?;
        let contact = self.contact_of(system, pair.of);
        let is_held = |contact: usize| self.is_held(system, (time, end), (contact, pair.of));
        Some(Crossing {
            of: pair.of,
            contact,
            held: contact.is_some_and(is_held),
            time: before + met.part * (time - before),
            place: met.place,
        })
    }

    /// Whether a smaller step may keep the two apart.
    fn may_be_cut(&self, system: &System, crossing: &Crossing) -> bool {
        let Some(contact) = crossing.contact else {
            return false;
        };
        let of = crossing.of.map(|number| &self.movers[number as usize]);
        let limit = most_unseen(of.map(|mover| &mover.of.core), crossing.held);
        let yields = system.contacts[contact].law.get().level() == Level::GapAndRate;
        // without a depth nobody knows
        limit > 0.0 && relative(&of[0].motion, &of[1].motion) > limit && !(crossing.held && yields)
    }

    /// The contact between two: of bodies the first that has faces of one on a side and of the other on the other.
    fn contact_of(&self, system: &System, of: [u32; 2]) -> Option<usize> {
        let on = |faces: &[Face], number: u32| {
            let own = self.movers[number as usize].of.core.nodes();
            let has = |node: &u32| own.binary_search(node).is_ok();
            faces.iter().any(|face| face.corners().iter().all(has))
        };
        match of.map(|number| self.sides.all[number as usize]) {
            [Side::Body(_), Side::Body(_)] => {
                let mut contacts = system.contacts.iter();
                contacts.position(|contact| {
                    let (own, target) = (&contact.secondary_faces, contact.primary_faces());
                    let both = |a: u32, b: u32| on(own, a) && on(target, b);
                    both(of[0], of[1]) || both(of[1], of[0])
                })
            }
            [_, Side::Shape(contact)] | [Side::Shape(contact), _] => Some(contact),
        }
    }

    /// Whether a point of one of two that is near the other has a force of their contact.
    fn is_held(
        &self,
        system: &System,
        (time, end): (f64, &State),
        (contact, of): (usize, [u32; 2]),
    ) -> bool {
        let motion = &end.motion;
        let places = system.places(time, &motion.u, &motion.frames);
        let points = system.points_of(contact);
        let mut carrying = points.filter(|point| end.interface.force[*point] > 0.0);
        carrying.any(|point| {
            let (_, own) = system.point(point);
            let point = &system.contacts[contact].points[own];
            let x = Bounds::of(&[point.place(&places)]);
            [[0, 1], [1, 0]].into_iter().any(|pair| {
                let [one, other] = pair.map(|k| &self.movers[of[k] as usize]);
                let has = one.of.core.nodes().binary_search(&point.node()).is_ok();
                let reach = 1.1 * other.of.core.most_kept();
                has && Bounds::of(&other.nodes).widened(reach).overlaps(&x)
            })
        })
    }

    fn overlaps_at_start(&mut self, dim: usize, of: [u32; 2]) -> bool {
        for number in of {
            self.movers[number as usize].place();
        }
        let moved = moved((&self.movers, of), &mut self.shrunk);
        overlap(moved, dim, &mut self.room)
    }

    /// What a look at two that are placed finds.
    fn seen(&mut self, dim: usize, of: [u32; 2]) -> Look {
        let moved = moved((&self.movers, of), &mut self.shrunk);
        look(moved, dim, &mut self.room)
    }

    /// Chooses the pairs that are followed of what is told, by where they were at the start of the step. `motion`: the most that any two have moved in it, m.
    fn choose(&self, system: &System, told: &mut Told, motion: f64) {
        let boxes: Vec<Bounds> = self.movers.iter().map(Mover::reach).collect();
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        order.sort_by(|a, b| {
            let least = |number: u32| boxes[number as usize].min[0];
            least(*a).total_cmp(&least(*b)).then(a.cmp(b))
        });
        let old = std::mem::take(&mut told.pairs);
        let met = told.crossings.iter().map(|crossing| crossing.of);
        let met: BTreeSet<[u32; 2]> = met.collect();
        // those that may come near in the step too
        let near = self.near + motion;
        for (place, &one) in order.iter().enumerate() {
            let end = boxes[one as usize].max[0] + near;
            for &other in &order[place + 1..] {
                if boxes[other as usize].min[0] > end {
                    break;
                }
                let of = [one.min(other), one.max(other)];
                let apart = boxes[one as usize].apart(&boxes[other as usize]);
                let is_out = || {
                    self.sides.leaves_out(system, of)
                        || told.overlapping.binary_search(&of).is_ok()
                        || met.contains(&of)
                };
                if apart > near || is_out() {
                    continue;
                }
                let known = old.binary_search_by(|pair| pair.of.cmp(&of));
                let left = known.map_or(apart, |k| old[k].left);
                told.pairs.push(Pair { of, left });
            }
        }
        told.pairs.sort_by_key(|pair| pair.of);
        told.left = self.near;
    }
}

/// Two that are placed, each as deep below its surface as the other allows.
fn moved<'a>(
    (movers, of): (&'a [Mover], [u32; 2]),
    [first, second]: &'a mut [[Vec<[f64; 3]>; 2]; 2],
) -> [Moved<'a>; 2] {
    let [one, other] = of.map(|number| &movers[number as usize]);
    [
        one.against(&other.of.core, first),
        other.against(&one.of.core, second),
    ]
}

/// How far two may move towards each other in a step, m, where a smaller one would not show a contact more of what it has missed. Where they have a force
/// already (`held`) that is more: a smaller step makes the force of an impulse larger.
fn most_unseen([one, other]: [&Core; 2], held: bool) -> f64 {
    match held {
        true => one.half().min(other.half()),
        false => {
            let margin = |a: &Core, b: &Core| a.margin(a.part_against(b));
            SEEN * (margin(one, other) + margin(other, one))
        }
    }
}
