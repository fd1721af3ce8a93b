//! What the check says of times, steps, normals, probes and contacts.

use std::path::Path;

use carom_case::{Built, Input, Problem, build, facts, parse};
use carom_contact::Target;

fn built(text: &str) -> Result<Built, Vec<Problem>> {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input)?;
    build(&case, &locator, &input)
}

/// What the check says of the contact `stop`.
fn stop(text: &str) -> String {
    let facts = facts(&built(text).unwrap());
    let stop = facts.into_iter().find(|fact| fact.name == "contact stop");
    stop.unwrap().value
}

/// A rigid mass 2 m above a stop.
fn mass(rest: &str) -> String {
    format!(
        r#"
carom = 1
mesh.generate.mass.line = {{ from = [2.0], to = [3.0], elements = 2 }}
material.stiff = {{ density = 1.0, elastic = {{ young = 1.0e12, poisson = 0.0 }} }}
contact.stop = {{ secondary = "mass.left", obstacle.plane = {{ point = [0.0], normal = [1.0] }}, law.penalty.stiffness = 100.0 }}
time = {{ end = 1.2, step = 1.0e-3, scheme.newmark = {{}} }}
{rest}
"#
    )
}

fn body(velocity: f64) -> String {
    format!(
        r#"body.mass = {{ region = "mass", material = "stiff", section.bar.area = 1.0, initial.velocity = [{velocity}] }}"#
    )
}

#[test]
fn the_first_impact_is_that_of_a_fall_with_gravity() {
    let fall = |velocity: f64, gravity: f64| {
        stop(&mass(&format!(
            "{}\nload.weight.acceleration = [{gravity}]",
            body(velocity)
        )))
    };
    // 2 = t + 5 t²: t = (√41 - 1)/10
    let expected = (41_f64.sqrt() - 1.0) / 10.0;
    let told = fall(-1.0, -10.0);
    assert!(
        told.contains(&format!("first possible impact at {expected:.4e} s")),
        "{told}"
    );
    // from rest: 2 = 5 t²
    let told = fall(0.0, -10.0);
    let expected = 0.4_f64.sqrt();
    assert!(
        told.contains(&format!("first possible impact at {expected:.4e} s")),
        "{told}"
    );
    // thrown up: 2 = -3 t + 5 t²
    let told = fall(3.0, -10.0);
    assert!(
        told.contains("first possible impact at 1.0000e0 s"),
        "{told}"
    );
    // it turns 1/8 m away from the stop
    let told = fall(-2.5, 5.0 / 3.0);
    assert!(told.contains("nothing approaches"), "{told}");
    let told = fall(0.0, -1.0);
    assert!(told.contains("no impact before the end"), "{told}");
}

/// Two bars of 0.1638 litre of steel, 7844 kg/m³, meet at the start.
#[test]
fn size_mass_waves_and_what_meets_first_are_told_in_words() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let input = Input::read(&cases.join("two-bars/case.toml"), &[]).unwrap();
    let (case, locator) = parse(&input).unwrap();
    let told = facts(&build(&case, &locator, &input).unwrap());
    let fact = |name: &str| {
        let found = told.iter().find(|fact| fact.name == name);
        found.map_or("", |fact| &fact.value).to_owned()
    };
    assert_eq!(fact("size"), "508 mm");
    assert!(
        fact("mass").starts_with("2.570 kg in all"),
        "{}",
        fact("mass")
    );
    assert_eq!(fact("waves"), "5137 m/s");
    assert_eq!(
        fact("in a step"),
        "a wave goes through 0.500 of the smallest elements"
    );
    let first = "`striker` and `target` (contact `shock`) at the start, which close with 5.14 m/s";
    assert_eq!(fact("meets first"), first);
    // a density in t/mm^3 with a stiffness in Pa
    let told =
        facts(&built(&mass(&body(-1.0)).replace("density = 1.0", "density = 1e-9")).unwrap());
    let waves = told.iter().find(|fact| fact.name == "waves").unwrap();
    assert!(waves.value.contains("are the units"), "{waves:?}");
}

#[test]
fn the_largest_value_of_a_record_is_told_with_its_unit_and_its_steps() {
    let shaken = format!(
        "{}\nload.ground.base-acceleration.x = \"quake\"\n[signal.quake]\nacceleration.points = [{}]",
        body(0.0),
        r#"{ time = 0.0, acceleration = 0.0 }, { time = 0.1, acceleration = "-0.3 gn" }, { time = 0.2, acceleration = 0.0 }"#
    );
    let told = facts(&built(&mass(&shaken)).unwrap());
    let record = told
        .iter()
        .find(|fact| fact.name == "signal quake")
        .unwrap();
    let expected = "acceleration, largest −2.94 m/s^2, −0.300 gn at 100 ms; 3 points every 100 ms from 0 s to 200 ms";
    assert_eq!(record.value, expected);
}

#[test]
fn an_acceleration_in_grams_is_met_with_the_standard_gravity() {
    let heavy = format!("{}\nload.weight.acceleration = [\"1 g\"]", body(0.0));
    let problems = built(&mass(&heavy)).unwrap_err();
    assert_eq!(problems[0].nearest.as_deref(), Some("gn"), "{problems:?}");
}

#[test]
fn gravity_moves_no_body_that_is_held() {
    let held = format!(
        "{}\nload.weight.acceleration = [-10.0]\nsupport.top = {{ on = \"mass.right\", fix = [\"x\"] }}",
        body(0.0)
    );
    assert!(stop(&mass(&held)).contains("nothing approaches"));
}

#[test]
fn bodies_that_move_together_never_meet() {
    let told = stop(
        r#"
carom = 1
mesh.generate.a.rectangle = { origin = [0.0, 0.0], size = [1.0, 1.0], elements = [3, 3] }
mesh.generate.b.rectangle = { origin = [0.1, 1.1], size = [0.7, 1.0], elements = [2, 2] }
material.m = { density = 1000.0, elastic = { young = "1 MPa", poisson = 0.3 } }
body.a = { region = "a", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [0.3, -0.7] }
body.b = { region = "b", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [0.3, -0.7] }
contact.stop = { secondary = "a.top", primary = "b.bottom", law.velocity = {} }
time = { end = 1.0, step = 1.0e-3, scheme.theta = {} }
"#,
    );
    assert!(told.contains("nothing approaches"), "{told}");
}

#[test]
fn a_scheme_for_all_is_asked_for_only_where_a_zone_has_none() {
    let zones = |scheme: &str, far: &str| {
        let text = format!(
            r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.0], size = [1.0, 1.0], elements = [3, 3] }}
mesh.generate.b.rectangle = {{ origin = [0.0, 1.0], size = [1.0, 1.0], elements = [2, 2] }}
material.m = {{ density = 1000.0, elastic = {{ young = "1 MPa", poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 1.0 }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 1.0 }}
zone.i = {{ bodies = ["a"], scheme.theta = {{}} }}
zone.o = {{ bodies = ["b"]{far} }}
interface.t = {{ inner = "a", outer = "b", surfaces = ["a.top", "b.bottom"] }}
time = {{ end = 1.0, step = 1.0e-3{scheme} }}
"#
        );
        built(&text).map(|built| built.warnings)
    };
    let own = ", scheme.newmark = {}";
    assert_eq!(zones("", own), Ok(Vec::new()));
    let problems = zones("", "").unwrap_err();
    assert_eq!(problems[0].message, "`scheme` is missing in `time`");
    assert!(
        problems[0]
            .accepted
            .contains(&"a scheme for each zone".to_string())
    );
    assert_eq!(zones(own, ""), Ok(Vec::new()));
    assert!(zones(own, own).unwrap()[0].contains("not used"));
}

#[test]
fn a_normal_has_a_direction_and_no_length() {
    let plane = |length: &str| {
        let text = mass(&body(0.0)).replace("normal = [1.0]", &format!("normal = [{length}]"));
        match &built(&text).unwrap().system.contacts[0].target {
            Target::Rigid(obstacle) => obstacle.clone(),
            Target::Surface(_) => panic!("a surface"),
        }
    };
    for length in ["1e154", "1e200", "1.7e308", "1e-154", "1e-200", "5e-324"] {
        assert_eq!(plane(length), plane("1.0"), "{length}");
    }
}

#[test]
fn a_probe_gives_the_mean_over_its_group() {
    let case = |section: &str| {
        format!(
            r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.0], size = [3.0, 1.0], elements = [3, 2] }}
material.m = {{ density = 1000.0, elastic = {{ young = "1 MPa", poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.{section} }}
probe.line = {{ on = "a.bottom", record = ["displacement"] }}
probe.area = {{ on = "a", record = ["displacement"] }}
probe.axis = {{ on = "a.left", record = ["displacement"] }}
time = {{ end = 1.0, step = 1.0e-3, scheme.theta = {{}} }}
"#
        )
    };
    // the mean of a field that is linear in x and y, which the elements hold exactly
    let means = |section: &str| {
        let built = built(&case(section)).unwrap();
        let mean = |name: &str| {
            let probe = built.probes.iter().find(|probe| probe.name == name);
            let nodes = &probe.unwrap().nodes;
            let total: f64 = nodes.iter().map(|(_, weight)| weight).sum();
            let field = |node: u32| {
                let x = built.system.mesh.nodes[node as usize];
                x[0] + 10.0 * x[1]
            };
            let sum = nodes.iter().map(|&(node, weight)| weight * field(node));
            sum.sum::<f64>() / total
        };
        ["line", "area", "axis"].map(mean)
    };
    let near = |found: [f64; 3], expected: [f64; 3]| {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    };
    near(means("plane-strain.thickness = 2.0"), [1.5, 6.5, 5.0]);
    // ∫ r 2πr dr / ∫ 2πr dr = 2 R/3; on the axis itself the mean along it
    near(means("axisymmetric = {}"), [2.0, 7.0, 5.0]);
    // a plain mean of nodes would say 3/2 of the first too, but not of a corner group
    let corner = built(&case("plane-strain.thickness = 2.0")).unwrap();
    let weights: Vec<f64> = corner.probes[2].nodes.iter().map(|node| node.1).collect();
    assert_eq!(weights.len(), 4);
    assert!((weights[0] / weights[1] - 0.5).abs() < 1e-15, "{weights:?}");
}

#[test]
fn a_critical_step_knows_the_damping() {
    let critical = |damping: &str, scheme: &str| {
        let text = format!(
            r#"
carom = 1
mesh.generate.bar.line = {{ from = [0.0], to = [1.0], elements = 1 }}
material.m = {{ density = 1.0, elastic = {{ young = 1.0, poisson = 0.0 }} }}
body.bar = {{ region = "bar", material = "m", section.bar.area = 1.0, damping = {{ {damping} }} }}
time = {{ end = 1.0, step = {{ critical = 1.0 }}, scheme.{scheme} }}
"#
        );
        built(&text).unwrap().system.dt
    };
    let central = |damping: &str| critical(damping, "central-difference = {}");
    // two masses of 1/2 kg on a spring of 1 N/m: ω = 2 rad/s, and dt = 2/ω (√(1 + ξ²) - ξ) with ξ = (α/ω + β ω)/2
    for (damping, ratio) in [
        ("mass = 0.0", 0.0),
        ("mass = 2.0", 0.5),
        ("stiffness = 1.0", 1.0),
        ("mass = 2.0, stiffness = 1.0", 1.5),
    ] {
        let ratio: f64 = ratio;
        let expected = (1.0 + ratio * ratio).sqrt() - ratio;
        assert!(
            (central(damping) / expected - 1.0).abs() < 1e-12,
            "{damping}"
        );
    }
    // (2φ - 1) ω² dt² + 2 c dt = 4 with φ = 1.5: 8 dt² + 8 dt = 4
    let damped = critical("stiffness = 1.0", "tchamwa-wielgosz = { phi = 1.5 }");
    assert!(
        (damped / (0.5 * (3_f64.sqrt() - 1.0)) - 1.0).abs() < 1e-12,
        "{damped}"
    );
}

#[test]
fn a_step_above_the_critical_one_is_told_with_digits_that_differ() {
    let text = |step: f64| {
        format!(
            r#"
carom = 1
mesh.generate.bar.line = {{ from = [0.0], to = [1.0], elements = 3 }}
material.m = {{ density = 7.0, elastic = {{ young = 11.0, poisson = 0.0 }} }}
body.bar = {{ region = "bar", material = "m", section.bar.area = 1.0 }}
time = {{ end = 10.0, step = {step:?}, scheme.central-difference = {{}} }}
"#
        )
    };
    let critical = built(&text(0.1)).unwrap().system.critical_step();
    assert!(built(&text(critical)).is_ok());
    for step in [critical.next_up(), critical * (1.0 + 1e-9), critical * 1.1] {
        let problems = built(&text(step)).unwrap_err();
        let number = |text: &str| {
            let words = text.split(' ').find_map(|word| word.parse::<f64>().ok());
            words.unwrap()
        };
        let (found, most) = (
            problems[0].found.as_deref().unwrap(),
            &problems[0].accepted[0],
        );
        assert!(number(found) > number(most), "{found} {most}");
        assert!(number(most) <= critical && number(most) > 0.99 * critical);
        // what is accepted is accepted
        assert!(built(&text(number(most))).is_ok());
    }
}

/// The picture of a model says where supports, loads, springs, masses and contacts are, by name.
#[test]
fn the_picture_of_a_model_names_what_acts_on_it() {
    let text = r#"
carom = 1
mesh.generate.low.rectangle = { origin = [0.0, 0.0], size = [1.0, 0.5], elements = [4, 2] }
mesh.generate.high.rectangle = { origin = [0.2, 0.6], size = [0.6, 0.5], elements = [3, 2] }
material.m = { density = 1000.0, elastic = { young = 1e7, poisson = 0.3 } }
body.low = { region = "low", material = "m", section.plane-strain.thickness = 1.0 }
body.high = { region = "high", material = "m", section.plane-strain.thickness = 1.0 }
support.floor = { on = "low.bottom", fix = ["x", "y"] }
load.press = { on = "high.top", traction = [0.0, -1e4] }
mass.bob = { mass = 2.0, at = [1.5, 0.5] }
spring.tether = { ends = ["bob", "ground"], stiffness = 1e4 }
contact.joint = { secondary = "high.bottom", primary = "low.top", law.velocity = {} }
time = { end = 1e-3, step = 1e-5, scheme.theta = {} }
"#;
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    let picture = carom_output::model_picture(&built.system).unwrap().unwrap();
    for label in [
        "low",
        "high",
        "support floor",
        "load press",
        "mass bob",
        "spring tether",
        "contact joint",
    ] {
        assert!(picture.contains(&format!(">{label}</text>")), "{label}");
    }
    // five nodes of the floor
    assert_eq!(picture.matches("l-3.5,6h7z").count(), 5);
}
