//! The laws under test, random deformations, and differences.

use carom_algebra::tensor::Mat3;
use carom_materials::{
    Branch, Elastic, Failure, HardeningPoint, J2Plasticity, J2Table, JohnsonCook, Law, Material,
    Maxwell, MooneyRivlin, NeoHooke, Response, StVenantKirchhoff, Tangent, Thermal, Want,
};
use carom_testing::Random;

/// Moduli of order one, so that errors read as relative ones.
pub const INITIAL: Elastic = Elastic {
    density: 2.0,
    young: 1.3,
    poisson: 0.3,
};

/// Rubber with about the same moduli.
pub const RUBBER: MooneyRivlin = MooneyRivlin {
    density: INITIAL.density,
    c10: 0.2,
    c01: 0.05,
    bulk: 1.1,
};

/// Metal that flows in all but the smallest deformations here.
pub const METAL: J2Plasticity = J2Plasticity {
    initial: INITIAL,
    yield_stress: 0.05,
    hardening: 0.2,
};

/// Two branches, one faster and one slower than the step of [`step`].
pub const POLYMER: Maxwell = Maxwell {
    initial: INITIAL,
    branches: [
        Some(Branch {
            ratio: 0.4,
            time: 0.1,
        }),
        None,
        Some(Branch {
            ratio: 0.3,
            time: 2.0,
        }),
        None,
    ],
};

/// Metal whose table has METAL's slope, then half of it, then none.
pub fn table() -> J2Table {
    let points = [[0.0, 0.05], [0.1, 0.07], [0.4, 0.1]];
    let points = points.map(|[strain, stress]| HardeningPoint { strain, stress });
    J2Table::new(INITIAL, &points).unwrap()
}

/// Metal that hardens by strain and rate, and softens as it heats.
pub const FAST_METAL: JohnsonCook = JohnsonCook {
    initial: INITIAL,
    yield_stress: 0.05,
    hardening: 0.1,
    exponent: 0.6,
    rate_factor: 0.1,
    reference_rate: 0.02,
    thermal: Some(Thermal {
        exponent: 1.1,
        melting_rise: 3.0,
        specific_heat: 0.1,
        converted: 0.9,
    }),
};

/// A law at finite strain with its name.
pub fn laws() -> Vec<(&'static str, Law)> {
    let initial = INITIAL;
    vec![
        (
            "st-venant-kirchhoff",
            Law::StVenantKirchhoff(StVenantKirchhoff { initial }),
        ),
        ("neo-hooke", Law::NeoHooke(NeoHooke { initial })),
        ("mooney-rivlin", Law::MooneyRivlin(RUBBER)),
        ("j2-plasticity", Law::J2Plasticity(METAL)),
        (
            "j2-plasticity, elastic",
            Law::J2Plasticity(J2Plasticity {
                yield_stress: 1e3,
                ..METAL
            }),
        ),
        ("maxwell", Law::Maxwell(POLYMER)),
        ("j2-table", Law::J2Table(table())),
        ("johnson-cook", Law::JohnsonCook(FAST_METAL)),
    ]
}

/// Calls `check` with every law.
pub fn for_each(mut check: impl FnMut(&str, &dyn Material)) {
    for (name, law) in laws() {
        check(name, law.finite().unwrap());
    }
}

/// The history of a point that nothing has happened to.
pub fn start(law: &dyn Material) -> Vec<f64> {
    let mut history = vec![f64::NAN; law.history_len()];
    law.start(&mut history);
    history
}

/// The law's answer after a step of 0.3 s from the history `old`, and the new history.
pub fn step(
    law: &dyn Material,
    f: &Mat3,
    old: &[f64],
    want: Want,
) -> Result<(Response, Vec<f64>), Failure> {
    let mut new = vec![f64::NAN; old.len()];
    let response = law.update(f, 0.3, (old, &mut new), want)?;
    Ok((response, new))
}

/// I + size * (random in [-1, 1)).
pub fn random_f(random: &mut Random, size: f64) -> Mat3 {
    Mat3::identity() + Mat3::from_fn(|_, _| size * random.next())
}

/// A rotation by a random angle about a random axis.
pub fn random_rotation(random: &mut Random) -> Mat3 {
    let axis = nalgebra::Vector3::from_fn(|_, _| random.next());
    nalgebra::Rotation3::new(axis * 2.5).into_inner()
}

/// The tangent times a change of F.
pub fn times(tangent: &Tangent, h: &Mat3) -> Mat3 {
    Mat3::from_fn(|i, j| {
        (0..9)
            .map(|kl| tangent[3 * i + j][kl] * h[(kl / 3, kl % 3)])
            .sum()
    })
}

/// Largest difference of ∂P/∂F from the fourth-order central difference of `stress` with the step `h`.
pub fn tangent_error(tangent: &Tangent, f: &Mat3, h: f64, stress: impl Fn(&Mat3) -> Mat3) -> f64 {
    let mut largest: f64 = 0.0;
    for kl in 0..9 {
        let mut unit = Mat3::zeros();
        unit[(kl / 3, kl % 3)] = 1.0;
        let central = |h: f64| (stress(&(f + unit * h)) - stress(&(f - unit * h))) / (2.0 * h);
        let difference = (central(h) * 4.0 - central(2.0 * h)) / 3.0;
        largest = largest.max((difference - times(tangent, &unit)).amax());
    }
    largest
}

/// The most that a tangent departs from major symmetry.
pub fn asymmetry(tangent: &Tangent) -> f64 {
    let pairs = (0..9).flat_map(|a| (0..a).map(move |b| (a, b)));
    pairs
        .map(|(a, b)| (tangent[a][b] - tangent[b][a]).abs())
        .fold(0.0, f64::max)
}
