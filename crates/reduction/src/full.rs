//! The full body of a reduction, by itself.

use std::sync::Arc;

use carom_algebra::unknowns::Kind;
use carom_system::{Damping, Model, ModelBody, System};

use crate::error::Error;
use crate::matrices::Matrices;
use crate::retained::retained;
use crate::statics::dot;

/// Force of a translation, over the largest stiffness, that is rounding.
const ROUNDING: f64 = 1e-12;

/// What a reduction keeps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keep {
    /// Number of modes.
    pub modes: usize,
    /// Nodes of the mesh that are retained beside those on which something acts.
    pub nodes: Vec<u32>,
    /// Whether the retained unknowns have no mass: modes are then those of the body with free retained nodes.
    pub massless: bool,
    /// Damping ratio of the modes.
    pub ratio: f64,
    /// Rayleigh's damping.
    pub rayleigh: Damping,
}

/// The full body by itself.
pub(crate) struct Full {
    pub(crate) name: String,
    pub(crate) system: Arc<System>,
    pub(crate) matrices: Matrices,
    /// Held by supports, and not retained.
    pub(crate) fixed: Vec<bool>,
    /// Retained unknowns.
    pub(crate) border: Vec<usize>,
}

impl Full {
    /// The full body, and the nodes of the mesh that are retained.
    pub(crate) fn of(model: &Model, body: usize, keep: &Keep) -> Result<(Full, Vec<u32>), Error> {
        let retained = retained(model, body, &keep.nodes);
        Ok((Full::new(model, body, &retained)?, retained))
    }

    pub(crate) fn new(model: &Model, body: usize, retained: &[u32]) -> Result<Full, Error> {
        let given = &model.bodies[body];
        let refused = |why| Error::Refused {
            body: given.spec.name.clone(),
            why,
        };
        if given.rigid.is_some() {
            return Err(refused("it is rigid"));
        }
        if given.reduced.is_some() {
            return Err(refused("it is reduced already"));
        }
        let own = ModelBody {
            mass: given.mass,
            ..ModelBody::new(given.spec.clone())
        };
        let system = System::whole(Model {
            supports: model.supports.clone(),
            ..Model::new(vec![own], model.mesh.clone(), model.scheme, 1.0)
        })?;
        if !system.bodies[0].is_linear() {
            return Err(refused(match system.bodies[0].has_finite_motion() {
                true => "it is at finite strain; its modes are those of small strain",
                false => "its material flows; modes are those of an elastic body",
            }));
        }
        let of_node = |&node: &u32| system.unknowns.of(system.number[node as usize]);
        let border: Vec<usize> = retained.iter().flat_map(of_node).collect();
        let mut fixed = system.fixed.clone();
        border.iter().for_each(|&unknown| fixed[unknown] = false);
        Ok(Full {
            name: given.spec.name.clone(),
            matrices: Matrices::new(&system)?,
            system,
            fixed,
            border,
        })
    }

    /// Unknowns that supports hold, and the retained ones.
    pub(crate) fn held(&self, border: bool) -> Vec<bool> {
        let mut held = self.fixed.clone();
        self.border
            .iter()
            .for_each(|&unknown| held[unknown] |= border);
        held
    }

    pub(crate) fn refused(&self, cause: carom_algebra::Error) -> Error {
        Error::Static {
            body: self.name.clone(),
            cause,
        }
    }

    /// 1 for translations along an axis.
    pub(crate) fn translation(&self, axis: usize) -> Vec<f64> {
        let moves = |i: usize| self.system.unknowns.kind(i) == Kind::Translation(axis);
        let all = 0..self.system.unknowns();
        all.map(|i| if moves(i) { 1.0 } else { 0.0 }).collect()
    }

    /// A motion without that of the unknowns that supports hold.
    pub(crate) fn freed(&self, mut motion: Vec<f64>) -> Vec<f64> {
        for (motion, _) in motion
            .iter_mut()
            .zip(&self.fixed)
            .filter(|(_, fixed)| **fixed)
        {
            *motion = 0.0;
        }
        motion
    }

    /// Whether a motion is one and needs no force: K r = 0 beside the rounding of the elements' sums.
    pub(crate) fn is_free(&self, motion: &[f64]) -> bool {
        let stiffness = &self.matrices.stiffness;
        let mut force = vec![0.0; motion.len()];
        stiffness.multiply(motion, &mut force);
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0_f64, |m, x| m.max(x.abs()));
        let free = force.iter().zip(&self.fixed).filter(|(_, fixed)| !**fixed);
        let left = largest(&mut free.map(|(force, _)| *force));
        let moves = largest(&mut motion.iter().copied());
        let stiffest = largest(&mut (0..motion.len()).map(|i| stiffness.get(i, i)));
        moves > 0.0 && left <= ROUNDING * moves * stiffest
    }

    /// The motion of a unit rotation about an axis through a place.
    pub(crate) fn rotation(&self, axis: usize, about: [f64; 3]) -> Vec<f64> {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let unknowns = &self.system.unknowns;
        let of = |i: usize| {
            let x = &self.system.x[unknowns.node(i) as usize];
            match unknowns.kind(i) {
                Kind::Translation(a) if a == j => about[k] - x[k],
                Kind::Translation(a) if a == k => x[j] - about[j],
                Kind::Rotation(a) if a == axis => 1.0,
                _ => 0.0,
            }
        };
        (0..self.system.unknowns()).map(of).collect()
    }

    /// Tᵀ M r.
    pub(crate) fn inertia(&self, columns: &[Vec<f64>], motion: &[f64]) -> Vec<f64> {
        let mut image = vec![0.0; motion.len()];
        self.matrices.mass.multiply(motion, &mut image);
        columns.iter().map(|column| dot(column, &image)).collect()
    }
}
