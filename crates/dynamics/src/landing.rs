//! The cut of a step before a point in flight closes.
//!
//! Where in its step a closing falls decides what a law makes of it: with θ = ½ the displacement law stops a point that is
//! half a step away at the start, lets one that touches the surface bounce off, and a law in the rate may find a point open
//! by a hair. So the cut puts the closing where scheme and law take it best, at a distance of the *lead* times the speed of
//! the approach before the step that closes. Sizes then change in flight, where no contact carries a force, and an impact
//! is computed with equal steps. See `docs/src/theory/step.md`.

use carom_contact::law::{ContactLaw, Level};

use crate::step_map::{Row, StepMap};
use crate::system::Adaptive;

/// Distance before the surface at which a cut aims, in tolerances of a closed gap: rounding then closes no point too early.
const AIM: f64 = 10.0;

/// Part of a step by which a cut may miss its instant.
const SLACK: f64 = 1e-9;

/// The size that an attempt of size `tried` should have so that points in flight close at their lead within a later step of size
/// `planned`; `None` if the size will do. `first`: when the first of them is at its lead, after the start of the attempt;
/// `taken`: size of the step before; all in s.
///
/// A closing one or two steps ahead is approached in equal parts, so that no step is less than half of the next one.
pub fn cut(rules: &Adaptive, first: f64, [tried, planned, taken]: [f64; 3]) -> Option<f64> {
    if first >= (2.0 - SLACK) * planned {
        return None;
    }
    let (size, slack) = match first > (1.0 + SLACK) * planned {
        true => (0.5 * first, 0.1),
        false => (first, SLACK),
    };
    // the second of two equal parts has the factor of the first
    let size = match (size - taken).abs() <= SLACK * planned {
        true => taken,
        false => size,
    };
    ((tried - size).abs() > slack * planned && size >= rules.smallest).then_some(size)
}

/// Whether a point flies: open, and without a force for `patience` of the largest steps (s).
pub fn flies(
    (gap, flight): (f64, f64),
    tolerance: f64,
    (rules, largest): (&Adaptive, f64),
) -> bool {
    let least = f64::from(rules.patience) * largest;
    flight >= least && gap > tolerance && gap.is_finite()
}

/// Time until an open gap closes without forces, s, counted from the start of an attempt of `dt` (s); infinite if it does not.
///
/// The gap is the parabola through its value (m) and rate (m/s) at the start and its value at the end. `tolerance`: gap that
/// counts as closed, m.
pub fn arrival([gap, rate, end]: [f64; 3], dt: f64, tolerance: f64) -> f64 {
    let gap = gap - AIM * tolerance;
    if gap <= 0.0 {
        // there already, to the rounding of the cut: the parabola's other root is where the point would leave again
        return 0.0;
    }
    let end = end - AIM * tolerance;
    let bend = ((end - gap) / dt - rate) / dt;
    root(gap, rate, bend)
}

/// Time before a closing at which the step that closes should begin, s.
///
/// * A law in the gap: so that the force which ends the step with the gap zero ends it with the rate zero too.
/// * A law that a gap switches on closes points in a window of distances one step wide. The middle between its lower end
///   and the distance from which nothing penetrates: deep enough that what lifts the point a little does not open it.
///   Where the law closes the point further away than that: the middle of the window.
/// * A law in the rate that aims at the gap: so that both vanish at once.
pub fn lead(map: &StepMap, dt: f64, law: &dyn ContactLaw) -> f64 {
    let explicit = is_explicit(map);
    match (law.level(), law.reach(f64::from(u8::from(explicit)))) {
        (Level::Gap, _) => exact_lead(map, Level::Gap).max(0.0),
        (level, Some(reach)) => {
            let exact = exact_lead(map, level);
            let [low, high] = [reach - 1.0, reach].map(|ways| ways * dt);
            0.5 * (low + if exact > low { exact } else { high })
        }
        // the gap that counts is that of the end of an explicit step, of the start of the others
        (_, None) if explicit => dt,
        (_, None) => target_lead(map),
    }
}

/// A rigid point that approaches at the rate -1, gap left out, and the answer to a force; both in what a row makes of them.
struct Rigid<'a> {
    map: &'a StepMap,
    /// The force that stops it, in the row given to [`Rigid::stopped`].
    force: f64,
}

impl Rigid<'_> {
    /// The point that the force of the step stops in this row, a unit mass.
    fn stopped<'a>(map: &'a StepMap, row: &Row) -> Rigid<'a> {
        let free = Rigid { map, force: 0.0 };
        let pushed = row.x * map.contact / map.inertia.x + row.c;
        Rigid {
            map,
            force: -free.value(row) / pushed,
        }
    }

    /// A row of the step.
    fn value(&self, row: &Row) -> f64 {
        let map = self.map;
        // memories of a steady flight are velocities
        let x = (map.inertia.v + self.force * map.contact) / map.inertia.x;
        row.x * x - row.v - row.m + row.c * self.force
    }
}

/// The lead of a rigid point that the force of one step stops, in the quantity that its law constrains, and that then lies on
/// the surface: at the end of the step, or with an explicit scheme, whose force moves the point a step later, of the next.
fn exact_lead(map: &StepMap, level: Level) -> f64 {
    let (stopped, placed) = match level {
        Level::Gap => (&map.velocity, &map.gap),
        Level::Rate | Level::GapAndRate => (&map.rate, &map.displacement),
    };
    let point = Rigid::stopped(map, stopped);
    match is_explicit(map) {
        false => -point.value(placed),
        true => {
            let next = &map.displacement;
            let [u, v, a] =
                [&map.displacement, &map.velocity, &map.acceleration].map(|row| point.value(row));
            -(next.u * u + next.v * v + next.a * a)
        }
    }
}

/// The lead of a rigid point that an implicit step stops where the rate constrained is -g/dt.
fn target_lead(map: &StepMap) -> f64 {
    let point = Rigid::stopped(map, &map.velocity);
    let dt = map.moves;
    (-dt * point.value(&map.rate)).max(0.0)
}

/// Whether the displacement at the end of the step is known before the forces.
fn is_explicit(map: &StepMap) -> bool {
    map.displacement.x == 0.0
}

/// The first time after zero at which `value + slope t + bend t²`, positive at zero, is zero; infinite if there is none.
fn root(value: f64, slope: f64, bend: f64) -> f64 {
    let discriminant = slope * slope - 4.0 * bend * value;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    // of the two forms of the roots, the one without cancellation
    let sum = -0.5 * (slope + slope.signum() * discriminant.sqrt());
    let roots = [value / sum, sum / bend];
    let later = roots.into_iter().filter(|root| *root > 0.0);
    later.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use carom_contact::law::{Capture, Displacement, Reading, Velocity};

    use super::*;
    use crate::Scheme;
    use crate::scheme::{
        CentralDifference, LaursenChawla, Newmark, PaoliSchatzman, TchamwaWielgosz, Theta,
    };

    const DT: f64 = 0.125;

    fn lead_of(scheme: Scheme, law: &dyn ContactLaw) -> f64 {
        lead(&scheme.get().step_map(DT), DT, law) / DT
    }

    fn velocity(capture: Capture) -> Velocity {
        Velocity {
            capture,
            reading: Reading::Closed,
        }
    }

    #[test]
    fn the_first_root_of_a_parabola_is_found() {
        assert_eq!(root(1.0, -2.0, 0.0), 0.5);
        assert!((root(0.02, -0.3, 0.1) - (0.3 - 0.082f64.sqrt()) / 0.2).abs() < 1e-15);
        assert!((root(1.0, 1.0, -6.0) - 0.5).abs() < 1e-15);
        assert_eq!(root(1.0, 1.0, 0.0), f64::INFINITY);
        assert_eq!(root(1.0, -1.0, 1.0), f64::INFINITY);
    }

    /// The force that makes the gap vanish stops the point: the lead is dt (1 - θ), dt (1 - β/γ), none.
    #[test]
    fn a_law_in_the_gap_stops_a_point_that_begins_at_its_lead() {
        let law = Displacement::default();
        let of = |scheme| lead_of(scheme, &law);
        for theta in [0.5, 0.75, 1.0] {
            assert!((of(Scheme::Theta(Theta { theta })) - (1.0 - theta)).abs() < 1e-15);
        }
        for (beta, gamma) in [(0.25, 0.5), (0.49, 0.9)] {
            let expected = 1.0 - beta / gamma;
            assert!((of(Scheme::Newmark(Newmark { beta, gamma })) - expected).abs() < 1e-15);
        }
        for restitution in [0.0, 0.5] {
            let scheme = Scheme::PaoliSchatzman(PaoliSchatzman { restitution });
            assert!(of(scheme).abs() < 1e-15);
        }
    }

    /// A target for the gap at the end of the step is the displacement law.
    #[test]
    fn a_mean_rate_that_aims_at_the_gap_is_a_law_in_the_gap() {
        let found = lead_of(
            Scheme::LaursenChawla(LaursenChawla {}),
            &velocity(Capture::GapTarget),
        );
        assert!((found - 0.5).abs() < 1e-15);
    }

    /// Windows (κ - 1, κ] for κ = 0, ½, 1 ways of an implicit step and one more of an explicit one; a step of θ = ½ that stops the
    /// point moves it by half a way, the leapfrog by a whole one, that of Tchamwa and Wielgosz then lifts it by φ - 1.
    #[test]
    fn a_law_in_the_rate_finds_the_point_between_its_window_and_the_surface() {
        let theta = Scheme::Theta(Theta { theta: 0.5 });
        let leapfrog = Scheme::CentralDifference(CentralDifference {});
        let lifting = Scheme::TchamwaWielgosz(TchamwaWielgosz { phi: 1.25 });
        let expected = [
            (Capture::Now, [-0.25, 0.5, 0.375]),
            (Capture::Half, [0.0, 0.75, 0.625]),
            (Capture::Full, [0.25, 1.5, 1.5]),
            (Capture::GapTarget, [0.0, 1.0, 1.0]),
        ];
        for (capture, expected) in expected {
            let law = velocity(capture);
            let found = [theta, leapfrog, lifting].map(|scheme| lead_of(scheme, &law));
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-14,
                    "{capture:?}: {found} for {expected}"
                );
            }
        }
    }
}
