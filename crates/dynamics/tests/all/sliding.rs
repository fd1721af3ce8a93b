//! Small sliding: points paired once.

use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_contact::{
    Basis, Integration, Law, Motion, Obstacle, Plane, Side, Sliding, Sphere, Translation,
};
use carom_dynamics::{
    Amplitude, Driver, Model, ModelTarget, Nonlinear, Preload, Prescribed, Scheme, System, scheme,
};

use crate::newton::{SOFT, square};

const DISPLACEMENT: Law = Law::Displacement(Displacement { projection: false });
const VELOCITY: Law = Law::Velocity(Velocity {
    capture: Capture::Now,
    reading: Reading::Closed,
});
const TRAPEZOID: Scheme = Scheme::Newmark(scheme::Newmark {
    beta: 0.25,
    gamma: 0.5,
});

/// The square over a sphere beside its middle, thrown along it.
fn over_sphere(scheme: Scheme, law: Law, sliding: Sliding) -> Model {
    let mut model = square(scheme, law, SOFT.into(), 4);
    model.bodies[0].velocity = [0.15, -0.2, 0.0];
    model.contacts[0].sliding = sliding;
    model.contacts[0].primary = ModelTarget::rigid(Sphere {
        centre: [0.6, -2.01, 0.0],
        radius: 2.0,
        side: Side::Outside,
    });
    model
}

#[test]
fn small_sliding_leaves_a_linear_system_linear_and_is_not_finite_sliding() {
    let theta = |theta| Scheme::Theta(scheme::Theta { theta });
    let mortar = Integration::Mortar { basis: Basis::Dual };
    let sets = [
        (TRAPEZOID, DISPLACEMENT, Integration::Node),
        (theta(0.5), VELOCITY, Integration::Node),
        (theta(0.75), DISPLACEMENT, mortar),
        (
            Scheme::CentralDifference(scheme::CentralDifference {}),
            VELOCITY,
            Integration::Node,
        ),
    ];
    for (scheme, law, integration) in sets {
        let name = scheme.get().name();
        let model = |sliding| {
            let mut model = over_sphere(scheme, law, sliding);
            model.contacts[0].integration = integration;
            System::new(model).unwrap()
        };
        let mut small = Driver::new(model(Sliding::Small)).unwrap();
        let mut finite = Driver::new(model(Sliding::Finite)).unwrap();
        let mut largest = 0.0_f64;
        for _ in 0..40 {
            small.step().unwrap();
            finite.step().unwrap();
            largest = largest.max(small.report().contacts[0].force);
        }
        assert!(largest > 0.0, "{name} never touches");
        let [one, apart] = [small.state(), finite.state()].map(|state| &state.motion.u);
        let size = one.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let off = |other: &[f64]| {
            let each = one.iter().zip(other).map(|(a, b)| (a - b).abs());
            each.fold(0.0, f64::max) / size
        };
        // the sphere curves, so that it matters where points are paired
        assert!(off(apart) > 1e-4, "{name}: {:e}", off(apart));
        if scheme.get().step_map(0.05).force.x != 0.0 {
            assert_eq!(
                small.costs().work.factorisations,
                1,
                "{name}: all is linear"
            );
        }
    }
}

/// Force and friction after the top of the square has come down on the sphere by `way` and along it by as much.
fn pressed(sliding: Sliding, way: f64) -> [f64; 2] {
    let mut model = over_sphere(TRAPEZOID, DISPLACEMENT, sliding);
    model.contacts[0].friction = 0.1.into();
    model.contacts[0].primary = ModelTarget::rigid(Sphere {
        centre: [0.5, -2.0, 0.0],
        radius: 2.0,
        side: Side::Outside,
    });
    model.gravity = [0.0; 3];
    let to = |end: f64| Some(Amplitude::new(vec![[0.0, 0.0], [4.0, end]]).unwrap());
    model.nonlinear = Nonlinear {
        motions: vec![Prescribed {
            nodes: model.mesh.group_nodes(&model.mesh.groups["a.top"]),
            displacement: [to(way), to(-way), None],
        }],
        preload: Some(Preload { end: 4.0, steps: 4 }),
        ..Nonlinear::default()
    };
    let mut newton = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..4 {
        newton.step().unwrap();
    }
    let report = &newton.report().contacts[0];
    assert!(report.slipping > 0);
    [report.force, report.friction]
}

#[test]
fn small_sliding_is_the_limit_of_finite_sliding_with_friction() {
    let difference = |way: f64| {
        let [small, finite] = [Sliding::Small, Sliding::Finite].map(|s| pressed(s, way));
        [0, 1].map(|i| (small[i] / finite[i] - 1.0).abs())
    };
    let [coarse, fine] = [0.008, 0.001].map(difference);
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        // rows turn by the way over the radius: relative differences are of the order of the motion
        assert!(coarse > 1e-5 && fine < 0.25 * coarse, "{coarse:e} {fine:e}");
    }
}

#[test]
fn on_a_plane_that_moves_small_and_finite_sliding_are_one() {
    let run = |sliding| {
        let mut model = square(TRAPEZOID, DISPLACEMENT, SOFT.into(), 3);
        model.bodies[0].velocity = [0.1, 0.0, 0.0];
        model.contacts[0].friction = 0.3.into();
        model.contacts[0].sliding = sliding;
        let plane = Plane {
            point: [0.0, -0.01, 0.0],
            normal: [0.0, 1.0, 0.0],
        };
        let motion = Motion {
            translation: Some(Translation::Velocity([-0.05, 0.2, 0.0])),
            turn: None,
        };
        model.contacts[0].primary = ModelTarget::Rigid(Obstacle {
            motion,
            ..plane.into()
        });
        let mut newton = Driver::new(System::new(model).unwrap()).unwrap();
        for _ in 0..20 {
            newton.step().unwrap();
        }
        assert!(newton.state().records.contacts[0].impulse() > 0.0);
        newton.state().motion.u.clone()
    };
    let [small, finite] = [Sliding::Small, Sliding::Finite].map(run);
    let size = finite.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    for (a, b) in small.iter().zip(&finite) {
        // one normal, and a gap that is linear in the motion: the same equations
        assert!((a - b).abs() < 1e-10 * size);
    }
}
