//! How long a force gives its impulse, in steps of one stage or of several.

use crate::TimeScheme;
use crate::step_map::Impulse;

/// How long a force gives its impulse, s. With F the force of a stage and R as the momentum takes it ([`Impulse`]):
///
/// `Σ force F = impulse given so far + later R`, if all steps have one size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Durations {
    /// Impulse of the force of the stage over the force, in this stage and in all after it: the length of the step where it has one stage.
    pub force: f64,
    /// What R at the end of the stage gives after it, over R.
    pub later: f64,
    /// What R at the start of the stage gives from there on, over R, where steps before it were as long.
    pub before: f64,
}

impl Durations {
    /// Those of a step of one stage, of length `dt` (s).
    pub fn of_step(dt: f64, impulse: &Impulse) -> Durations {
        let later = dt * impulse.later();
        Durations {
            force: dt,
            later,
            before: later,
        }
    }

    /// Those of stage `number` of a step of `dt` (s) of the scheme.
    pub fn of_stage(scheme: &dyn TimeScheme, number: usize, dt: f64) -> Durations {
        let lengths = scheme.stages();
        let stage = |k: usize| {
            let k = k % lengths.len();
            (lengths[k] * dt, scheme.stage_map(k, dt).contact_impulse)
        };
        if lengths.len() == 1 {
            let (dt, impulse) = stage(0);
            return Durations::of_step(dt, &impulse);
        }
        // later(k) = h of_start - carry later(k + 1), of the stage k + 1 and its length h, around the step
        let (mut given, mut left) = (0.0, 1.0);
        for k in 1..=lengths.len() {
            let (h, impulse) = stage(number + k);
            given += left * h * impulse.of_start();
            left *= -impulse.carry;
        }
        let later = given / (1.0 - left);
        let (h, impulse) = stage(number);
        Durations {
            force: impulse.gain * (h * impulse.new + later),
            later,
            before: h * impulse.of_start() - impulse.carry * later,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Durations;
    use crate::{Bathe, Scheme, TimeScheme};

    /// Impulse of a unit force in one stage alone, over this and eight steps after it.
    fn given(scheme: &dyn TimeScheme, stage: usize, dt: f64) -> f64 {
        let lengths = scheme.stages();
        let (mut before, mut sum) = (0.0, 0.0);
        for k in 0..8 * lengths.len() {
            let map = scheme.stage_map(k % lengths.len(), dt);
            let impulse = map.contact_impulse;
            let force = if k == stage { 1.0 } else { 0.0 };
            let now = impulse.gain * force - impulse.carry * before;
            sum += lengths[k % lengths.len()] * dt * (impulse.old * before + impulse.new * now);
            before = now;
        }
        sum
    }

    #[test]
    fn a_force_gives_its_whole_impulse_over_its_duration() {
        let dt = 0.3;
        for scheme in Bathe::usual() {
            let durations = [0, 1].map(|stage| Durations::of_stage(&scheme, stage, dt));
            for (stage, own) in durations.iter().enumerate() {
                let error = own.force - given(&scheme, stage, dt);
                assert!(error.abs() < 1e-15, "{scheme:?}, stage {stage}: {error}");
                let next = &durations[(stage + 1) % 2];
                assert!((own.later - next.before).abs() < 1e-15, "{scheme:?}");
            }
            let sum: f64 = durations.iter().map(|own| own.force).sum();
            assert!((sum - dt).abs() < 1e-15, "{scheme:?}: {sum}");
        }
    }

    #[test]
    fn durations_of_one_stage_are_those_of_the_step() {
        let dt = 0.3;
        let one = |scheme: &Scheme| scheme.get().stages().len() == 1;
        for scheme in Scheme::registered().iter().filter(|scheme| one(scheme)) {
            let scheme = scheme.get();
            let of_step = Durations::of_step(dt, &scheme.step_map(dt).contact_impulse);
            assert_eq!(Durations::of_stage(scheme, 0, dt), of_step);
        }
    }
}
