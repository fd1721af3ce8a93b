//! A box around a face, whether flat or curved.

use carom_elements::{Kind, MAX_FACE_NODES, map};

use crate::{Bounds, Face};

impl Face {
    /// A box that holds all points of the face, not only its nodes; the smallest one for linear faces.
    ///
    /// `positions`: of the face's nodes, in its order, m. With L the linear face of the corners, y = L + Σ N_m δ_m: δ_m is
    /// how far a midside node stands off L, that of the centre how far off the face of the other eight, and 0 <= N_m <= 1.
    pub fn bounds(&self, positions: &[[f64; 3]]) -> Bounds {
        let (corners, linear) = match self.kind {
            Kind::Bar3 => (2, Kind::Bar2),
            Kind::Tri6 => (3, Kind::Tri3),
            Kind::Quad8 | Kind::Quad9 => (4, Kind::Quad4),
            _ => return Bounds::of(positions),
        };
        let mut bounds = Bounds::of(&positions[..corners]);
        let mut off = [[0.0; 3]; MAX_FACE_NODES];
        for (m, xi) in self.kind.table().reference.iter().enumerate().skip(corners) {
            let mut n = [0.0; 4];
            (linear.table().shape)(xi, &mut n[..corners]);
            let mut flat = map::point(&positions[..corners], &n[..corners]);
            if m == 8 {
                // at the centre each of the four midside functions is one half
                for of_side in &off[4..8] {
                    (0..3).for_each(|i| flat[i] += 0.5 * of_side[i]);
                }
            }
            off[m] = [0, 1, 2].map(|i| positions[m][i] - flat[i]);
            for (i, off) in off[m].iter().enumerate() {
                bounds.min[i] += off.min(0.0);
                bounds.max[i] += off.max(0.0);
            }
        }
        bounds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::{ElementId, face_nodes};

    #[test]
    fn the_box_holds_every_point_of_curved_faces_and_is_tight_for_flat_ones() {
        let mut random = Random::new(8);
        for kind in [
            Kind::Bar3,
            Kind::Tri6,
            Kind::Quad8,
            Kind::Quad9,
            Kind::Quad4,
        ] {
            let table = kind.table();
            let face = Face {
                kind,
                nodes: face_nodes(&[0; 9][..table.nodes]),
                parent: ElementId { block: 0, index: 0 },
                axis: [0.0; 3],
            };
            let mut bulges = 0;
            for shake in [0.0, 0.4, 0.4, 0.4] {
                let x: Vec<[f64; 3]> = table
                    .reference
                    .iter()
                    .map(|xi| {
                        let shake = random.point(shake);
                        [0, 1, 2].map(|i| xi[i] + shake[i])
                    })
                    .collect();
                let (bounds, of_nodes) = (face.bounds(&x), Bounds::of(&x));
                if shake == 0.0 {
                    assert_eq!(bounds, of_nodes);
                }
                for _ in 0..500 {
                    let mut xi = random.point(1.0);
                    xi[2] = 0.0;
                    if !(table.contains)(&xi, 0.0) {
                        continue;
                    }
                    if table.dim == 1 {
                        xi[1] = 0.0;
                    }
                    let mut n = vec![0.0; table.nodes];
                    (table.shape)(&xi, &mut n);
                    let y = map::point(&x, &n);
                    assert!(bounds.distance_squared(&y) < 1e-28);
                    bulges += usize::from(of_nodes.distance_squared(&y) > 1e-28);
                }
            }
            assert_eq!(bulges > 0, kind != Kind::Quad4, "{kind:?}");
        }
    }
}
