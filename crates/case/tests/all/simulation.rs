//! Runs whose steps a program takes, and forces that it sets between them.

use std::fs;

use carom_case::{AddedForce, Failed, Input, Resume, Simulation, build, build_with, parse, run};
use carom_dynamics::{Held, Silent};

const BARS: &str = r#"
carom = 1
[mesh]
generate.striker.line = { from = [-0.2], to = [0.0], elements = 8 }
generate.target.line = { from = [0.0], to = [0.2], elements = 8 }
[material.steel]
density = 7800.0
elastic = { young = "210 GPa", poisson = 0.0 }
[body.striker]
region = "striker"
material = "steel"
section.bar = { area = "100 mm^2" }
initial = { velocity = [1.0] }
[body.target]
region = "target"
material = "steel"
section.bar = { area = "100 mm^2" }
[contact.shock]
secondary = "striker.right"
primary = "target.left"
law.displacement = {}
[time]
end = "50 us"
step = "1 us"
scheme.newmark = {}
"#;

/// An oscillator of 1 kg and 100 N/m.
const OSCILLATOR: &str = r#"
carom = 1
mass.weight = { mass = 1.0, at = [0.0] }
spring.spring = { ends = ["weight", "ground"], axis = [1.0], stiffness = 100.0 }
time = { end = 1.0, step = 1e-3, scheme.newmark = {} }
"#;

fn simulation(text: &str, forces: &[AddedForce], folder: Option<&std::path::Path>) -> Simulation {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let built = build_with(&case, &locator, &input, forces).unwrap();
    Simulation::new((&input, &case, built), forces, folder.map(Into::into)).unwrap()
}

fn force(on: &str, size: &Held) -> AddedForce {
    AddedForce {
        name: "push".to_owned(),
        on: on.to_owned(),
        direction: vec![1.0],
        size: size.clone(),
    }
}

#[test]
fn steps_taken_one_by_one_leave_the_folder_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let [one, other] = ["run", "steps"].map(|name| folder.path().join(name));
    let input = Input::from_text("case.toml", BARS, &[]);
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    run((&input, &case, &built), one.clone(), &mut Silent, &|| false).unwrap();
    let mut steps = simulation(BARS, &[], Some(&other));
    while !steps.is_done() {
        steps.step().unwrap();
    }
    let finished = steps.finish(None).unwrap().unwrap();
    assert!(!finished.interrupted);
    for name in ["histories.csv", "impacts.csv", "case.toml"] {
        let [one, other] = [&one, &other].map(|folder| fs::read(folder.join(name)).unwrap());
        assert_eq!(one, other, "{name}");
    }
}

#[test]
fn a_saved_simulation_goes_on_with_the_same_bits() {
    let mut simulation = simulation(BARS, &[], None);
    let steps = |simulation: &mut Simulation| {
        (0..20).for_each(|_| simulation.step().unwrap());
        simulation.run().state().motion.u.clone()
    };
    steps(&mut simulation);
    let saved = simulation.saved().unwrap();
    let first = steps(&mut simulation);
    simulation.restore(&saved).unwrap();
    assert_eq!(first, steps(&mut simulation));
    assert!(matches!(
        simulation.restore(&saved[..9]),
        Err(Failed::Start(_))
    ));
    let folder = tempfile::tempdir().unwrap();
    let mut written = self::simulation(BARS, &[], Some(&folder.path().join("a")));
    assert!(written.restore(&saved).is_err());
}

/// A force of 5 N on an oscillator at rest: its energy is the work of the force, and its place swings about 5 N over the stiffness up to
/// twice that.
#[test]
fn a_force_set_between_the_steps_does_its_work() {
    let size = Held::new();
    let mut simulation = simulation(OSCILLATOR, &[force("weight", &size)], None);
    size.set(5.0);
    let mut largest = 0.0_f64;
    while !simulation.is_done() {
        simulation.step().unwrap();
        largest = largest.max(simulation.run().state().motion.u[0]);
    }
    // the force stands at the end of the first step only, half a step late: (ω dt/2)² and the period error are below 1e-4
    assert!((largest / 0.1 - 1.0).abs() < 1e-4, "{largest}");
    let ledger = &simulation.run().state().ledger;
    let residual = ledger.balance.energy_residual.abs();
    assert!(residual < 1e-9 * ledger.largest_energy, "{residual}");
}

#[test]
fn forces_that_do_not_fit_are_refused() {
    let input = Input::from_text("case.toml", BARS, &[]);
    let (case, locator) = parse(&input).unwrap();
    let refused = |force: AddedForce| {
        let problems = build_with(&case, &locator, &input, &[force]).unwrap_err();
        problems[0].message.clone()
    };
    let size = Held::new();
    assert_eq!(
        refused(force("nowhere", &size)),
        "no group of this name in the mesh"
    );
    let plane = AddedForce {
        direction: vec![1.0, 0.0],
        ..force("striker.left", &size)
    };
    assert_eq!(refused(plane), "not a direction in the space of the mesh");
}

/// A run with forces of a program cannot go on without it.
#[test]
fn a_checkpoint_names_the_forces_of_a_program() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pushed");
    let size = Held::new();
    let mut pushed = simulation(BARS, &[force("striker.left", &size)], Some(&path));
    pushed.step().unwrap();
    assert!(pushed.finish(None).unwrap().unwrap().interrupted);
    assert!(Resume::open(&path, &[]).is_err());
    let path = folder.path().join("free");
    let mut free = simulation(BARS, &[], Some(&path));
    free.step().unwrap();
    free.finish(None).unwrap();
    assert!(Resume::open(&path, &[]).is_ok());
}
