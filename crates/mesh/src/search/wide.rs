//! Eight boxes at once, in single precision, a little larger than the boxes that they stand for.

use crate::Bounds;

/// Boxes side by side.
pub(super) const WIDTH: usize = 8;

/// Relative rounding of coordinates in single precision, with a margin for the few operations of a test.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// Boxes relative to a place; those that do not exist are empty.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wide {
    min: [[f32; WIDTH]; 3],
    max: [[f32; WIDTH]; 3],
}

impl Wide {
    pub const EMPTY: Wide = Wide {
        min: [[f32::INFINITY; WIDTH]; 3],
        max: [[f32::NEG_INFINITY; WIDTH]; 3],
    };

    /// Takes a box, rounded outwards.
    pub fn set(&mut self, at: usize, bounds: &Bounds, origin: &[f64; 3]) {
        for i in 0..3 {
            self.min[i][at] = ((bounds.min[i] - origin[i]) as f32).next_down();
            self.max[i][at] = ((bounds.max[i] - origin[i]) as f32).next_up();
        }
    }

    /// Takes the box around the boxes of another.
    pub fn set_around(&mut self, at: usize, other: &Wide) {
        for i in 0..3 {
            let (min, max) = (other.min[i].iter(), other.max[i].iter());
            self.min[i][at] = min.fold(f32::INFINITY, |least, x| least.min(*x));
            self.max[i][at] = max.fold(f32::NEG_INFINITY, |most, x| most.max(*x));
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
    #[inline]
    pub fn squares(&self, from: &Around) -> [f32; WIDTH] {
        let mut squares = [0.0; WIDTH];
        for i in 0..3 {
            for (at, square) in squares.iter_mut().enumerate() {
                let out = (self.min[i][at] - from.max[i]).max(from.min[i] - self.max[i][at]);
                let out = out.max(0.0);
                *square += out * out;
            }
        }
        squares
    }
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
        let coordinates = min.iter().chain(&max);
        let own = coordinates.fold(0.0, |most: f32, x| most.max(x.abs()));
        Around {
            min,
            max,
            lost: ROUNDING * (f64::from(own) + reach),
        }
    }

    /// Square of a distance (m) from which on boxes are surely farther than it.
    pub fn limit(&self, distance: f64) -> f32 {
        let square = (distance + self.lost).powi(2) * (1.0 + ROUNDING);
        // boxes that do not exist are at infinity, which no limit reaches
        (square as f32).next_up().min(f32::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

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
