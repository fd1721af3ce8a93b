//! Case files with something wrong anywhere: problems that are told, or a model; never a panic.

use carom_case::{Input, build, parse};
use carom_testing::damage::damaged;

/// A case with most kinds of values: quantities, vectors, names, choices, tables in lines.
const CASE: &str = r#"
carom = 1
title = "two"
mesh.generate.a.rectangle = { origin = [0.0, 0.0], size = ["2 cm", 0.1], elements = [2, 1] }
mesh.generate.b.rectangle = { origin = [0.0, 0.11], size = [0.02, 0.1], elements = [2, 1] }
material.m = { density = "1000 kg/m^3", elastic = { young = 1e7, poisson = 0.3 } }
body.a = { region = "a", material = "m", section.plane-strain.thickness = 0.5 }
body.b = { region = "b", material = "m", section.plane-strain.thickness = "10 mm", initial.velocity = [0.0, "-1 m/s"] }
support.s = { on = "a.bottom", fix = ["x", "y"] }

[contact.c]
secondary = "b.bottom"
primary = "a.top"
law.velocity = { capture = "half" }
friction.coulomb = 0.3

[time]
end = "8 ms"
step = { courant = 0.5 }
scheme.theta = { theta = 0.5 }

[probe.p]
on = "b.top"
record = ["velocity"]
"#;

#[test]
fn damaged_cases_are_refused_with_their_problems_or_built() {
    let (mut state, mut refused) = (11, 0);
    for _ in 0..3000 {
        let content = damaged(CASE.as_bytes(), &mut state);
        let text = String::from_utf8_lossy(&content);
        let input = Input::from_text("case.toml", &text, &[]);
        let built = parse(&input).and_then(|(case, locator)| build(&case, &locator, &input));
        if let Err(problems) = built {
            assert!(!problems.is_empty());
            refused += 1;
        }
    }
    // most places are those of a key, a name or a unit
    assert!((1500..3000).contains(&refused), "{refused}");
}
