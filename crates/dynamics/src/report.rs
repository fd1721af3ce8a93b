//! What a step did: of each contact, and the balance at its end.

use serde::{Deserialize, Serialize};

use crate::ledger::Balance;
use crate::resultant::Resultant;

/// What one contact did in a step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactReport {
    /// Sum of the normal forces of its points, N, compressive positive.
    pub force: f64,
    /// Impulse of the step that is in no force, N s: of a projection or another stage after a step, and of the force that it
    /// changes at the beginning of the next. Force times step and this are the impulse.
    pub impulsive: f64,
    /// Force on the secondary body, N.
    pub resultant: [f64; 3],
    /// The part of it of the normal forces, N.
    pub normal: [f64; 3],
    /// Magnitude of the sum of the friction forces of its points, N.
    pub friction: f64,
    /// Points that slip with a friction force.
    pub slipping: usize,
    /// Moment of the force on the secondary body about the point that the contact names, friction included, N m; zero where it names
    /// none ([`moment`](crate::moment())).
    pub moment: [f64; 3],
    /// Energy that friction took in the step, J.
    pub friction_loss: f64,
    /// Least gap at the end of the step, m; infinite where nothing faces anything.
    pub gap: f64,
    /// Gap rate at the point of the least gap, m/s: the largest of several with the same gap.
    pub rate: f64,
    /// Points with a force.
    pub closed: usize,
    /// Points whose force began or ended in this step.
    pub status_changes: usize,
    /// Σ |P (ġ₊ + opening)| dt, J: zero when forces act on closed points only.
    pub persistency_defect: f64,
    /// Nodes of the secondary surface whose supports are partly closed: there the pressure of the weak form depends on r.
    /// Zero with another integration.
    pub mixed: usize,
}

/// What all contacts did in a part of a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactSample {
    /// Time at its end, s.
    pub time: f64,
    /// Its length, s; of a stage of a step how long its forces give their impulse ([`Durations`](crate::scheme::Durations)). The sum is the
    /// length of the step.
    pub dt: f64,
    /// By contact.
    pub contacts: Vec<ContactReport>,
}

/// Something that a step went on after, and that people should know.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notice {
    /// How often.
    pub count: u32,
    /// Where, or why, the first time.
    pub place: String,
}

impl Notice {
    /// Once more.
    pub(crate) fn add(&mut self, place: impl FnOnce() -> String) {
        if self.count == 0 {
            self.place = place();
        }
        self.count += 1;
    }

    fn join(&mut self, other: &Notice) {
        if self.count == 0 {
            self.place.clone_from(&other.place);
        }
        self.count += other.count;
    }
}

/// All that a step went on after.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notices {
    /// Iterations whose motion was halved as often as it may be, that left the forces less in balance than before, and were taken: where the imbalance
    /// was largest. The step has come to its tolerance nevertheless.
    pub worse: Notice,
    /// Iterations of linear equations that ended without a solution, after which the step was taken with factors: why.
    pub factored: Notice,
    /// Contact problems whose tension, which the law cuts off, did not settle in the last iteration: the first point.
    pub clipped: Notice,
}

impl Notices {
    /// Adds those of a part of the step, or of a zone.
    pub fn join(&mut self, other: &Notices) {
        self.worse.join(&other.worse);
        self.factored.join(&other.factored);
        self.clipped.join(&other.clipped);
    }

    /// All of them, in the order of the fields.
    pub fn all(&self) -> [&Notice; 3] {
        [&self.worse, &self.factored, &self.clipped]
    }
}

/// What a step did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Number of the step, from 1; 0 for the initial state.
    pub step: u64,
    /// Time at the end of the step, s.
    pub time: f64,
    /// Size of the step, s; zero for the initial state.
    pub dt: f64,
    /// Attempts made, the last one taken.
    pub attempts: u32,
    /// By contact. Of a step in parts: forces are means over the step, gap and rate those at its end, closed, slipping and
    /// mixed the most in one of its parts, the rest sums.
    pub contacts: Vec<ContactReport>,
    /// Energies, works and momentum at the end of the step.
    pub balance: Balance,
    /// Forces of the named supports ([`System::supports`](crate::System::supports)) on the bodies, with the moments about their
    /// centres, as the scheme has them in its balance: at the end of the step, or the mean over it of schemes that balance means. Empty
    /// before the first step, and of zones that step apart.
    pub supports: Vec<Resultant>,
    /// Passes of the status loop; in zones the passes over the step until the links hold.
    pub passes: usize,
    /// What the contacts did in the parts of the step, where it has some: the inner steps of zones, the halves of a nonlinear
    /// step that found no equilibrium, the stages of a scheme of several. A contact of a zone without inner steps does in each part what it does in the step.
    pub samples: Vec<ContactSample>,
    /// What the step went on after; of zones with inner steps in the last of them.
    pub notices: Notices,
    /// Whether the state is known at watched nodes alone, and contact points where somebody looks at them, since other processes have the rest.
    pub partial: bool,
}

impl StepReport {
    /// End, length (both s) and contacts of each part of the step; of the step itself if it has none.
    pub fn parts(&self) -> impl Iterator<Item = (f64, f64, &[ContactReport])> {
        let whole = self.samples.is_empty();
        let step = whole.then_some((self.time, self.dt, &self.contacts[..]));
        let parts = self.samples.iter();
        step.into_iter()
            .chain(parts.map(|part| (part.time, part.dt, &part.contacts[..])))
    }

    /// Adds a part that ends at `time` (s) after `dt` (s), in which the contacts did what `contacts` says now.
    pub fn add_part(&mut self, time: f64, dt: f64) {
        self.samples.push(ContactSample {
            time,
            dt,
            contacts: self.contacts.clone(),
        });
    }

    /// Writes what the contacts did in the step from its parts, if it has some.
    pub fn join_parts(&mut self) {
        for (contact, whole) in self.contacts.iter_mut().enumerate() {
            let parts = self.samples.iter();
            join(parts.map(|part| (part.dt, &part.contacts[contact])), whole);
        }
    }
}

/// What a contact did in the parts of a step, as [`StepReport::contacts`] has it.
fn join<'a>(parts: impl Iterator<Item = (f64, &'a ContactReport)>, whole: &mut ContactReport) {
    let (mut sum, mut length) = (ContactReport::default(), 0.0);
    for (dt, part) in parts {
        length += dt;
        sum.force += dt * part.force;
        sum.impulsive += part.impulsive;
        for i in 0..3 {
            sum.resultant[i] += dt * part.resultant[i];
            sum.normal[i] += dt * part.normal[i];
            sum.moment[i] += dt * part.moment[i];
        }
        sum.friction += dt * part.friction;
        sum.slipping = sum.slipping.max(part.slipping);
        (sum.gap, sum.rate) = (part.gap, part.rate);
        sum.closed = sum.closed.max(part.closed);
        sum.mixed = sum.mixed.max(part.mixed);
        sum.status_changes += part.status_changes;
        sum.persistency_defect += part.persistency_defect;
    }
    if length > 0.0 {
        *whole = ContactReport {
            force: sum.force / length,
            resultant: sum.resultant.map(|r| r / length),
            normal: sum.normal.map(|r| r / length),
            moment: sum.moment.map(|r| r / length),
            friction: sum.friction / length,
            ..sum
        };
    }
}
