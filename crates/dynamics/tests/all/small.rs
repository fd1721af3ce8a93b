//! What the looks at small strain and small sliding find.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Plane, Side, Sliding, Sphere};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, SmallSliding, Stepper, System,
    scheme,
};
use carom_materials::Elastic;
use carom_mesh::{Mesh, Surface, generate};

const SOFT: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
const VELOCITY: Law = Law::Velocity(Velocity {
    capture: Capture::Now,
    reading: Reading::Closed,
});
const THETA: Scheme = Scheme::Theta(scheme::Theta { theta: 0.6 });

fn body(mesh: &Mesh, name: &str, velocity: [f64; 3]) -> ModelBody {
    let cells = mesh.groups[name].elements.clone();
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    ModelBody {
        velocity,
        ..ModelBody::new(BodySpec::new(name, cells, kinematics, SOFT))
    }
}

fn surface(mesh: &Mesh, body: &str, side: &str) -> Surface {
    let cells = &mesh.groups[body].elements;
    Surface::new(mesh, &mesh.groups[&format!("{body}.{side}")], cells).unwrap()
}

/// A bar of 1 m by 0.1 m in the plane.
fn bar() -> Model {
    let mesh = generate::rectangle("a", [0.0; 2], [1.0, 0.1], [20, 2], false);
    let bodies = vec![body(&mesh, "a", [0.0; 3])];
    Model::new(bodies, mesh, THETA, 1e-3)
}

#[test]
fn a_bar_that_turns_in_its_linear_motion_has_turned_by_the_arc_tangent_of_its_antisymmetric_part() {
    let system = System::new(bar()).unwrap();
    let omega = 5.0;
    // v = ω × x is a motion without strain, and stays one at the same rate
    let spin: Vec<f64> = system
        .x
        .iter()
        .flat_map(|x| [-omega * x[1], omega * x[0]])
        .collect();
    let mut driver = Driver::new(system.clone()).unwrap();
    driver
        .restart(&vec![0.0; system.unknowns()], &spin)
        .unwrap();
    for _ in 0..160 {
        driver.step().unwrap();
    }
    let found = driver.state().records.small.bodies[0];
    let angle = (omega * driver.state().time).atan();
    // 160 steps of solves that round to 1e-14
    assert!(
        (found.rotation.value - angle).abs() < 1e-10,
        "{found:?} {angle}"
    );
    assert_eq!(found.rotation.time, driver.state().time);
    assert!(found.strain.value < 1e-10, "{found:?}");
    // the first 7 steps and every 32nd
    assert_eq!(driver.state().records.small.looks(), 7 + 5);
}

#[test]
fn looks_are_few_and_see_the_largest_strain_of_an_impact() {
    let mesh = generate::line("a", [0.0; 3], [1.0, 0.0, 0.0], 200, 1);
    let wave = (SOFT.young / SOFT.density).sqrt();
    let cells = mesh.groups["a"].elements.clone();
    let steel = Elastic {
        poisson: 0.0,
        ..SOFT
    };
    let speed = 0.02 * wave;
    let left = surface(&mesh, "a", "left");
    let wall = Plane {
        point: [0.0; 3],
        normal: [1.0, 0.0, 0.0],
    };
    let bar = BodySpec::new("a", cells, Kinematics::Bar { area: 1.0 }, steel);
    let dt = 0.5 / 200.0 / wave;
    let model = Model {
        contacts: vec![ModelContact::new(
            "wall",
            left,
            ModelTarget::rigid(wall),
            VELOCITY,
        )],
        ..Model::new(
            vec![ModelBody {
                velocity: [-speed, 0.0, 0.0],
                ..ModelBody::new(bar)
            }],
            mesh,
            THETA,
            dt,
        )
    };
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    let mut largest = 0.0_f64;
    let steps = 1200;
    for _ in 0..steps {
        driver.step().unwrap();
        let u = &driver.state().motion.u;
        let strains = u.windows(2).map(|u| (u[1] - u[0]).abs() * 200.0);
        largest = strains.fold(largest, f64::max);
    }
    let small = &driver.state().records.small;
    let found = small.bodies[0].strain;
    // v/c is the strain of the shock; its first overshoot passes one element in two steps, of which looks may see the second
    assert!(
        found.value > 0.95 * largest && found.value < (1.0 + 1e-12) * largest,
        "{found:?} {largest}"
    );
    assert!((found.value / 0.02 - 1.0).abs() < 0.5);
    // the first ones, every 32nd, and as many quarters as there are between a thousandth of the energy and all of it
    let grown = 1000.0_f64.ln() / 1.25_f64.ln();
    let most = 7.0 + f64::from(steps) / 32.0 + grown;
    assert!((small.looks() as f64) < most + 1.0, "{}", small.looks());
    assert_eq!(small.bodies[0].rotation.value, 0.0);
}

/// A unit square of 16 cells at (x, 1.5), thrown at a plate of 4 m by 1 m with cells of 0.5 m.
fn thrown(x: f64, velocity: [f64; 3], sliding: Sliding) -> Model {
    let mut mesh = generate::rectangle("a", [x, 1.5], [1.0, 1.0], [4, 4], false);
    let plate = generate::rectangle("b", [0.0, 0.0], [4.0, 1.0], [8, 2], false);
    mesh.merge("b", plate).unwrap();
    let contact = ModelContact {
        sliding,
        ..ModelContact::new(
            "c",
            surface(&mesh, "a", "bottom"),
            ModelTarget::Surface(surface(&mesh, "b", "top")),
            VELOCITY,
        )
    };
    let bodies = vec![body(&mesh, "a", velocity), body(&mesh, "b", [0.0; 3])];
    Model {
        contacts: vec![contact],
        ..Model::new(bodies, mesh, THETA, 2e-3)
    }
}

fn ran(model: Model, steps: usize) -> (SmallSliding, f64) {
    let system = System::new(model).unwrap();
    let mut driver: Box<dyn Stepper> = match system.is_nonlinear() {
        true => Box::new(Driver::new(system).unwrap()),
        false => Box::new(Driver::new(system).unwrap()),
    };
    for _ in 0..steps {
        driver.step().unwrap();
    }
    let records = &driver.state().records;
    (records.small.contacts[0], records.contacts[0].impulse())
}

#[test]
fn contacts_that_small_sliding_loses_or_invents_are_found_and_finite_sliding_has_none() {
    let small = |x, velocity, steps| ran(thrown(x, velocity, Sliding::Small), steps);
    let finite = |x, velocity, steps| ran(thrown(x, velocity, Sliding::Finite), steps);
    // two of the four faces are opposite the plate at the start, and the others pass into it
    let aslant = [10.0, -3.0, 0.0];
    let (lost, _) = small(-0.6, aslant, 200);
    assert!(lost.lost.value > 0.5, "{lost:?}");
    assert_eq!(finite(-0.6, aslant, 200).0, SmallSliding::default());
    // beyond the edge before it comes down: a force where nothing is opposite
    let along = [10.0, -1.0, 0.0];
    let (invented, impulse) = small(3.0, along, 400);
    assert!(
        impulse > 100.0 && invented.invented.value == f64::INFINITY,
        "{invented:?}"
    );
    assert_eq!(finite(3.0, along, 400).1, 0.0);
    // straight down nothing slides; the faces of the plate bend by what a strain of 1/30 makes of them
    let (straight, impulse) = small(1.5, [0.0, -1.0, 0.0], 400);
    assert!(impulse > 100.0, "{impulse}");
    assert!(
        straight.slide.value < 0.2 && straight.lost.value < 0.1,
        "{straight:?}"
    );
    assert!(straight.invented.value < 0.1, "{straight:?}");
}

#[test]
fn the_way_along_the_surface_is_the_relative_displacement_in_faces() {
    // resting on the plate, and thrown along it: what closes at once slides at 0.8 m/s
    let mut model = thrown(0.5, [0.8, -0.01, 0.0], Sliding::Small);
    for x in &mut model.mesh.nodes[..25] {
        x[1] -= 0.5;
    }
    let (found, impulse) = ran(model, 300);
    let way = 0.8 * found.slide.time / 0.5;
    // the impact shakes both by less than its speed over the wave speed, and nodes move by it: a hundredth of the way
    assert!(impulse > 0.0 && found.slide.value > 0.1, "{found:?}");
    assert!(
        (found.slide.value / way - 1.0).abs() < 0.05,
        "{found:?} {way}"
    );
}

#[test]
fn against_a_plane_nothing_is_to_be_found_and_against_a_sphere_the_normal_turns() {
    let over = |target: ModelTarget| {
        let mut model = bar();
        model.bodies[0].velocity = [1.0, -0.1, 0.0];
        let bottom = surface(&model.mesh, "a", "bottom");
        model.contacts = vec![ModelContact::new("c", bottom, target, VELOCITY)];
        ran(model, 300).0
    };
    let plane = Plane {
        point: [0.0; 3],
        normal: [0.0, 1.0, 0.0],
    };
    assert_eq!(over(ModelTarget::rigid(plane)), SmallSliding::default());
    let found = over(ModelTarget::rigid(Sphere {
        centre: [0.5, -2.0, 0.0],
        radius: 2.0,
        side: Side::Outside,
    }));
    // at 1 m/s along a circle of 2 m
    let expected = 0.5 * found.turn.time;
    assert!(
        (found.turn.value / expected - 1.0).abs() < 0.1,
        "{found:?} {expected}"
    );
    assert_eq!(found.slide.value, 0.0);
}
