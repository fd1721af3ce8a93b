//! Whether bodies passed through each other in accepted steps, contact between them or not.
//!
//! Each pair of bodies, or of a body and the rigid shape that it meets, has a distance that both may still move towards each other before their cores can
//! meet. Each step takes the largest relative motion of their nodes from it; the pair is looked at again in the step in which that uses it up.

use std::collections::BTreeSet;

use carom_contact::Target;
use carom_contact::certificate::{Moved, Room, look, overlap};
use carom_mesh::{Bounds, Face};
use serde::{Deserialize, Serialize};

use crate::state::State;
use crate::system::{ContactPair, CoreOf, CoreOwner, Motion, System};

type Vec3 = [f64; 3];

/// Pairs up to which all are followed; of more those that are near.
const FOLLOWED: usize = 2000;

/// Looks at the accepted states of a run.
#[derive(Debug)]
pub struct Certificate {
    movers: Vec<Mover>,
    told: Told,
    /// Farthest that the boxes of a followed pair are apart, m; infinite where all are followed.
    near: f64,
    /// Connected parts that links join, ascending.
    linked: BTreeSet<[usize; 2]>,
    /// Contacts whose gaps do not count from the surfaces, or are penetrated as their curve says.
    elsewhere: Vec<bool>,
    /// Pairs of bodies of these, ascending.
    shifted: BTreeSet<[usize; 2]>,
    /// Time of the last state, s.
    time: f64,
    room: Room,
}

/// What a certificate has found, and what it goes on from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Told {
    pairs: Vec<Pair>,
    /// What any two may move relative to each other until pairs are chosen anew, m.
    left: f64,
    /// Pairs that met.
    pub crossings: Vec<Crossing>,
    /// Pairs whose cores meet at the start, ascending.
    overlapping: Vec<[u32; 2]>,
    /// Pairs of nodes, edges and triangles that were looked at.
    pub tested: u64,
}

/// A pair that is followed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Pair {
    of: [u32; 2],
    /// What both may still move towards each other, m.
    left: f64,
}

/// Two that met, for the first time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Crossing {
    /// Their numbers ([`Certificate::names`]).
    pub of: [u32; 2],
    /// The contact that is between them, if there is one.
    pub contact: Option<usize>,
    /// Whether that has a force at the end of the step: how deep it lets them go is told by its records.
    pub held: bool,
    /// When, s.
    pub time: f64,
    /// Where, m.
    pub place: Vec3,
}

/// A core that moves.
#[derive(Debug)]
struct Mover {
    of: CoreOf,
    /// Places of its nodes, m.
    nodes: Vec<Vec3>,
    /// Vertices at the start and at the end of the step, m.
    before: Vec<Vec3>,
    after: Vec<Vec3>,
    /// Places of the nodes at the start of the step.
    earlier: Vec<Vec3>,
    /// Box of the motions of its nodes in the step.
    motion: Bounds,
    /// Whether the vertices are those of this step.
    is_placed: bool,
}

impl Certificate {
    /// Of a run whose first state this is.
    pub fn begin(system: &System, state: &State) -> Certificate {
        let mut certificate = Certificate::new(system, state);
        certificate.choose(system, 0.0);
        let starting = certificate.told.pairs.iter().map(|pair| pair.of);
        let starting: Vec<[u32; 2]> = starting.collect();
        for of in starting {
            if certificate.overlaps_at_start(system.dim, of) {
                certificate.told.overlapping.push(of);
            }
        }
        let told = &mut certificate.told;
        let meet = |pair: &Pair| told.overlapping.binary_search(&pair.of).is_ok();
        told.pairs.retain(|pair| !meet(pair));
        certificate
    }

    /// Of a run that goes on from a state until which this was told; nothing where that is of another system.
    pub fn resume(system: &System, state: &State, told: Told) -> Option<Certificate> {
        let mut certificate = Certificate::new(system, state);
        let movers = certificate.movers.len() as u32;
        let known = |of: &[u32; 2]| of.iter().all(|number| *number < movers);
        let contacts = system.contacts.len();
        let is_of = told.pairs.iter().all(|pair| known(&pair.of))
            && told.overlapping.iter().all(known)
            && told.crossings.iter().all(|crossing| {
                known(&crossing.of) && crossing.contact.is_none_or(|contact| contact < contacts)
            });
        certificate.told = told;
        is_of.then_some(certificate)
    }

    fn new(system: &System, state: &State) -> Certificate {
        Certificate::at(system, (state.time, &state.motion))
    }

    fn at(system: &System, (time, motion): (f64, &Motion)) -> Certificate {
        let movers: Vec<Mover> = system.cores().into_iter().map(Mover::new).collect();
        let count = movers.len();
        let mut certificate = Certificate {
            linked: linked(system),
            shifted: BTreeSet::new(),
            elsewhere: system.contacts.iter().map(is_elsewhere).collect(),
            time,
            near: f64::INFINITY,
            told: Told::default(),
            room: Room::default(),
            movers,
        };
        for (contact, _) in system
            .contacts
            .iter()
            .zip(&certificate.elsewhere)
            .filter(|of| *of.1)
        {
            for (k, &one) in contact.bodies.iter().enumerate() {
                let others = contact.bodies[k..].iter();
                certificate
                    .shifted
                    .extend(others.map(|&other| [one, other]));
            }
        }
        for mover in &mut certificate.movers {
            mover.take(system, (time, motion));
            mover.earlier.clone_from(&mover.nodes);
        }
        if count * count.saturating_sub(1) / 2 > FOLLOWED {
            let movers = certificate.movers.iter();
            let sizes = movers.map(|mover| mover.size_at_rest(system));
            certificate.near = sizes.sum::<f64>() / count as f64;
        }
        certificate
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
        certificate.choose(system, 0.0);
        let pairs = std::mem::take(&mut certificate.told.pairs);
        for mover in &mut certificate.movers {
            let v = mover.body().map_or([0.0; 3], moves);
            for x in &mut mover.nodes {
                *x = [0, 1, 2].map(|i| x[i] + span * v[i]);
            }
        }
        let mut met = Vec::new();
        for Pair { of, .. } in pairs {
            let bodies = of.map(|number| certificate.movers[number as usize].body());
            if bodies.contains(&None) || certificate.overlaps_at_start(system.dim, of) {
                continue;
            }
            let moved = of.map(|number| certificate.movers[number as usize].moved());
            let found = look(moved, system.dim, &mut certificate.room);
            let when = found.met.map(|met| met.part * span);
            let when = when.filter(|_| certificate.contact_of(system, of).is_none());
            met.extend(when.map(|when| (certificate.names(system, of), when)));
        }
        met
    }

    /// What was found, and what the certificate goes on from.
    pub fn told(&self) -> &Told {
        &self.told
    }

    /// Whether there is a pair of bodies, or of a body and a shape, that is looked at.
    pub fn looks(&self, system: &System) -> bool {
        let overlapping = &self.told.overlapping;
        let mut looked = self
            .all_pairs()
            .filter(|of| !self.leaves_out(system, *of) && overlapping.binary_search(of).is_err());
        looked.next().is_some()
    }

    fn all_pairs(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let all = self.movers.len() as u32;
        (0..all).flat_map(move |one| (one + 1..all).map(move |other| [one, other]))
    }

    /// The two that a pair of numbers is of, by name.
    pub fn names(&self, system: &System, of: [u32; 2]) -> String {
        let owners = of.map(|number| &self.movers[number as usize].of.owner);
        let name = |owner: &CoreOwner| match owner {
            CoreOwner::Body(body) => format!("`{}`", system.bodies[*body].name()),
            CoreOwner::Shape(contact, _) => {
                let contact = &system.contacts[*contact].name;
                format!("the obstacle of contact `{contact}`")
            }
        };
        match owners {
            [CoreOwner::Body(one), CoreOwner::Body(other)] if one == other => {
                format!("two pieces of {}", name(owners[0]))
            }
            _ => format!("{} and {}", name(owners[0]), name(owners[1])),
        }
    }

    /// Pairs whose cores meet at the start: bodies that go into each other there, or are joined in one place.
    pub fn overlapping(&self) -> &[[u32; 2]] {
        &self.told.overlapping
    }

    /// Pairs of bodies that are not looked at, since links join them or the gaps of their contact count from elsewhere.
    pub fn joined<'a>(&'a self, system: &'a System) -> impl Iterator<Item = [u32; 2]> + 'a {
        let is_body = |number: u32| self.movers[number as usize].body().is_some();
        let none = self.linked.is_empty() && self.shifted.is_empty();
        let pairs = self.all_pairs().take(if none { 0 } else { usize::MAX });
        pairs.filter(move |of| {
            of.iter().all(|number| is_body(*number)) && self.leaves_out(system, *of)
        })
    }

    /// Looks at a state, the one after that of the last call.
    pub fn take(&mut self, system: &System, state: &State) {
        if self.movers.len() < 2 {
            return;
        }
        let before = std::mem::replace(&mut self.time, state.time);
        let mut all = Bounds::EMPTY;
        for mover in &mut self.movers {
            mover.take(system, (state.time, &state.motion));
            all = all.union(&mover.motion);
        }
        if self.near.is_finite() {
            self.told.left -= all.diagonal();
            if self.told.left <= 0.0 {
                self.choose(system, all.diagonal());
            }
        }
        let mut pairs = std::mem::take(&mut self.told.pairs);
        pairs.retain_mut(|pair| {
            let [one, other] = pair.of.map(|number| &self.movers[number as usize].motion);
            pair.left -= relative(one, other);
            pair.left > 0.0 || self.look(system, (state, before), pair)
        });
        self.told.pairs = pairs;
    }

    /// Looks at a pair; whether it is to be followed further.
    fn look(&mut self, system: &System, (state, before): (&State, f64), pair: &mut Pair) -> bool {
        for number in pair.of {
            self.movers[number as usize].place();
        }
        let moved = pair.of.map(|number| self.movers[number as usize].moved());
        let found = look(moved, system.dim, &mut self.room);
        self.told.tested += found.tested;
        pair.left = found.apart;
        let Some(met) = found.met else {
            return true;
        };
        let contact = self.contact_of(system, pair.of);
        let held = contact.is_some_and(|contact| self.is_held(system, state, (contact, pair.of)));
        self.told.crossings.push(Crossing {
            of: pair.of,
            contact,
            held,
            time: before + met.part * (state.time - before),
            place: met.place,
        });
        false
    }

    /// The contact between two: of bodies the first that has faces of one on a side and of the other on the other.
    fn contact_of(&self, system: &System, of: [u32; 2]) -> Option<usize> {
        let owners = of.map(|number| &self.movers[number as usize].of.owner);
        let on = |faces: &[Face], number: u32| {
            let own = self.movers[number as usize].of.core.nodes();
            let has = |node: &u32| own.binary_search(node).is_ok();
            faces.iter().any(|face| face.corners().iter().all(has))
        };
        match owners {
            [CoreOwner::Body(_), CoreOwner::Body(_)] => {
                let mut contacts = system.contacts.iter();
                contacts.position(|contact| {
                    let (own, target) = (&contact.secondary_faces, contact.primary_faces());
                    let both = |a: u32, b: u32| on(own, a) && on(target, b);
                    both(of[0], of[1]) || both(of[1], of[0])
                })
            }
            [_, CoreOwner::Shape(contact, _)] | [CoreOwner::Shape(contact, _), _] => Some(*contact),
        }
    }

    /// Whether a point of one of two that is near the other has a force of their contact.
    fn is_held(&self, system: &System, state: &State, (contact, of): (usize, [u32; 2])) -> bool {
        let motion = &state.motion;
        let places = system.places(state.time, &motion.u, &motion.frames);
        let points = system.points_of(contact);
        let mut carrying = points.filter(|point| state.interface.force[*point] > 0.0);
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
        let cores = of.map(|number| {
            let mover = &self.movers[number as usize];
            (&mover.of.core, &mover.before[..])
        });
        overlap(cores, dim, &mut self.room)
    }

    /// Chooses the pairs that are followed, by where they were at the start of the step. `motion`: the most that any two have moved in it, m.
    fn choose(&mut self, system: &System, motion: f64) {
        let boxes: Vec<Bounds> = self.movers.iter().map(Mover::reach).collect();
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        order.sort_by(|a, b| {
            let least = |number: u32| boxes[number as usize].min[0];
            least(*a).total_cmp(&least(*b)).then(a.cmp(b))
        });
        let old = std::mem::take(&mut self.told.pairs);
        let met: BTreeSet<[u32; 2]> = self
            .told
            .crossings
            .iter()
            .map(|crossing| crossing.of)
            .collect();
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
                    self.leaves_out(system, of)
                        || self.told.overlapping.binary_search(&of).is_ok()
                        || met.contains(&of)
                };
                if apart > near || is_out() {
                    continue;
                }
                let known = old.binary_search_by(|pair| pair.of.cmp(&of));
                let left = known.map_or(apart, |k| old[k].left);
                self.told.pairs.push(Pair { of, left });
            }
        }
        self.told.pairs.sort_by_key(|pair| pair.of);
        self.told.left = self.near;
    }

    /// Whether a pair is not looked at: two shapes, a shape and what its contact is not of, bodies that links join, and those of contacts whose gaps count
    /// from elsewhere.
    fn leaves_out(&self, system: &System, of: [u32; 2]) -> bool {
        let owners = of.map(|number| &self.movers[number as usize].of.owner);
        match owners {
            [CoreOwner::Body(one), CoreOwner::Body(other)] => {
                let parts = [one, other].map(|&body| system.part_of_body[body]);
                let [first, last] = [parts[0].min(parts[1]), parts[0].max(parts[1])];
                self.linked.contains(&[first, last])
                    || self.shifted.contains(&[*one.min(other), *one.max(other)])
            }
            [CoreOwner::Shape(..), CoreOwner::Shape(..)] => true,
            [CoreOwner::Body(body), CoreOwner::Shape(contact, _)]
            | [CoreOwner::Shape(contact, _), CoreOwner::Body(body)] => {
                !system.contacts[*contact].bodies.contains(body) || self.elsewhere[*contact]
            }
        }
    }
}

/// Whether gaps of a contact do not count from the surfaces, or what it lets go deep is told by its curve.
fn is_elsewhere(contact: &ContactPair) -> bool {
    contact.law.get().is_of_the_whole() || contact.offsets.iter().any(|offset| *offset != 0.0)
}

/// Connected parts that links join, ascending.
fn linked(system: &System) -> BTreeSet<[usize; 2]> {
    let mut parts = BTreeSet::new();
    for row in system.links.rows.iter() {
        let of = row.iter().map(|(i, _)| system.part_of(*i as usize));
        let of: BTreeSet<usize> = of.collect();
        for &one in &of {
            let others = of.iter().filter(|other| one < **other);
            parts.extend(others.map(|&other| [one, other]));
        }
    }
    parts
}

impl Mover {
    fn new(of: CoreOf) -> Mover {
        Mover {
            of,
            nodes: Vec::new(),
            before: Vec::new(),
            after: Vec::new(),
            earlier: Vec::new(),
            motion: Bounds::EMPTY,
            is_placed: false,
        }
    }

    fn body(&self) -> Option<usize> {
        match self.of.owner {
            CoreOwner::Body(body) => Some(body),
            CoreOwner::Shape(..) => None,
        }
    }

    /// Takes the places in a state.
    fn take(&mut self, system: &System, (time, motion): (f64, &Motion)) {
        std::mem::swap(&mut self.nodes, &mut self.earlier);
        self.nodes.clear();
        match &self.of.owner {
            CoreOwner::Body(_) => {
                let places = system.places(time, &motion.u, &motion.frames);
                let nodes = self.of.core.nodes().iter();
                self.nodes.extend(nodes.map(|&node| places.of(node)));
            }
            CoreOwner::Shape(contact, places) => {
                if let Target::Rigid(obstacle) = &system.contacts[*contact].target {
                    let moved = places.iter().map(|place| obstacle.moved(place, time));
                    self.nodes.extend(moved);
                }
            }
        }
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (now, before) in self.nodes.iter().zip(&self.earlier) {
            for i in 0..3 {
                let moved = now[i] - before[i];
                min[i] = if moved < min[i] { moved } else { min[i] };
                max[i] = if moved > max[i] { moved } else { max[i] };
            }
        }
        self.motion = Bounds { min, max };
        self.is_placed = false;
    }

    /// Places the vertices, if they are not.
    fn place(&mut self) {
        if std::mem::replace(&mut self.is_placed, true) {
            return;
        }
        match self.of.owner {
            CoreOwner::Body(_) => {
                self.of.core.place(&self.earlier, &mut self.before);
                self.of.core.place(&self.nodes, &mut self.after);
            }
            CoreOwner::Shape(..) => {
                self.before.clone_from(&self.earlier);
                self.after.clone_from(&self.nodes);
            }
        }
    }

    fn moved(&self) -> Moved<'_> {
        Moved {
            core: &self.of.core,
            before: &self.before,
            after: &self.after,
        }
    }

    /// The box around its places at the start of the step, and what others are to keep from it.
    fn reach(&self) -> Bounds {
        Bounds::of(&self.earlier).widened(1.1 * self.of.core.most_kept())
    }

    /// Diagonal of the box around it in the reference configuration, m.
    fn size_at_rest(&self, system: &System) -> f64 {
        let nodes = self.of.core.nodes().iter();
        let places = nodes.map(|&node| system.x[node as usize]);
        let bounds = places.fold(Bounds::EMPTY, |all, x| all.union(&Bounds::of(&[x])));
        match bounds.min[0].is_finite() {
            true => bounds.diagonal(),
            false => 0.0,
        }
    }
}

/// The most that two move relative to each other, m, whose motions are in these boxes.
fn relative(one: &Bounds, other: &Bounds) -> f64 {
    let most = |i: usize| {
        let (up, down) = (one.max[i] - other.min[i], other.max[i] - one.min[i]);
        if up > down { up } else { down }
    };
    (0..3).map(|i| most(i).powi(2)).sum::<f64>().sqrt()
}
