//! Hardening by a table, by rate and by heat, against closed forms.

use carom_algebra::tensor::Mat3;
use carom_materials::{
    HardeningPoint, J2Plasticity, J2Table, JohnsonCook, Material, Response, Want,
};
use carom_testing::Random;

use crate::support::{FAST_METAL, INITIAL, METAL, random_f, start, step, table};

/// A bar under uniaxial tension at a logarithmic strain: Kirchhoff stress, response and history.
fn tension(law: &dyn Material, strain: f64, old: &[f64]) -> (f64, Response, Vec<f64>) {
    let axial = strain.exp();
    let mut side: f64 = 1.0;
    for _ in 0..50 {
        let f = Mat3::from_diagonal(&[axial, side, side].into());
        let (response, new) = step(law, &f, old, Want::Tangent).unwrap();
        let tangent = response.tangent.as_ref().unwrap();
        let change = response.stress[(1, 1)] / (tangent[4][4] + tangent[4][8]);
        if change.abs() < 1e-15 {
            return (response.stress[(0, 0)] * axial, response, new);
        }
        side -= change;
    }
    panic!("the side stress was not removed");
}

#[test]
fn a_table_of_one_slope_is_linear_hardening() {
    // the same equations in another order of operations: rounding
    let ends = [0.0, 0.3, 1e3];
    let points = ends.map(|strain| HardeningPoint {
        strain,
        stress: METAL.yield_stress + METAL.hardening * strain,
    });
    let law = J2Table::new(INITIAL, &points).unwrap();
    let mut random = Random(41);
    for _ in 0..20 {
        let [mut one, mut other] = [start(&METAL), start(&law)];
        let mut f = Mat3::identity();
        for _ in 0..3 {
            f = random_f(&mut random, 0.25) * f;
            let (of_line, new) = step(&METAL, &f, &one, Want::Tangent).unwrap();
            let (of_table, own) = step(&law, &f, &other, Want::Tangent).unwrap();
            assert!((of_line.stress - of_table.stress).amax() < 1e-13);
            assert!((of_line.hardening - of_table.hardening).abs() < 1e-13);
            assert!((of_line.dissipated - of_table.dissipated).abs() < 1e-13);
            let tangents = of_line.tangent.unwrap().into_iter().flatten();
            for (a, b) in tangents.zip(of_table.tangent.unwrap().into_iter().flatten()) {
                assert!((a - b).abs() < 1e-12);
            }
            (one, other) = (new, own);
        }
    }
}

#[test]
fn tension_follows_the_pieces_of_the_table() {
    let law = table();
    let points: Vec<_> = law.hardening.iter().flatten().collect();
    // one step over several pieces, and small ones, end on the same curve: the path is proportional
    for strains in [vec![0.9], vec![0.05, 0.12, 0.2, 0.5, 0.9]] {
        let (mut last, mut old) = (0.0, start(&law));
        for strain in strains {
            let (kirchhoff, response, new) = tension(&law, strain, &old);
            let plastic = strain - kirchhoff / INITIAL.young;
            assert!((new[6] - plastic).abs() < 1e-13, "{strain}");
            let piece = points.partition_point(|point| point.strain <= plastic) - 1;
            let (from, to) = (points[piece], points.get(piece + 1));
            let slope = to.map_or(0.0, |to| {
                (to.stress - from.stress) / (to.strain - from.strain)
            });
            let expected = from.stress + slope * (plastic - from.strain);
            assert!((kirchhoff - expected).abs() < 1e-13, "{strain}");
            let dissipated = 0.05 * (new[6] - old[6]);
            assert!((response.dissipated - dissipated).abs() < 1e-14);
            (last, old) = (response.hardening, new);
        }
        // up to 0.1 a triangle, to 0.4 a trapezium above the first stress, then the rest of the way
        let stored = 0.5 * 0.1 * 0.02 + 0.3 * (0.02 + 0.015) + (old[6] - 0.4) * 0.05;
        assert!((last - stored).abs() < 1e-14, "{last} {stored}");
    }
}

/// σ_y of a plastic strain, its rate and the rise of the temperature, as the paper writes it.
fn printed(law: &JohnsonCook, [plastic, rate, rise]: [f64; 3]) -> f64 {
    let thermal = law.thermal.unwrap();
    (law.yield_stress + law.hardening * plastic.powf(law.exponent))
        * (1.0 + law.rate_factor * (rate / law.reference_rate).ln())
        * (1.0 - (rise / thermal.melting_rise).powf(thermal.exponent))
}

#[test]
fn tension_follows_the_formula_of_johnson_and_cook() {
    // steps of 0.3 s, as `step` takes them; the stress is that of the strain and the rate at the end of the step and of the heat at its
    // beginning: rounding of the return
    let law = &FAST_METAL;
    let thermal = law.thermal.unwrap();
    let mut old = start(law);
    let mut rise = 0.0;
    for strain in [0.1, 0.2, 0.45, 0.7] {
        let (kirchhoff, response, new) = tension(law, strain, &old);
        let plastic = strain - kirchhoff / law.initial.young;
        assert!((new[6] - plastic).abs() < 1e-13, "{strain}");
        let slip = new[6] - old[6];
        let expected = printed(law, [plastic, slip / 0.3, rise]);
        assert!((kirchhoff - expected).abs() < 1e-13, "{strain}");
        assert!((response.dissipated - kirchhoff * slip).abs() < 1e-13);
        rise +=
            thermal.converted * kirchhoff * slip / (law.initial.density * thermal.specific_heat);
        assert!((JohnsonCook::temperature_rise(&new) - rise).abs() < 1e-13);
        old = new;
    }
    assert!(rise > 0.1 * thermal.melting_rise, "{rise}");
}

#[test]
fn without_rate_heat_and_power_it_is_linear_hardening() {
    let law = JohnsonCook {
        yield_stress: METAL.yield_stress,
        hardening: METAL.hardening,
        exponent: 1.0,
        rate_factor: 0.0,
        thermal: None,
        ..FAST_METAL
    };
    let line: J2Plasticity = METAL;
    let mut random = Random(42);
    for _ in 0..20 {
        let f = random_f(&mut random, 0.3);
        let (one, _) = step(&line, &f, &start(&line), Want::Stress).unwrap();
        let (other, _) = step(&law, &f, &start(&law), Want::Stress).unwrap();
        assert!((one.stress - other.stress).amax() < 1e-14);
    }
}

#[test]
fn molten_metal_carries_pressure_alone() {
    let law = &FAST_METAL;
    let mut old = start(law);
    old[7] = 2.0 * law.thermal.unwrap().melting_rise;
    let f = Mat3::from_diagonal(&[1.3, 0.9, 1.05].into());
    let (response, _) = step(law, &f, &old, Want::Stress).unwrap();
    let kirchhoff = response.stress * f.transpose();
    let pressure = kirchhoff.trace() / 3.0;
    assert!((kirchhoff - Mat3::identity() * pressure).amax() < 1e-15);
    assert!(pressure > 0.1);
}
