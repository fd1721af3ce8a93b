//! Grades of what springs, fluid gaps and shells assume of the motion of their ends, and defaults that hold for what is modelled.

use carom_output::{Grade, Summary};

use crate::verdict::result;

fn graded(summary: &Summary, line: &str) -> (Grade, f64) {
    let line = summary.verdict.line(line);
    let line = line.unwrap_or_else(|| panic!("{:#?}", summary.verdict));
    (line.grade, line.value)
}

/// Two masses 2 m apart, with a spring along x between them; the second moves across it at this speed for a second.
fn turning(speed: f64, axis: &str) -> Summary {
    let case = format!(
        r#"
carom = 1
mass.p = {{ mass = 1.0, at = [0.0, 0.0] }}
mass.q = {{ mass = 1.0, at = [2.0, 0.0], initial.velocity = [0.0, {speed:?}] }}
spring.k = {{ ends = ["p", "q"], {axis} stiffness = 1.0 }}
time = {{ end = 1.0, step = 1e-2, scheme.newmark = {{}} }}
"#
    );
    result(&case).0
}

const ALONG: &str = "axis = [1.0, 0.0],";

#[test]
fn a_spring_whose_ends_turn_about_each_other_is_told_that_its_axis_does_not() {
    // nothing acts across the axis: the angle is atan(v t/L)
    for (speed, expected) in [(0.1, Grade::Good), (0.3, Grade::Look), (1.0, Grade::Bad)] {
        let (grade, angle) = graded(&turning(speed, ALONG), "axis-rotation");
        assert_eq!(grade, expected, "{angle}");
        // looks are every 32 steps, the last one at 0.96 s
        let exact = (0.96 * speed / 2.0_f64).atan();
        assert!((angle / exact - 1.0).abs() < 1e-6, "{angle} {exact}");
    }
    // in all directions there is no axis
    let all = turning(1.0, "");
    assert!(all.verdict.line("axis-rotation").is_none());
}

#[test]
fn a_mass_that_moves_where_its_only_spring_holds_nothing_is_not_good() {
    let spring = |springs: &str| {
        let case = format!(
            r#"
carom = 1
mass.p = {{ mass = 1.0, at = [1.0, 0.0], initial.velocity = [0.5, 3.0] }}
{springs}
time = {{ end = 5.0, step = 1e-3, scheme.newmark = {{}} }}
"#
        );
        result(&case).0
    };
    let along = r#"spring.k = { ends = ["p", "ground"], axis = [1.0, 0.0], stiffness = 1e5 }"#;
    let (grade, angle) = graded(&spring(along), "axis-rotation");
    // 15 m aside, millimetres along
    assert!(grade == Grade::Bad && angle > 1.5, "{angle}");
    // one for each axis is a spring in the plane
    let across = r#"spring.l = { ends = ["p", "ground"], axis = [0.0, 1.0], stiffness = 1e5 }"#;
    let both = spring(&format!("{along}\n{across}"));
    assert!(both.verdict.line("axis-rotation").is_none());
}

/// A cylinder that moves in a shell around it, 10 mm away all around, by its share of the momentum.
fn in_fluid(speed: f64, given: &str) -> Summary {
    let case = format!(
        r#"
carom = 1
mass.i = {{ mass = 1.0, at = [0.0, 0.0, 0.0], initial.velocity = [{speed:?}, 0.0, 0.0] }}
mass.o = {{ mass = 2.0, at = [0.0, 0.0, 0.0] }}
spring.hold = {{ ends = ["o", "ground"], stiffness = 1e9 }}
fluid.f = {{ inner = "i", outer = "o", {given}, length = 0.1, axis = [0.0, 0.0, 1.0] }}
time = {{ end = 1.0, step = 1e-2, scheme.newmark = {{}} }}
"#
    );
    result(&case).0
}

#[test]
fn a_body_that_moves_further_than_its_fluid_gap_is_wide_is_bad() {
    let gap = "diameters = [0.1, 0.12], density = 1000.0";
    for (way, expected) in [(0.3, Grade::Good), (0.7, Grade::Look), (100.0, Grade::Bad)] {
        let (grade, value) = graded(&in_fluid(0.01 * way, gap), "fluid-gap");
        assert_eq!(grade, expected, "{value}");
        // the shell hardly moves, and a look is at 0.96 s
        assert!((value / (0.96 * way) - 1.0).abs() < 0.05, "{value} {way}");
    }
    // masses without a gap
    let none = in_fluid(1.0, "relative-mass = 1.0");
    assert!(none.verdict.line("fluid-gap").is_none());
}

/// A strip of a shell, 1 m long and 10 mm thick, under forces at its end: across it, and in its plane. `more`: of the body.
fn strip(rotations: &str, forces: [f64; 2], more: &str) -> Summary {
    let [across, within] = forces;
    let case = format!(
        r#"
carom = 1
mesh.dimension = 3
mesh.generate.s.rectangle = {{ origin = [0.0, 0.0], size = [1.0, 0.1], elements = [10, 1] }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e7, poisson = 0.0 }} }}
body.s = {{ region = "s", material = "m", section.shell = {{ thickness = 0.01, rotations = "{rotations}" }}{more} }}
support.c = {{ on = "s.left", fix = ["x", "y", "z", "rx", "ry", "rz"] }}
load.F = {{ on = "s.right", force = [0.0, {within:?}, {across:?}] }}
time = {{ end = 1.0, static = {{ end = 1.0, steps = 4 }} }}
"#
    );
    result(&case).0
}

#[test]
fn a_shell_with_small_rotations_that_bends_far_is_bad_and_told_what_to_write() {
    // F L²/(2 E I): 2 F 6e5 / 1e7, of both nodes of the end
    for (force, expected) in [(1e-5, Grade::Good), (5e-3, Grade::Look), (0.05, Grade::Bad)] {
        let summary = strip("small", [force, 0.0], "");
        let (grade, angle) = graded(&summary, "small-strain-rotation");
        let slope = 2.0 * force / (2.0 * 1e7 * 0.1 * 0.01_f64.powi(3) / 12.0);
        assert!((angle / slope - 1.0).abs() < 0.02, "{angle} {slope}");
        assert_eq!(grade, expected, "{angle}");
    }
    let far = strip("small", [0.05, 0.0], "");
    let line = far.verdict.line("small-strain-rotation").unwrap();
    assert!(
        line.remedy.contains("rotations = \"finite\""),
        "{}",
        line.remedy
    );
    let finite = strip("finite", [0.05, 0.0], "");
    assert!(finite.verdict.line("small-strain-rotation").is_none());
}

#[test]
fn shells_with_one_point_bend_in_their_plane_unless_the_case_says_otherwise() {
    let deflection = |more: &str| {
        let summary = strip("finite", [0.0, 1e-3], more);
        summary.maxima.displacement.as_ref().unwrap().value
    };
    // F L³/(3 E I) and F L/(G A) of shear, of two nodes
    let (second_moment, area) = (0.01 * 0.1_f64.powi(3) / 12.0, 1e-3);
    let exact = 2e-3 / (3.0 * 1e7 * second_moment) + 2e-3 / (0.5e7 * area);
    // a constant moment in each of ten elements, 1/(4 · 10²) too stiff, and the clamped end: within the 2 % of `one-point-shells`
    let usual = deflection(", formulation.reduced = {}");
    assert!((usual / exact - 1.0).abs() < 0.02, "{usual} {exact}");
    let soft = deflection(", formulation.reduced = { hourglass = 0.05 }");
    assert!(soft > 5.0 * exact, "{soft} {exact}");
    // it is the stiffness of the material, and its energy no fault
    let summary = strip("finite", [0.0, 1e-3], ", formulation.reduced = {}");
    assert!(summary.verdict.line("hourglass").is_none());
}
