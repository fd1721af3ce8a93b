//! Eight boxes at once, in single precision. What coordinates lose there is added to the distances that are asked for.

use crate::Bounds;
use crate::bounds::{larger, smaller};

/// Boxes side by side.
pub(super) const WIDTH: usize = 8;

/// What a distance may lose, over the largest coordinates of box and place: ε/2 in each of them and in their difference, along three
/// axes √3 ε, and as much again for the margin.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// Boxes relative to a place; those that do not exist are empty.
#[derive(Clone, Debug, PartialEq)]
#[repr(align(64))]
pub(super) struct Wide {
    min: [[f32; WIDTH]; 3],
    max: [[f32; WIDTH]; 3],
}

impl Wide {
    pub const EMPTY: Wide = Wide {
        min: [[f32::INFINITY; WIDTH]; 3],
        max: [[f32::NEG_INFINITY; WIDTH]; 3],
    };

    /// Takes a box.
    #[inline]
    pub fn set(&mut self, at: usize, bounds: &Bounds, origin: &[f64; 3]) {
        for i in 0..3 {
            self.min[i][at] = (bounds.min[i] - origin[i]) as f32;
            self.max[i][at] = (bounds.max[i] - origin[i]) as f32;
        }
    }

    /// Takes the box around the boxes of another.
    pub fn set_around(&mut self, at: usize, other: &Wide) {
        for i in 0..3 {
            let (min, max) = (other.min[i].iter(), other.max[i].iter());
            self.min[i][at] = min.fold(f32::INFINITY, |least, x| smaller(least, *x));
            self.max[i][at] = max.fold(f32::NEG_INFINITY, |most, x| larger(most, *x));
        }
    }

    /// Sum of the sides of the boxes.
    pub fn sides(&self) -> f64 {
        let pairs = self.min.iter().flatten().zip(self.max.iter().flatten());
        pairs
            .map(|(min, max)| f64::from((max - min).max(0.0)))
            .sum()
    }

    /// Squares of the distances of the boxes from a box; infinite of those that do not exist.
    #[inline(always)]
    pub fn squares(&self, from: &Around) -> [f32; WIDTH] {
        let mut squares = [0.0; WIDTH];
        for i in 0..3 {
            for (at, square) in squares.iter_mut().enumerate() {
                let (before, after) =
                    (self.min[i][at] - from.max[i], from.min[i] - self.max[i][at]);
                let out = larger(0.0, larger(before, after));
                *square += out * out;
            }
        }
        squares
    }

    /// Squares of the distances of points from one of the boxes.
    #[inline(always)]
    pub fn squares_of(&self, at: usize, points: &[[f32; WIDTH]; 3]) -> [f32; WIDTH] {
        let mut squares = [0.0; WIDTH];
        for (i, x) in points.iter().enumerate() {
            let (min, max) = (self.min[i][at], self.max[i][at]);
            for (x, square) in x.iter().zip(&mut squares) {
                let out = larger(0.0, larger(min - x, x - max));
                *square += out * out;
            }
        }
        squares
    }
}

/// The entries not above a limit with their places, smaller ones first, into `near`; how many they are.
#[inline(always)]
pub(super) fn sorted(squares: &[f32; WIDTH], limit: f32, near: &mut [(f32, u32); WIDTH]) -> usize {
    let mut bits = [0_u32; WIDTH];
    for (place, (bit, square)) in bits.iter_mut().zip(squares).enumerate() {
        *bit = if *square <= limit { 1 << place } else { 0 };
    }
    let mut left: u32 = bits.iter().sum();
    let mut found = 0;
    while left != 0 {
        let place = left.trailing_zeros();
        left &= left - 1;
        let square = squares[place as usize % WIDTH];
        let mut at = found;
        while at > 0 && near[at - 1].0 > square {
            near[at] = near[at - 1];
            at -= 1;
        }
        near[at] = (square, place);
        found += 1;
    }
    found
}

/// The place, or the box, from which distances are asked.
pub(super) struct Around {
    min: [f32; 3],
    max: [f32; 3],
    /// What its coordinates and those of a tree may have lost, m.
    lost: f64,
}

impl Around {
    /// Around a box, in a tree whose coordinates are at most `reach` (m) from its origin.
    pub fn new(bounds: &Bounds, origin: &[f64; 3], reach: f64) -> Around {
        let local = |x: &[f64; 3]| [0, 1, 2].map(|i| (x[i] - origin[i]) as f32);
        let (min, max) = (local(&bounds.min), local(&bounds.max));
        let coordinates = || min.iter().chain(&max);
        // of a place that is none the distances are none either
        let own = match coordinates().all(|x| x.is_finite()) {
            true => coordinates().fold(0.0, |most: f32, x| most.max(x.abs())),
            false => f32::NAN,
        };
        Around {
            min,
            max,
            lost: ROUNDING * (f64::from(own) + reach),
        }
    }

    /// Square of a distance (m) from which on boxes are surely farther than it; below zero from a place with coordinates that are not finite.
    pub fn limit(&self, distance: f64) -> f32 {
        let square = (distance + self.lost).powi(2) * (1.0 + ROUNDING);
        if self.lost.is_nan() {
            return -1.0;
        }
        // boxes that do not exist are at infinity, which no limit reaches
        (square as f32).next_up().min(f32::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn nothing_is_near_a_place_that_is_none() {
        let wide = Wide::EMPTY;
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for place in [[x, 0.0, 0.0], [x; 3], [0.0, x, 1.0]] {
                let bounds = Bounds {
                    min: place,
                    max: place,
                };
                let around = Around::new(&bounds, &[0.0; 3], 1.0);
                let limit = around.limit(f64::INFINITY);
                assert!(
                    wide.squares(&around)
                        .iter()
                        .all(|square| square.is_nan() || *square > limit)
                );
            }
        }
    }

    #[test]
    fn a_box_is_never_told_to_be_farther_than_it_is() {
        let mut random = Random::new(11);
        for size in [1e-6, 1.0, 1e6] {
            for _ in 0..1000 {
                let point = |random: &mut Random| random.point(size);
                let bounds = Bounds::of(&[point(&mut random), point(&mut random)]);
                let (place, origin) = (point(&mut random), point(&mut random));
                let mut wide = Wide::EMPTY;
                wide.set(3, &bounds, &origin);
                let from = Bounds::of(&[place]);
                let around = Around::new(&from, &origin, 2.0 * size);
                let distance = bounds.distance_squared(&place).sqrt();
                let squares = wide.squares(&around);
                assert!(squares[3] <= around.limit(distance));
                // and hardly nearer
                let near = distance - 1e-5 * size;
                assert!(near < 0.0 || squares[3] > around.limit(near));
                assert!(squares[4] > around.limit(f64::INFINITY));
            }
        }
    }
}
