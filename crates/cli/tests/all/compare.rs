//! `compare` and `study`: files, tables, exit codes.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::commands::{carom, project, text};

/// The two bars with fewer elements.
fn case(work: &Path) {
    let path = project().join("cases/two-bars/case.toml");
    let text = fs::read_to_string(path).unwrap();
    fs::write(
        work.join("case.toml"),
        text.replace("elements = 200", "elements = 20"),
    )
    .unwrap();
}

#[test]
fn a_comparison_leaves_its_table_its_figures_and_the_results_of_each_variant() {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    let arguments = [
        "compare",
        "case.toml",
        "--with",
        "theta",
        "newmark={beta=0.49,gamma=0.9}",
    ];
    let output = carom(work.path(), &arguments);
    let said = text(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    for word in [
        "force error",
        "restitution",
        "the exact solution `two-bars`",
        "does not converge",
    ] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let folder = work.path().join("case.compare");
    let variants = ["theta", "newmark-beta-0.49-gamma-0.9"];
    for variant in variants {
        for file in ["summary.json", "report.html", "histories.csv"] {
            assert!(
                folder.join(variant).join(file).is_file(),
                "{variant}/{file}"
            );
        }
    }
    let csv = fs::read_to_string(folder.join("comparison.csv")).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 3);
    assert!(lines[0].starts_with("variant,scheme,contact,law,force_error,overshoot,"));
    assert!(
        lines[1].starts_with("theta,\"theta, theta = 0.5\",shock,velocity,0."),
        "{}",
        lines[1]
    );
    let page = fs::read_to_string(folder.join("report.html")).unwrap();
    for quantity in ["force", "displacement", "velocity", "energy"] {
        let figure = fs::read_to_string(folder.join(format!("plots/{quantity}.svg"))).unwrap();
        for variant in variants {
            assert!(figure.contains(variant), "{quantity}");
        }
        assert!(page.contains(&figure), "{quantity} is on the page");
    }
    assert!(
        fs::read_to_string(folder.join("plots/force.svg"))
            .unwrap()
            .contains("exact")
    );
    // the summary of a variant can be had again by `run`
    let copy = fs::read_to_string(folder.join(variants[1]).join("case.toml")).unwrap();
    assert!(
        copy.starts_with("# --set time.scheme={ newmark={beta=0.49,gamma=0.9} }\n"),
        "{copy}"
    );
}

#[test]
fn a_pair_that_is_refused_is_in_the_table_with_its_reason() {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    let arguments = [
        "compare",
        "case.toml",
        "--with",
        "theta",
        "central-difference",
    ];
    let output = carom(
        work.path(),
        &[&arguments[..], &["--law", "displacement"]].concat(),
    );
    let said = text(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let name = "central-difference_displacement";
    assert!(
        said.contains(&format!("{name} refused: contact.shock.law.displacement: ")),
        "{said}"
    );
    let csv = fs::read_to_string(work.path().join("case.compare/comparison.csv")).unwrap();
    assert!(
        csv.lines()
            .any(|line| line.starts_with(name) && line.contains(",refused,")),
        "{csv}"
    );
}

#[test]
fn bad_input_exits_2_and_leaves_nothing() {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    let wrong: [&[&str]; 8] = [
        &["compare", "case.toml", "--with", "newmrk"],
        &[
            "compare",
            "case.toml",
            "--with",
            "theta",
            "--reference",
            "thet",
        ],
        &["compare", "none.toml", "--with", "theta"],
        &[
            "compare",
            "case.toml",
            "--with",
            "central-difference",
            "--law",
            "displacement",
        ],
        &["study", "case.toml", "--vary", "time.step"],
        &["study", "case.toml", "--vary", "time.step.courant=1,0"],
        &[
            "study",
            "case.toml",
            "--vary",
            "time.step.courant=1,0.5; time.end=1e-4",
        ],
        &[
            "compare",
            "case.toml",
            "--with",
            "theta",
            "--contact",
            "shok",
        ],
    ];
    for arguments in wrong {
        let output = carom(work.path(), arguments);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            text(&output)
        );
        assert_eq!(
            fs::read_dir(work.path()).unwrap().count(),
            1,
            "{arguments:?}"
        );
    }
    let message = text(&carom(work.path(), wrong[0]));
    assert!(message.contains("did you mean `newmark`?"), "{message}");
}

#[test]
fn a_variant_that_fails_in_running_exits_3_and_the_others_are_kept() {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    // the limit on the size of files lets the report of the run of few steps through, and not the histories of the other
    let script = format!(
        "trap '' XFSZ; ulimit -f 1500; exec '{}' study case.toml --vary time.step.courant=1,0.002",
        env!("CARGO_BIN_EXE_carom")
    );
    let mut command = Command::new("bash");
    let output = command
        .args(["-c", &script])
        .current_dir(work.path())
        .output()
        .unwrap();
    let said = text(&output);
    assert_eq!(output.status.code(), Some(3), "{said}");
    let csv = fs::read_to_string(work.path().join("case.study/study.csv")).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert!(
        lines[1].contains(",good,") && lines[2].contains(",failed,"),
        "{csv}"
    );
}

#[test]
fn a_study_gives_orders_with_error_bars_and_a_figure() {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    let elements =
        ["striker", "target"].map(|bar| format!("mesh.generate.{bar}.line.elements=20,40,80"));
    let output = carom(
        work.path(),
        &["study", "case.toml", "--vary", &elements.join(";")],
    );
    let said = text(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    for word in [
        "against time step (s)",
        "± 0.",
        "extrapolated",
        "saturated from",
        "Contact `shock`.",
        "raw peak of a single step does not converge",
    ] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let folder = work.path().join("case.study");
    let orders = fs::read_to_string(folder.join("orders.csv")).unwrap();
    assert!(
        orders
            .lines()
            .any(|line| line.starts_with("impulse_n_s,,0.7")),
        "{orders}"
    );
    // the limit of three runs is closer to it than the finest run
    let cell = |line: &str, column: &str| -> f64 {
        let heads = orders.lines().next().unwrap().split(',');
        let place = heads.into_iter().position(|head| head == column).unwrap();
        line.split(',').nth(place).unwrap().parse().unwrap()
    };
    let impulse = orders.lines().find(|line| line.starts_with("impulse_n_s"));
    let limit = cell(impulse.unwrap(), "extrapolated");
    let runs = fs::read_to_string(folder.join("study.csv")).unwrap();
    let heads: Vec<&str> = runs.lines().next().unwrap().split(',').collect();
    let of = |column: &str| -> f64 {
        let place = heads.iter().position(|head| *head == column).unwrap();
        let finest = runs.lines().last().unwrap();
        finest.split(',').nth(place).unwrap().parse().unwrap()
    };
    let exact = of("exact.impulse_n_s");
    assert!((limit - exact).abs() < 0.5 * (of("impulse_n_s") - exact).abs());
    assert!(
        !orders.contains("\npeak_force_n,"),
        "the raw peak has no order"
    );
    let figure = fs::read_to_string(folder.join("plots/orders.svg")).unwrap();
    assert!(figure.contains("impulse, order 0.71"));
    assert!(
        fs::read_to_string(folder.join("report.html"))
            .unwrap()
            .contains(&figure)
    );
    assert!(folder.join("3-elements-80/summary.json").is_file());
}

#[test]
fn a_fit_prints_the_value_that_it_found() {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    let fit = |goal: &str| fitted(work.path(), goal);
    let output = fit("restitution=0.92");
    let said = text(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("time.scheme.theta.theta = 0."), "{said}");
    assert!(said.contains("restitution 0.9200000"), "{said}");
    let found = written(work.path());
    let value = found["value"].as_f64().unwrap();
    assert!(said.contains(&format!("theta = {value:.7}")), "{said}");
    assert!((found["reached"].as_f64().unwrap() - 0.92).abs() < 1e-6);
    let run = found["run"].as_str().unwrap();
    let results = work.path().join("case.study").join(run);
    assert!(results.join("summary.json").is_file());
    let page = work.path().join("case.study/report.html");
    let page = fs::read_to_string(page).unwrap();
    assert_eq!(page.matches("→").count(), 1, "one run is marked");
    let output = fit("restitution=0.1");
    assert_eq!(output.status.code(), Some(3), "{}", text(&output));
    assert!(written(work.path())["reason"].is_string());
    assert_eq!(fit("rest=0.1").status.code(), Some(2));
}

/// Fits the parameter of the theta scheme of the case in a folder.
fn fitted(work: &std::path::Path, goal: &str) -> std::process::Output {
    let key = "time.scheme.theta.theta";
    let arguments = [
        "study",
        "case.toml",
        "--fit",
        key,
        "--between",
        "0.5,1",
        "--to",
        goal,
    ];
    carom(work, &arguments)
}

/// The `fit.json` of the case in a folder.
fn written(work: &std::path::Path) -> serde_json::Value {
    let text = fs::read_to_string(work.join("case.study/fit.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// A history is met by the run that made it: its distance is zero, and that of the others is in the table.
#[test]
fn a_fit_to_a_history_finds_the_run_that_made_it() {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    let one = [
        "run",
        "case.toml",
        "--set",
        "time.scheme.theta.theta=0.6",
        "--results",
        "made",
    ];
    assert_eq!(carom(work.path(), &one).status.code(), Some(0));
    let output = fitted(work.path(), "force=made/histories.csv");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let found = written(work.path());
    // a thousandth of the range
    assert!((found["value"].as_f64().unwrap() - 0.6).abs() < 5e-4);
    let table = fs::read_to_string(work.path().join("case.study/study.csv")).unwrap();
    let mut lines = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let heads = lines.next().unwrap();
    let column = |name: &str| heads.iter().position(|head| *head == name).unwrap();
    let (run, distance) = (column("run"), column("distance"));
    let rows: Vec<(String, f64)> = lines
        .map(|row| (row[run].to_owned(), row[distance].parse().unwrap()))
        .collect();
    let nearest = rows.iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert_eq!(nearest.0, found["run"].as_str().unwrap());
    assert_eq!(nearest.1, found["reached"].as_f64().unwrap());
}

/// Starts a sweep, interrupts it while the run in the folder `running` goes on, and gives the table that it left.
fn interrupted(arguments: &[&str], running: &str, table: &str) -> String {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    let mut child = Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(arguments)
        .current_dir(work.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    let histories = work.path().join(running).join("histories.csv");
    while fs::metadata(&histories).map_or(0, |data| data.len()) < 100_000 {
        let waited = begin.elapsed();
        assert!(
            waited < Duration::from_secs(60),
            "the run writes as it goes"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
    Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let folder = work.path().join(running);
    let summary = fs::read_to_string(folder.join("summary.json")).unwrap();
    assert!(summary.contains("interrupted"), "{summary}");
    fs::read_to_string(work.path().join(table)).unwrap()
}

/// The rows of a table that end in the verdict `stopped`, or were computed.
fn counts(table: &str) -> [usize; 2] {
    let count = |word: &str| table.lines().filter(|line| line.contains(word)).count();
    [count(",stopped,"), count(",good,")]
}

#[test]
fn an_interrupted_comparison_has_a_table_and_exits_130() {
    let arguments = [
        "compare",
        "case.toml",
        "--with",
        "theta",
        "newmark={beta=0.49,gamma=0.9}",
        "--reference",
        "finest",
        "--set",
        "time.end=10.0",
    ];
    let running = "case.compare/theta";
    let table = interrupted(&arguments, running, "case.compare/comparison.csv");
    assert_eq!(counts(&table), [3, 0], "{table}");
}

#[test]
fn an_interrupted_study_keeps_the_runs_before_and_exits_130() {
    let arguments = ["study", "case.toml", "--vary", "time.end=1e-4,10.0,20.0"];
    let running = "case.study/2-end-10.0";
    let table = interrupted(&arguments, running, "case.study/study.csv");
    assert_eq!(counts(&table), [2, 1], "{table}");
}
