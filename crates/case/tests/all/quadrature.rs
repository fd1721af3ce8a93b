//! `integration = "quadrature"` from the text to the summary.

use carom_case::{Input, build, parse, run};
use carom_contact::Integration;
use carom_dynamics::System;
use carom_output::Grade;

use carom_dynamics::Silent;

/// A block of 5 elements of 0.2 m that comes down on a slope.
fn text(contact: &str) -> Input {
    let text = format!(
        r#"
carom = 1
title = "Block on a slope"
mesh.generate.block.rectangle = {{ origin = [0.0, 0.0], size = [1.0, 1.0], elements = [5, 5] }}
material.rubber = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.0 }} }}
body.block = {{ region = "block", material = "rubber", section.plane-strain.thickness = 1.0, initial.velocity = [0.0, -5.0] }}
time = {{ end = "4 ms", step.courant = 0.5, scheme.theta.theta = 1.0 }}
[contact.slope]
secondary = "block.bottom"
obstacle.plane = {{ point = [0.0, 0.0], normal = [0.01, 1.0] }}
{contact}
"#
    );
    Input::from_text("case.toml", &text, &[])
}

fn integration(contact: &str) -> Integration {
    let input = text(contact);
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    let system: &System = &built.system;
    let points = match system.contacts[0].integration {
        Integration::Node => 6,
        Integration::Points | Integration::Weak { .. } => 10,
        Integration::Mortar { .. } => panic!("no mortar was asked for"),
    };
    assert_eq!(system.points(), points);
    system.contacts[0].integration
}

#[test]
fn r_comes_from_the_case_or_from_the_material() {
    let r_of = |contact: &str| match integration(contact) {
        Integration::Weak { r } => r,
        other => panic!("{other:?}"),
    };
    let near = |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-12);
    assert_eq!(integration("law.displacement = {}"), Integration::Node);
    // E / h, and ρ c = sqrt(ρ E) without lateral strain
    let displacement = "law.displacement = {}\nintegration";
    near(r_of(&format!("{displacement} = 'quadrature'")), 5e9);
    near(r_of(&format!("{displacement}.quadrature = {{}}")), 5e9);
    near(
        r_of(&format!("{displacement}.quadrature.r = '2 GPa/m'")),
        2e9,
    );
    let velocity = "law.velocity = {}\nintegration";
    near(r_of(&format!("{velocity} = 'quadrature'")), 1e6);
    // both may be given, for the comparison of laws
    let both = "quadrature = { r = 7.0, r-v = '3 MPa*s/m' }";
    near(r_of(&format!("{velocity} = {{ {both} }}")), 3e6);
    let penalty = "law.penalty.stiffness = '1 GPa/m'\nintegration = 'quadrature'";
    assert_eq!(integration(penalty), Integration::Points);
}

#[test]
fn the_summary_counts_the_nodes_with_mixed_supports() {
    let mixed = |contact: &str| {
        let input = text(contact);
        let (case, locator) = parse(&input).unwrap();
        let built = build(&case, &locator, &input).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("results");
        let finished = run((&input, &case, &built), folder, &mut Silent, &|| false).unwrap();
        let contact = &finished.summary.contacts["slope"];
        let verdict = &finished.summary.verdict;
        // the scheme takes 40 % of the energy, which the verdict tells
        let bad = verdict
            .lines
            .iter()
            .filter(|line| line.grade != Grade::Good);
        assert!(
            bad.map(|line| line.name.as_str()).eq(["scheme-loss"]),
            "{verdict:?}"
        );
        assert!(contact.peak_force > 0.0);
        contact.mixed_supports
    };
    let laws = ["law.displacement = {}", "law.velocity = {}"];
    for law in laws {
        // the slope closes from one side within a few steps, and at its front one or two nodes are mixed at a time
        let weak = mixed(&format!("{law}\nintegration = 'quadrature'"));
        assert!(weak.is_some_and(|nodes| nodes >= 1), "{law}: {weak:?}");
        assert_eq!(mixed(law), None);
    }
}
