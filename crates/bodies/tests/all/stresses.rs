//! Stresses of one element.

use carom_bodies::{Body, Formulation, Kinematics};
use carom_materials::{Law, NeoHooke};
use carom_mesh::generate;

use crate::sample::{MATERIAL, Sample, all};

/// The stress of one element is that among those of all, bit for bit: of several kinds of cells in a body, of more cells than one chunk has,
/// at small and at finite strain.
#[test]
fn the_stress_of_one_element_is_that_among_all() {
    let solid = Kinematics::Solid;
    let large = || generate::box_("b", [0.0; 3], [1.0; 3], [9, 9, 9], false);
    let soft = Law::NeoHooke(NeoHooke { initial: MATERIAL });
    let mut samples = all();
    samples.push(Sample::new("many", large(), solid));
    let finite = Sample::of("finite", large(), solid, soft, Formulation::Full);
    samples.push(finite);
    for sample in samples {
        let field = |x: &[f64; 3]| [0, 1, 2].map(|i| 0.05 * (x[i] * x[(i + 1) % 3]).sin());
        let u = sample.field(field);
        let body = Body::Solid(sample.body);
        let stresses = body.stresses(&u, &[]);
        assert_eq!(stresses.len(), body.cells().len());
        for (k, found) in stresses.iter().enumerate() {
            assert_eq!(
                body.stress(k, &u, &[]).as_ref(),
                Some(found),
                "{}: {k}",
                sample.name
            );
        }
        assert_eq!(body.stress(stresses.len(), &u, &[]), None);
    }
}
