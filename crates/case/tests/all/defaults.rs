//! What a contact is where the case does not say it: how far it slides, where its law holds.

use carom_case::{Built, Input, Problem, build, facts, parse};
use carom_contact::{Integration, Sliding};

/// A square over a plate, 0.1 m apart.
fn text(material: &str, contact: &str, place: f64) -> Input {
    let text = format!(
        r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [{place}, 0.1], size = [1.0, 1.0], elements = [4, 4] }}
mesh.generate.b.rectangle = {{ origin = [0.0, -1.0], size = [4.0, 1.0], elements = [8, 2] }}
material.m = {{ density = 1000.0, {material} = {{ young = 1e6, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [1.0, -1.0] }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 1.0 }}
time = {{ end = 0.1, step = 1e-3, scheme.theta = {{}} }}
[contact.c]
secondary = "a.bottom"
primary = "b.top"
law.velocity = {{}}
{contact}
"#
    );
    Input::from_text("case.toml", &text, &[])
}

fn built(input: &Input) -> Result<Built, Vec<Problem>> {
    let (case, locator) = parse(input).unwrap();
    build(&case, &locator, input)
}

fn sliding(material: &str, contact: &str) -> Sliding {
    built(&text(material, contact, 1.5))
        .unwrap()
        .system
        .contacts[0]
        .sliding
}

#[test]
fn sliding_is_finite_where_steps_are_not_linear_anyway_unless_the_case_says_otherwise() {
    for (material, contact, expected) in [
        ("elastic", "", Sliding::Small),
        ("neo-hooke", "", Sliding::Finite),
        ("elastic", "friction.coulomb = 0.3", Sliding::Finite),
        ("elastic", "integration = 'mortar'", Sliding::Finite),
        ("elastic", "sliding = 'finite'", Sliding::Finite),
        ("neo-hooke", "sliding = 'small'", Sliding::Small),
    ] {
        assert_eq!(sliding(material, contact), expected, "{material} {contact}");
    }
}

#[test]
fn a_contact_that_can_never_act_is_refused_unless_it_slides() {
    let refused = built(&text("neo-hooke", "sliding = 'small'", -2.0)).unwrap_err();
    let [problem] = &refused[..] else {
        panic!("{refused:?}");
    };
    let told = format!("{problem:?}");
    for word in ["contact.c", "can never act", "sliding = \\\"finite\\\""] {
        assert!(told.contains(word), "{word}: {told}");
    }
    assert!(built(&text("elastic", "", -2.0)).is_err());
    let sliding = built(&text("neo-hooke", "", -2.0)).unwrap();
    let told = facts(&sliding);
    let contact = told.iter().find(|fact| fact.name == "contact c").unwrap();
    assert!(
        contact
            .value
            .contains("finite sliding, nothing opposite at the start"),
        "{contact:?}"
    );
}

/// A square of eight nodes on a plate of four.
fn quadratic(contact: &str, time: &str) -> (tempfile::TempDir, Input) {
    let mesh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 3 \"a.bottom\"\n1 4 \"b.top\"\n2 1 \"a\"\n2 2 \"b\"\n$EndPhysicalNames\n$Nodes\n12\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0.5 0 0\n6 1 0.5 0\n7 0.5 1 0\n8 0 0.5 0\n9 -1 -1 0\n10 2 -1 0\n11 2 0 0\n12 -1 0 0\n$EndNodes\n$Elements\n4\n1 16 2 1 1 1 2 3 4 5 6 7 8\n2 3 2 2 2 9 10 11 12\n3 8 2 3 3 1 2 5\n4 1 2 4 4 11 12\n$EndElements\n";
    let text = format!(
        r#"
carom = 1
mesh.file = "square.msh"
material.m = {{ density = 1000.0, elastic = {{ young = 1e6, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 1.0 }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 1.0 }}
contact.c = {{ secondary = "a.bottom", primary = "b.top", law.displacement = {{}}, {contact} }}
time = {{ end = 0.1, step = 1e-3, scheme.{time} }}
"#
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("case.toml");
    std::fs::write(&file, text).unwrap();
    std::fs::write(folder.path().join("square.msh"), mesh).unwrap();
    let input = Input::read(&file, &[]).unwrap();
    (folder, input)
}

#[test]
fn quadratic_faces_are_integrated_by_mortar_and_check_says_so() {
    let (_folder, input) = quadratic("", "newmark = { beta = 0.49, gamma = 0.9 }");
    let found = built(&input).unwrap();
    assert!(matches!(
        found.system.contacts[0].integration,
        Integration::Mortar { .. }
    ));
    assert_eq!(found.warnings, Vec::<String>::new());
    let told = facts(&found);
    let contact = told.iter().find(|fact| fact.name == "contact c").unwrap();
    assert!(
        contact.value.contains("by mortar (quadratic faces)"),
        "{contact:?}"
    );
    // what is asked for is taken, and told
    let (_folder, input) = quadratic(
        "integration = 'node'",
        "newmark = { beta = 0.49, gamma = 0.9 }",
    );
    let found = built(&input).unwrap();
    assert_eq!(found.system.contacts[0].integration, Integration::Node);
    assert!(
        found.warnings[0].contains("oscillate by a third"),
        "{:?}",
        found.warnings
    );
    // any scheme takes it
    let (_folder, input) = quadratic("", "krenk = {}");
    let found = built(&input).unwrap();
    assert!(matches!(
        found.system.contacts[0].integration,
        Integration::Mortar { .. }
    ));
}
