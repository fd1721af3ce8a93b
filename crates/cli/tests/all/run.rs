//! `run`: what it leaves, its exit codes, and what a failure leaves.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::commands::{carom, project, text};

fn case(name: &str, work: &Path) {
    fs::copy(
        project().join("cases").join(name).join("case.toml"),
        work.join("case.toml"),
    )
    .unwrap();
}

fn summary(work: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(work.join("case.carom/summary.json")).unwrap()).unwrap()
}

/// Rows of the histories, each as long as the header.
fn rows(work: &Path) -> usize {
    let histories = fs::read_to_string(work.join("case.carom/histories.csv")).unwrap();
    let columns = histories.lines().next().unwrap().split(',').count();
    assert!(histories.ends_with('\n'), "the last row is whole");
    histories
        .lines()
        .for_each(|line| assert_eq!(line.split(',').count(), columns));
    histories.lines().count() - 1
}

#[test]
fn main_job_leaves_its_results_and_agrees_with_the_exact_solution() {
    let work = tempfile::tempdir().unwrap();
    case("two-bars", work.path());
    let output = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let results = work.path().join("case.carom");
    for name in [
        "report.html",
        "impacts.csv",
        "fields.pvd",
        "case.toml",
        "checkpoints/last.state",
    ] {
        assert!(results.join(name).is_file(), "{name}");
    }
    assert!(fs::read_dir(results.join("plots")).unwrap().count() >= 2);
    let summary = summary(work.path());
    assert_eq!(summary["verdict"]["grade"], "good");
    // Z v0 / 2 with Z = A sqrt(E rho): the front rises over some steps, so the mean over the contact is a little less
    let exact = 0.5 * 645e-6 * (207e9_f64 * 7844.0).sqrt() * 5.1359;
    let mean = summary["contacts"]["shock"]["mean_force"].as_f64().unwrap();
    assert!((mean / exact - 1.0).abs() < 0.02, "{mean} {exact}");
    assert_eq!(
        rows(work.path()) as u64,
        summary["time"]["steps"].as_u64().unwrap() + 1
    );
    assert_eq!(
        summary["counts"]["factorisations"], 2,
        "one for each bar, for the whole run"
    );
}

/// The wave crosses the tie of two meshes that do not match: contact from 20 to 100 us, 2 m v0 = 128 N s. Steps close the contact within one of
/// 0.18 us; the end of the contact is smeared over some cells of 1 mm, 0.2 us each; the impulse is that force over this time, 1 %.
#[test]
fn a_bar_of_tied_halves_meets_the_wall_as_one() {
    let work = tempfile::tempdir().unwrap();
    case("tied-bar", work.path());
    let mesh = project().join("cases/tied-bar/bar.msh");
    fs::copy(mesh, work.path().join("bar.msh")).unwrap();
    let output = carom(work.path(), &["run", "case.toml", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let summary = summary(work.path());
    let of = |key: &str| summary["contacts"]["wall"][key].as_f64().unwrap();
    assert!((of("first_closing") - 20e-6).abs() < 0.2e-6);
    assert!((of("last_release") - 100e-6).abs() < 1e-6);
    assert!((of("impulse") - 128.0).abs() < 1.28);
    assert_eq!(
        summary["timings"]["factorisation"].as_f64(),
        Some(0.0),
        "in one pass"
    );
}

#[test]
fn a_file_where_the_folder_should_be_is_a_failure_with_its_cause() {
    let work = tempfile::tempdir().unwrap();
    case("two-bars", work.path());
    fs::write(work.path().join("case.carom"), "mine").unwrap();
    let output = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(text(&output).contains("case.carom"), "{}", text(&output));
    assert_eq!(
        fs::read_to_string(work.path().join("case.carom")).unwrap(),
        "mine"
    );
}

#[test]
fn a_full_disk_ends_the_run_with_its_cause_and_leaves_whole_rows() {
    let work = tempfile::tempdir().unwrap();
    case("two-bars", work.path());
    // a limit on the size of files stands for a full disk; the shell ignores the signal that comes with it
    let script = format!(
        "trap '' XFSZ; ulimit -f 100; exec '{}' run case.toml",
        env!("CARGO_BIN_EXE_carom")
    );
    let output = Command::new("bash")
        .args(["-c", &script])
        .current_dir(work.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", text(&output));
    assert!(text(&output).contains("histories.csv"), "{}", text(&output));
    let rows = rows(work.path());
    assert!(rows > 10, "{rows} rows before the disk was full");
    assert_eq!(summary(work.path())["verdict"]["grade"], "bad");
}

#[test]
fn an_interrupted_run_leaves_a_summary_that_says_so() {
    let work = tempfile::tempdir().unwrap();
    case("two-bars", work.path());
    let mut child = Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(["run", "case.toml", "--set", "time.end=10.0"])
        .current_dir(work.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let histories = work.path().join("case.carom/histories.csv");
    let begin = Instant::now();
    while fs::metadata(&histories).map_or(0, |data| data.len()) < 100_000 {
        assert!(
            begin.elapsed() < Duration::from_secs(60),
            "the run writes as it goes"
        );
        std::thread::sleep(Duration::from_millis(10));
    }
    Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(rows(work.path()) > 10);
    let verdict = summary(work.path())["verdict"].clone();
    assert_eq!(verdict["grade"], "bad");
    assert!(
        verdict["unfinished"]
            .as_str()
            .unwrap()
            .contains("interrupted"),
        "{verdict}"
    );
}

#[test]
fn a_contact_problem_without_solution_ends_the_run_and_is_kept() {
    let work = tempfile::tempdir().unwrap();
    case("two-bars", work.path());
    let file = work.path().join("case.toml");
    let text = fs::read_to_string(&file).unwrap();
    // the rows of what the case must give name numbers of the exact solution
    let text = text.split("\n[expect").next().unwrap();
    // the same contact from its other side too: the forces of the two cannot be told apart
    let (start, end) = (
        text.find("[contact.shock]").unwrap(),
        text.find("[time]").unwrap(),
    );
    let twice = text[start..end]
        .replace("shock", "again")
        .replace("secondary", "third")
        .replace("primary", "secondary")
        .replace("third", "primary");
    let text = text
        .replace("[time]", &format!("{twice}[time]"))
        .replace("[reference.two-bars]", "");
    fs::write(&file, text).unwrap();
    let output = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(
        output.status.code(),
        Some(3),
        "{}",
        crate::commands::text(&output)
    );
    assert!(
        crate::commands::text(&output).contains("singular"),
        "{}",
        crate::commands::text(&output)
    );
    let kept = fs::read(work.path().join("case.carom/interface-1.json")).unwrap();
    let problem: serde_json::Value = serde_json::from_slice(&kept).unwrap();
    assert_eq!(problem["compliance"].as_array().unwrap().len(), 4);
    assert_eq!(summary(work.path())["verdict"]["grade"], "bad");
    assert!(
        work.path()
            .join("case.carom/checkpoints/last.state")
            .is_file()
    );
}

#[test]
fn an_adaptive_step_that_cannot_go_on_ends_the_run_with_its_cause_and_what_was_computed() {
    let work = tempfile::tempdir().unwrap();
    case("two-bars-newmark", work.path());
    // the trapezoid with the displacement law makes energy in contact, however small the step
    let step = "time.step={ adaptive = { largest = { courant = 0.5 } } }";
    let trapezoid = "time.scheme.newmark={ beta = 0.25, gamma = 0.5 }";
    let set = ["run", "case.toml", "--set", step, "--set", trapezoid];
    let output = carom(work.path(), &set);
    assert_eq!(output.status.code(), Some(3), "{}", text(&output));
    assert!(
        text(&output).contains("the energy grows without a load"),
        "{}",
        text(&output)
    );
    let results = work.path().join("case.carom");
    for name in ["report.html", "checkpoints/last.state", "plots/energy.svg"] {
        assert!(results.join(name).is_file(), "{name}");
    }
    let summary = summary(work.path());
    let time = &summary["time"];
    // the initial state has a row too
    assert_eq!(
        rows(work.path()) as u64,
        time["steps"].as_u64().unwrap() + 1
    );
    assert!(time["rejected"]["energy_growth"].as_u64().unwrap() > 0);
    assert!(time["end"].as_f64().unwrap() < 5.8e-3);
    let verdict = &summary["verdict"];
    assert_eq!(verdict["grade"], "bad");
    let reason = verdict["unfinished"].as_str().unwrap();
    assert!(
        reason.contains("the energy grows without a load"),
        "{reason}"
    );
}

/// A block under its weight on a plane, static; `load` pushes its left side.
fn lying(load: &str) -> String {
    format!(
        r#"
carom = 1
[mesh]
generate.block.rectangle = {{ origin = [0.0, 0.0], size = [1.0, 1.0], elements = [2, 2] }}
[material.rubber]
density = 1000.0
neo-hooke = {{ young = "1 MPa", poisson = 0.3 }}
[body.block]
region = "block"
material = "rubber"
section.plane-strain = {{ thickness = 1.0 }}
[load.weight]
acceleration = [0.0, -9.81]
[load.push]
on = "block.left"
traction = {load}
[contact.ground]
secondary = "block.bottom"
obstacle.plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}
law.displacement = {{}}
[time]
static = {{ end = "1 s", steps = 4 }}
end = "1 s"
"#
    )
}

#[test]
fn a_static_load_that_no_contact_takes_ends_the_run_with_body_and_motion() {
    let cases = [
        ("[0.0, 0.0]", None),
        ("[1.0, 0.0]", Some("can move along x")),
        // less than its weight of 9810 N, more than half of it: about the right edge
        ("[0.0, 6e3]", Some("can turn about z")),
    ];
    for (load, motion) in cases {
        let work = tempfile::tempdir().unwrap();
        fs::write(work.path().join("case.toml"), lying(load)).unwrap();
        let output = carom(work.path(), &["run", "case.toml"]);
        let said = text(&output);
        match motion {
            None => assert_eq!(output.status.code(), Some(0), "{said}"),
            Some(motion) => {
                assert_eq!(output.status.code(), Some(3), "{said}");
                assert!(
                    said.contains("body 'block'") && said.contains(motion),
                    "{said}"
                );
            }
        }
    }
}

#[test]
fn the_log_tells_which_factor_an_iteration_takes_and_why() {
    let work = tempfile::tempdir().unwrap();
    case("spinning-bar", work.path());
    let mesh = project().join("cases/spinning-bar/bar-plane.msh");
    fs::copy(mesh, work.path().join("bar-plane.msh")).unwrap();
    let run = ["run", "case.toml", "--quiet", "--set", "time.end=0.2 s"];
    let told = |more: &[&str]| {
        let output = carom(work.path(), &[&run[..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let log = told(&["--log", "debug"]);
    assert!(
        log.contains("the factor is renewed: ") && log.contains(" with a new one"),
        "{log}"
    );
    assert_eq!(told(&[]), "");
}

/// A bar that runs against a support, with one cell of which explicit steps become too long: the run ends with the name of the cell that
/// the front has reached, its critical step above that of no step taken, and the state before it.
#[test]
fn an_explicit_run_whose_steps_become_unstable_ends_with_the_cell_and_the_last_good_state() {
    let work = tempfile::tempdir().unwrap();
    let file = r#"carom = 1
[mesh]
generate.bar.box = { origin = [0.0, 0.0, 0.0], size = [1.0, 0.1, 0.1], elements = [10, 1, 1] }
[material.rubber]
density = 1000.0
neo-hooke = { young = "10 MPa", poisson = 0.3 }
[body.bar]
region = "bar"
material = "rubber"
initial = { velocity = [-40.0, 0.0, 0.0] }
[support.end]
on = "bar.left"
fix = ["x", "y", "z"]
[time]
end = "10 ms"
step = { critical = 0.8 }
scheme.central-difference = {}
newton = { halvings = 0 }
"#;
    fs::write(work.path().join("case.toml"), file).unwrap();
    let output = carom(work.path(), &["run", "case.toml"]);
    let said = text(&output);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("cell 0 of block 0 in body 'bar'"), "{said}");
    let steps = summary(work.path())["time"]["steps"].as_u64().unwrap();
    assert!(
        steps > 0 && said.contains(&format!("step {}, t = ", steps + 1)),
        "{said}"
    );
    assert_eq!(rows(work.path()) as u64, steps + 1);
    let results = work.path().join("case.carom");
    let table = fs::read_to_string(results.join("histories.csv")).unwrap();
    let numbers = table.lines().skip(1).flat_map(|line| line.split(','));
    let given = numbers.filter(|cell| !cell.is_empty());
    assert!(
        given
            .map(|cell| cell.parse::<f64>().unwrap())
            .all(f64::is_finite)
    );
    assert!(results.join("checkpoints/last.state").is_file());
    // the same bar takes halves where it may
    let halved = [
        "run",
        "case.toml",
        "--set",
        "time.newton.halvings=8",
        "--set",
        "time.end='3 ms'",
    ];
    let output = carom(work.path(), &halved);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
}
