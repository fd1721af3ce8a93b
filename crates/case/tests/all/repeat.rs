//! Tables that stand for many.

use carom_case::schema::Case;
use carom_case::{Input, Problem, parse};

fn read(text: &str, overrides: &[&str]) -> Result<Case, Vec<Problem>> {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    let read = parse(&Input::from_text("case.toml", text, &overrides));
    read.map(|(case, _)| case)
}

const ROW: &str = r#"
carom = 1

[repeat]
n = [1, 3]
gap = [0, 3]
k = [1, 2]

[mass."m{n}-{k}"]
mass = "1 kg"
at = ["{n*0.5-0.25} m", "{k} m"]

[mass.m2-1]
mass = "3 kg"

[mass."m{gap*4}-{k}"]
mass = "9 kg"
at = ["{gap*2-0.25} m", "{k} m"]

[stop."g{k}-{gap}"]
ends = ["m{gap}-{k}", "m{gap+1}-{k}"]
axis = [1.0, 0.0]
stiffness = "1 MN/m"
gap = "1 mm"

[stop."g{k}-3"]
gap = "2 mm"

[time]
end = "1 ms"
step = "10 us"
scheme.newmark = {}
"#;

#[test]
fn a_table_with_indices_is_made_for_each_of_their_values() {
    let case = read(ROW, &[]).unwrap();
    assert_eq!(case.stop.names().count(), 8);
    let stop = case.stop.get("g2-1").unwrap();
    assert_eq!(stop.ends, ["m1-2", "m2-2"]);
    // fewer indices count before more, and what is written out before all
    assert_eq!(stop.gap.unwrap().0, 1e-3);
    assert_eq!(case.stop.get("g2-3").unwrap().gap.unwrap().0, 2e-3);
    assert_eq!(case.stop.get("g2-3").unwrap().ends, ["m3-2", "m4-2"]);
    let mass = |name: &str| case.mass.get(name).unwrap();
    assert_eq!(mass("m2-1").mass.0, 3.0);
    assert_eq!(mass("m2-2").mass.0, 1.0);
    let place = |name: &str| mass(name).at.as_ref().unwrap().0.clone();
    assert_eq!(
        place("m3-2").iter().map(|x| x.0).collect::<Vec<_>>(),
        [1.25, 2.0]
    );
    assert_eq!(mass("m12-1").mass.0, 9.0);
}

#[test]
fn overrides_see_the_tables_as_they_are_written() {
    let stops = |overrides: &[&str]| read(ROW, overrides).unwrap().stop;
    let all = stops(&[r#"stop."g{k}-{gap}".gap=4 mm"#]);
    assert_eq!(all.get("g1-0").unwrap().gap.unwrap().0, 4e-3);
    assert_eq!(all.get("g1-3").unwrap().gap.unwrap().0, 2e-3);
    let one = stops(&["stop.g1-1.gap=5 mm"]);
    assert_eq!(one.get("g1-1").unwrap().gap.unwrap().0, 5e-3);
    assert_eq!(one.get("g1-1").unwrap().ends, ["m1-1", "m2-1"]);
    assert_eq!(stops(&["repeat.k=[1, 1]"]).names().count(), 4);
}

#[test]
fn indices_that_make_no_sense_are_told_where_they_stand() {
    let told = |old: &str, new: &str| {
        assert!(ROW.contains(old));
        read(&ROW.replacen(old, new, 1), &[]).unwrap_err().remove(0)
    };
    for (old, new, path, message) in [
        (
            "gap = [0, 3]",
            "gap = [3, 0]",
            "repeat.gap",
            "an index has a name",
        ),
        (
            "gap = [0, 3]",
            "gap = [0, 3.5]",
            "repeat.gap",
            "an index has a name",
        ),
        (
            "gap = [0, 3]",
            "gap = 3",
            "repeat.gap",
            "an index has a name",
        ),
        (
            "k = [1, 2]",
            "k = [1, 9000]",
            r#"mass."m{n}-{k}""#,
            "one table stands for more",
        ),
        (
            "m{gap+1}-{k}",
            "m{gab+1}-{k}",
            r#"stop.g1-0.ends[1]"#,
            "no index of `[repeat]`",
        ),
        (
            "m{gap+1}-{k}",
            "m{gap+1-{k}",
            r#"stop.g1-0.ends[1]"#,
            "no index of `[repeat]`",
        ),
        (
            "m{gap+1}-{k}",
            "m{n}-{k}",
            r#"stop.g1-0.ends[1]"#,
            "`n` has no value here",
        ),
        (r#""g{k}-3""#, r#""g{n}-3""#, "stop.g3-3", "is missing"),
        (
            "\"g{k}-3\"]\ngap",
            "\"g{k}-{gap+1}\"]\ngap",
            "stop.g1-1",
            "made twice",
        ),
    ] {
        let problem = told(old, new);
        let told = format!("{}: {}", problem.path, problem.message);
        assert!(told.starts_with(path) && told.contains(message), "{told}");
        assert!(problem.place.is_some(), "{told}");
    }
}
