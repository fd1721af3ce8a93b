//! Zones, overlaps and interfaces from the text to a model in zones.

use carom_arlequin::Row;
use carom_case::{Built, Input, build, parse};
use carom_dynamics::Stepper;
use carom_zones::{LinkKind, Whole, Zones};

/// A file with two bars with fine tips that meet at x = 0; the fine cells are a quarter of the coarse ones.
fn bars(end: &str) -> String {
    format!(
        r#"
carom = 1
[mesh.generate]
bar1.line = {{ from = [-1.0], to = [-0.1], elements = 9 }}
tip1.line = {{ from = [-0.5], to = [0.0], elements = 20 }}
tip2.line = {{ from = [0.0], to = [0.5], elements = 20 }}
bar2.line = {{ from = [0.0], to = [1.0], elements = 10 }}
[material.one]
density = 1.0
elastic = {{ young = 1.0, poisson = 0.0 }}
[body]
bar1 = {{ region = "bar1", material = "one", section.bar.area = 1.0, initial.velocity = [0.1] }}
tip1 = {{ region = "tip1", material = "one", section.bar.area = 1.0, initial.velocity = [0.1] }}
tip2 = {{ region = "tip2", material = "one", section.bar.area = 1.0 }}
bar2 = {{ region = "bar2", material = "one", section.bar.area = 1.0 }}
[contact.shock]
secondary = "tip1.right"
primary = "tip2.left"
law.velocity = {{}}
[time]
end = 2.0
step = {{ courant = 0.5 }}
scheme.central-difference = {{}}
[zone.impact]
bodies = ["tip1", "tip2"]
scheme.theta = {{ theta = 0.6 }}
{end}
"#
    )
}

const TWO: &str = r#"
[zone.rest]
bodies = ["bar1", "bar2"]
substeps = { impact = 4 }
[arlequin.left]
inner = "tip1"
outer = "bar1"
[arlequin.right]
inner = "tip2"
outer = "bar2"
overlap.box = { min = [0.2], max = [0.5] }
"#;

fn built(text: &str) -> Built {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap();
    build(&case, &locator, &input).unwrap()
}

#[test]
fn two_bars_with_fine_tips_become_two_zones_that_take_a_step() {
    let built = built(&bars(TWO));
    let zoned = built.zoned.as_ref().unwrap();
    let zones: Vec<(&str, u32)> = zoned
        .zones
        .iter()
        .map(|zone| (zone.name.as_str(), zone.substeps))
        .collect();
    assert_eq!(zones, [("impact", 4), ("rest", 1)]);
    // more steps than one: the link that dissipates nothing
    assert_eq!(zoned.kind, LinkKind::PrakashHjelmstad);
    // the outer nodes on [-0.5, -0.1] and on [0.2, 0.5]
    let rows: Vec<usize> = zoned.links.iter().map(|link| link.rows.len()).collect();
    assert_eq!(rows, [5, 4]);
    // the Courant number is that of the outer cells: 0.1 m at 1 m/s
    assert!((zoned.model.dt - 0.05).abs() < 1e-15);
    // cells of the second bar on [0, 0.2], inside the tip and outside the overlap
    assert_eq!(built.overlaps[1].removed, 2);
    // the models share the material: both bars have their length as mass
    let masses: f64 = (0..4).map(|body| built.system.body_mass(body)).sum();
    assert!((masses - 2.0).abs() < 1e-12, "{masses}");

    let mut zones = Zones::new(zoned).unwrap();
    zones.step().unwrap();
    // four inner instants and one outer, and velocities that agree at its end
    assert_eq!(zones.samples().len(), 5);
    let parted = zoned.links.iter().flat_map(|link| &link.rows).map(|row| {
        let v = |zone: usize| {
            let driver = &zones.drivers()[zone];
            move |node: u32, _: usize| {
                let number = driver.system().number[node as usize] as usize;
                driver.state().motion.v[number]
            }
        };
        Row::apply(&row.inner, v(0)) - Row::apply(&row.outer, v(1))
    });
    let worst = parted.fold(0.0, |worst: f64, defect| worst.max(defect.abs()));
    assert!(worst < 1e-12, "{worst}");
    assert!(
        zones
            .samples()
            .iter()
            .any(|s| s.contacts.iter().any(|c| c.force > 0.0))
    );
}

#[test]
fn the_exact_bars_are_those_that_overlaps_make() {
    let text = bars(TWO).replace("[zone.rest]", "[reference.two-bars]\n[zone.rest]");
    let reference = built(&text).reference.unwrap();
    // two bars of length, modulus and density 1: in contact for the two transits of the shorter
    let contacts = reference.solution.contacts();
    assert_eq!(contacts.len(), 1);
    assert!((contacts[0].end - contacts[0].start - 2.0).abs() < 1e-9);
}

#[test]
fn steps_in_the_inner_zone_say_the_same_as_in_the_outer_one() {
    let other = TWO.replace("substeps = { impact = 4 }", "");
    let text = bars(&other).replace(
        "scheme.theta = { theta = 0.6 }",
        "scheme.theta = { theta = 0.6 }\nsubsteps = 4",
    );
    let (one, other) = (built(&bars(TWO)), built(&text));
    let steps = |built: &Built| {
        let zones = &built.zoned.as_ref().unwrap().zones;
        zones.iter().map(|zone| zone.substeps).collect::<Vec<_>>()
    };
    assert_eq!(steps(&one), steps(&other));
}

#[test]
fn equal_steps_take_the_pointwise_link() {
    let text = bars(TWO).replace("substeps = { impact = 4 }", "");
    let kind = built(&text).zoned.unwrap().kind;
    assert_eq!(kind, LinkKind::GravouilCombescure);
}

/// Three bodies of one mesh file that share the nodes of their borders: a row of squares.
const ROW: &str = r#"
carom = 1
mesh.file = "row.msh"
material.one = { density = 1.0, elastic = { young = 1.0, poisson = 0.0 } }
time = { end = 1.0, step.courant = 0.5, scheme.theta = {} }
[body]
a = { region = "a", material = "one", section.plane-strain.thickness = 1.0, initial.velocity = [0.0, 1.0] }
b = { region = "b", material = "one", section.plane-strain.thickness = 1.0 }
"#;

/// Two squares with a common side, as Gmsh writes them.
const SQUARES: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"a\"\n2 2 \"b\"\n$EndPhysicalNames\n\
$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n\
$Elements\n2\n1 3 2 1 1 1 2 5 4\n2 3 2 2 2 2 3 6 5\n$EndElements\n";

fn row(end: &str) -> Result<Built, Vec<String>> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("row.msh"), SQUARES).unwrap();
    let case = folder.path().join("case.toml");
    std::fs::write(&case, format!("{ROW}{end}")).unwrap();
    let input = Input::read(&case, &[]).unwrap();
    let (case, locator) = parse(&input).unwrap();
    let texts = |problems: Vec<carom_case::Problem>| {
        problems.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    build(&case, &locator, &input).map_err(texts)
}

#[test]
fn zones_of_one_mesh_are_tied_at_the_nodes_that_they_share() {
    let zones = "[zone]\none.bodies = ['a']\ntwo = { bodies = ['b'], substeps = 2 }\n";
    let loose = row(zones).unwrap_err();
    assert!(loose[0].contains("share 2 nodes"), "{loose:?}");
    let built = row(&format!(
        "{zones}[interface.cut]\ninner = 'b'\nouter = 'a'\n"
    ))
    .unwrap();
    let zoned = built.zoned.unwrap();
    // two nodes in two directions
    assert_eq!(zoned.links[0].rows.len(), 4);
    let mut zones = Zones::new(&zoned).unwrap();
    zones.step().unwrap();
    // initial velocities differ at the border; the momentum stays that of the first square
    let momentum: f64 = zones
        .drivers()
        .iter()
        .map(|driver| {
            let system = driver.system();
            system.body_mass(0) * system.mean_velocity(0, &driver.state().motion.v)[1]
        })
        .sum();
    assert!((momentum - 1.0).abs() < 1e-12, "{momentum}");
}

/// A fine piece between two coarse bars, held at the left end.
const MIDDLE: &str = r#"
carom = 1
[mesh.generate]
a.line = { from = [0.0], to = [1.0], elements = 10 }
m.line = { from = [0.7], to = [2.3], elements = 64 }
b.line = { from = [2.0], to = [3.0], elements = 10 }
[material.one]
density = 1.0
elastic = { young = 1.0, poisson = 0.0 }
[body]
a = { region = "a", material = "one", section.bar.area = 1.0 }
b = { region = "b", material = "one", section.bar.area = 1.0 }
m = { region = "m", material = "one", section.bar.area = 1.0 }
[time]
end = 1.0
step.courant = 0.5
scheme.theta = {}
[zone]
fine = { bodies = ["m"], substeps = 4 }
rest.bodies = ["a", "b"]
[arlequin]
left = { inner = "m", outer = "a" }
right = { inner = "m", outer = "b" }
"#;

#[test]
fn a_body_with_two_overlaps_has_the_weights_of_both() {
    let built = built(MIDDLE);
    let mass = |body: usize| built.system.body_mass(body);
    // linear weights halve the mass of each body in an overlap of 0.3 m
    for (body, expected) in [(0, 0.85), (1, 0.85), (2, 1.3)] {
        assert!(
            (mass(body) - expected).abs() < 1e-12,
            "{body}: {}",
            mass(body)
        );
    }
    let zoned = built.zoned.unwrap();
    assert_eq!(zoned.links.len(), 2);
    Zones::new(&zoned).unwrap().step().unwrap();
}

#[test]
fn rows_that_supports_hold_in_both_bodies_are_dropped_and_named() {
    let text = r#"
carom = 1
[mesh.generate]
bar.rectangle = { origin = [0.0, 0.0], size = [1.0, 0.2], elements = [10, 2] }
tip.rectangle = { origin = [0.7, 0.0], size = [0.7, 0.2], elements = [7, 2] }
[material.one]
density = 1.0
elastic = { young = 1.0, poisson = 0.0 }
[body]
bar = { region = "bar", material = "one", section.plane-strain.thickness = 1.0 }
tip = { region = "tip", material = "one", section.plane-strain.thickness = 1.0 }
[support]
one = { on = "bar.bottom", fix = ["y"] }
other = { on = "tip.bottom", fix = ["y"] }
[time]
end = 1.0
step.courant = 0.5
scheme.theta = {}
[zone]
fine.bodies = ["tip"]
rest.bodies = ["bar"]
[arlequin.left]
inner = "tip"
outer = "bar"
"#;
    let built = built(text);
    // four columns of three nodes in two directions; the four at the bottom cannot move up
    let zoned = built.zoned.as_ref().unwrap();
    assert_eq!(zoned.links[0].rows.len(), 20);
    let named = built
        .warnings
        .iter()
        .find(|text| text.contains("4 constraints removed"));
    assert!(
        named.is_some_and(|text| text.contains("y of node")),
        "{:?}",
        built.warnings
    );
    // on equal meshes they would be redundant: the multipliers could not be found
    Zones::new(zoned).unwrap().step().unwrap();
}

/// A block of rubber over a foot that yields, in zones whose nodes do not match, that slide on a plane.
const STACK: &str = r#"
carom = 1
[mesh.generate]
foot.rectangle = { origin = [0.0, 0.0], size = [1.0, 0.5], elements = [6, 3] }
block.rectangle = { origin = [0.0, 0.5], size = [1.0, 1.0], elements = [4, 4] }
[material.rubber]
density = 1.0
neo-hooke = { young = 1.0, poisson = 0.3 }
[material.clay]
density = 1.0
j2 = { young = 1.0, poisson = 0.3, yield-stress = 0.02, hardening = 0.1 }
[body]
foot = { region = "foot", material = "clay", section.plane-strain.thickness = 1.0, initial.velocity = [0.1, -0.2] }
block = { region = "block", material = "rubber", section.plane-strain.thickness = 1.0, initial.velocity = [0.1, -0.2] }
[contact.ground]
secondary = "foot.bottom"
obstacle.plane = { point = [0.0, -0.01], normal = [0.0, 1.0] }
law.velocity = {}
friction.coulomb = 0.3
[time]
end = 2.0
step = 0.08
scheme.theta = { theta = 0.5 }
[zone.low]
bodies = ["foot"]
substeps = 2
[zone.high]
bodies = ["block"]
scheme.energy-momentum = {}
[interface.glue]
inner = "foot"
outer = "block"
surfaces = ["foot.top", "block.bottom"]
"#;

#[test]
fn zones_at_finite_strain_are_tied_over_surfaces_whose_nodes_do_not_match() {
    let built = built(STACK);
    let zoned = built.zoned.as_ref().unwrap();
    // a multiplier at each of seven nodes of the finer side, in two directions
    assert_eq!(zoned.links[0].rows.len(), 14);
    let mut whole = Whole::new(zoned, built.system.clone()).unwrap();
    let start = whole.state().ledger.balance;
    for _ in 0..25 {
        whole.step().unwrap();
    }
    let state = whole.state();
    let balance = &state.ledger.balance;
    // what iterations to 1e-10 leave in 25 steps
    assert!(balance.energy_residual.abs() < 1e-8 * start.energy());
    assert!(balance.dissipation_material > 0.0 && balance.dissipation_friction > 0.0);
    // the history of the foot is in the state of the whole, and its friction
    let low = whole.names().iter().position(|name| name == "low").unwrap();
    let zone = whole.zones().drivers()[low].state();
    assert!(!zone.motion.history.is_empty());
    assert_eq!(state.motion.history, zone.motion.history);
    assert_eq!(state.interface.friction, zone.interface.friction);
}
