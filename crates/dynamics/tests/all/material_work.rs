//! Work of materials, dampers and pressures over many nonlinear steps, against closed forms.

use carom_bodies::Kinematics;
use carom_contact::law::{Capture, Reading, Velocity};
use carom_dynamics::{
    Amplitude, Damping, Driver, Error, Load, LoadKind, Model, Prescribed, Scheme, Support, System,
    scheme,
};
use carom_materials::{Elastic, J2Plasticity, Law as Material, NeoHooke};
use carom_mesh::{Surface, generate};

use crate::newton::{SOFT, square};

const VELOCITY: carom_contact::Law = carom_contact::Law::Velocity(Velocity {
    capture: Capture::Now,
    reading: Reading::Closed,
});
const TRAPEZOID: Scheme = Scheme::Newmark(scheme::Newmark {
    beta: 0.25,
    gamma: 0.5,
});

fn theta(theta: f64) -> Scheme {
    Scheme::Theta(scheme::Theta { theta })
}

fn newton(model: Model) -> Driver {
    Driver::new(System::new(model).unwrap()).unwrap()
}

/// A square without contact and gravity, at rest.
fn alone(scheme: Scheme, material: Material, n: usize) -> Model {
    let mut model = square(scheme, VELOCITY, material, n);
    model.contacts.clear();
    model.gravity = [0.0; 3];
    model.bodies[0].velocity = [0.0; 3];
    model
}

/// Uniaxial strain ε of a metal: q = |2μ ε - 3μ p| with p the signed plastic strain, so that the return at each turn of ε is
/// the one of the whole way to it.
#[test]
fn a_plastic_cycle_has_the_work_of_its_closed_form_under_any_theta() {
    let metal = J2Plasticity {
        initial: Elastic {
            density: 1e-6,
            ..SOFT
        },
        yield_stress: 0.1,
        hardening: 0.5,
    };
    let (mu, volume) = (SOFT.shear_modulus(), 0.5);
    let bulk = SOFT.young / (3.0 * (1.0 - 2.0 * SOFT.poisson));
    let turns = [0.1, -0.1, 0.02];
    let (mut signed, mut strain) = (0.0_f64, 0.0);
    for turn in turns {
        let trial = 2.0 * mu * turn - 3.0 * mu * signed;
        let beyond = trial.abs() - metal.yield_stress - metal.hardening * strain;
        let slip = beyond.max(0.0) / (3.0 * mu + metal.hardening);
        strain += slip;
        signed += slip * trial.signum();
    }
    let q = 2.0 * mu * turns[2] - 3.0 * mu * signed;
    let stored = volume * (0.5 * bulk * turns[2].powi(2) + q * q / (6.0 * mu));
    for value in [0.5, 0.75, 1.0] {
        let scheme_term = |steps: usize| {
            let ledger = cycle(value, metal, turns, steps).state().ledger.clone();
            let now = &ledger.balance;
            // the return is exact however many steps make the way; a history of the middle of a step would add slip at each
            for (found, exact) in [
                (
                    now.dissipation_material,
                    volume * metal.yield_stress * strain,
                ),
                (
                    now.hardening,
                    volume * 0.5 * metal.hardening * strain * strain,
                ),
                (now.strain, stored),
            ] {
                assert!(
                    (found - exact).abs() < 1e-12,
                    "theta {value}: {found} {exact}"
                );
            }
            assert!(ledger.largest_energy_residual < 1e-14);
            now.dissipation_scheme / now.dissipation_material
        };
        // the supports work along the path of the stress, which the steps follow at one place each: first order, less at θ = ½
        let [coarse, fine] = [160, 320].map(scheme_term);
        let (least, largest) = if value == 0.5 {
            (-0.01, 0.01)
        } else {
            (0.0, 0.3)
        };
        assert!(
            coarse > least && coarse < largest,
            "theta {value}: {coarse}"
        );
        assert!(
            fine.abs() < 0.55 * coarse.abs(),
            "theta {value}: {coarse} {fine}"
        );
    }
    assert!(strain > 0.1);
}

/// A square in uniaxial strain that is led from turn to turn of its logarithmic strain.
fn cycle(value: f64, metal: J2Plasticity, turns: [f64; 3], steps: usize) -> Driver {
    let mut model = alone(theta(value), Material::J2Plasticity(metal), 1);
    let nodes = |group: &str| model.mesh.group_nodes(&model.mesh.groups[group]);
    let (top, bottom) = (nodes("a.top"), nodes("a.bottom"));
    let mut course = vec![[0.0; 2]];
    for (time, turn) in [1.0, 3.0, 4.0].into_iter().zip(turns) {
        course.push([time, turn.exp_m1()]);
    }
    let motion = |nodes, up| Prescribed {
        nodes,
        displacement: [Some(Amplitude::constant(0.0)), Some(up), None],
    };
    let up = Amplitude::new(course).unwrap();
    model.nonlinear.motions = vec![motion(top, up), motion(bottom, Amplitude::constant(0.0))];
    model.dt = 4.0 / steps as f64;
    let mut newton = newton(model);
    for _ in 0..steps {
        newton.step().unwrap();
    }
    newton
}

/// One bar, one end held: a mass of ρ A L/2 on a spring of E A/L, whose motion is e^(-ξωt) (cos ω_d t + ξω/ω_d sin ω_d t).
fn damped_bar(scheme: Scheme, damping: Damping, steps: usize) -> (f64, Driver) {
    let mesh = generate::line("a", [0.0; 3], [1.0, 0.0, 0.0], 1, 1);
    let mut model = alone(scheme, SOFT.into(), 1);
    let body = &mut model.bodies[0];
    body.spec.cells = mesh.groups["a"].elements.clone();
    body.spec.kinematics = Kinematics::Bar { area: 0.3 };
    body.displacement = [0.1, 0.0, 0.0];
    let held = mesh.group_nodes(&mesh.groups["a.left"]);
    model.supports = vec![Support {
        nodes: held,
        fix: [true; 3],
        fix_rotations: [false; 3],
    }];
    model.mesh = mesh;
    model.nonlinear.damping = vec![damping];
    let omega = (SOFT.young / (0.5 * SOFT.density)).sqrt();
    let end = 2.0;
    model.dt = end / steps as f64;
    let mut newton = newton(model);
    for _ in 0..steps {
        newton.step().unwrap();
    }
    let ratio = 0.5 * (damping.mass / omega + damping.stiffness * omega);
    let turned = omega * (1.0 - ratio * ratio).sqrt();
    let swing = (turned * end).cos() + ratio * omega / turned * (turned * end).sin();
    let exact = 0.1 * (-ratio * omega * end).exp() * swing;
    let u = newton
        .state()
        .motion
        .u
        .iter()
        .fold(0.0, |m: f64, u| if u.abs() > m.abs() { *u } else { m });
    (u - exact, newton)
}

#[test]
fn rayleigh_damping_takes_a_mode_down_as_its_closed_form_says() {
    let by_mass = Damping {
        mass: 0.4,
        stiffness: 0.0,
    };
    let by_stiffness = Damping {
        mass: 0.0,
        stiffness: 0.03,
    };
    for scheme in [TRAPEZOID, theta(0.5)] {
        for damping in [by_mass, by_stiffness] {
            let name = scheme.get().name();
            let [(coarse, _), (fine, newton)] = [100, 200].map(|n| damped_bar(scheme, damping, n));
            // second order: the error of half the step is a fourth, with the next terms of (ω dt)² = 0.003 beside it
            assert!(
                (coarse / fine - 4.0).abs() < 0.1,
                "{name}, {damping:?}: {coarse:e} {fine:e}"
            );
            assert!(fine.abs() < 1e-3 * 0.1, "{name}, {damping:?}: {fine:e}");
            let ledger = &newton.state().ledger;
            let lost = ledger.initial.energy() - ledger.balance.energy();
            assert!(lost > 0.3 * ledger.initial.energy());
            // neither rule takes energy of its own from a linear system
            assert!(
                (ledger.balance.dissipation_damping - lost).abs() < 1e-12 * lost,
                "{name}"
            );
        }
    }
}

/// Relative error of the work of a pressure on all sides against -p ΔV, and the relative change of the volume.
fn work_of_pressure(scheme: Scheme, kinematics: Kinematics, steps: usize) -> (f64, f64) {
    let pressure = 0.4;
    let mut model = alone(scheme, Material::NeoHooke(NeoHooke { initial: SOFT }), 3);
    let mesh = generate::rectangle("a", [1.0, 0.0], [1.0, 1.0], [3, 3], false);
    model.bodies[0].spec.kinematics = kinematics;
    let cells = model.bodies[0].spec.cells.clone();
    let sides = ["a.bottom", "a.right", "a.top", "a.left"].map(|side| Load {
        name: side.into(),
        surface: Surface::new(&mesh, &mesh.groups[side], &cells).unwrap(),
        kind: LoadKind::Pressure(pressure),
        amplitude: Amplitude::constant(1.0),
    });
    model.nonlinear.loads = sides.to_vec();
    model.nonlinear.iteration.tolerance = 1e-13;
    model.mesh = mesh;
    model.dt = 0.6 / steps as f64;
    let mut newton = newton(model);
    let system = newton.system();
    // a shear and a stretch, so that the sides turn
    let v = system
        .x
        .iter()
        .flat_map(|x| [0.4 * x[1], 0.5 * x[1] + 0.3 * x[0]])
        .collect::<Vec<_>>();
    newton.restart(&vec![0.0; v.len()], &v).unwrap();
    let volume = |newton: &Driver| -> f64 {
        let motion = &newton.state().motion;
        let stresses = newton.system().bodies[0].stresses(&motion.u, &motion.history);
        stresses.iter().map(|(volume, _)| volume).sum()
    };
    let start = volume(&newton);
    for _ in 0..steps {
        newton.step().unwrap();
    }
    let change = volume(&newton) - start;
    let work = newton.state().ledger.balance.work_loads;
    let ledger = &newton.state().ledger;
    assert!(ledger.largest_energy_residual < 1e-11 * ledger.largest_energy);
    (
        (work + pressure * change) / (pressure * start),
        change / start,
    )
}

#[test]
fn pressure_that_follows_does_p_dv() {
    // the area of a polygon is quadratic in its corners: the force at the middle of a step is the mean one
    let (error, change) =
        work_of_pressure(theta(0.5), Kinematics::PlaneStrain { thickness: 0.5 }, 12);
    assert!(change.abs() > 0.01, "{change}");
    assert!(error.abs() < 1e-13, "{error:e}");
    // a volume of revolution is cubic: second order
    let [(coarse, change), (fine, _)] =
        [12, 24].map(|n| work_of_pressure(theta(0.5), Kinematics::Axisymmetric, n));
    assert!(change.abs() > 0.01, "{change}");
    assert!((coarse / fine - 4.0).abs() < 0.3, "{coarse:e} {fine:e}");
    assert!(fine.abs() < 1e-4, "{fine:e}");
}

/// A block that is squeezed between its speed and a wall, a step just below its first critical one.
fn squeezed_model(halvings: u32) -> Model {
    let central = Scheme::CentralDifference(scheme::CentralDifference {});
    let soft = Material::NeoHooke(NeoHooke {
        initial: Elastic {
            poisson: 0.0,
            ..SOFT
        },
    });
    let mut model = square(central, VELOCITY, soft, 3);
    model.gravity = [0.0; 3];
    model.bodies[0].velocity = [0.0, -0.6, 0.0];
    model.dt = 0.88 * System::new(model.clone()).unwrap().critical_step();
    model.nonlinear.iteration.halvings = halvings;
    model
}

fn squeezed(halvings: u32) -> (Result<(), Error>, u32, Driver) {
    let mut newton = newton(squeezed_model(halvings));
    let (mut most, mut sum) = (0, 0.0);
    for _ in 0..60 {
        if let Err(error) = newton.step() {
            return (Err(error), most, newton);
        }
        let report = newton.report();
        most = most.max(report.attempts);
        sum += report.contacts[0].force * report.dt;
    }
    // the force of a step in parts is the mean over them
    let forces = newton.state().records.contacts[0].impulse_of_forces();
    assert!((sum - forces).abs() < 1e-13 * forces, "{sum} {forces}");
    (Ok(()), most, newton)
}

#[test]
fn an_explicit_step_is_split_where_elements_have_shortened() {
    let (run, most, newton) = squeezed(6);
    run.unwrap();
    assert!(most >= 2, "never split");
    let ledger = &newton.state().ledger;
    // what is conserved is E - dt²/8 |a|²_M: at 0.9 of the critical step E may be up to 1/(1 - 0.9²) of it, and no more
    let start = ledger.initial.energy();
    assert!(
        ledger.largest_energy < 5.3 * start,
        "{} of {start}",
        ledger.largest_energy
    );
    assert!(ledger.largest_energy_residual < 1e-13 * start);
    let (run, _, newton) = squeezed(0);
    match run {
        Err(Error::Shortened { dt, critical, .. }) => {
            assert!(critical < dt && dt == newton.system().dt)
        }
        other => panic!("{other:?}"),
    }
}

/// Half of the critical step is asked for, of which no smaller part may be taken: the error tells a step that is below the smallest part, which the
/// critical step itself is not.
#[test]
fn an_error_tells_the_step_that_a_fraction_of_the_critical_one_asks_for() {
    let mut model = squeezed_model(0);
    model.critical_fraction = Some(0.5);
    model.nonlinear.iteration.halvings = 0;
    let mut newton = newton(model);
    match (0..1000).find_map(|_| newton.step().err()) {
        Some(Error::Shortened {
            dt,
            critical,
            fitting,
            ..
        }) => {
            assert!(fitting < dt && dt == newton.system().dt);
            assert!((fitting / critical - 0.5).abs() < 1e-12);
        }
        other => panic!("{other:?}"),
    }
}

/// A step that is a fraction of the critical one is never split: it gets shorter. It is below the critical step of the present shape,
/// and no lower than what is not known of that step: lengths to a tenth when they are looked at, so much of the stiffness
/// of the least of them, and a rung.
#[test]
fn a_fraction_of_the_critical_step_follows_the_shape() {
    let mut model = squeezed_model(0);
    model.critical_fraction = Some(0.88);
    model.nonlinear.iteration.halvings = 6;
    let mut newton = newton(model);
    let (largest, mut least, mut times) = (newton.system().dt, f64::INFINITY, 0.0);
    let end = 60.0 * largest;
    while newton.state().time < end {
        let before = newton.state().time;
        let (critical, _) = newton
            .system()
            .critical_step_at(&newton.state().motion)
            .unwrap();
        newton.step().unwrap();
        let dt = newton.state().time - before;
        times += dt;
        assert_eq!(newton.report().attempts, 1);
        assert!((0.6..1.0).contains(&(dt / critical)), "{}", dt / critical);
        least = f64::min(least, dt);
    }
    assert!(least < 0.75 * largest, "{least:e} of {largest:e}");
    // instants of equal steps are products
    assert!((times / newton.state().time - 1.0).abs() < 1e-12);
    let ledger = &newton.state().ledger;
    assert!(ledger.largest_energy_residual < 1e-13 * ledger.initial.energy());
}

#[test]
fn pressure_in_energy_momentum_steps_does_p_dv_however_long_they_are() {
    let conserving = || Scheme::EnergyMomentum(scheme::EnergyMomentum {});
    for kinematics in [
        Kinematics::PlaneStrain { thickness: 0.5 },
        Kinematics::Axisymmetric,
    ] {
        for steps in [3, 12] {
            let (error, change) = work_of_pressure(conserving(), kinematics, steps);
            assert!(change.abs() > 0.01, "{change}");
            // solved to 1e-13 of the forces in each step
            assert!(error.abs() < 1e-12, "{kinematics:?}: {error:e}");
        }
    }
}

#[test]
fn a_pressure_on_one_side_of_a_spinning_square_is_of_second_order_in_energy_momentum_steps() {
    // a quarter of a turn in so many steps: where the middle of the square is
    let middle = |steps: u32| {
        let conserving = Scheme::EnergyMomentum(scheme::EnergyMomentum {});
        let mut model = alone(
            conserving,
            Material::NeoHooke(NeoHooke { initial: SOFT }),
            1,
        );
        model.bodies[0].spin = [0.0, 0.0, 1.0];
        let cells = &model.bodies[0].spec.cells;
        model.nonlinear.loads = vec![Load {
            name: "push".to_owned(),
            surface: Surface::new(&model.mesh, &model.mesh.groups["a.left"], cells).unwrap(),
            kind: LoadKind::Pressure(0.2),
            amplitude: Amplitude::constant(1.0),
        }];
        model.dt = 1.6 / f64::from(steps);
        let mut newton = Driver::new(System::new(model).unwrap()).unwrap();
        (0..steps).for_each(|_| newton.step().unwrap());
        let u = &newton.state().motion.u;
        [0, 1].map(|i| u.iter().skip(i).step_by(2).sum::<f64>() / 4.0)
    };
    let [one, two, four] = [32, 64, 128].map(middle);
    for i in 0..2 {
        let ratio = (one[i] - two[i]) / (two[i] - four[i]);
        // 4, and half as much with the first order; terms of the next order are a tenth of that
        assert!((3.0..5.0).contains(&ratio), "{i}: {ratio}");
    }
}
