//! Static stages of bodies that only contacts hold.

use carom_bodies::{Curve, DiscreteKind};
use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_contact::{Integration, Law, Plane, Sliding};
use carom_dynamics::{
    Amplitude, Driver, Error, Load, LoadKind, Model, ModelTarget, Preload, Scheme, Support, System,
    scheme,
};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Surface, generate};

use crate::discrete::link;
use crate::newton::{SOFT, square};

const DISPLACEMENT: Law = Law::Displacement(Displacement { projection: false });
pub(crate) const VELOCITY: Law = Law::Velocity(Velocity {
    capture: Capture::Now,
    reading: Reading::Closed,
});
pub(crate) const TRAPEZOID: Scheme = Scheme::Newmark(scheme::Newmark {
    beta: 0.25,
    gamma: 0.5,
});
/// ν = 0: a column.
const COLUMN: Elastic = Elastic {
    poisson: 0.0,
    ..SOFT
};
/// Elements along a side.
const N: usize = 4;
/// Weight, N: density 2, thickness 0.5, gravity 0.1.
const WEIGHT: f64 = 0.1;

/// The square, which nothing holds, 0.01 above the plane, in two static steps.
fn falling(law: Law, material: Material) -> Model {
    let mut model = square(TRAPEZOID, law, material, N);
    model.bodies[0].velocity = [0.0; 3];
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 2 });
    model
}

/// A constant traction in Pa on a group.
fn traction(model: &Model, group: &str, traction: [f64; 3]) -> Load {
    let cells = &model.bodies[0].spec.cells;
    Load {
        name: "push".into(),
        surface: Surface::new(&model.mesh, &model.mesh.groups[group], cells).unwrap(),
        kind: LoadKind::Traction(traction),
        amplitude: Amplitude::constant(1.0),
    }
}

fn pressed(model: Model) -> Result<Driver, Error> {
    let mut newton = Driver::new(System::new(model).unwrap())?;
    for _ in 0..2 {
        newton.step()?;
    }
    Ok(newton)
}

/// Asserts that the square stands: σ(y) = -ρ g (1 - y) in the middle of each element, and nothing moves sideways.
fn assert_column(newton: &Driver, bottom: f64) {
    let u = &newton.state().motion.u;
    for (node, x) in newton.system().x.iter().enumerate() {
        // the exact displacement, whose nodal values linear elements have too
        let sunk = 2.0 * 0.1 / COLUMN.young * (x[1] - 0.5 * x[1] * x[1]);
        assert!((u[2 * node + 1] - (bottom - sunk)).abs() < 1e-12, "{x:?}");
        assert!(u[2 * node].abs() < 1e-12);
    }
}

#[test]
fn a_block_that_nothing_holds_comes_to_rest_on_a_plane() {
    for (law, sliding, integration) in [
        (DISPLACEMENT, Sliding::Small, Integration::Node),
        (VELOCITY, Sliding::Finite, Integration::Node),
        (
            DISPLACEMENT,
            Sliding::Finite,
            Integration::Mortar {
                basis: carom_contact::Basis::Dual,
            },
        ),
    ] {
        let mut model = falling(law, COLUMN.into());
        model.contacts[0].sliding = sliding;
        model.contacts[0].integration = integration;
        model.nonlinear.iteration.tolerance = 1e-13;
        let newton = pressed(model).unwrap();
        assert!(newton.residuals().len() <= 6, "{:?}", newton.residuals());
        let report = &newton.report().contacts[0];
        // to rounding, and to the tolerance of the iterations
        assert!(
            (report.force / WEIGHT - 1.0).abs() < 1e-12,
            "{}",
            report.force
        );
        assert_column(&newton, -0.01);
    }
}

#[test]
fn a_block_at_rest_stays_at_rest_when_the_dynamics_begin() {
    for (law, material) in [
        (DISPLACEMENT, COLUMN.into()),
        (VELOCITY, COLUMN.into()),
        (DISPLACEMENT, neo_hooke()),
        (VELOCITY, neo_hooke()),
    ] {
        let mut model = falling(law, material);
        // the displacement law makes of what is left of the equilibrium as much again in each step
        model.nonlinear.iteration.tolerance = 1e-12;
        let mut newton = pressed(model).unwrap();
        assert!((newton.report().contacts[0].force / WEIGHT - 1.0).abs() < 1e-9);
        for _ in 0..20 {
            newton.step().unwrap();
            let v = newton.state().motion.v.iter();
            let fastest = v.fold(0.0_f64, |m, v| m.max(v.abs()));
            // g Δt = 5e-3 is what one step of a free fall gives; equilibrium is that of the stage, 1e-10 of the weight
            assert!(fastest < 1e-10, "{fastest:e}");
            let force = newton.report().contacts[0].force;
            assert!((force / WEIGHT - 1.0).abs() < 1e-8, "{force}");
        }
    }
}

fn neo_hooke() -> Material {
    Material::NeoHooke(NeoHooke { initial: SOFT })
}

#[test]
fn a_block_at_large_strain_stands_under_its_weight() {
    let mut model = falling(DISPLACEMENT, neo_hooke());
    // ρ g H / E = 1/4
    model.gravity = [0.0, -1.0, 0.0];
    let newton = pressed(model).unwrap();
    assert!(newton.residuals().len() <= 20, "{:?}", newton.residuals());
    let u = &newton.state().motion.u;
    let least = u.iter().fold(0.0_f64, |m, u| m.min(*u));
    assert!(least < -0.1, "it has sunk by a tenth: {least}");
    assert!((newton.report().contacts[0].force / (10.0 * WEIGHT) - 1.0).abs() < 1e-9);
    // to the tolerance of the iterations: what is not loaded has not moved
    let x = &newton.system().x;
    let drift: f64 = x.iter().enumerate().map(|(node, _)| u[2 * node]).sum();
    assert!(drift.abs() < 1e-8 * x.len() as f64, "{drift:e}");
}

fn refusal(model: Model) -> String {
    match pressed(model) {
        Err(Error::Unheld {
            step, body, motion, ..
        }) => format!("{step} {body}: {motion}"),
        Err(other) => panic!("{other}"),
        Ok(_) => "stands".into(),
    }
}

#[test]
fn loads_that_no_contact_takes_are_named() {
    for material in [COLUMN.into(), neo_hooke()] {
        let mut model = falling(DISPLACEMENT, material);
        model.nonlinear.loads = vec![traction(&model, "a.left", [0.01, 0.0, 0.0])];
        assert_eq!(refusal(model.clone()), "1 a: move along x");
        // the same load, with friction
        model.contacts[0].friction = 0.5.into();
        assert_eq!(refusal(model), "stands");

        // pulled off in the second step
        let mut model = falling(DISPLACEMENT, material);
        let mut pull = traction(&model, "a.top", [0.0, 1.0, 0.0]);
        pull.amplitude = Amplitude::new(vec![[0.5, 0.0], [1.0, 1.0]]).unwrap();
        model.nonlinear.loads = vec![pull];
        assert_eq!(refusal(model), "2 a: move along y");

        // over the edge of a plane that ends: it tips
        let mut model = falling(DISPLACEMENT, material);
        model.gravity = [0.0; 3];
        model.nonlinear.loads = vec![traction(&model, "a.right", [0.0, -0.1, 0.0])];
        let cells = &model.bodies[0].spec.cells;
        let left = carom_mesh::Group::new(1, model.mesh.groups["a.bottom"].elements[..2].to_vec());
        model.contacts[0].secondary = Surface::new(&model.mesh, &left, cells).unwrap();
        assert_eq!(refusal(model), "1 a: turn about z");
    }
}

#[test]
fn a_block_slides_on_to_the_contact_that_stops_it() {
    let mut model = falling(DISPLACEMENT, COLUMN.into());
    model.nonlinear.loads = vec![traction(&model, "a.left", [0.01, 0.0, 0.0])];
    let mut wall = model.contacts[0].clone();
    wall.name = "wall".into();
    wall.primary = ModelTarget::rigid(Plane {
        point: [1.3, 0.0, 0.0],
        normal: [-1.0, 0.0, 0.0],
    });
    let cells = &model.bodies[0].spec.cells;
    wall.secondary = Surface::new(&model.mesh, &model.mesh.groups["a.right"], cells).unwrap();
    model.contacts.push(wall);
    let newton = pressed(model).unwrap();
    let contacts = &newton.report().contacts;
    // on a thickness of 0.5; iterations end at 1e-10 of the largest force
    for (contact, exact) in contacts.iter().zip([WEIGHT, 0.005]) {
        assert!(
            (contact.force - exact).abs() < 1e-10 * WEIGHT,
            "{}",
            contact.force
        );
    }
}

#[test]
fn blocks_that_only_touch_each_other_and_the_ground_carry_a_load_down() {
    for material in [COLUMN.into(), neo_hooke()] {
        let mut model = falling(DISPLACEMENT, material);
        // a narrower block of another mesh, 0.02 above the first one
        let upper = generate::rectangle("b", [0.2, 1.02], [0.5, 0.5], [3, 2], false);
        model.mesh.merge("b", upper).unwrap();
        let mut body = model.bodies[0].clone();
        body.spec.name = "b".into();
        body.spec.cells = model.mesh.groups["b"].elements.clone();
        let surface = |group: &str, cells: &[_]| {
            Surface::new(&model.mesh, &model.mesh.groups[group], cells).unwrap()
        };
        let mut joint = model.contacts[0].clone();
        joint.name = "joint".into();
        joint.integration = Integration::Mortar {
            basis: carom_contact::Basis::Dual,
        };
        joint.secondary = surface("b.bottom", &body.spec.cells);
        joint.primary = ModelTarget::Surface(surface("a.top", &model.bodies[0].spec.cells));
        let push = Load {
            name: "push".into(),
            surface: surface("b.top", &body.spec.cells),
            kind: LoadKind::Traction([0.0, -0.5, 0.0]),
            amplitude: Amplitude::constant(1.0),
        };
        model.contacts.push(joint);
        model.bodies.push(body);
        model.nonlinear.loads = vec![push];
        // the upper block is not above the middle of the lower one, whose top leans and would let it slide
        for group in ["a.left", "b.left"] {
            let nodes = model.mesh.group_nodes(&model.mesh.groups[group]);
            let fix = [true, false, false];
            model.supports.push(Support {
                nodes,
                fix,
                fix_rotations: [false; 3],
            });
        }
        let newton = pressed(model).unwrap();
        let (system, motion) = (newton.system(), &newton.state().motion);
        let on = |body: usize| -> f64 {
            let nodes = system.body_masses[body].iter();
            nodes
                .map(|(node, _)| motion.contact_force[2 * *node as usize + 1])
                .sum()
        };
        // a quarter of the area of the lower block, and the traction on 0.5 times 0.5
        let upper = 0.25 * WEIGHT + 0.5 * 0.25;
        // iterations end at 1e-10 of the forces, the largest of which are those inside
        assert!((on(1) - upper).abs() < 1e-8, "{}", on(1) - upper);
        assert!((on(0) - WEIGHT).abs() < 1e-8, "{}", on(0) - WEIGHT);
        let ground = newton.report().contacts[0].force;
        assert!((ground - WEIGHT - upper).abs() < 1e-8, "{ground}");
        assert!(newton.residuals().len() <= 20, "{:?}", newton.residuals());
    }
}

/// A square on a clamped one, of two by two cells each, in one body or in two; nothing but their contact keeps them apart.
fn stacked(material: Material, sliding: Sliding, one_body: bool) -> Model {
    let mut model = square(TRAPEZOID, VELOCITY, material, 2);
    model.bodies[0].velocity = [0.0; 3];
    model.gravity = [0.0; 3];
    let upper = generate::rectangle("b", [0.0, 1.0], [1.0, 1.0], [2, 2], false);
    model.mesh.merge("b", upper).unwrap();
    let lower = model.bodies[0].spec.cells.clone();
    let upper = model.mesh.groups["b"].elements.clone();
    let surface = |group: &str, cells: &[_]| {
        Surface::new(&model.mesh, &model.mesh.groups[group], cells).unwrap()
    };
    model.contacts[0].secondary = surface("b.bottom", &upper);
    model.contacts[0].primary = ModelTarget::Surface(surface("a.top", &lower));
    model.contacts[0].sliding = sliding;
    let held = |nodes: Vec<u32>, fix: [bool; 3]| Support {
        nodes,
        fix,
        fix_rotations: [false; 3],
    };
    let bottom = model.mesh.group_nodes(&model.mesh.groups["a.bottom"]);
    let side = node_at(&model, [0.0, 1.5], 9);
    model.supports = vec![
        held(bottom, [true; 3]),
        held(vec![side], [true, false, false]),
    ];
    match one_body {
        true => model.bodies[0].spec.cells.extend(upper),
        false => {
            let mut body = model.bodies[0].clone();
            body.spec.name = "b".into();
            body.spec.cells = upper;
            model.bodies.push(body);
        }
    }
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 2 });
    model
}

/// The node at a place, from a number on.
fn node_at(model: &Model, place: [f64; 2], first: u32) -> u32 {
    let nodes = model.mesh.nodes.iter().zip(0..);
    let mut nodes = nodes.filter(|&(_, node)| node >= first);
    let is_there = |x: &[f64; 3]| (0..2).all(|i| (x[i] - place[i]).abs() < 1e-9);
    nodes.find(|(x, _)| is_there(x)).unwrap().1
}

/// Two plates and a bolt: the spring holds its direction, and the turn about its end is for the contact alone to hold.
/// A body of two pieces is in one part of the model, and its pieces move apart all the same.
#[test]
fn a_piece_of_a_body_rests_on_another_piece_of_it() {
    let forces = [true, false].map(|one_body| {
        let mut model = stacked(COLUMN.into(), Sliding::Small, one_body);
        model.gravity = [0.0, -0.1, 0.0];
        let newton = pressed(model).unwrap();
        newton.report().contacts[0].force
    });
    for force in forces {
        // the weight of the upper square; iterations end at 1e-10 of the forces
        assert!((force / WEIGHT - 1.0).abs() < 1e-9, "{forces:?}");
    }
}

/// The bolt holds its direction and the support the other: without contact ahead the plate would turn about the bolt.
#[test]
fn a_plate_that_a_load_turns_about_its_bolt_is_named() {
    let mut model = stacked(COLUMN.into(), Sliding::Finite, false);
    let ends = [([0.5, 0.0], 0), ([0.5, 2.0], 9)];
    let ends = ends.map(|(place, first)| node_at(&model, place, first));
    let spring = (Curve::line(0.5), Some([0.0, 1.0, 0.0]));
    link(&mut model, &ends, DiscreteKind::Spring, spring);
    // no contact on the side to which it turns
    let cells = model.bodies[1].spec.cells.clone();
    let left = carom_mesh::Group::new(1, model.mesh.groups["b.bottom"].elements[..1].to_vec());
    model.contacts[0].secondary = Surface::new(&model.mesh, &left, &cells).unwrap();
    let side = &model.mesh.groups["b.right"];
    let push = Load {
        name: "push".into(),
        surface: Surface::new(&model.mesh, side, &cells).unwrap(),
        kind: LoadKind::Traction([0.0, -0.02, 0.0]),
        amplitude: Amplitude::constant(1.0),
    };
    model.nonlinear.loads = vec![push];
    assert_eq!(refusal(model), "1 b: turn about z");
}
