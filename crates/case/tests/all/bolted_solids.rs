//! Sections of solids that the static stage tightens.

use carom_case::{Input, build, parse};

use crate::verdict::result;

/// F, N.
const PRELOAD: f64 = 20e3;

/// Quadrilaterals over lines in x and y in the format of Gmsh 2.2: the groups of each cell by its middle, and those of lines by their ends. Cells of different
/// first groups have no common nodes.
struct Grid {
    x: Vec<f64>,
    y: Vec<f64>,
    cell: fn([f64; 2]) -> &'static [&'static str],
    line: fn(&str, [[f64; 2]; 2]) -> Option<&'static str>,
}

impl Grid {
    fn text(&self) -> String {
        let (mut names, mut nodes, mut elements) = (Vec::new(), Vec::new(), Vec::new());
        let number = |names: &mut Vec<(usize, &'static str)>, of: (usize, &'static str)| {
            let place = names.iter().position(|known| *known == of);
            1 + place.unwrap_or_else(|| {
                names.push(of);
                names.len() - 1
            })
        };
        let mut known: Vec<(&str, usize, usize)> = Vec::new();
        for i in 1..self.x.len() {
            for j in 1..self.y.len() {
                let middle = [
                    0.5 * (self.x[i] + self.x[i - 1]),
                    0.5 * (self.y[j] + self.y[j - 1]),
                ];
                let groups = (self.cell)(middle);
                let Some(&body) = groups.first() else {
                    continue;
                };
                let corners = [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)];
                let own = corners.map(|(i, j)| {
                    let place = known.iter().position(|known| *known == (body, i, j));
                    1 + place.unwrap_or_else(|| {
                        known.push((body, i, j));
                        nodes.push([self.x[i], self.y[j]]);
                        known.len() - 1
                    })
                });
                for &group in groups {
                    let tag = number(&mut names, (2, group));
                    elements.push(format!(
                        "3 2 {tag} {tag} {} {} {} {}",
                        own[0], own[1], own[2], own[3]
                    ));
                }
                for k in 0..4 {
                    let ends = [k, (k + 1) % 4];
                    let at = ends.map(|k| nodes[own[k] - 1]);
                    if let Some(group) = (self.line)(body, at) {
                        let tag = number(&mut names, (1, group));
                        elements.push(format!("1 2 {tag} {tag} {} {}", own[ends[0]], own[ends[1]]));
                    }
                }
            }
        }
        let mut text = format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n",
            names.len()
        );
        for (k, (dim, name)) in names.iter().enumerate() {
            text += &format!("{dim} {} \"{name}\"\n", k + 1);
        }
        text += &format!("$EndPhysicalNames\n$Nodes\n{}\n", nodes.len());
        for (k, [x, y]) in nodes.iter().enumerate() {
            text += &format!("{} {x:?} {y:?} 0\n", k + 1);
        }
        text += &format!("$EndNodes\n$Elements\n{}\n", elements.len());
        for (k, element) in elements.iter().enumerate() {
            text += &format!("{} {element}\n", k + 1);
        }
        text + "$EndElements\n"
    }

    fn write(&self, work: &tempfile::TempDir) -> String {
        let file = work.path().join("bolt.msh");
        std::fs::write(&file, self.text()).unwrap();
        file.to_str().unwrap().to_owned()
    }
}

/// A strip of 12 mm by 48 mm.
fn strip() -> Grid {
    Grid {
        x: vec![0.0, 0.006, 0.012],
        y: vec![0.0, 0.012, 0.018, 0.03, 0.048],
        cell: |[_, y]| match y {
            0.012..0.018 => &["bolt", "layer"],
            _ => &["bolt"],
        },
        line: |_, [[c, a], [d, b]]| match (a == b, c == d) {
            (true, _) if a == 0.0 => Some("foot"),
            (true, _) if a == 0.018 => Some("section"),
            (true, _) if a == 0.048 => Some("head"),
            (_, true) if c == 0.0 => Some("side"),
            _ => None,
        },
    }
}

/// A strip in plane stress between two walls, of which one moves away over 2 ms of the dynamics by 10 µm: the stress is F/A in all cells, those that are
/// tightened too, and E A/L times the way comes on top.
#[test]
fn a_strip_has_its_force_in_all_sections_and_its_stiffness_afterwards() {
    let work = tempfile::tempdir().unwrap();
    let mesh = strip().write(&work);
    let (area, young, way): (f64, f64, f64) = (0.012 * 0.01, 210e9, 1e-5);
    for on in ["layer", "section"] {
        let (summary, histories) = result(&format!(
            r#"
carom = 1
mesh.file = {mesh:?}
material.steel = {{ density = 7850.0, elastic = {{ young = {young:?}, poisson = 0.3 }} }}
body.bolt = {{ region = "bolt", material = "steel", section.plane-stress.thickness = 0.01 }}
support.foot = {{ on = "foot", fix = ["y"] }}
support.side = {{ on = "side", fix = ["x"] }}
support.head = {{ on = "head", move.y = [{{ time = 0.0, displacement = 0.0 }}, {{ time = 1.0, displacement = 0.0 }}, {{ time = 1.002, displacement = {way:?} }}] }}
pretension.bolt = {{ force = {PRELOAD:?}, on = {on:?} }}
probe.layer = {{ at = [0.003, 0.015], record = ["stress"] }}
probe.head = {{ at = [0.003, 0.04], record = ["stress"] }}
[time]
static = {{ end = 1.0, steps = 2 }}
end = 1.004
step = "10 us"
scheme.theta.theta = 1.0
"#
        ));
        let force = &histories["pretension.bolt.force_n"];
        let start = histories["time_s"]
            .iter()
            .position(|time| *time >= 1.0)
            .unwrap();
        // prescribed in the stage, to the tolerance of the equilibrium; waves that cross in 10 µs are damped out 2 ms after the way
        assert!(
            (force[start] / PRELOAD - 1.0).abs() < 1e-9,
            "{}",
            force[start]
        );
        let (last, exact) = (force.last().unwrap() - PRELOAD, young * area / 0.048 * way);
        assert!((last / exact - 1.0).abs() < 1e-6, "{on}: {last} {exact}");
        // the waves of the support, which moves by 5 mm/s, are E v/c on either side of what it brings in the end
        let largest = summary.maxima.von_mises.as_ref().unwrap().value;
        let wanted = (PRELOAD + exact) / area;
        let waves = young * (way / 2e-3) / (young / 7850.0).sqrt();
        assert!(
            (largest - wanted).abs() < waves + 1e-6 * wanted,
            "{on}: {largest} {wanted}"
        );
        for place in ["layer", "head"] {
            let stress = |axes: &str| &histories[&format!("probe.{place}.stress_{axes}_pa")];
            for (step, force) in [(start, PRELOAD), (force.len() - 1, PRELOAD + exact)] {
                let wanted = force / area;
                let [along, across, shear] = ["yy", "xx", "xy"].map(|axes| stress(axes)[step]);
                assert!(
                    (along / wanted - 1.0).abs() < 1e-6,
                    "{on} {place}: {along} {wanted}"
                );
                assert!(across.abs() + shear.abs() < 1e-6 * wanted, "{on} {place}");
            }
        }
    }
}

/// Half the section of a bolt of 6 mm radius with a head of 10 mm, through a plate of 24 mm with a hole of 7 mm.
fn flange() -> Grid {
    Grid {
        x: vec![0.0, 3.0, 6.0, 7.0, 8.5, 10.0, 14.0, 20.0],
        y: vec![0.0, 6.0, 12.0, 18.0, 24.0, 27.0, 30.0],
        cell: |[r, z]| match (r, z) {
            (..6.0, 6.0..12.0) => &["bolt", "layer"],
            (..6.0, _) | (..10.0, 24.0..) => &["bolt"],
            (7.0.., ..24.0) => &["plate"],
            _ => &[],
        },
        line: |body, [[r, a], [s, b]]| match (body, a == b) {
            ("bolt", true) if a == 0.0 => Some("nut"),
            ("bolt", true) if a == 18.0 => Some("section"),
            ("bolt", true) if a == 24.0 && r.max(s) > 6.0 => Some("under"),
            ("bolt", true) if a == 30.0 => Some("top"),
            ("plate", true) if a == 0.0 => Some("base"),
            ("plate", true) if a == 24.0 => Some("face"),
            _ => None,
        },
    }
}

/// The head is held by its contact with the plate alone, and pulled at by P in the dynamics. What the head presses with and the force of the bolt are in
/// balance in both, and the bolt bears the same share of P wherever it is tightened, since the material is elastic afterwards; twice the forces give
/// twice the motion.
#[test]
fn a_bolt_with_a_head_presses_the_plate_and_shares_loads_with_it() {
    let work = tempfile::tempdir().unwrap();
    let mesh = flange().write(&work);
    let mut shares = Vec::new();
    for (on, times) in [("layer", 1.0), ("section", 1.0), ("layer", 2.0)] {
        let (preload, load) = (times * PRELOAD, times * 5e3);
        let (summary, histories) = result(&format!(
            r#"
carom = 1
mesh = {{ file = {mesh:?}, unit = "mm" }}
material.steel = {{ density = 7850.0, elastic = {{ young = 210e9, poisson = 0.3 }} }}
body.bolt = {{ region = "bolt", material = "steel", section.axisymmetric = {{}} }}
body.plate = {{ region = "plate", material = "steel", section.axisymmetric = {{}} }}
support.nut = {{ on = "nut", fix = ["y"] }}
support.base = {{ on = "base", fix = ["y"] }}
pretension.bolt = {{ force = {preload:?}, on = {on:?} }}
contact.head = {{ secondary = "under", primary = "face", sliding = "small", law.displacement = {{}} }}
[load.pull]
on = "top"
traction = [0.0, {:?}]
amplitude = [{{ time = 1.0, factor = 0.0 }}, {{ time = 1.001, factor = 1.0 }}]
[time]
static = {{ end = 1.0, steps = 2 }}
end = 1.003
step = "10 us"
scheme.theta.theta = 1.0
"#,
            load / (std::f64::consts::PI * 1e-4)
        ));
        let end = summary.pretensions["bolt"].end_of_stage.unwrap();
        assert!((end / preload - 1.0).abs() < 1e-9, "{end}");
        let [bolt, pressed] =
            ["pretension.bolt.force_n", "contact.head.resultant_y_n"].map(|name| &histories[name]);
        let start = histories["time_s"]
            .iter()
            .position(|time| *time >= 1.0)
            .unwrap();
        // equilibrium of the head, to the tolerance of iterations and to what the damped waves leave
        assert!(
            (pressed[start].abs() / preload - 1.0).abs() < 1e-8,
            "{}",
            pressed[start]
        );
        let [bolt, pressed] = [bolt, pressed].map(|values| *values.last().unwrap());
        assert!(
            (bolt - pressed.abs() - load).abs() < 1e-6 * preload,
            "{bolt} {pressed}"
        );
        shares.push((bolt - preload) / load);
    }
    assert!((0.02..0.5).contains(&shares[0]), "{shares:?}");
    for share in &shares {
        assert!((share - shares[0]).abs() < 1e-6, "{shares:?}");
    }
}

fn refused(text: &str) -> (String, String) {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let problems = build(&case, &locator, &input).unwrap_err();
    let problem = problems
        .into_iter()
        .find(|one| one.path.starts_with("pretension"));
    let problem = problem.unwrap();
    (problem.path.clone(), problem.message.clone())
}

#[test]
fn what_is_no_section_is_refused() {
    let work = tempfile::tempdir().unwrap();
    let mesh = flange().write(&work);
    let case = |on: &str, material: &str| {
        format!(
            r#"
carom = 1
mesh = {{ file = {mesh:?}, unit = "mm" }}
material.steel = {{ density = 7850.0, {material} = {{ young = 210e9, poisson = 0.3 }} }}
body.bolt = {{ region = "bolt", material = "steel", section.axisymmetric = {{}} }}
support.nut = {{ on = "nut", fix = ["y"] }}
pretension.bolt = {{ force = {PRELOAD:?}, on = {on:?} }}
[time]
static = {{ end = 1.0, steps = 2 }}
end = 1.003
step = "10 us"
scheme.theta.theta = 1.0
"#
        )
    };
    // the whole body, its surface, and a corner of cells
    for on in ["bolt", "top", "under"] {
        let (path, message) = refused(&case(on, "elastic"));
        assert_eq!(path, "pretension.bolt.on");
        assert!(
            message.contains("no section across a bolt"),
            "{on}: {message}"
        );
    }
    let (_, message) = refused(&case("layer", "neo-hooke"));
    assert_eq!(message, "a solid at finite strain is not tightened");
}
