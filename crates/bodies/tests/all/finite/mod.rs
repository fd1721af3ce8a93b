//! Bodies at finite strain: kinds, kinematics, formulations and laws.

mod between;
mod derivatives;
mod facts;
mod history;
mod locking;
mod patch;
mod pressure;

use carom_bodies::{Error, Formulation, Kinematics, Placement, Scratch, Stored};
use carom_materials::{
    Branch, J2Plasticity, Law, Maxwell, MooneyRivlin, NeoHooke, StVenantKirchhoff,
};
use carom_testing::Random;

use crate::sample::{MATERIAL, Sample, dense, shapes};

const HOURGLASS: Formulation = Formulation::Reduced { hourglass: 0.1 };

/// Hyperelastic laws.
fn elastic() -> Vec<(&'static str, Law)> {
    let initial = MATERIAL;
    vec![
        ("neo-hooke", Law::NeoHooke(NeoHooke { initial })),
        (
            "st-venant-kirchhoff",
            Law::StVenantKirchhoff(StVenantKirchhoff { initial }),
        ),
        (
            "mooney-rivlin",
            Law::MooneyRivlin(MooneyRivlin {
                density: MATERIAL.density,
                c10: 0.2,
                c01: 0.05,
                bulk: 1.1,
            }),
        ),
    ]
}

/// Laws with a history: a metal that flows and a polymer that relaxes.
fn inelastic() -> Vec<(&'static str, Law)> {
    let metal = J2Plasticity {
        initial: MATERIAL,
        yield_stress: 0.05,
        hardening: 0.2,
    };
    let branch = Branch {
        ratio: 0.4,
        time: 0.2,
    };
    let polymer = Maxwell {
        initial: MATERIAL,
        branches: [Some(branch), None, None, None],
    };
    vec![
        ("j2-plasticity", Law::J2Plasticity(metal)),
        ("maxwell", Law::Maxwell(polymer)),
    ]
}

/// Every mesh in plane strain, axisymmetry or space with every formulation, each with its law.
fn samples(law: &(&str, Law)) -> Vec<Sample> {
    let mut samples = Vec::new();
    for formulation in [Formulation::Full, Formulation::BBar, HOURGLASS] {
        for (name, mesh, kinematics) in shapes() {
            let name = format!("{name}, {}, {formulation:?}", law.0);
            if !matches!(kinematics, Kinematics::PlaneStress { .. })
                && takes(name.as_str(), formulation)
            {
                samples.push(Sample::of(&name, mesh, kinematics, law.1, formulation));
            }
        }
    }
    samples
}

/// Reduced integration is for the linear quadrilateral and hexahedron, and nothing to triangles.
fn takes(name: &str, formulation: Formulation) -> bool {
    let reduced = ["quad4", "hex8", "tri3", "tet4"];
    formulation != HOURGLASS || reduced.iter().any(|kind| name.starts_with(kind))
}

/// A displacement of the size of a tenth of an element.
fn displacement(sample: &Sample, seed: u64) -> Vec<f64> {
    Random(seed)
        .vector(sample.n)
        .iter()
        .map(|u| 0.03 * u)
        .collect()
}

/// About ten of `n` unknowns, of all components.
fn probes(n: usize) -> impl Iterator<Item = usize> {
    let step = (n / 10).max(1);
    (0..n).step_by(if step.is_multiple_of(2) || step.is_multiple_of(3) {
        step / 6 * 6 + 7
    } else {
        step
    })
}

/// A body with its history at the start of a step of 0.1 s.
struct Step<'a> {
    sample: &'a Sample,
    from: Option<&'a [f64]>,
    old: Vec<f64>,
}

impl<'a> Step<'a> {
    fn new(sample: &'a Sample) -> Step<'a> {
        let mut old = vec![f64::NAN; sample.body.history_len()];
        sample.body.start_history(&mut old);
        Step {
            sample,
            from: None,
            old,
        }
    }

    fn between(sample: &'a Sample, from: &'a [f64]) -> Step<'a> {
        Step {
            from: Some(from),
            ..Step::new(sample)
        }
    }

    fn at<'b>(&'b self, u: &'b [f64]) -> Placement<'b> {
        Placement {
            u,
            v: &[],
            from: self.from,
            frames: &[],
            dt: 0.1,
            old: &self.old,
        }
    }

    fn run(&self, u: &[f64]) -> Result<(Vec<f64>, Stored, Vec<f64>), Error> {
        let (mut f, mut new) = (vec![0.0; self.sample.n], vec![f64::NAN; self.old.len()]);
        let body = &self.sample.body;
        let stored = body.force(&self.at(u), &mut new, &mut Scratch::default(), &mut f)?;
        Ok((f, stored, new))
    }

    fn force(&self, u: &[f64]) -> Vec<f64> {
        self.run(u).unwrap().0
    }

    /// What the force is the derivative of: the sum of what is stored and dissipated.
    fn potential(&self, u: &[f64]) -> f64 {
        let stored = self.run(u).unwrap().1;
        stored.strain + stored.hardening + stored.dissipated
    }

    /// Dense tangent.
    fn tangent(&self, u: &[f64]) -> Vec<f64> {
        let mut matrix = self.sample.pattern();
        let body = &self.sample.body;
        body.add_tangent(&self.at(u), 1.0, &mut matrix).unwrap();
        dense(&matrix, self.sample.n)
    }
}

/// Displacement of a rotation by `angle` and a translation.
fn rotation(sample: &Sample, angle: f64) -> Vec<f64> {
    let turn = turn(sample, angle);
    sample.field(|x| [0, 1, 2].map(|i| (0..3).map(|j| turn[i][j] * x[j]).sum::<f64>() - x[i] + 0.3))
}

/// R = cos I + sin [axis]× + (1 - cos) axis ⊗ axis about a skew axis, or the normal of the plane.
fn turn(sample: &Sample, angle: f64) -> [[f64; 3]; 3] {
    let axis = match sample.dim() {
        2 => [0.0, 0.0, 1.0],
        _ => [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0],
    };
    let (sin, cos) = angle.sin_cos();
    let [x, y, z] = axis;
    let skew = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            let unit = if i == j { cos } else { 0.0 };
            unit + sin * skew[i][j] + (1.0 - cos) * axis[i] * axis[j]
        })
    })
}
