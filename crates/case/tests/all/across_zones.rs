//! Contacts between zones of unequal steps whose forces are not unique, or small beside what rounding makes of them.

use crate::verdict::result;

/// A rigid block whose face, a plane of four points, comes down on a block of another zone: the rows of the points are dependent. Before, the
/// matrix of the closed points was singular at the second step of the contact.
#[test]
fn a_flat_face_of_a_rigid_body_lands_in_a_zone_of_other_steps() {
    let (summary, histories) = result(
        r#"
carom = 1
mesh.generate.a.box = { origin = [0.1, 0.1, 0.201], size = [0.1, 0.1, 0.1], elements = [1, 1, 1] }
mesh.generate.b.box = { origin = [0.0, 0.0, 0.0], size = [0.3, 0.3, 0.2], elements = [2, 2, 2] }
material.m = { density = 7800.0, elastic = { young = "200 GPa", poisson = 0.3 } }
body.b = { region = "b", material = "m" }
contact.c = { secondary = "a.bottom", primary = "b.top", law.velocity = {} }
support.f = { on = "b.bottom", fix = ["x", "y", "z"] }
time = { end = "1.4 ms", step = "20 us", scheme.theta.theta = 0.6 }
zone.za = { bodies = ["a"], substeps = 4 }
zone.zb = { bodies = ["b"] }
[body.a]
region = "a"
material = "m"
rigid = {}
initial = { velocity = [0.0, 0.0, -1.0], spin = [0.1, 0.0, 0.2] }
"#,
    );
    let closed = &histories["contact.c.closed_points"];
    assert!(closed.contains(&4.0), "{closed:?}");
    // the block gets the impulse of the contact: rounding of some hundred steps
    let residual = summary.momentum.relative_residual;
    assert!(residual < 1e-11, "{residual:e}");
    let line = summary.verdict.line("contact-impulse").unwrap();
    assert!(line.value < 1e-11, "{line:?}");
    // the block of 7.8 kg is stopped and thrown back, by not more than it came with
    let impulse = summary.contacts["c"].impulse.unwrap();
    assert!(impulse > 7.8 && impulse < 15.6, "{impulse}");
}

/// Bars of 4 EPa: where the contact lets go, the force that changes a rate by its rounding, 1e-16 of 2 m/s times ρ c A, is far above 1e-12 of what
/// is left of the contact force. Passes end there.
#[test]
fn passes_of_a_contact_between_zones_end_at_the_rounding_of_the_rates() {
    let bars = |young: &str| {
        let text = format!(
            r#"
carom = 1
mesh.generate.a.line = {{ from = [-1.0], to = [0.0], elements = 16 }}
mesh.generate.b.line = {{ from = [0.0], to = [1.0], elements = 16 }}
material.m = {{ density = 7800.0, elastic = {{ young = "{young}", poisson = 0.0 }} }}
body.a = {{ region = "a", material = "m", section.bar.area = "1 cm^2", initial.velocity = [2.0] }}
body.b = {{ region = "b", material = "m", section.bar.area = "1 cm^2", reduction.modes = 6 }}
contact.c = {{ secondary = "a.right", primary = "b.left", law.velocity = {{}} }}
zone.i = {{ bodies = ["a"], substeps = 4 }}
zone.o = {{ bodies = ["b"] }}
time = {{ end = "0.5 ms", step = "8 us", scheme.theta = {{}} }}
"#
        );
        result(&text).0
    };
    for young in ["200 GPa", "4294967296 GPa"] {
        let summary = bars(young);
        let residual = summary.momentum.relative_residual;
        assert!(residual < 1e-9, "{young}: {residual:e}");
    }
}

/// Two blocks that strike each other, the lower one tied to a third, each in a zone of its own. What the contact took and made is judged by the energy of these
/// three, in their own frame: a body far away, slow or fast, and a motion of all change no grade, and values by rounding of velocities of some
/// hundred m/s, 1e-9.
#[test]
fn grades_of_zones_that_step_apart_are_those_of_what_acts_on_each_other() {
    let blocks = |[x, y]: [f64; 2], far: Option<f64>| {
        let mut text = format!(
            r#"
carom = 1
mesh.generate.foot.rectangle = {{ origin = [0.0, -0.4], size = [1.0, 0.2], elements = [5, 1] }}
mesh.generate.low.rectangle = {{ origin = [0.0, -0.2], size = [1.0, 0.2], elements = [5, 2] }}
mesh.generate.up.rectangle = {{ origin = [0.31, 0.001], size = [0.4, 0.1], elements = [3, 2] }}
material.m = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.2 }} }}
contact.c = {{ secondary = "up.bottom", primary = "low.top", law.velocity.capture = "half", friction.coulomb = 0.2, sliding = "finite" }}
interface.tie = {{ inner = "low", outer = "foot" }}
zone.a = {{ bodies = ["low"], substeps = 2 }}
zone.b = {{ bodies = ["up"], substeps = 3 }}
time = {{ end = "4 ms", step = "0.1 ms", scheme.theta.theta = 0.5 }}
body.foot = {{ region = "foot", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [{x}, {y}] }}
body.low = {{ region = "low", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [{x}, {y}] }}
body.up = {{ region = "up", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [{}, {}] }}
"#,
            x + 0.5,
            y - 1.0
        );
        let bodies = match far {
            None => r#"zone.o = { bodies = ["foot"] }"#.to_owned(),
            Some(speed) => format!(
                r#"
mesh.generate.far.rectangle = {{ origin = [50.0, 0.0], size = [2.0, 2.0], elements = [2, 2] }}
zone.o = {{ bodies = ["foot", "far"] }}
body.far = {{ region = "far", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [{speed}, {speed}] }}
"#
            ),
        };
        text += &bodies;
        result(&text).0
    };
    let alone = blocks([0.0, 0.0], None);
    let lost = alone.verdict.line("contact-loss").unwrap();
    assert!(lost.value > 0.01, "{lost:?}");
    for changed in [
        blocks([100.0, 50.0], None),
        blocks([0.0, 0.0], Some(0.0)),
        blocks([0.0, 0.0], Some(300.0)),
    ] {
        for name in ["contact-loss", "contact-work", "energy-gain", "scheme-loss"] {
            let [one, other] = [&alone, &changed].map(|summary| summary.verdict.line(name));
            let (one, other) = (one.unwrap(), other.unwrap());
            assert_eq!(one.grade, other.grade, "{name}: {one:?} {other:?}");
            assert!(
                (one.value - other.value).abs() < 1e-9,
                "{name}: {one:?} {other:?}"
            );
        }
    }
}
