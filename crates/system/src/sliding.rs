//! Which contacts may slide far.

use std::collections::BTreeSet;

use crate::contacts::{bodies_of, owners};
use crate::model::{Model, ModelContact, damped, is_finite, needs_newton};
use crate::nonlinear::Damping;

impl Model {
    /// For each contact, whether its sides may move far along each other: it has friction, mortar or an obstacle that moves, one of its
    /// bodies is at finite strain, has finite rotations, damping, a load, a motion in time or an element that is not linear, or all bodies
    /// have a base acceleration, a static stage or a scheme with forces between two states. Other bodies do not count.
    pub fn slide_far(&self) -> Vec<bool> {
        let all = self.nonlinear.base.iter().any(Option::is_some)
            || self.nonlinear.preload.is_some()
            || self.scheme.get().is_between()
            || self.mixes_schemes();
        if all {
            return vec![true; self.contacts.len()];
        }
        let far = self.bodies_that_move_far();
        let owners = owners(self);
        let slides = |contact: &ModelContact| {
            let bodies = bodies_of(contact, &owners);
            needs_newton(contact) || bodies.iter().flatten().any(|&body| far[body])
        };
        self.contacts.iter().map(slides).collect()
    }

    /// For each body, and each set of discrete elements after them.
    fn bodies_that_move_far(&self) -> Vec<bool> {
        let driven = self.driven_nodes();
        let is_driven = |cells: &[_]| {
            let mut nodes = cells.iter().flat_map(|&cell| self.mesh.element_nodes(cell));
            nodes.any(|node| driven.contains(node))
        };
        let damping = |body: usize| self.nonlinear.damping.get(body);
        let solids = self.bodies.iter().enumerate().map(|(k, body)| {
            is_finite(body)
                || damped(body)
                || damping(k).is_some_and(|some| *some != Damping::default())
                || is_driven(&body.spec.cells)
        });
        let discrete = self.discrete.iter();
        let discrete = discrete.map(|some| !some.spec.is_linear() || is_driven(&some.spec.cells));
        solids.chain(discrete).collect()
    }

    /// Nodes with a load or a motion in time, and those of discrete elements that are not linear.
    fn driven_nodes(&self) -> BTreeSet<u32> {
        let Model { nonlinear, .. } = self;
        let mut nodes = BTreeSet::new();
        let faces = nonlinear.loads.iter().flat_map(|load| &load.surface.faces);
        nodes.extend(faces.flat_map(|face| face.corners()).copied());
        nodes.extend(nonlinear.nodal.iter().flat_map(|load| &load.nodes));
        nodes.extend(nonlinear.motions.iter().flat_map(|motion| &motion.nodes));
        nodes.extend(nonlinear.turns.iter().map(|turn| turn.node));
        let curved = self.discrete.iter().filter(|some| !some.spec.is_linear());
        let cells = curved.flat_map(|some| &some.spec.cells);
        nodes.extend(cells.flat_map(|&cell| self.mesh.element_nodes(cell)));
        nodes
    }
}
