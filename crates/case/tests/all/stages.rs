//! Static stages before the dynamics.

use carom_case::{Input, build, parse};

use crate::verdict::result;

/// A bar in a static stage up to 1 s, then in steps up to 1.00001 s.
fn bar(step: &str) -> String {
    format!(
        r#"
carom = 1
mesh.generate.bar.line = {{ from = [0.0], to = ["10 mm"], elements = 2 }}
material.m = {{ density = 7800.0, elastic = {{ young = "210 GPa", poisson = 0.0 }} }}
body.bar = {{ region = "bar", material = "m", section.bar.area = "1 mm^2" }}
support.left = {{ on = "bar.left", fix = ["x"] }}
load.pull = {{ on = "bar.right", force = ["100 N"] }}
time = {{ end = 1.00001, step = "{step}", static = {{ end = 1.0, steps = 1 }}, scheme.newmark = {{}} }}
"#
    )
}

#[test]
fn the_steps_of_a_run_are_those_after_its_static_stage() {
    let checked = |step: &str| {
        let input = Input::from_text("case.toml", &bar(step), &[]);
        let (case, locator) = parse(&input).unwrap();
        build(&case, &locator, &input)
    };
    // 10 us in steps of 0.1 ns, not 1.00001 s
    let built = checked("1e-10 s").unwrap();
    let facts = carom_case::facts(&built);
    let time = facts.iter().find(|fact| fact.name == "time").unwrap();
    assert!(
        time.value.contains("100000 steps of 1.000000e-10 s"),
        "{}",
        time.value
    );
    let problems = checked("1e-15 s").unwrap_err();
    let found = problems[0].found.as_deref().unwrap();
    assert_eq!(found, "1.000e10 steps of 1.000e-15 s");

    // the sizes that the summary tells, by which studies order their runs, are those of the dynamics
    let (summary, _) = result(&bar("1 us"));
    let time = &summary.time;
    assert_eq!(time.steps, 11);
    for size in [time.smallest_step, time.largest_step] {
        assert!((size / 1e-6 - 1.0).abs() < 1e-12, "{size}");
    }
}

/// Steps that are a fraction of the critical one grow by a rung at a time from that of the step before, but not from those of a static stage,
/// which may be of any size.
#[test]
fn explicit_steps_begin_at_their_own_size_after_short_static_steps() {
    let block = |end: f64| {
        let text = format!(
            r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.0], size = [1.0, 1.0], elements = [2, 2] }}
material.m = {{ density = 7800.0, elastic = {{ young = "200 GPa", poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 1.0 }}
support.f = {{ on = "a.bottom", fix = ["x", "y"] }}
load.g.acceleration = [0.0, -9.81]
time = {{ end = {:?}, static = {{ end = {end:?}, steps = 10 }}, step.critical = 0.8, scheme.central-difference = {{}} }}
"#,
            end + 1.5e-3
        );
        result(&text).0
    };
    let [short, long] = [1e-6, 1.0].map(block);
    // loads do not know how long the stage is: the same equilibrium, and the same steps to the rounding of their instants
    assert_eq!(short.time.steps, long.time.steps);
    let sizes = |of: &carom_output::Summary| [of.time.smallest_step, of.time.largest_step];
    assert_eq!(sizes(&short), sizes(&long));
    let energies = [&short, &long].map(|of| of.energy.strain_final);
    assert!(
        (energies[0] / energies[1] - 1.0).abs() < 1e-9,
        "{energies:?}"
    );
}

/// A hammer that nothing holds along its way waits for the dynamics: no load moves it, and only its stop is ahead. It has no stiffness at all.
#[test]
fn a_mass_before_a_stop_waits_for_the_dynamics() {
    let (summary, histories) = result(
        r#"
carom = 1
mesh.generate.b.line = { from = [0.0], to = [1.0], elements = 4 }
material.m = { density = 1000.0, elastic = { young = 1e9, poisson = 0.0 } }
body.b = { region = "b", material = "m", section.bar.area = 1e-4 }
support.s = { on = "b.right", fix = ["x"] }
load.f = { on = "b.left", force = [-10.0] }
mass.hammer = { mass = 0.2, at = [-0.001], initial.velocity = [3.0] }
stop.hit = { ends = ["hammer", "b.left"], axis = [1.0], gap = "1 mm", stiffness = 5e7 }
probe.h = { on = "hammer", record = ["displacement", "velocity"] }
time = { end = 1.0005, step = 1e-6, static = { end = 1.0, steps = 1 }, scheme.theta.theta = 0.55 }
"#,
    );
    let (times, way) = (&histories["time_s"], &histories["probe.h.displacement_x_m"]);
    let at = times.iter().position(|time| *time >= 1.0).unwrap();
    assert_eq!(way[at], 0.0);
    let speed = histories["probe.h.velocity_x_m_s"][at + 1];
    assert!((speed / 3.0 - 1.0).abs() < 1e-12, "{speed}");
    // F L/(E A) = 0.1 mm of the gap are gone: 0.9 mm at 3 m/s, to a step
    let closing = summary.contacts["hit"].first_closing.unwrap();
    assert!((closing - 1.0003).abs() < 2e-6, "{closing}");
}

/// A ram above a bar that is pulled in the stage: its weight would let it fall, and nothing else holds it.
fn ram(body: &str) -> String {
    format!(
        r#"
carom = 1
mesh.generate.post.rectangle = {{ origin = [0.0, 0.0], size = [0.1, 0.1], elements = [2, 2] }}
mesh.generate.ram.rectangle = {{ origin = [0.0, 0.1001], size = [0.1, 0.1], elements = [2, 2] }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e8, poisson = 0.0 }} }}
body.post = {{ region = "post", material = "m", section.plane-strain.thickness = 0.1 }}
body.ram = {{ region = "ram", material = "m", section.plane-strain.thickness = 0.1, initial.velocity = [0.0, -1.0]{body} }}
support.foot = {{ on = "post.bottom", fix = ["x", "y"] }}
load.g.acceleration = [0.0, -10.0]
contact.c = {{ secondary = "ram.bottom", primary = "post.top", law.velocity = {{}} }}
probe.r = {{ on = "ram.top", record = ["displacement", "velocity"] }}
time = {{ end = 1.0004, step = 1e-6, static = {{ end = 1.0, steps = 2 }}, scheme.theta.theta = 0.6 }}
"#
    )
}

#[test]
fn a_body_that_is_held_waits_for_the_dynamics_and_is_free_then() {
    for body in [", hold = true", ", hold = true, rigid = {}"] {
        let (summary, histories) = result(&ram(body));
        let (times, way) = (&histories["time_s"], &histories["probe.r.displacement_y_m"]);
        let at = times.iter().position(|time| *time >= 1.0).unwrap();
        // held as by a support; nodes of a rigid body are placed from its centre, to rounding
        assert!(way[at].abs() < 1e-15, "{body}: {:e}", way[at]);
        // 0.1 mm and what the post has sunk, g ρ h²/(2 E) = 0.5 um, at 1 m/s; gravity adds g t²/2 = 0.05 um; to two steps
        let closing = summary.contacts["c"].first_closing.unwrap();
        assert!((closing - 1.0001005).abs() < 2e-6, "{closing}");
    }
    // without the word it would fall on the post in the stage: a static equilibrium
    let (summary, _) = result(&ram(""));
    let closing = summary.contacts["c"].first_closing.unwrap();
    assert!(closing <= 1.0, "{closing}");
}

/// What held the body in the stage pushes no longer in the dynamics: its weight is all that moves it, v = -g t, and the balances close.
#[test]
fn a_body_that_was_held_under_its_weight_falls_freely() {
    let (summary, histories) = result(
        r#"
carom = 1
mesh.generate.a.rectangle = { origin = [40.0, 30.0], size = [2.0, 1.0], elements = [2, 1] }
material.m = { density = 1000.0, elastic = { young = 1e7, poisson = 0.0 } }
body.a = { region = "a", material = "m", section.plane-strain.thickness = 1.0, hold = true }
load.weight.acceleration = [0.0, -9.81]
probe.a = { on = "a", record = ["velocity"] }
time = { end = 1.01, step = 1e-4, static = { end = 1.0, steps = 2 }, scheme.theta.theta = 0.55 }
"#,
    );
    let speed = *histories["probe.a.velocity_y_m_s"].last().unwrap();
    assert!((speed / -0.0981 - 1.0).abs() < 1e-10, "{speed}");
    let impulses = &summary.momentum.impulses;
    // m g t of 2000 kg over 10 ms; nothing holds it
    assert!((impulses["loads"][1] / -196.2 - 1.0).abs() < 1e-10);
    assert!(impulses.get("supports").is_none_or(|p| p[1].abs() < 1e-7));
    assert!(
        summary.momentum.relative_residual < 1e-9,
        "{:e}",
        summary.momentum.relative_residual
    );
    assert_eq!(summary.verdict.grade, carom_output::Grade::Good);
}

#[test]
fn a_body_that_is_held_without_a_static_stage_is_refused() {
    let text = ram(", hold = true").replace("static = { end = 1.0, steps = 2 }, ", "");
    let input = Input::from_text("case.toml", &text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let problems = build(&case, &locator, &input).err().unwrap();
    assert!(
        problems[0].message.contains("the case has none"),
        "{}",
        problems[0].message
    );
}

/// Two cubes of one cell, the upper one on the lower one, in one set: a body of two pieces.
const CUBES: &str = "*NODE, NSET=NALL
1,0.,0.,0.\n2,2.,0.,0.\n3,2.,2.,0.\n4,0.,2.,0.\n5,0.,0.,2.\n6,2.,0.,2.\n7,2.,2.,2.\n8,0.,2.,2.
11,0.5,0.5,2.\n12,1.5,0.5,2.\n13,1.5,1.5,2.\n14,0.5,1.5,2.\n15,0.5,0.5,3.\n16,1.5,0.5,3.\n17,1.5,1.5,3.\n18,0.5,1.5,3.
*ELEMENT, TYPE=C3D8, ELSET=LOW\n1,1,2,3,4,5,6,7,8
*ELEMENT, TYPE=C3D8, ELSET=HIGH\n2,11,12,13,14,15,16,17,18
*ELSET, ELSET=ALL\nLOW,HIGH
*NSET, NSET=FLOOR\n1,2,3,4
*NSET, NSET=RAIL\n15,16,17,18
*SURFACE, NAME=LOWTOP\n1,S2
*SURFACE, NAME=HIGHFOOT\n2,S1
*SURFACE, NAME=HIGHTOP\n2,S2
";

#[test]
fn a_body_of_pieces_that_a_contact_joins_is_in_equilibrium_as_two_bodies_are() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cubes.inp"), CUBES).unwrap();
    let text = r#"
carom = 1
mesh = { file = "cubes.inp", unit = "mm" }
material.steel = { density = 7800.0, elastic = { young = "210 GPa", poisson = 0.0 } }
body.all = { region = "ALL", material = "steel" }
support.floor = { on = "FLOOR", fix = ["x", "y", "z"] }
support.rail = { on = "RAIL", fix = ["x", "y"] }
load.p = { on = "HIGHTOP", pressure = "100 MPa" }
contact.c = { secondary = "HIGHFOOT", primary = "LOWTOP", law.displacement = {} }
time = { end = 1.0, static = { end = 1.0, steps = 2 } }
"#;
    let file = folder.path().join("case.toml");
    std::fs::write(&file, text).unwrap();
    let input = Input::read(&file, &[]).unwrap();
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    assert!(built.warnings.is_empty(), "{:?}", built.warnings);
    let facts = carom_case::facts(&built);
    let model = facts.iter().find(|fact| fact.name == "model").unwrap();
    assert!(model.value.contains("2 connected parts"), "{}", model.value);
    let finished = carom_case::run(
        (&input, &case, &built),
        folder.path().join("results"),
        &mut carom_dynamics::Silent,
        &|| false,
    );
    // 100 MPa on 1 mm²; the tolerance of the iterations is 1e-10
    let force = finished.unwrap().summary.contacts["c"].peak_force;
    assert!((force / 100.0 - 1.0).abs() < 1e-8, "{force}");
}

/// A block is pressed on a rough plane with N, then its top is drawn by d. It slides all the way but for its shear of 1e-4 d: the friction force is μ N,
/// and it takes μ N d less at most the way of one step, in whose course it rises. Contact and balance count the same work, which is what the support
/// gave: what shear stores is 1e-4 of it.
#[test]
fn friction_of_a_static_stage_is_told() {
    let (n, mu, way, steps) = (1e3, 0.3, 10e-3, 20);
    let (summary, _) = result(&format!(
        r#"
carom = 1
mesh.generate.b.rectangle = {{ origin = [0.0, 0.0], size = [0.2, 0.05], elements = [2, 1] }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e9, poisson = 0.3 }} }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 0.1 }}
load.weight = {{ on = "b.top", traction = [0.0, {pressure:?}], amplitude = [{{ time = 0.0, factor = 0.0 }}, {{ time = 1.0, factor = 1.0 }}] }}
support.top.on = "b.top"
support.top.move.x = [{{ time = 0.0, displacement = 0.0 }}, {{ time = 1.0, displacement = 0.0 }}, {{ time = 2.0, displacement = {way:?} }}]
contact.foot = {{ secondary = "b.bottom", obstacle.plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}, law.displacement = {{}}, friction.coulomb = {mu:?} }}
time = {{ end = 2.0, static = {{ end = 2.0, steps = {steps} }} }}
"#,
        pressure = -n / (0.2 * 0.1),
    ));
    let friction = summary.contacts["foot"].friction.as_ref().unwrap();
    // equations are solved to 1e-10 of the forces
    assert!(
        (friction.peak_force / (mu * n) - 1.0).abs() < 1e-8,
        "{} N",
        friction.peak_force
    );
    let all = mu * n * way;
    let step = 2.0 * way / f64::from(steps);
    assert!(
        friction.loss <= all && friction.loss >= all - mu * n * step,
        "{} J of {all} J",
        friction.loss
    );
    let lost = summary.energy.dissipations["friction"];
    assert!(
        (friction.loss / lost - 1.0).abs() < 1e-9,
        "{} J, {lost} J",
        friction.loss
    );
    let resultant = summary.contacts["foot"].peak_resultant.as_ref().unwrap();
    let size = n * (1.0 + mu * mu).sqrt();
    assert!(
        (resultant.magnitude / size - 1.0).abs() < 1e-8,
        "{} N of {size} N",
        resultant.magnitude
    );
}
