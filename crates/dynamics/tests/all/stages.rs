//! Steps of schemes of several stages.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::Plane;
use carom_contact::law::{Displacement, Law};
use carom_dynamics::scheme::Bathe;
use carom_dynamics::{
    Driver, Iteration, Model, ModelBody, ModelContact, ModelTarget, Scheme, Support, System,
};
use carom_materials::{Law as Material, NeoHooke};
use carom_mesh::{Surface, generate};

use crate::newton::{SOFT, square};

const EXACT: Law = Law::Displacement(Displacement { projection: false });
const SPEED: f64 = 0.2;
const GAP: f64 = 0.01;

/// A bar of `n` elements that is held at its left end, and moves to the right towards a wall.
fn bar(scheme: Bathe, n: usize, dt: f64) -> Driver {
    let mesh = generate::line("a", [0.0; 3], [1.0, 0.0, 0.0], n, 1);
    let cells = mesh.groups["a"].elements.clone();
    let spec = BodySpec::new("a", cells.clone(), Kinematics::Bar { area: 0.5 }, SOFT);
    let wall = ModelTarget::rigid(Plane {
        point: [1.0 + GAP, 0.0, 0.0],
        normal: [-1.0, 0.0, 0.0],
    });
    let end = Surface::new(&mesh, &mesh.groups["a.right"], &cells).unwrap();
    let model = Model {
        supports: vec![Support {
            nodes: mesh.group_nodes(&mesh.groups["a.left"]),
            fix: [true, false, false],
            fix_rotations: [false; 3],
        }],
        contacts: vec![ModelContact::new("wall", end, wall, EXACT)],
        ..Model::new(
            vec![ModelBody {
                velocity: [SPEED, 0.0, 0.0],
                ..ModelBody::new(spec)
            }],
            mesh,
            Scheme::Bathe(scheme),
            dt,
        )
    };
    Driver::new(System::new(model).unwrap()).unwrap()
}

/// An oscillator of unit mass at a wall, by the formulas of the two stages as they are printed.
struct Printed {
    square: f64,
    motion: [f64; 3],
}

impl Printed {
    /// End of a stage in which `u₊ = known u + factor a₊` and `v₊ = known v + rate a₊`, and the force of the wall.
    fn stage(&self, [u, factor]: [f64; 2], [v, rate]: [f64; 2]) -> ([f64; 3], f64) {
        let free = -self.square * u / (1.0 + self.square * factor);
        let a = match u + factor * free > GAP {
            true => (GAP - u) / factor,
            false => free,
        };
        let end = [u + factor * a, v + rate * a, a];
        (end, -(a + self.square * end[0]))
    }

    /// A step, and the forces of its stages.
    fn step(&mut self, gamma: f64, dt: f64) -> [f64; 2] {
        let [u, v, a] = self.motion;
        let half = 0.5 * gamma * dt;
        let known = [u + 2.0 * half * v + half * half * a, half * half];
        let (middle, first) = self.stage(known, [v + half * a, half]);
        let [c1, c2, c3] = [
            (1.0 - gamma) / (gamma * dt),
            -1.0 / ((1.0 - gamma) * gamma * dt),
            (2.0 - gamma) / ((1.0 - gamma) * dt),
        ];
        let speed = -(c1 * v + c2 * middle[1]) / c3;
        let place = (speed - c1 * u - c2 * middle[0]) / c3;
        let (end, second) = self.stage([place, 1.0 / (c3 * c3)], [speed, 1.0 / c3]);
        self.motion = end;
        [first, second]
    }
}

#[test]
fn an_oscillator_at_a_wall_moves_by_the_printed_formulas() {
    let dt = 0.07;
    for scheme in [Bathe::default(), Bathe { gamma: 0.5 }] {
        let mut driver = bar(scheme, 1, dt);
        // half of the mass of the bar is at its end
        let mass = 0.5 * SOFT.density * 0.5;
        let mut printed = Printed {
            square: SOFT.young * 0.5 / mass,
            motion: [0.0, SPEED, 0.0],
        };
        let mut touched = 0;
        for _ in 0..40 {
            driver.step().unwrap();
            let forces = printed.step(scheme.gamma, dt);
            let motion = &driver.state().motion;
            let [u, v, a] = printed.motion;
            let scale = SPEED / dt;
            // rounding of a few dozen operations with factors of order one
            assert!(
                (motion.u[1] - u).abs() < 1e-13 * SPEED,
                "{} {u}",
                motion.u[1]
            );
            assert!(
                (motion.v[1] - v).abs() < 1e-12 * SPEED,
                "{} {v}",
                motion.v[1]
            );
            assert!(
                (motion.a[1] - a).abs() < 1e-11 * scale,
                "{} {a}",
                motion.a[1]
            );
            let parts: Vec<f64> = driver
                .report()
                .parts()
                .map(|part| part.2[0].force)
                .collect();
            assert_eq!(parts.len(), 2);
            for (part, force) in parts.iter().zip(forces) {
                assert!(
                    (part - mass * force).abs() < 1e-11 * scale,
                    "{part} {force}"
                );
                touched += usize::from(force > 0.0);
            }
            let length: f64 = driver.report().parts().map(|part| part.1).sum();
            assert!((length - dt).abs() < 1e-15);
        }
        assert!(touched > 0);
        let ledger = &driver.state().ledger;
        assert!(ledger.largest_energy_residual < 1e-13 * ledger.largest_energy);
        assert!(ledger.largest_momentum_residual < 1e-13 * ledger.largest_momentum);
    }
}

#[test]
fn a_linear_body_is_factored_once_for_each_matrix_of_the_stages() {
    for (gamma, factors) in [(Bathe::default().gamma, 1), (0.5, 2)] {
        let mut driver = bar(Bathe { gamma }, 10, 0.07);
        for _ in 0..20 {
            driver.step().unwrap();
        }
        assert_eq!(driver.costs().work.factorisations, factors, "{gamma}");
    }
}

#[test]
fn energy_never_grows_in_free_vibration_of_any_step() {
    for scheme in [Bathe::default(), Bathe { gamma: 0.5 }] {
        for dt in [0.01, 0.3, 10.0] {
            let mut driver = bar(scheme, 10, dt);
            let n = driver.system().unknowns();
            // away from the wall, in all modes; the left end is held
            let u: Vec<f64> = (0..n)
                .map(|i| -1e-3 * f64::from(u8::from(i == 4)))
                .collect();
            driver.restart(&u, &vec![0.0; n]).unwrap();
            let mut last = driver.state().ledger.balance.energy();
            let first = last;
            for _ in 0..50 {
                driver.step().unwrap();
                if driver.report().contacts[0].force > 0.0 {
                    break;
                }
                let energy = driver.state().ledger.balance.energy();
                // rounding
                assert!(
                    energy < last + 1e-14 * first,
                    "{scheme:?}, {dt}: {last} {energy}"
                );
                last = energy;
            }
        }
    }
}

#[test]
fn a_step_in_halves_has_both_stages_in_each_half() {
    let fall = |dt: f64, passes: usize| {
        let material = Material::NeoHooke(NeoHooke { initial: SOFT });
        let mut model = square(Scheme::Bathe(Bathe::default()), EXACT, material, 2);
        model.bodies[0].velocity = [0.0, -1.0, 0.0];
        model.dt = dt;
        model.nonlinear.iteration = Iteration {
            passes,
            ..Iteration::default()
        };
        Driver::new(System::new(model).unwrap()).unwrap()
    };
    // the first step strikes, and takes more iterations than it may
    let mut whole = fall(0.4, 3);
    whole.step().unwrap();
    let parts: Vec<f64> = whole.report().parts().map(|part| part.1).collect();
    assert!(
        parts.len() > 2 && parts.len().is_multiple_of(2),
        "{parts:?}"
    );
    assert!((parts.iter().sum::<f64>() - 0.4).abs() < 1e-14, "{parts:?}");
    // halves of halves are steps of their sizes
    let mut halves = fall(0.4, 30);
    for half in parts.chunks(2) {
        halves.force_size(half[0] + half[1]);
        halves.step().unwrap();
    }
    let [one, other] = [&whole, &halves].map(|driver| &driver.state().motion);
    for (a, b) in one.u.iter().zip(&other.u).chain(one.v.iter().zip(&other.v)) {
        // what the iterations leave
        assert!((a - b).abs() < 1e-8, "{a} {b}");
    }
}
