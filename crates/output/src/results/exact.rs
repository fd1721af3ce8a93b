//! The distance of the result from the exact solution, step by step.

use carom_dynamics::{Order, State, StepReport, System};
use carom_exact::{FarEnd, Motion, Solution};
use serde::{Deserialize, Serialize};

use crate::results::Reference;
use crate::results::sensor::{ContactPoint, Sensor};

/// Sums of squares of an error and of what it is relative to.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Norms {
    error: f64,
    size: f64,
}

impl Norms {
    fn add(&mut self, value: f64, exact: f64) {
        self.error += (value - exact).powi(2);
        self.size += exact * exact;
    }

    /// Relative L² error; `None` if there is nothing to be relative to.
    pub fn relative(&self) -> Option<f64> {
        (self.size > 0.0).then(|| (self.error / self.size).sqrt())
    }
}

/// The comparison, growing with the run.
#[derive(Debug)]
pub(crate) struct Comparison {
    pub(crate) reference: Reference,
    pub(crate) errors: Errors,
}

/// What the comparison has gathered.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Errors {
    /// Force of each step, or part of one, against the mean of the exact force over it, over those that meet the exact
    /// contact.
    pub force: Norms,
    /// Displacement of the contact points at the end of each step, counted from the start.
    pub displacement: Norms,
    start: Vec<f64>,
}

impl Comparison {
    pub(crate) fn new(reference: Reference) -> Comparison {
        Comparison {
            reference,
            errors: Errors::default(),
        }
    }

    pub(crate) fn push(
        &mut self,
        (system, point): (&System, &ContactPoint),
        state: &State,
        report: &StepReport,
    ) {
        let of = |s: &Sensor| s.of(system, &state.motion, Order::Displacement);
        let values = point.sides.iter().map(|(_, s)| of(s));
        if report.step == 0 {
            self.errors.start = values.collect();
            return;
        }
        let solution = &self.reference.solution;
        let beyond = |time: f64| time > solution.end_time() * (1.0 + 1e-9);
        for (to, dt, contacts) in report.parts().filter(|(to, ..)| !beyond(*to)) {
            let force = contacts[self.reference.contact].force;
            compare(&mut self.errors.force, solution, [to - dt, to], force);
        }
        if beyond(report.time) {
            return;
        }
        for (body, value) in values.enumerate().take(solution.motions().len()) {
            let start = self.errors.start.get(body).copied().unwrap_or(0.0);
            let exact = displacement(solution, body, report.time);
            self.errors.displacement.add(value - start, exact);
        }
    }
}

/// Adds a force to the norms if its step meets the exact contact.
fn compare(norms: &mut Norms, solution: &Solution, [from, to]: [f64; 2], force: f64) {
    let over = |end: f64| end * (1.0 - 1e-12);
    let contacts = solution.contacts();
    let next = contacts.partition_point(|contact| over(contact.end) <= from);
    if contacts.get(next).is_some_and(|c| c.start < over(to)) {
        norms.add(force, solution.force().mean(from, to));
    }
}

/// Displacement of the contact end of a bar since the start, along the axis from the secondary to the primary side, m.
pub fn displacement(solution: &Solution, body: usize, t: f64) -> f64 {
    let motion = &solution.motions()[body];
    sign(body) * (motion.displacement(0.0, t) - motion.displacement(0.0, 0.0))
}

/// Direction away from the contact along the axis.
fn sign(body: usize) -> f64 {
    if body == 0 { -1.0 } else { 1.0 }
}

/// Speed at which the mean motions of the bars part, m/s: each is positive away from the contact.
pub(crate) fn opening_speed(solution: &Solution, t: f64) -> f64 {
    let motions = solution.motions().iter();
    motions.map(|m| m.momentum(t) / m.bar().mass()).sum()
}

/// Whether the bars have parted by a time, and nothing but the contact has changed their momenta: neither a clamp nor
/// gravity.
pub(crate) fn parts_freely(solution: &Solution, t: f64) -> bool {
    let free =
        |motion: &Motion| motion.bar().far_end == FarEnd::Free && motion.bar().acceleration == 0.0;
    let parted = |contact: &carom_exact::Contact| contact.end < t;
    solution.motions().iter().all(free) && solution.contacts().iter().all(parted)
}

/// Largest exact force up to a time, N.
pub fn peak_force(solution: &Solution, t: f64) -> f64 {
    let contacts = solution.contacts().iter();
    contacts
        .filter(|contact| contact.start < t)
        .fold(0.0, |peak, contact| peak.max(contact.peak_force))
}

/// An exact curve: abscissae and ordinates, jumps as two samples at one instant.
pub type Polyline = (Vec<f64>, Vec<f64>);

/// Displacement, velocity and acceleration of the contact end of a bar up to a time, along the axis. The acceleration
/// is that between the jumps of the velocity, where it is infinite.
pub fn motion_curves(solution: &Solution, body: usize, end: f64) -> [Polyline; 3] {
    let motion = &solution.motions()[body];
    let mut curves: [Polyline; 3] = Default::default();
    for pair in instants(motion, end.min(solution.end_time())).windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let at = |part: f64| from + part * (to - from);
        // both ends as they are: `at(1.0)` may lie beyond `to` by rounding, and the next sample then before it
        for time in [from, at(0.25), at(0.5), at(0.75), to] {
            add(&mut curves[0], time, displacement(solution, body, time));
        }
        // The velocity is linear between two instants, and may jump at both.
        let [a, b] = [0.25, 0.75].map(|part| sign(body) * motion.velocity(0.0, at(part)));
        let slope = 2.0 * (b - a);
        add(&mut curves[1], from, a - 0.25 * slope);
        add(&mut curves[1], to, b + 0.25 * slope);
        add(&mut curves[2], from, slope / (to - from));
        add(&mut curves[2], to, slope / (to - from));
    }
    curves
}

/// The exact force up to a time.
pub fn force_curve(solution: &Solution, end: f64) -> Polyline {
    let mut curve = Polyline::default();
    for (time, force) in solution.force().polyline() {
        if time >= end {
            add(&mut curve, end, solution.force().value(end));
            break;
        }
        add(&mut curve, time, force);
    }
    curve
}

fn add(curve: &mut Polyline, x: f64, y: f64) {
    curve.0.push(x);
    curve.1.push(y);
}

/// Instants of jumps and kinks at the contact end of a bar, from 0 to `end`, these included.
fn instants(motion: &Motion, end: f64) -> Vec<f64> {
    let delay = motion.bar().round_trip();
    let emitted = motion.wave().breakpoints();
    let mut instants: Vec<f64> = emitted.flat_map(|t| [t, t + delay]).collect();
    instants.retain(|t| *t > 0.0 && *t < end);
    instants.extend([0.0, end]);
    instants.sort_unstable_by(f64::total_cmp);
    // Arrivals that differ by rounding are one.
    instants.dedup_by(|b, a| *b - *a <= 1e-9 * end);
    instants
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    reason = "clippy sees only #[test] functions as tests"
)]
mod tests {
    use super::*;
    use carom_exact::{Bar, Impact, solve};

    /// Two steel bars of 254 mm and 1 m, whose round trips divide nothing.
    fn unequal() -> Solution {
        let bar = |length| Bar::new(length, 6.45e-4, 2.07e11, 7844.0);
        let impact = Impact::TwoBars {
            secondary: bar(0.254).with_velocity(-5.1359),
            primary: bar(1.0),
            gap: 0.0,
        };
        solve(&impact, 5e-4).unwrap()
    }

    #[test]
    fn exact_curves_never_go_back_and_end_at_the_end() {
        let solution = unequal();
        for k in 1..500 {
            let end = f64::from(k) * 1e-6;
            for body in [0, 1] {
                for (x, y) in motion_curves(&solution, body, end) {
                    assert_eq!(x.len(), y.len());
                    assert!(x.windows(2).all(|pair| pair[0] <= pair[1]), "{end}");
                    // arrivals that differ from the end by rounding are it
                    assert!((x[x.len() - 1] - end).abs() <= 1e-9 * end);
                }
            }
        }
    }
}
