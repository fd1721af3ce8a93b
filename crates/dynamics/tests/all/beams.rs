//! Beams in the step: balances of energy, momentum and angular momentum, allocations, mass, what is refused.

use carom_algebra::unknowns::Kind;
use carom_bodies::{BeamSection, BeamTheory, BodySpec, Kinematics, MassKind, SectionShape};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Plane};
use carom_dynamics::scheme::{CentralDifference, EnergyMomentum, Newmark, Theta};
use carom_dynamics::{
    Driver, Error, Model, ModelBody, ModelConstraint, ModelContact, ModelTarget, Preload, Scheme,
    State, Support, System,
};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};
use carom_testing::allocations;

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.3,
};

/// A beam of ten elements, at an angle in the plane, or in space; its right end lies lowest.
fn beam(dim: usize, scheme: Scheme, mass: MassKind) -> Model {
    let to = match dim {
        2 => [0.8, -0.6, 0.0],
        _ => [3.0 / 7.0, 2.0 / 7.0, -6.0 / 7.0],
    };
    let mesh = generate::line("a", [0.0; 3], to, 10, dim);
    let shape = SectionShape::Rectangle {
        height: 0.04,
        width: 0.02,
    };
    let section = BeamSection {
        orientation: (dim == 3).then_some([0.0, 1.0, 0.2]),
        ..BeamSection::new(BeamTheory::Timoshenko, shape.properties(0.3))
    };
    let cells = mesh.groups["a"].elements.clone();
    let spec = BodySpec::new("a", cells, Kinematics::Beam(section), STEEL);
    let body = ModelBody {
        mass,
        ..ModelBody::new(spec)
    };
    Model::new(vec![body], mesh, scheme, 1e-6)
}

/// The same, falling on its right end.
fn falling(dim: usize, scheme: Scheme, mass: MassKind) -> Model {
    let mut model = beam(dim, scheme, mass);
    let (axis, last) = (dim - 1, model.mesh.nodes.len() - 1);
    let mut velocity = [0.1, 0.0, 0.0];
    velocity[axis] = -2.0;
    model.bodies[0].velocity = velocity;
    model.gravity[axis] = -9.81;
    let mut normal = [0.0; 3];
    normal[axis] = 1.0;
    let cells = &model.bodies[0].spec.cells;
    let plane = Plane {
        point: model.mesh.nodes[last],
        normal,
    };
    model.contacts = vec![ModelContact::new(
        "ground",
        Surface::new(&model.mesh, &model.mesh.groups["a.right"], cells).unwrap(),
        ModelTarget::rigid(plane),
        Law::Velocity(Velocity {
            capture: Capture::Half,
            reading: Reading::Closed,
        }),
    )];
    model
}

fn run(model: Model, steps: usize) -> Driver {
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..steps {
        driver.step().unwrap();
    }
    driver
}

/// Residuals of energy, momentum and angular momentum, each over the largest of its kind.
fn residuals(state: &State) -> [f64; 3] {
    let ledger = &state.ledger;
    [
        ledger.largest_energy_residual / ledger.largest_energy,
        ledger.largest_momentum_residual / ledger.largest_momentum,
        ledger.largest_angular_residual / ledger.largest_angular_momentum,
    ]
}

const THETA: Scheme = Scheme::Theta(Theta { theta: 0.5 });
const NEWMARK: Scheme = Scheme::Newmark(Newmark {
    beta: 0.25,
    gamma: 0.5,
});

/// Rounding of some hundred steps: 1e-9 is what the ledger promises for linear bodies.
#[test]
fn balances_close_in_an_impact_of_a_beam() {
    for dim in [2, 3] {
        for (scheme, mass) in [
            (THETA, MassKind::Consistent),
            (
                Scheme::EnergyMomentum(EnergyMomentum {}),
                MassKind::Consistent,
            ),
            (THETA, MassKind::Lumped),
            (
                Scheme::CentralDifference(CentralDifference {}),
                MassKind::Lumped,
            ),
        ] {
            if dim == 3 && mass == MassKind::Lumped {
                continue;
            }
            let driver = run(falling(dim, scheme, mass), 400);
            let state = driver.state();
            let impulse = state.records.contacts[0].impulse();
            assert!(impulse > 0.1, "{impulse}");
            let [energy, momentum, angular] = residuals(state);
            assert!(energy < 1e-9 && momentum < 1e-9, "{energy} {momentum}");
            assert!(angular < 1e-9, "{dim} {angular}");
        }
    }
}

#[test]
fn a_step_of_a_beam_allocates_nothing() {
    for scheme in [THETA, NEWMARK] {
        let mut model = falling(2, scheme, MassKind::Consistent);
        if let Scheme::Newmark(_) = scheme {
            model.contacts.clear();
        }
        let mut driver = run(model, 200);
        let mut fewest = usize::MAX;
        // statuses may still change in some steps
        for _ in 0..20 {
            let before = allocations();
            driver.step().unwrap();
            fewest = fewest.min(allocations() - before);
        }
        assert_eq!(fewest, 0);
    }
}

/// A clamp at one node holds a beam in a static stage; a hinge does not.
#[test]
fn a_clamp_at_one_node_holds_a_beam_and_a_hinge_does_not() {
    for dim in [2, 3] {
        let model = |fix_rotations: [bool; 3]| {
            let mut model = beam(dim, NEWMARK, MassKind::Consistent);
            model.gravity = [0.0, -9.81, 0.0];
            model.supports = vec![Support {
                nodes: vec![0],
                fix: [true; 3],
                fix_rotations,
            }];
            model.nonlinear.preload = Some(Preload { end: 1.0, steps: 1 });
            Driver::new(System::new(model).unwrap())
        };
        assert!(model([true; 3]).unwrap().step().is_ok());
        let refused = model([true, true, false]).err();
        assert!(
            matches!(refused, Some(Error::FreeMotion { .. })),
            "{refused:?}"
        );
    }
}

/// A beam hangs on the end of a clamped one by the rows of a constraint: each motion that they leave is named.
#[test]
fn a_static_stage_names_the_beam_that_a_constraint_leaves_free() {
    use Kind::{Rotation, Translation};
    let hung = |tied: &[Kind]| {
        let mut model = beam(2, NEWMARK, MassKind::Consistent);
        let second = generate::line("b", [0.8, -0.6, 0.0], [1.8, -0.6, 0.0], 10, 2);
        model.mesh.merge("b", second).unwrap();
        let mut body = model.bodies[0].clone();
        body.spec.name = "b".into();
        body.spec.cells = model.mesh.groups["b"].elements.clone();
        model.bodies.push(body);
        model.gravity = [0.0, -9.81, 0.0];
        model.supports = vec![Support {
            nodes: vec![0],
            fix: [true; 3],
            fix_rotations: [true; 3],
        }];
        let row = |&kind: &Kind| vec![(10, kind, 1.0), (11, kind, -1.0)];
        model.constraints = vec![ModelConstraint {
            name: "joint".into(),
            rows: tied.iter().map(row).collect(),
        }];
        model.nonlinear.preload = Some(Preload { end: 1.0, steps: 1 });
        match Driver::new(System::new(model).unwrap()) {
            Err(Error::FreeMotion {
                body,
                motion,
                constraints,
            }) => {
                assert_eq!(constraints, ["joint"]);
                format!("{body} can {motion}")
            }
            Err(other) => panic!("{other}"),
            Ok(mut driver) => driver
                .step()
                .map_or_else(|e| e.to_string(), |_| "held".into()),
        }
    };
    let [x, y, turn] = [Translation(0), Translation(1), Rotation(2)];
    assert_eq!(hung(&[x, y, turn]), "held");
    assert_eq!(hung(&[y]), "b can move along x");
    assert_eq!(hung(&[x]), "b can move along y");
    assert_eq!(hung(&[x, turn]), "b can move along y");
    // about the hinge: translations with the turn, of which the last is named
    assert_eq!(hung(&[x, y]), "b can turn about z");
}

#[test]
fn a_lumped_mass_that_is_not_diagonal_is_refused() {
    let error = System::new(beam(3, THETA, MassKind::Lumped)).err();
    let told = error.map(|error| error.to_string()).unwrap_or_default();
    assert!(told.contains("take a consistent mass"), "{told}");
}
