//! Explicit steps that several processes take together.
//!
//! Each rank computes the forces of its own elements and the motion of their nodes, and its own contact points: it knows the motion
//! of their nodes and the sums of the forces there, and gives the contact forces to the ranks whose elements have these nodes. Sums
//! over all ranks end the step, with what went wrong on any of them: all take the step, or none.

use std::sync::Arc;
use std::time::Instant;

use carom_bodies::{Distortion, Share};
use carom_ranks::Ranks;

use super::Driver;
use super::explicit::leapfrog::Direct;
use crate::error::Error;
use crate::march::{Going, Scope, Watched};
use crate::shared::{Begin, InReach, OwnElements, Shared, SharedNodes, Told, receive};
use crate::state::State;
use crate::system::{Model, System};
use crate::watch::{OfBody, is_due};

/// What one of several ranks has of a run, and sends to others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RankShare {
    /// Elements whose forces it computes.
    pub elements: usize,
    /// Nodes whose motion it computes, those included that others compute too.
    pub nodes: usize,
    /// Contact points that it computes.
    pub points: usize,
    /// The most of them so far that might touch something at a time.
    pub looked_points: usize,
    /// How often contacts of surfaces have been shared out.
    pub contact_shares: usize,
    /// Bytes that it sends in each step, by the count of these nodes.
    pub halo_bytes: u64,
    /// Bytes that it has sent so far: with what the first rank is given where impacts begin or end, and where somebody looks.
    pub sent_bytes: u64,
    /// Nodes that ranks share in all, by both ways of sharing out the elements.
    pub shared_nodes: SharedNodes,
}

impl Driver {
    /// What takes the steps on the first of several ranks, from the start or from a `saved` state ([`State::to_bytes`]): it has the whole system, and
    /// computes a part of its elements. The others ask with [`Driver::beside`]. For steps whose elements can be shared
    /// ([`why_not_on_ranks`](crate::why_not_on_ranks)).
    ///
    /// # Errors
    /// [`Error::Partition`]; as [`Driver::new`]; that another rank cannot build its part.
    pub fn on_ranks(
        system: Arc<System>,
        saved: Option<&[u8]>,
        ranks: &Ranks,
        watched: &Watched,
    ) -> Result<Driver, Error> {
        let begun = Begin::first(&system, ranks)
            .and_then(|begin| Ok((begin, Driver::from_saved(&system, saved)?)));
        let (begin, mut driver) = of_all(ranks, begun)?;
        watched.give(&system, ranks);
        let given = begin.give((&system, ranks), &mut driver.attempt.state);
        of_all(ranks, given)?;
        driver.share(ranks, (watched, begin.of_first()));
        Ok(driver)
    }

    /// The same on another rank, which has the part of the system that its elements and all contacts have, and the first one's state of it. The step
    /// of the model is that of the first one. With it comes the system.
    ///
    /// # Errors
    /// As [`Driver::on_ranks`], on all ranks.
    pub fn beside(model: Model, ranks: &Ranks) -> Result<(Driver, Arc<System>), Error> {
        let (around, begin) = of_all(ranks, Begin::other(model, ranks))?;
        let (system, own) = begin.of_other(ranks.rank(), &around);
        drop(around);
        let watched = Watched::receive(&system, ranks);
        let driver =
            receive(&system, ranks).and_then(|state| Driver::resume(Arc::clone(&system), state));
        let mut driver = of_all(ranks, driver)?;
        driver.share(ranks, (&watched, own));
        Ok((driver, system))
    }

    /// What takes the steps from the start, or from a saved state, where ranks share the products of iterations alone: each takes all of the steps
    /// ([`Alike`](crate::Alike)).
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn alike(
        system: &Arc<System>,
        saved: Option<&[u8]>,
        ranks: &Ranks,
    ) -> Result<Driver, Error> {
        let mut driver = Driver::from_saved(system, saved)?;
        driver.parts.share(ranks);
        Ok(driver)
    }

    fn from_saved(system: &Arc<System>, saved: Option<&[u8]>) -> Result<Driver, Error> {
        match saved {
            None => Driver::new(Arc::clone(system)),
            Some(bytes) => {
                let state = State::from_bytes(system, bytes)?;
                Driver::resume(Arc::clone(system), state)
            }
        }
    }

    /// Shares the steps with other ranks. `own`: the elements of this one.
    fn share(&mut self, ranks: &Ranks, (watched, own): (&Watched, OwnElements)) {
        self.certificate = None;
        self.attempt.state.crossings = None;
        self.attempt.next.crossings = None;
        let system = Arc::clone(&self.attempt.system);
        let map = self.attempt.maps.first();
        let at_ends =
            |contact: usize| self.contacts.paired_at(contact).row(map) == map.displacement;
        let in_reach = InReach::new(&system, &self.contacts.active().reaches, at_ends);
        let given = (in_reach, &self.attempt.state);
        let mut shared = Shared::new(&system, ranks, (watched, own), given);
        shared.take_looks(&system, &self.attempt.state.shapes.looks);
        if !shared.is_first() {
            self.attempt.state.shapes.looks = Vec::new();
            // what was counted so far is the first rank's
            let records = &mut self.attempt.state.records.contacts;
            for record in records {
                let (counts, impulse) = record.counts_mut();
                counts.into_iter().for_each(|count| *count = 0);
                *impulse = 0.0;
            }
        }
        if let Some(mut direct) = self.explicit.take() {
            self.contacts
                .take_homes(&self.attempt, &mut shared, &mut direct);
            self.contacts.look_to(&shared.in_reach);
            self.explicit.keep(direct);
        }
        self.ranks.begin(shared);
    }

    /// Whether several ranks take the steps.
    pub(super) fn is_shared(&self) -> bool {
        self.ranks.are_several()
    }

    /// Places of the elements that this rank computes among those of each body, ascending; none where ranks share no elements.
    pub fn own_elements(&self) -> Option<Vec<Vec<u32>>> {
        let shared = self.ranks.shared()?;
        let of_body = |shares: &[Share; 2]| {
            let mut places = shares.each_ref().map(Share::places).concat();
            places.sort_unstable();
            places
        };
        Some(shared.bodies().map(of_body).collect())
    }

    /// What this rank has and sends; none of a run in one process.
    pub fn rank_share(&self) -> Option<RankShare> {
        let shared = self.ranks.shared()?;
        let elements = shared.bodies().flatten();
        Some(RankShare {
            elements: elements.map(|share| share.places().len()).sum(),
            nodes: shared.halo.present.len(),
            points: self.contacts.active().own_points(),
            looked_points: shared.looked,
            contact_shares: shared.found_homes,
            halo_bytes: shared.halo.bytes(self.attempt.system.dim),
            sent_bytes: shared.ranks.sent_bytes(),
            shared_nodes: shared.shared_nodes(),
        })
    }

    /// Takes the attempt on all ranks.
    pub(super) fn step_on_ranks(
        &mut self,
        shared: &mut Shared,
        direct: &mut Direct,
        clean: bool,
    ) -> Result<(), Error> {
        let (begin, before) = (Instant::now(), self.attempt.phases);
        let (dim, mut clean) = (self.attempt.system.dim, clean);
        if shared.in_reach.is_due(&self.attempt.system) {
            if shared.look_for_faces(&self.attempt.system, &mut self.attempt.state) {
                self.contacts.take_homes(&self.attempt, shared, direct);
                clean = false;
            }
            self.contacts.look_to(&shared.in_reach);
        }
        self.parts
            .begin_explicit_pass(&mut self.attempt, direct, clean);
        self.attempt.place_end(direct);
        let forced = self
            .parts
            .forces_on_ranks(&mut self.attempt, shared, direct);
        let loads = self.attempt.loads_of_end(direct.loaded);
        let mut failed = forced.err();
        self.contacts.follow_interface(&mut self.attempt);
        if failed.is_none() {
            failed = self.touch(direct, loads).err();
        }
        let forces = &mut self.attempt.next.motion.contact_force;
        shared.pass_contact_forces(dim, forces, |node| direct.touch(node));
        self.attempt.count_contact(begin, before);
        let begin = Instant::now();
        self.end_motion(direct, loads);
        direct.sum_parts();
        let rank = shared.ranks.rank();
        self.balances
            .report_supports(&self.attempt, loads, &|node| shared.halo.counts(node, rank));
        self.contacts.end_points(&mut self.attempt);
        self.report_own_contacts();
        let mut contacts = self.contacts.take_sums();
        let energies = (self.parts.energies_mut(), self.balances.reactions_mut());
        let parts = &mut direct.parts[..];
        let told = Told {
            failed: failed.is_some(),
            passes: match self.contacts.candidates().is_empty() {
                true => 0,
                false => self.contacts.passes(),
            },
        };
        let told = shared.sum_up(parts, energies, &mut contacts, &told);
        if shared.in_reach.travel(&self.attempt.system, &contacts) {
            self.contacts.keep_sums(contacts);
            return self.step_on_ranks(shared, direct, false);
        }
        if told.failed {
            return Err(of_ranks(&shared.ranks, failed));
        }
        self.contacts.set_passes(told.passes);
        let sums = direct.total(self.attempt.system.axisymmetric);
        self.know_end(&sums, direct);
        self.contacts.know_gaps(&mut self.attempt, &mut contacts);
        let records = &self.attempt.state.records.contacts;
        shared.sum_contacts(
            &self.attempt.system,
            &mut contacts,
            (records, self.attempt.state.time + self.attempt.dt),
        );
        if self.attempt.impacts_change(&contacts) {
            let velocities = [
                &mut self.attempt.state.motion.v[..],
                &mut self.attempt.next.motion.v,
            ];
            shared.gather_velocities(dim, velocities);
        }
        self.contacts.keep_sums(contacts);
        self.end_directly(&sums, direct);
        self.attempt.phases.balance += begin.elapsed();
        Ok(())
    }

    /// What the contact points of this rank did.
    fn report_own_contacts(&mut self) {
        self.report_contacts();
        let map = self.attempt.maps.first();
        self.contacts.report_motions(map);
    }

    /// That no entry of the attempt that this rank has is infinite or no number, on any rank.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub(super) fn check_finite_on_ranks(&self) -> Result<(), Error> {
        let found = self.attempt.check_finite();
        let Some(shared) = self.ranks.shared() else {
            return found;
        };
        let text = found.err().map(|error| error.to_string());
        match shared.ranks.first_text(text.as_deref()) {
            None => Ok(()),
            Some((rank, cause)) => Err(Error::OnRank { rank, cause }),
        }
    }

    /// See [`Stepper::agree`](crate::Stepper::agree).
    pub(super) fn agree_on_ranks(&mut self, own: Going) -> Going {
        match self.ranks.shared() {
            Some(shared) => own.of_all(&shared.ranks),
            None => own,
        }
    }

    /// See [`Stepper::bring`](crate::Stepper::bring).
    pub(super) fn bring_on_ranks(&mut self, scope: Scope) {
        let Some(mut shared) = self.ranks.take() else {
            return;
        };
        let (system, dim) = (Arc::clone(&self.attempt.system), self.attempt.system.dim);
        let step = self.attempt.state.step;
        let asks = self.ranks.asks(step) && shared.is_first();
        let is_due = |assembly: usize| asks && is_due(&self.attempt.state, step, assembly);
        let due: Vec<bool> = (0..system.assemblies.all.len()).map(is_due).collect();
        // the numbers of the looks at each body, zero where there is none: assemblies of a rank are of its part of the model
        let look = |body: usize| {
            let assembly = system.assemblies.of_part[system.part_of_body[body]];
            match due[assembly] {
                true => (self.attempt.state.records.small.looked[assembly].looks + 1) as f64,
                false => 0.0,
            }
        };
        let mut said = vec![f64::from(scope as u8), f64::from(due.contains(&true))];
        said.extend((0..system.bodies.len()).map(look));
        shared.ranks.broadcast(&mut said);
        let (scope, is_due) = (Scope::of(said[0]), said[1] != 0.0);
        shared.bring(dim, scope, &mut self.attempt.state);
        if scope == Scope::All {
            shared.gather_looks(&system, &mut self.attempt.state.shapes.looks);
        }
        self.report.partial = scope != Scope::All && shared.is_first();
        if is_due {
            shared.bring_contacts(dim, &mut self.attempt.state);
            let u = &self.attempt.state.motion.u;
            let found = shared.distortions(u, &said[2..]);
            let bending = shared.bending(u);
            if shared.is_first() {
                let of = |body: usize, _: (&[f64], usize), _: &Distortion| OfBody {
                    distortion: found[body],
                    bending: bending[body],
                    // springs are not shared
                    across: None,
                };
                let state = &mut self.attempt.state;
                self.watch.look((&system, &due), &of, state);
            }
        }
        self.ranks.keep(shared);
    }
}

/// What this rank has, if none has an error.
fn of_all<T>(ranks: &Ranks, own: Result<T, Error>) -> Result<T, Error> {
    let text = own.as_ref().err().map(ToString::to_string);
    match ranks.first_text(text.as_deref()) {
        None => own,
        Some((rank, cause)) => own.and(Err(Error::OnRank { rank, cause })),
    }
}

/// The error of a step that has failed on some rank, on all of them the same.
fn of_ranks(ranks: &Ranks, own: Option<Error>) -> Error {
    let text = own.map(|error| error.to_string());
    let (rank, cause) = ranks.first_text(text.as_deref()).unwrap_or_default();
    Error::OnRank { rank, cause }
}
