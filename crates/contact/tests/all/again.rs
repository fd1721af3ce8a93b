//! Points paired again.

use carom_contact::{Basis, Integration, Search};
use carom_testing::Random;

use crate::fixture::paired;
use crate::pairs::flat_pairs;

#[test]
fn points_paired_again_are_what_a_new_pairing_makes_of_them_and_others_stay() {
    for pair in flat_pairs() {
        for integration in [
            Integration::Mortar {
                basis: Basis::Standard,
            },
            Integration::Node,
        ] {
            let mut contact = pair.contact(Basis::Standard, 1.0);
            contact.integration = integration;
            if integration == Integration::Node {
                contact.mortar = None;
            }
            let u: Vec<f64> = Random(1).vector(pair.dim * pair.x.len());
            let small: Vec<f64> = u.iter().map(|u| 1e-3 * u).collect();
            let before = paired(&contact, &pair.places(&vec![0.0; u.len()]));
            let after = paired(&contact, &pair.places(&small));
            let mut pairing = before.clone();
            let wanted: Vec<u32> = (0..before.len() as u32).step_by(2).collect();
            let places = pair.places(&small);
            contact.pair_again(&places, &mut Search::default(), (&wanted, 0), &mut pairing);
            for point in 0..before.len() {
                let chosen = wanted.contains(&(point as u32));
                if !chosen && integration == Integration::Node {
                    continue;
                }
                let of = if chosen { &after } else { &before };
                assert_eq!(pairing.rows.gap(point), of.rows.gap(point), "{point}");
                assert_eq!(pairing.rows.row(point), of.rows.row(point), "{point}");
                assert_eq!(pairing.rows.normal(point), of.rows.normal(point));
                for (rows, tangents) in pairing.tangents[..pair.dim - 1].iter().zip(&of.tangents) {
                    assert_eq!(rows.row(point), tangents.row(point), "{point}");
                }
                assert_eq!(pairing.areas[point], of.areas[point]);
            }
        }
    }
}
