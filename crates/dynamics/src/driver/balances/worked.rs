//! Works of the forces of a step that are not all linear.

use super::mean_forces::{MeanForces, Weighted};
use super::works::Works;
use super::{Balances, reported};
use crate::driver::attempt::Attempt;
use crate::driver::attempt::balance::{Weights, balanced};
use crate::resultant::Resultant;
use crate::step_forces::OutsideForces;

/// Works of the forces on the way of the step, J, and resultants, N.
pub(crate) struct Worked {
    pub(crate) load: f64,
    pub(crate) contact: f64,
    pub(crate) reaction: f64,
    pub(crate) inertia: f64,
    pub(crate) internal: f64,
    pub(crate) damping: f64,
    pub(crate) link: f64,
    pub(crate) forces: OutsideForces<Resultant>,
}

impl Balances {
    /// What the forces of the step do on its way.
    pub(crate) fn work(&mut self, attempt: &Attempt, link: &[f64], weights: &Weights) -> Worked {
        let system = &*attempt.system;
        let (old, new) = (&attempt.state.motion, &attempt.next.motion);
        let Works {
            contact,
            held,
            reaction,
            springs,
            mean,
            given,
            ..
        } = &mut self.works;
        given.clear();
        given.resize(system.parts.len(), 0.0);
        let now = balanced(&attempt.vectors, link, [contact, reaction, springs]);
        let before = &attempt.state.forces;
        let weigh = |before, now, weights| Weighted {
            before,
            now,
            weights,
        };
        let own = |before, now| weigh(before, now, &weights.forces);
        let of_contacts = |before, now| weigh(before, now, &weights.contacts);
        let mut means = MeanForces {
            system,
            old,
            new,
            mean,
        };
        let (load, loads) = means.given(own(&before.load, now.load), given);
        let (touch, contacts) = means.work_and_resultant(of_contacts(&before.contact, now.contact));
        let (reaction, reactions) = means.given(own(&before.reaction, now.reaction), given);
        let mut inertia = means.work(own(&before.inertia, now.inertia));
        let internal = means.work(own(&before.internal, now.internal));
        let (damping, damped) = means.work_and_resultant(own(&before.damping, now.damping));
        let (link, linked) = means.work_and_resultant(own(&before.link, now.link));
        let (_, sprung) = means.work_and_resultant(own(&before.spring, now.spring));
        if weights.pushes {
            // the inertia of the push is the force that gives it
            inertia += touch + means.work(of_contacts(&[], held));
        }
        let places = (&old.frames[..], &[&old.u[..], &new.u[..]][..]);
        Worked {
            load,
            contact: touch,
            reaction,
            inertia,
            internal,
            damping,
            link,
            forces: OutsideForces {
                loads,
                contacts,
                supports: reactions.plus(&sprung.reversed()),
                held: match weights.pushes {
                    true => Resultant::at(system, places, held),
                    false => Resultant::default(),
                },
                links: linked.plus(&damped.reversed()),
            },
        }
    }

    /// Forces of the named supports.
    pub(crate) fn report_reactions(&mut self, attempt: &Attempt, weights: &Weights) {
        let Works {
            held,
            reaction,
            springs,
            ..
        } = &self.works;
        let apart = |i: usize| if weights.pushes { held[i] } else { 0.0 };
        let spring = |i: usize| springs.get(i).unwrap_or(&0.0);
        let (frames, u) = (&attempt.state.motion.frames[..], &attempt.next.motion.u[..]);
        reported::write(
            &mut self.reactions,
            &attempt.system,
            (frames, Some(u)),
            |i| reaction[i] + apart(i) - spring(i),
        );
    }

    /// Keeps the forces of the step for the balance of the next one, if that has them at its start; in stages as the momentum takes them.
    pub(crate) fn keep_forces(&self, attempt: &mut Attempt, link: &[f64], weights: &Weights) {
        let go_on = weights.forces.iter().any(|of| of[0] != 0.0) || attempt.maps.is_static();
        let carry = match attempt.is_plain() {
            true => attempt.maps.first().impulse.carry,
            false => 0.0,
        };
        let works = &self.works;
        let own = [&works.contact[..], &works.reaction, &works.springs];
        let now = balanced(&attempt.vectors, link, own);
        let kept = attempt.next.forces.each_mut().into_iter();
        for (kept, force) in kept.zip(now.each()) {
            kept.clear();
            kept.extend_from_slice(if go_on { force } else { &[] });
        }
        if carry == 0.0 {
            return;
        }
        let (kept, before) = (&mut attempt.next.forces, &attempt.state.forces);
        for (kept, before) in kept.each_mut().into_iter().zip(before.each()) {
            let both = kept.iter_mut().zip(before);
            both.for_each(|(kept, before)| *kept -= carry * before);
        }
    }

    /// What the forces from outside give to the momentum of each connected part; not in a static stage.
    pub(crate) fn exchange(&self, attempt: &mut Attempt, link: &[f64]) {
        let maps = &attempt.maps;
        if maps.is_static() {
            return;
        }
        let (system, vectors) = (&*attempt.system, &attempt.vectors);
        let exchange = &mut attempt.next.exchange;
        exchange.follow(&attempt.state.exchange);
        if let Some(impulses) = self.jump.impulses() {
            exchange.jump(system, impulses);
        }
        let Works {
            own, held, springs, ..
        } = &self.works;
        let spring = |i: usize| springs.get(i).unwrap_or(&0.0);
        let linked = |i: usize| link.get(i).unwrap_or(&0.0);
        let own = |i: usize| vectors.load[i] + own[i] + linked(i) - vectors.damping[i] - spring(i);
        let dt = attempt.dt;
        exchange.add(system, (0, dt, |i| maps.of(i).impulse), own);
        exchange.add(system, (1, dt, |i| maps.of(i).contact_impulse), |i| held[i]);
    }
}
