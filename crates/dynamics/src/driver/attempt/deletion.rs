//! Elements that are deleted at the end of an attempt.

use carom_bodies::{Body, Placement};

use super::Attempt;
use crate::error::Error;
use crate::system::System;

impl Attempt {
    /// Deletes the elements that have reached their limit in the attempt.
    ///
    /// # Errors
    /// An element without stress.
    pub(crate) fn delete_elements(&mut self) -> Result<(), Error> {
        let (old, next) = (&self.state.motion, &mut self.next);
        let before = next.ledger.deleted;
        let bodies = self.system.bodies.iter().enumerate();
        for (number, body) in bodies.filter(|(_, body)| Body::has_deletion(body)) {
            let range = self.system.nonlinear.histories[number].clone();
            let at = Placement {
                u: &next.motion.u,
                v: &next.motion.v,
                from: None,
                frames: &old.frames,
                dt: self.dt,
                old: &old.history[range.clone()],
            };
            let deleted = body.delete(&at, &mut next.motion.history[range])?;
            if deleted.elements > 0 {
                next.ledger.delete(&deleted);
                next.assemblies.delete(number, &deleted);
            }
        }
        if next.ledger.deleted > before {
            next.records.loose = loose(&self.system, &next.motion.history);
        }
        Ok(())
    }
}

/// Whether all elements at the node of each contact point are deleted. Nodes without any element, as those of point masses, are not meant.
fn loose(system: &System, histories: &[f64]) -> Vec<bool> {
    let mut had = vec![false; system.x.len()];
    let mut has = vec![false; system.x.len()];
    let mark = |marks: &mut Vec<bool>, nodes: &[u32]| {
        for &node in nodes {
            marks[node as usize] = true;
        }
    };
    for (number, body) in system.bodies.iter().enumerate() {
        let history = system.history(number, histories);
        body.each_element_left(history, &mut |nodes| mark(&mut has, nodes));
        if body.has_deletion() {
            body.each_element(&mut |nodes| mark(&mut had, nodes));
        }
    }
    let points = system.contacts.iter().flat_map(|contact| &contact.points);
    let is_loose = |node: usize| had[node] && !has[node];
    points
        .map(|point| is_loose(point.node() as usize))
        .collect()
}
