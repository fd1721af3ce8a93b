//! Parameters out of range are named with their value.

use carom_materials::{
    Branch, Elastic, HardeningPoint, J2Plasticity, J2Table, JohnsonCook, Law, Maxwell,
    MooneyRivlin, NeoHooke,
};

use crate::support::{FAST_METAL, INITIAL, METAL, POLYMER, RUBBER, laws};

#[test]
fn the_laws_under_test_are_in_range() {
    for (name, law) in laws() {
        assert_eq!(law.check(), Ok(()), "{name}");
    }
}

#[test]
fn each_parameter_out_of_range_is_named() {
    let elastic = |change: fn(&mut Elastic)| {
        let mut initial = INITIAL;
        change(&mut initial);
        Law::NeoHooke(NeoHooke { initial })
    };
    let metal = |change: fn(&mut J2Plasticity)| {
        let mut law = METAL;
        change(&mut law);
        Law::J2Plasticity(law)
    };
    let rubber = |change: fn(&mut MooneyRivlin)| {
        let mut law = RUBBER;
        change(&mut law);
        Law::MooneyRivlin(law)
    };
    let polymer = |ratio: f64, time: f64| {
        let mut branches = POLYMER.branches;
        branches[1] = Some(Branch { ratio, time });
        Law::Maxwell(Maxwell {
            branches,
            ..POLYMER
        })
    };
    let fast = |change: fn(&mut JohnsonCook)| {
        let mut law = FAST_METAL;
        change(&mut law);
        Law::JohnsonCook(law)
    };
    let tabulated = |points: &[[f64; 2]]| {
        let points = points.iter();
        let points = points.map(|&[strain, stress]| HardeningPoint { strain, stress });
        Law::J2Table(J2Table::new(INITIAL, &points.collect::<Vec<_>>()).unwrap())
    };
    let cases = [
        (fast(|m| m.exponent = 0.0), "exponent = 0 is"),
        (fast(|m| m.rate_factor = -0.1), "rate-factor = -0.1 is"),
        (fast(|m| m.reference_rate = 0.0), "reference-rate = 0 is"),
        (
            fast(|m| {
                let thermal = m.thermal.as_mut().unwrap();
                thermal.converted = 1.5;
            }),
            "thermal.converted = 1.5 is",
        ),
        (tabulated(&[[0.1, 1.0]]), "strain = 0.1 is"),
        (tabulated(&[[0.0, 1.0], [0.0, 2.0]]), "strain = 0 is"),
        (tabulated(&[[0.0, 1.0], [0.2, 0.9]]), "stress = 0.9 is"),
        (elastic(|e| e.density = 0.0), "density = 0 is"),
        (elastic(|e| e.young = -1.0), "young = -1 is"),
        (elastic(|e| e.poisson = 0.5), "poisson = 0.5 is"),
        (elastic(|e| e.poisson = -1.0), "poisson = -1 is"),
        (elastic(|e| e.young = f64::INFINITY), "young = inf is"),
        (metal(|m| m.yield_stress = 0.0), "yield-stress = 0 is"),
        (metal(|m| m.hardening = -2.0), "hardening = -2 is"),
        (metal(|m| m.initial.young = 0.0), "young = 0 is"),
        (rubber(|r| r.c10 = 0.0), "c10 = 0 is"),
        (rubber(|r| r.c01 = -0.1), "c01 = -0.1 is"),
        (rubber(|r| r.bulk = 0.5), "bulk = 0.5 is"),
        (polymer(0.0, 1.0), "ratio = 0 is"),
        (polymer(0.1, 0.0), "time = 0 is"),
        (polymer(0.5, 1.0), "sum of the ratios = 1.2"),
    ];
    for (law, expected) in cases {
        let message = law.check().unwrap_err().to_string();
        assert!(message.starts_with(expected), "{message}");
        assert!(message.contains("it must be"), "{message}");
    }
}
