//! Comparisons and studies of the two bars, as a user of the library makes them.

use std::fs;
use std::path::Path;

use carom_case::{Axis, Choices, Fit, Input, Sweep, SweepError, compare, fit, study};
use carom_dynamics::Silent;
use carom_output::Summary;
use carom_studies::compare::{COLUMNS, Comparison, Outcome, Standard};
use carom_studies::study::{Quantity, Source, Study};

/// Two equal bars of `n` elements each, theta 1/2, Courant number 1/2.
fn two_bars(n: usize, reference: &str) -> Input {
    let text = format!(
        r#"
carom = 1
title = "Two bars"
mesh.generate.one.line = {{ from = ["-254 mm"], to = [0.0], elements = {n} }}
mesh.generate.two.line = {{ from = [0.0], to = ["254 mm"], elements = {n} }}
material.steel = {{ density = 7844.0, elastic = {{ young = "207 GPa", poisson = 0.0 }} }}
body.one = {{ region = "one", material = "steel", section.bar.area = "645 mm^2", initial.velocity = [5.1359] }}
body.two = {{ region = "two", material = "steel", section.bar.area = "645 mm^2" }}
contact.shock = {{ secondary = "one.right", primary = "two.left", law.velocity.capture = "half" }}
time = {{ end = "150 us", step.courant = 0.5, scheme.theta.theta = 0.5 }}
{reference}
"#
    );
    Input::from_text("case.toml", &text, &[])
}

const EXACT: &str = "[reference.two-bars]";

fn sweep<T>(folder: &Path, jobs: usize, work: impl FnOnce(&Sweep) -> T) -> T {
    work(&Sweep {
        folder,
        contact: None,
        jobs,
        watch: &|_, _| Box::new(Silent),
        stop: &|| false,
    })
}

fn words(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|text| (*text).to_owned()).collect()
}

fn compared(folder: &Path, input: &Input, choices: &Choices) -> Comparison {
    sweep(folder, 1, |sweep| compare(input, choices, sweep))
        .unwrap()
        .0
}

fn value(comparison: &Comparison, variant: &str, column: &str) -> Option<f64> {
    let variant = comparison
        .variants
        .iter()
        .find(|v| v.name == variant)
        .unwrap();
    let column = COLUMNS.iter().find(|c| c.name == column).unwrap();
    (column.value)(variant.done().unwrap())
}

#[test]
fn figures_of_a_variant_are_those_of_its_own_summary() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path().join("case.compare");
    let choices = Choices {
        beside: Vec::new(),
        schemes: words(&["case", "theta={theta=1.0}", "newmark={beta=0.5}"]),
        laws: words(&["velocity", "damped"]),
        reference: None,
    };
    let comparison = compared(&folder, &two_bars(40, EXACT), &choices);
    assert_eq!(comparison.standard, Standard::Exact);
    let names: Vec<&str> = comparison
        .variants
        .iter()
        .map(|v| v.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "case_velocity",
            "case_damped",
            "theta-theta-1.0_velocity",
            "theta-theta-1.0_damped",
            "newmark-beta-0.5_velocity",
            "newmark-beta-0.5_damped"
        ]
    );
    for name in names {
        let text = fs::read_to_string(folder.join(name).join("summary.json")).unwrap();
        let own = Summary::from_json(&text).unwrap();
        let (shock, exact) = (&own.contacts["shock"], own.exact.unwrap());
        let of = |column| value(&comparison, name, column);
        assert_eq!(of("force_error"), exact.force_error, "{name}");
        assert_eq!(of("overshoot"), exact.overshoot);
        assert_eq!(of("mean_overshoot"), exact.mean_overshoot);
        assert_eq!(of("impulse_error"), Some(exact.impulse_error));
        assert_eq!(of("restitution"), exact.restitution);
        assert_eq!(of("status_changes"), Some(shock.status_changes as f64));
        assert_eq!(of("penetration_m"), Some(shock.max_penetration));
        assert_eq!(of("persistency_defect_j"), Some(shock.persistency_defect));
        assert_eq!(of("release_s"), shock.last_release);
        assert_eq!(of("work_contact_j"), Some(own.energy.works["contact"]));
        assert_eq!(of("steps"), Some(own.time.steps as f64));
        let start = own.energy.kinetic_initial + own.energy.strain_initial;
        let end = own.energy.kinetic_final + own.energy.strain_final;
        assert_eq!(of("energy_change"), Some(end / start - 1.0));
    }
    // numerical and mechanical dissipation are told apart: theta = 1 damps, theta = 1/2 does not; the damper does
    let of = |name, column| value(&comparison, name, column).unwrap();
    let energy = 0.5 * 7844.0 * 645e-6 * 0.254 * 5.1359 * 5.1359;
    assert!(of("case_velocity", "dissipation_scheme_j").abs() < 1e-9 * energy);
    assert!(of("theta-theta-1.0_velocity", "dissipation_scheme_j") > 0.01 * energy);
    assert!(of("case_damped", "work_contact_j") < 0.0);
}

#[test]
fn a_run_is_at_no_distance_from_itself_and_the_finest_has_a_quarter_of_the_step() {
    let work = tempfile::tempdir().unwrap();
    let input = two_bars(40, EXACT);
    let choices = |reference: &str| Choices {
        beside: Vec::new(),
        schemes: words(&["theta", "theta={theta=0.6}"]),
        laws: Vec::new(),
        reference: Some(reference.to_owned()),
    };
    let folder = work.path().join("a");
    let own = compared(&folder, &input, &choices("theta"));
    assert_eq!(own.standard, Standard::Run("theta".to_owned()));
    assert_eq!(value(&own, "theta", "force_error"), Some(0.0));
    assert_eq!(value(&own, "theta", "impulse_error"), Some(0.0));
    assert!(value(&own, "theta-theta-0.6", "force_error").unwrap() > 0.0);
    let finest = compared(&folder, &input, &choices("finest"));
    let last = finest.variants.last().unwrap();
    assert_eq!(last.name, "finest");
    let steps = |name: &str| value(&finest, name, "steps").unwrap();
    // the last of the four may be one too many
    assert_eq!((steps("finest") / 4.0).ceil(), steps("theta"));
    // the same folder again: what the last comparison left and this one does not have is gone
    assert!(folder.join("finest/summary.json").is_file());
    compared(&folder, &input, &choices("none"));
    assert!(!folder.join("finest").exists());
    assert!(folder.join("theta/summary.json").is_file());
}

#[test]
fn the_finest_run_is_nearer_to_the_exact_solution_than_the_case_and_says_what_it_cannot_see() {
    let work = tempfile::tempdir().unwrap();
    let choices = Choices {
        schemes: words(&["case", "theta={theta=0.6}"]),
        reference: Some("finest".to_owned()),
        ..Choices::default()
    };
    let comparison = compared(&work.path().join("a"), &two_bars(40, EXACT), &choices);
    let exact_error = |name: &str| {
        let mut variants = comparison.variants.iter();
        let done = variants.find(|v| v.name == name).unwrap().done().unwrap();
        done.summary.exact.as_ref().unwrap().force_error.unwrap()
    };
    // elements and steps of a quarter; the force of two bars errs like n^-0.36, measured from n = 50 to 800: 0.61
    let ratio = exact_error("finest") / exact_error("case");
    assert!((0.55..0.67).contains(&ratio), "{ratio}");
    let distance = value(&comparison, "case", "force_error").unwrap();
    // what the distance cannot show is at least what two errors can differ by
    let own = exact_error("finest");
    assert!(distance >= exact_error("case") - own && distance <= exact_error("case") + own);
    let unseen = comparison.unseen().unwrap();
    let of = |p: f64| {
        format!(
            "{:.2} % of the force",
            100.0 * distance / (4f64.powf(p) - 1.0)
        )
    };
    for text in [
        "1/4 of the size of its elements and of its step",
        &of(1.0),
        &of(1.0 / 3.0),
    ] {
        assert!(unseen.contains(text), "{text:?} in {unseen}");
    }
    let page = fs::read_to_string(work.path().join("a/report.html")).unwrap();
    assert!(page.contains("Not shown: the error of"));
}

#[test]
fn a_row_far_from_the_reference_run_is_bad_whatever_its_own_verdict() {
    let work = tempfile::tempdir().unwrap();
    // laws that find the bars touching: with the trapezoid the displacement law errs by 0.84 of the force, the velocity law by 0.08
    let choices = Choices {
        laws: words(&["velocity", "displacement"]),
        reference: Some("finest".to_owned()),
        ..Choices::default()
    };
    let comparison = compared(&work.path().join("a"), &two_bars(50, ""), &choices);
    for (law, grade, errors) in [
        ("velocity", "good", 0.02..0.15),
        ("displacement", "bad", 0.5..1.5),
    ] {
        let mut variants = comparison.variants.iter();
        let variant = variants.find(|variant| variant.name == law).unwrap();
        let done = variant.done().unwrap();
        assert!(errors.contains(&done.errors.force.unwrap()), "{law}");
        let line = done.line.as_ref().unwrap();
        assert_eq!(line.grade.word(), grade, "{law}");
        let (word, reason) = variant.verdict();
        assert_eq!(word, grade, "{law}: {reason}");
        assert_eq!(reason.contains(&line.text()), grade == "bad", "{reason}");
    }
}

#[test]
fn a_mesh_that_cannot_be_refined_leaves_its_error_unseen_and_the_table_says_why() {
    let work = tempfile::tempdir().unwrap();
    let choices = Choices {
        reference: Some("finest".to_owned()),
        ..Choices::default()
    };
    // 512 elements by nine halvings: ten are allowed
    let text = two_bars(1, "").sources[0].text.clone();
    let text = text.replace("carom = 1", "carom = 1\nmesh.refine = 9");
    let input = Input::from_text("case.toml", &text, &[]);
    let comparison = compared(&work.path().join("a"), &input, &choices);
    let refined = comparison.refined.as_ref().unwrap();
    assert!(refined.same_mesh.as_ref().unwrap().contains("mesh.refine"));
    let unseen = comparison.unseen().unwrap();
    assert!(
        unseen.starts_with("Not shown: the error of the mesh."),
        "{unseen}"
    );
    let steps = |name: &str| value(&comparison, name, "steps").unwrap();
    assert_eq!((steps("finest") / 4.0).ceil(), steps("case"));
}

#[test]
fn parallel_runs_give_the_numbers_of_runs_one_by_one() {
    let work = tempfile::tempdir().unwrap();
    let choices = Choices {
        beside: Vec::new(),
        schemes: words(&["theta", "theta={theta=0.6}", "newmark"]),
        ..Choices::default()
    };
    let input = two_bars(20, EXACT);
    let table = |jobs: usize| {
        let folder = work.path().join(jobs.to_string());
        let comparison = sweep(&folder, jobs, |sweep| compare(&input, &choices, sweep))
            .unwrap()
            .0;
        let mut table = comparison.table();
        let wall = table
            .heads
            .iter()
            .position(|head| head == "wall time")
            .unwrap();
        table.rows.iter_mut().for_each(|row| drop(row.remove(wall)));
        table.rows
    };
    assert_eq!(table(1), table(3));
}

#[test]
fn refused_pairs_keep_their_rows_and_wrong_words_are_bad_input() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path().join("case.compare");
    let input = two_bars(10, EXACT);
    let choices = Choices {
        beside: Vec::new(),
        schemes: words(&["theta", "central-difference"]),
        laws: words(&["displacement", "velocity"]),
        reference: None,
    };
    let comparison = compared(&folder, &input, &choices);
    let refused = &comparison.variants[2];
    assert_eq!(refused.name, "central-difference_displacement");
    assert!(matches!(&refused.outcome, Outcome::Refused(reason) if reason.contains("explicit")));
    let done = comparison.variants.iter().filter(|v| v.done().is_some());
    assert_eq!(done.count(), 3);
    let nothing = work.path().join("nothing");
    let wrong = |scheme: &[&str], law: &[&str], reference: Option<&str>| {
        let choices = Choices {
            beside: Vec::new(),
            schemes: words(scheme),
            laws: words(law),
            reference: reference.map(str::to_owned),
        };
        match sweep(&nothing, 1, |sweep| compare(&input, &choices, sweep)) {
            Err(SweepError::Input { problems, .. }) => problems[0].clone(),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(
        wrong(&["newmrk"], &[], None).nearest.as_deref(),
        Some("newmark")
    );
    assert_eq!(
        wrong(&["theta={thta=1}"], &[], None).nearest.as_deref(),
        Some("theta")
    );
    assert_eq!(
        wrong(&["theta"], &[], Some("thet")).nearest.as_deref(),
        Some("theta")
    );
    // no pair at all can be run
    assert!(
        wrong(&["central-difference"], &["displacement"], None)
            .message
            .contains("explicit")
    );
    assert!(!nothing.exists());
}

fn studied(folder: &Path, input: &Input, vary: &[&str]) -> Study {
    let vary: Vec<Axis> = vary.iter().map(|text| Axis::read(text).unwrap()).collect();
    sweep(folder, 1, |sweep| study(input, &vary, sweep))
        .unwrap()
        .0
}

#[test]
fn impulse_and_restitution_of_two_bars_converge_with_the_width_of_the_front() {
    let work = tempfile::tempdir().unwrap();
    let elements = "50,100,200,400";
    let vary = ["one", "two"].map(|bar| format!("mesh.generate.{bar}.line.elements={elements}"));
    let study = studied(
        work.path().join("s").as_path(),
        &two_bars(10, EXACT),
        &[&vary.join(";")],
    );
    let orders = study.orders();
    let of = |quantity| {
        orders
            .iter()
            .find(|order| order.quantity == quantity)
            .unwrap()
    };
    // the impulse and the restitution lack the dispersed front, which is as wide as h^0.69 over these sizes
    for quantity in [Quantity::Impulse, Quantity::Restitution] {
        let fit = of(quantity).fit.unwrap();
        assert!((fit.order - 0.69).abs() < 0.02, "{quantity:?}: {fit:?}");
        assert!(fit.error_bar.unwrap() < 0.02, "{quantity:?}: {fit:?}");
        assert_eq!(of(quantity).source, Source::Exact);
        assert_eq!(of(quantity).consecutive.len(), 3);
    }
    let force = of(Quantity::ForceError).fit.unwrap();
    assert!((force.order - 0.36).abs() < 0.03, "{force:?}");
    let energy = of(Quantity::EnergyChange).fit.unwrap();
    assert!((energy.order - 1.0).abs() < 0.02, "{energy:?}");
    assert!(
        orders
            .iter()
            .all(|order| order.quantity != Quantity::PeakForce)
    );
}

#[test]
fn without_an_exact_solution_the_order_comes_from_differences() {
    let work = tempfile::tempdir().unwrap();
    let elements = "50,100,200,400";
    let vary = ["one", "two"].map(|bar| format!("mesh.generate.{bar}.line.elements={elements}"));
    let folder = work.path().join("s");
    let study = studied(&folder, &two_bars(10, ""), &[&vary.join(";")]);
    let orders = study.orders();
    let energy = orders
        .iter()
        .find(|o| o.quantity == Quantity::EnergyChange)
        .unwrap();
    assert_eq!(energy.source, Source::Differences);
    assert!((energy.fit.unwrap().order - 1.0).abs() < 0.05, "{energy:?}");
    for file in [
        "study.csv",
        "orders.csv",
        "plots/orders.svg",
        "plots/force.svg",
        "report.html",
    ] {
        assert!(folder.join(file).is_file(), "{file}");
    }
    assert!(folder.join("1-elements-50/summary.json").is_file());
}

#[test]
fn a_fit_finds_the_parameter_that_made_the_result() {
    let work = tempfile::tempdir().unwrap();
    let input = two_bars(20, EXACT);
    let truth = 0.7;
    let folder = work.path().join("truth");
    let choices = Choices {
        beside: Vec::new(),
        schemes: vec![format!("theta={{theta={truth}}}")],
        ..Choices::default()
    };
    let made = compared(&folder, &input, &choices);
    let name = made.variants[0].name.clone();
    let restitution = value(&made, &name, "restitution").unwrap();
    let histories = folder.join(name).join("histories.csv");
    let goals = [
        (format!("restitution={restitution}"), 1e-6),
        (format!("force={}", histories.display()), 1e-3),
    ];
    for (goal, tolerance) in goals {
        let wanted = Fit::read("time.scheme.theta.theta", "0.5,1.0", &goal, None).unwrap();
        let fitted = sweep(&work.path().join("fit"), 1, |sweep| {
            fit(&input, &wanted, sweep)
        });
        let (study, path) = fitted.unwrap();
        let found = study.fitted.as_ref().unwrap().found.clone().unwrap();
        let theta = found.value;
        assert!((theta - truth).abs() < tolerance, "{goal}: {theta}");
        assert!(study.runs.len() < 25, "{}", study.runs.len());
        // a wanted history is drawn under the force of the nearest trial, and under that one alone
        let figure = fs::read_to_string(work.path().join("fit/plots/force.svg"));
        let page = fs::read_to_string(&path).unwrap();
        match goal.starts_with("force") {
            true => {
                let figure = figure.unwrap();
                assert!(figure.contains("\nwanted\n"), "{figure}");
                let drawn = study.runs.iter();
                let drawn = drawn.filter(|run| figure.contains(&run.variant.name));
                assert_eq!(drawn.count(), 1);
                assert!(page.contains("The pale line is the wanted history"));
            }
            false => assert!(!page.contains("wanted history")),
        }
    }
    let far = Fit::read(
        "time.scheme.theta.theta",
        "0.5,1.0",
        "restitution=0.2",
        None,
    )
    .unwrap();
    let (study, _) = sweep(&work.path().join("fit"), 1, |sweep| {
        fit(&input, &far, sweep)
    })
    .unwrap();
    assert!(study.fitted.unwrap().found.is_err());
}

#[test]
fn a_goal_that_is_none_is_refused() {
    for (between, goal) in [
        ("1,0", "restitution=0.5"),
        ("0", "restitution=0.5"),
        ("0,1", "restitution"),
        ("0,1", "restitution=much"),
        ("0,1", "rest=0.5"),
        ("0,1", "force=nowhere.csv"),
    ] {
        let read = Fit::read("time.scheme.theta.theta", between, goal, None);
        assert!(
            matches!(read, Err(SweepError::Input { .. })),
            "{between} {goal}"
        );
    }
}

#[test]
fn of_several_forces_that_of_the_contact_counts() {
    let work = tempfile::tempdir().unwrap();
    let file = work.path().join("contact.csv");
    let table = "time_s,contact.left.force_n,contact.far_right.force_n\n0.0,0.0,0.0\n1.0,2.0,3.0\n";
    fs::write(&file, table).unwrap();
    let goal = format!("force={}", file.display());
    let read = |contact| Fit::read("time.scheme.theta.theta", "0.5,1.0", &goal, contact);
    assert!(read(Some("far-right")).is_ok());
    for contact in [None, Some("right")] {
        let Err(SweepError::Input { problems, .. }) = read(contact) else {
            panic!("{contact:?}");
        };
        assert!(problems[0].to_string().contains("several contacts"));
    }
}

#[test]
fn a_grid_has_a_row_for_each_combination_and_orders_for_each_value_of_the_second_axis() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path().join("study");
    let axes = [
        "time.step.courant=0.5,0.25,0.125",
        "time.scheme.theta.theta=0.5,1.0",
    ];
    let input = two_bars(10, EXACT);
    let study = studied(&folder, &input, &axes);
    let names: Vec<&str> = study
        .runs
        .iter()
        .map(|run| run.variant.name.as_str())
        .collect();
    assert_eq!(names.len(), 6);
    assert_eq!(names[0], "1-courant-0.5-theta-0.5");
    assert_eq!(names[5], "6-courant-0.125-theta-1.0");
    let [courant, theta] = &study.keys[..] else {
        panic!("{:?}", study.keys);
    };
    assert_eq!(courant.1, ["0.5", "0.5", "0.25", "0.25", "0.125", "0.125"]);
    assert_eq!(theta.1, ["0.5", "1.0", "0.5", "1.0", "0.5", "1.0"]);
    // each run is that of the study of one axis with the other value set
    for (at, value) in ["0.5", "1.0"].iter().enumerate() {
        let single = folder.with_extension(value);
        let set = format!("time.scheme.theta.theta={value}");
        let text = input.sources[0].text.clone();
        let set = Input::from_text("case.toml", &text, &[set]);
        let one = studied(&single, &set, &axes[..1]);
        for (k, run) in one.runs.iter().enumerate() {
            let same = &study.runs[2 * k + at];
            for quantity in Quantity::ALL {
                assert_eq!(quantity.of(run), quantity.of(same), "{quantity:?}");
            }
        }
        let series = format!("theta {value}");
        let orders = study.orders();
        let orders = orders.iter().filter(|order| order.series == series);
        let points = |orders: &mut dyn Iterator<Item = &carom_studies::study::Order>| {
            orders.map(|order| order.points.clone()).collect::<Vec<_>>()
        };
        assert_eq!(
            points(&mut orders.into_iter()),
            points(&mut one.orders().iter())
        );
    }
    let csv = fs::read_to_string(folder.join("orders.csv")).unwrap();
    assert!(csv.contains("\nimpulse_n_s,theta 1.0,"), "{csv}");
}

/// Two bars between a wall and each other: the second contact closes when the wave has passed.
fn bars_and_wall() -> Input {
    let mut text = two_bars(10, "").sources[0].text.clone();
    text += r#"
[contact.wall]
secondary = "two.right"
obstacle.plane = { point = ["254 mm"], normal = [-1.0] }
law.velocity = {}
"#;
    Input::from_text("case.toml", &text, &[])
}

#[test]
fn the_contact_that_is_looked_at_is_chosen_and_named() {
    let work = tempfile::tempdir().unwrap();
    let looked_at = |contact: Option<&str>| {
        let folder = work.path().join(contact.unwrap_or("default"));
        let choices = Choices {
            beside: Vec::new(),
            reference: Some("none".to_owned()),
            ..Choices::default()
        };
        sweep(&folder, 1, |sweep| {
            let sweep = Sweep { contact, ..*sweep };
            compare(&bars_and_wall(), &choices, &sweep)
        })
    };
    let (first, _) = looked_at(None).unwrap();
    let (wall, _) = looked_at(Some("wall")).unwrap();
    assert_eq!(first.contact(), Some("shock"));
    assert_eq!(wall.contact(), Some("wall"));
    for (comparison, name) in [(&first, "shock"), (&wall, "wall")] {
        let summary = &comparison.variants[0].done().unwrap().summary;
        let impulse = value(comparison, "case", "impulse_n_s");
        assert_eq!(impulse, summary.contacts[name].impulse);
    }
    assert_ne!(
        value(&first, "case", "impulse_n_s"),
        value(&wall, "case", "impulse_n_s")
    );
    match looked_at(Some("wal")) {
        Err(SweepError::Input { problems, .. }) => {
            assert_eq!(problems[0].nearest.as_deref(), Some("wall"));
        }
        other => panic!("{other:?}"),
    }
}
