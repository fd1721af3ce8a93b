//! Sliding of the points of an iteration: rows of the tangents, ways, and what friction forces make of them.

use carom_contact::Rows;

use super::Contacts;
use crate::coulomb::Slip;
use crate::driver::attempt::Attempt;
use crate::report::ContactReport;
use crate::step_map::{Row, StepMap};

/// Points that carried friction are first thought to stick.
pub(super) fn first_thought(friction: &[f64; 2]) -> Slip {
    match friction == &[0.0; 2] {
        true => Slip::Open,
        false => Slip::Stick,
    }
}

impl Contacts {
    /// Whether a candidate has friction.
    pub(crate) fn rubs(&self, attempt: &Attempt) -> bool {
        let acts = |&point: &u32| {
            let contact = attempt.system.contact_of(point as usize);
            attempt.system.contacts[contact].friction.acts()
        };
        attempt.system.tangents() > 0 && self.candidates.iter().any(acts)
    }

    /// Points that carried friction are first thought to stick.
    pub(crate) fn guess_slips(&mut self, attempt: &mut Attempt) {
        let points = attempt.system.points();
        self.slips.clear();
        if attempt.system.tangents() == 0 {
            return;
        }
        let friction = &mut attempt.next.interface.friction;
        friction.resize(points, [0.0; 2]);
        self.slips.extend(friction.iter().map(first_thought));
    }

    /// Rows of all points, each with those of its tangents after it.
    pub(crate) fn stack(&mut self, attempt: &Attempt) {
        let tangents = attempt.system.tangents();
        if tangents == 0 {
            return;
        }
        self.stacked.clear();
        for point in 0..self.pairing.len() {
            self.stacked.push_from(&self.pairing.rows, point);
            for rows in &self.pairing.tangents[..tangents] {
                self.stacked.push_from(rows, point);
            }
        }
    }

    /// The times, from that at which the places of a contact are taken, over which its sliding is looked at, s.
    pub(crate) fn span(&self, attempt: &Attempt, contact: usize) -> [f64; 2] {
        let after = self.paired_after(attempt, contact);
        match self.by_rate {
            true => [attempt.dt - after; 2],
            false => [-after, attempt.dt - after],
        }
    }

    /// The row of a map whose product with T is the sliding quantity, and the time that turns a rate into it.
    pub(crate) fn sliding(
        &self,
        attempt: &Attempt,
    ) -> (impl Fn(&StepMap) -> Row + Copy + use<>, f64) {
        let by_rate = self.by_rate;
        let row = move |map: &StepMap| match by_rate {
            true => map.rate,
            false => map.displacement.since(&Row::START),
        };
        (row, if by_rate { 1.0 } else { attempt.dt })
    }

    /// Sliding quantity of a point along one tangent at the x of the iteration.
    pub(crate) fn slid(
        &self,
        attempt: &Attempt,
        point: usize,
        tangent: usize,
        (row, time): (impl Fn(&StepMap) -> Row, f64),
    ) -> f64 {
        let rows = &self.pairing.tangents[tangent];
        let xc = [&attempt.vectors.x[..], &attempt.vectors.push];
        let along = attempt
            .maps
            .on((rows, point), row, &attempt.state.motion, xc);
        along + time * rows.rate(point)
    }

    /// Adds Tᵀ t to the nodal contact forces.
    pub(crate) fn spread_friction(&self, attempt: &mut Attempt) {
        for point in self.active.within(0..attempt.system.points()) {
            let Some(t) = attempt.next.interface.friction.get(point) else {
                return;
            };
            for (rows, &t) in self.pairing.tangents.iter().zip(t) {
                if t != 0.0 {
                    rows.add_force(point, t, &mut attempt.vectors.contact);
                }
            }
        }
    }

    /// How far a point that sticks has slid at the x of the iteration, m.
    pub(super) fn slip_defect(&self, attempt: &Attempt, point: usize) -> f64 {
        if self.slips.get(point) != Some(&Slip::Stick) {
            return 0.0;
        }
        let (row, time) = self.sliding(attempt);
        let slid = |k: usize| self.slid(attempt, point, k, (row, time)).powi(2);
        let slid: f64 = (0..attempt.system.tangents()).map(slid).sum();
        slid.sqrt() * attempt.dt / time
    }

    /// How far the friction of a point is from what its status allows, over `largest`, the largest force of all points:
    /// |t| - μ P of a point that sticks, | |t| - μ P | of one that slips, over what their equations may leave, 2 + μ.
    /// Forces of one solve obey this to its tolerance, a mixture of points that stick and slip need not.
    pub(super) fn cone_defect(&self, attempt: &Attempt, point: usize, largest: f64) -> f64 {
        let interface = &attempt.next.interface;
        let (Some(t), Some(slip)) = (interface.friction.get(point), self.slips.get(point)) else {
            return 0.0;
        };
        let (sticks, slides) = self.coefficients(attempt, point);
        let mu = match slip {
            Slip::Slip => slides,
            Slip::Stick | Slip::Open => sticks,
        };
        let beyond = t[0].hypot(t[1]) - mu * interface.force[point].max(0.0);
        let defect = match slip {
            Slip::Slip => beyond.abs(),
            Slip::Stick | Slip::Open => beyond.max(0.0),
        };
        if defect == 0.0 {
            0.0
        } else {
            defect / ((2.0 + mu) * largest)
        }
    }

    /// Coefficients of friction with which a point sticks and slides in the step, by the rate of its sliding at the start.
    fn coefficients(&self, attempt: &Attempt, point: usize) -> (f64, f64) {
        let law = attempt.system.contacts[attempt.system.contact_of(point)]
            .friction
            .get();
        (law.sticks(), law.slides(self.sliding_speed(attempt, point)))
    }

    /// Rate at which a point slides at the start of the step, m/s.
    pub(super) fn sliding_speed(&self, attempt: &Attempt, point: usize) -> f64 {
        let mut square = 0.0;
        for rows in &self.pairing.tangents[..attempt.system.tangents()] {
            let rate = rows.product(point, &attempt.state.motion.v) + rows.rate(point);
            square += rate * rate;
        }
        square.sqrt()
    }

    /// Way that a point slides along one tangent in the step that was taken, m.
    pub(crate) fn way(&self, attempt: &Attempt, point: usize, tangent: usize) -> f64 {
        let rows = &self.pairing.tangents[tangent];
        let [old, new] =
            [&attempt.state.motion.u, &attempt.next.motion.u].map(|u| rows.product(point, u));
        new - old + attempt.dt * rows.rate(point)
    }

    /// Work in J of the friction forces of the step, old and new with these weights by zone, on the way that their points slide
    /// over the primary.
    pub(crate) fn friction_work(&self, attempt: &Attempt, weights: &[[f64; 2]]) -> f64 {
        let contacts = 0..attempt.system.contacts.len();
        let of = |k| self.friction_work_of(attempt, k, weights[attempt.system.zone_of(k)]);
        contacts.map(of).sum()
    }

    /// The same of one contact, with its weights.
    pub(crate) fn friction_work_of(
        &self,
        attempt: &Attempt,
        contact: usize,
        weights: [f64; 2],
    ) -> f64 {
        let (old, new) = (&attempt.state.interface, &attempt.next.interface);
        let mut work = 0.0;
        for point in self.active.within(attempt.system.points_of(contact)) {
            let Some(t) = new.friction.get(point) else {
                break;
            };
            let before = old.friction.get(point).copied().unwrap_or_default();
            for k in 0..attempt.system.tangents() {
                let mean = weights[0] * before[k] + weights[1] * t[k];
                if mean != 0.0 {
                    work += mean * self.way(attempt, point, k);
                }
            }
        }
        attempt.contact_factor() * work
    }

    /// Writes the friction of a contact into its report, and adds it to the resultant.
    pub(crate) fn report_friction(
        &self,
        attempt: &Attempt,
        contact: usize,
        report: &mut ContactReport,
    ) {
        // how many tangents there are is asked of all contacts
        if attempt.next.interface.friction.is_empty() {
            return;
        }
        let rubbing = Rubbing {
            tangents: &self.pairing.tangents[..attempt.system.tangents()],
            forces: &attempt.next.interface.friction,
            slips: &|point| self.slips[point] == Slip::Slip,
        };
        let points = attempt.system.points_of(contact);
        rubbing.add(self.active.within(points), report);
    }
}

/// Friction in the points of contacts.
pub struct Rubbing<'a> {
    /// Rows of the tangents.
    pub tangents: &'a [Rows],
    /// Friction force of each point along them, N; empty without friction.
    pub forces: &'a [[f64; 2]],
    /// Whether a point slips.
    pub slips: &'a dyn Fn(usize) -> bool,
}

impl Rubbing<'_> {
    /// Writes the friction of some points into the report of their contact, and adds it to the resultant.
    pub fn add(&self, points: impl Iterator<Item = usize>, report: &mut ContactReport) {
        let mut sum = [0.0; 3];
        for point in points {
            let Some(t) = self.forces.get(point) else {
                return;
            };
            for (rows, t) in self.tangents.iter().zip(t) {
                for (sum, direction) in sum.iter_mut().zip(rows.resultant(point)) {
                    *sum += t * direction;
                }
            }
            let slips = (self.slips)(point) && t != &[0.0; 2];
            report.slipping += usize::from(slips);
        }
        report.friction = sum.iter().map(|f| f * f).sum::<f64>().sqrt();
        for (resultant, f) in report.resultant.iter_mut().zip(sum) {
            *resultant += f;
        }
    }
}
