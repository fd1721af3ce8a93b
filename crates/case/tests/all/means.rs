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
