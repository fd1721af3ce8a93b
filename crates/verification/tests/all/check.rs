//! Rows, and the run over checks.

use carom_verification::inside::verify;
use carom_verification::{Check, Error, Kind, Made, Row, Size};

#[test]
fn printed_number_gives_a_unit_of_its_last_digit() {
    let printed = |value, digits| Row::printed(Kind::OtherCode, "x", value, digits);
    assert!(printed(0.04709, "0.0470").holds());
    assert!(!printed(0.04711, "0.0470").holds());
    assert!(printed(-0.0401, "-0.05").holds());
    assert!(printed(11.0, "10.9").holds());
    assert!(printed(59.0, "59").holds());
    assert!(!printed(60.0, "59").holds());
    assert!(!printed(1.0, "one").holds());
    assert_eq!(printed(1.0, "one").kind, Kind::OtherCode);
}

#[test]
fn what_is_no_number_holds_nowhere() {
    let rows = [
        Row::near("x", f64::NAN, 0.0, f64::INFINITY),
        Row::at_most("x", f64::NAN, f64::INFINITY),
        Row::at_least("x", f64::NAN, -1.0),
        Row::shown("x", f64::NAN),
    ];
    assert!(rows.iter().all(|row| !row.holds()));
}

#[test]
fn any_number_that_is_shown_holds_and_says_so() {
    for value in [0.0, -1e300, f64::INFINITY] {
        let row = Row::shown("x", value);
        assert!(row.holds());
        assert!(row.to_string().starts_with("info"));
    }
}

#[test]
fn every_row_ends_with_its_kind() {
    let row = || Row::at_most("x", 1.0, 2.0);
    let rows = [
        row(),
        row().published(),
        row().other_code(),
        row().second_formulation(),
        row().regression(),
        Row::shown("x", 1.0),
    ];
    for (row, kind) in rows.iter().zip(Kind::ALL) {
        assert!(row.to_string().ends_with(kind.name()), "{row}");
    }
}

fn check(name: &'static str, run: fn(Size) -> Result<Vec<Row>, Error>) -> Check {
    Check {
        name,
        fact: "",
        run,
    }
}

#[test]
fn failures_are_counted_by_kind_and_the_filter_is_a_part_of_the_name() {
    let rows = |_| {
        Ok(vec![
            Row::at_most("a", 1.0, 2.0),
            Row::at_most("b", 3.0, 2.0),
            Row::at_most("c", 3.0, 2.0).regression(),
            Row::shown("d", 3.0),
        ])
    };
    let failing = |_| Err(Error::Group { name: "g".into() });
    let checks = [check("one", rows), check("two", failing)];
    let run = |filter| {
        let mut out = Vec::new();
        let (verdict, made) = verify(&checks, filter, (Size::Quick, false), &mut out).unwrap();
        assert_eq!(made.len(), verdict.checks);
        assert!(!made.iter().any(Made::holds));
        let text = String::from_utf8(out).unwrap();
        (verdict, text.lines().last().unwrap().to_string())
    };
    let (verdict, summary) = run(None);
    let [rows, failed] =
        [verdict.rows, verdict.failed].map(|counts| Kind::ALL.map(|kind| counts.of(kind)));
    assert_eq!(rows, [2, 0, 0, 0, 1, 1]);
    assert_eq!(failed, [1, 0, 0, 0, 1, 0]);
    assert_eq!((verdict.checks, verdict.unmade), (2, 1));
    assert_eq!(
        summary,
        "2 checks, 4 rows: 2 closed form, 1 regression, 1 information; 2 failed: 1 closed form, 1 regression; \
         checks that could not be made: 1"
    );
    assert!(!verdict.holds());
    assert_eq!(run(Some("on")).0.checks, 1);
    let (none, summary) = run(Some("three"));
    assert!(!none.holds());
    assert_eq!(summary, "0 checks, 0 rows; 0 failed");
}

#[test]
fn a_check_that_only_shows_holds() {
    let checks = [check("one", |_| Ok(vec![Row::shown("d", 3.0)]))];
    let (verdict, _) = verify(&checks, None, (Size::Quick, false), &mut Vec::new()).unwrap();
    assert!(verdict.holds());
}
