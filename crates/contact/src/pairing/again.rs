//! Some points of a contact, paired again at another configuration.

use super::Pairing;
use super::stencil::Stencil;
use crate::{Contact, Integration, Places, Search, Target};

impl Contact {
    /// Pairs some points of a contact again, in a pairing that has all of its points: gap, rows and curvature of these become what
    /// [`Contact::pair_fully`] gives at this configuration. Those of others may, and need not.
    ///
    /// `wanted`: their numbers in the contact, ascending; `first`: the number of the contact's first point in the pairing.
    pub fn pair_again(
        &self,
        places: &Places,
        search: &mut Search,
        (wanted, first): (&[u32], usize),
        pairing: &mut Pairing,
    ) {
        self.renew(places, search);
        let shift = |pairing: &mut Pairing, k: usize| pairing.rows.shift(first + k, self.offset(k));
        match (self.integration, &self.mortar, &self.target) {
            (Integration::Mortar { basis }, Some(mortar), _) if !mortar.is_ends() => {
                let wants = |point: u32| wanted.binary_search(&point).is_ok();
                mortar.pair_some((self, basis), places, search, (&wants, first), pairing);
            }
            (_, _, Target::Rigid(obstacle)) => {
                let span = pairing.span;
                for &k in wanted {
                    let point = &self.points[k as usize];
                    let stencil = Stencil::on_obstacle(places, point, obstacle, span);
                    let of = (first + k as usize, point.area);
                    pairing.place(places, of, stencil.as_ref());
                }
            }
            _ => {
                self.pair_points(places, search, (first, pairing));
                return (0..self.points.len()).for_each(|k| shift(pairing, k));
            }
        }
        wanted.iter().for_each(|&k| shift(pairing, k as usize));
    }
}
