//! Contacts that the points of two pieces of one surface tell.

use super::Pairing;
use crate::Contact;

impl Contact {
    /// Whether a point leaves its contact to those that it faces: all nodes of the face opposite to it have points that `take_part` and go
    /// before it, and one of them faces it. It is then on the other side of their rows. `first`: number of the contact's
    /// first point in the pairing; points by their numbers in the contact.
    pub fn leaves_it(
        &self,
        (pairing, first): (&Pairing, usize),
        point: usize,
        take_part: impl Fn(usize) -> bool,
    ) -> bool {
        let sides = self.sight.as_ref().and_then(|sight| sight.sides());
        let (Some(sides), Some(own)) = (sides, self.points[point].as_node()) else {
            return false;
        };
        let mut is_faced = false;
        for node in pairing.opposite(first + point) {
            let Some(other) = sides.point_of(node) else {
                return false;
            };
            if !sides.yields(point, other) || !take_part(other) {
                return false;
            }
            is_faced |= pairing.opposite(first + other).any(|node| node == own);
        }
        is_faced
    }
}

impl Pairing {
    /// Nodes of the face opposite to a point that is a node; none of one that faces nothing or an obstacle.
    fn opposite(&self, point: usize) -> impl Iterator<Item = u32> + '_ {
        let of = |(stencil, _): &(u32, f64)| self.stencils[*stencil as usize].opposite();
        self.terms(point).iter().flat_map(of).map(|(node, _)| node)
    }
}
