//! Means of probes over groups.

use crate::verdict::result;

/// A free bar whose right end has a point mass of its own weight and moves at first.
const BAR: &str = r#"
carom = 1
mesh.generate.bar.line = { from = [0.0], to = [1.0], elements = 20 }
material.m = { density = 1000.0, elastic = { young = 1e7, poisson = 0.0 } }
body.bar = { region = "bar", material = "m", section.bar.area = 1e-3 }
mass.weight = { mass = 1.0, on = "bar.right", initial.velocity = [3.0] }
probe.centre = { on = "bar", mean = "mass", record = ["velocity"] }
probe.middle = { on = "bar", record = ["velocity"] }
time = { end = 1e-2, step = 1e-4, scheme.theta = {} }
"#;

#[test]
fn the_mean_by_mass_is_the_momentum_over_the_mass_and_that_by_length_is_not() {
    let (_, histories) = result(BAR);
    let momentum = histories["momentum.x_n_s"][0];
    assert!(
        momentum > 3.0,
        "the weight and its share of the bar move: {momentum}"
    );
    // 1 kg of the bar, 1 kg of the weight; nothing acts from outside
    for v in &histories["probe.centre.velocity_x_m_s"] {
        assert!((v - momentum / 2.0).abs() < 1e-12 * momentum, "{v}");
    }
    let middle = &histories["probe.middle.velocity_x_m_s"];
    assert!(
        middle
            .iter()
            .any(|v| (v - momentum / 2.0).abs() > 0.1 * momentum)
    );
}

/// Two blocks that meet, with probes of the contact at all of its nodes and at one of them.
const MEETING: &str = r#"
carom = 1
mesh.generate.a.rectangle = { origin = [0.0, 0.0], size = [0.2, 0.1], elements = [8, 4] }
mesh.generate.b.rectangle = { origin = [0.2001, 0.0], size = [0.2, 0.1], elements = [8, 4] }
material.m = { density = 1000.0, elastic = { young = 1e7, poisson = 0.3 } }
body.a = { region = "a", material = "m", section.plane-strain.thickness = 0.5, initial.velocity = [1.0, 0.0] }
body.b = { region = "b", material = "m", section.plane-strain.thickness = 0.5 }
contact.c = { secondary = "a.right", primary = "b.left", law.velocity = {} }
probe.side = { on = "a.right", record = ["contact"] }
probe.corner = { at = [0.2, 0.0], record = ["contact"] }
time = { end = 2e-3, step = 2e-5, scheme.theta = {} }
"#;

#[test]
fn a_probe_of_a_contact_has_the_force_and_the_gap_of_its_points() {
    let (_, histories) = crate::verdict::result(MEETING);
    let of = |name: &str| &histories[name];
    let (whole, side) = (of("contact.c.force_n"), of("probe.side.contact_force_n"));
    assert!(whole.iter().any(|force| *force > 0.0));
    for (k, force) in whole.iter().enumerate() {
        // all points are at the nodes of the side: the same sum
        assert!((force - side[k]).abs() <= 1e-12 * force.abs());
        // 0.1 m by 0.5 m
        let pressure = of("probe.side.contact_pressure_pa")[k];
        assert!((pressure - force / 0.05).abs() <= 1e-12 * pressure.abs());
    }
    // the least gap of the same points
    assert_eq!(of("probe.side.gap_m"), of("contact.c.gap_m"));
    // a corner stands for half of the area of a node in the middle, and carries less than a quarter of the whole
    let corner = of("probe.corner.contact_force_n");
    assert!(corner.iter().any(|force| *force > 0.0));
    assert!(
        corner
            .iter()
            .zip(whole)
            .all(|(one, all)| *one <= 0.25 * all + 1e-9)
    );
}

#[test]
fn a_probe_of_a_contact_is_at_a_contact() {
    let text = MEETING.replace("on = \"a.right\"", "on = \"a.left\"");
    let input = carom_case::Input::from_text("case.toml", &text, &[]);
    let (case, locator) = carom_case::parse(&input).unwrap();
    let problems = carom_case::build(&case, &locator, &input).err().unwrap();
    let told = problems[0].to_string();
    assert!(told.contains("probe.side.record[0]"), "{told}");
}
