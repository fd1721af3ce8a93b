//! What is strange about a case without being wrong.

use carom_case::{Input, build, parse};

/// Warnings of two bars of 10 elements of 25.4 mm, c = 5137 m/s, with the damped law.
fn warnings(law: &str, courant: f64, scheme: &str) -> Vec<String> {
    let text = format!(
        r#"
carom = 1
mesh.generate.one.line = {{ from = ["-254 mm"], to = [0.0], elements = 10 }}
mesh.generate.two.line = {{ from = [0.0], to = ["254 mm"], elements = 10 }}
material.steel = {{ density = 7844.0, elastic = {{ young = "207 GPa", poisson = 0.0 }} }}
body.one = {{ region = "one", material = "steel", section.bar.area = "645 mm^2", initial.velocity = [5.1359] }}
body.two = {{ region = "two", material = "steel", section.bar.area = "645 mm^2" }}
contact.shock = {{ secondary = "one.right", primary = "two.left", law.damped = {law} }}
time = {{ end = "150 us", step.courant = {courant}, scheme.{scheme} }}
"#
    );
    let input = Input::from_text("case.toml", &text, &[]);
    let (case, locator) = parse(&input).unwrap();
    build(&case, &locator, &input).unwrap().warnings
}

#[test]
fn a_spring_too_stiff_for_an_implicit_step_is_told_with_its_remedy() {
    let theta = "theta.theta = 0.5";
    // the default k = E / h has 2 sqrt(k h / E) CFL = 2 CFL
    assert!(warnings("{}", 1.0, theta).is_empty());
    let told = warnings("{}", 2.0, theta);
    let [warning] = &told[..] else {
        panic!("{told:?}");
    };
    let h_over_c = 0.0254 / (207e9_f64 / 7844.0).sqrt();
    for word in [
        "contact `shock`".to_owned(),
        "2 sqrt(k h/E) CFL = 4.000".to_owned(),
        format!("a step of at most {h_over_c:.4e} s"),
        "a stiffness 0.250 times".to_owned(),
    ] {
        assert!(warning.contains(&word), "{word}: {warning}");
    }
    // both remedies are enough: k is 8.15e12 Pa/m by default
    assert!(warnings("{ stiffness = 2.03e12 }", 2.0, theta).is_empty());
    assert_eq!(warnings("{ stiffness = 2.06e12 }", 2.0, theta).len(), 1);
}

#[test]
fn an_explicit_scheme_has_its_critical_step_instead() {
    let law = "{ stiffness = 1e13 }";
    assert!(warnings(law, 0.4, "central-difference = {}").is_empty());
    assert_eq!(warnings(law, 0.95, "theta.theta = 0.5").len(), 1);
}

#[test]
fn a_step_in_which_bodies_come_nearer_by_more_than_an_element_is_told() {
    let text = |speed: f64, step: f64| {
        format!(
            r#"
carom = 1
mesh.generate.one.line = {{ from = [0.0], to = [1.0], elements = 10 }}
mesh.generate.two.line = {{ from = [2.0], to = [3.0], elements = 5 }}
material.soft = {{ density = 1.0, elastic = {{ young = 1.0, poisson = 0.0 }} }}
body.one = {{ region = "one", material = "soft", section.bar.area = 1.0, initial.velocity = [{speed}] }}
body.two = {{ region = "two", material = "soft", section.bar.area = 1.0, initial.velocity = [-1.0] }}
contact.shock = {{ secondary = "one.right", primary = "two.left", law.velocity = {{}} }}
time = {{ end = 2.0, step = {step}, scheme.theta.theta = 0.5 }}
"#
        )
    };
    let told = |speed, step| {
        let input = Input::from_text("case.toml", &text(speed, step), &[]);
        let (case, locator) = parse(&input).unwrap();
        build(&case, &locator, &input).unwrap().warnings
    };
    // elements of 0.1 m come nearer at speed + 1 m/s
    assert!(told(1.0, 0.0499).is_empty());
    let warnings = told(1.0, 0.1);
    let [warning] = &warnings[..] else {
        panic!("{warnings:?}");
    };
    for word in ["`shock`", "by 2.0000e-1 m", "(1.0000e-1 m)", "5.0000e-2 s"] {
        assert!(warning.contains(word), "{word}: {warning}");
    }
    // what moves away does not pass through
    assert!(told(-1.5, 0.5).is_empty());
}

/// Two squares of one body on each other, with nodes of their own where they meet, or `apart` (m) above.
fn two_pieces(apart: f64, tied: bool) -> Vec<String> {
    let text = format!(
        r#"
carom = 1
mesh.file = "pieces.msh"
material.m = {{ density = 1000.0, elastic = {{ young = 1e8, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 1.0 }}
{}
time = {{ end = 0.1, step = 1e-4, scheme.theta = {{}} }}
"#,
        match tied {
            true =>
                "body.b = { region = \"b\", material = \"m\", section.plane-strain.thickness = 1.0 }",
            false => "",
        }
    );
    let between = match tied {
        true => "\n3 3 2 2 2 1 2 6 5",
        false => "",
    };
    let mesh = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"a\"\n2 2 \"b\"\n$EndPhysicalNames\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 -1 0\n4 0 -1 0\n5 0 {apart} 0\n6 1 {apart} 0\n7 1 2 0\n8 0 2 0\n$EndNodes\n$Elements\n{}\n1 3 2 1 1 4 3 2 1\n2 3 2 1 1 5 6 7 8{between}\n$EndElements\n",
        if tied { 3 } else { 2 }
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("case.toml");
    std::fs::write(&file, text).unwrap();
    std::fs::write(folder.path().join("pieces.msh"), mesh).unwrap();
    let input = Input::read(&file, &[]).unwrap();
    let (case, locator) = parse(&input).unwrap();
    build(&case, &locator, &input).unwrap().warnings
}

#[test]
fn a_body_in_pieces_is_told_with_the_closest_nodes_unless_another_body_joins_them() {
    let told = two_pieces(0.0, false);
    let [warning] = &told[..] else {
        panic!("{told:?}");
    };
    for word in [
        "body `a`",
        "2 pieces",
        "0 at (0.000000, 0.000000, 0.000000) m and 4,",
        "merge the nodes",
    ] {
        assert!(warning.contains(word), "{word}: {warning}");
    }
    let told = two_pieces(0.5, false);
    assert!(
        told[0].contains("are 5.0000e-1 m apart") && told[0].contains("a body of its own"),
        "{told:?}"
    );
    assert_eq!(two_pieces(0.5, true), Vec::<String>::new());
}

#[test]
fn pairs_of_scheme_and_law_that_the_chapter_advises_against_are_told_with_the_reason() {
    let told = |scheme: &str, law: &str| {
        let text = format!(
            r#"
carom = 1
mesh.generate.one.line = {{ from = [0.0], to = [1.0], elements = 10 }}
mesh.generate.two.line = {{ from = [1.0], to = [2.0], elements = 10 }}
material.soft = {{ density = 1.0, elastic = {{ young = 1.0, poisson = 0.0 }} }}
body.one = {{ region = "one", material = "soft", section.bar.area = 1.0, initial.velocity = [0.1] }}
body.two = {{ region = "two", material = "soft", section.bar.area = 1.0 }}
contact.shock = {{ secondary = "one.right", primary = "two.left", law.{law} }}
time = {{ end = 2.0, step.courant = 0.5, scheme.{scheme} }}
"#
        );
        let input = Input::from_text("case.toml", &text, &[]);
        let (case, locator) = parse(&input).unwrap();
        build(&case, &locator, &input).unwrap().warnings
    };
    for (scheme, law, reason) in [
        ("newmark = {}", "displacement = {}", "gains energy"),
        ("newmark = {}", "velocity = {}", "every other step"),
        ("theta = {}", "displacement = {}", "oscillates"),
        ("laursen-chawla = {}", "velocity = {}", "chatters"),
        ("laursen-love = {}", "displacement = {}", "chatters"),
        ("hht = {}", "displacement = {}", "chatters"),
    ] {
        let warnings = told(scheme, law);
        let [warning] = &warnings[..] else {
            panic!("{scheme}, {law}: {warnings:?}");
        };
        assert!(
            warning.contains("`shock`") && warning.contains(reason),
            "{warning}"
        );
    }
    for (scheme, law) in [
        ("theta = {}", "velocity = {}"),
        ("theta.theta = 1.0", "displacement = {}"),
        ("newmark = {}", "displacement.projection = true"),
        (
            "newmark = { beta = 0.49, gamma = 0.9 }",
            "displacement = {}",
        ),
        ("central-difference = {}", "velocity = {}"),
        ("paoli-schatzman = {}", "displacement = {}"),
    ] {
        assert!(told(scheme, law).is_empty(), "{scheme}, {law}");
    }
}

#[test]
fn a_support_that_jumps_at_the_start_is_told() {
    let told = |course: &str, more: &str| {
        let text = format!(
            r#"
carom = 1
mesh.generate.bar.line = {{ from = [0.0], to = [1.0], elements = 5 }}
material.soft = {{ density = 1.0, elastic = {{ young = 1.0, poisson = 0.0 }} }}
body.bar = {{ region = "bar", material = "soft", section.bar.area = 1.0 }}
support.end = {{ on = "bar.left", move.x = {course} }}
time = {{ end = 2.0, step = 0.1, scheme.newmark = {{}}{more} }}
"#
        );
        let input = Input::from_text("case.toml", &text, &[]);
        let (case, locator) = parse(&input).unwrap();
        build(&case, &locator, &input).unwrap().warnings
    };
    let from = |start: f64| {
        format!("[{{ time = 0.0, displacement = {start} }}, {{ time = 1.0, displacement = 0.1 }}]")
    };
    assert!(told(&from(0.0), "").is_empty());
    let warnings = told(&from(0.02), "");
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(
        warnings[0].starts_with("support.end.move.x: the displacement is 2.0000e-2 m at time 0")
    );
    // the first value holds before its time
    assert_eq!(told("[{ time = 0.5, displacement = 0.1 }]", "").len(), 1);
    // equilibrium is found, and nothing jumps
    assert!(told(&from(0.02), ", static = { end = 1.0, steps = 2 }").is_empty());
}

#[test]
fn contacts_with_exchanged_sides_are_told() {
    let text = r#"
carom = 1
mesh.generate.one.line = { from = [0.0], to = [1.0], elements = 5 }
mesh.generate.two.line = { from = [1.0], to = [2.0], elements = 5 }
material.soft = { density = 1.0, elastic = { young = 1.0, poisson = 0.0 } }
body.one = { region = "one", material = "soft", section.bar.area = 1.0 }
body.two = { region = "two", material = "soft", section.bar.area = 1.0 }
contact.a = { secondary = "one.right", primary = "two.left", law.penalty.stiffness = 1.0 }
contact.b = { secondary = "two.left", primary = "one.right", law.penalty.stiffness = 1.0 }
time = { end = 2.0, step = 0.1, scheme.theta = {} }
"#;
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let warnings = build(&case, &locator, &input).unwrap().warnings;
    assert!(
        warnings[0].starts_with("contact `b`: the contact `a` joins the same faces"),
        "{warnings:?}"
    );
}

#[test]
fn a_law_per_area_on_the_larger_of_two_sections_is_told() {
    let told = |areas: [f64; 2], law: &str| {
        let [one, two] = areas;
        let text = format!(
            r#"
carom = 1
mesh.generate.one.line = {{ from = [0.0], to = [1.0], elements = 5 }}
mesh.generate.two.line = {{ from = [1.0], to = [2.0], elements = 5 }}
material.soft = {{ density = 1.0, elastic = {{ young = 1.0, poisson = 0.0 }} }}
body.one = {{ region = "one", material = "soft", section.bar.area = {one} }}
body.two = {{ region = "two", material = "soft", section.bar.area = {two} }}
contact.shock = {{ secondary = "one.right", primary = "two.left", law.{law} }}
time = {{ end = 2.0, step = 0.1, scheme.theta = {{}} }}
"#
        );
        let input = Input::from_text("case.toml", &text, &[]);
        let (case, locator) = parse(&input).unwrap();
        build(&case, &locator, &input).unwrap().warnings
    };
    let penalty = "penalty.stiffness = 1.0";
    let warnings = told([3.0, 2.0], penalty);
    assert!(
        warnings[0].contains("which is 1.5000 times that of the primary one"),
        "{warnings:?}"
    );
    assert!(told([2.0, 3.0], penalty).is_empty());
    assert!(told([2.0, 2.0], penalty).is_empty());
    // a force between nodes, whatever their areas
    assert!(told([3.0, 2.0], "velocity = {}").is_empty());
}

/// A beam along the common edge of the cells of a solid, from inside of it, with what joins them.
fn beam_in_a_solid(joint: &str, from: f64) -> Vec<String> {
    let text = format!(
        r#"
carom = 1
mesh.generate.tip.box = {{ origin = [0.0, -0.01, -0.01], size = [0.1, 0.02, 0.02], elements = [10, 2, 2] }}
mesh.generate.bar.line = {{ from = [{from:?}, 0.0, 0.0], to = [0.5, 0.0, 0.0], elements = 44 }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e8, poisson = 0.3 }} }}
body.tip = {{ region = "tip", material = "m" }}
body.bar = {{ region = "bar", material = "m", section.beam = {{ shape.rectangle = {{ height = 0.02, width = 0.02 }}, orientation = [0.0, 1.0, 0.0] }} }}
time = {{ end = 0.1, step = 1e-4, scheme.theta = {{}} }}
{joint}
"#
    );
    let input = Input::from_text("case.toml", &text, &[]);
    let (case, locator) = parse(&input).unwrap();
    build(&case, &locator, &input).unwrap().warnings
}

#[test]
fn a_beam_in_a_solid_to_which_nothing_joins_it_is_told() {
    let told = beam_in_a_solid("", 0.06);
    let told: Vec<_> = told
        .iter()
        .filter(|told| told.contains("arlequin"))
        .collect();
    let [warning] = &told[..] else {
        panic!("{told:?}");
    };
    // 0.06, 0.07, ... 0.1 m, with the one on the face
    assert!(
        warning.starts_with("5 nodes of body `bar`, the first at (0.060000,"),
        "{warning}"
    );
    assert!(warning.contains("the solid `tip`"), "{warning}");
    let zones = "zone.a.bodies = [\"tip\"]\nzone.b.bodies = [\"bar\"]";
    let glued = format!("{zones}\narlequin.glue = {{ inner = \"tip\", outer = \"bar\" }}");
    let ended = "transition.joint = { end = \"bar.left\", face = \"tip.right\" }";
    for (joint, from) in [(&glued[..], 0.06), (ended, 0.1), ("", 0.11)] {
        let told = beam_in_a_solid(joint, from);
        let joins = told.iter().any(|told| told.contains("nothing joins"));
        assert!(!joins, "{joint}: {told:?}");
    }
}

/// Beams of 20 mm fly at each other with 20 m/s: in a step of more than 1 ms their middles can pass each other unseen.
#[test]
fn a_step_in_which_middles_may_pass_each_other_is_told() {
    let told = |step: &str| {
        let text = format!(
            r#"
carom = 1
mesh.generate.a.line = {{ from = [0.0, 0.0], to = [1.0, 0.0], elements = 8 }}
mesh.generate.b.line = {{ from = [0.1, 0.1], to = [0.9, 0.1], elements = 5 }}
material.m = {{ density = 7800.0, elastic = {{ young = "210 GPa", poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.beam.shape.circle.diameter = "2 cm" }}
body.b = {{ region = "b", material = "m", section.beam.shape.circle.diameter = "2 cm", initial.velocity = [0.0, -20.0] }}
contact.both = {{ secondary = "b", primary = "a", integration = "mortar", law.velocity = {{}} }}
time = {{ end = "12 ms", step = "{step}", scheme.theta = {{}} }}
"#
        );
        let input = Input::from_text("case.toml", &text, &[]);
        let (case, locator) = parse(&input).unwrap();
        build(&case, &locator, &input).unwrap().warnings
    };
    assert_eq!(told("0.9 ms"), Vec::<String>::new());
    let found = told("4 ms");
    // 80 mm in a step, 20 mm between the middles: at most 1 ms
    let passes =
        |told: &String| told.contains("distance of the middles") && told.contains("1.0000e-3 s");
    assert!(found.iter().any(passes), "{found:?}");
}

/// Warnings of a case.
fn told(text: &str) -> Vec<String> {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap();
    build(&case, &locator, &input).unwrap().warnings
}

/// 1 kg on 10^4 N/m vibrates with 62.83 ms.
#[test]
fn a_mass_on_a_spring_that_the_steps_do_not_follow_is_told() {
    let text = |step: &str| {
        format!(
            r#"
carom = 1
mass.bob = {{ mass = 1.0, at = [1.0], initial.velocity = [1.0] }}
spring.rod = {{ ends = ["bob", "ground"], axis = [1.0], stiffness = 1.0e4 }}
time = {{ end = 10.0, step = "{step}", scheme.newmark = {{}} }}
"#
        )
    };
    assert!(told(&text("15 ms")).is_empty());
    let warnings = told(&text("628 ms"));
    let [warning] = &warnings[..] else {
        panic!("{warnings:?}");
    };
    for word in ["mass.bob", "62.8 ms", "at most 3.14 ms"] {
        assert!(warning.contains(word), "{word}: {warning}");
    }
}

/// A cube of 1 m and 1000 kg: 1000/6 kg m², and at most 750 kg m² with all of its mass in its corners.
#[test]
fn moments_of_inertia_that_no_body_has_are_told() {
    let text = |inertia: &str| {
        format!(
            r#"
carom = 1
mesh.generate.cube.box = {{ origin = [0.0, 0.0, 0.0], size = [1.0, 1.0, 1.0], elements = [1, 1, 1] }}
material.m = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.3 }} }}
body.cube = {{ region = "cube", material = "m", rigid.inertia = {inertia}, initial.velocity = [0.0, 0.0, 1.0] }}
time = {{ end = 1.0, step = "1 ms", scheme.theta = {{}} }}
"#
        )
    };
    let of_inertia = |inertia: &str| -> Vec<String> {
        let warnings = told(&text(inertia)).into_iter();
        warnings
            .filter(|warning| warning.contains("inertia"))
            .collect()
    };
    assert!(of_inertia("[100.0, 100.0, 200.0]").is_empty());
    let impossible = of_inertia("[100.0, 100.0, 201.0]");
    assert!(
        impossible.len() == 1 && impossible[0].contains("the sum of the other two"),
        "{impossible:?}"
    );
    let large = of_inertia("[751.0, 751.0, 751.0]");
    assert!(large.len() == 1 && large[0].contains("750"), "{large:?}");
}
