//! The largest stress of a body, looked for in a cheaper way than all stresses are computed.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Mat3;
use carom_bodies::{Body, Formulation, Kinematics, LookCost, PeakStress, StressedState};
use carom_materials::{Law, NeoHooke};
use carom_mesh::generate;
use carom_testing::Random;

use crate::sample::{MATERIAL, Sample, all};
use crate::section_stresses::{SHAPES, body, section};

/// Relative: sums of the same products in another order, of strains that cancel to some digits.
const ROUNDING: f64 = 1e-10;

fn von_mises(stress: &Mat3) -> f64 {
    let deviator = stress - Mat3::identity() * (stress.trace() / 3.0);
    (1.5 * deviator.norm_squared()).sqrt()
}

/// The largest of the values and its element are those that a search through all finds, and nothing is above it.
fn check(name: &str, body: &Body, at: &StressedState, all: &[f64]) {
    let look = PeakStress::new(body);
    let most = all.iter().copied().fold(0.0, f64::max);
    let Some((value, cell)) = look.above(0.0, body, at) else {
        return assert_eq!(most, 0.0, "{name}");
    };
    assert!(
        (value / most - 1.0).abs() < ROUNDING,
        "{name}: {value} {most}"
    );
    assert!(
        (all[cell as usize] / most - 1.0).abs() < ROUNDING,
        "{name}: {cell}"
    );
    let again = look.above(most * (1.0 - 1e-6), body, at);
    assert_eq!(again, Some((value, cell)), "{name}");
    assert_eq!(look.above(most * (1.0 + 1e-6), body, at), None, "{name}");
}

#[test]
fn the_largest_stress_of_a_solid_is_that_of_all_its_elements() {
    let solid = Kinematics::Solid;
    // more elements than a thread takes at least
    let large = || generate::box_("b", [0.0; 3], [1.0; 3], [11, 11, 11], false);
    let soft = Law::NeoHooke(NeoHooke { initial: MATERIAL });
    let mut samples = all();
    samples.push(Sample::new("many", large(), solid));
    let finite = Sample::of("finite", large(), solid, soft, Formulation::Full);
    samples.push(finite);
    for sample in samples {
        let field = |x: &[f64; 3]| [0, 1, 2].map(|i| 0.05 * (x[i] * x[(i + 1) % 3]).sin());
        let u = sample.field(field);
        let (name, body) = (sample.name, Body::Solid(sample.body));
        let at = StressedState {
            u: &u,
            frames: &[],
            history: &[],
        };
        let stresses = body.stresses(&u, &[]);
        let all: Vec<f64> = stresses.iter().map(|(_, s)| von_mises(s)).collect();
        let expected = match name.starts_with("finite") {
            true => LookCost::General,
            false => LookCost::Linear,
        };
        assert_eq!(PeakStress::cost(&body), expected, "{name}");
        check(&name, &body, &at, &all);
    }
}

#[test]
fn the_largest_stress_of_a_beam_is_that_in_its_sections() {
    let mut random = Random(7);
    for shape in &SHAPES {
        let body = body(section(shape), MATERIAL);
        let frames = [Rotation::IDENTITY; 2];
        for _ in 0..20 {
            // motions of all sizes, so that each force decides in its turn
            let size = |_| 1e-3 * random.between(-1.0, 1.0).powi(5);
            let u: [f64; 12] = std::array::from_fn(size);
            let at = StressedState {
                u: &u,
                frames: &frames,
                history: &[],
            };
            let sections = body.section_stresses(&u, &frames, &[]).unwrap();
            let all: Vec<f64> = sections.iter().map(|own| own.von_mises).collect();
            check("beam", &body, &at, &all);
        }
    }
}
