//! The largest stress of a run is that of its steps, not of the instants that are kept.

use carom_output::Summary;

use crate::verdict::result;

/// A heavy mass at the free end of a light member along x, with a velocity, over ten periods of 2π √(m/k): the kept instants divide each into
/// three.
fn struck(section: &str, velocity: &str, stiffness: f64, scheme: &str) -> Summary {
    let period = std::f64::consts::TAU * (MASS / stiffness).sqrt();
    let (end, step) = (10.0 * period, 1e-3 * period);
    let density = DENSITIES[usize::from(section.contains("beam"))];
    let case = format!(
        r#"
carom = 1
mesh.generate.rod.line = {{ from = [0.0, 0.0], to = [1.0, 0.0], elements = 1 }}
material.light = {{ density = {density:?}, elastic = {{ young = "200 GPa", poisson = 0.0 }} }}
body.rod = {{ region = "rod", material = "light", {section} }}
mass.head = {{ mass = {MASS:?}, on = "rod.right", initial.velocity = {velocity} }}
support.root = {{ on = "rod.left", fix = {fixed} }}
time = {{ end = {end:?}, step = {step:?}, scheme.{scheme} = {{}} }}
output.allowable.body.rod.stress = "100 MPa"
"#,
        fixed = match section.contains("beam") {
            true => r#"["x", "y", "rz"]"#,
            false => r#"["x", "y"]"#,
        }
    );
    result(&case).0
}

const MASS: f64 = 100.0;

/// Of a bar so light that half of it is less than 5e-5 of the mass, and so heavy that a wave takes a step along it; of a beam, whose end turns
/// too, nothing.
const DENSITIES: [f64; 2] = [50.0, 1e-4];

/// The largest stress is v √(k m) times that of a unit force, to the square of the phase of half a step between looks over eight, and the energy of
/// the light member; those of thirds of periods are sin 60° of it.
fn check(summary: &Summary, exact: f64, every: u64) {
    let found = summary.maxima.von_mises.as_ref().unwrap();
    assert_eq!(summary.maxima.stress_every, every);
    // four steps of a thousandth of a period: (0.0126)²/2; and the mass of the member, a quarter of which moves
    assert!(
        (found.value / exact - 1.0).abs() < 1e-4,
        "{found:?} {exact}"
    );
    assert_eq!(found.body, "rod");
    assert_eq!(
        summary.maxima.von_mises_of_bodies[..],
        *std::slice::from_ref(found)
    );
    let [stress] = &summary.allowables[..] else {
        panic!("{:?}", summary.allowables);
    };
    assert_eq!(stress.margin.found, found.value);
    assert_eq!(stress.margin.governing.as_ref().unwrap().1, found.time);
}

#[test]
fn the_largest_stress_of_a_struck_cantilever_is_that_between_the_kept_instants() {
    // F L³/(3 E I), F L c/I of a 40 mm by 20 mm rectangle
    let second_moment = 0.02 * 0.04_f64.powi(3) / 12.0;
    let stiffness = 3.0 * 2e11 * second_moment;
    let section = r#"section.beam = { theory = "euler-bernoulli", shape.rectangle = { height = "40 mm", width = "20 mm" } }"#;
    let summary = struck(section, "[0.0, 0.1]", stiffness, "newmark");
    let force = 0.1 * (stiffness * MASS).sqrt();
    check(&summary, force * 0.02 / second_moment, 1);
}

#[test]
fn the_largest_stress_of_a_struck_bar_is_that_between_the_kept_instants() {
    let stiffness = 2e11 * 1e-4;
    let section = r#"section.bar.area = "1 cm^2""#;
    for (scheme, every) in [("newmark", 1), ("central-difference", 4)] {
        let summary = struck(section, "[0.1, 0.0]", stiffness, scheme);
        check(&summary, 0.1 * (stiffness * MASS).sqrt() / 1e-4, every);
    }
}
