//! Which laws hold where a contact is integrated.

use carom_contact::{Contact, Integration, Target};
use carom_mesh::Face;

use crate::contact_pair::ContactPair;
use crate::contacts::is_axis;
use crate::error::Error;
use crate::system::System;

const WHICH_LAWS: &str = "at Gauss points hold, in their weak form, the displacement law without projection and the velocity law, and, in each point by itself, the compliance, and penalty and stop without damping; the other laws hold at nodes";

impl System {
    /// Refuses laws that cannot hold where they are asked to.
    pub(crate) fn check_integration(&self) -> Result<(), Error> {
        let cause = |contact: &Contact| match contact.integration {
            Integration::Weak { r } if !(r > 0.0 && r.is_finite()) => {
                Some("r of the weak form must be positive and finite")
            }
            Integration::Weak { .. } if !contact.law.has_weak_form() => Some(WHICH_LAWS),
            Integration::Points if !contact.law.is_function() => Some(WHICH_LAWS),
            Integration::Weak { .. }
            | Integration::Points
            | Integration::Node
            | Integration::Mortar { .. } => None,
        };
        let cause = |pair: &ContactPair| {
            let around = || unfit_around_axes(pair, &pair.secondary_faces, self.dim);
            cause(pair).or_else(around)
        };
        let mut contacts = self.contacts.iter();
        match contacts.find_map(|pair| Some((pair, cause(pair)?))) {
            None => Ok(()),
            Some((contact, cause)) => Err(Error::Integration {
                contact: contact.name.clone(),
                cause,
            }),
        }
    }
}

/// Why a contact with surfaces around axes cannot be as it is, if it cannot.
fn unfit_around_axes(contact: &Contact, secondary: &[Face], dim: usize) -> Option<&'static str> {
    let target = match &contact.target {
        Target::Surface(faces) => &faces[..],
        Target::Rigid(_) => &[],
    };
    let faces = || secondary.iter().chain(target);
    if !faces().any(Face::is_round) {
        return None;
    }
    match contact.integration {
        Integration::Mortar { .. } if dim == 3 && faces().any(is_axis) => Some(
            "in space surfaces around axes of beams have no mortar method: lines that cross have no area in common",
        ),
        _ if contact
            .sight
            .as_ref()
            .is_some_and(|sight| !sight.has_both_sides()) =>
        {
            Some("a depth means nothing to surfaces around axes of beams and middles of shells")
        }
        _ if target
            .iter()
            .any(|face| face.is_round() && face.radius == Some(0.0)) =>
        {
            Some(
                "beams without a radius are no primary side: their axis has no inside that a point could be kept out of",
            )
        }
        _ => None,
    }
}
