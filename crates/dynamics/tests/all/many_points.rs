//! Many points of contact. Explicit steps, where they share nodes: nothing is dense, and every point obeys its law. Implicit ones, where
//! bodies share nothing: what is held grows as the bodies.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Basis, Integration, Law, Plane, Sliding};
use carom_dynamics::scheme::{CentralDifference, Theta};
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

const STEEL: Elastic = Elastic {
    density: 2.0,
    young: 8.0,
    poisson: 0.0,
};
const FRICTION: f64 = 0.2;

fn velocity() -> Law {
    Law::Velocity(Velocity {
        capture: Capture::Now,
        reading: Reading::Closed,
    })
}

/// Two plates of 1 m x 1 m and two elements, of meshes that do not match, that touch and approach each other with 2 m/s and slide
/// with 0.5 m/s; `across`: elements along the sides of the upper one.
fn plates(across: usize, integration: Integration, friction: f64) -> Driver {
    let model = model([across, across - across / 9], [0.5, 0.0], |[own, other]| {
        let target = ModelTarget::Surface(other);
        ModelContact {
            integration,
            friction: friction.into(),
            ..ModelContact::new("joint", own, target, velocity())
        }
    });
    Driver::new(System::new(model).unwrap()).unwrap()
}

/// Plates of as many elements along the sides, the upper one first, that slide with `slides` m/s and are `apart` m from each other;
/// `contact`: between their sides.
fn model(
    [across, below]: [usize; 2],
    [slides, apart]: [f64; 2],
    contact: impl FnOnce([Surface; 2]) -> ModelContact,
) -> Model {
    let height = 2.0 / across as f64;
    let plate = |name: &str, low: f64, n: usize| {
        generate::box_(name, [0.0, 0.0, low], [1.0, 1.0, height], [n, n, 2], false)
    };
    let mut mesh = plate("a", height + apart, across);
    mesh.merge("b", plate("b", 0.0, below)).unwrap();
    let body = |name: &str, velocity: [f64; 3]| {
        let cells = mesh.groups[name].elements.clone();
        ModelBody {
            velocity,
            ..ModelBody::new(BodySpec::new(name, cells, Kinematics::Solid, STEEL))
        }
    };
    let side = |body: &str, side: &str| {
        let group = &mesh.groups[&format!("{body}.{side}")];
        Surface::new(&mesh, group, &mesh.groups[body].elements).unwrap()
    };
    Model {
        contacts: vec![contact([side("a", "bottom"), side("b", "top")])],
        ..Model::new(
            vec![body("a", [slides, 0.0, -1.0]), body("b", [0.0, 0.0, 1.0])],
            mesh,
            Scheme::CentralDifference(CentralDifference {}),
            // the waves have 2 m/s; an eighth of the way through an element
            0.0625 / across as f64,
        )
    }
}

/// Points that carry a force after a step, and the numbers per point of the largest matrix, each with its place.
///
/// Closed points neither approach nor part, to 1e-9 of a velocity of 2 m/s that the solver finds to 1e-12; others do not approach;
/// friction is within its bound.
fn step(driver: &mut Driver, friction: f64) -> (usize, f64) {
    driver.step().unwrap();
    let state = driver.state();
    let largest = state
        .interface
        .force
        .iter()
        .fold(0.0, |most, p| f64::max(most, *p));
    let mut closed = 0;
    for (point, &force) in state.interface.force.iter().enumerate() {
        let rate = state.interface.rate[point];
        assert!(force >= -1e-12 * largest, "{point}: {force}");
        match force > 0.0 {
            true => assert!(rate.abs() < 1e-9, "{point}: {rate:e}"),
            false => assert!(rate > -1e-9, "{point}: {rate:e}"),
        }
        closed += usize::from(force > 0.0);
        if friction > 0.0 {
            let [t, s] = state.interface.friction[point];
            assert!(t.hypot(s) <= friction * force + 1e-11 * largest, "{point}");
        }
    }
    // eight bytes each, beside the places that rows share: no more numbers than that
    let numbers = driver.costs().compliance_bytes as f64 / 8.0;
    (closed, numbers / state.interface.force.len() as f64)
}

#[test]
fn ten_thousand_points_have_at_most_a_hundred_numbers_each() {
    let dual = Integration::Mortar { basis: Basis::Dual };
    for (across, integration, friction) in [
        (100, Integration::Node, 0.0),
        (100, Integration::Node, FRICTION),
        (30, dual, 0.0),
        (30, dual, FRICTION),
    ] {
        let mut driver = plates(across, integration, friction);
        let (closed, numbers) = step(&mut driver, friction);
        assert!(closed > across * across, "{integration:?}: {closed}");
        assert!(
            numbers <= 100.0,
            "{integration:?}, friction {friction}: {numbers}"
        );
    }
}

/// Two plates that come together, as one surface that faces itself, have the forces that they have where the finer one is the secondary
/// surface, whichever of them is the first: to 1e-9 of the largest, as the solver finds both to 1e-10 of it.
#[test]
fn of_a_surface_that_faces_itself_the_finer_side_tells_the_contact() {
    let finite = |own, target, law| ModelContact {
        sliding: Sliding::Finite,
        friction: FRICTION.into(),
        ..ModelContact::new("joint", own, ModelTarget::Surface(target), law)
    };
    let told = |[upper, lower]: [Surface; 2]| match upper.faces.len() > lower.faces.len() {
        true => finite(upper, lower, velocity()),
        false => finite(lower, upper, velocity()),
    };
    let itself = |[mut both, lower]: [Surface; 2]| {
        both.faces.extend(lower.faces);
        both.nodes.extend(lower.nodes);
        both.nodes.sort_unstable();
        finite(both.clone(), both, velocity())
    };
    for sizes in [[18, 16], [16, 18]] {
        let [once, twice] = [
            model(sizes, [0.0, 1e-3], told),
            model(sizes, [0.0, 1e-3], itself),
        ]
        .map(|model| {
            let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
            driver.step().unwrap();
            let state = driver.state();
            let closed = state.interface.force.iter().filter(|p| **p > 0.0);
            (closed.count(), state.motion.contact_force.clone())
        });
        assert_eq!((once.0, twice.0), (19 * 19, 19 * 19));
        let largest = once.1.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        for (k, (a, b)) in once.1.iter().zip(&twice.1).enumerate() {
            assert!((a - b).abs() <= 1e-9 * largest, "{k}: {a:e} {b:e}");
        }
    }
}

/// `count` blocks of side 1, of 2 x 2 x 2 elements, that fall on a plane with 1 m/s and slide with 0.3 m/s, with steps of the implicit
/// Euler method.
fn falling(count: usize, friction: f64) -> Driver {
    let name = |k: usize| format!("block-{k}");
    let block = |k: usize| {
        let corner = [3.0 * k as f64, 0.0, 0.01];
        generate::box_(&name(k), corner, [1.0; 3], [2; 3], false)
    };
    let mut mesh = block(0);
    for k in 1..count {
        mesh.merge(&name(k), block(k)).unwrap();
    }
    let body = |k: usize| {
        let cells = mesh.groups[&name(k)].elements.clone();
        ModelBody {
            velocity: [0.3, 0.0, -1.0],
            ..ModelBody::new(BodySpec::new(name(k), cells, Kinematics::Solid, STEEL))
        }
    };
    let law = velocity();
    let contact = |k: usize| {
        let group = &mesh.groups[&format!("{}.bottom", name(k))];
        let side = Surface::new(&mesh, group, &mesh.groups[&name(k)].elements).unwrap();
        let plane = ModelTarget::rigid(Plane {
            point: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
        });
        ModelContact {
            friction: friction.into(),
            ..ModelContact::new(name(k), side, plane, law)
        }
    };
    let contacts = (0..count).map(contact).collect();
    let bodies = (0..count).map(body).collect();
    let scheme = Scheme::Theta(Theta { theta: 1.0 });
    let model = Model {
        contacts,
        ..Model::new(bodies, mesh, scheme, 0.02)
    };
    Driver::new(System::new(model).unwrap()).unwrap()
}

/// Bodies that share nothing are solved by themselves in an implicit step too: what is held grows as their number, and each moves
/// as it does alone. Tolerance: rounding; places differ, and sums over all bodies have another order.
#[test]
fn bodies_that_share_nothing_are_groups_of_their_own() {
    for friction in [0.0, FRICTION] {
        let (mut alone, mut many) = (falling(1, friction), falling(5, friction));
        let mut touched = 0;
        for _ in 0..25 {
            alone.step().unwrap();
            many.step().unwrap();
            let forces = &alone.state().interface.force;
            touched += usize::from(forces.iter().any(|force| *force > 0.0));
            let bytes = [&alone, &many].map(|driver| driver.costs().compliance_bytes);
            assert_eq!(bytes[1], 5 * bytes[0], "friction {friction}");
        }
        assert!(touched > 5, "{touched}");
        let (one, all) = (&alone.state().motion.u, &many.state().motion.u);
        let largest = one.iter().fold(0.0, |most, u| f64::max(most, u.abs()));
        for (k, u) in all.iter().enumerate() {
            let own = one[k % one.len()];
            assert!((u - own).abs() < 1e-12 * largest, "{k}: {u} {own}");
        }
    }
}
