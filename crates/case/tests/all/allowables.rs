//! Margins of what bodies, supports, springs and stops had to bear.

use carom_case::{Input, Problem, build, parse};
use carom_output::{Margin, Summary};

use carom_dynamics::Silent;

fn run(text: &str) -> Result<Summary, Vec<Problem>> {
    let work = tempfile::tempdir().unwrap();
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input)?;
    let built = build(&case, &locator, &input)?;
    let (parts, folder) = ((&input, &case, &built), work.path().join("r"));
    let finished = carom_case::run(parts, folder, &mut Silent, &|| false).unwrap();
    Ok(finished.summary)
}

/// 10 kN on a bar of 1 cm².
const BAR: &str = r#"
carom = 1
mesh.generate.bar.line = { from = [0.0], to = [1.0], elements = 4 }
material.steel = { density = 7800.0, elastic = { young = "200 GPa", poisson = 0.0 } }
body.bar = { region = "bar", material = "steel", section.bar.area = "1 cm^2" }
support.clamp = { on = "bar.left", fix = ["x"] }
load.pull = { on = "bar.right", force = ["10 kN"] }
time = { end = 1.0, static = { end = 1.0, steps = 1 } }
"#;

#[test]
fn margins_of_stress_and_of_a_support_are_those_of_a_bar() {
    let allowed =
        "output.allowable = { body.bar.stress = \"150 MPa\", support.clamp.force = \"8 kN\" }";
    let summary = run(&format!("{BAR}{allowed}")).unwrap();
    let [stress, support] = &summary.allowables[..] else {
        panic!("{:?}", summary.allowables);
    };
    // 100 MPa and 10 kN, to the tolerance of the equilibrium
    assert!(
        (stress.margin.margin.unwrap() - 0.5).abs() < 1e-9,
        "{stress:?}"
    );
    assert!(
        (support.margin.margin.unwrap() + 0.2).abs() < 1e-9,
        "{support:?}"
    );
    assert_eq!(support.margin.governing.as_ref().unwrap().0, "clamp");
    assert!(run(BAR).unwrap().allowables.is_empty());
}

#[test]
fn the_margin_of_plastic_strain_is_that_of_its_hardening() {
    // 20 MPa beyond the yield stress are a plastic strain of 20 MPa over the hardening, and the strain of 100 MPa beside it
    let metal = r#"j2 = { young = "200 GPa", poisson = 0.3, yield-stress = "80 MPa", hardening = "1 GPa" }"#;
    let case = BAR.replace(r#"elastic = { young = "200 GPa", poisson = 0.0 }"#, metal);
    let case = case.replace(
        r#"load.pull = { on = "bar.right", force = ["10 kN"] }"#,
        r#"support.pull = { on = "bar.right", move.x = [{ time = 1.0, displacement = 0.0205 }] }"#,
    );
    let allowed = "output.allowable.body.bar = { plastic-strain = 0.03 }";
    let summary = run(&format!("{case}{allowed}")).unwrap();
    let [strain] = &summary.allowables[..] else {
        panic!("{:?}", summary.allowables);
    };
    // to the tolerance of the equilibrium
    assert!(
        (strain.margin.found / 0.02 - 1.0).abs() < 1e-6,
        "{strain:?}"
    );
    assert!((strain.margin.margin.unwrap() - 0.5).abs() < 1e-5);
}

/// A mass that hits a stop which is crushed, and one on a spring: both stop within a quarter of their periods.
const MASSES: &str = r#"
carom = 1
mass.ram = { mass = 2.0, at = [1.0], initial.velocity = [-3.0] }
mass.bob = { mass = 2.0, at = [5.0], initial.velocity = [-3.0] }
spring.rod = { ends = ["bob", "ground"], axis = [1.0], stiffness = 200.0 }
time = { end = 0.6, step = "0.1 ms", scheme.newmark = {} }
[stop.pad]
ends = ["ram", "ground"]
axis = [-1.0]
gap = 0.0
crush = "permanent"
curve = [{ penetration = 0.1, force = 20.0 }, { penetration = 1.1, force = 40.0 }]
[level.pads]
contacts = ["pad"]
allowable = { stroke = 1.0, crush = 0.5 }
[output.allowable]
spring.rod = { force = 90.0, stroke = 0.15 }
"#;

#[test]
fn margins_of_stroke_crush_and_springs_are_those_of_energies() {
    let summary = run(MASSES).unwrap();
    let near = |margin: &Margin, found: f64| {
        // peaks of a step: a quarter of the square of its phase, and the order of the scheme
        assert!(
            (margin.found / found - 1.0).abs() < 1e-4,
            "{margin:?} {found}"
        );
        let left = margin.allowable / margin.found - 1.0;
        assert_eq!(margin.margin, Some(left));
    };
    // ½ m v² = 9 J: 1 J to 0.1 m, and 20 x + 10 x² J on x more; what comes back is the force over the first 200 N/m
    let x = (720_f64.sqrt() - 20.0) / 20.0;
    let level = &summary.levels["pads"];
    near(level.stroke_margin.as_ref().unwrap(), 0.1 + x);
    near(level.crush_margin.as_ref().unwrap(), x - 0.1 * x);
    // v √(m/k) = 0.3 m, v √(k m) = 60 N
    let [force, stroke] = &summary.allowables[..] else {
        panic!("{:?}", summary.allowables);
    };
    near(&force.margin, 60.0);
    near(&stroke.margin, 0.3);
    assert!(stroke.margin.margin.unwrap() < 0.0);
}

#[test]
fn allowables_of_what_is_not_there_are_met_with_what_is() {
    for (allowed, key) in [
        ("body.bat.stress = 1.0", "output.allowable.body.bat"),
        (
            "support.clamb.force = 1.0",
            "output.allowable.support.clamb",
        ),
        ("spring.rod.force = 1.0", "output.allowable.spring.rod"),
    ] {
        let problems = run(&format!("{BAR}output.allowable = {{ {allowed} }}")).unwrap_err();
        assert_eq!(problems[0].path, key);
    }
}
