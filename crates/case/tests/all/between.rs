//! What gets between the points of a secondary side is told, whatever body has that side.

use carom_output::Grade;

use crate::verdict::result;

#[test]
fn a_pin_between_the_nodes_of_a_coarse_floor_is_told_of_a_rigid_floor_too() {
    for (rigid, held, on) in [
        ("", r#"["x", "y"]"#, "floor.bottom"),
        (", rigid = {}", r#"["x", "y", "rz"]"#, "floor"),
    ] {
        let case = format!(
            r#"
carom = 1
mesh.generate.floor.rectangle = {{ origin = [0.0, 0.0], size = [2.0, 0.2], elements = [2, 1] }}
mesh.generate.pin.rectangle = {{ origin = [0.4, 0.201], size = [0.2, 0.2], elements = [2, 2] }}
material.m = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.3 }} }}
body.floor = {{ region = "floor", material = "m", section.plane-strain.thickness = 1.0{rigid} }}
body.pin = {{ region = "pin", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [0.0, -1.0] }}
support.f = {{ on = "{on}", fix = {held} }}
contact.c = {{ secondary = "floor.top", primary = "pin.bottom", law.velocity = {{}}, sliding = "finite", integration = "quadrature" }}
time = {{ end = 0.064, step = 2e-4, scheme.theta = {{}} }}
"#
        );
        let summary = result(&case).0;
        let line = summary.verdict.line("penetration-between");
        let line = line.unwrap_or_else(|| panic!("{on}: {:#?}", summary.verdict));
        // it falls freely through 1 mm and then 63 mm, of elements of 100 mm; the last look is at step 320, the end
        assert!((line.value - 0.63).abs() < 1e-9, "{on}: {}", line.value);
        assert_eq!(line.grade, Grade::Look, "{on}");
    }
}
