//! What of a face lies under another one: the pieces that mortar integration works on, and their quadrature points.
//!
//! A face is cut into linear cells (itself, or the cells between its nodes where it is quadratic); two cells are laid
//! into the plane of the secondary one, along its normal, and what they have in common is a segment or a convex polygon.
//! The cells only bound the pieces: shape functions, places and measures in the points are those of the faces. Cutting
//! into linear cells: Puso, Laursen and Solberg (2008); written from the idea, the text was not at hand.

use carom_algebra::tensor::Vec3;
use carom_elements::{Element, Kind, map};

use super::clip::Polygon;

/// The largest number of corners of a cell.
const CORNERS: usize = 4;

/// Cosines of the angles of 30 and 60 degrees between a normal and the opposite of the other one: what is steeper than
/// the second casts no shadow, and between them the weight of a shadow falls to nothing.
const FACING: [f64; 2] = [0.866_025_403_784_438_6, 0.5];

/// Pieces smaller than this part of the cell are rounding.
const SLIVER: f64 = 1e-12;

/// Abscissa √(3/5) of the three-point Gauss rule.
const SIDE: f64 = 0.774_596_669_241_483_4;
/// Three Gauss points on [-1, 1] and their weights, exact to degree 5.
const LINE: [(f64, f64); 3] = [(-SIDE, 5.0 / 9.0), (0.0, 8.0 / 9.0), (SIDE, 5.0 / 9.0)];

const ROOT_15: f64 = 3.872_983_346_207_417;
/// Radon's rule of degree 5 on the triangle: the distinct barycentric coordinate of each orbit of three points, the other
/// two being equal, and the weight of each point as a part of the area. The centroid has 9/40.
const RADON: [(f64, f64); 2] = [
    ((9.0 - 2.0 * ROOT_15) / 21.0, (155.0 + ROOT_15) / 1200.0),
    ((9.0 + 2.0 * ROOT_15) / 21.0, (155.0 - ROOT_15) / 1200.0),
];

/// A linear cell of a face.
pub struct Cell {
    element: &'static Element,
    /// Its corners in the reference cell of the face.
    xi: [[f64; 3]; CORNERS],
    /// Their positions, m.
    x: [[f64; 3]; CORNERS],
    /// Unit normal in the middle.
    normal: Vec3,
}

/// A quadrature point: where in the reference cell of the face, and what of its measure it stands for, less where the other
/// cell is steep.
pub struct Sample {
    pub xi: [f64; 3],
    pub weight: f64,
}

/// The nodes of the linear cells of a face.
fn parts(element: &Element) -> &'static [&'static [usize]] {
    match (element.dim, element.nodes) {
        (1, 2) => &[&[0, 1]],
        (1, _) => &[&[0, 2], &[2, 1]],
        (_, 3) => &[&[0, 1, 2]],
        (_, 4) => &[&[0, 1, 2, 3]],
        (_, 6) => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        (_, 8) => &[
            &[0, 4, 7],
            &[4, 1, 5],
            &[5, 2, 6],
            &[6, 3, 7],
            &[4, 5, 6, 7],
        ],
        _ => &[&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]],
    }
}

/// The linear cells of a face with nodes at `x`.
pub fn cells<'a>(element: &'static Element, x: &'a [[f64; 3]]) -> impl Iterator<Item = Cell> + 'a {
    parts(element).iter().map(move |nodes| {
        let kind = match (element.dim, nodes.len()) {
            (1, _) => Kind::Bar2,
            (_, 3) => Kind::Tri3,
            _ => Kind::Quad4,
        };
        let pick = |from: &[[f64; 3]]| {
            let mut to = [[0.0; 3]; CORNERS];
            for (to, &node) in to.iter_mut().zip(*nodes) {
                *to = from[node];
            }
            to
        };
        Cell::new(kind.table(), pick(element.reference), pick(x))
    })
}

impl Cell {
    fn new(element: &'static Element, xi: [[f64; 3]; CORNERS], x: [[f64; 3]; CORNERS]) -> Cell {
        let corners = element.nodes;
        let middle = map::point(
            element.reference,
            &[1.0 / corners as f64; CORNERS][..corners],
        );
        let mut gradients = [[0.0; 3]; CORNERS];
        (element.gradient)(&middle, &mut gradients[..corners]);
        let (_, normal) = map::measure(&x[..corners], &gradients[..corners], element.dim);
        Cell {
            element,
            xi,
            x,
            normal: normal.into(),
        }
    }

    /// Positions of the corners, m.
    pub fn corners(&self) -> &[[f64; 3]] {
        &self.x[..self.element.nodes]
    }

    /// Mean of the corners, m.
    pub fn middle(&self) -> [f64; 3] {
        let n = self.element.nodes;
        map::point(self.corners(), &[1.0 / n as f64; CORNERS][..n])
    }

    /// Unit normal in the middle.
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Quadrature points on what the shadow of another cell, cast along the normal of this one, covers of it.
    ///
    /// `low`: all shape functions involved are linear, and degree 2 is enough. Otherwise the rules are exact to degree 5
    /// on segments and triangles: for the products of shape functions on parallelograms. `side`: 1 where what faces the other cell is on the side of
    /// the normal, -1 on the other one. `round`: the other cell has a surface on both sides.
    pub fn shared(
        &self,
        other: &Cell,
        (side, round, low): (f64, bool, bool),
        mut each: impl FnMut(Sample),
    ) {
        let cosine = -side * self.normal.dot(&other.normal);
        let faces = facing(if round { cosine.abs() } else { cosine });
        if faces == 0.0 {
            return;
        }
        let plane = Plane::new(self);
        let (own, shadow) = (plane.flat(self), plane.flat(other));
        if self.element.dim == 1 {
            let ends = |x: &[[f64; 3]]| (x[0][0].min(x[1][0]), x[0][0].max(x[1][0]));
            let ((a, b), (c, d)) = (ends(&own), ends(&shadow));
            let (begin, end) = (a.max(c), b.min(d));
            if end - begin > SLIVER * (b - a) {
                for (t, w) in LINE {
                    let s = 0.5 * (begin + end) + 0.5 * (end - begin) * t;
                    each(self.on_line(&own, s, faces * 0.5 * (end - begin) * w));
                }
            }
            return;
        }
        let own_polygon = Polygon::new(&own[..self.element.nodes]);
        let shadow = Polygon::new(&shadow[..other.element.nodes]);
        let opposed = self.normal.dot(&other.normal) < 0.0;
        let shadow = if opposed { shadow.reversed() } else { shadow };
        let common = shadow.clipped(&own_polygon);
        let least = SLIVER * own_polygon.area();
        common.triangles(|corners, area| {
            if area > least {
                on_triangle(low, |weights, part| {
                    let s = [0, 1].map(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum());
                    each(self.sample(&own, s, faces * part * area));
                });
            }
        });
    }

    /// The quadrature point at a place of the line that stands for `length` of it.
    fn on_line(&self, own: &[[f64; 3]; CORNERS], s: f64, length: f64) -> Sample {
        let part = (s - own[0][0]) / (own[1][0] - own[0][0]);
        let [begin, end] = [self.xi[0][0], self.xi[1][0]];
        let stretch = (end - begin) / (own[1][0] - own[0][0]);
        Sample {
            xi: [begin + part * (end - begin), 0.0, 0.0],
            weight: length * stretch,
        }
    }

    /// The quadrature point at a place of the plane that stands for `area` of it.
    fn sample(&self, own: &[[f64; 3]; CORNERS], s: [f64; 2], area: f64) -> Sample {
        let n = self.element.nodes;
        let (mut shape, mut gradients) = ([0.0; CORNERS], [[0.0; 3]; CORNERS]);
        let mut eta = [0.0; 3];
        let mut stretch = 1.0;
        // Newton's method for the bilinear map of a convex cell, exact at once for a linear one.
        for _ in 0..20 {
            (self.element.shape)(&eta, &mut shape[..n]);
            (self.element.gradient)(&eta, &mut gradients[..n]);
            let at = map::point(&own[..n], &shape[..n]);
            let (j, det) = map::jacobian(&own[..n], &gradients[..n], 2);
            stretch = det;
            let r = [s[0] - at[0], s[1] - at[1]];
            let step = [
                (j[1][1] * r[0] - j[0][1] * r[1]) / det,
                (j[0][0] * r[1] - j[1][0] * r[0]) / det,
            ];
            eta = [eta[0] + step[0], eta[1] + step[1], 0.0];
            if step[0].abs() + step[1].abs() < 1e-14 {
                break;
            }
        }
        (self.element.shape)(&eta, &mut shape[..n]);
        let (_, reference) = map::jacobian(&self.xi[..n], &gradients[..n], 2);
        Sample {
            xi: map::point(&self.xi[..n], &shape[..n]),
            weight: area * reference / stretch,
        }
    }
}

/// Weight of a shadow by the cosine of the angle between one normal and the opposite of the other: a cubic with level ends.
///
/// A face that turns past the last angle so leaves the means without a jump. With a jump a corner whose steep side is near
/// that angle has no equilibrium: the forces with the face turn it out, those without it turn it in.
fn facing(cosine: f64) -> f64 {
    let [all, none] = FACING;
    let t = ((cosine - none) / (all - none)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The plane of a cell, or its line in the plane.
struct Plane {
    origin: Vec3,
    axes: [Vec3; 2],
}

impl Plane {
    fn new(cell: &Cell) -> Plane {
        let first = Vec3::from(cell.x[0]);
        let along = Vec3::from(cell.x[1]) - first;
        let along = (along - cell.normal * along.dot(&cell.normal)).normalize();
        Plane {
            origin: first,
            axes: [along, cell.normal.cross(&along)],
        }
    }

    /// Corners of a cell in the coordinates of the plane.
    fn flat(&self, cell: &Cell) -> [[f64; 3]; CORNERS] {
        cell.x.map(|x| {
            let r = Vec3::from(x) - self.origin;
            [r.dot(&self.axes[0]), r.dot(&self.axes[1]), 0.0]
        })
    }
}

/// Barycentric coordinates and weights (parts of the area) of a rule on the triangle, of degree 2 or 5.
fn on_triangle(low: bool, mut each: impl FnMut([f64; 3], f64)) {
    let mut orbit = |distinct: f64, weight: f64| {
        let rest = 0.5 * (1.0 - distinct);
        for k in 0..3 {
            let mut coordinates = [rest; 3];
            coordinates[k] = distinct;
            each(coordinates, weight);
        }
    };
    if low {
        return orbit(2.0 / 3.0, 1.0 / 3.0);
    }
    for (distinct, weight) in RADON {
        orbit(distinct, weight);
    }
    each([1.0 / 3.0; 3], 9.0 / 40.0);
}
