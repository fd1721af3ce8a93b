//! Histories of supports and of probes at a place.

use crate::verdict::{result, result_with};

const G: f64 = 9.81;

#[test]
fn supports_carry_the_weight_each_its_part_and_a_held_corner_is_counted_once() {
    // a beam on two supports at its ends: half of its weight on each
    let (_, histories) = result(
        r#"
carom = 1
mesh.dimension = 2
mesh.generate.beam.line = { from = [0.0, 0.0], to = [2.0, 0.0], elements = 8 }
material.m = { density = 1500.0, elastic = { young = 1e9, poisson = 0.0 } }
body.beam = { region = "beam", material = "m", section.beam.shape.rectangle = { width = 0.01, height = 0.1 } }
support.near = { on = "beam.left", fix = ["x", "y"] }
support.far = { on = "beam.right", fix = ["y"] }
support.other = { on = "beam.left", fix = ["y"] }
load.weight.acceleration = [0.0, -9.81]
time = { end = 1.0, static = { end = 1.0, steps = 2 } }
"#,
    );
    let last = |name: &str| *histories[name].last().unwrap();
    let weight = 1500.0 * 0.01 * 0.1 * 2.0 * G;
    // equilibrium of a statically determinate beam: rounding and the tolerance of the iterations
    for support in ["near", "far"] {
        let force = last(&format!("support.{support}.force_y_n"));
        assert!(
            (force / (0.5 * weight) - 1.0).abs() < 1e-8,
            "{support} {force}"
        );
    }
    assert_eq!(last("support.other.force_y_n"), 0.0);
}

#[test]
fn a_clamp_carries_force_and_moment_about_its_centre() {
    for dim in ["beam", "cells"] {
        let (mesh, body, tip) = match dim {
            "beam" => (
                r#"mesh.generate.a.line = { from = [3.0, 1.0], to = [5.0, 1.0], elements = 4 }
mesh.dimension = 2"#,
                "section.beam.shape.rectangle = { width = 0.05, height = 0.1 }",
                "a.right",
            ),
            _ => (
                "mesh.generate.a.rectangle = { origin = [3.0, 0.95], size = [2.0, 0.1], elements = [16, 2] }",
                "section.plane-stress.thickness = 0.05",
                "a.right",
            ),
        };
        let load = match dim {
            "beam" => format!("load.tip = {{ on = \"{tip}\", force = [0.0, -100.0] }}"),
            // 100 N over the end of 0.1 m times 0.05 m
            _ => format!("load.tip = {{ on = \"{tip}\", traction = [0.0, -2e4] }}"),
        };
        let text = format!(
            r#"
carom = 1
{mesh}
material.m = {{ density = 7800.0, elastic = {{ young = 2e11, poisson = 0.0 }} }}
body.a = {{ region = "a", material = "m", {body} }}
support.clamp = {{ on = "a.left", fix = {} }}
{load}
time = {{ end = 1.0, static = {{ end = 1.0, steps = 1 }} }}
"#,
            if dim == "beam" {
                r#"["x", "y", "rz"]"#
            } else {
                r#"["x", "y"]"#
            },
        );
        let (_, histories) = result(&text);
        let last = |name: &str| *histories[name].last().unwrap();
        assert!(
            (last("support.clamp.force_y_n") - 100.0).abs() < 1e-6,
            "{dim}"
        );
        assert!(last("support.clamp.force_x_n").abs() < 1e-6, "{dim}");
        // on the body: the clamp turns it up about its centre, 2 m from the force
        assert!(
            (last("support.clamp.moment_z_n_m") - 200.0).abs() < 1e-5,
            "{dim} {}",
            last("support.clamp.moment_z_n_m")
        );
    }
}

/// A bar that runs at 1 m/s and whose end a support stops, under a scheme.
fn stopped(scheme: &str, material: &str) -> crate::verdict::Histories {
    let text = format!(
        r#"
carom = 1
mesh.generate.bar.{material}
body.bar = {{ region = "bar", material = "m", {section}, initial.velocity = {velocity} }}
support.end = {{ on = "bar.left", fix = ["x"] }}
time = {{ end = 3e-4, step.courant = 0.5, scheme.{scheme} }}
"#,
        section = if material.starts_with("line") {
            "section.bar.area = 1e-3"
        } else {
            "section.plane-strain.thickness = 1e-2"
        },
        velocity = if material.starts_with("line") {
            "[-1.0]"
        } else {
            "[-1.0, 0.0]"
        },
    );
    result(&text).1
}

#[test]
fn the_impulse_of_a_support_is_the_momentum_that_it_gives() {
    let line = "line = { from = [0.0], to = [1.0], elements = 50 }\nmaterial.m = { density = 7800.0, elastic = { young = 2e11, poisson = 0.0 } }";
    let finite = "rectangle = { origin = [0.0, 0.0], size = [1.0, 0.1], elements = [50, 1] }\nmaterial.m = { density = 7800.0, neo-hooke = { young = 2e11, poisson = 0.0 } }";
    for (scheme, material, [old, new]) in [
        ("theta = {}", line, [0.0, 1.0]),
        ("newmark = {}", line, [0.5, 0.5]),
        ("central-difference = {}", line, [0.5, 0.5]),
        ("central-difference = {}", finite, [0.5, 0.5]),
        ("theta = {}", finite, [0.0, 1.0]),
    ] {
        let histories = stopped(scheme, material);
        let (times, force) = (&histories["time_s"], &histories["support.end.force_x_n"]);
        assert!(force[0].is_nan());
        let momentum = &histories["momentum.x_n_s"];
        let mut impulse = 0.0;
        for k in 2..times.len() {
            impulse += (times[k] - times[k - 1]) * (old * force[k - 1] + new * force[k]);
        }
        let gained = momentum.last().unwrap() - momentum[1];
        // sums of some hundred terms: rounding
        assert!(
            (impulse / gained - 1.0).abs() < 1e-9,
            "{scheme} {impulse} {gained}"
        );
        // ρ c v A behind the front until the wave comes back after 0.39 ms; mesh and scheme let it swing by a tenth or two
        let plateau = 7800.0 * (2e11_f64 / 7800.0).sqrt() * 1e-3;
        let mean = impulse / (times.last().unwrap() - times[1]);
        assert!(
            (mean / plateau - 1.0).abs() < 0.02,
            "{scheme} {mean} {plateau}"
        );
    }
}

#[test]
fn a_probe_at_a_place_has_the_nearest_node_and_the_stress_of_the_nearest_cell() {
    // a plate pulled to a strain of 1e-3 in x, free in y
    let (_, histories) = result(
        r#"
carom = 1
mesh.generate.a.rectangle = { origin = [0.0, 0.0], size = [1.0, 1.0], elements = [4, 4] }
material.m = { density = 1000.0, elastic = { young = 1e9, poisson = 0.3 } }
body.a = { region = "a", material = "m", section.plane-stress.thickness = 1.0 }
support.left = { on = "a.left", fix = ["x"] }
support.bottom = { on = "a.bottom", fix = ["y"] }
support.right = { on = "a.right", move = { x = [{ time = 0.0, displacement = 0.0 }, { time = 1.0, displacement = 1e-3 }] } }
probe.p = { at = [0.55, 0.7], record = ["displacement", "stress"] }
time = { end = 1.0, static = { end = 1.0, steps = 2 } }
"#,
    );
    let last = |name: &str| *histories[name].last().unwrap();
    // the node at (0.5, 0.75)
    let near = |name: &str, value: f64, size: f64| {
        let found = last(name);
        assert!(
            (found - value).abs() < 1e-8 * size,
            "{name} {found} {value}"
        );
    };
    near("probe.p.displacement_x_m", 0.5e-3, 1e-3);
    near("probe.p.displacement_y_m", -0.3e-3 * 0.75, 1e-3);
    near("probe.p.stress_xx_pa", 1e6, 1e6);
    near("probe.p.stress_yy_pa", 0.0, 1e6);
    near("probe.p.stress_von_mises_pa", 1e6, 1e6);
    // the pulled end and the held one
    near("support.right.force_x_n", 1e6, 1e6);
    near("support.left.force_x_n", -1e6, 1e6);
}

#[test]
fn a_filter_of_a_contact_keeps_the_impulse_and_cuts_what_is_fast() {
    // an oscillator of 1 kg on a stop of 1 MN/m: half a sine of 3.14 ms, 1000 N and 2 N s
    let (summary, table) = result_with(
        r#"
carom = 1
mesh.dimension = 1
mesh.generate.bar.line = { from = [0.0], to = [1e-3], elements = 1 }
material.m = { density = 1e6, elastic = { young = 1e12, poisson = 0.0 } }
body.bar = { region = "bar", material = "m", section.bar.area = 1e-3, initial.velocity = [-1.0] }
time = { end = 0.1, step = 2e-5, scheme.newmark = {} }
[contact.stop]
secondary = "bar.left"
obstacle.plane = { point = [-0.02], normal = [1.0] }
law.penalty.stiffness = 1e9
filter = ["cfc-60", "cfc-1000"]
"#,
        "filtered.csv",
    );
    let sum = |name: &str| table[name].iter().sum::<f64>() * 2e-5;
    let most = |name: &str| table[name].iter().copied().fold(0.0, f64::max);
    let raw = "contact.stop.force_n";
    let impulse = summary.contacts["stop"].impulse.unwrap();
    assert!(
        (sum(raw) / impulse - 1.0).abs() < 1e-9,
        "{} {impulse}",
        sum(raw)
    );
    for class in [60, 1000] {
        let name = format!("contact.stop.force.cfc_{class}_n");
        // far from both ends of the record the filter has a gain of one at frequency zero
        assert!(
            (sum(&name) / impulse - 1.0).abs() < 1e-3,
            "{class} {}",
            sum(&name)
        );
    }
    // half a sine of 159 Hz: well below 1650 Hz, well above 100 Hz
    assert!(most("contact.stop.force.cfc_1000_n") > 0.97 * most(raw));
    assert!(most("contact.stop.force.cfc_60_n") < 0.8 * most(raw));
}
