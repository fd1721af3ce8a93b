//! Convex polygons in a plane: what two of them have in common.

/// Room for the corners: two quadrilaterals have at most eight in common, twelve if one of them is not convex.
const CORNERS: usize = 16;

/// A polygon, counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub struct Polygon {
    corners: [[f64; 2]; CORNERS],
    n: usize,
}

impl Polygon {
    /// The polygon of these corners, in the first two coordinates.
    pub fn new(x: &[[f64; 3]]) -> Polygon {
        let mut polygon = Polygon {
            corners: [[0.0; 2]; CORNERS],
            n: 0,
        };
        x.iter().for_each(|x| polygon.push([x[0], x[1]]));
        polygon
    }

    fn push(&mut self, corner: [f64; 2]) {
        if self.n < CORNERS {
            self.corners[self.n] = corner;
            self.n += 1;
        }
    }

    fn corners(&self) -> &[[f64; 2]] {
        &self.corners[..self.n]
    }

    /// The same polygon run through the other way.
    pub fn reversed(mut self) -> Polygon {
        self.corners[..self.n].reverse();
        self
    }

    /// Area, positive counter-clockwise.
    pub fn area(&self) -> f64 {
        let mut sum = 0.0;
        self.triangles(|_, area| sum += area);
        sum
    }

    /// What this polygon has in common with a convex one. Sutherland and Hodgman (1974).
    pub fn clipped(&self, convex: &Polygon) -> Polygon {
        let mut rest = *self;
        for (k, &a) in convex.corners().iter().enumerate() {
            let b = convex.corners()[(k + 1) % convex.n];
            rest = rest.left_of(a, b);
        }
        rest
    }

    /// What lies to the left of the line from a to b, the line included.
    fn left_of(&self, a: [f64; 2], b: [f64; 2]) -> Polygon {
        let mut rest = Polygon { n: 0, ..*self };
        for (k, &from) in self.corners().iter().enumerate() {
            let to = self.corners()[(k + 1) % self.n];
            let (before, after) = (twice_area(a, b, from), twice_area(a, b, to));
            if before >= 0.0 {
                rest.push(from);
            }
            if before.min(after) < 0.0 && before.max(after) > 0.0 {
                let t = before / (before - after);
                rest.push([0, 1].map(|i| from[i] + t * (to[i] - from[i])));
            }
        }
        rest
    }

    /// The triangles from the first corner, and their areas.
    pub fn triangles(&self, mut each: impl FnMut([[f64; 2]; 3], f64)) {
        for k in 2..self.n {
            let corners = [self.corners[0], self.corners[k - 1], self.corners[k]];
            each(
                corners,
                0.5 * twice_area(corners[0], corners[1], corners[2]),
            );
        }
    }
}

/// Twice the area of a triangle, positive counter-clockwise.
fn twice_area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[[f64; 2]]) -> Polygon {
        let x: Vec<[f64; 3]> = corners.iter().map(|c| [c[0], c[1], 0.0]).collect();
        Polygon::new(&x)
    }

    #[test]
    fn two_squares_turned_by_45_degrees_share_an_octagon() {
        let square = polygon(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]);
        let r = 2.0_f64.sqrt();
        let turned = polygon(&[[r, 0.0], [0.0, r], [-r, 0.0], [0.0, -r]]);
        let common = square.clipped(&turned);
        // a regular octagon of inradius 1 has area 8 tan(22.5°)
        let expected = 8.0 * (std::f64::consts::PI / 8.0).tan();
        assert_eq!(common.n, 8);
        assert!((common.area() - expected).abs() < 1e-14);
        assert!((turned.clipped(&square).area() - expected).abs() < 1e-14);
    }

    #[test]
    fn a_polygon_inside_is_kept_and_one_outside_is_gone() {
        let square = polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        let inside = polygon(&[[1.0, 1.0], [2.0, 1.0], [1.0, 3.0]]);
        assert_eq!(inside.clipped(&square).area(), 1.0);
        assert_eq!(square.clipped(&inside).area(), 1.0);
        let outside = polygon(&[[5.0, 0.0], [6.0, 0.0], [6.0, 1.0]]);
        assert_eq!(outside.clipped(&square).n, 0);
        // the same square, and one that shares an edge
        assert_eq!(square.clipped(&square).area(), 16.0);
        let beside = polygon(&[[4.0, 0.0], [5.0, 0.0], [5.0, 4.0], [4.0, 4.0]]);
        assert_eq!(beside.clipped(&square).area(), 0.0);
    }
}
