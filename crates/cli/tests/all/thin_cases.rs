//! The cases with thin bodies and solids run: a few steps of each, with balances that close.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::commands::{carom, project, text};

/// Runs a case of the project up to a time, with other keys set too; the summary.
fn run_until(name: &str, end: &str, set: &[&str]) -> serde_json::Value {
    let work = tempfile::tempdir().unwrap();
    let folder = project().join("cases").join(name);
    for entry in fs::read_dir(&folder).unwrap().map(Result::unwrap) {
        if entry.path().is_file() {
            fs::copy(entry.path(), work.path().join(entry.file_name())).unwrap();
        }
    }
    let end = format!("time.end={end}");
    let set = set.iter().copied().chain([&end[..]]);
    let set = set.flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> = ["run", "case.toml"].into_iter().chain(set).collect();
    let output = carom(work.path(), &arguments);
    assert_eq!(output.status.code(), Some(0), "{name}: {}", text(&output));
    summary(work.path())
}

fn summary(work: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(work.join("case.carom/summary.json")).unwrap()).unwrap()
}

/// Energy, relative, to the tolerance of the iterations; momentum likewise.
fn assert_balanced(summary: &serde_json::Value, name: &str) {
    for quantity in ["energy", "momentum"] {
        let residual = summary[quantity]["relative_residual"].as_f64().unwrap();
        assert!(residual < 1e-8, "{name}: {quantity}: {residual}");
    }
}

#[test]
fn a_rod_between_solid_leaves_runs() {
    assert_balanced(&run_until("rod-arlequin", "150 us", &[]), "rod-arlequin");
}

#[test]
fn a_tube_in_the_hole_of_its_plate_runs() {
    // its harmonics are multiples of 5 kHz: the band holds the second, with 20 steps a period
    let fast =
        r#"random.spectrum=[{frequency="6 kHz",density=30.0},{frequency="10 kHz",density=30.0}]"#;
    let [x, y] = ["x", "y"].map(|axis| format!("load.turbulence-{axis}.{fast}"));
    let summary = run_until("tube-on-support", "200 us", &["time.step=5 us", &x, &y]);
    assert!(summary["energy"]["works"]["loads"].as_f64().unwrap() > 0.0);
    assert_balanced(&summary, "tube-on-support");
}

#[test]
fn a_bar_of_solid_and_beam_turns_in_unequal_steps() {
    let summary = run_until("turning-bar", "50 ms", &[]);
    assert_balanced(&summary, "turning-bar");
    // the zones keep the impulse of the push, 200 kPa of 0.1 m x 10 mm that grow over 0.1 s: 2.5 N s
    let momentum = summary["momentum"]["final"][1].as_f64().unwrap();
    assert!((momentum - 2.5).abs() < 1e-6, "{momentum}");
}

#[test]
fn a_box_of_shells_falls() {
    assert_balanced(&run_until("dropped-box", "20 us", &[]), "dropped-box");
}

#[test]
fn three_blocks_land_in_a_tray() {
    let summary = run_until("pile", "15 ms", &[]);
    assert_balanced(&summary, "pile");
    let contacts = summary["contacts"].as_object().unwrap();
    assert_eq!(contacts.len(), 10);
    // the brick falls 4 mm with 1 m/s and more, the hexagon 12 mm behind it later
    let first = |name: &str| contacts[name]["first_closing"].as_f64();
    assert!((3.0e-3..5.0e-3).contains(&first("landing").unwrap()));
    assert_eq!(first("all-brick-hexagon"), None);
    // two corners land within 15 ms, and each is one impact
    let impacts = contacts["landing"]["impacts"].as_u64().unwrap();
    assert!((1..=3).contains(&impacts), "{impacts}");
    let moment = contacts["landing"]["peak_moment"]["magnitude"]
        .as_f64()
        .unwrap();
    // the largest force, 0.2 to 0.3 kN, has an arm of at most half the diagonal, 65 mm
    let force = contacts["landing"]["peak_resultant"]["magnitude"]
        .as_f64()
        .unwrap();
    assert!(moment > 0.0 && moment < 0.075 * force, "{moment} {force}");
}

#[test]
fn strips_of_plies_and_taper_bend_as_beams() {
    let summary = run_until("shell-strips", "1.2 ms", &[]);
    assert_balanced(&summary, "shell-strips");
}

#[test]
fn a_sheet_of_one_point_shells_strikes_a_cylinder() {
    let summary = run_until("wrapped-sheet", "30 us", &[]);
    assert_balanced(&summary, "wrapped-sheet");
    // the first points touch after 0.1 mm at 20 m/s
    let impulse = summary["contacts"]["cylinder"]["impulse"].as_f64().unwrap();
    assert!(impulse > 0.0, "{impulse}");
}

/// Zener's largest force, of the equations in the README of the case, is 461 N in a quarter, at 91 μs; 10 % as there.
#[test]
fn a_plate_of_solid_and_shell_is_struck() {
    let summary = run_until("struck-plate", "0.11 ms", &[]);
    assert_balanced(&summary, "struck-plate");
    let force = summary["contacts"]["ball"]["peak_force"].as_f64().unwrap();
    assert!((force - 461.0).abs() < 46.1, "{force}");
}

#[test]
fn a_bar_of_solid_and_beam_is_struck() {
    let summary = run_until("beam-and-solid", "100 us", &[]);
    assert_balanced(&summary, "beam-and-solid");
    // a spring of 5 MN/m after 0.1 ms at 2 m/s: below k v t, above half of it
    let force = summary["contacts"]["head"]["peak_force"].as_f64().unwrap();
    assert!((500.0..1000.0).contains(&force), "{force}");
}

/// A free bar in the plane, a solid at finite strain and a beam with finite rotations, pushed aside at one end for 0.2 s.
const TURNING: &str = r#"
carom = 1

[mesh]
generate.solid.rectangle = { origin = [0.0, -0.05], size = [0.6, 0.1], elements = [12, 2] }
generate.beam.line = { from = [0.4, 0.0], to = [1.0, 0.0], elements = 6 }

[material.rubber]
density = "1000 kg/m^3"
neo-hooke = { young = "1 GPa", poisson = 0.0 }

[material.soft]
density = "1000 kg/m^3"
elastic = { young = "1 GPa", poisson = 0.0 }

[body.solid]
region = "solid"
material = "rubber"
section.plane-strain = { thickness = "10 mm" }

[body.beam]
region = "beam"
material = "soft"
section.beam = { shape.rectangle = { height = "100 mm", width = "10 mm" }, rotations = "finite" }

[arlequin.glue]
inner = "solid"
outer = "beam"

[zone.solid]
bodies = ["solid"]
scheme.energy-momentum = {}

[zone.beam]
bodies = ["beam"]
scheme.energy-momentum = {}

[load.push]
on = "solid.left"
traction = [0.0, "200 kPa"]
amplitude = [{ time = "0 s", factor = 0.0 }, { time = "0.1 s", factor = 1.0 }, { time = "0.2 s", factor = 0.0 }]

[probe.tip]
on = "beam.right"
record = ["displacement"]

[time]
end = "1 s"
step = "5 ms"
"#;

#[test]
fn a_bar_of_solid_and_beam_turns_over() {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("case.toml"), TURNING).unwrap();
    let output = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert_balanced(&summary(work.path()), "turning");
    let histories = fs::read_to_string(work.path().join("case.carom/histories.csv")).unwrap();
    let header: Vec<&str> = histories.lines().next().unwrap().split(',').collect();
    let place = header
        .iter()
        .position(|name| name.ends_with("tip.displacement_x_m"));
    let along = |line: &str| -> f64 {
        line.split(',')
            .nth(place.unwrap())
            .unwrap()
            .parse()
            .unwrap()
    };
    // an end of a bar of 1 m has gone the way of more than a quarter of a turn about its middle
    let least = histories.lines().skip(1).map(along).fold(0.0, f64::min);
    assert!(least < -0.5, "{least}");
}

/// Places of the end of the bar that turns over, by time in µs, with these schemes and this step.
fn turned_over(solid: &str, beam: &str, step: &str) -> BTreeMap<u64, [f64; 2]> {
    run_over((solid, 1), beam, step).0
}

/// The same with so many steps of the solid in one of the beam, and the summary.
fn run_over(
    (solid, substeps): (&str, u32),
    beam: &str,
    step: &str,
) -> (BTreeMap<u64, [f64; 2]>, serde_json::Value) {
    let set = [
        format!("zone.solid.scheme={solid}"),
        format!("zone.solid.substeps={substeps}"),
        format!("zone.beam.scheme={beam}"),
        format!("time.step={step}"),
    ];
    run_text(TURNING, &set)
}

/// Places of the end of the bar of a case with other keys set, and the summary.
fn run_text(case: &str, set: &[String]) -> (BTreeMap<u64, [f64; 2]>, serde_json::Value) {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("case.toml"), case).unwrap();
    let set = set.iter().flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> = ["run", "case.toml"].into_iter().chain(set).collect();
    let output = carom(work.path(), &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let summary = summary(work.path());
    assert_balanced(&summary, "two schemes");
    let histories = fs::read_to_string(work.path().join("case.carom/histories.csv")).unwrap();
    let mut lines = histories.lines().map(|line| line.split(','));
    let heads: Vec<&str> = lines.next().unwrap().collect();
    let column = |name: &str| heads.iter().position(|head| head.ends_with(name)).unwrap();
    let columns = ["time_s", "tip.displacement_x_m", "tip.displacement_y_m"].map(column);
    let row = |line: std::str::Split<char>| {
        let cells: Vec<&str> = line.collect();
        let [t, x, y] = columns.map(|k| cells[k].parse::<f64>().unwrap());
        ((1e6 * t).round() as u64, [x, y])
    };
    (lines.map(row).collect(), summary)
}

/// Velocity steps in the solid and displacement steps in the beam: with half the step a quarter of the error, of second order as each of both. One scheme at a quarter of
/// the step, whose own error is a sixteenth, is the standard. The ratio of errors is above 3 where the order is above 1.6; at the smaller step 2 % of the length, twice
/// the 1.2 % of one scheme.
#[test]
fn two_schemes_turn_over_as_one_does() {
    let newmark = "{newmark={}}";
    let standard = turned_over(newmark, newmark, "0.625e-3");
    let error = |step: &str| -> f64 {
        let run = turned_over("{theta={theta=0.5}}", newmark, step);
        distance(&run, &standard)
    };
    let [coarse, fine] = ["2.5e-3", "1.25e-3"].map(error);
    assert!(fine < 0.02 && coarse > 3.0 * fine, "{coarse} {fine}");
}

/// The bar of the case `turning-bar`, a run in one system being the standard: 1 % of the length at the outer step of the case, and a quarter with half the step, as both schemes are of
/// second order: above 3 where the order is above 1.6.
#[test]
fn a_bar_turns_over_in_two_steps_as_in_one() {
    let conserving = "{energy-momentum={}}";
    let standard = turned_over(conserving, conserving, "0.25e-3");
    let error = |step: &str| -> f64 {
        let (run, summary) = run_over((conserving, 4), "{newmark={}}", step);
        let [work, energy] = [
            &summary["energy"]["works"]["links"],
            &summary["energy"]["largest"],
        ];
        // the verdict looks at a gain of that size
        assert!(work.as_f64().unwrap().abs() < 1e-3 * energy.as_f64().unwrap());
        distance(&run, &standard)
    };
    let [coarse, fine] = ["2e-3", "1e-3"].map(error);
    assert!(fine < 0.01 && coarse > 3.0 * fine, "{coarse} {fine}");
}

/// The end of the beam on the face of the solid, in place of an overlap: the run in two steps against that in one system without zones.
#[test]
fn a_beam_on_the_face_of_a_solid_of_another_zone_turns_over() {
    let overlap = "[arlequin.glue]\ninner = \"solid\"\nouter = \"beam\"\n";
    let transition = "[transition.glue]\nend = \"beam.left\"\nface = \"solid.right\"\n";
    let on_face = TURNING
        .replace("from = [0.4, 0.0]", "from = [0.6, 0.0]")
        .replace("elements = 6", "elements = 4")
        .replace(overlap, transition);
    let zones = on_face.find("[zone.solid]").unwrap()..on_face.find("[load.push]").unwrap();
    let mut single = on_face.clone();
    single.replace_range(zones, "");
    let single = single.replace(
        "step = \"5 ms\"",
        "step = \"0.25 ms\"\nscheme.energy-momentum = {}",
    );
    let (standard, _) = run_text(&single, &[]);
    let set = [
        "zone.solid.substeps=4",
        "zone.beam.scheme={newmark={}}",
        "time.step=1e-3",
    ];
    let (run, _) = run_text(&on_face, &set.map(str::to_owned));
    let apart = distance(&run, &standard);
    assert!(apart < 0.01, "{apart}");
}

/// Largest distance at common instants, m.
fn distance(run: &BTreeMap<u64, [f64; 2]>, standard: &BTreeMap<u64, [f64; 2]>) -> f64 {
    let both = run.iter().filter_map(|(t, x)| Some((x, standard.get(t)?)));
    let apart = both.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
    apart.fold(0.0, f64::max)
}
