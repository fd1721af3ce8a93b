//! What ranks together see of the shapes of their elements.

use carom_bodies::{Bending, Distortion, Extreme, Share};

use crate::shared::Shared;

impl Shared {
    /// How far the elements of each body lock in bending at the displacement `u`, of all ranks together; none of bodies without such elements.
    pub(crate) fn bending(&self, u: &[f64]) -> Vec<Option<Bending>> {
        let of_body = |shares: &[Share; 2]| {
            let found = shares.iter().map(|share| share.solid().bending(u));
            let found = found.flatten().reduce(Bending::with);
            found.map_or([0.0; 3], |own| [1.0, own.energy, own.locked])
        };
        let mut sums: Vec<f64> = self.bodies().flat_map(of_body).collect();
        self.ranks.reduce(&mut sums, &mut []);
        let bodies = sums.chunks_exact(3);
        let bending = bodies.map(|sum| {
            (sum[0] > 0.0).then_some(Bending {
                energy: sum[1],
                locked: sum[2],
            })
        });
        bending.collect()
    }

    /// Rotation and strain of the elements of each body at the displacement `u`, the largest of all ranks; none at finite strain. `looks`: by body,
    /// which point of each element is looked at.
    pub(crate) fn distortions(&self, u: &[f64], looks: &[f64]) -> Vec<Option<Distortion>> {
        let none = Distortion::default();
        let of_body = |(body, shares): (usize, &[Share; 2])| {
            let mut found = [[0.0; 2]; 2];
            let mut small = false;
            for share in shares {
                let Some(own) = share.solid().distortion(u, looks[body] as usize, &none) else {
                    continue;
                };
                small = true;
                for (most, one) in found.iter_mut().zip([own.rotation, own.strain]) {
                    if let Some(&place) = share.places().get(one.cell as usize)
                        && one.value > most[0]
                    {
                        *most = [one.value, f64::from(self.place_in_whole(body, place))];
                    }
                }
            }
            (small, found)
        };
        let own: Vec<(bool, [[f64; 2]; 2])> = self.bodies().enumerate().map(of_body).collect();
        let values = own.iter().flat_map(|(_, found)| found.map(|one| one[0]));
        let mut values: Vec<f64> = values.collect();
        self.ranks.reduce(&mut [], &mut values);
        // of ranks with the same value the first place
        let places = own.iter().flat_map(|(_, found)| *found);
        let places = places.zip(&values);
        let mut places: Vec<f64> = places
            .map(|([value, place], most)| {
                if value == *most {
                    -place
                } else {
                    f64::NEG_INFINITY
                }
            })
            .collect();
        self.ranks.reduce(&mut [], &mut places);
        let extreme = |k: usize| Extreme {
            value: values[k],
            cell: -places[k] as u32,
        };
        let distortion = |(body, (small, _)): (usize, &(bool, _))| {
            small.then(|| Distortion {
                rotation: extreme(2 * body),
                strain: extreme(2 * body + 1),
            })
        };
        own.iter().enumerate().map(distortion).collect()
    }
}
