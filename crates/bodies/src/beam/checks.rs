//! What beams refuse, and the weights of their elements.

use carom_elements::Kind;
use carom_mesh::Mesh;

use super::element::EndWeights;
use crate::spec::BodySpec;
use crate::{Error, Formulation, Kinematics};

/// Refuses bodies that are none of beams.
pub(super) fn check(mesh: &Mesh, spec: &BodySpec) -> Result<(), Error> {
    let body = || spec.name.clone();
    if spec.cells.is_empty() {
        return Err(Error::Empty { body: body() });
    }
    if mesh.dim < 2 {
        return Err(Error::BeamOnLine { body: body() });
    }
    if spec.weights.is_some() && spec.material.uniaxial().is_some() {
        return Err(Error::BeamWeights { body: body() });
    }
    if spec.material.finite().is_some() && spec.material.uniaxial().is_none() {
        return Err(Error::FiniteKinematics {
            body: body(),
            kinematics: spec.kinematics.name(),
        });
    }
    if spec.formulation != Formulation::Full {
        return Err(Error::LinearFormulation { body: body() });
    }
    for &cell in &spec.cells {
        match mesh.kind(cell) {
            Kind::Bar2 => {}
            Kind::Bar3 => return Err(Error::QuadraticBar { body: body() }),
            kind => {
                return Err(Error::WrongElement {
                    body: body(),
                    found: kind.table().name,
                    kinematics: spec.kinematics.name(),
                    dim: Kinematics::dim(spec.kinematics),
                });
            }
        }
    }
    Ok(())
}

/// The weights of each cell of a body.
pub(super) fn end_weights(mesh: &Mesh, spec: &BodySpec) -> Result<Vec<EndWeights>, Error> {
    let Some(weights) = &spec.weights else {
        return Ok(vec![EndWeights::ONE; spec.cells.len()]);
    };
    weights.check(&spec.name, mesh, &spec.cells)?;
    let mut all = Vec::with_capacity(spec.cells.len());
    let ends = |list: &[f64], k: usize| [list[2 * k], list[2 * k + 1]];
    for (k, &cell) in spec.cells.iter().enumerate() {
        let weights = EndWeights {
            inertia: ends(&weights.inertia, k),
            stiffness: ends(&weights.stiffness, k),
        };
        let bad = |w: &f64| w.is_nan() || *w < 0.0;
        if let Some(&weight) = weights.stiffness.iter().find(|w| bad(w)) {
            return Err(Error::NegativeStiffness {
                body: spec.name.clone(),
                cell,
                weight,
            });
        }
        if let Some(end) = weights.inertia.iter().position(bad) {
            return Err(Error::NegativeMass {
                body: spec.name.clone(),
                cell,
                node: mesh.element_nodes(cell)[end],
                mass: weights.inertia[end],
            });
        }
        all.push(weights);
    }
    Ok(all)
}
