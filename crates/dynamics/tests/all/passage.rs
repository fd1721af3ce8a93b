//! Blocks that come so fast, or so narrow, that they could pass what they meet.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Side, Sliding, Sphere};
use carom_dynamics::scheme::{CentralDifference, Theta};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, Support, System,
};
use carom_materials::Elastic;
use carom_mesh::{Mesh, Surface, generate};

const EXPLICIT: Scheme = Scheme::CentralDifference(CentralDifference {});
const LAW: Law = Law::Velocity(Velocity {
    capture: Capture::Half,
    reading: Reading::Closed,
});
/// Waves run at 37 m/s.
const SOFT: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};

fn body(mesh: &Mesh, name: &str, fall: f64) -> ModelBody {
    let cells = mesh.groups[name].elements.clone();
    let plane = Kinematics::PlaneStrain { thickness: 1.0 };
    ModelBody {
        velocity: [0.0, fall, 0.0],
        ..ModelBody::new(BodySpec::new(name, cells, plane, SOFT))
    }
}

/// A block of `wide` by 0.8 m that falls from 2 mm above a plate of this thickness, whose top is at zero, on its faces of 0.25 m.
fn falling(wide: f64, thick: f64, (fall, dt): (f64, f64), scheme: Scheme) -> Model {
    let layers = (4.0 * thick).max(1.0) as usize;
    let mut mesh = generate::rectangle("low", [0.0, -thick], [1.0, thick], [4, layers], false);
    let left = 0.375 - 0.5 * wide;
    let high = generate::rectangle("high", [left, 0.002], [wide, 0.8], [4, 4], false);
    mesh.merge("high", high).unwrap();
    let bodies = vec![body(&mesh, "low", 0.0), body(&mesh, "high", fall)];
    let side = |k: usize, group: &str| {
        Surface::new(&mesh, &mesh.groups[group], &bodies[k].spec.cells).unwrap()
    };
    let target = ModelTarget::Surface(side(0, "low.top"));
    let contact = ModelContact {
        sliding: Sliding::Finite,
        ..ModelContact::new("faces", side(1, "high.bottom"), target, LAW)
    };
    let floor = Support {
        nodes: mesh.group_nodes(&mesh.groups["low.bottom"]),
        fix: [true, true, false],
        fix_rotations: [false; 3],
    };
    Model {
        contacts: vec![contact],
        supports: vec![floor],
        ..Model::new(bodies, mesh.clone(), scheme, dt)
    }
}

/// Takes steps whole.
fn run(mut model: Model, steps: usize) -> Driver {
    model.nonlinear.iteration.halvings = 0;
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..steps {
        driver.step().unwrap();
    }
    driver
}

#[test]
fn a_point_that_comes_two_thirds_of_an_element_deep_in_one_explicit_step_is_pushed_back() {
    // 62 and 160 mm a step at a Courant number of half: a quarter and two thirds of the faces below
    for (fall, dt) in [(-20.0, 3.1e-3), (-50.0, 3.2e-3)] {
        let driver = run(falling(0.7, 1.0, (fall, dt), EXPLICIT), 8);
        let (system, state) = (driver.system(), driver.state());
        let record = &state.records.contacts[0];
        assert_eq!(record.first_closing, Some(0.0), "{fall}");
        assert_eq!(record.passed, 0, "{fall}");
        // the impulse is the momentum that the block has got, but for normals that lean with the faces: a dent of half a face has a cosine of 0.89
        let got = system.body_mass(1) * (system.mean_velocity(1, &state.motion.v)[1] - fall);
        let given = record.impulse();
        assert!(given > 0.2 * system.body_mass(1) * -fall, "{given}");
        assert!(got <= given && got > 0.89 * given, "{got} {given}");
    }
}

#[test]
fn points_that_pass_a_plate_within_a_step_are_counted_explicit_and_implicit() {
    // 0.3 m a step through a plate of 0.1 m, whose far side is closer at the end; the block has five nodes at its lower side
    let through = |dt: f64, scheme: Scheme, steps: usize| {
        let mut model = falling(0.5, 0.1, (-300.0, dt), scheme);
        let all = Surface::outer(&model.mesh, &model.bodies[0].spec.cells);
        model.contacts[0].primary = ModelTarget::Surface(all);
        run(model, steps)
    };
    for scheme in [EXPLICIT, Scheme::Theta(Theta { theta: 0.5 })] {
        let driver = through(1e-3, scheme, 2);
        let record = &driver.state().records.contacts[0];
        assert_eq!((record.passed, record.impulse()), (5, 0.0));
    }
    // a tenth of that in a step is seen, further from the sides of the plate than it is deep; later the plate, which waves cross in 30 steps, is gone
    let driver = through(1e-4, EXPLICIT, 2);
    let record = &driver.state().records.contacts[0];
    assert_eq!(record.passed, 0);
    assert!(record.impulse() > 0.0);
}

#[test]
fn points_that_pass_a_rigid_ball_within_a_step_are_counted_and_those_beside_it_are_not() {
    // five nodes between x = 0.025 and 0.725, 0.175 apart; the ball holds from 0.1 to 0.4: two of them
    for (radius, expected) in [(0.15, 2), (0.04, 0)] {
        let mut model = falling(0.7, 1.0, (-300.0, 3e-3), EXPLICIT);
        model.contacts[0].primary = ModelTarget::Rigid(
            Sphere {
                centre: [0.25, -0.7, 0.0],
                radius,
                side: Side::Outside,
            }
            .into(),
        );
        let driver = run(model, 2);
        let record = &driver.state().records.contacts[0];
        assert_eq!((record.passed, record.impulse()), (expected, 0.0));
    }
}

#[test]
fn a_block_between_two_points_of_the_secondary_surface_is_told_of_by_its_depth() {
    // the block is narrower than the face of the plate under its middle, and no point of the plate is below it
    let mut model = falling(
        0.15,
        0.5,
        (-10.0, 5e-4),
        Scheme::Theta(Theta { theta: 0.5 }),
    );
    let contact = &mut model.contacts[0];
    let ModelTarget::Surface(low) = &mut contact.primary else {
        unreachable!()
    };
    std::mem::swap(low, &mut contact.secondary);
    let driver = run(model, 65);
    let record = &driver.state().records.contacts[0];
    assert_eq!(record.impulse(), 0.0);
    // at the look of the 64th step it has gone 0.32 m: 0.318 m deep, to the rounding of as many steps
    let deepest = record.between.value;
    let expected = 0.3 + 0.018;
    assert!((deepest - expected).abs() < 1e-12, "{deepest}");
    // with the block as secondary nothing gets between
    let driver = run(
        falling(
            0.15,
            0.5,
            (-10.0, 5e-4),
            Scheme::Theta(Theta { theta: 0.5 }),
        ),
        65,
    );
    let record = &driver.state().records.contacts[0];
    assert!(
        record.impulse() > 0.0 && record.between.value < 0.02,
        "{record:?}"
    );
}
