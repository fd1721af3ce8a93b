//! Contact points whose way to what they face is held by a support, but for rounding.

use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_contact::{Law, Plane};
use carom_dynamics::scheme::Newmark;
use carom_dynamics::{Driver, ModelTarget, Preload, Scheme, Support, System};

use crate::newton::{SOFT, square};

/// Force of the plane below a square that its weight presses on it in a static step: the left side is held across the plane, the lower left
/// corner with it, and the right side along it. The plane leans by an angle of this tangent.
fn force(lean: f64, law: Law, friction: f64) -> f64 {
    let scheme = Scheme::Newmark(Newmark {
        beta: 0.25,
        gamma: 0.5,
    });
    let mut model = square(scheme, law, SOFT.into(), 4);
    let length = lean.hypot(1.0);
    model.contacts[0].primary = ModelTarget::rigid(Plane {
        point: [0.0; 3],
        normal: [lean / length, 1.0 / length, 0.0],
    });
    model.contacts[0].friction = friction.into();
    model.bodies[0].velocity = [0.0; 3];
    let held = |side: &str, fix: [bool; 3]| Support {
        nodes: model.mesh.group_nodes(&model.mesh.groups[side]),
        fix,
        fix_rotations: [false; 3],
    };
    let supports = vec![
        held("a.left", [false, true, false]),
        held("a.right", [true, false, false]),
    ];
    model.supports = supports;
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 2 });
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..2 {
        driver.step().unwrap();
    }
    driver.report().contacts[0].force
}

#[test]
fn a_plane_that_leans_by_a_rounding_presses_a_node_that_is_held_across_it_no_more_than_a_level_one()
{
    let laws = [
        Law::Displacement(Displacement { projection: false }),
        Law::Velocity(Velocity {
            capture: Capture::Now,
            reading: Reading::Closed,
        }),
    ];
    // 2 kg/m³ on a square metre, 0.5 m thick, under 0.1 m/s²
    let weight = 0.1;
    for law in laws {
        for friction in [0.0, 0.2] {
            let level = force(0.0, law, friction);
            // the left side takes a part of it
            assert!(level > 0.5 * weight && level < weight, "{level}");
            for lean in [1.2e-16, -1e-12, 1e-9] {
                let leaning = force(lean, law, friction);
                // the plane is deeper by the lean times a metre, and the square as stiff as 8 Pa times 0.5 m
                let off = (leaning - level).abs();
                assert!(
                    off <= 1e-9 * weight + 10.0 * lean.abs(),
                    "{lean} {leaning} {level}"
                );
            }
        }
    }
}
