//! The lines of the verdict, each on a run that an earlier verdict called wrongly.

use std::collections::BTreeMap;

use carom_case::{Built, Input, build, parse, run};
use carom_output::{Grade, Summary};

use carom_dynamics::Silent;

/// Columns of `histories.csv` by name.
pub type Histories = BTreeMap<String, Vec<f64>>;

/// Summary and histories of a case.
pub fn result(text: &str) -> (Summary, Histories) {
    result_with(text, "histories.csv")
}

/// Summary of a case, and a table of its results folder.
pub fn result_with(text: &str, table: &str) -> (Summary, Histories) {
    result_of(text, table, |_| {})
}

/// The same of a case that is changed after it was built.
pub fn result_of(text: &str, table: &str, change: impl FnOnce(&mut Built)) -> (Summary, Histories) {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let mut built = build(&case, &locator, &input).unwrap();
    change(&mut built);
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("results");
    let finished = run(
        (&input, &case, &built),
        folder.clone(),
        &mut Silent,
        &|| false,
    );
    let histories = std::fs::read_to_string(folder.join(table)).unwrap();
    let mut lines = histories.lines();
    let names = lines.next().unwrap().split(',').map(str::to_owned);
    let mut columns: Vec<(String, Vec<f64>)> = names.map(|name| (name, Vec::new())).collect();
    for line in lines {
        for ((_, values), cell) in columns.iter_mut().zip(line.split(',')) {
            // a gap of points that are far is not told
            let number = if cell.is_empty() {
                f64::NAN
            } else {
                cell.parse().unwrap()
            };
            values.push(number);
        }
    }
    (finished.unwrap().summary, columns.into_iter().collect())
}

fn grade(summary: &Summary, line: &str) -> Grade {
    summary.verdict.line(line).unwrap().grade
}

fn value(summary: &Summary, line: &str) -> f64 {
    summary.verdict.line(line).unwrap().value
}

/// A block of rubber that falls on a plane, under the trapezoid with the displacement law, which makes energy.
fn bouncing(body: &str, motion: &str, more: &str) -> Summary {
    let text = format!(
        r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.001], size = [1.0, 1.0], elements = [3, 3] }}
material.m = {{ density = 1000.0, neo-hooke = {{ young = 1e6, poisson = 0.3 }} }}
time = {{ end = 0.3, step = 1e-3, scheme.newmark = {{}} }}
[body.a]
region = "a"
material = "m"
section.plane-strain.thickness = 1.0
initial.velocity = [0.0, -1.0]
{body}
[contact.c]
secondary = "a.bottom"
obstacle.plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0]{motion} }}
law.displacement = {{}}
{more}
"#
    );
    result(&text).0
}

#[test]
fn energy_that_contact_makes_is_bad_whatever_moves_or_damps() {
    let far = r#"
[contact.far]
secondary = "a.top"
obstacle.sphere = { centre = [0.0, 1e3], radius = 1.0, motion.velocity = [1.0, 0.0] }
law.displacement = {}
"#;
    for (name, summary) in [
        ("nothing moves", bouncing("", "", "")),
        (
            "a motion of zero",
            bouncing("", ", motion.velocity = [0.0, 0.0]", ""),
        ),
        ("an obstacle far away", bouncing("", "", far)),
        (
            "damped away in the end",
            bouncing("damping.mass = 30.0", "", ""),
        ),
    ] {
        assert_eq!(summary.verdict.grade, Grade::Bad, "{name}");
        assert_eq!(grade(&summary, "energy-gain"), Grade::Bad, "{name}");
        assert_eq!(grade(&summary, "contact-work"), Grade::Bad, "{name}");
        // the equations are solved: no residual shows it
        assert_eq!(grade(&summary, "energy-residual"), Grade::Good, "{name}");
    }
    let damped = bouncing("damping.mass = 30.0", "", "");
    let energy = &damped.energy;
    assert!(energy.kinetic_final + energy.strain_final < energy.kinetic_initial);
}

/// A bar of 1 kg, c = 1 m/s, that a plane pushes from rest.
fn pushed(motion: &str) -> (Summary, Histories) {
    let text = format!(
        r#"
carom = 1
mesh.generate.bar.line = {{ from = [0.0], to = [1.0], elements = 20 }}
material.m = {{ density = 1.0, elastic = {{ young = 1.0, poisson = 0.0 }} }}
body.bar = {{ region = "bar", material = "m", section.bar.area = 1.0 }}
time = {{ end = 1.5, step = 0.01, scheme.theta = {{}} }}
[contact.push]
secondary = "bar.left"
obstacle.plane = {{ point = [-0.005], normal = [1.0], motion = {motion} }}
law.velocity = {{}}
"#
    );
    result(&text)
}

#[test]
fn the_work_of_a_moving_obstacle_is_force_times_its_motion() {
    // at a constant speed V: V times the momentum that the bar gets
    let speed = 0.01;
    let (summary, _) = pushed("{ velocity = [0.01] }");
    let work = summary.energy.works["obstacles"];
    let momentum = summary.momentum.r#final[0];
    assert!(momentum > 0.0);
    // sums of some hundred terms: rounding
    assert!(
        (work / (speed * momentum) - 1.0).abs() < 1e-12,
        "{work} {momentum}"
    );
    assert!(summary.energy.works["contact"] <= 0.0);
    assert_eq!(summary.verdict.grade, Grade::Good, "{:?}", summary.verdict);

    // along a table whose bends are within steps: the force of each step times the way in it
    let table = "[{ time = 0.0, displacement = [0.0] }, { time = 0.803, displacement = [0.00803] }, { time = 1.5, displacement = [0.0289] }]";
    let (summary, histories) = pushed(&format!("{{ displacement = {table} }}"));
    let times = &histories["time_s"];
    let place = |t: f64| match t < 0.803 {
        true => 0.01 * t,
        false => 0.00803 + (t - 0.803) * (0.0289 - 0.00803) / (1.5 - 0.803),
    };
    let force = &histories["contact.push.force_n"];
    let steps = 1..times.len();
    let expected: f64 = steps
        .map(|k| force[k] * (place(times[k]) - place(times[k - 1])))
        .sum();
    let work = summary.energy.works["obstacles"];
    assert!((work / expected - 1.0).abs() < 1e-12, "{work} {expected}");
}

#[test]
fn a_penetration_deeper_than_an_element_is_bad() {
    let (summary, _) = result(
        r#"
carom = 1
mesh.generate.a.rectangle = { origin = [0.0, 4.0], size = [1.0, 1.0], elements = [4, 4] }
mesh.generate.b.rectangle = { origin = [-1.0, 0.0], size = [3.0, 0.1], elements = [12, 1] }
material.m = { density = 1000.0, neo-hooke = { young = 1e6, poisson = 0.3 } }
body.a = { region = "a", material = "m", section.plane-strain.thickness = 1.0 }
body.b = { region = "b", material = "m", section.plane-strain.thickness = 1.0 }
support.s = { on = "b", fix = ["x", "y"] }
load.g.acceleration = [0.0, -1000.0]
time = { end = 0.12, step = 2e-3, scheme.theta.theta = 0.6, newton.halvings = 0 }
[contact.c]
secondary = "a.bottom"
primary = "b.top"
law.velocity = {}
sliding = "finite"
"#,
    );
    // the plate is one element of 0.1 m
    let depth = summary.contacts["c"].max_penetration / 0.1;
    assert!((value(&summary, "penetration") / depth - 1.0).abs() < 1e-12);
    assert_eq!(grade(&summary, "penetration"), Grade::Bad, "{depth}");
}

/// Two bodies, one above the other, of which the upper one comes down with 20 m/s, from 0.1 m between their middles.
fn crossing(bodies: &str, contact: &str, step: &str) -> Summary {
    let text = format!(
        r#"
carom = 1
{bodies}
material.m = {{ density = 7800.0, elastic = {{ young = "210 GPa", poisson = 0.3 }} }}
{contact}
time = {{ end = "12 ms", step = "{step}", scheme.theta = {{}} }}
"#
    );
    result(&text).0
}

/// A step of 80 mm carries the bodies to the other side. Of nonlinear models it is cut, and they meet; of linear ones nothing but the crossing tells of it.
#[test]
fn bodies_that_would_pass_each_other_within_a_step_meet_or_are_bad() {
    let beams = r#"
mesh.generate.a.line = { from = [0.0, 0.0], to = [1.0, 0.0], elements = 8 }
mesh.generate.b.line = { from = [0.1, 0.1], to = [0.9, 0.1], elements = 5 }
body.a = { region = "a", material = "m", section.beam.shape.circle.diameter = "2 cm" }
body.b = { region = "b", material = "m", section.beam.shape.circle.diameter = "2 cm", initial.velocity = [0.0, -20.0] }
"#;
    let plates = r#"
mesh.generate.a.rectangle = { origin = [0.0, 0.0], size = [1.0, 0.02], elements = [50, 2] }
mesh.generate.b.rectangle = { origin = [0.1, 0.1], size = [0.8, 0.02], elements = [40, 2] }
body.a = { region = "a", material = "m", section.plane-strain.thickness = 1.0 }
body.b = { region = "b", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [0.0, -20.0] }
"#;
    let both = |more: &str| {
        format!(
            r#"contact.both = {{ secondary = "b", primary = "a", {more}, law.velocity = {{}} }}"#
        )
    };
    let [mortar, nodes] = ["integration = \"mortar\"", "sliding = \"finite\""].map(both);
    let all = "general-contact = { law.velocity = {} }";
    for (bodies, contact) in [(beams, &*mortar), (beams, &*nodes), (plates, all)] {
        let summary = crossing(bodies, contact, "4 ms");
        let impulses = |summary: &Summary| -> f64 {
            let contacts = summary.contacts.values();
            contacts.filter_map(|contact| contact.impulse).sum()
        };
        let is_cut = summary.time.rejected.passage > 0;
        // mortar integrals that follow the bodies make their model nonlinear
        assert_eq!(is_cut, contact == mortar, "{contact}");
        assert_eq!(impulses(&summary) > 0.0, is_cut, "{contact}");
        if !is_cut {
            // the middles are 0.1 m apart at the start, and 0.02 m where surfaces touch
            assert_eq!(grade(&summary, "passing"), Grade::Bad);
        }
        let summary = crossing(bodies, contact, "0.25 ms");
        assert!(impulses(&summary) > 0.0);
        assert_eq!(grade(&summary, "passing"), Grade::Good);
    }
}

/// One free bar of 24 m that a push of 120 us at its end sets in motion, at `critical` of the critical step. Only with a load in
/// time is the run not linear.
fn pulse(critical: f64) -> Summary {
    let text = format!(
        r#"
carom = 1
mesh.generate.bar.line = {{ from = [0.0], to = [24.0], elements = 240 }}
material.steel = {{ density = 7800.0, elastic = {{ young = "210 GPa", poisson = 0.0 }} }}
body.bar = {{ region = "bar", material = "steel", section.bar.area = "6.45 cm^2" }}
time = {{ end = "2.6 ms", step.critical = {critical}, scheme.central-difference = {{}} }}
[load.pulse]
on = "bar.left"
traction = [40.47e6]
amplitude = [{{ time = 0.0, factor = 0.0 }}, {{ time = 6e-5, factor = 1.0 }}, {{ time = 1.2e-4, factor = 0.0 }}]
"#
    );
    result(&text).0
}

#[test]
fn central_difference_is_judged_by_the_energy_that_it_balances() {
    let summary = pulse(0.9);
    // its energy K + U - dt²/8 |a|² changes by the work of the load alone, to rounding
    assert!(value(&summary, "energy-gain") < 1e-12);
    assert!(summary.energy.dissipations["scheme"].abs() < 1e-12 * summary.energy.works["loads"]);
    // that of motion and strain is above it by more than any gain that passes, and swings back
    assert!(value(&summary, "scheme-energy") > 0.01);
    assert_eq!(summary.verdict.grade, Grade::Good, "{:?}", summary.verdict);
    // the term is of second order in the step
    let ratio = value(&summary, "scheme-energy") / value(&pulse(0.225), "scheme-energy");
    assert!((8.0..32.0).contains(&ratio), "{ratio}");
}

#[test]
fn residuals_are_judged_by_the_tolerance_that_was_asked_for() {
    let with = |tolerance: f64| {
        let text = format!(
            r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.0], size = [1.0, 1.0], elements = [4, 4] }}
material.m = {{ density = 1000.0, neo-hooke = {{ young = 1e6, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 1.0 }}
support.s = {{ on = "a.bottom", fix = ["x", "y"] }}
load.push = {{ on = "a.right", traction = [-1e5, 0.0] }}
time = {{ end = 0.4, step = 4e-3, scheme.theta = {{}}, newton.tolerance = {tolerance} }}
"#
        );
        result(&text).0
    };
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let summary = with(tolerance);
        let line = summary.verdict.line("energy-residual").unwrap();
        let (bound, largest) = (line.bad.unwrap(), line.value);
        assert!(largest <= bound, "{tolerance}: {largest} {bound}");
        // an unbalanced force of relative size tol does at most tol times the work of the forces in a step: of the order of
        // tol times the energy, a hundred times
        assert!(
            (tolerance..1e4 * tolerance).contains(&bound),
            "{tolerance}: {bound}"
        );
        assert_eq!(summary.verdict.grade, Grade::Good, "{:?}", summary.verdict);
    }
    // more than a rounding bound would take
    assert!(value(&with(1e-6), "energy-residual") > 1e-9);
}

/// Two equal bars of 60 elements under a scheme and a law, beside their exact solution.
fn bars(scheme: &str, law: &str) -> Summary {
    let text = format!(
        r#"
carom = 1
mesh.generate.one.line = {{ from = ["-254 mm"], to = [0.0], elements = 60 }}
mesh.generate.two.line = {{ from = [0.0], to = ["254 mm"], elements = 60 }}
material.steel = {{ density = 7844.0, elastic = {{ young = "207 GPa", poisson = 0.0 }} }}
body.one = {{ region = "one", material = "steel", section.bar.area = "645 mm^2", initial.velocity = [5.1359] }}
body.two = {{ region = "two", material = "steel", section.bar.area = "645 mm^2" }}
contact.shock = {{ secondary = "one.right", primary = "two.left", law.{law} }}
time = {{ end = "150 us", step.courant = 0.5, scheme.{scheme} }}
reference.two-bars = {{}}
"#
    );
    result(&text).0
}

#[test]
fn a_contact_that_switches_on_and_off_is_bad_and_so_is_a_force_that_is_not_the_exact_one() {
    let sound = bars("theta = {}", "velocity = {}");
    // closed once, opened once
    assert_eq!(value(&sound, "chatter"), 2.0);
    assert_eq!(sound.verdict.grade, Grade::Good, "{:?}", sound.verdict);
    for (scheme, law) in [
        ("newmark = {}", "velocity = {}"),
        ("theta = {}", "displacement = {}"),
        ("laursen-chawla = {}", "velocity = {}"),
        ("laursen-love = {}", "displacement = {}"),
    ] {
        let summary = bars(scheme, law);
        assert!(
            summary.exact.as_ref().unwrap().force_error.unwrap() > 0.5,
            "{scheme} {law}"
        );
        for line in ["chatter", "force-error"] {
            assert_eq!(grade(&summary, line), Grade::Bad, "{scheme} {law} {line}");
        }
        // and yet every balance closes
        assert_eq!(grade(&summary, "energy-residual"), Grade::Good);
        assert_eq!(grade(&summary, "energy-gain"), Grade::Good);
    }
}

/// A bar of 60 elements that hits a rigid plane.
fn on_wall(scheme: &str, law: &str) -> (Summary, Histories) {
    let text = format!(
        r#"
carom = 1
mesh.generate.bar.line = {{ from = [0.0], to = ["254 mm"], elements = 60 }}
material.steel = {{ density = 7844.0, elastic = {{ young = "207 GPa", poisson = 0.0 }} }}
body.bar = {{ region = "bar", material = "steel", section.bar.area = "645 mm^2", initial.velocity = [-5.1359] }}
contact.wall = {{ secondary = "bar.left", obstacle.plane = {{ point = [0.0], normal = [1.0] }}, law.{law} }}
time = {{ end = "150 us", step.courant = 0.5, scheme.{scheme} }}
"#
    );
    result(&text)
}

#[test]
fn forces_times_step_and_what_is_in_no_force_are_the_momentum() {
    let projection = "displacement = { projection = true }";
    for (scheme, law, has) in [
        ("newmark = {}", projection, true),
        ("newmark = { beta = 0.49, gamma = 0.9 }", projection, true),
        ("laursen-love = {}", "displacement = {}", true),
        ("theta = {}", "velocity = {}", false),
        ("central-difference = {}", "velocity = {}", false),
    ] {
        let (summary, histories) = on_wall(scheme, law);
        let times = &histories["time_s"];
        let force = &histories["contact.wall.force_n"];
        let steps = 1..times.len();
        let forces: f64 = steps.map(|k| force[k] * (times[k] - times[k - 1])).sum();
        let column = histories.get("contact.wall.impulsive_n_s");
        assert_eq!(column.is_some(), has, "{scheme}");
        let impulsive = column.map_or(0.0, |column| column.iter().sum::<f64>());
        // M v of the bar, which knows of no force
        let momentum = summary.momentum.r#final[0] - summary.momentum.initial[0];
        let contact = &summary.contacts["wall"];
        // sums of some thousand terms: rounding
        let near = |a: f64, b: f64| (a - b).abs() < 1e-11 * momentum;
        assert!(near(forces + impulsive, momentum), "{scheme} {law}");
        assert!(near(contact.impulse.unwrap(), momentum), "{scheme} {law}");
        assert!(near(contact.impulsive, impulsive), "{scheme} {law}");
        assert_eq!(impulsive.abs() > 1e-4 * momentum, has, "{scheme} {law}");
    }
}

#[test]
fn friction_loses_energy_and_what_is_lost_is_positive() {
    // 1 kg on a spring of 1e4 N/m, friction 0.1 under 10 N, let go at 0.85 mm: it turns at 0.65, 0.45, 0.25 and sticks at 0.05 mm,
    // each way shorter by 2 mu N / k = 0.2 mm. 1 N over 3.2 mm
    let (summary, histories) = result(
        r#"
carom = 1
mesh.generate.spring.line = { from = [0.0, 0.0], to = [1.0, 0.0], elements = 1 }
material.spring = { density = 2.0, elastic = { young = 1.0e4, poisson = 0.0 } }
body.spring = { region = "spring", material = "spring", section.bar.area = 1.0 }
load.weight.acceleration = [0.0, -10.0]
time = { end = 0.18, step = 1.0e-4, scheme.theta = {} }
probe.mass = { on = "spring.right", record = ["displacement"] }
[support.left]
on = "spring.left"
fix = ["y"]
move = { x = [{ time = 0.0, displacement = -0.85e-3 }] }
[contact.floor]
secondary = "spring.right"
obstacle.plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }
friction.coulomb = 0.1
law.velocity = {}
"#,
    );
    let way = &histories["probe.mass.displacement_x_m"];
    let slid: f64 = way.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    let lost = summary.energy.dissipations["friction"];
    // 1 N over the way, but for the steps in which it turns
    assert!(
        lost > 0.0 && (lost / slid - 1.0).abs() < 1e-3,
        "{lost} {slid}"
    );
    assert_eq!(*histories["dissipation.friction_j"].last().unwrap(), lost);
}

#[test]
fn a_run_with_deleted_cells_says_that_it_cannot_tell_what_breaks_and_one_without_does_not() {
    let run = |speed: f64| {
        let text = format!(
            r#"
carom = 1
mesh.generate.bar.box = {{ origin = [0.0, 0.0, 0.0], size = [0.1, 0.1, 0.4], elements = [1, 1, 4] }}
material.steel = {{ density = 7800.0, j2 = {{ young = "200 GPa", poisson = 0.3, yield-stress = "400 MPa", hardening = "1 GPa" }} }}
[body.bar]
region = "bar"
material = "steel"
formulation.reduced = {{}}
deletion.plastic-strain = 0.05
initial.velocity = [0.0, 0.0, -{speed:?}]
[contact.wall]
secondary = "bar.bottom"
obstacle.plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
law.velocity = {{}}
[time]
end = "3 ms"
step.critical = 0.5
scheme.central-difference = {{}}
"#
        );
        result(&text).0.verdict.unchecked
    };
    let says = |unchecked: &[String]| {
        let says = |what: &str| unchecked.iter().any(|why| why.contains(what));
        ["of 4 cells were deleted", "whose cells are all deleted"].map(says)
    };
    // at 1 m/s nothing yields: ρ c v is a tenth of the yield stress
    assert_eq!(says(&run(1.0)), [false; 2]);
    assert_eq!(says(&run(200.0)), [true; 2]);
}
