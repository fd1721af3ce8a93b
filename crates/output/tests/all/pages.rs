//! The summary and the report.

use std::collections::BTreeMap;

use carom_output::summary::{self, Check, Contact, Energy, Exact, Momentum, Verdict};
use carom_output::{ImpactRow, Report, Summary};

fn check(value: f64) -> Check {
    Check {
        quantity: "energy residual / initial energy".to_owned(),
        value,
        bound: 1e-9,
    }
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
        outputs: vec!["summary.json".to_owned()],
    }
}

#[test]
fn the_verdict_is_good_only_if_the_run_is_complete_and_every_check_holds() {
    assert!(Verdict::new(None, vec![check(1e-9), check(-1e-10)]).good);
    for value in [1.1e-9, -1.1e-9, f64::NAN, f64::INFINITY] {
        let verdict = Verdict::new(None, vec![check(0.0), check(value)]);
        assert!(!verdict.good);
        assert_eq!(verdict.reasons.len(), 1);
        assert!(verdict.reasons[0].starts_with("energy residual / initial energy is "));
    }
    let cut = Verdict::new(Some("stopped by the user".to_owned()), vec![check(0.0)]);
    assert!(!cut.good);
    assert_eq!(cut.reasons, ["stopped by the user"]);
}

#[test]
fn a_summary_comes_back_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("summary.json");
    let summary = sample(Verdict::new(None, vec![check(1e-12)]));
    summary.write(&path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(Summary::from_json(&text).unwrap(), summary);
    assert!(text.contains("\"first_closing\": null"));
    assert!(text.contains("\"good\": true"));
}

#[test]
fn a_residual_that_is_not_a_number_is_null_and_read_as_such() {
    let mut summary = sample(Verdict::new(None, vec![check(f64::NAN)]));
    summary.energy.residual = f64::INFINITY;
    let text = summary.to_json().unwrap();
    assert!(text.contains("\"residual\": null") && text.contains("\"value\": null"));
    let read = Summary::from_json(&text).unwrap();
    assert!(read.energy.residual.is_nan() && read.verdict.checks[0].value.is_nan());
    assert!(!read.verdict.good);
}

#[test]
fn the_fingerprint_is_fnv_1a() {
    // Fowler, Noll, Vo: test vectors of the 64-bit variant.
    assert_eq!(summary::hash(""), "cbf29ce484222325");
    assert_eq!(summary::hash("a"), "af63dc4c8601ec8c");
    assert_eq!(summary::hash("foobar"), "85944171f73967e8");
}

fn page(summary: &Summary, impacts: &[ImpactRow], figures: &[String]) -> String {
    Report {
        summary,
        impacts,
        figures,
        case: "title = \"<b>\" # & more",
    }
    .html()
    .unwrap()
}

#[test]
fn the_report_says_what_the_summary_says() {
    let figures = ["<svg><!-- one --></svg>".to_owned()];
    let html = page(
        &sample(Verdict::new(None, vec![check(1e-12)])),
        &[],
        &figures,
    );
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
    let bad = page(&sample(Verdict::new(None, vec![check(1.0)])), &[], &figures);
    assert!(bad.contains("Not to be relied on") && bad.contains("is 1.000e0; its bound is 1.0e-9"));
    assert!(bad.contains(">fails<") && html.contains(">holds<"));
}

#[test]
fn the_report_is_one_file_that_runs_nothing_and_asks_for_nothing() {
    let html = page(&sample(Verdict::default()), &[], &[]);
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
        peak_mean_force: 1.0,
        window: 1e-6,
        impulse: 1.0,
        approach_speed: 1.0,
        rebound_speed: None,
        restitution: None,
        energy_given: 1.0,
        energy_lost: 1.0,
        energy_crushed: 0.0,
    };
    let html = page(&sample(Verdict::default()), &[impact], &[]);
    let row = html
        .lines()
        .find(|line| line.starts_with("<tr><th scope=\"row\">shock</th>"))
        .unwrap();
    assert_eq!(row.matches("<td>–</td>").count(), 3);
    let body = html.split_once("</style>").unwrap().1;
    assert!(!body.contains("none") && !body.contains("NaN"));
}
