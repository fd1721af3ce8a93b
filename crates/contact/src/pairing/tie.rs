//! Surfaces that are tied rather than in contact: the mortar integrals of both sides.

use carom_algebra::unknowns::Unknowns;
use carom_mesh::Face;

use super::Pairing;
use crate::law::Displacement;
use crate::{Basis, Contact, Frames, Integration, Law, Mortar, Places, Search, Sliding, Target};

/// What one multiplier of a tie holds together.
#[derive(Clone, Debug, PartialEq)]
pub struct Tie {
    /// Its node on the secondary surface.
    pub node: u32,
    /// `∫ φ_A φ_B dΓ` over what faces the primary surface, by secondary node B, ascending, m².
    pub secondary: Vec<(u32, f64)>,
    /// `∫ φ_A ψ_C dΓ` by primary node C, ascending, m².
    pub primary: Vec<(u32, f64)>,
}

impl Tie {
    /// The ties of two surfaces as they lie, one for each multiplier that faces anything: rows
    /// `Σ_B ∫ φ_A φ_B v_B - Σ_C ∫ φ_A ψ_C v_C = 0` in each direction. Both sides are integrated with the same quadrature
    /// points, so what is uniform, and on flat surfaces what is linear, satisfies the rows.
    ///
    /// `secondary`, `primary`: faces whose normals point out of their bodies, nodes by number in `x` (m). `factor`: as in
    /// [`Mortar::new`].
    pub fn all(
        (secondary, primary): (Vec<Face>, Vec<Face>),
        (x, dim): (&[[f64; 3]], usize),
        basis: Basis,
        factor: impl Fn(&[f64; 3]) -> f64,
    ) -> Vec<Tie> {
        let (mortar, points) = Mortar::new(secondary, x, factor);
        let contact = Contact {
            name: String::new(),
            law: Law::Displacement(Displacement::default()),
            sliding: Sliding::Small,
            integration: Integration::Mortar { basis },
            points,
            mortar: Some(mortar),
            target: Target::Surface(primary),
            sight: None,
            edges: None,
            offsets: Vec::new(),
            near_only: false,
        };
        let places = Places {
            unknowns: &Unknowns::translations(dim, x.len()),
            time: 0.0,
            x,
            u: &vec![0.0; dim * x.len()],
            frames: Frames::default(),
        };
        let mut pairing = Pairing::default();
        pairing.clear();
        contact.pair_fully(&places, &mut Search::default(), &mut pairing);
        let nodes = contact.points.iter().map(|point| point.node()).enumerate();
        nodes
            .filter(|(point, _)| !pairing.terms(*point).is_empty())
            .map(|(point, node)| pairing.tie(point, node))
            .collect()
    }
}

impl Pairing {
    fn tie(&self, point: usize, node: u32) -> Tie {
        let area = self.areas[point];
        let (mut secondary, mut primary) = (Vec::new(), Vec::new());
        for &(stencil, weight) in self.terms(point) {
            let stencil = &self.stencils[stencil as usize];
            let weighted = |(node, n): (u32, f64)| (node, area * weight * n);
            secondary.extend(stencil.carriers().map(weighted));
            primary.extend(stencil.opposite().map(weighted));
        }
        Tie {
            node,
            secondary: summed(secondary),
            primary: summed(primary),
        }
    }
}

/// Terms of the same node as one, ascending.
fn summed(mut terms: Vec<(u32, f64)>) -> Vec<(u32, f64)> {
    terms.sort_by_key(|(node, _)| *node);
    let mut sums: Vec<(u32, f64)> = Vec::new();
    for (node, value) in terms {
        match sums.last_mut() {
            Some((last, sum)) if *last == node => *sum += value,
            _ => sums.push((node, value)),
        }
    }
    sums.retain(|(_, sum)| *sum != 0.0);
    sums
}

#[cfg(test)]
mod tests {
    use carom_mesh::{Surface, generate};

    use super::*;

    /// Faces of two blocks of 2 and 3 elements along a side that meet at z = 1, and the nodes.
    fn blocks() -> (Vec<[f64; 3]>, Vec<Face>, Vec<Face>) {
        let mut mesh = generate::box_("low", [0.0; 3], [1.0; 3], [2, 2, 1], false);
        let high = generate::box_("high", [0.0, 0.0, 1.0], [1.0; 3], [3, 3, 1], false);
        mesh.merge("two", high).unwrap();
        let faces = |body: &str, side: &str| {
            let cells = &mesh.groups[body].elements;
            let group = &mesh.groups[&format!("{body}.{side}")];
            Surface::new(&mesh, group, cells).unwrap().faces
        };
        let (low, high) = (faces("low", "top"), faces("high", "bottom"));
        (mesh.nodes, low, high)
    }

    #[test]
    fn what_is_linear_satisfies_the_rows_of_a_tie_and_they_share_the_area() {
        let (x, low, high) = blocks();
        let field = |node: u32| {
            let x = x[node as usize];
            0.3 + x[0] - 2.0 * x[1]
        };
        for basis in [Basis::Standard, Basis::Dual] {
            let ties = Tie::all((high.clone(), low.clone()), (&x, 3), basis, |_| 1.0);
            assert_eq!(ties.len(), 16);
            let on = |terms: &[(u32, f64)], field: &dyn Fn(u32) -> f64| -> f64 {
                terms.iter().map(|(node, c)| c * field(*node)).sum()
            };
            let mut area = 0.0;
            for tie in &ties {
                // rounding of a hundred products below 1
                let [one, other] = [&tie.secondary, &tie.primary].map(|terms| on(terms, &field));
                assert!((one - other).abs() < 1e-13, "{one} {other}");
                area += on(&tie.primary, &|_| 1.0);
            }
            assert!((area - 1.0).abs() < 1e-13);
        }
    }
}
