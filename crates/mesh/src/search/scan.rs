//! One look for points that are near each other: whether anything but what each has found is within its distance.

use super::wide::{Around, WIDTH, Wide};
use crate::bounds::larger;

/// Nodes that a look for neighbours may take: eight points in a row over eight faces take some fifteen.
const LOOKS: usize = 40;

/// A look for points side by side.
pub(super) struct Scan<'a> {
    from: &'a Around,
    /// Square of the farthest distance, m².
    farthest: f32,
    /// Coordinates of the points from the origin of the tree, m.
    points: [[f32; WIDTH]; 3],
    /// Squares of their distances, m².
    limits: [f32; WIDTH],
    looks: usize,
    /// Whether others than its own item are within the distance of each.
    pub others: [bool; WIDTH],
}

impl<'a> Scan<'a> {
    /// `from`: around all points, in a tree with this origin.
    pub fn new(
        (from, origin): (&'a Around, &[f64; 3]),
        points: &[[f64; 3]; WIDTH],
        distances: &[f64; WIDTH],
    ) -> Scan<'a> {
        let mut local = [[0.0; WIDTH]; 3];
        for (i, local) in local.iter_mut().enumerate() {
            for (x, point) in local.iter_mut().zip(points) {
                *x = (point[i] - origin[i]) as f32;
            }
        }
        let limits = distances.map(|distance| from.limit(distance));
        Scan {
            from,
            farthest: limits.into_iter().fold(f32::NEG_INFINITY, larger),
            points: local,
            limits,
            looks: 0,
            others: [false; WIDTH],
        }
    }

    /// Looks at the items below a node; whether few enough nodes were asked.
    pub fn goes_through(
        &mut self,
        (levels, items): (&[Vec<Wide>], &[u32]),
        (level, node): (usize, u32),
        own: &[u32; WIDTH],
    ) -> bool {
        self.looks += 1;
        if self.looks > LOOKS {
            return false;
        }
        let boxes = &levels[level][node as usize];
        let (squares, farthest) = (boxes.squares(self.from), self.farthest);
        for (at, _) in (0..).zip(squares).filter(|(_, square)| *square <= farthest) {
            let place = node * WIDTH as u32 + at;
            if level > 0 {
                if !self.goes_through((levels, items), (level - 1, place), own) {
                    return false;
                }
                continue;
            }
            let (item, squares) = (
                items[place as usize],
                boxes.squares_of(at as usize, &self.points),
            );
            for k in 0..WIDTH {
                self.others[k] |= (squares[k] <= self.limits[k]) & (item != own[k]);
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use crate::random::Random;
    use crate::search::wide::WIDTH;
    use crate::{Bounds, BoxTree};

    /// What is within a distance is always told, and what is farther than that by more than single precision is not.
    #[test]
    fn others_are_those_whose_boxes_are_within_the_distance() {
        let mut random = Random::new(12);
        let boxes: Vec<Bounds> = (0..900)
            .map(|i| [f64::from(i % 30), f64::from(i / 30), 0.1 * random.unit()])
            .map(|x| Bounds::of(&[x, [x[0] + 0.9, x[1] + 0.9, 0.2]]))
            .collect();
        let tree = BoxTree::new(&boxes);
        let mut alone = 0;
        for spread in [0.5, 3.0, 30.0] {
            for _ in 0..200 {
                let middle = random.point(15.0);
                let mut points = [[0.0; 3]; WIDTH];
                for x in &mut points {
                    let off = random.point(spread);
                    *x = [15.0 + middle[0] + off[0], 15.0 + middle[1] + off[1], 0.3];
                }
                let distances = [0; WIDTH].map(|_| 0.6 * random.unit());
                let own = points
                    .map(|x| 30 * (x[1].clamp(0.0, 29.0) as u32) + x[0].clamp(0.0, 29.0) as u32);
                let told = tree.others(&points, &distances, &own);
                let within = |k: usize, distance: f64| {
                    let others = (0..900).filter(|&item| item != own[k]);
                    let mut boxes = others.map(|item| &boxes[item as usize]);
                    boxes.any(|b| b.distance_squared(&points[k]) <= distance * distance)
                };
                for k in 0..WIDTH {
                    assert!(told[k] || !within(k, distances[k]));
                    // one look serves points that are together
                    let together = spread == 0.5;
                    assert!(!told[k] || !together || within(k, distances[k] + 1e-4));
                    alone += usize::from(!told[k]);
                }
            }
        }
        assert!(alone > 500, "{alone}");
    }
}
