//! What acts on a model is in its report, by name.

use carom_case::{Input, build, parse, run};
use serde_json::Value;

use carom_dynamics::Silent;

/// A strip of four cells above a bar, held on the left and pulled down on the right, beside two masses that a spring joins.
const MODEL: &str = r#"
carom = 1
mesh.generate.strip.rectangle = { origin = [0.0, 0.1], size = [4.0, 1.0], elements = [4, 1] }
mesh.generate.floor.rectangle = { origin = [0.0, -1.0], size = [4.0, 1.0], elements = [2, 1] }
material.m = { density = 1000.0, elastic = { young = 1e9, poisson = 0.3 } }
body.strip = { region = "strip", material = "m", section.plane-strain.thickness = 1.0 }
body.floor = { region = "floor", material = "m", section.plane-strain.thickness = 1.0 }
support.wall = { on = "strip.left", fix = ["x", "y"] }
support.ground = { on = "floor.bottom", fix = ["x", "y"] }
load.push = { on = "strip.right", force = [0.0, -1000.0] }
mass.weight = { mass = 1.0, at = [5.0, 0.5] }
mass.weights = { mass = 1.0, at = [6.0, 0.5] }
spring.hook = { ends = ["weight", "weights"], axis = [1.0, 0.0], stiffness = 1e5 }
contact.gap = { secondary = "strip.bottom", primary = "floor.top", law.velocity = {} }
time = { end = 1e-4, step = 1e-5, scheme.theta.theta = 0.55 }
"#;

#[test]
fn the_model_of_the_report_has_names_of_what_acts_on_it() {
    let input = Input::from_text("case.toml", MODEL, &[]);
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("results");
    let all = (&input, &case, &built);
    run(all, folder.clone(), &mut Silent, &|| false).unwrap();
    let html = std::fs::read_to_string(folder.join("report.html")).unwrap();
    let (_, rest) = html.split_once("<script id=\"carom-page\"").unwrap();
    let head = rest.split_once('>').unwrap().1;
    let head: Value = serde_json::from_str(head.split_once("</script>").unwrap().0).unwrap();
    let signs = head["model"]["signs"].as_array().unwrap().iter();
    let mut found: Vec<_> = signs
        .map(|sign| {
            let count = |key: &str| sign[key]["count"].as_u64().unwrap();
            let text = |key: &str| sign[key].as_str().unwrap();
            (text("what"), text("label"), count("nodes"), count("ways"))
        })
        .collect();
    found.sort_unstable();
    assert_eq!(
        found,
        [
            ("body", "floor", 6, 0),
            ("body", "strip", 10, 0),
            ("contact", "contact gap", 5, 0),
            ("link", "spring hook", 2, 0),
            ("load", "load push", 2, 6),
            ("mass", "mass weight", 1, 0),
            ("mass", "mass weights", 1, 0),
            ("support", "support ground", 3, 0),
            ("support", "support wall", 2, 0),
        ]
    );
}
