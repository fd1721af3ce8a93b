//! What gets between the points of a secondary side is told, whatever body has that side.

use carom_case::{Input, build, parse};
use carom_output::Grade;

use crate::verdict::result;

/// A narrow pin on a wide face of a floor, between two nodes of it; `contact`: what lets them touch.
fn pinned((rigid, held, on): (&str, &str, &str), contact: &str) -> String {
    format!(
        r#"
carom = 1
mesh.generate.floor.rectangle = {{ origin = [0.0, 0.0], size = [2.0, 0.2], elements = [2, 1] }}
mesh.generate.pin.rectangle = {{ origin = [0.4, 0.201], size = [0.2, 0.2], elements = [2, 2] }}
material.m = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.3 }} }}
body.floor = {{ region = "floor", material = "m", section.plane-strain.thickness = 1.0{rigid} }}
body.pin = {{ region = "pin", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [0.0, -1.0] }}
support.f = {{ on = "{on}", fix = {held} }}
{contact}
time = {{ end = 0.064, step = 2e-4, scheme.theta = {{}} }}
"#
    )
}

/// At nodes with finite sliding contact is looked for both ways: the pin touches the floor after 1 mm at 1 m/s, whichever side is called secondary, and
/// the same equations give the same force.
#[test]
fn the_side_called_secondary_does_not_decide_whether_there_is_contact() {
    let on = ("", r#"["x", "y"]"#, "floor.bottom");
    let forces = [("floor.top", "pin.bottom"), ("pin.bottom", "floor.top")].map(|sides| {
        let contact = format!(
            r#"contact.c = {{ secondary = "{}", primary = "{}", law.velocity = {{}}, sliding = "finite" }}"#,
            sides.0, sides.1
        );
        let (summary, histories) = result(&pinned(on, &contact));
        let first = summary.contacts["c"].first_closing.unwrap();
        assert!((first - 1e-3).abs() <= 2e-4, "{first}");
        // the force is that on the secondary body, 200 kg/m are thrown up
        let up = histories["contact.c.resultant_y_n"].iter().sum::<f64>();
        assert_eq!(up > 0.0, sides.0 == "pin.bottom");
        histories["contact.c.force_n"].clone()
    });
    let largest = forces[0]
        .iter()
        .fold(0.0_f64, |most, force| most.max(*force));
    for (one, other) in forces[0].iter().zip(&forces[1]) {
        assert!((one - other).abs() < 1e-9 * largest, "{one} {other}");
    }
}

/// Deeper than an element, where points in the run do not see what they are behind.
#[test]
fn a_deep_overlap_at_the_start_is_refused() {
    let on = ("", r#"["x", "y"]"#, "floor.bottom");
    let contact = r#"contact.c = { secondary = "pin.bottom", primary = "floor.top", law.velocity = {}, sliding = "finite" }"#;
    let case = pinned(on, contact);
    let case = case.replace("[0.4, 0.201]", "[0.4, 0.05]");
    let case = case.replace("elements = [2, 1]", "elements = [2, 4]");
    let input = Input::from_text("case.toml", &case, &[]);
    let (case, locator) = parse(&input).unwrap();
    let problems = build(&case, &locator, &input).err().unwrap();
    let told = problems[0].to_string();
    assert!(told.contains("3 points penetrate at the start"), "{told}");
}

#[test]
fn a_pin_between_the_nodes_of_a_coarse_floor_is_told_of_a_rigid_floor_too() {
    for (rigid, held, on) in [
        ("", r#"["x", "y"]"#, "floor.bottom"),
        (", rigid = {}", r#"["x", "y", "rz"]"#, "floor"),
    ] {
        let contact = r#"contact.c = { secondary = "floor.top", primary = "pin.bottom", law.velocity = {}, sliding = "finite", integration = "quadrature" }"#;
        let case = pinned((rigid, held, on), contact);
        let summary = result(&case).0;
        let line = summary.verdict.line("penetration-between");
        let line = line.unwrap_or_else(|| panic!("{on}: {:#?}", summary.verdict));
        // it falls freely through 1 mm and then 63 mm, of elements of 100 mm; the last look is at step 320, the end
        assert!((line.value - 0.63).abs() < 1e-9, "{on}: {}", line.value);
        assert_eq!(line.grade, Grade::Look, "{on}");
    }
}
