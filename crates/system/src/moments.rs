//! Contacts whose moment is asked for: the point that it is about, and what belongs to the secondary side.

use carom_contact::Contact;
use carom_mesh::Face;

use crate::error::Error;
use crate::made::Made;
use crate::model::ModelContact;
use crate::moment_arms::MomentArms;

/// The point that the moment of a contact is about, and what its forces on the secondary body act on.
#[derive(Clone, Debug, PartialEq)]
pub struct MomentAbout {
    /// The point, fixed in space, m.
    pub point: [f64; 3],
    /// What moves nodes of the secondary surface.
    pub arms: MomentArms,
}

impl MomentAbout {
    /// `None` where no moment is asked for. `faces`: the secondary surface by system number.
    ///
    /// # Errors
    /// [`Error::MomentAbout`] where there is no moment, or the two sides share nodes.
    pub(crate) fn of(
        model: &ModelContact,
        (contact, faces): (&Contact, &[Face]),
        of: &Made,
    ) -> Result<Option<MomentAbout>, Error> {
        let Some(point) = model.moment_about else {
            return Ok(None);
        };
        let refuse = |cause| {
            Err(Error::MomentAbout {
                contact: contact.name.clone(),
                cause,
            })
        };
        let unknowns = of.unknowns;
        if of.model.mesh.dim < 2 || of.axisymmetric {
            return refuse("forces along a line and axisymmetric ones have no moment");
        }
        let mut secondary = vec![false; unknowns.len()];
        let own = contact.points.iter().filter(|point| !point.is_on_primary());
        let own = own.flat_map(|point| point.carriers());
        let of_faces = faces.iter().flat_map(|face| face.corners());
        for node in own.map(|(node, _)| node).chain(of_faces.copied()) {
            secondary[unknowns.of(unknowns.moved_by(node))].fill(true);
        }
        let primary = contact.faces_of_primary(faces.len());
        let mut opposite = primary.iter().flat_map(|face| face.corners());
        let shared = |&node: &u32| {
            let mut of = unknowns.of(unknowns.moved_by(node));
            of.any(|unknown| secondary[unknown])
        };
        if opposite.any(shared) {
            return refuse("its two sides share nodes, whose forces belong to both");
        }
        let arms = of.arms.among(unknowns, |unknown| secondary[unknown]);
        Ok(Some(MomentAbout { point, arms }))
    }
}
