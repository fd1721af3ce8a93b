//! What the contact points of all ranks did in a step, and what the first rank is given of them.

use carom_contact::law::Status;
use carom_contact::{Faced, Point};
use carom_ranks::{Message, Ranks};

use super::halo::{Halo, With, by_rank};
use crate::chatter::Waiting;
use crate::contact_sums::ContactSums;
use crate::march::{Scope, Watched};
use crate::records::{ContactRecord, Records};
use crate::state::{InterfaceState, State};
use crate::system::System;

/// Numbers of a point that the first rank is given where somebody looks at points, and where the state is to be whole.
const SEEN: usize = 5;
pub(super) const WHOLE: usize = 15;

/// The points of contacts that the first rank does not have: by rank on the first one, and on another its own.
#[derive(Debug, Default)]
pub(super) struct SharedPoints {
    all: Vec<With>,
    /// Those at watched nodes.
    watched: Vec<With>,
    /// Those that are looked at with [`Scope::Points`], and at watched nodes.
    seen: Vec<With>,
    room: Vec<Message>,
    /// Least gaps of the contacts on this rank, m.
    gaps: Vec<f64>,
    sums: Vec<f64>,
    largest: Vec<f64>,
}

impl SharedPoints {
    pub(super) fn new(
        system: &System,
        (halo, rank): (&Halo, usize),
        watched: &Watched,
    ) -> SharedPoints {
        let [nodes, seen] = [&watched.nodes, &watched.points].map(|numbers| {
            let mut numbers = numbers.clone();
            numbers.sort_unstable();
            numbers
        });
        let is_watched = |_, point: &Point| {
            let mut carriers = point.carriers();
            carriers.any(|(node, _)| nodes.binary_search(&node).is_ok())
        };
        let is_seen = |number: u32, point: &Point| {
            seen.binary_search(&number).is_ok() || is_watched(number, point)
        };
        let lists = |has: &dyn Fn(u32, &Point) -> bool| {
            let points = system.contacts.iter().flat_map(|contact| &contact.points);
            let points = (0..).zip(points).zip(&halo.homes.of_point);
            let points =
                points.filter(|((number, point), home)| **home != 0 && has(*number, point));
            by_rank(points.map(|((number, _), home)| (number, *home)), rank)
        };
        SharedPoints {
            all: lists(&|_, _| true),
            watched: lists(&is_watched),
            seen: lists(&is_seen),
            ..SharedPoints::default()
        }
    }

    /// What a step sums over all ranks before [`SharedPoints::sum`]: whether any point of a contact was looked at, its least gap, and the largest
    /// motion of its nodes.
    pub(super) fn begin_sum(
        &mut self,
        contacts: &[ContactSums],
        (sums, largest): (&mut Vec<f64>, &mut Vec<f64>),
    ) {
        self.gaps.clear();
        for of in contacts {
            sums.push(f64::from(of.near));
            largest.extend([-of.report.gap, of.motion]);
            self.gaps.push(of.report.gap);
        }
    }

    /// Takes what all ranks have given for it.
    pub(super) fn take_begun(
        contacts: &mut [ContactSums],
        (sums, largest): (&mut impl FnMut() -> f64, &mut impl FnMut() -> f64),
    ) {
        for of in contacts {
            of.near = sums() > 0.0;
            of.report.gap = -largest();
            of.motion = largest();
        }
    }

    /// Makes of what the points of this rank did what those of all ranks did, of the contacts of which any rank has looked at some. `before`: their
    /// records at the start of the step, `end`: its end, s; `tolerances`: of each, m, up to which a gap is the least one.
    pub(super) fn sum(
        &mut self,
        ranks: &Ranks,
        contacts: &mut [ContactSums],
        (before, end): (&[ContactRecord], f64),
        tolerances: impl Iterator<Item = f64>,
    ) {
        let SharedPoints {
            gaps,
            sums,
            largest,
            ..
        } = self;
        sums.clear();
        largest.clear();
        let all = contacts.iter().zip(&*gaps).zip(tolerances);
        for ((of, gap), tolerance) in all.filter(|((of, _), _)| of.near) {
            numbers(&mut of.clone(), &mut |number| sums.push(*number));
            let has_least = *gap <= of.report.gap + tolerance;
            largest.push(if has_least {
                of.report.rate
            } else {
                f64::NEG_INFINITY
            });
            largest.push(of.passing.value);
        }
        if sums.is_empty() {
            return;
        }
        ranks.reduce(sums, largest);
        let (mut sums, mut largest) = (sums.iter(), largest.iter());
        for of in contacts.iter_mut().filter(|of| of.near) {
            numbers(of, &mut |number| {
                *number = sums.next().copied().unwrap_or_default()
            });
            let report = &mut of.report;
            let rate = largest.next().filter(|_| report.gap.is_finite());
            report.rate = rate.copied().unwrap_or_default();
            let deepest = largest.next().copied().unwrap_or_default();
            if of.passing.value < deepest {
                of.passing.value = deepest;
                of.passing.place = u32::MAX;
            }
            let friction = [0, 1, 2].map(|i| (report.resultant[i] - report.normal[i]).powi(2));
            report.friction = friction.iter().sum::<f64>().sqrt();
        }
        find_places(ranks, contacts, (before, end));
    }

    /// Brings forces, gaps and statuses of the points of a scope to the first rank; with all of them all that a state has of them.
    pub(super) fn gather(&mut self, ranks: &Ranks, scope: Scope, state: &mut State) {
        let lists = match scope {
            Scope::Watched => &self.watched,
            Scope::Points => &self.seen,
            Scope::All => &self.all,
        };
        let whole = scope == Scope::All;
        collect((ranks, whole), (lists, &mut self.room), state);
        if whole {
            sum_closings(ranks, &mut state.records);
        }
    }

    /// Brings forces, gaps and statuses of all points to the first rank.
    pub(super) fn gather_seen(&mut self, ranks: &Ranks, state: &mut State) {
        collect((ranks, false), (&self.all, &mut self.room), state);
    }
}

/// Finds where points are deeper behind the other side than any before the step, each rank knowing how deep: the first of such places.
fn find_places(
    ranks: &Ranks,
    contacts: &mut [ContactSums],
    (before, end): (&[ContactRecord], f64),
) {
    let pairs = contacts.iter_mut().zip(before);
    let is_deeper = |(of, record): &(&mut ContactSums, &ContactRecord)| {
        of.near && of.passing.value > record.passing.value
    };
    let mut deeper: Vec<_> = pairs.filter(is_deeper).map(|(of, _)| of).collect();
    if deeper.is_empty() {
        return;
    }
    let own = deeper.iter().map(|of| match of.passing.place {
        u32::MAX => f64::NEG_INFINITY,
        place => -f64::from(place),
    });
    let mut places: Vec<f64> = own.collect();
    ranks.reduce(&mut [], &mut places);
    for (of, place) in deeper.iter_mut().zip(places) {
        of.passing.place = -place as u32;
        of.passing.time = end;
    }
}

/// Brings what is seen of points, or the `whole`, to the first rank.
fn collect(
    (ranks, whole): (&Ranks, bool),
    (lists, room): (&[With], &mut Vec<Message>),
    state: &mut State,
) {
    let is_first = ranks.is_first();
    let each = if whole { WHOLE } else { SEEN };
    room.resize_with(lists.len(), Message::default);
    for (message, list) in room.iter_mut().zip(lists) {
        message.with = list.rank;
        message.values.resize(each * list.nodes.len(), 0.0);
    }
    if is_first {
        ranks.exchange(&[], room, || ());
    }
    for (message, list) in room.iter_mut().zip(lists) {
        let mut values = message.values.iter_mut();
        for &point in &list.nodes {
            of_point(state, point as usize, whole, &mut |number| {
                if let Some(value) = values.next() {
                    match is_first {
                        true => *number = *value,
                        false => *value = *number,
                    }
                }
            });
        }
    }
    if !is_first {
        ranks.exchange(room, &mut [], || ());
    }
}

/// Makes what each rank has counted that of the first, which has all of it then.
fn sum_closings(ranks: &Ranks, records: &mut Records) {
    let mut sums = Vec::with_capacity(5 * records.contacts.len());
    for record in &mut records.contacts {
        let (counts, impulse) = record.counts_mut();
        sums.extend(counts.map(|count| *count as f64));
        sums.push(*impulse);
    }
    ranks.reduce(&mut sums, &mut []);
    let mut sums = sums.iter();
    let mut sum = || {
        sums.next()
            .copied()
            .filter(|_| ranks.is_first())
            .unwrap_or_default()
    };
    for record in &mut records.contacts {
        let (counts, impulse) = record.counts_mut();
        for count in counts {
            *count = sum() as u64;
        }
        *impulse = sum();
    }
}

/// Visits what of a contact is a sum over its points, or of one rank alone.
fn numbers(of: &mut ContactSums, visit: &mut impl FnMut(&mut f64)) {
    let ContactSums {
        near: _,
        motion: _,
        report,
        work,
        crushed,
        pushed,
        passing: _,
        passed,
        jump: _,
    } = of;
    let vectors = [
        &mut report.resultant,
        &mut report.normal,
        &mut report.moment,
        &mut pushed.force,
    ];
    vectors.into_iter().flatten().for_each(&mut *visit);
    let counts = [
        &mut report.slipping,
        &mut report.closed,
        &mut report.status_changes,
    ];
    for count in counts {
        let mut number = *count as f64;
        visit(&mut number);
        *count = number as usize;
    }
    let mut number = *passed as f64;
    visit(&mut number);
    *passed = number as u64;
    let sums = [
        &mut report.force,
        &mut report.friction_loss,
        &mut report.persistency_defect,
        work,
        crushed,
        &mut pushed.turn,
    ];
    sums.into_iter().for_each(visit);
}

/// Visits what a state has of a point: what is seen of it, or the `whole`.
pub(super) fn of_point(
    state: &mut State,
    point: usize,
    whole: bool,
    visit: &mut dyn FnMut(&mut f64),
) {
    let InterfaceState {
        force,
        friction,
        carried,
        gap,
        rate,
        opening,
        status,
        watched,
        flight,
        crush,
        landed,
        faced,
    } = &mut state.interface;
    let mut slid = friction.get(point).copied().unwrap_or_default();
    let mut number = number_of(status[point]);
    let seen = [&mut force[point], &mut gap[point], &mut number];
    seen.into_iter().chain(&mut slid).for_each(&mut *visit);
    status[point] = status_of(number);
    if friction.is_empty() && slid != [0.0; 2] {
        friction.resize(force.len(), [0.0; 2]);
    }
    if let Some(friction) = friction.get_mut(point) {
        *friction = slid;
    }
    if !whole {
        return;
    }
    let mut is_watched = f64::from(watched[point]);
    let mut waits = match state.records.waiting[point] {
        Waiting::Nothing => 0.0,
        Waiting::Due => 1.0,
        Waiting::Hasty => 2.0,
        Waiting::Chattering => 3.0,
    };
    let place = faced.binary_search_by_key(&point, |(of, _)| *of as usize);
    let mut edge = number_of_faced(place.ok().map(|place| faced[place].1));
    let rest = [
        &mut carried[point],
        &mut rate[point],
        &mut opening[point],
        &mut flight[point],
        &mut crush[point],
        &mut landed[point],
        &mut state.records.opened[point],
        &mut is_watched,
        &mut edge,
        &mut waits,
    ];
    rest.into_iter().for_each(visit);
    watched[point] = is_watched != 0.0;
    state.interface.set_faced(point, faced_of(edge));
    state.records.waiting[point] = match waits {
        0.0 => Waiting::Nothing,
        1.0 => Waiting::Due,
        2.0 => Waiting::Hasty,
        _ => Waiting::Chattering,
    };
}

/// An edge that a point is closed at as a number: zero of none.
fn number_of_faced(faced: Option<Faced>) -> f64 {
    faced.map_or(0.0, |faced| {
        f64::from(faced.edge) * 2.0 + 1.0 + f64::from(faced.is_reversed)
    })
}

/// The reverse.
fn faced_of(number: f64) -> Option<Faced> {
    let from_zero = (number as u64).checked_sub(1)?;
    Some(Faced {
        edge: (from_zero / 2) as u32,
        is_reversed: from_zero % 2 == 1,
    })
}

/// A status as a number: pieces from 3 on.
fn number_of(status: Status) -> f64 {
    match status {
        Status::Open => 0.0,
        Status::Closed => 1.0,
        Status::Corner => 2.0,
        Status::Piece(piece) => 3.0 + f64::from(piece),
    }
}

/// The reverse.
fn status_of(number: f64) -> Status {
    match number as u32 {
        0 => Status::Open,
        1 => Status::Closed,
        2 => Status::Corner,
        piece => Status::Piece((piece - 3) as u16),
    }
}
