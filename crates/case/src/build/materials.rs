//! Materials: the law of each, its parameters in their ranges.

use std::collections::BTreeMap;

use carom_materials::{
    J2Plasticity, Law, MAX_BRANCHES, Maxwell, MooneyRivlin, NeoHooke, StVenantKirchhoff,
};

use super::Builder;
use crate::error::Problem;
use crate::schema::{self, Material};

impl Builder<'_> {
    /// The laws by name; those out of range are told, and stay, so that bodies find them.
    pub(super) fn materials(&mut self) -> BTreeMap<String, Law> {
        let mut laws = BTreeMap::new();
        for (name, material) in self.case.material.iter() {
            let Some((key, law)) = law(material) else {
                continue;
            };
            if let Err(out) = law.check() {
                let parameter = match out.parameter {
                    "sum of the ratios" => "branches",
                    parameter => parameter,
                };
                let path = format!("material.{name}.{key}.{parameter}");
                let message = format!("out of range: {} must be {}", out.parameter, out.accepted);
                self.problems
                    .push(Problem::new(path, message).found(out.value));
            }
            laws.insert(name.to_string(), law);
        }
        laws
    }
}

/// The law of a material, and its key; the schema has seen that there is one.
fn law(material: &Material) -> Option<(&'static str, Law)> {
    let density = material.density.0;
    let isotropic = |young: schema::Modulus, poisson: f64| carom_materials::Elastic {
        density,
        young: young.0,
        poisson,
    };
    let elastic = |given: &schema::Elastic| isotropic(given.young, given.poisson);
    if let Some(given) = &material.elastic {
        return Some(("elastic", Law::Elastic(elastic(given))));
    }
    if let Some(given) = &material.st_venant_kirchhoff {
        let initial = elastic(given);
        let law = Law::StVenantKirchhoff(StVenantKirchhoff { initial });
        return Some(("st-venant-kirchhoff", law));
    }
    if let Some(given) = &material.neo_hooke {
        let initial = elastic(given);
        return Some(("neo-hooke", Law::NeoHooke(NeoHooke { initial })));
    }
    if let Some(given) = &material.mooney_rivlin {
        let law = MooneyRivlin {
            density,
            c10: given.c10.0,
            c01: given.c01.0,
            bulk: given.bulk.0,
        };
        return Some(("mooney-rivlin", Law::MooneyRivlin(law)));
    }
    if let Some(given) = &material.j2 {
        let law = J2Plasticity {
            initial: isotropic(given.young, given.poisson),
            yield_stress: given.yield_stress.0,
            hardening: given.hardening.0,
        };
        return Some(("j2", Law::J2Plasticity(law)));
    }
    let given = material.maxwell.as_ref()?;
    let mut branches = [None; MAX_BRANCHES];
    for (branch, given) in branches.iter_mut().zip(&given.branches) {
        *branch = Some(carom_materials::Branch {
            ratio: given.ratio,
            time: given.time.0,
        });
    }
    let law = Maxwell {
        initial: isotropic(given.young, given.poisson),
        branches,
    };
    Some(("maxwell", Law::Maxwell(law)))
}
