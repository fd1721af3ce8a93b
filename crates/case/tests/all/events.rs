//! Loads, preloads, moments of contacts and impacts that chatter, as histories and summary tell them.

use crate::verdict::result;

/// A block of 10 kg that stands on the ground by its weight of 100 N, in a static stage of a second, and is then pressed down by 100 N and
/// pushed by 100 N, both for two milliseconds as triangles.
const PRESSED: &str = r#"
carom = 1
mesh.generate.block.rectangle = { origin = [0.0, 0.0], size = [0.2, 0.1], elements = [8, 4] }
material.m = { density = 1000.0, elastic = { young = 1e7, poisson = 0.3 } }
body.block = { region = "block", material = "m", section.plane-strain.thickness = 0.5 }
contact.ground = { secondary = "block.bottom", obstacle.plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }, law.velocity = {}, moment-about = [0.1, 0.05] }
load.weight.acceleration = [0.0, -10.0]
load.press = { on = "block.top", traction = [0.0, -1e3], amplitude = [{ time = 1.0, factor = 0.0 }, { time = 1.001, factor = 1.0 }, { time = 1.002, factor = 0.0 }] }
load.push = { on = "block.right", traction = [-2e3, 0.0], amplitude = [{ time = 1.0, factor = 0.0 }, { time = 1.001, factor = 1.0 }, { time = 1.002, factor = 0.0 }] }
time = { end = 1.003, static = { end = 1.0, steps = 2 }, step = 1e-5, scheme.newmark = {} }
"#;

#[test]
fn the_impulse_of_a_load_is_that_of_its_history_and_the_momentum_that_it_gives() {
    let (summary, histories) = result(PRESSED);
    // the ground has no friction: what the push gives along x is all there is. Newmark's scheme takes loads by the trapezoidal rule,
    // and so does the impulse: they differ by what the iterations leave, 1e-10 of the largest force in each of 300 steps
    let push = &summary.loads["push"];
    assert!((push.impulse[0] + 0.1).abs() < 1e-12, "{push:?}");
    let given = histories["momentum.x_n_s"].last().unwrap();
    assert!((given - push.impulse[0]).abs() < 1e-8, "{given} {push:?}");
    assert_eq!(push.impulse[1], 0.0);
    let press = &summary.loads["press"];
    assert!((press.peak_force - 100.0).abs() < 1e-9, "{press:?}");
    assert!((press.time - 1.001).abs() < 1e-9, "{press:?}");
    let force = &histories["load.press.force_y_n"];
    let time = &histories["time_s"];
    for (force, time) in force.iter().zip(time) {
        let exact = (1.0 - (time - 1.001).abs() / 1e-3).max(0.0) * -100.0;
        assert!((force - exact).abs() < 1e-6, "{time}: {force} {exact}");
    }
    // gravity is no load of its own
    assert!(!histories.contains_key("load.weight.force_y_n"));
}

#[test]
fn the_preload_is_the_weight_and_clocks_start_with_the_dynamics() {
    let (summary, histories) = result(PRESSED);
    let ground = &summary.contacts["ground"];
    let preload = ground.preload.unwrap();
    // the iterations end at 1e-10 of the forces
    assert!((preload - 100.0).abs() < 1e-7, "{preload}");
    assert_eq!(ground.first_closing, Some(1.0));
    // the pressure is even and the weight central until the push: no moment about the mass centre
    let moment = &histories["contact.ground.moment_z_n_m"];
    assert!(moment[2].abs() < 1e-7, "{}", moment[2]);
    let peak = ground.peak_moment.unwrap();
    let largest = moment.iter().fold(0.0_f64, |m, value| m.max(value.abs()));
    assert_eq!(peak.magnitude, largest);
    assert_eq!(peak.about, [0.1, 0.05, 0.0]);
}

#[test]
fn a_pressure_acts_on_the_area_that_it_finds() {
    let text = PRESSED.replace("traction = [0.0, -1e3]", "pressure = 1e3");
    let (summary, _) = result(&text);
    let press = &summary.loads["press"];
    // 0.1 m² at its rest length; the block widens by some 1e-4 of it under ν σ/E = 1e-4 and 0.3 of that along
    assert!((press.peak_force - 100.0).abs() < 0.01, "{press:?}");
    assert_ne!(press.force[1], -100.0);
}

/// Impacts of a ball that bounces with e = 1/2 from 1 m/s under 10 m/s²: its flights last 0.1 s, 0.05 s, 0.025 s …
fn bounces(more: &str) -> usize {
    let text = format!(
        r#"
carom = 1
mass.ball = {{ mass = 2.0, at = [0.0], initial.velocity = [-1.0] }}
contact.floor = {{ secondary = "ball", obstacle.plane = {{ point = [0.0], normal = [1.0] }}, law.restitution = {{ coefficient = 0.5 }}{more} }}
load.weight.acceleration = [-10.0]
time = {{ end = 0.4, step = 1e-4, scheme.theta = {{}} }}
"#
    );
    result(&text).0.contacts["floor"].impacts
}

#[test]
fn flights_shorter_than_the_time_given_are_within_one_impact() {
    assert_eq!(bounces(", merge-within = \"60 ms\""), 2);
    assert_eq!(bounces(", merge-within = \"30 ms\""), 3);
    assert_eq!(bounces(", merge-within = \"15 ms\""), 4);
    // the first flight that is shorter than four steps of 0.1 ms is the tenth, 0.1 s / 2⁹ (0.2 ms): before it there are nine that last,
    // or eight if the ninth, 0.39 ms, is cut to three steps and an impact takes one
    let found = bounces("");
    assert!((8..=10).contains(&found), "{found}");
}

#[test]
fn a_point_out_of_the_plane_is_told() {
    let text = PRESSED.replace(
        "moment-about = [0.1, 0.05]",
        "moment-about = [0.1, 0.05, 1.0]",
    );
    let input = carom_case::Input::from_text("case.toml", &text, &[]);
    let (case, locator) = carom_case::parse(&input).unwrap();
    let problems = carom_case::build(&case, &locator, &input).err().unwrap();
    let told = problems[0].to_string();
    assert!(told.contains("contact.ground.moment-about"), "{told}");
    assert!(told.contains("beyond the 2 dimensions"), "{told}");
}

/// Two blocks in zones of which one takes half steps; the moment of their contact about `point`.
fn struck_in_zones(point: &str) -> [Vec<f64>; 3] {
    let text = format!(
        r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.0], size = [0.2, 0.1], elements = [8, 4] }}
mesh.generate.b.rectangle = {{ origin = [0.2001, 0.02], size = [0.2, 0.1], elements = [8, 4] }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e7, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 0.5, initial.velocity = [1.0, 0.0] }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 0.5 }}
contact.c = {{ secondary = "a.right", primary = "b.left", law.velocity = {{}}, moment-about = {point} }}
zone.a = {{ bodies = ["a"], scheme.theta = {{}}, substeps = {{ b = 2 }} }}
zone.b = {{ bodies = ["b"], scheme.theta = {{}} }}
time = {{ end = 2e-3, step = 2e-5 }}
"#
    );
    let (_, mut histories) = result(&text);
    ["moment_z_n_m", "resultant_x_n", "resultant_y_n"]
        .map(|name| histories.remove(&format!("contact.c.{name}")).unwrap())
}

/// A moment about another point differs by that of the resultant, here as in one system: to the rounding of two sums of some ten terms.
#[test]
fn moments_between_zones_move_with_the_point_as_the_resultant_says() {
    let [one, x, y] = struck_in_zones("[0.1, 0.05]");
    let [other, again, _] = struck_in_zones("[0.13, -0.02]");
    assert_eq!(x, again);
    let largest = one.iter().fold(0.0_f64, |m, moment| m.max(moment.abs()));
    assert!(largest > 0.0);
    for k in 0..one.len() {
        let moved = one[k] - (0.03 * y[k] + 0.07 * x[k]);
        assert!(
            (other[k] - moved).abs() < 1e-12 * largest,
            "{k}: {} {moved}",
            other[k]
        );
    }
    assert!(
        one.iter()
            .zip(&other)
            .any(|(one, other)| (one - other).abs() > 0.1 * largest)
    );
}
