//! Faces of primary sides where cells are deleted: those of deleted cells leave, those that become free join.

use std::collections::BTreeSet;

use carom_contact::Target;
use carom_mesh::{ElementId, Face};

use crate::System;
use crate::contacts::renumbered;

impl System {
    /// Whether cells at the primary side of a contact may be deleted.
    pub fn may_lay_bare(&self, contact: usize) -> bool {
        match (
            &self.contacts[contact].target,
            self.contacts[contact].primary_body,
        ) {
            (Target::Surface(_), Some(body)) => self.bodies[body].has_deletion(),
            _ => false,
        }
    }

    /// The faces of the primary side of a contact with these histories of all bodies: first those of the surface whose cells are left, in
    /// their order, then those of its body that deletion has laid bare. None of a side without deletion.
    pub fn faces_left(&self, contact: usize, histories: &[f64]) -> Option<Vec<Face>> {
        let body = self.contacts[contact].primary_body?;
        let Target::Surface(faces) = &self.contacts[contact].target else {
            return None;
        };
        let cells = self.bodies[body].cells();
        let deleted = self.bodies[body].deleted(self.history(body, histories))?;
        let gone = cells.iter().zip(&deleted).filter(|(_, deleted)| **deleted);
        let gone: BTreeSet<ElementId> = gone.map(|(cell, _)| *cell).collect();
        let left = faces.iter().filter(|face| !gone.contains(&face.parent));
        let bare = self.mesh.bare_faces(cells, &deleted);
        let bare = bare.iter().map(|face| renumbered(face, &self.number));
        Some(left.copied().chain(bare).collect())
    }
}
