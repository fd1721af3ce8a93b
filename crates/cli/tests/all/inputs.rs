//! Files that are none, and what the tables of a run hold where there is nothing.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::commands::{carom, text};
use crate::streams::BAR;

#[test]
#[cfg(target_os = "linux")]
fn a_pipe_or_a_device_is_no_input_and_does_not_hang() {
    let work = tempfile::tempdir().unwrap();
    let pipe = work.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let mesh = |file: &str| {
        let case = BAR.replace(
            "generate.bar.line = { from = [0.0], to = [1.0], elements = 8 }",
            &format!("file = \"{file}\""),
        );
        fs::write(work.path().join("case.toml"), case).unwrap();
        "case.toml"
    };
    std::os::unix::fs::symlink("/dev/zero", work.path().join("zero.msh")).unwrap();
    fs::rename(&pipe, work.path().join("pipe.msh")).unwrap();
    for file in ["pipe.msh", "/dev/zero"] {
        let output = carom(work.path(), &["check", file]);
        assert_eq!(output.status.code(), Some(2));
        assert!(
            text(&output).contains("not a regular file"),
            "{}",
            text(&output)
        );
    }
    for file in ["pipe.msh", "zero.msh"] {
        let output = carom(work.path(), &["check", mesh(file)]);
        assert_eq!(output.status.code(), Some(2));
        assert!(
            text(&output).contains("not a regular file"),
            "{}",
            text(&output)
        );
    }
}

#[test]
fn a_case_file_beyond_its_bound_is_named() {
    let work = tempfile::tempdir().unwrap();
    let file = fs::File::create(work.path().join("case.toml")).unwrap();
    file.set_len((16 << 20) + 1).unwrap();
    let output = carom(work.path(), &["check", "case.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        text(&output).contains("more than 16 MiB"),
        "{}",
        text(&output)
    );
}

/// A case file that is not there: the one that was meant is told where there is one with nearly this name, in the folder or in one with nearly its name.
/// A block of eighty million nodes where the process may have 4 GB.
#[test]
#[cfg(target_os = "linux")]
fn a_mesh_without_memory_is_refused_before_it_is_made() {
    let work = tempfile::tempdir().unwrap();
    let case = r#"
carom = 1
mesh.generate.s.box = { origin = [0.0, 0.0, 0.0], size = [1.0, 1.0, 1.0], elements = [400, 400, 500] }
material.m = { density = 1000.0, elastic = { young = "1 GPa", poisson = 0.3 } }
body.s = { region = "s", material = "m" }
time = { end = "1 ms", step = "0.1 ms", scheme.newmark = {} }
"#;
    fs::write(work.path().join("case.toml"), case).unwrap();
    let program = env!("CARGO_BIN_EXE_carom");
    for command in ["check", "run"] {
        let script = format!("ulimit -v 4000000; exec '{program}' {command} case.toml");
        let output = Command::new("bash")
            .args(["-c", &script])
            .current_dir(work.path())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(3), "{}", text(&output));
        assert!(
            text(&output).contains("out of memory: a mesh of 8.1e7 nodes needs"),
            "{}",
            text(&output)
        );
        assert_eq!(fs::read_dir(work.path()).unwrap().count(), 1);
    }
}

#[test]
fn a_case_file_that_is_missing_is_met_with_the_one_that_was_meant() {
    let work = tempfile::tempdir().unwrap();
    fs::create_dir(work.path().join("two-bars")).unwrap();
    fs::write(work.path().join("two-bars/case.toml"), BAR).unwrap();
    for (asked, meant) in [
        ("two-bars/cas.toml", Some("two-bars/case.toml")),
        ("two-bar/case.toml", Some("two-bars/case.toml")),
        ("two-bar/cases.toml", None),
        ("else.toml", None),
    ] {
        let output = carom(work.path(), &["check", asked]);
        assert_eq!(output.status.code(), Some(2));
        let said = text(&output);
        assert!(
            said.contains(&format!("cannot read the case file `{asked}`")),
            "{said}"
        );
        match meant {
            Some(meant) => assert!(said.contains(&format!("did you mean `{meant}`?")), "{said}"),
            None => assert!(!said.contains("did you mean"), "{said}"),
        }
    }
}

/// The cells of a column of a table.
fn column(table: &Path, name: &str) -> Vec<String> {
    let table = fs::read_to_string(table).unwrap();
    let mut rows = table.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let at = rows.next().unwrap().iter().position(|head| *head == name);
    rows.map(|row| row[at.unwrap()].to_owned()).collect()
}

#[test]
fn the_gap_of_what_faces_nothing_is_empty() {
    let work = tempfile::tempdir().unwrap();
    // two squares that pass beside each other, one of them above the other after a while
    let case = r#"carom = 1
[mesh]
generate.a.rectangle = { origin = [-2.0, 0.0], size = [1.0, 1.0], elements = [2, 2] }
generate.b.rectangle = { origin = [0.0, 1.1], size = [1.0, 1.0], elements = [2, 2] }
[material.m]
density = 1000.0
neo-hooke = { young = "1 MPa", poisson = 0.3 }
[body.a]
region = "a"
material = "m"
section.plane-strain = { thickness = 1.0 }
initial = { velocity = [10.0, 0.0] }
[body.b]
region = "b"
material = "m"
section.plane-strain = { thickness = 1.0 }
[contact.c]
secondary = "a.top"
primary = "b.bottom"
law.velocity = {}
sliding = "finite"
[time]
end = 0.2
step = 0.01
scheme.theta = {}
"#;
    fs::write(work.path().join("case.toml"), case).unwrap();
    let output = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let gaps = column(
        &work.path().join("case.carom/histories.csv"),
        "contact.c.gap_m",
    );
    assert_eq!(gaps[0], "", "{gaps:?}");
    assert!(
        (gaps[20].parse::<f64>().unwrap() - 0.1).abs() < 1e-9,
        "{gaps:?}"
    );
}

#[test]
fn tied_zones_balance_as_well_far_from_the_origin() {
    let work = tempfile::tempdir().unwrap();
    let residuals = |far: f64| {
        let case = format!(
            r#"carom = 1
[mesh]
generate.a.rectangle = {{ origin = [{far}, {far}], size = [1.0, 1.0], elements = [3, 3] }}
generate.b.rectangle = {{ origin = [{far}, {}], size = [1.0, 1.0], elements = [2, 2] }}
[material.m]
density = 7800.0
elastic = {{ young = "200 GPa", poisson = 0.3 }}
[body.a]
region = "a"
material = "m"
section.plane-strain = {{ thickness = 1.0 }}
[body.b]
region = "b"
material = "m"
section.plane-strain = {{ thickness = 1.0 }}
[zone.i]
bodies = ["a"]
[zone.o]
bodies = ["b"]
substeps = {{ i = 2 }}
[interface.t]
inner = "a"
outer = "b"
surfaces = ["a.top", "b.bottom"]
[load.p]
on = "b.top"
pressure = "1 MPa"
amplitude = [{{ time = 0.0, factor = 0.0 }}, {{ time = "0.1 ms", factor = 1.0 }}]
[time]
end = "0.5 ms"
step = {{ courant = 0.5 }}
scheme.newmark = {{}}
"#,
            far + 1.0
        );
        fs::write(work.path().join("case.toml"), case).unwrap();
        let output = carom(work.path(), &["run", "case.toml"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        let summary = fs::read(work.path().join("case.carom/summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        let residual = |balance: &str| summary[balance]["relative_residual"].as_f64().unwrap();
        [residual("energy"), residual("momentum")]
    };
    // powers of two keep the coordinates exact: the same model, and the same iterations
    for far in [0.0, 64.0, 65536.0] {
        let found = residuals(far);
        assert!(
            found.iter().all(|residual| *residual < 1e-13),
            "{far}: {found:?}"
        );
    }
}

#[test]
fn a_damped_bar_is_stable_up_to_its_critical_step() {
    let work = tempfile::tempdir().unwrap();
    let case = BAR
        .replace("elements = 8", "elements = 1")
        .replace(
            "initial = { velocity = [1.0] }",
            "damping.stiffness = \"0.2 ms\"",
        )
        .replace("point = [1.0]", "point = [2.0]")
        .replace("end = \"0.2 ms\"", "end = \"20 ms\"")
        .replace("courant = 1.0", "critical = 0.999")
        .replace("scheme.theta", "scheme.central-difference")
        + "[load.push]\non = \"bar.left\"\npressure = \"1 MPa\"\n";
    fs::write(work.path().join("case.toml"), case).unwrap();
    let output = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    // 100 N on 0.78 kg; the spring holds half of it: F²/8k at most, twice that while it swings in
    let energies = column(
        &work.path().join("case.carom/histories.csv"),
        "energy.strain_j",
    );
    let least = 100.0_f64.powi(2) / (8.0 * 200e9 * 1e-4);
    let largest = energies.iter().map(|energy| energy.parse::<f64>().unwrap());
    let largest = largest.fold(0.0, f64::max);
    assert!(largest < 4.0 * least, "{largest} J, at rest {least} J");
}

/// A soft square that a moving support presses on a plane, in static steps, `more` in its time.
fn pressed(more: &str) -> String {
    format!(
        r#"carom = 1
[mesh]
generate.a.rectangle = {{ origin = [0.0, 0.0], size = [1.0, 1.0], elements = [2, 2] }}
[material.m]
density = 1000.0
neo-hooke = {{ young = "1 MPa", poisson = 0.3 }}
[body.a]
region = "a"
material = "m"
section.plane-strain = {{ thickness = 1.0 }}
[support.side]
on = "a.left"
fix = ["x"]
[support.top]
on = "a.top"
move = {{ y = [{{ time = 0.0, displacement = 0.0 }}, {{ time = 1.0, displacement = -0.01 }}] }}
[contact.c]
secondary = "a.bottom"
obstacle.plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}
law.velocity = {{}}
[time]
static = {{ end = 1.0, steps = 4 }}
{more}
"#
    )
}

#[test]
fn static_steps_give_no_impulse() {
    let work = tempfile::tempdir().unwrap();
    let contact = |more: &str| {
        fs::write(work.path().join("case.toml"), pressed(more)).unwrap();
        let output = carom(work.path(), &["run", "case.toml"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        let summary = fs::read(work.path().join("case.carom/summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        (summary["contacts"]["c"].clone(), text(&output))
    };
    let rows = || {
        let table = fs::read_to_string(work.path().join("case.carom/impacts.csv")).unwrap();
        table.lines().count() - 1
    };
    let (alone, said) = contact("end = 1.0");
    assert!(alone["peak_force"].as_f64().unwrap() > 1000.0, "{alone}");
    for name in ["impulse", "mean_force", "peak_mean_force"] {
        assert!(alone[name].is_null(), "{name} {alone}");
    }
    assert!(said.contains("static: no impulse"), "{said}");
    assert_eq!(rows(), 0);
    let figure = fs::read_to_string(work.path().join("case.carom/plots/energy.svg")).unwrap();
    assert!(figure.contains("Pseudo-time of the loads"), "the axis");
    // the dynamics after it, in equilibrium: the force that is there, over the time of the dynamics
    let dynamic = "end = 1.1\nstep = 0.01\nscheme.newmark = {}";
    let (then, _) = contact(dynamic);
    let number = |name: &str| then[name].as_f64().unwrap();
    let force = alone["peak_force"].as_f64().unwrap();
    assert!(
        (number("impulse") / (0.1 * force) - 1.0).abs() < 1e-6,
        "{then}"
    );
    assert!((number("mean_force") / force - 1.0).abs() < 1e-6, "{then}");
    assert!(
        (number("peak_mean_force") / force - 1.0).abs() < 1e-6,
        "{then}"
    );
    assert_eq!(rows(), 1);
}

#[test]
fn a_penalty_and_a_stop_are_of_second_order_under_theta_one_half() {
    let work = tempfile::tempdir().unwrap();
    // (its own stiffness is 1e7 times that of the spring: a change of 1e-7 of the period)
    // 1 kg at 1 m/s on a spring of 100 N/m, 50 mm away: ω = 10 rad/s, rebound after half a period
    let case = |law: &str, step: f64| {
        BAR.replace("to = [1.0], elements = 8", "to = [1.0], elements = 1")
            .replace("density = 7800.0", "density = 1.0")
            .replace("young = \"200 GPa\"", "young = 1e9")
            .replace("1 cm^2", "1 m^2")
            .replace("point = [1.0]", "point = [1.05]")
            .replace("law.velocity = {}", law)
            .replace("end = \"0.2 ms\"", "end = 0.5")
            .replace("step = { courant = 1.0 }", &format!("step = {step:?}"))
    };
    let error = |law: &str, step: f64| {
        fs::write(work.path().join("case.toml"), case(law, step)).unwrap();
        let output = carom(work.path(), &["run", "case.toml"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        let table = work.path().join("case.carom/histories.csv");
        let numbers = |name: &str| -> Vec<f64> {
            column(&table, name)
                .iter()
                .map(|cell| cell.parse().unwrap())
                .collect()
        };
        let exact = |time: f64| {
            let (rate, since) = (10.0, time - 0.05);
            match since {
                since if since < 0.0 => time,
                since if rate * since < std::f64::consts::PI => 0.05 + (rate * since).sin() / rate,
                since => 0.05 + std::f64::consts::PI / rate - since,
            }
        };
        let found = numbers("contact.wall.secondary.displacement_m");
        let errors = numbers("time_s").into_iter().zip(found);
        let errors = errors.map(|(time, found)| (found - exact(time)).abs());
        errors.fold(0.0, f64::max)
    };
    for law in [
        "law.penalty = { stiffness = 100.0 }",
        "law.stop = { curve = [{ penetration = \"1 m\", force = \"100 N\" }, { penetration = \"2 m\", force = \"200 N\" }] }",
    ] {
        // a sixteenth of the step: order 2 is 256, order 1 is 16; where in a step the contact begins scatters the errors by a
        // factor of about two
        let [coarse, fine] = [4.7e-3, 4.7e-3 / 16.0].map(|step| error(law, step));
        assert!(coarse / fine > 128.0, "{law}: {coarse:e} {fine:e}");
    }
}
