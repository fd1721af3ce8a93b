//! How often the points of a contact close, and which of it is chatter.

use serde::{Deserialize, Serialize};

/// A closing of a contact point whose force is not worth counting yet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Waiting {
    /// None.
    #[default]
    Nothing,
    /// One that is due.
    Due,
    /// One sooner after the last opening than mesh and step can tell.
    Hasty,
    /// None, but the point is closed by a hasty closing that has been counted.
    Chattering,
}

/// Elements and steps to a period, the least that mesh and step carry: two to a half-wave. What a point does in a shorter time is
/// theirs and not that of the bodies.
const RESOLVED: f64 = 4.0;

/// Part of the largest force so far, shared by the closed points, up to which a force is no closing: what rests on a surface trembles
/// there, in points and as a whole.
pub(crate) const TREMBLE: f64 = 0.01;

/// Part of the impulse of a contact up to which its hasty closings are no chatter: they change nothing that anybody reads.
const SHARE: f64 = 0.01;

/// What rounding of the time leaves of a flight of a whole number of steps, over its length.
const ROUNDING: f64 = 1e-6;

/// Closings of points in a step, by kind.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Closings {
    /// Those that are due.
    pub(crate) due: u64,
    /// Those that are not.
    pub(crate) hasty: u64,
    /// Those of points whose elements are all deleted.
    pub(crate) loose: u64,
    /// Σ force times step of points that are closed hastily, N s.
    pub(crate) hasty_impulse: f64,
}

/// A step in which points of a contact close.
pub(crate) struct Closing<'a> {
    /// Time at its start and end, s.
    pub(crate) span: [f64; 2],
    /// Its length; 0 of a static step, s.
    pub(crate) dt: f64,
    /// Normal forces of all points at the start and of the step, N.
    pub(crate) forces: [&'a [f64]; 2],
    /// Force of a point up to which it is no closing, N.
    pub(crate) least: f64,
    /// Time of a wave over the smallest element, s.
    pub(crate) passage: f64,
}

impl Closing<'_> {
    /// Counts the closings of some points whose force begins in the step, or has begun and becomes worth counting. `opened`: when that of each
    /// point ended last, s; `waiting`: what is to be counted of each; `loose`: whether the elements of each are deleted, empty for none; all
    /// by the number of the point.
    pub(crate) fn count(
        &self,
        points: impl Iterator<Item = usize>,
        (opened, waiting, loose): (&mut [f64], &mut [Waiting], &[bool]),
    ) -> Closings {
        let ([start, end], [old, new]) = (self.span, self.forces);
        let soon = RESOLVED * (1.0 - ROUNDING) * f64::max(end - start, self.passage);
        let mut counted = Closings::default();
        for point in points {
            let waits = &mut waiting[point];
            match (old[point] != 0.0, new[point] != 0.0) {
                (true, false) => match std::mem::take(waits) {
                    // of a closing that did not count the opening does not either
                    Waiting::Due | Waiting::Hasty => {}
                    Waiting::Nothing | Waiting::Chattering => opened[point] = end,
                },
                (false, true) if loose.get(point) == Some(&true) => counted.loose += 1,
                (false, true) => {
                    *waits = match start - opened[point] < soon {
                        true => Waiting::Hasty,
                        false => Waiting::Due,
                    };
                }
                (true, true) | (false, false) => {}
            }
            if matches!(waits, Waiting::Hasty | Waiting::Chattering) {
                counted.hasty_impulse += self.dt * new[point];
            }
            match waits {
                Waiting::Hasty if new[point] > self.least => {
                    counted.hasty += 1;
                    *waits = Waiting::Chattering;
                }
                Waiting::Due if new[point] > self.least => {
                    counted.due += 1;
                    *waits = Waiting::Nothing;
                }
                Waiting::Nothing | Waiting::Due | Waiting::Hasty | Waiting::Chattering => {}
            }
        }
        counted
    }
}

/// Changes of status to a closing that is due, of closings that are due and that are not, and of the impulses of the latter and of the contact, N s.
pub(crate) fn chatter([due, hasty]: [u64; 2], [hasty_impulse, impulse]: [f64; 2]) -> f64 {
    let hasty = match hasty_impulse > SHARE * impulse.abs() {
        true => hasty,
        false => 0,
    };
    match due {
        0 => 0.0,
        due => 2.0 * (due + hasty) as f64 / due as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closings of one point that has these forces (N) in steps of 0.1 s after it was open, and its chatter.
    fn counted(forces: &[f64]) -> (Closings, f64) {
        let (mut opened, mut waiting) = ([f64::NEG_INFINITY], [Waiting::default()]);
        let (mut sum, mut impulse) = (Closings::default(), 0.0);
        let (mut before, mut peak) = (0.0, 0.0_f64);
        for (k, &force) in forces.iter().enumerate() {
            let step = Closing {
                // sums of tenths are no whole numbers of steps
                span: [k, k + 1].map(|k| 7.0 + 0.1 * k as f64),
                dt: 0.1,
                forces: [&[before], &[force]],
                least: TREMBLE * peak,
                passage: 0.0,
            };
            let own = step.count(0..1, (&mut opened, &mut waiting, &[]));
            sum.due += own.due;
            sum.hasty += own.hasty;
            sum.hasty_impulse += own.hasty_impulse;
            impulse += 0.1 * force;
            (before, peak) = (force, peak.max(force));
        }
        let chatter = chatter([sum.due, sum.hasty], [sum.hasty_impulse, impulse]);
        (sum, chatter)
    }

    /// Blows of 1 N with so many steps without a force between them.
    fn blows(flight: usize) -> (Closings, f64) {
        let blow = [vec![0.0; flight], vec![1.0]].concat();
        counted(&blow.repeat(10))
    }

    #[test]
    fn a_point_that_closes_again_within_four_steps_chatters_and_after_five_it_does_not() {
        for flight in 1..=4 {
            let (closings, chatter) = blows(flight);
            assert_eq!((closings.due, closings.hasty), (1, 9), "{flight}");
            assert_eq!(chatter, 20.0);
        }
        let (closings, chatter) = blows(5);
        assert_eq!((closings.due, closings.hasty), (10, 0));
        assert_eq!(chatter, 2.0);
    }

    #[test]
    fn hasty_closings_that_carry_no_impulse_are_no_chatter() {
        let mut forces = vec![1.0; 1000];
        forces.extend([0.0, 0.5, 0.5, 0.0, 0.0, 0.0]);
        let (closings, chatter) = counted(&forces);
        assert_eq!((closings.due, closings.hasty), (1, 1));
        // one part in a thousand
        assert!((closings.hasty_impulse - 0.1).abs() < 1e-12);
        assert_eq!(chatter, 2.0);
        // one in fifty
        assert_eq!(counted(&forces[950..]).1, 4.0);
    }

    #[test]
    fn a_force_below_a_hundredth_of_the_largest_is_no_closing_and_ends_no_flight() {
        let tremble = [1.0, 0.0, 0.0, 0.009, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.009];
        let (closings, _) = counted(&tremble);
        assert_eq!((closings.due, closings.hasty), (1, 0));
        // one that grows counts when it is worth it, by the flight before it
        let grows = [1.0, 0.0, 0.009, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.009, 0.5];
        let (closings, _) = counted(&grows);
        assert_eq!((closings.due, closings.hasty), (2, 1));
        let flight = [1.0, 0.0, 0.0, 0.0, 0.001, 0.0, 0.0, 1.0];
        let (closings, _) = counted(&flight);
        assert_eq!((closings.due, closings.hasty), (2, 0));
    }
}
