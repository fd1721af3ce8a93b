//! `mpirun carom run`: the results of one process. Built with the feature `mpi` alone; needs `mpirun` of Open MPI.

// Helpers of tests panic as the tests themselves do.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

const BLOCK: &str = r#"
carom = 1
[mesh]
generate.block.box = { origin = [0.0, 0.0, 0.002], size = [0.1, 0.08, 0.12], elements = [6, 5, 7] }
[material.soft]
density = 1000.0
neo-hooke = { young = "5 MPa", poisson = 0.3 }
[body.block]
region = "block"
material = "soft"
initial = { velocity = [0.3, 0.0, SPEED] }
[contact.ground]
secondary = "block.bottom"
obstacle.plane = { point = [0.0, 0.0, 0.0], normal = [0.1, 0.0, 1.0] }
law.velocity = {}
[time]
end = "2 ms"
step = { critical = 0.2 }
scheme.central-difference = {}
[probe.top]
on = "block.top"
record = ["displacement", "velocity"]
"#;

fn write(folder: &Path, speed: &str) {
    fs::write(folder.join("case.toml"), BLOCK.replace("SPEED", speed)).unwrap();
}

/// The program on so many ranks, more than the machine has processors perhaps.
fn mpirun(folder: &Path, ranks: usize, arguments: &[&str]) -> Command {
    let mut command = Command::new("mpirun");
    command
        .args([
            "--oversubscribe",
            "-n",
            &ranks.to_string(),
            env!("CARGO_BIN_EXE_carom"),
        ])
        .args(arguments)
        .current_dir(folder)
        // Open MPI refuses root, which containers have, unless it is told twice
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Rows of the histories.
fn rows(folder: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(folder.join("histories.csv")).unwrap();
    let row = |line: &str| {
        line.split(',')
            .map(|cell| cell.parse().unwrap_or(0.0))
            .collect()
    };
    text.lines().skip(1).map(row).collect()
}

/// Names of the columns, and by how much each differs, over the largest entry of all components of its quantity.
fn differences(one: &Path, other: &Path) -> Vec<(String, f64)> {
    let text = fs::read_to_string(one.join("histories.csv")).unwrap();
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let (one, other) = (rows(one), rows(other));
    assert_eq!(one.len(), other.len());
    let quantity = |name: &str| {
        let axes = ["_x_", "_y_", "_z_", ".x_", ".y_", ".z_"].iter();
        axes.fold(name.to_owned(), |name, axis| name.replace(axis, "_"))
    };
    let largest = |column: usize| {
        one.iter()
            .fold(1e-30f64, |most, row| most.max(row[column].abs()))
    };
    let of = |(column, name): (usize, &&str)| {
        let alike = (0..names.len()).filter(|&k| quantity(names[k]) == quantity(name));
        let most = alike.map(largest).fold(0.0, f64::max);
        let pairs = one.iter().zip(&other);
        let apart = pairs.fold(0.0f64, |most, (a, b)| {
            most.max((a[column] - b[column]).abs())
        });
        ((*name).to_owned(), apart / most)
    };
    names.iter().enumerate().map(of).collect()
}

/// That motion, forces and energies of a run are those of one process: 1e-9 is a million roundings, in a run with some tens of closings.
fn assert_same(alone: &Path, several: &Path) {
    for (name, apart) in differences(alone, several) {
        // residuals are rounding in both
        if !name.contains("residual") && !name.contains("dissipation") {
            assert!(apart < 1e-9, "{name}: {apart:e}");
        }
    }
}

fn run_alone(folder: &Path, set: &[&str]) {
    let output = Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(["run", "case.toml", "--results", "alone"])
        .args(set)
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", said(&output));
}

#[test]
fn several_processes_give_the_results_of_one() {
    let work = tempfile::tempdir().unwrap();
    write(work.path(), "-5.0");
    run_alone(work.path(), &[]);
    for ranks in [1, 2, 4] {
        let name = ranks.to_string();
        let output = mpirun(
            work.path(),
            ranks,
            &["run", "case.toml", "--results", &name],
        );
        let output = { output }.output().unwrap();
        assert!(output.status.success(), "{}", said(&output));
        assert_same(&work.path().join("alone"), &work.path().join(&name));
        // one tells the end
        assert_eq!(
            said(&output).matches("verdict:").count(),
            1,
            "{}",
            said(&output)
        );
    }
}

#[test]
fn a_rank_that_fails_ends_all_with_one_message() {
    let work = tempfile::tempdir().unwrap();
    // nodes that the plane has stopped are overtaken in one step, by five elements: these turn inside out, and steps are not halved
    let text = BLOCK.replace("SPEED", "-5000.0");
    let text = text.replace(
        "step = { critical = 0.2 }",
        "step = \"20 us\"\nnewton = { halvings = 0 }",
    );
    fs::write(work.path().join("case.toml"), text).unwrap();
    let output = mpirun(work.path(), 3, &["run", "case.toml"])
        .output()
        .unwrap();
    let said = said(&output);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert_eq!(said.matches("error: rank ").count(), 1, "{said}");
    assert!(
        work.path().join("case.carom/checkpoints").is_dir(),
        "{said}"
    );
}

/// The block in implicit steps with iterations, each of which is a product that ranks share.
fn write_implicit(folder: &Path) {
    let text = BLOCK
        .replace("SPEED", "-5.0")
        .replace(
            "step = { critical = 0.2 }",
            "step = \"20 us\"\nsolver = \"iterative\"",
        )
        .replace("scheme.central-difference", "scheme.theta");
    fs::write(folder.join("case.toml"), text).unwrap();
}

#[test]
fn implicit_steps_of_several_processes_give_the_results_of_one() {
    let work = tempfile::tempdir().unwrap();
    write_implicit(work.path());
    let short = ["--set", "time.end=0.8 ms"];
    run_alone(work.path(), &short);
    // of MPI alone the same bits; of PETSc what its preconditioners leave, which solves end at 1e-12
    let options: &[&str] = match cfg!(feature = "petsc") {
        true => &[
            "",
            "-pc_type gamg",
            "-pc_type cholesky -pc_factor_mat_solver_type mumps",
        ],
        false => &[""],
    };
    for (number, options) in options.iter().enumerate() {
        let ranks = if number == 0 { 4 } else { 2 };
        let name = ranks.to_string() + options;
        let arguments = [&["run", "case.toml", "--results", &name], &short[..]].concat();
        let output = mpirun(work.path(), ranks, &arguments)
            .env("PETSC_OPTIONS", options)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", said(&output));
        assert_same(&work.path().join("alone"), &work.path().join(&name));
        assert_eq!(said(&output).matches("each rank computes all").count(), 1);
    }
}

/// A factor that PETSc has over all ranks finds contact forces as one of one process does, with as many factorisations and columns: where the matrix stays, three for
/// each node that comes near; else for each tangent. A solve takes one iteration, or two by rounding. A block that rubs on a slanting plane, of a
/// linear material and of one whose tangents change.
#[cfg(feature = "petsc")]
#[test]
fn a_factor_over_all_ranks_finds_contact_forces() {
    let work = tempfile::tempdir().unwrap();
    write_implicit(work.path());
    let tangents = fs::read_to_string(work.path().join("case.toml")).unwrap();
    let tangents = tangents.replace(
        "law.velocity = {}",
        "law.velocity = {}\nfriction.coulomb = 0.3",
    );
    let short = ["--set", "time.end=0.8 ms"];
    for stays in [true, false] {
        let text = match stays {
            true => tangents.replace("neo-hooke", "elastic"),
            false => tangents.clone(),
        };
        fs::write(work.path().join("case.toml"), text).unwrap();
        let _ = fs::remove_dir_all(work.path().join("alone"));
        run_alone(
            work.path(),
            &[&short[..], &["--set", "time.solver=direct"]].concat(),
        );
        let [with_factor, made, ..] = counts(&work.path().join("alone"));
        for ranks in [2, 3] {
            let name = format!("{stays}-{ranks}");
            let arguments = [&["run", "case.toml", "--results", &name], &short[..]].concat();
            let output = mpirun(work.path(), ranks, &arguments)
                .env(
                    "PETSC_OPTIONS",
                    "-pc_type cholesky -pc_factor_mat_solver_type mumps",
                )
                .output()
                .unwrap();
            assert!(output.status.success(), "{}", said(&output));
            assert_same(&work.path().join("alone"), &work.path().join(&name));
            let [columns, factors, sweeps, steps] = counts(&work.path().join(&name));
            assert!(columns > 0 && columns == with_factor, "{columns}");
            assert_eq!(factors, made);
            // of the load and of the contact forces, a solve of two iterations each, which are three pairs of sweeps
            assert!(!stays || sweeps <= 12 * (steps + 1), "{sweeps} in {steps}");
        }
    }
}

/// Columns of contact rows, factorisations, sweeps and steps of a run.
#[cfg(feature = "petsc")]
fn counts(results: &Path) -> [u64; 4] {
    let text = fs::read_to_string(results.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    let number = |group: &str, key: &str| summary[group][key].as_u64().unwrap();
    [
        number("counts", "contact_columns"),
        number("counts", "factorisations"),
        number("counts", "sweeps"),
        number("time", "steps"),
    ]
}

/// A preconditioner that PETSc does not have ends all ranks with one message: it is PETSc that solves.
#[cfg(feature = "petsc")]
#[test]
fn an_error_of_petsc_ends_all_ranks() {
    let work = tempfile::tempdir().unwrap();
    write_implicit(work.path());
    let output = mpirun(work.path(), 2, &["run", "case.toml"])
        .env("PETSC_OPTIONS", "-pc_type nonsense")
        .output()
        .unwrap();
    let said = said(&output);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert_eq!(said.matches("PETSc: ").count(), 1, "{said}");
}

/// Cases of the project whose steps each rank takes whole: with factors, friction, a static stage and zones. All have the bits of one process.
#[test]
fn cases_of_the_project_have_the_bits_of_one_process() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let work = tempfile::tempdir().unwrap();
    for case in [
        "two-bars",
        "hertz",
        "ironing",
        "block-drop",
        "bars-in-zones",
    ] {
        let file = cases.join(case).join("case.toml");
        let run = |ranks: usize| {
            let results = format!("{case}-{ranks}");
            let file = file.to_str().unwrap();
            let output = mpirun(work.path(), ranks, &["run", file, "--results", &results]);
            let output = { output }.output().unwrap();
            // a bad verdict is an end too
            assert!(
                work.path().join(&results).join("summary.json").is_file(),
                "{}",
                said(&output)
            );
            fs::read(work.path().join(&results).join("histories.csv")).unwrap()
        };
        let alone = run(1);
        assert!(run(2) == alone, "{case} on 2 ranks");
        assert!(run(4) == alone, "{case} on 4 ranks");
    }
}

/// Waits until a file is there.
fn wait_for(path: &Path, child: &mut Child) {
    let begin = Instant::now();
    while !path.exists() && begin.elapsed() < Duration::from_secs(60) {
        assert!(child.try_wait().unwrap().is_none(), "the run has ended");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The number of a process below another one that runs this program.
fn rank_of(mpirun: u32) -> Option<u32> {
    let children = format!("/proc/{mpirun}/task/{mpirun}/children");
    let children = fs::read_to_string(children).ok()?;
    let mut numbers = children
        .split_whitespace()
        .filter_map(|number| number.parse().ok());
    numbers.next_back()
}

#[test]
fn three_processes_go_on_after_one_of_four_was_killed() {
    let work = tempfile::tempdir().unwrap();
    write(work.path(), "-5.0");
    go_on_after_a_kill(work.path(), "40 ms");
}

#[test]
fn three_processes_go_on_with_implicit_steps_after_one_of_four_was_killed() {
    let work = tempfile::tempdir().unwrap();
    write_implicit(work.path());
    go_on_after_a_kill(work.path(), "3 ms");
}

/// Kills one of four ranks after the first checkpoint; three go on.
fn go_on_after_a_kill(folder: &Path, end: &str) {
    let end = format!("time.end={end}");
    let long = ["--set", &end, "--set", "output.checkpoint.every=0.5 ms"];
    run_alone(folder, &long);
    let arguments = [&["run", "case.toml"], &long[..]].concat();
    let mut child = mpirun(folder, 4, &arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for(
        &folder.join("case.carom/checkpoints/last.state"),
        &mut child,
    );
    let killed = rank_of(child.id()).expect("a rank");
    Command::new("kill")
        .args(["-9", &killed.to_string()])
        .status()
        .unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(!output.status.success());
    // that of mpirun names the rank and the signal
    let killed = said(&output);
    assert!(
        killed.contains("signal 9") && killed.contains("rank"),
        "{killed}"
    );
    let output = mpirun(folder, 3, &["resume", "case.carom"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", said(&output));
    assert_same(&folder.join("alone"), &folder.join("case.carom"));
}

/// A box that falls on its corner, with 12 912 elements, plasticity, friction, contact of all sides with each other and steps that follow the
/// critical step: the results of one process.
#[test]
fn the_drop_test_on_several_processes_gives_the_results_of_one() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let file = cases.join("drop-test/case.toml");
    let set = [
        "mesh.refine=1",
        "body.walls.mass-scaling.step=0.24 us",
        "body.corners.mass-scaling.step=0.24 us",
        "time.end=60 us",
    ];
    let work = tempfile::tempdir().unwrap();
    let run = |ranks: usize| {
        let results = work.path().join(ranks.to_string());
        let mut arguments = vec!["run", file.to_str().unwrap(), "--results"];
        arguments.push(results.to_str().unwrap());
        arguments.extend(set.iter().flat_map(|key| ["--set", key]));
        let output = mpirun(work.path(), ranks, &arguments).output().unwrap();
        let said = said(&output);
        // a bad verdict is an end too: the run is cut short
        assert!(results.join("summary.json").is_file(), "{said}");
        assert_eq!(said.contains("bytes sent a step"), ranks > 1, "{said}");
        results
    };
    let alone = run(1);
    let forces = rows(&alone);
    let text = fs::read_to_string(alone.join("histories.csv")).unwrap();
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let force = names
        .iter()
        .position(|name| name.contains("floor") && name.contains("force"));
    let force = force.unwrap();
    assert!(forces.iter().any(|row| row[force] > 0.0), "nothing touches");
    for ranks in [2, 4] {
        assert_same(&alone, &run(ranks));
    }
}

/// A bar along the diagonal of the plane, whose cuts across the axes are longer than those across itself: Scotch's parts share fewer nodes than 0.9 of
/// those of planes (by the lengths of the cuts 0.71), and are taken.
#[cfg(feature = "petsc")]
#[test]
fn scotch_shares_out_a_bar_that_lies_askew() {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("bar.msh"), diagonal(60, 12)).unwrap();
    fs::write(work.path().join("case.toml"), DIAGONAL).unwrap();
    run_alone(work.path(), &[]);
    for ranks in [2, 3] {
        let results = ranks.to_string();
        let run = ["run", "case.toml", "--results", &results];
        let output = mpirun(work.path(), ranks, &run).output().unwrap();
        let said = said(&output);
        assert!(output.status.success(), "{said}");
        assert!(said.contains("shared out by Scotch"), "{said}");
        assert_same(&work.path().join("alone"), &work.path().join(&results));
    }
    // as many ranks give the same bits, since the elements are shared out alike
    let run = ["run", "case.toml", "--results", "again"];
    let output = mpirun(work.path(), 3, &run).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let bytes = |folder: &str| fs::read(work.path().join(folder).join("histories.csv")).unwrap();
    assert!(bytes("again") == bytes("3"));
}

#[cfg(feature = "petsc")]
const DIAGONAL: &str = r#"
carom = 1
[mesh]
file = "bar.msh"
[material.soft]
density = 1000.0
neo-hooke = { young = "5 MPa", poisson = 0.3 }
[body.bar]
region = "bar"
material = "soft"
section.plane-strain = { thickness = "10 mm" }
initial = { velocity = [-2.0, -2.0] }
[contact.wall]
secondary = "end"
obstacle.plane = { point = [-0.001, -0.001], normal = [1.0, 1.0] }
law.velocity = {}
[time]
end = "4 ms"
step = { critical = 0.5 }
scheme.central-difference = {}
"#;

/// A mesh of so many squares of 10 mm along the diagonal and across it; its lower left end is a group.
#[cfg(feature = "petsc")]
fn diagonal(along: usize, across: usize) -> String {
    let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"end\"\n2 2 \"bar\"\n$EndPhysicalNames\n".to_owned();
    text += &format!("$Nodes\n{}\n", (along + 1) * (across + 1));
    let number = |i: usize, j: usize| j * (along + 1) + i + 1;
    for j in 0..=across {
        for i in 0..=along {
            let [s, t] = [i, j].map(|k| 0.01 * k as f64 / 2f64.sqrt());
            text += &format!("{} {} {} 0\n", number(i, j), s - t, s + t);
        }
    }
    text += &format!("$EndNodes\n$Elements\n{}\n", across + along * across);
    for j in 0..across {
        text += &format!("{} 1 2 1 1 {} {}\n", j + 1, number(0, j + 1), number(0, j));
    }
    for j in 0..across {
        for i in 0..along {
            let corners = [
                number(i, j),
                number(i + 1, j),
                number(i + 1, j + 1),
                number(i, j + 1),
            ];
            let [a, b, c, d] = corners;
            let element = across + j * along + i + 1;
            text += &format!("{element} 3 2 2 2 {a} {b} {c} {d}\n");
        }
    }
    text + "$EndElements\n"
}
