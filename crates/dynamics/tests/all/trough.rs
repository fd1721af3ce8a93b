//! Sliding on what curves, under the velocity law.

use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Side, Sphere};
use carom_dynamics::{Driver, Model, ModelTarget, Scheme, Stepper, System, scheme};

use crate::newton::{SOFT, square};

const GRAVITY: f64 = 0.1;
const RADIUS: f64 = 2.0;

/// A square that stands with its lower corners in a round trough and is pushed along it.
fn in_trough(dt: f64, capture: Capture) -> Model {
    let law = Law::Velocity(Velocity {
        capture,
        reading: Reading::Closed,
    });
    let theta = Scheme::Theta(scheme::Theta { theta: 0.5 });
    let mut model = square(theta, law, SOFT.into(), 8);
    model.bodies[0].velocity = [1e-3, 0.0, 0.0];
    model.gravity = [0.0, -GRAVITY, 0.0];
    model.contacts[0].primary = ModelTarget::rigid(Sphere {
        centre: [0.5, (RADIUS * RADIUS - 0.25_f64).sqrt(), 0.0],
        radius: RADIUS,
        side: Side::Inside,
    });
    model.dt = dt;
    model
}

#[test]
fn a_contact_that_curves_gains_no_energy_in_steps_of_many_elements() {
    // the corners carry half the weight each, and the turning of their normals, taken as that of an explicit step of their
    // mass alone, would be unstable beyond dt² P / (m R) = 128 g dt² / R = 4: 0.8 s, in which waves pass 15 elements
    let captures = [Capture::Half, Capture::Now, Capture::Full];
    let cases = captures.map(|capture| [0.5, 1.4, 2.0].map(|dt| (dt, capture)));
    for (dt, capture) in cases.into_iter().flatten() {
        let system = System::new(in_trough(dt, capture)).unwrap();
        let mut linear = Driver::new(system.clone()).unwrap();
        let mut newton = Driver::new(system).unwrap();
        for _ in 0..20 {
            linear.step().unwrap();
            newton.step().unwrap();
        }
        let [one, other] = [linear.state(), newton.state()].map(|state| &state.motion.u);
        let size = one.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        for (a, b) in one.iter().zip(other) {
            // the same equations, and twenty steps of rounding
            assert!((a - b).abs() < 1e-10 * size, "{dt} s, {capture:?}: {a} {b}");
        }
        let runs: [&mut dyn Stepper; 2] = [&mut linear, &mut newton];
        for run in runs {
            for _ in 0..200 {
                run.step().unwrap();
                let ledger = &run.state().ledger;
                let free = ledger.balance.energy() - ledger.balance.work_loads;
                // impacts and the sinking of closed points only take energy; rounding
                let bound = ledger.initial.energy() + 1e-9 * ledger.largest_energy;
                assert!(
                    free <= bound,
                    "{dt} s, {capture:?}, step {}: {free}",
                    run.state().step
                );
            }
            assert!(
                run.report().contacts[0].force > 0.0,
                "{dt} s, {capture:?}: it has left"
            );
        }
    }
}
