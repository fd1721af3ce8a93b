//! Histories that the page plots, of every contact and every probe, in memory that does not grow with their number.

use carom_dynamics::{Order, State, StepReport, System};
use serde::{Deserialize, Serialize};

use crate::results::columns::moments;
use crate::results::impacts::ContactTotals;
use crate::results::sensor::Sensor;
use crate::results::trace::Trace;
use carom_dynamics::ContactPair;

/// Samples of all traces together, 16 bytes each, and the most of one.
const SAMPLES: usize = 1 << 19;
const MOST: usize = 1 << 14;

/// Supports with plots of their own, at most, and loads.
const NAMED: usize = 8;

/// What is followed.
#[derive(Debug)]
pub(crate) struct SeriesOf {
    /// Sensors of each probe.
    probes: Vec<Vec<Sensor>>,
    pub(crate) series: Series,
}

/// What was seen so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Series {
    pub(crate) contacts: Vec<ContactSeries>,
    /// Of each probe and component: displacement, velocity, acceleration.
    pub(crate) probes: Vec<Vec<[Trace; 3]>>,
    /// Force of the supports along the axes, mean of each step, N.
    pub(crate) supports: [Trace; 3],
    /// Force of each of the first named supports along the axes, N.
    pub(crate) named: Vec<[Trace; 3]>,
    /// Total force of each of the first loads along the axes, N.
    pub(crate) loads: Vec<[Trace; 3]>,
    /// Largest magnitude of a component of the residuals of linear momentum, N s.
    pub(crate) momentum_residual: Trace,
    /// Impulse of the supports so far, N s.
    given: [f64; 3],
}

/// Of a contact.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct ContactSeries {
    /// N.
    pub(crate) force: Trace,
    /// Mean of the force over the window of its peak, N.
    pub(crate) mean: Trace,
    /// Least gap, m.
    pub(crate) gap: Trace,
    /// Impulse so far, N s.
    pub(crate) impulse: Trace,
    /// Moment about the point that the contact names, N m; empty where it names none.
    pub(crate) moment: Vec<Trace>,
    given: f64,
}

impl Series {
    /// Whether another one, of a checkpoint, may take its place.
    fn takes(&self, kept: &Series) -> bool {
        let contact = |(own, kept): (&ContactSeries, &ContactSeries)| {
            own.force.takes(&kept.force)
                && own.mean.takes(&kept.mean)
                && own.gap.takes(&kept.gap)
                && own.impulse.takes(&kept.impulse)
                && takes_all(&own.moment, &kept.moment)
        };
        let probe = |(own, kept): (&Vec<[Trace; 3]>, &Vec<[Trace; 3]>)| takes_triples(own, kept);
        kept.contacts.len() == self.contacts.len()
            && self.contacts.iter().zip(&kept.contacts).all(contact)
            && kept.probes.len() == self.probes.len()
            && self.probes.iter().zip(&kept.probes).all(probe)
            && takes_all(&self.supports, &kept.supports)
            && takes_triples(&self.named, &kept.named)
            && takes_triples(&self.loads, &kept.loads)
            && self.momentum_residual.takes(&kept.momentum_residual)
    }
}

fn takes_all(own: &[Trace], kept: &[Trace]) -> bool {
    let mut pairs = own.iter().zip(kept);
    own.len() == kept.len() && pairs.all(|(own, kept)| own.takes(kept))
}

fn takes_triples(own: &[[Trace; 3]], kept: &[[Trace; 3]]) -> bool {
    let mut pairs = own.iter().zip(kept);
    own.len() == kept.len() && pairs.all(|(own, kept)| takes_all(own, kept))
}

impl SeriesOf {
    /// Whether this can be gone on with.
    pub(crate) fn takes(&self, kept: &Series) -> bool {
        self.series.takes(kept)
    }

    /// Nothing yet; `probes`: the sensors of each.
    pub(crate) fn new(system: &System, probes: &[Vec<Sensor>]) -> SeriesOf {
        let components: usize = probes.iter().map(Vec::len).sum();
        let named = system.supports.len().min(NAMED);
        let turning = system
            .contacts
            .iter()
            .filter(|pair| pair.moment.is_some())
            .count();
        let loads = system.nonlinear.load_names.len().min(NAMED);
        let triples = turning + components + named + loads;
        let count = 4 * system.contacts.len() + 3 * triples + 4;
        let limit = (SAMPLES / count).min(MOST);
        let trace = || Trace::of(limit);
        let contact = |pair: &ContactPair| ContactSeries {
            force: trace(),
            mean: trace(),
            gap: trace(),
            impulse: trace(),
            moment: match pair.moment {
                Some(_) => moments(system).map(|_| trace()).collect(),
                None => Vec::new(),
            },
            given: 0.0,
        };
        let of_probe = |sensors: &Vec<Sensor>| {
            let motion = |_: &Sensor| [trace(), trace(), trace()];
            sensors.iter().map(motion).collect()
        };
        SeriesOf {
            series: Series {
                contacts: system.contacts.iter().map(contact).collect(),
                probes: probes.iter().map(of_probe).collect(),
                supports: [trace(), trace(), trace()],
                named: (0..named).map(|_| [trace(), trace(), trace()]).collect(),
                loads: (0..loads).map(|_| [trace(), trace(), trace()]).collect(),
                momentum_residual: trace(),
                given: [0.0; 3],
            },
            probes: probes.to_vec(),
        }
    }

    /// Adds a step; `totals`: of the contacts, with the step in them.
    pub(crate) fn push(
        &mut self,
        system: &System,
        (state, report): (&State, &StepReport),
        totals: &[ContactTotals],
    ) {
        let (t, series) = (report.time, &mut self.series);
        let is_static = report.step <= system.static_steps();
        for (end, dt, contacts) in report.parts() {
            for (own, contact) in series.contacts.iter_mut().zip(contacts) {
                own.force.push(end, contact.force);
                for (trace, i) in own.moment.iter_mut().zip(moments(system)) {
                    trace.push(end, contact.moment[i]);
                }
                if !is_static {
                    own.given += contact.force * dt + contact.impulsive;
                }
            }
        }
        let contacts = series.contacts.iter_mut().zip(&report.contacts);
        for ((own, contact), totals) in contacts.zip(totals) {
            own.mean.push(t, totals.mean.mean());
            own.gap.push(t, contact.gap);
            own.impulse.push(t, own.given);
        }
        for (sensors, traces) in self.probes.iter().zip(&mut series.probes) {
            for (sensor, motion) in sensors.iter().zip(traces) {
                for (trace, order) in motion.iter_mut().zip(Order::ALL) {
                    trace.push(t, sensor.of(system, &state.motion, order));
                }
            }
        }
        let given = report.balance.impulse_supports.linear;
        if report.dt > 0.0 && !is_static {
            for (i, trace) in series.supports.iter_mut().enumerate() {
                trace.push(t, (given[i] - series.given[i]) / report.dt);
            }
        }
        series.given = given;
        for (traces, support) in series.named.iter_mut().zip(&report.supports) {
            for (trace, force) in traces.iter_mut().zip(support.linear) {
                trace.push(t, force);
            }
        }
        let residual = report.balance.momentum_residual.linear;
        let residual = residual.iter().fold(0.0_f64, |most, r| most.max(r.abs()));
        series.momentum_residual.push(t, residual);
    }

    /// Adds the forces of the loads at the end of a step, at `time` (s).
    pub(crate) fn push_loads(&mut self, time: f64, forces: &[[f64; 3]]) {
        for (traces, force) in self.series.loads.iter_mut().zip(forces) {
            for (trace, force) in traces.iter_mut().zip(force) {
                trace.push(time, *force);
            }
        }
    }
}
