//! Bars and beams of metal that flows, in the step: balances, allocations, runs that are cut, steps that fail, steps that are refused.

use carom_bodies::{
    BeamSection, BeamTheory, BodySpec, Error as Refusal, Kinematics, MassKind, Rotations,
    SectionShape,
};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Plane};
use carom_dynamics::scheme::{CentralDifference, EnergyMomentum, Newmark, Theta};
use carom_dynamics::{
    Driver, Error, Model, ModelBody, ModelContact, ModelTarget, Scheme, State, Stepper, System,
};
use carom_materials::{Elastic, J2Plasticity, JohnsonCook, Law as Material, Thermal};
use carom_mesh::{Surface, generate};
use carom_testing::allocations;

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.3,
};

const METAL: Material = Material::J2Plasticity(J2Plasticity {
    initial: STEEL,
    yield_stress: 3e7,
    hardening: 1e10,
});

/// With rate and heat.
const COOK: Material = Material::JohnsonCook(JohnsonCook {
    initial: STEEL,
    yield_stress: 3e7,
    hardening: 1e8,
    exponent: 0.4,
    rate_factor: 0.02,
    reference_rate: 1.0,
    thermal: Some(Thermal {
        exponent: 1.0,
        melting_rise: 1500.0,
        specific_heat: 460.0,
        converted: 0.9,
    }),
});

const THETA: Scheme = Scheme::Theta(Theta { theta: 0.5 });
const NEWMARK: Scheme = Scheme::Newmark(Newmark {
    beta: 0.25,
    gamma: 0.5,
});
const CENTRAL: Scheme = Scheme::CentralDifference(CentralDifference {});

#[derive(Clone, Copy, Debug)]
enum Line {
    Bars,
    Beams(Rotations),
}

/// A line of ten elements falls with its end on a plane, in the plane or in space. Only beams with rotations may stand at an angle:
/// bars would fold.
fn falling(line: Line, dim: usize, scheme: Scheme, material: Material) -> Model {
    let to = match (line, dim) {
        (Line::Bars, _) => [
            0.0,
            if dim == 2 { -1.0 } else { 0.0 },
            if dim == 3 { -1.0 } else { 0.0 },
        ],
        (_, 2) => [0.8, -0.6, 0.0],
        _ => [3.0 / 7.0, 2.0 / 7.0, -6.0 / 7.0],
    };
    let mesh = generate::line("a", [0.0; 3], to, 10, dim);
    let shape = SectionShape::Rectangle {
        height: 0.04,
        width: 0.02,
    };
    let kinematics = match line {
        Line::Bars => Kinematics::Bar { area: 8e-4 },
        Line::Beams(rotations) => Kinematics::Beam(BeamSection {
            shape: Some(shape),
            layers: 4,
            rotations,
            orientation: (dim == 3).then_some([0.0, 1.0, 0.2]),
            ..BeamSection::new(BeamTheory::Timoshenko, shape.properties(0.3))
        }),
    };
    let cells = mesh.groups["a"].elements.clone();
    let spec = BodySpec::new("a", cells, kinematics, material);
    let (axis, last) = (dim - 1, mesh.nodes.len() - 1);
    let lumped = matches!(scheme, Scheme::CentralDifference(_)) || matches!(line, Line::Bars);
    let mut body = ModelBody {
        mass: if lumped {
            MassKind::Lumped
        } else {
            MassKind::Consistent
        },
        ..ModelBody::new(spec)
    };
    body.velocity[axis] = -4.0;
    let mut normal = [0.0; 3];
    normal[axis] = 1.0;
    let plane = Plane {
        point: mesh.nodes[last],
        normal,
    };
    let ground = ModelContact::new(
        "ground",
        Surface::new(&mesh, &mesh.groups["a.right"], &body.spec.cells).unwrap(),
        ModelTarget::rigid(plane),
        Law::Velocity(Velocity {
            capture: Capture::Half,
            reading: Reading::Closed,
        }),
    );
    Model {
        contacts: vec![ground],
        ..Model::new(vec![body], mesh, scheme, 2e-6)
    }
}

fn models() -> Vec<(String, Model)> {
    let (small, finite) = (
        Line::Beams(Rotations::Small),
        Line::Beams(Rotations::Finite),
    );
    let mut models = Vec::new();
    for material in [METAL, COOK] {
        for (line, dim, scheme) in [
            (Line::Bars, 2, CENTRAL),
            (Line::Bars, 3, THETA),
            (small, 2, CENTRAL),
            (small, 2, THETA),
            (small, 3, THETA),
            (finite, 2, THETA),
            (finite, 3, NEWMARK),
        ] {
            let name = format!("{line:?} {dim} {} {}", scheme.get().name(), material.key());
            models.push((name, falling(line, dim, scheme, material)));
        }
    }
    models
}

fn driver(model: Model) -> Driver {
    Driver::new(System::new(model).unwrap()).unwrap()
}

/// What the iterations leave, 1e-10 of the forces in each of some hundred steps: the ledger promises 1e-9 for linear bodies.
#[test]
fn balances_close_in_an_impact_and_metal_dissipates() {
    for (name, model) in models() {
        let mut driver = driver(model);
        let mut before = 0.0;
        for _ in 0..150 {
            driver.step().unwrap();
            let dissipated = driver.state().ledger.balance.dissipation_material;
            assert!(dissipated >= before, "{name}");
            before = dissipated;
        }
        let ledger = &driver.state().ledger;
        assert!(before > 1e-3 * ledger.initial.energy(), "{name} {before}");
        let energy = ledger.largest_energy_residual / ledger.largest_energy;
        let momentum = ledger.largest_momentum_residual / ledger.largest_momentum;
        assert!(
            energy < 1e-8 && momentum < 1e-8,
            "{name} {energy} {momentum}"
        );
    }
}

/// Beams take steps whose balance by works allocates, as it does for all bodies that are not linear, and implicit ones make factors anew;
/// their forces allocate nothing (tests of the bodies).
#[test]
fn an_explicit_step_of_bars_allocates_nothing() {
    for material in [METAL, COOK] {
        let (name, model) = (material.key(), falling(Line::Bars, 2, CENTRAL, material));
        let mut driver = driver(model);
        for _ in 0..100 {
            driver.step().unwrap();
        }
        let mut fewest = usize::MAX;
        // statuses may still change in some steps
        for _ in 0..20 {
            let before = allocations();
            driver.step().unwrap();
            fewest = fewest.min(allocations() - before);
        }
        assert_eq!(fewest, 0, "{name}");
    }
}

#[test]
fn a_run_that_is_cut_goes_on_with_the_same_bytes() {
    for (name, model) in models() {
        let system = System::new(model).unwrap();
        let mut whole = Driver::new(system.clone()).unwrap();
        for _ in 0..60 {
            whole.step().unwrap();
        }
        let bytes = whole.saved().unwrap();
        let state = State::from_bytes(&system, &bytes).unwrap();
        let mut other = Driver::resume(system.clone(), state).unwrap();
        for _ in 0..40 {
            whole.step().unwrap();
            other.step().unwrap();
        }
        assert!(whole.state().ledger.balance.dissipation_material > 0.0);
        assert_eq!(whole.saved().unwrap(), other.saved().unwrap(), "{name}");
    }
}

/// A step that is attempted and dropped leaves no history: one iteration finds no solution, and the run halves until it gives up.
#[test]
fn a_step_that_fails_leaves_the_state_as_it_was() {
    let (name, mut model) = models().swap_remove(3);
    model.nonlinear.iteration.passes = 1;
    model.nonlinear.iteration.halvings = 2;
    let mut driver = driver(model);
    let failed = loop {
        let before = driver.saved().unwrap();
        if driver.step().is_err() {
            break before;
        }
        assert!(driver.state().step < 200, "{name}: no step has failed");
    };
    assert_eq!(driver.saved().unwrap(), failed);
}

#[test]
fn a_scheme_with_a_stress_between_two_states_is_refused() {
    let scheme = Scheme::EnergyMomentum(EnergyMomentum {});
    for line in [
        Line::Bars,
        Line::Beams(Rotations::Small),
        Line::Beams(Rotations::Finite),
    ] {
        let refused = System::new(falling(line, 2, scheme, METAL)).map_err(Error::from);
        let message = refused
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default();
        let expected = Refusal::NoBetween { body: "a".into() };
        assert_eq!(message, expected.to_string());
    }
}
