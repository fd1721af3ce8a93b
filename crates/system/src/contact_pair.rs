//! What a system knows of each of its contacts.

use std::ops::{Deref, Range};

use carom_contact::{Contact, Friction, Target};
use carom_mesh::Face;

use crate::contacts::{is_of_many, renumbered, sides, touching};
use crate::error::Error;
use crate::extents::passage;
use crate::made::Made;
use crate::moments::MomentAbout;
use crate::tolerances::Tolerances;

/// A contact of a system. It is used as the [`Contact`] that it holds: points, target and law, nodes by system number.
#[derive(Clone, Debug)]
pub struct ContactPair {
    /// The contact.
    pub contact: Contact,
    /// Its points in the arrays over all points.
    pub range: Range<usize>,
    /// Faces of the secondary surface.
    pub secondary_faces: Vec<Face>,
    /// Body of the secondary side, of several the first.
    pub secondary_body: usize,
    /// The same of the primary side; none of a rigid obstacle.
    pub primary_body: Option<usize>,
    /// All bodies of both sides, ascending.
    pub bodies: Vec<usize>,
    /// Whether a side has several bodies that move apart: what two bodies do to each other is then not told apart.
    pub is_of_many: bool,
    /// Gap below which a point counts as closed, m: 1e-12 of the size of the bodies that it may touch, since how large others are says nothing of
    /// a gap.
    pub tolerance: f64,
    /// Time that a wave needs to pass over the smallest element at a side, of the slower side, s.
    pub passage: f64,
    /// Friction.
    pub friction: Friction,
    /// Duration of a flight that ends an impact, s; none where waves and steps tell.
    pub merge_within: Option<f64>,
    /// What the moment of its forces is about; none where none is reported.
    pub moment: Option<MomentAbout>,
}

impl Deref for ContactPair {
    type Target = Contact;

    fn deref(&self) -> &Contact {
        &self.contact
    }
}

impl ContactPair {
    /// Faces of the primary side, by system number; none of an obstacle.
    pub fn primary_faces(&self) -> &[Face] {
        self.contact.faces_of_primary(self.secondary_faces.len())
    }

    /// Faces whose nodes are its points, by system number: of the secondary side, or of both.
    pub fn faces_of_points(&self) -> &[Face] {
        match &self.target {
            Target::Surface(faces) if self.looks_both_ways() => faces,
            _ => &self.secondary_faces,
        }
    }

    /// The contacts of a model, from those by system number.
    ///
    /// # Errors
    /// [`Error::MomentAbout`].
    pub(crate) fn all(contacts: Vec<Contact>, of: &Made) -> Result<Vec<ContactPair>, Error> {
        let tolerances = Tolerances::new(of.model);
        let mut first = 0;
        let of_model = of.model.contacts.iter().zip(contacts);
        let pairs = of_model.map(|(given, contact)| {
            let faces = given.secondary.faces.iter();
            let secondary_faces: Vec<Face> =
                faces.map(|face| renumbered(face, of.number)).collect();
            let (secondary_body, primary_body) = sides(given, of.model);
            let bodies = touching(given, of.model, of.owners);
            let range = first..first + contact.points.len();
            first = range.end;
            Ok(ContactPair {
                moment: MomentAbout::of(given, (&contact, &secondary_faces), of)?,
                range,
                secondary_body,
                primary_body,
                is_of_many: is_of_many(given, of.owners, of.part_of_body),
                tolerance: tolerances.of(&bodies),
                passage: passage(given, of, &bodies),
                friction: given.friction,
                merge_within: given.merge_within,
                secondary_faces,
                bodies,
                contact,
            })
        });
        pairs.collect()
    }
}
