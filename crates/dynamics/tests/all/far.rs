//! Contacts that do not look for what is far have the forces of those that look for all points.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_contact::{Integration, Law, Sliding};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, Support, System, scheme,
};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Surface, generate};

const STEPS: usize = 40;

/// Cells along a side of the upper block, of 0.1 m.
const CELLS: usize = 10;

/// How the blocks come together.
#[derive(Clone, Copy)]
struct Fall {
    /// Distance of the blocks, m.
    gap: f64,
    /// Speed of the upper one at the start, m/s.
    speed: f64,
    /// Acceleration of gravity, m/s².
    gravity: f64,
    dt: f64,
}

/// Two blocks at finite strain, the upper one above the lower one, which is held, beside its middle; their whole outer sides are
/// in contact. `near_only`: without those that are far.
fn blocks(fall: Fall, law: Law, near_only: bool) -> Model {
    let cells = [CELLS; 2];
    let mut mesh = generate::rectangle("low", [0.0; 2], [1.0; 2], cells, false);
    let high = generate::rectangle("high", [0.33, 1.0 + fall.gap], [1.0; 2], cells, false);
    mesh.merge("high", high).unwrap();
    let initial = Elastic {
        density: 1000.0,
        young: 1e7,
        poisson: 0.3,
    };
    let body = |name: &str, speed: f64| {
        let cells = mesh.groups[name].elements.clone();
        let plane = Kinematics::PlaneStrain { thickness: 1.0 };
        ModelBody {
            velocity: [0.3 * speed, -speed, 0.0],
            ..ModelBody::new(BodySpec::new(
                name,
                cells,
                plane,
                Material::NeoHooke(NeoHooke { initial }),
            ))
        }
    };
    let bodies = vec![body("low", 0.0), body("high", fall.speed)];
    let side = |k: usize| Surface::outer(&mesh, &bodies[k].spec.cells);
    let contact = ModelContact {
        sliding: Sliding::Finite,
        integration: Integration::Node,
        friction: 0.2.into(),
        depth: Some(0.1),
        near_only,
        ..ModelContact::new("all", side(1), ModelTarget::Surface(side(0)), law)
    };
    Model {
        contacts: vec![contact],
        // gravity is that of the upper block
        supports: vec![Support {
            nodes: mesh.group_nodes(&mesh.groups["low"]),
            fix: [true, true, false],
            fix_rotations: [false; 3],
        }],
        gravity: [0.0, -fall.gravity, 0.0],
        ..Model::new(
            bodies,
            mesh,
            Scheme::GeneralisedAlpha(scheme::GeneralisedAlpha::default()),
            fall.dt,
        )
    }
}

fn velocity() -> Law {
    Law::Velocity(Velocity {
        capture: Capture::Half,
        reading: Reading::Closed,
    })
}

/// Resultant of the contact in each of some steps, N, and the least gap that it knows, m.
fn run(model: Model, steps: usize) -> Vec<([f64; 3], f64)> {
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    let step = |driver: &mut Driver| {
        driver.step().unwrap();
        let contact = &driver.report().contacts[0];
        (contact.resultant, contact.gap)
    };
    (0..steps).map(|_| step(&mut driver)).collect()
}

#[test]
fn forces_are_those_of_all_points() {
    let slow = Fall {
        gap: 0.05,
        speed: 4.0,
        gravity: 0.0,
        dt: 5e-4,
    };
    // the first step alone leads half a metre down, five cells, from rest and from three cells away
    let sudden = Fall {
        gap: 0.3,
        speed: 0.0,
        gravity: 1e4,
        dt: 1e-2,
    };
    // 0.2 m in a step, twice the depth
    let fast = Fall {
        gap: 0.55,
        speed: 40.0,
        gravity: 0.0,
        dt: 5e-3,
    };
    let displacement = Law::Displacement(Displacement { projection: false });
    let cases = [
        (slow, velocity(), STEPS),
        (slow, displacement, STEPS),
        (sudden, displacement, 1),
        (fast, displacement, 3),
    ];
    for (number, (fall, law, steps)) in cases.into_iter().enumerate() {
        let [near, all] = [true, false].map(|near_only| run(blocks(fall, law, near_only), steps));
        let largest = all[..steps].iter().flat_map(|(force, _)| force);
        let largest = largest.fold(0.0_f64, |most, force| most.max(force.abs()));
        assert!(largest > 0.0, "the blocks meet in case {number}");
        for (step, ((one, _), (other, _))) in near.iter().zip(&all).enumerate().take(steps) {
            // the same equations in the same order: no more than rounding
            let apart = (0..3).fold(0.0_f64, |most, i| most.max((one[i] - other[i]).abs()));
            assert!(
                apart <= 1e-12 * largest,
                "case {number}, step {step}: {one:?} {other:?}"
            );
        }
    }
}

#[test]
fn gaps_of_sides_that_are_apart_are_not_known() {
    let fall = Fall {
        gap: 0.5,
        speed: 1.0,
        gravity: 0.0,
        dt: 1e-3,
    };
    let [near, all] =
        [true, false].map(|near_only| run(blocks(fall, velocity(), near_only), STEPS));
    assert!(near.iter().all(|(_, gap)| *gap == f64::INFINITY));
    assert!(all.iter().all(|(_, gap)| gap.is_finite()));
}
