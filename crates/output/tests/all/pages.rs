//! The summary and the report.

use std::collections::BTreeMap;

use carom_output::summary::{self, Contact, Energy, Exact, Momentum};
use carom_output::verdict::{Bounds, Grade, Line, Verdict};
use carom_output::{ImpactRow, Report, Summary};
use carom_pages::form::Form;

fn line(value: f64, bounds: Bounds) -> Line {
    let quantity = "energy residual relative to the largest energy";
    Line::new(
        "energy-residual",
        (quantity, value, Form::Power),
        bounds,
        "a smaller step",
    )
}

/// The verdict on one line, bad above 1e-9.
fn verdict(value: f64) -> Verdict {
    Verdict::new(None, vec![line(value, Bounds::Bad(1e-9))], Vec::new())
}

fn sample(verdict: Verdict) -> Summary {
    let contact = Contact {
        law: "velocity, capture = half".to_owned(),
        peak_force: 7.46e4,
        restitution: Some(0.9904),
        ..Contact::default()
    };
    let energy = Energy {
        kinetic_initial: 16.94,
        works: BTreeMap::from([("scheme".to_owned(), -0.02)]),
        residual: 5e-14,
        ..Energy::default()
    };
    Summary {
        version: "0.1.0".to_owned(),
        title: "Bars <script>alert(1)</script> & walls".to_owned(),
        case_hash: summary::hash("case"),
        verdict,
        model: summary::Model::default(),
        scheme: "theta, theta = 0.5".to_owned(),
        time: summary::Time {
            end: 1.5e-4,
            steps: 1200,
            ..summary::Time::default()
        },
        zones: None,
        contacts: BTreeMap::from([("shock".to_owned(), contact)]),
        levels: BTreeMap::new(),
        loads: BTreeMap::new(),
        discrete: BTreeMap::new(),
        pretensions: BTreeMap::new(),
        maxima: Default::default(),
        expectations: None,
        allowables: Vec::new(),
        energy,
        momentum: Momentum {
            initial: [6.6, 0.0, 0.0],
            ..Momentum::default()
        },
        exact: Some(Exact {
            name: "two-bars".to_owned(),
            contact: "shock".to_owned(),
            force_error: Some(0.047),
            ..Exact::default()
        }),
        counts: summary::Counts::default(),
        newton: None,
        timings: BTreeMap::from([("solve".to_owned(), 0.1234)]),
        warnings: vec!["the step is long".to_owned()],
        notices: Vec::new(),
        outputs: vec!["summary.json".to_owned()],
    }
}

/// The page of a summary without a program.
fn page(summary: &Summary) -> String {
    let report = Report {
        summary,
        impacts: &[],
        figures: &[],
        case: "",
        tiles: &[],
        quality: &[],
        data: None,
    };
    report.html().unwrap()
}

#[test]
fn what_rounding_leaves_of_a_zero_is_0_in_the_tables_but_for_residuals() {
    let mut summary = sample(verdict(0.0));
    summary.momentum = Momentum {
        initial: [6.6, -0.0, 3e-17],
        r#final: [6.6, -4e-16, 0.0],
        residual: [0.0, -4e-16, 0.0],
        size: 6.6,
        ..Momentum::default()
    };
    let page = page(&summary);
    let row = |label: &str| {
        let begin = page
            .find(&format!("<th scope=\"row\">{label}</th><td>6.6"))
            .unwrap();
        let end = page[begin..].find("</tr>").unwrap();
        page[begin..begin + end].to_owned()
    };
    for label in ["Start", "End"] {
        assert!(
            row(label).ends_with("<td>0</td><td>0</td>"),
            "{}",
            row(label)
        );
    }
    assert!(
        page.contains("<td>−4.000·10⁻¹⁶</td>"),
        "the residual shows rounding"
    );
}

#[test]
fn a_page_has_landmarks_with_names() {
    let page = page(&sample(verdict(0.0)));
    let [main, end] = ["<main>", "</main>"].map(|tag| page.find(tag).unwrap());
    assert!(
        main < page.find("class=\"tiles\"").unwrap() && page.find("id=\"case\"").unwrap() < end
    );
    for named in [
        "<nav aria-label=",
        "class=\"tiles\" aria-label=",
        "<section id=\"verdict\"",
    ] {
        assert!(page.contains(named), "{named}");
    }
}

#[test]
fn a_line_is_graded_by_its_bounds_and_what_is_no_number_is_bad() {
    let both = Bounds::Both(1e-9, 1e-6);
    for (value, bounds, grade) in [
        (1e-9, Bounds::Bad(1e-9), Grade::Good),
        (-1.1e-9, Bounds::Bad(1e-9), Grade::Bad),
        (-1e-9, both, Grade::Good),
        (1.1e-9, both, Grade::Look),
        (-1e-6, both, Grade::Look),
        (1.1e-6, both, Grade::Bad),
        (1e300, Bounds::Look(1.0), Grade::Look),
        (f64::NAN, Bounds::Look(1.0), Grade::Bad),
        (f64::NAN, both, Grade::Bad),
        (f64::INFINITY, Bounds::Bad(1e-9), Grade::Bad),
    ] {
        assert_eq!(line(value, bounds).grade, grade, "{value} {bounds:?}");
    }
    let line = line(2e-9, both);
    assert_eq!(
        line.text(),
        "energy residual relative to the largest energy: 2.0·10⁻⁹ (look above 1.0·10⁻⁹, bad above 1.0·10⁻⁶); a smaller step"
    );
}

#[test]
fn the_verdict_is_the_worst_of_its_lines_and_bad_if_the_run_is_not_complete() {
    let bounds = Bounds::Both(1e-9, 1e-6);
    let of = |values: &[f64]| {
        let lines = values.iter().map(|value| line(*value, bounds)).collect();
        Verdict::new(None, lines, vec!["mesh".to_owned()])
    };
    assert_eq!(of(&[0.0, 1e-10]).grade, Grade::Good);
    assert!(of(&[0.0, 1e-10]).reasons().is_empty());
    assert_eq!(of(&[0.0, 1e-8, 0.0]).grade, Grade::Look);
    let bad = of(&[1e-8, 0.0, 1.0, 1e-7]);
    assert_eq!(bad.grade, Grade::Bad);
    let reasons = bad.reasons();
    assert_eq!(reasons.len(), 3);
    assert!(
        reasons[0].contains(": 1.0 (") || reasons[0].contains(": 1.0·10⁰ ("),
        "{}",
        reasons[0]
    );
    let mut cut = of(&[0.0]);
    cut.incomplete("stopped by the user".to_owned());
    assert_eq!(cut.grade, Grade::Bad);
    assert_eq!(cut.reasons(), ["stopped by the user"]);
}

#[test]
fn a_summary_comes_back_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("summary.json");
    let summary = sample(verdict(1e-12));
    summary.write(&path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(Summary::from_json(&text).unwrap(), summary);
    assert!(text.contains("\"first_closing\": null"));
    assert!(text.contains("\"grade\": \"good\""));
}

#[test]
fn a_residual_that_is_not_a_number_is_null_and_read_as_such() {
    let mut summary = sample(verdict(f64::NAN));
    summary.energy.residual = f64::INFINITY;
    let text = summary.to_json().unwrap();
    assert!(text.contains("\"residual\": null") && text.contains("\"value\": null"));
    let read = Summary::from_json(&text).unwrap();
    assert!(read.energy.residual.is_nan() && read.verdict.lines[0].value.is_nan());
    assert_eq!(read.verdict.grade, Grade::Bad);
}

#[test]
fn the_fingerprint_is_fnv_1a() {
    // Fowler, Noll, Vo: test vectors of the 64-bit variant.
    assert_eq!(summary::hash(""), "cbf29ce484222325");
    assert_eq!(summary::hash("a"), "af63dc4c8601ec8c");
    assert_eq!(summary::hash("foobar"), "85944171f73967e8");
}

fn page_of(summary: &Summary, impacts: &[ImpactRow], figures: &[String]) -> String {
    Report {
        summary,
        impacts,
        figures,
        case: "title = \"<b>\" # & more",
        tiles: &[],
        quality: &[],
        data: None,
    }
    .html()
    .unwrap()
}

#[test]
fn the_report_says_what_the_summary_says() {
    let figures = ["<svg><!-- one --></svg>".to_owned()];
    let html = page_of(&sample(verdict(1e-12)), &[], &figures);
    for text in [
        "Good: the run is complete",
        "74.6 kN",
        "0.990",
        "16.94000",
        "5.000·10⁻¹⁴",
        "4.70 %",
        "150 µs",
        "1200",
        "123 ms",
        "the step is long",
        "<svg><!-- one --></svg>",
    ] {
        assert!(html.contains(text), "{text}");
    }
    assert!(!html.contains("Impacts"), "no table without rows");
    let bad = page_of(&sample(verdict(1.0)), &[], &figures);
    assert!(bad.contains("Not to be relied on") && bad.contains("Remedy: a smaller step"));
    // each line leads to the plot of its quantity
    let line = |grade| format!(">{grade}</b> <a href=\"#plot-residual\">energy residual");
    assert!(bad.contains(&line("bad")) && html.contains(&line("good")));
}

#[test]
fn the_report_without_its_program_runs_nothing_and_asks_for_nothing() {
    let html = page_of(&sample(Verdict::default()), &[], &[]);
    assert!(!html.contains("<script") && !html.contains("http") && !html.contains("src="));
    assert!(
        html.contains("Bars &lt;script&gt;alert(1)&lt;&#x2f;script&gt; &amp; walls"),
        "text is escaped"
    );
    assert!(html.contains("&lt;b&gt;&quot; # &amp; more"));
    for tag in [
        "table", "tbody", "thead", "tr", "th", "td", "div", "section", "ul", "li", "p",
    ] {
        let opened =
            html.matches(&format!("<{tag}>")).count() + html.matches(&format!("<{tag} ")).count();
        assert_eq!(opened, html.matches(&format!("</{tag}>")).count(), "{tag}");
    }
}

#[test]
fn what_does_not_exist_is_a_dash() {
    let impact = ImpactRow {
        pair: "shock".to_owned(),
        start: 0.0,
        duration: None,
        peak_force: 1.0,
        peak_steps: 1,
        peak_mean_force: Some(1.0),
        window: 1e-6,
        impulse: 1.0,
        approach_speed: Some(1.0),
        rebound_speed: None,
        restitution: None,
        energy_given: Some(1.0),
        energy_taken: 1.0,
        energy_lost: 1.0,
        energy_crushed: 0.0,
        friction_loss: 0.0,
        intervals: 1,
        impulsive: 0.0,
    };
    let html = page_of(&sample(Verdict::default()), &[impact], &[]);
    let row = html
        .lines()
        .find(|line| line.starts_with("<tr><th scope=\"row\">shock</th>"))
        .unwrap();
    assert_eq!(row.matches("<td>–</td>").count(), 3);
    let body = html.split_once("</style>").unwrap().1;
    assert!(!body.contains("none") && !body.contains("NaN"));
}
