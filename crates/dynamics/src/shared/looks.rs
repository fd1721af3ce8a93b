//! Looks at the frequencies of elements, each by the rank that has it.

use carom_bodies::{Body, Looks, Seen, Share, Solid};
use carom_ranks::{Message, Ranks};

use super::OwnElements;
use super::halo::{Halo, Parts};
use crate::error::Error;
use crate::system::{Motion, System};

/// What is known of the frequencies of the elements of a rank.
#[derive(Debug, Default)]
pub(super) struct SharedLooks {
    /// Of each body those of the elements at nodes that others have too, and of the others.
    own: Vec<[Looks; 2]>,
    /// Elements of each body by rank.
    counts: Vec<Vec<usize>>,
    /// Whether any rank has found frequencies anew since the first one was given them.
    stale: bool,
}

impl SharedLooks {
    pub(super) fn new(parts: &Parts, ranks: usize) -> SharedLooks {
        let count = |rank: usize| {
            let of_body = |parts: &Vec<u32>| {
                let own = parts.iter().filter(|part| **part as usize == rank);
                own.count()
            };
            parts.iter().map(of_body).collect()
        };
        SharedLooks {
            own: Vec::new(),
            counts: (0..ranks).map(count).collect(),
            stale: false,
        }
    }

    /// Takes what is known of the elements of this rank, `shares` of each body, from what is known of all.
    pub(super) fn take(&mut self, system: &System, shares: &[[Share; 2]], all: &[Looks]) {
        let bodies = system.bodies.iter().zip(shares).enumerate();
        let of_body = |(k, (body, shares)): (usize, (&Body, &[Share; 2]))| {
            let known = all.get(k).filter(|looks| !looks.is_empty());
            let has_numbers = body.as_solid().and_then(Solid::numbers_of_look);
            let of_share = |share: &Share| {
                let Some(all) = known else {
                    return Looks::default();
                };
                if has_numbers.is_none() {
                    return all.clone();
                }
                let (mut own, mut numbers) = (Looks::default(), Vec::new());
                let places = share.places();
                for (element, &place) in places.iter().enumerate() {
                    numbers.clear();
                    all.push(place as usize, &mut numbers);
                    own.take((element, places.len()), &numbers);
                }
                own
            };
            [of_share(&shares[0]), of_share(&shares[1])]
        };
        self.own = bodies.map(of_body).collect();
    }

    /// As [`carom_bodies::Body::look`], of all bodies, each with the mean velocity (m/s) of its nodes.
    ///
    /// # Errors
    /// That of the first rank which has one, on all ranks.
    pub(super) fn look(
        &mut self,
        (ranks, halo, shares): (&Ranks, &Halo, &mut [[Share; 2]]),
        (system, motion): (&System, &Motion),
        worth: f64,
    ) -> Result<Vec<(Seen, [f64; 3])>, Error> {
        let mut found = Ok(Vec::new());
        for (k, shares) in shares.iter_mut().enumerate() {
            let at = system.placement(k, motion);
            let mut seen = Seen::default();
            for (share, looks) in shares.iter_mut().zip(&mut self.own[k]) {
                match share.look(&at, looks, worth) {
                    Ok(one) => seen = seen.with(&one),
                    Err(error) => found = found.and(Err(error)),
                }
            }
            if let Ok(found) = &mut found {
                found.push(seen);
            }
        }
        let text = found.as_ref().err().map(ToString::to_string);
        if let Some((rank, cause)) = ranks.first_text(text.as_deref()) {
            return Err(Error::OnRank { rank, cause });
        }
        let mut found = found?;
        let mut momenta = momenta((ranks.rank(), halo), system, &motion.v);
        let mut most: Vec<f64> = Vec::new();
        for seen in &found {
            most.extend([
                seen.bound.frequency,
                seen.bound.by_compression,
                -seen.shortest,
                seen.changed,
                f64::from(seen.is_renewed),
            ]);
        }
        ranks.reduce(&mut momenta, &mut most);
        for (seen, most) in found.iter_mut().zip(most.chunks_exact(5)) {
            (seen.bound.frequency, seen.bound.by_compression) = (most[0], most[1]);
            (seen.shortest, seen.changed, seen.is_renewed) = (-most[2], most[3], most[4] > 0.0);
            // of several ranks none knows whose it is
            seen.bound.cell = None;
            self.stale |= seen.is_renewed;
        }
        let velocities = momenta.chunks_exact(4);
        let velocities = velocities.map(|sum| [0, 1, 2].map(|i| sum[i] / sum[3]));
        Ok(found.into_iter().zip(velocities).collect())
    }

    /// Brings to the first rank, if there is anything new, what is known of the frequencies of all elements.
    pub(super) fn gather(
        &mut self,
        (ranks, elements, shares): (&Ranks, &OwnElements, &[[Share; 2]]),
        system: &System,
        all: &mut Vec<Looks>,
    ) {
        if !std::mem::take(&mut self.stale) {
            return;
        }
        let numbers = |k: usize| {
            let solid = system.bodies[k].as_solid();
            solid.and_then(Solid::numbers_of_look)
        };
        let mut own = Vec::new();
        for (k, (shares, looks)) in shares.iter().zip(&self.own).enumerate() {
            if numbers(k).is_none() {
                continue;
            }
            for (share, looks) in shares.iter().zip(looks) {
                for (element, &place) in share.places().iter().enumerate() {
                    own.push(f64::from(elements.place_in_whole(k, place)));
                    looks.push(element, &mut own);
                }
            }
        }
        if !ranks.is_first() {
            let message = Message {
                with: 0,
                values: own,
            };
            return ranks.exchange(&[message], &mut [], || ());
        }
        let length = |counts: &Vec<usize>| {
            let of_body = |(k, count): (usize, &usize)| numbers(k).map_or(0, |n| (n + 1) * count);
            counts.iter().enumerate().map(of_body).sum()
        };
        let others = self.counts.iter().enumerate().skip(1);
        let mut messages: Vec<Message> = others
            .map(|(with, counts)| Message {
                with,
                values: vec![0.0; length(counts)],
            })
            .collect();
        ranks.exchange(&[], &mut messages, || ());
        messages.insert(
            0,
            Message {
                with: 0,
                values: own,
            },
        );
        all.resize_with(system.bodies.len(), Looks::default);
        for (message, counts) in messages.iter().zip(&self.counts) {
            let mut values = &message.values[..];
            for (k, &count) in counts.iter().enumerate() {
                // what never changes is found again
                let Some(numbers) = numbers(k) else { continue };
                let whole = system.bodies[k].cells().len();
                for _ in 0..count {
                    let (own, rest) = values.split_at(numbers + 1);
                    all[k].take((own[0] as usize, whole), &own[1..]);
                    values = rest;
                }
            }
        }
    }
}

/// Σ m v (kg m/s) and Σ m (kg) of each body over the nodes that count on this rank.
fn momenta((rank, halo): (usize, &Halo), system: &System, v: &[f64]) -> Vec<f64> {
    let of_body = |masses: &Vec<(u32, f64)>| {
        let own = masses.iter();
        let own = own.filter(|(node, _)| halo.counts(*node as usize, rank));
        own.fold([0.0; 4], |sum, &(node, m)| {
            let [x, y, z] = system.unknowns.vector(node, v);
            [sum[0] + m * x, sum[1] + m * y, sum[2] + m * z, sum[3] + m]
        })
    };
    system.body_masses.iter().flat_map(of_body).collect()
}

/// Largest |v - w|² (m²/s²) over the nodes of each part, with the w of the part.
pub(super) fn fastest(
    (ranks, halo): (&Ranks, &Halo),
    system: &System,
    (w, v): (&[[f64; 3]], &[f64]),
) -> Vec<f64> {
    let mut squares = vec![0.0; system.parts.len()];
    for &node in &halo.present {
        let part = system.part_of(system.unknowns.first(node));
        let v = system.unknowns.vector(node, v);
        let square = (0..3).map(|i| (v[i] - w[part][i]).powi(2)).sum::<f64>();
        squares[part] = f64::max(squares[part], square);
    }
    ranks.reduce(&mut [], &mut squares);
    squares
}
