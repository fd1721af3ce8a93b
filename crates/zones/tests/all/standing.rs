//! Forces that stand over the outer step between zones of every scheme that takes them.

use carom_contact::Law;
use carom_contact::law::{Capture, Reading, Velocity};
use carom_dynamics::scheme::{CentralDifference, EnergyMomentum, Newmark, Theta};
use carom_dynamics::{Model, ModelContact, ModelTarget, Scheme, Stepper};
use carom_mesh::{Surface, generate};
use carom_zones::{LinkKind, ModelZone, Whole, Zoned};

use crate::schemes_apart::soft_bar;

const N: usize = 50;

fn velocity() -> Law {
    Law::Velocity(Velocity {
        capture: Capture::Half,
        reading: Reading::Closed,
    })
}

/// Two equal bars of unit impedance; the first meets the second with unit velocity, and takes `m[0]` steps in one, the second `m[1]`.
fn bars(schemes: [Scheme; 2], m: [u32; 2], law: Law) -> Zoned {
    let line = |name: &str, from: f64| {
        generate::line(name, [from, 0.0, 0.0], [from + 1.0, 0.0, 0.0], N, 1)
    };
    let mut mesh = line("one", -1.0);
    mesh.merge("other", line("other", 0.0)).unwrap();
    let mut bodies = vec![soft_bar(&mesh, "one"), soft_bar(&mesh, "other")];
    bodies[0].velocity = [1.0, 0.0, 0.0];
    let side = |group: &str, body: usize| {
        let cells: &[_] = &bodies[body].spec.cells;
        Surface::new(&mesh, &mesh.groups[group], cells).unwrap()
    };
    let target = ModelTarget::Surface(side("other.left", 1));
    let contact = ModelContact::new("c", side("one.right", 0), target, law);
    let zone = |name: &str, body: usize| ModelZone::new(name, vec![body], (schemes[body], m[body]));
    Zoned {
        zones: vec![zone("one", 0), zone("other", 1)],
        links: Vec::new(),
        kind: LinkKind::PrakashHjelmstad,
        model: Model {
            contacts: vec![contact],
            ..Model::new(bodies, mesh, schemes[0], 0.6 / N as f64)
        },
    }
}

fn schemes() -> Vec<Scheme> {
    let mut all = Scheme::registered();
    all.push(Scheme::EnergyMomentum(EnergyMomentum {}));
    // steps of several stages are refused
    all.retain(|scheme| scheme.get().stages().len() == 1);
    all
}

fn whole(zoned: &Zoned) -> Whole {
    Whole::new(zoned, zoned.whole().unwrap()).unwrap()
}

/// The exact force is Z v/2 as long as the waves take to the free ends and back. Momentum, balance of energy and sign of the work to the rounding of
/// some 250 outer steps of up to four inner ones; the mean of the force to 0.5 %, since what oscillates behind the front falls as 1/n. Energy
/// may swing with the term of the scheme in |a|²_M, of 1 % with elements that waves cross in 1.7 steps.
#[test]
fn bars_of_every_scheme_meet_in_unequal_steps_with_equal_impulses() {
    let mid_point = Scheme::Theta(Theta { theta: 0.5 });
    for scheme in schemes() {
        for (pair, m) in [
            ([scheme; 2], [1, 1]),
            ([scheme; 2], [1, 4]),
            ([scheme; 2], [3, 2]),
            ([scheme, mid_point], [4, 1]),
        ] {
            let name = format!("{} {m:?}", scheme.get().name());
            let mut run = whole(&bars(pair, m, velocity()));
            let start = run.state().ledger.balance;
            let (mut forces, mut worked, mut largest) = (Vec::new(), 0.0, 0.0_f64);
            while run.state().time < 3.0 {
                run.step().unwrap();
                let balance = &run.state().ledger.balance;
                let work = balance.work_links + balance.work_contact;
                // the works of a scheme with a lag are those of earlier places
                let lags = scheme
                    .get()
                    .energy_identity(1.0)
                    .is_some_and(|i| i.lag != 0.0);
                let gain = work - worked;
                assert!(lags || gain < 1e-14, "{name}: a contact works {gain:e}");
                worked = work;
                largest = largest.max(balance.energy());
                if (0.2..1.8).contains(&run.state().time) {
                    forces.push(run.report().contacts[0].force);
                }
            }
            assert_eq!(run.state().interface.force[0], 0.0, "{name}: they part");
            let mean = forces.iter().sum::<f64>() / forces.len() as f64;
            assert!((mean / 0.5 - 1.0).abs() < 5e-3, "{name}: force {mean}");
            let ledger = &run.state().ledger;
            let (balance, energy) = (&ledger.balance, start.energy());
            let left = ledger.largest_energy_residual / energy;
            assert!(left < 1e-12, "{name}: energy {left:e}");
            assert!(largest < 1.01 * energy, "{name}: {largest} of {energy}");
            let momentum = start.momentum.linear[0];
            let left = (balance.momentum.linear[0] - momentum).abs() / momentum;
            assert!(left < 1e-12, "{name}: momentum {left:e}");
            let left = balance.impulse_links.largest() / momentum;
            assert!(left < 1e-12, "{name}: action and reaction {left:e}");
        }
    }
}

/// The trapezoidal rule takes the mean of the forces at both ends and the mid-point rule those of the mean place; of linear bodies under a force that
/// stands both are the same.
#[test]
fn the_trapezoidal_rule_is_the_mid_point_rule_under_forces_that_stand() {
    let motion = |scheme: Scheme| {
        let mut run = whole(&bars([scheme; 2], [1, 3], velocity()));
        while run.state().time < 2.5 {
            run.step().unwrap();
        }
        let motion = &run.state().motion;
        [motion.u.clone(), motion.v.clone()].concat()
    };
    let newmark = motion(Scheme::Newmark(Newmark::default()));
    let mid_point = motion(Scheme::Theta(Theta { theta: 0.5 }));
    for (one, other) in newmark.iter().zip(&mid_point) {
        assert!((one - other).abs() < 1e-11, "{one} {other}");
    }
}

/// A state has the forces that stand, from which the next jump begins; a step taken twice begins from them too.
#[test]
fn a_run_that_was_cut_or_repeated_while_forces_stand_ends_in_the_same_bytes() {
    let explicit = Scheme::CentralDifference(CentralDifference {});
    let newmark = Scheme::Newmark(Newmark::default());
    for (schemes, m) in [([newmark, explicit], [1, 1]), ([explicit, newmark], [3, 2])] {
        let zoned = bars(schemes, m, velocity());
        let mut run = whole(&zoned);
        let mut again = whole(&zoned);
        again.force_rejections(3);
        let mut cut = Vec::new();
        for step in 0..40 {
            if step == 20 {
                cut = run.saved().unwrap();
            }
            run.step().unwrap();
            again.step().unwrap();
        }
        assert!(run.state().interface.force[0] > 0.0);
        assert!(run.saved().unwrap() == again.saved().unwrap(), "repeated");
        let mut resumed = Whole::resume(&zoned, zoned.whole().unwrap(), &cut).unwrap();
        for _ in 20..40 {
            resumed.step().unwrap();
        }
        assert!(run.saved().unwrap() == resumed.saved().unwrap(), "cut");
    }
}
