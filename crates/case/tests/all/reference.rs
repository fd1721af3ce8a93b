//! `[reference]`: from a case to its exact solution.

use carom_case::{Built, Input, build, parse};

/// A steel bar of 0.4 m and 6 cm² at 5 m/s, 12.3 µm from an aluminium bar of 0.6 m and 4 cm² at rest, with more in the case.
fn built(more: &str) -> Result<Built, String> {
    let text = format!(
        r#"
carom = 1
mesh.generate.striker.line = {{ from = ["-400 mm"], to = [0.0], elements = 40 }}
mesh.generate.target.line = {{ from = ["12.3 um"], to = ["600.0123 mm"], elements = 62 }}
material.steel = {{ density = 7800.0, elastic = {{ young = "210 GPa", poisson = 0.0 }} }}
material.aluminium = {{ density = 2700.0, elastic = {{ young = "70 GPa", poisson = 0.0 }} }}
body.striker = {{ region = "striker", material = "steel", section.bar.area = "6 cm^2", initial.velocity = [5.0] }}
body.target = {{ region = "target", material = "aluminium", section.bar.area = "4 cm^2" }}
contact.shock = {{ secondary = "striker.right", primary = "target.left", law.velocity = {{}} }}
time = {{ end = "400 us", step.courant = 0.5, scheme.theta = {{}} }}
[reference.two-bars]
{more}
"#
    );
    made(&text)
}

fn made(text: &str) -> Result<Built, String> {
    with(text, &[])
}

fn with(text: &str, changes: &[String]) -> Result<Built, String> {
    let input = Input::from_text("case.toml", text, changes);
    let all = |problems: Vec<carom_case::Problem>| {
        let texts = problems.iter().map(ToString::to_string);
        texts.collect::<Vec<_>>().join("; ")
    };
    let (case, locator) = parse(&input).map_err(all)?;
    build(&case, &locator, &input).map_err(all)
}

fn close(found: f64, exact: f64, relative: f64) {
    assert!((found / exact - 1.0).abs() < relative, "{found} {exact}");
}

#[test]
fn bars_of_unequal_section_and_material_have_their_own_impedances() {
    let solution = built("").unwrap().reference.unwrap().solution;
    // Z = A √(E ρ), F = Z Z' w/(Z + Z'), and after the return from the steel (Z - Z')/(Z + Z') of it; the case has its numbers to
    // rounding
    let z = 6e-4 * f64::sqrt(2.1e11 * 7800.0);
    let other = 4e-4 * f64::sqrt(7e10 * 2700.0);
    let first = z * other / (z + other) * 5.0;
    close(solution.first_contact().unwrap(), 12.3e-6 / 5.0, 1e-9);
    close(solution.force().value(1e-4), first, 1e-12);
    close(
        solution.force().value(2e-4),
        first * (z - other) / (z + other),
        1e-12,
    );
    // another implementation, to its digits
    close(first, 22418.6, 5e-6);
    close(solution.impulse(400e-6), 4.60883, 2e-6);
}

#[test]
fn plane_bars_of_unequal_thickness_have_the_solution_of_bars() {
    let plane = |thickness: f64| {
        let text = format!(
            r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [-1.0, 0.0], size = [1.0, 0.2], elements = [10, 2] }}
mesh.generate.b.rectangle = {{ origin = [0.0, 0.0], size = [2.0, 0.2], elements = [20, 2] }}
material.m = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.0 }} }}
body.a = {{ region = "a", material = "m", section.plane-stress.thickness = 0.1, initial.velocity = [2.0] }}
body.b = {{ region = "b", material = "m", section.plane-stress.thickness = {thickness} }}
contact.c = {{ secondary = "a.right", primary = "b.left", law.velocity = {{}} }}
time = {{ end = "1 ms", step.courant = 0.5, scheme.theta = {{}} }}
reference.two-bars = {{}}
support.end = {{ on = "b.right", fix = ["x"] }}
"#
        );
        made(&text).unwrap().reference.unwrap().solution
    };
    for thickness in [0.1, 0.3] {
        let (z, other) = (0.02 * 1e6, 0.2 * thickness * 1e6);
        let solution = plane(thickness);
        close(
            solution.force().value(1e-4),
            z * other / (z + other) * 2.0,
            1e-12,
        );
        // the far end of b is clamped: no momentum is left to the two alone
        assert!((solution.momentum(9e-4) - solution.momentum(0.0)).abs() < 1e-9 * 40.0);
        assert_eq!(
            solution.motions()[1].bar().far_end,
            carom_exact::FarEnd::Clamped
        );
    }
}

#[test]
fn what_acts_on_the_bars_beside_contact_and_gravity_is_refused_by_name() {
    let cases = [
        ("body.striker.damping.mass=1.0", "damping of a body"),
        ("contact.shock.friction.coulomb=0.3", "friction"),
        (
            "support.s={ on = \"target.right\", move = { x = [{ time = 0, displacement = 0 }, { time = 1, displacement = 1 }] } }",
            "support that moves",
        ),
    ];
    for (line, what) in cases {
        let message = with(INPUT, &[line.to_owned()]).unwrap_err();
        assert!(message.contains(what), "{message}");
    }
    made(INPUT).unwrap();
}

const INPUT: &str = r#"
carom = 1
mesh.generate.striker.line = { from = [-1.0], to = [0.0], elements = 4 }
mesh.generate.target.line = { from = [0.0], to = [1.0], elements = 4 }
material.steel = { density = 7800.0, elastic = { young = "210 GPa", poisson = 0.0 } }
time = { end = "400 us", step.courant = 0.5, scheme.theta = {} }
reference.two-bars = {}
[body.striker]
region = "striker"
material = "steel"
section.bar.area = "6 cm^2"
initial.velocity = [5.0]
[body.target]
region = "target"
material = "steel"
section.bar.area = "6 cm^2"
[contact.shock]
secondary = "striker.right"
primary = "target.left"
law.velocity = {}
"#;
