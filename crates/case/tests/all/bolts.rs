//! Bolts that the static stage tightens.

use carom_case::{Input, build, parse};
use carom_output::Summary;

use crate::resume::compare;
use crate::verdict::{Histories, result};

/// F, N.
const PRELOAD: f64 = 20e3;

/// Stiffness of the bolt and of the joint between nodes, N/m.
const STIFFNESS: [f64; 2] = [5e8, 2e9];

/// A head on a joint that only pushes, with a bolt to the ground, pulled by P in N, which grows over 4 ms of the dynamics.
fn nodes(load: f64) -> String {
    let [bolt, joint] = STIFFNESS;
    format!(
        r#"
carom = 1
mass.head = {{ mass = 1.0, at = [0.1] }}
pretension.bolt = {{ force = {PRELOAD:?}, ends = ["ground", "head"], axis = [1.0], stiffness = {bolt:?} }}
stop.joint = {{ ends = ["ground", "head"], axis = [1.0], gap = 0.0, stiffness = {joint:?} }}
probe.head = {{ on = "head", record = ["displacement"] }}
[load.pull]
on = "head"
force = [{load:?}]
amplitude = [{{ time = 1.0, factor = 0.0 }}, {{ time = 1.004, factor = 1.0 }}]
[time]
static = {{ end = 1.0, steps = 2 }}
end = 1.006
step = "10 us"
scheme.theta.theta = 1.0
"#
    )
}

/// Two plates of 60 mm by 12 mm with 40 mm across, which are 0.1 of steel and have the stiffness of the bolt, and a beam from the foot of the one to the
/// face of the other. Nothing contracts across, so that the joint is a bar in compression. `load`: on the upper face, N.
fn plates(load: f64, bolt: &str) -> String {
    format!(
        r#"
carom = 1
mesh.generate.lower.rectangle = {{ origin = ["-30 mm", 0.0], size = ["60 mm", "12 mm"], elements = [6, 2] }}
mesh.generate.upper.rectangle = {{ origin = ["-30 mm", "12 mm"], size = ["60 mm", "12 mm"], elements = [6, 2] }}
mesh.generate.shank.line = {{ from = [0.0, 0.0], to = [0.0, "24 mm"], elements = 4 }}
material.steel = {{ density = "7850 kg/m^3", elastic = {{ young = "210 GPa", poisson = 0.0 }} }}
material.soft = {{ density = "7850 kg/m^3", elastic = {{ young = "10 GPa", poisson = 0.0 }} }}
body.lower = {{ region = "lower", material = "soft", section.plane-strain.thickness = "40 mm" }}
body.upper = {{ region = "upper", material = "soft", section.plane-strain.thickness = "40 mm" }}
body.bolt = {{ region = "shank", material = "steel", section.beam = {{ shape.circle.diameter = "12 mm", theory = "timoshenko" }} }}
support.base = {{ on = "lower.bottom", fix = ["x", "y"] }}
support.nut = {{ on = "shank.left", fix = ["x", "y", "rz"] }}
transition.head = {{ end = "shank.right", face = "upper.top" }}
contact.joint = {{ secondary = "upper.bottom", primary = "lower.top", law.velocity = {{}} }}
pretension.bolt = {{ force = {PRELOAD:?}, {bolt} }}
[load.pull]
on = "upper.top"
traction = [0.0, {:?}]
amplitude = [{{ time = 1.0, factor = 0.0 }}, {{ time = 1.002, factor = 1.0 }}]
[time]
static = {{ end = 1.0, steps = 2 }}
end = 1.003
step = "10 us"
scheme.theta.theta = 1.0
"#,
        load / (0.06 * 0.04)
    )
}

/// Force of a bolt and of the joint under a load P: both share it as their stiffnesses as long as the joint is closed, and the bolt bears all of it when it
/// is open.
fn shared(load: f64, [bolt, joint]: [f64; 2]) -> [f64; 2] {
    let share = load * bolt / (bolt + joint);
    match PRELOAD + share > load {
        true => [PRELOAD + share, PRELOAD + share - load],
        false => [load, 0.0],
    }
}

/// The last rows of the forces of bolt and joint.
fn last(histories: &Histories, [bolt, joint]: [&str; 2]) -> [f64; 2] {
    [bolt, joint].map(|name| *histories[name].last().unwrap())
}

fn preload(summary: &Summary, name: &str) -> f64 {
    summary.pretensions[name].end_of_stage.unwrap()
}

#[test]
fn a_bolt_between_nodes_follows_the_joint_diagram() {
    for load in [0.0, 10e3, 24e3, 40e3] {
        let (summary, histories) = result(&nodes(load));
        // prescribed in the stage, to the tolerance of the equilibrium
        let start = preload(&summary, "bolt");
        assert!((start / PRELOAD - 1.0).abs() < 1e-9, "{start}");
        let found = last(
            &histories,
            ["pretension.bolt.force_n", "contact.joint.force_n"],
        );
        // the load has been constant for 2 ms, 16 periods of the closed joint, of each of which the scheme leaves next to nothing
        for (found, wanted) in found.iter().zip(shared(load, STIFFNESS)) {
            assert!(
                (found - wanted).abs() < 1e-6 * PRELOAD,
                "{load}: {found} {wanted}"
            );
        }
    }
}

#[test]
fn a_bolt_of_beams_follows_the_joint_diagram() {
    let area = 0.25 * std::f64::consts::PI * 0.012_f64.powi(2);
    let stiffness = [210e9 * area / 0.024, 10e9 * 0.06 * 0.04 / 0.024];
    for (load, bolt) in [
        (0.0, "beam = \"bolt\""),
        (15e3, "on = \"shank\""),
        (60e3, "beam = \"bolt\""),
    ] {
        let (summary, histories) = result(&plates(load, bolt));
        let start = preload(&summary, "bolt");
        assert!((start / PRELOAD - 1.0).abs() < 1e-9, "{start}");
        let pressed = summary.contacts["joint"].preload.unwrap();
        assert!((pressed / PRELOAD - 1.0).abs() < 1e-8, "{pressed}");
        let found = last(
            &histories,
            ["pretension.bolt.force_n", "contact.joint.force_n"],
        );
        // plates that do not contract are bars, and so is the shank: exact with linear elements; 1 ms under the constant load as above
        for (found, wanted) in found.iter().zip(shared(load, stiffness)) {
            assert!(
                (found - wanted).abs() < 1e-5 * PRELOAD,
                "{load}: {found} {wanted}"
            );
        }
        let told = summary.pretensions["bolt"];
        assert_eq!(told.last.unwrap(), found[0]);
        assert!((told.loss.unwrap() - (1.0 - found[0] / start)).abs() < 1e-12);
    }
}

/// A pulse of the base along the joint, then rest.
fn shaken() -> String {
    let case = plates(0.0, "beam = \"bolt\"");
    let shake = r#"
signal.shake.acceleration.points = [
  { time = 0.0, acceleration = 0.0 }, { time = 1.0, acceleration = 0.0 }, { time = 1.0002, acceleration = 800.0 },
  { time = 1.0006, acceleration = -800.0 }, { time = 1.0008, acceleration = 0.0 }, { time = 2.0, acceleration = 0.0 },
]
load.shake.base-acceleration.y = "shake"
"#;
    case.replace("[load.pull]", &format!("{shake}\n[load.pull]"))
}

#[test]
fn a_shaken_joint_has_its_preload_at_rest() {
    let (summary, _) = result(&shaken());
    let bolt = summary.pretensions["bolt"];
    let ([most, _], [least, _]) = (bolt.largest.unwrap(), bolt.smallest.unwrap());
    // the upper plate of 0.226 kg at 800 m/s² pulls by 181 N, about half of which is the bolt's; dynamics doubles it at most
    assert!(most - PRELOAD > 40.0 && most - PRELOAD < 200.0, "{most}");
    assert!(PRELOAD - least > 40.0 && PRELOAD - least < 200.0, "{least}");
    // nothing slid or opened: what is left is that of a motion that the scheme has damped for 2 ms
    assert!(bolt.loss.unwrap().abs() < 1e-6, "{bolt:?}");
}

#[test]
fn a_run_with_a_bolt_that_is_cut_in_its_stage_and_after_it_leaves_the_same_bytes() {
    let text = shaken().replace("end = 1.003", "end = 1.0005");
    let input = Input::from_text("case.toml", &text, &[]);
    compare("bolt", &input, [1, 7]);
}

/// The problem of a case that is refused: path, message, what is accepted.
fn refused(text: &str) -> (String, String, Vec<String>) {
    let input = Input::from_text("case.toml", text, &[]);
    let built = parse(&input).and_then(|(case, locator)| build(&case, &locator, &input));
    let problems = built.unwrap_err();
    let mut all = problems.iter();
    let first = all.find(|one| one.path.starts_with("pretension")).unwrap();
    let accepted = first.accepted.clone();
    (first.path.clone(), first.message.clone(), accepted)
}

#[test]
fn what_cannot_be_tightened_is_refused_with_what_can() {
    let (path, message, accepted) = refused(&plates(0.0, "on = \"upper\""));
    assert_eq!(path, "pretension.bolt.on");
    assert!(message.contains("no section across a bolt"), "{message}");
    assert!(accepted[0].contains("between two planes"), "{accepted:?}");

    let dynamic = nodes(0.0).replace("static = { end = 1.0, steps = 2 }", "");
    let (path, message, accepted) = refused(&dynamic);
    assert_eq!(path, "pretension.bolt");
    assert!(message.contains("the case has none"), "{message}");
    assert!(accepted[0].starts_with("static = "), "{accepted:?}");

    let turning = plates(0.0, "beam = \"bolt\"").replace(
        "theory = \"timoshenko\"",
        "theory = \"timoshenko\", rotations = \"finite\"",
    );
    let (path, message, _) = refused(&turning);
    assert_eq!(path, "pretension.bolt.beam");
    assert_eq!(message, "beams with finite rotations are not tightened");

    let (path, message, _) = refused(&plates(0.0, "beam = \"upper\""));
    assert_eq!(path, "pretension.bolt.beam");
    assert_eq!(message, "this body has no beams");
}

/// A plate of 60 mm by 12 mm, `nx` by `ny` quadrilaterals, whose lower left corner is at (-30, `y`) mm, from a node and a cell on: nodes, cells, and
/// those of its lower and of its upper side, in the format of Gmsh 2.2.
fn plate((nx, ny): (usize, usize), y: f64, (node, tag): (usize, usize)) -> [String; 4] {
    let mut parts: [String; 4] = Default::default();
    let number = |i: usize, j: usize| node + j * (nx + 1) + i;
    for j in 0..=ny {
        for i in 0..=nx {
            let x = [
                i as f64 / nx as f64 * 60.0 - 30.0,
                y + j as f64 / ny as f64 * 12.0,
            ];
            parts[0] += &format!("{} {:?} {:?} 0\n", number(i, j), x[0], x[1]);
        }
    }
    for j in 0..ny {
        for i in 0..nx {
            let [a, b] = [number(i, j), number(i, j + 1)];
            parts[1] += &format!("0 3 2 {tag} {tag} {a} {} {} {b}\n", a + 1, b + 1);
        }
    }
    for (k, j) in [(2, 0), (3, ny)] {
        for i in 0..nx {
            let (a, side) = (number(i, j), tag + k - 1);
            parts[k] += &format!("0 1 2 {side} {side} {a} {}\n", a + 1);
        }
    }
    parts
}

/// Two plates on each other, with the groups of the case below.
fn joint_mesh(nx: usize, ny: usize) -> String {
    let nodes = (nx + 1) * (ny + 1);
    let lower = plate((nx, ny), 0.0, (1, 1));
    let upper = plate((nx, ny), 12.0, (nodes + 1, 4));
    let names = [
        "lower",
        "lower-bottom",
        "lower-top",
        "upper",
        "upper-bottom",
        "upper-top",
    ];
    let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n9\n".to_owned();
    for (k, name) in names.iter().enumerate() {
        let dim = if k % 3 == 0 { 2 } else { 1 };
        text += &format!("{dim} {} \"{name}\"\n", k + 1);
    }
    text += "0 7 \"nut\"\n0 8 \"head\"\n0 9 \"left\"\n$EndPhysicalNames\n";
    text += &format!("$Nodes\n{}\n{}{}$EndNodes\n", 2 * nodes, lower[0], upper[0]);
    let points = [1 + nx / 2, 2 * nodes - nx / 2, nodes + 1];
    let mut cells: Vec<String> = Vec::new();
    for (k, node) in points.iter().enumerate() {
        cells.push(format!("0 15 2 {0} {0} {node}", k + 7));
    }
    let all = lower[1..].iter().chain(&upper[1..]);
    cells.extend(all.flat_map(|part| part.lines()).map(str::to_owned));
    text += &format!("$Elements\n{}\n", cells.len());
    for (k, cell) in cells.iter().enumerate() {
        text += &format!("{}{}\n", k + 1, &cell[1..]);
    }
    text + "$EndElements\n"
}

/// A bolt by hand, a spring with a curve through (0, 20 kN), in a joint that friction holds, beside a hammer that nothing holds: that found no
/// equilibrium. The contact bears the force of the spring, which is less than 20 kN by its stiffness times the shortening of the plates.
#[test]
fn a_bolt_as_a_spring_with_a_curve_finds_its_equilibrium() {
    let work = tempfile::tempdir().unwrap();
    let mesh = work.path().join("joint.msh");
    std::fs::write(&mesh, joint_mesh(10, 2)).unwrap();
    let (_, histories) = result(&format!(
        r#"
carom = 1
mesh = {{ file = {mesh:?}, unit = "mm" }}
material.steel = {{ density = "7850 kg/m^3", elastic = {{ young = "210 GPa", poisson = 0.3 }} }}
body.lower = {{ region = "lower", material = "steel", section.plane-strain.thickness = "40 mm" }}
body.upper = {{ region = "upper", material = "steel", section.plane-strain.thickness = "40 mm" }}
support.base = {{ on = "lower-bottom", fix = ["x", "y"] }}
contact.joint = {{ secondary = "upper-bottom", primary = "lower-top", law.velocity = {{}}, friction.coulomb = 0.2 }}
support.guide = {{ on = "hammer", fix = ["y"] }}
[spring.bolt]
ends = ["nut", "head"]
axis = [0.0, 1.0]
curve = [{{ elongation = "-0.04 mm", force = "0 N" }}, {{ elongation = "0 mm", force = "20 kN" }}, {{ elongation = "0.1 mm", force = "70 kN" }}]
[mass.hammer]
mass = "0.2 kg"
at = ["-32 mm", "12 mm"]
initial.velocity = ["3 m/s", 0.0]
[stop.hit]
ends = ["hammer", "left"]
axis = [1.0, 0.0]
gap = "1 mm"
stiffness = "50 MN/m"
[time]
static = {{ end = "1 s", steps = 4 }}
end = "1.00001 s"
step = "2 us"
scheme.theta.theta = 0.55
"#
    ));
    let (times, forces) = (&histories["time_s"], &histories["spring.bolt.force_n"]);
    let end = times.iter().position(|time| *time >= 1.0).unwrap();
    let elongation = histories["spring.bolt.elongation_m"][end];
    assert!(elongation < -1e-7, "{elongation}");
    assert!((forces[end] - (20e3 + 5e8 * elongation)).abs() < 1e-6);
    // along the axis, with what friction bears of it where the faces turn; iterations end at 1e-10 of the forces
    let pressed = histories["contact.joint.resultant_y_n"][end];
    assert!(
        (pressed / forces[end] - 1.0).abs() < 1e-8,
        "{pressed} {}",
        forces[end]
    );
}
