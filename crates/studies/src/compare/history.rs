//! What a comparison keeps of a run beside its summary: the force of every step or part of one, and the curves of the figures.

use carom_dynamics::{Observer, Order, Stepper, System};
use carom_output::results::Reference;
use carom_output::results::sensor::{ContactPoint, contact_point};
use carom_output::results::trace::Trace;

/// A force that is constant over each step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepForce {
    /// Start of the run and end of each step, s, increasing.
    times: Vec<f64>,
    /// ∫ F dt up to these times, N s.
    impulses: Vec<f64>,
}

impl StepForce {
    /// Adds a step of force `force` (N) that ends at `time` (s). The first call gives the start of the run.
    pub fn push(&mut self, time: f64, force: f64) {
        let added = self.times.last().map_or(0.0, |last| force * (time - last));
        let before = self.impulses.last().copied().unwrap_or(0.0);
        self.times.push(time);
        self.impulses.push(before + added);
    }

    /// ∫ F dt from the start to `time`, N s.
    pub fn impulse(&self, time: f64) -> f64 {
        let next = self.times.partition_point(|end| *end < time);
        match (next.checked_sub(1), self.times.get(next)) {
            (None, _) => self.impulses.first().copied().unwrap_or(0.0),
            (Some(last), None) => self.impulses[last],
            (Some(last), Some(end)) => {
                let part = (time - self.times[last]) / (end - self.times[last]);
                self.impulses[last] + part * (self.impulses[next] - self.impulses[last])
            }
        }
    }

    /// Times and forces of the steps, each at the end of its step and zero at the start, in the bounded number of a figure.
    pub(crate) fn curve(&self) -> (Vec<f64>, Vec<f64>) {
        let mut trace = Trace::default();
        if let Some(start) = self.times.first() {
            trace.push(*start, 0.0);
        }
        for (span, impulse) in self.times.windows(2).zip(self.impulses.windows(2)) {
            trace.push(span[1], (impulse[1] - impulse[0]) / (span[1] - span[0]));
        }
        trace.columns()
    }

    /// Largest magnitude of the force of a step, N.
    fn peak(&self) -> f64 {
        let spans = self.times.windows(2).zip(self.impulses.windows(2));
        let forces = spans.map(|(span, impulse)| (impulse[1] - impulse[0]) / (span[1] - span[0]));
        forces.fold(0.0, |peak, force| peak.max(force.abs()))
    }

    /// Relative L² distance of this force from another one, step by step of this one against the mean of the other over
    /// the step, on all steps in which the other one acts:
    /// sqrt(Σ dt (F − F̄)² / Σ dt F̄²). `None` where the other never acts.
    pub fn distance(&self, other: &StepForce) -> Option<f64> {
        // ends of steps that differ by rounding must not make a step meet the other force
        let least = 1e-9 * other.peak();
        let (mut error, mut size) = (0.0, 0.0);
        for (span, impulse) in self.times.windows(2).zip(self.impulses.windows(2)) {
            let dt = span[1] - span[0];
            let mean = (other.impulse(span[1]) - other.impulse(span[0])) / dt;
            let force = (impulse[1] - impulse[0]) / dt;
            if mean.abs() > least && dt > 0.0 {
                error += dt * (force - mean).powi(2);
                size += dt * mean * mean;
            }
        }
        (size > 0.0).then(|| (error / size).sqrt())
    }
}

/// Histories of one run.
#[derive(Clone, Debug, Default)]
pub struct History {
    /// Name of the contact that is compared.
    pub contact: Option<String>,
    /// Its force.
    pub force: StepForce,
    pub(crate) force_curve: Trace,
    /// Name of the side, displacement and velocity of its contact point along the axis.
    pub(crate) sides: Vec<(String, [Trace; 2])>,
    pub(crate) energy: Trace,
    pub(crate) dissipation: Trace,
    pub(crate) work_of_contact: Trace,
}

/// The observer that keeps them.
#[derive(Debug)]
pub struct Recorder {
    point: Option<ContactPoint>,
    history: History,
}

impl Recorder {
    /// Follows the contact `chosen` (its index), else that of the exact solution, else the first one.
    pub fn new(system: &System, reference: Option<&Reference>, chosen: Option<usize>) -> Recorder {
        let point = contact_point(system, reference, chosen);
        let sides = point.iter().flat_map(|point| &point.sides);
        let history = History {
            contact: point
                .as_ref()
                .map(|point| system.contacts[point.contact].name.clone()),
            sides: sides
                .map(|(name, _)| (name.clone(), Default::default()))
                .collect(),
            ..History::default()
        };
        Recorder { point, history }
    }

    /// What was kept.
    pub fn into_history(self) -> History {
        self.history
    }
}

impl Observer for Recorder {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        let (system, state, report) = (run.system(), run.state(), run.report());
        let (t, history, balance) = (report.time, &mut self.history, &report.balance);
        if let Some(point) = &self.point {
            for (end, _, contacts) in report.parts() {
                let force = contacts[point.contact].force;
                history.force.push(end, force);
                history.force_curve.push(end, force);
            }
            for ((_, traces), (_, sensor)) in history.sides.iter_mut().zip(&point.sides) {
                for (trace, order) in traces.iter_mut().zip(Order::ALL) {
                    trace.push(t, sensor.of(system, &state.motion, order));
                }
            }
        }
        history.energy.push(t, balance.energy());
        history.dissipation.push(t, balance.dissipation_scheme);
        history.work_of_contact.push(t, balance.work_contact);
        Ok(())
    }

    fn finish(&mut self, _run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn force(dt: f64, values: &[f64]) -> StepForce {
        let mut force = StepForce::default();
        force.push(0.0, 0.0);
        for (k, value) in values.iter().enumerate() {
            force.push((k + 1) as f64 * dt, *value);
        }
        force
    }

    #[test]
    fn the_mean_over_a_step_is_that_of_the_finer_force() {
        let fine = force(0.5, &[0.0, 0.0, 3.0, 5.0, 1.0, 3.0, 0.0, 0.0]);
        let coarse = force(1.0, &[0.0, 4.0, 2.0, 0.0]);
        assert_eq!(coarse.distance(&fine), Some(0.0));
        assert!((fine.impulse(1.75) - 2.75).abs() < 1e-15);
        assert_eq!(fine.impulse(9.0), 6.0);
        // a force of no effect where the reference acts: distance one; nothing to compare with: none
        assert_eq!(
            force(1.0, &[9.0, 0.0, 0.0, 9.0]).distance(&coarse),
            Some(1.0)
        );
        assert_eq!(coarse.distance(&force(1.0, &[0.0; 4])), None);
    }

    #[test]
    fn twice_the_force_is_at_distance_one_whatever_the_steps() {
        let one = force(0.25, &[1.0, 2.0, 7.0, 0.5]);
        let twice = force(0.25, &[2.0, 4.0, 14.0, 1.0]);
        assert!((twice.distance(&one).unwrap() - 1.0).abs() < 1e-15);
        let mut uneven = StepForce::default();
        for (time, force) in [
            (0.0, 0.0),
            (0.1, 2.0),
            (0.25, 2.0),
            (0.5, 4.0),
            (0.75, 14.0),
            (1.0, 1.0),
        ] {
            uneven.push(time, force);
        }
        assert!((uneven.distance(&one).unwrap() - 1.0).abs() < 1e-12);
    }
}
