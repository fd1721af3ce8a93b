//! Weights of inertia and internal work of shells that share their volume with another model.

use carom_mesh::{ElementId, Mesh};

use super::products::MOST;
use crate::Error;
use crate::spec::BodySpec;

/// Weights α and δ at the points of integration of an element.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointWeights {
    pub inertia: [f64; MOST],
    pub stiffness: [f64; MOST],
}

impl Default for PointWeights {
    fn default() -> PointWeights {
        PointWeights {
            inertia: [1.0; MOST],
            stiffness: [1.0; MOST],
        }
    }
}

impl PointWeights {
    /// Those at points with these shape functions, of values α and δ at the nodes.
    pub(super) fn new(shapes: &[[f64; MOST]], [alpha, delta]: [&[f64; MOST]; 2]) -> PointWeights {
        let mut weights = PointWeights::default();
        if [alpha, delta] == [&[1.0; MOST]; 2] {
            return weights;
        }
        for (point, n) in shapes.iter().enumerate() {
            let at = |nodal: &[f64; MOST]| n.iter().zip(nodal).map(|(n, w)| n * w).sum();
            weights.inertia[point] = at(alpha);
            weights.stiffness[point] = at(delta);
        }
        weights
    }

    /// Refuses a weight of stiffness below zero, or none that is a number.
    pub(super) fn checked(self, body: &str, cell: ElementId) -> Result<PointWeights, Error> {
        // rounding of a weight that ends at a node
        let bad = |w: &&f64| w.is_nan() || **w < -1e-12;
        match self.stiffness.iter().find(bad) {
            Some(&weight) => Err(Error::NegativeStiffness {
                body: body.to_owned(),
                cell,
                weight,
            }),
            None => Ok(self),
        }
    }
}

/// α and δ at the nodes of each cell.
pub(super) fn nodal(mesh: &Mesh, spec: &BodySpec) -> Result<Vec<[[f64; MOST]; 2]>, Error> {
    let Some(weights) = &spec.weights else {
        return Ok(vec![[[1.0; MOST]; 2]; spec.cells.len()]);
    };
    weights.check(&spec.name, mesh, &spec.cells)?;
    let mut from = 0;
    let of = |&cell: &ElementId| {
        let count = mesh.element_nodes(cell).len();
        let own = [&weights.inertia, &weights.stiffness].map(|list| {
            let mut own = [0.0; MOST];
            own[..count].copy_from_slice(&list[from..from + count]);
            own
        });
        from += count;
        own
    };
    Ok(spec.cells.iter().map(of).collect())
}
