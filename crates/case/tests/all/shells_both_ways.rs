//! Solids and shells see each other, whichever side is called the secondary one.

use carom_case::{Input, build, parse, run};
use carom_dynamics::Silent;

use crate::verdict::result;

/// A shell of 4 mm in one face, and a tetrahedron with its tip 1 mm above it, between its nodes.
const TIP: &str = r#"$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
4
2 1 "plate"
3 2 "tip"
2 3 "tip-skin"
1 4 "rim"
$EndPhysicalNames
$Nodes
8
1 0.0 0.0 0.0
2 0.1 0.0 0.0
3 0.1 0.1 0.0
4 0.0 0.1 0.0
5 0.03 0.02 0.043
6 0.07 0.03 0.043
7 0.05 0.07 0.043
8 0.05 0.045 0.003
$EndNodes
$Elements
10
1 3 2 1 1 1 2 3 4
2 4 2 2 2 6 5 7 8
3 2 2 3 3 5 6 7
4 2 2 3 3 6 5 8
5 2 2 3 3 7 6 8
6 2 2 3 3 5 7 8
7 1 2 4 4 1 2
8 1 2 4 4 2 3
9 1 2 4 4 3 4
10 1 2 4 4 4 1
$EndElements
"#;

/// The tip falls on the plate; first closing, s, and the force in all steps, N.
fn dropped(contact: &str) -> (f64, Vec<f64>) {
    let text = format!(
        r#"
carom = 1
mesh.file = "m.msh"
material.m = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.3 }} }}
body.plate = {{ region = "plate", material = "m", section.shell.thickness = "4 mm" }}
body.tip = {{ region = "tip", material = "m", initial.velocity = [0.0, 0.0, -1.0] }}
contact.c = {{ {contact}, law.velocity = {{}}, sliding = "finite" }}
time = {{ end = "3 ms", step = "50 us", scheme.theta = {{}} }}
"#
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    std::fs::write(folder.path().join("m.msh"), TIP).unwrap();
    std::fs::write(&path, text).unwrap();
    let input = Input::read(&path, &[]).unwrap();
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    let results = folder.path().join("results");
    let given = (&input, &case, &built);
    let summary = run(given, results.clone(), &mut Silent, &|| false)
        .unwrap()
        .summary;
    let table = std::fs::read_to_string(results.join("histories.csv")).unwrap();
    let mut rows = table.lines().map(|line| line.split(','));
    let column = rows
        .next()
        .unwrap()
        .position(|name| name == "contact.c.force_n")
        .unwrap();
    let force = rows.map(|mut row| row.nth(column).unwrap().parse().unwrap());
    (
        summary.contacts["c"].first_closing.unwrap(),
        force.collect(),
    )
}

/// The nodes of the plate are beside the tip: only that of the tip can meet it.
#[test]
fn a_corner_meets_a_shell_between_its_nodes_at_half_the_thickness_whichever_side_is_the_secondary_one()
 {
    let sides = [("tip-skin", "plate"), ("plate", "tip-skin")];
    let [one, other] = sides.map(|(secondary, primary)| {
        dropped(&format!(
            r#"secondary = "{secondary}", primary = "{primary}""#
        ))
    });
    // 1 mm at 1 m/s, in steps of 50 us
    for (first, _) in [&one, &other] {
        assert!((first - 1e-3).abs() <= 5e-5, "{first}");
    }
    let largest = one.1.iter().fold(0.0_f64, |most, force| most.max(*force));
    assert!(largest > 0.0);
    for (a, b) in one.1.iter().zip(&other.1) {
        // the same equations in another order
        assert!((a - b).abs() < 1e-9 * largest, "{a} {b}");
    }
}

/// A block of 2 x 2 x 2 elements pressed on a shell that is held, node on node.
fn pressed(contact: &str, z: f64) -> String {
    let probes = [[0.0, 0.0], [0.05, 0.0], [0.05, 0.05]];
    let probes = probes.iter().enumerate().map(|(k, [x, y])| {
        format!("probe.p{k} = {{ at = [{x:?}, {y:?}, {z:?}], record = [\"contact\"] }}\n")
    });
    format!(
        r#"
carom = 1
mesh.dimension = 3
mesh.generate.plate.rectangle = {{ origin = [0.0, 0.0], size = [0.1, 0.1], elements = [2, 2] }}
mesh.generate.block.box = {{ origin = [0.0, 0.0, 0.002], size = [0.1, 0.1, 0.1], elements = [2, 2, 2] }}
material.m = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.0 }} }}
body.plate = {{ region = "plate", material = "m", section.shell.thickness = "4 mm" }}
body.block = {{ region = "block", material = "m" }}
support.held = {{ on = "plate", fix = ["x", "y", "z", "rx", "ry", "rz"] }}
support.middle = {{ on = "block.left", fix = ["x"] }}
support.side = {{ on = "block.front", fix = ["y"] }}
load.top = {{ on = "block.top", pressure = 1e4 }}
contact.c = {{ {contact}, law.displacement = {{}}, sliding = "finite" }}
time = {{ end = 1.0, static = {{ end = 1.0, steps = 1 }} }}
{}"#,
        probes.collect::<String>()
    )
}

/// The block is compressed alike everywhere, and as many nodes as one side has carry the pressure.
#[test]
fn a_flat_block_on_a_shell_has_the_same_pressure_at_all_nodes() {
    let [block, plate] = [0.002, 0.0];
    for (secondary, primary, z) in [
        ("block.bottom", "plate", block),
        ("plate", "block.bottom", plate),
    ] {
        let contact = format!(r#"secondary = "{secondary}", primary = "{primary}""#);
        let (_, histories) = result(&pressed(&contact, z));
        for k in 0..3 {
            let all = &histories[&format!("probe.p{k}.contact_pressure_pa")];
            let pressure = all.last().unwrap();
            // the sides are the same faces: what iterations leave
            assert!(
                (pressure / 1e4 - 1.0).abs() < 1e-9,
                "{secondary} {k}: {pressure}"
            );
        }
    }
}
