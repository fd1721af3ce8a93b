//! Solids and shells see each other, whichever side is called the secondary one.

use carom_case::{Input, build, parse, run};
use carom_dynamics::Silent;

use crate::verdict::result;

/// A shell in one face, and a cube of 40 mm that stands on its corner 3 mm above the middle of that, between its nodes.
fn mesh() -> String {
    let (x, y, z) = (
        (2.0_f64 / 3.0).sqrt(),
        0.5_f64.sqrt(),
        (1.0_f64 / 3.0).sqrt(),
    );
    let along = [[x, 0.0, z], [-0.5 * x, y, z], [-0.5 * x, -y, z]];
    let corners = ["000", "100", "110", "010", "001", "101", "111", "011"];
    let places = corners.map(|corner| {
        let steps: Vec<f64> = corner.chars().map(|c| f64::from(c == '1')).collect();
        let at = |i: usize| (0..3).map(|k| 0.04 * steps[k] * along[k][i]).sum::<f64>();
        [0.05 + at(0), 0.045 + at(1), 0.003 + at(2)]
    });
    let plate = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]].map(|[x, y]| [x, y, 0.0]);
    let nodes = plate.iter().chain(&places).zip(1..);
    let nodes: String = nodes
        .map(|([x, y, z], k)| format!("{k} {x:?} {y:?} {z:?}\n"))
        .collect();
    let skin = [
        "5 6 7 8",
        "9 10 11 12",
        "5 6 10 9",
        "6 7 11 10",
        "7 8 12 11",
        "8 5 9 12",
    ];
    let skin = skin.iter().zip(3..);
    let skin: String = skin
        .map(|(side, k)| format!("{k} 3 2 3 3 {side}\n"))
        .collect();
    let names = "3\n2 1 \"plate\"\n3 2 \"cube\"\n2 3 \"skin\"";
    let elements = format!("1 3 2 1 1 1 2 3 4\n2 5 2 2 2 5 6 7 8 9 10 11 12\n{skin}");
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{names}\n$EndPhysicalNames\n$Nodes\n12\n{nodes}$EndNodes\n$Elements\n8\n{elements}$EndElements\n"
    )
}

/// The cube of a material falls on the plate, which is linear; first closing, s, and the force in all steps, N.
fn dropped(contact: &str, material: &str) -> (f64, Vec<f64>) {
    let text = format!(
        r#"
carom = 1
mesh.file = "m.msh"
material.m = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.3 }} }}
material.of-cube = {{ density = 1000.0, {material} = {{ young = "1 GPa", poisson = 0.3 }} }}
body.plate = {{ region = "plate", material = "m", section.shell.thickness = "4 mm" }}
body.cube = {{ region = "cube", material = "of-cube", initial.velocity = [0.0, 0.0, -1.0] }}
contact.c = {{ {contact}, sliding = "finite" }}
time = {{ end = "3 ms", step = "50 us", scheme.theta = {{}} }}
"#
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    std::fs::write(folder.path().join("m.msh"), mesh()).unwrap();
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

/// The nodes of the plate are beside the cube: only its corner can meet the plate.
#[test]
fn a_corner_meets_a_shell_between_its_nodes_at_half_the_thickness_whichever_side_is_the_secondary_one()
 {
    let sides = [("skin", "plate"), ("plate", "skin")];
    let [one, other] = sides.map(|(secondary, primary)| {
        let contact =
            format!(r#"secondary = "{secondary}", primary = "{primary}", law.velocity = {{}}"#);
        dropped(&contact, "elastic")
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

/// Of a hyperelastic cube the matrix changes, of the plate it does not; forces of a law in the gap turn with both.
#[test]
fn a_corner_of_a_hyperelastic_body_meets_a_linear_shell_as_one_of_a_linear_body_does() {
    let impulse = |material: &str| {
        let contact = r#"secondary = "plate", primary = "skin", law.displacement = {}"#;
        dropped(contact, material).1.iter().sum::<f64>()
    };
    let [linear, hyperelastic] = ["elastic", "neo-hooke"].map(impulse);
    // strains are of the order of the speed over that of waves, 1 m/s over 1160 m/s; ten times that
    assert!(linear > 0.0);
    assert!(
        (hyperelastic / linear - 1.0).abs() < 1e-2,
        "{hyperelastic} {linear}"
    );
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
