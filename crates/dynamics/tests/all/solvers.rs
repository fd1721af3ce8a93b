//! A factor or iterations for several bodies that touch.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Hertz, HuntCrossley, Reading, StaticKinetic, Velocity};
use carom_contact::{self as contact, Friction, Law};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, Solver, System, scheme,
};
use carom_materials::{Elastic, Law as Material, NeoHooke, Plane};
use carom_mesh::{Surface, generate};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.3,
};

/// Elements along a side of the block.
const N: usize = 18;

/// A block of 20 577 unknowns that falls on a plate of 441, both free: one is large enough for iterations, a factor of the other costs nothing.
fn driver(solver: Solver, (law, friction): (Law, Friction)) -> Driver {
    let mut mesh = generate::box_("block", [0.0, 0.0, 1e-4], [1.0; 3], [N; 3], false);
    let plate = generate::box_(
        "plate",
        [-0.5, -0.5, -0.5],
        [2.0, 2.0, 0.5],
        [6, 6, 2],
        false,
    );
    mesh.merge("plate", plate).unwrap();
    let body = |name: &str, speed: f64| {
        let cells = mesh.groups[name].elements.clone();
        let spec = BodySpec::new(name, cells, Kinematics::Solid, RUBBER);
        ModelBody {
            velocity: [0.2 * speed, 0.1 * speed, speed],
            ..ModelBody::new(spec)
        }
    };
    let bodies = vec![body("block", -5.0), body("plate", 1.0)];
    let surface = |body: usize, group: &str| {
        Surface::new(&mesh, &mesh.groups[group], &bodies[body].spec.cells).unwrap()
    };
    let primary = ModelTarget::Surface(surface(1, "plate.top"));
    let contact = ModelContact {
        friction,
        ..ModelContact::new("touch", surface(0, "block.bottom"), primary, law)
    };
    let step = 0.5 / N as f64 / RUBBER.wave_speed(Plane::Full);
    let theta = Scheme::Theta(scheme::Theta { theta: 0.5 });
    let mut model = Model {
        contacts: vec![contact],
        ..Model::new(bodies, mesh, theta, step)
    };
    model.nonlinear.iteration.solver = solver;
    Driver::new(System::new(model).unwrap()).unwrap()
}

/// The largest difference over the largest.
fn difference(one: &[f64], other: &[f64]) -> f64 {
    let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, x| m.max(x.abs()));
    most(&mut one.iter().zip(other).map(|(a, b)| a - b)) / most(&mut one.iter().copied())
}

#[test]
fn bodies_that_touch_have_one_kind_of_solver_and_the_forces_of_factors() {
    let velocity = |capture| {
        Law::Velocity(Velocity {
            capture,
            reading: Reading::Closed,
        })
    };
    // as deep as the block comes in these steps the force is twice that of the wave
    let spring = Hertz {
        stiffness: 1.5e11,
        exponent: 1.5,
    };
    let lossy = HuntCrossley {
        spring,
        damping: 0.05,
    };
    let falling = StaticKinetic {
        at_rest: 0.3,
        kinetic: 0.1,
        decay: Some(1.0),
    };
    for contact in [
        (velocity(Capture::Half), 0.0.into()),
        (velocity(Capture::Free), 0.0.into()),
        (velocity(Capture::Half), 0.15.into()),
        (Law::Hertz(spring), 0.0.into()),
        (Law::HuntCrossley(lossy), 0.15.into()),
        (velocity(Capture::Half), Friction::StaticKinetic(falling)),
    ] {
        let [mut direct, mut chosen] =
            [Solver::Direct, Solver::Auto].map(|solver| driver(solver, contact));
        for _ in 0..10 {
            direct.step().unwrap();
            chosen.step().unwrap();
            let [one, other] = [&direct, &chosen].map(|driver| &driver.state().interface);
            assert_eq!(one.status, other.status);
        }
        let [one, other] = [&direct, &chosen].map(Driver::state);
        // iterations end at 1e-12 of the load, and the errors of ten steps add up
        let forces = difference(&one.interface.force, &other.interface.force);
        let motion = difference(&one.motion.v, &other.motion.v);
        assert!(forces < 1e-9 && motion < 1e-9, "{forces} {motion}");
        let [slid, same] = [one, other].map(|state| state.interface.friction.as_flattened());
        assert!(!contact.1.acts() || difference(slid, same) < 1e-9);
        let closed = one.interface.force.iter().filter(|force| **force > 0.0);
        assert!(closed.count() > N * N / 2);
        let [one, other] = [&direct, &chosen].map(|driver| driver.costs().work);
        assert_eq!((one.factorisations, one.products), (2, 0));
        assert_eq!((other.factorisations, other.columns), (0, 0));
        assert!(other.products > 0);
    }
}

/// A soft block at finite strain that falls fast on a plane, in long steps.
fn crushed(solver: Solver) -> Driver {
    const SIDE: usize = 12;
    let mesh = generate::box_("block", [0.0, 0.0, 0.01], [1.0; 3], [SIDE; 3], false);
    let soft = Elastic {
        young: 5e6,
        ..RUBBER
    };
    let cells = mesh.groups["block"].elements.clone();
    let mut spec = BodySpec::new("block", cells, Kinematics::Solid, soft);
    spec.material = Material::NeoHooke(NeoHooke { initial: soft });
    let block = ModelBody {
        velocity: [0.0, 0.0, -60.0],
        ..ModelBody::new(spec)
    };
    let bottom = Surface::new(&mesh, &mesh.groups["block.bottom"], &block.spec.cells).unwrap();
    let law = Law::Velocity(Velocity {
        capture: Capture::Half,
        reading: Reading::Closed,
    });
    let ground = ModelTarget::rigid(contact::Plane {
        point: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
    });
    let contact = ModelContact::new("ground", bottom, ground, law);
    let theta = Scheme::Theta(scheme::Theta { theta: 0.5 });
    let mut model = Model {
        contacts: vec![contact],
        ..Model::new(vec![block], mesh, theta, 5e-4)
    };
    model.nonlinear.iteration.solver = solver;
    Driver::new(System::new(model).unwrap()).unwrap()
}

#[test]
fn steps_in_which_iterations_fail_have_factors() {
    let [mut direct, mut chosen] = [Solver::Direct, Solver::Auto].map(crushed);
    for _ in 0..16 {
        direct.step().unwrap();
        chosen.step().unwrap();
    }
    // no step was halved that factors take whole
    let [one, other] = [&direct, &chosen].map(|driver| driver.state().control.failed);
    assert_eq!((one, other), (0, 0));
    let work = chosen.costs().work;
    assert!(work.factorisations > 0 && work.products > 0, "{work:?}");
    let [one, other] = [&direct, &chosen].map(|driver| &driver.state().motion.u);
    // steps end at 1e-10 of the forces, and errors of sixteen add up
    let motion = difference(one, other);
    assert!(motion < 1e-7, "{motion}");
}
