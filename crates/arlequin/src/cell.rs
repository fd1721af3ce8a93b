//! One cell of a mesh as a body in space: inverse map, gradients, convex parts.

use carom_elements::{Kind, MAX_NODES, map};
use carom_mesh::{Bounds, ElementId, Mesh, gather};

use crate::polytope::{Plane, Polytope, cross, dot, sub};
use crate::rule::Rule;

/// Slack of point location, in reference units: above round-off, below any sensible distance.
const SLACK: f64 = 1e-9;

/// A cell with its node positions.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub kind: Kind,
    x: [[f64; 3]; MAX_NODES],
    /// Diagonal of its bounding box.
    pub size: f64,
    /// Image of the reference origin and inverse Jacobian, if the map is affine.
    affine: Option<([f64; 3], [[f64; 3]; 3])>,
}

/// A convex part of a cell.
#[derive(Clone, Debug)]
pub(crate) struct Convex {
    pub shape: Polytope,
    /// Its faces, normals outward.
    pub planes: Vec<Plane>,
}

impl Cell {
    pub fn new(mesh: &Mesh, id: ElementId) -> Cell {
        let kind = mesh.kind(id);
        let mut buffer = [[0.0; 3]; MAX_NODES];
        gather(&mesh.nodes, mesh.element_nodes(id), &mut buffer);
        let mut cell = Cell {
            kind,
            x: buffer,
            size: 0.0,
            affine: None,
        };
        let bounds = cell.bounds();
        cell.size = norm(&sub(&bounds.max, &bounds.min));
        cell.affine = cell.affine_map();
        cell
    }

    /// The cell with the same corners and straight edges.
    pub fn straight(&self) -> Cell {
        let mut cell = Cell {
            kind: self.kind.table().linear,
            ..self.clone()
        };
        cell.affine = cell.affine_map();
        cell
    }

    /// Node positions.
    pub fn x(&self) -> &[[f64; 3]] {
        &self.x[..self.kind.table().nodes]
    }

    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.x())
    }

    /// Whether shape functions are polynomials of the position.
    pub fn is_affine(&self) -> bool {
        self.affine.is_some()
    }

    /// Total degree of the shape functions in the position, if the map is affine.
    pub fn degree(&self) -> usize {
        self.kind.table().degree
    }

    fn affine_map(&self) -> Option<([f64; 3], [[f64; 3]; 3])> {
        let table = self.kind.table();
        let (origin, (j, det)) = (self.point(&[0.0; 3]), self.signed_jacobian(&[0.0; 3]));
        let largest = self
            .x()
            .iter()
            .flatten()
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        let tolerance = 1e-13 * self.size + 1e-15 * largest;
        let fits = table.reference.iter().zip(self.x()).all(|(xi, x)| {
            let image = |i: usize| origin[i] + (0..table.dim).map(|k| j[i][k] * xi[k]).sum::<f64>();
            (0..table.dim).all(|i| (image(i) - x[i]).abs() <= tolerance)
        });
        fits.then(|| (origin, inverse(&j, det)))
    }

    /// The kind with the same corners and no other nodes.
    pub fn corners(&self) -> Kind {
        self.kind.table().linear
    }

    /// Whether two quadrilaterals or hexahedra are parallelograms or parallelepipeds with the same axes, up to their
    /// order and sense: shape functions of one are then linear in each reference coordinate of the other.
    pub fn is_aligned(&self, other: &Cell) -> bool {
        let Some((_, inverse)) = &other.affine else {
            return false;
        };
        let cube = |cell: &Cell| matches!(cell.corners(), Kind::Quad4 | Kind::Hex8);
        if !self.is_affine() || !cube(self) || !cube(other) {
            return false;
        }
        let (j, _) = self.jacobian(&[0.0; 3]);
        inverse.iter().all(|row| {
            let to = [0, 1, 2].map(|k| (0..3).map(|i| row[i] * j[i][k]).sum::<f64>().abs());
            let largest = to.iter().fold(0.0, |m: f64, &t| m.max(t));
            to.iter().filter(|&&t| t > 1e-13 * largest).count() == 1
        })
    }

    /// x(ξ).
    pub fn point(&self, xi: &[f64; 3]) -> [f64; 3] {
        let mut n = [0.0; MAX_NODES];
        map::point(self.x(), self.shape(xi, &mut n))
    }

    /// Shape functions at ξ.
    pub fn shape<'a>(&self, xi: &[f64; 3], n: &'a mut [f64; MAX_NODES]) -> &'a [f64] {
        let table = self.kind.table();
        (table.shape)(xi, &mut n[..table.nodes]);
        &n[..table.nodes]
    }

    /// Gradients dN/dx at ξ, in 1/length.
    pub fn gradients<'a>(
        &self,
        xi: &[f64; 3],
        out: &'a mut [[f64; 3]; MAX_NODES],
    ) -> &'a [[f64; 3]] {
        let table = self.kind.table();
        let mut dn = [[0.0; 3]; MAX_NODES];
        (table.gradient)(xi, &mut dn[..table.nodes]);
        let (j, det) = map::jacobian(self.x(), &dn[..table.nodes], table.dim);
        map::physical_gradient(&j, det, &dn[..table.nodes], &mut out[..table.nodes]);
        &out[..table.nodes]
    }

    /// Jacobian at ξ and its determinant, of a bar without the sign: it may run against the axis, and lengths count, not orientation.
    pub fn jacobian(&self, xi: &[f64; 3]) -> ([[f64; 3]; 3], f64) {
        let (j, det) = self.signed_jacobian(xi);
        let is_bar = self.kind.table().dim == 1;
        (j, if is_bar { det.abs() } else { det })
    }

    /// Jacobian at ξ and its determinant, of which the inverse is made.
    fn signed_jacobian(&self, xi: &[f64; 3]) -> ([[f64; 3]; 3], f64) {
        let table = self.kind.table();
        let mut dn = [[0.0; 3]; MAX_NODES];
        (table.gradient)(xi, &mut dn[..table.nodes]);
        map::jacobian(self.x(), &dn[..table.nodes], table.dim)
    }

    /// Reference coordinates of a position: exact for an affine map, else by Newton's method from the centre.
    /// `None` where Newton's method does not converge.
    pub fn reference(&self, x: &[f64; 3]) -> Option<[f64; 3]> {
        if let Some((origin, inverse)) = &self.affine {
            return Some(multiply(inverse, &sub(x, origin)));
        }
        let mut xi = [0.0; 3];
        for _ in 0..50 {
            let (j, det) = self.signed_jacobian(&xi);
            let step = multiply(&inverse(&j, det), &sub(x, &self.point(&xi)));
            (0..3).for_each(|i| xi[i] += step[i]);
            if !xi.iter().all(|t| t.abs() < 1e3) {
                return None;
            }
            if step.iter().all(|t| t.abs() < 1e-14) {
                return Some(xi);
            }
        }
        // Round-off of positions far from the origin can exceed the last bits of ξ: the point itself decides.
        let miss = norm(&sub(x, &self.point(&xi)));
        let far = x.iter().fold(0.0, |far: f64, x| far.max(x.abs()));
        (miss <= (1e-11 * self.size).max(4.0 * f64::EPSILON * far)).then_some(xi)
    }

    /// Whether a position lies in the cell, its boundary included.
    pub fn contains(&self, x: &[f64; 3]) -> bool {
        let inside = self.kind.table().contains;
        self.reference(x).is_some_and(|xi| inside(&xi, SLACK))
    }

    /// Quadrature points ξ and weights (with the Jacobian) of a rule on the cell's own reference cell.
    pub fn points<'a>(&'a self, rule: &'a Rule) -> impl Iterator<Item = ([f64; 3], f64)> + 'a {
        let points = rule.points.iter().zip(&rule.weights);
        points.map(|(xi, w)| (*xi, w * self.jacobian(xi).1))
    }

    /// Length, area or volume.
    pub fn measure(&self) -> f64 {
        let rule = self.kind.table().mass_rule;
        let points = rule.points.iter().zip(rule.weights);
        points.map(|(xi, w)| w * self.jacobian(xi).1).sum()
    }

    /// Edge length of the regular cell (cube, or corner of a cube) of the same measure.
    pub fn length(&self) -> f64 {
        let dim = self.kind.table().dim;
        let corner = match self.corners() {
            Kind::Tri3 | Kind::Wedge6 => 2.0,
            Kind::Tet4 => 6.0,
            _ => 1.0,
        };
        (corner * self.measure()).powf(1.0 / dim as f64)
    }

    /// Extent along a unit direction.
    pub fn extent(&self, direction: &[f64; 3]) -> f64 {
        let along = self.x().iter().map(|x| dot(x, direction));
        along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
    }

    /// The cell with straight edges as convex parts: itself; a hexahedron with warped faces, or not convex, as the 24 tetrahedra that
    /// join its centre with the four triangles around the middle of each face (which neighbours share).
    pub fn parts(&self) -> Vec<Convex> {
        match self.kind.table().dim {
            1 => vec![self.segment()],
            2 => vec![self.straight().polygon()],
            _ => {
                let cell = self.straight();
                let whole = cell.polyhedron();
                whole.map_or_else(|| cell.tetrahedra(), |part| vec![part])
            }
        }
    }

    fn segment(&self) -> Convex {
        let (a, b) = (
            self.x[0][0].min(self.x[1][0]),
            self.x[0][0].max(self.x[1][0]),
        );
        let plane = |sign: f64, x: f64| Plane {
            normal: [sign, 0.0, 0.0],
            offset: sign * x,
        };
        Convex {
            shape: Polytope::Segment([a, b]),
            planes: vec![plane(-1.0, a), plane(1.0, b)],
        }
    }

    fn polygon(&self) -> Convex {
        let x = self.x();
        let edges = (0..x.len()).map(|i| (x[i], x[(i + 1) % x.len()]));
        let plane = |(a, b): ([f64; 3], [f64; 3])| Plane::new(&a, &[b[1] - a[1], a[0] - b[0], 0.0]);
        Convex {
            planes: edges.map(plane).collect(),
            shape: Polytope::Polygon(x.to_vec()),
        }
    }

    /// The cell as one polyhedron, if its faces are plane and it is convex.
    fn polyhedron(&self) -> Option<Convex> {
        let faces: Vec<Vec<[f64; 3]>> = self
            .kind
            .table()
            .faces
            .iter()
            .map(|face| face.nodes.iter().map(|&a| self.x[a]).collect())
            .collect();
        let planes: Vec<Plane> = faces.iter().map(|face| Plane::of_face(face)).collect();
        let tolerance = 1e-12 * self.size;
        let plane_faces = faces
            .iter()
            .zip(&planes)
            .all(|(face, plane)| face.iter().all(|x| plane.distance(x).abs() <= tolerance));
        let convex = planes
            .iter()
            .all(|plane| self.x().iter().all(|x| plane.distance(x) <= tolerance));
        (plane_faces && convex).then_some(Convex {
            shape: Polytope::Polyhedron(faces),
            planes,
        })
    }

    fn tetrahedra(&self) -> Vec<Convex> {
        let centre = Polytope::mean(self.x());
        let mut parts = Vec::new();
        for face in self.kind.table().faces {
            let corners: Vec<[f64; 3]> = face.nodes.iter().map(|&a| self.x[a]).collect();
            let middle = Polytope::mean(&corners);
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                parts.push(tetrahedron(&[centre, middle, a, b]));
            }
        }
        parts
    }
}

fn tetrahedron(x: &[[f64; 3]; 4]) -> Convex {
    let faces = Kind::Tet4.table().faces.iter();
    let faces: Vec<Vec<[f64; 3]>> = faces
        .map(|face| face.nodes.iter().map(|&a| x[a]).collect())
        .collect();
    Convex {
        planes: faces.iter().map(|face| Plane::of_face(face)).collect(),
        shape: Polytope::Polyhedron(faces),
    }
}

/// Inverse of a matrix with a known determinant.
fn inverse(j: &[[f64; 3]; 3], det: f64) -> [[f64; 3]; 3] {
    let cofactor = [
        cross(&j[1], &j[2]),
        cross(&j[2], &j[0]),
        cross(&j[0], &j[1]),
    ];
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| cofactor[k][i] / det))
}

fn multiply(a: &[[f64; 3]; 3], x: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| dot(&a[i], x))
}

pub(crate) fn norm(a: &[f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_mesh::generate;

    /// A cube of side 2 with one corner moved: three faces are warped.
    fn warped() -> Cell {
        let mut mesh = generate::box_("a", [-1.0; 3], [2.0; 3], [1; 3], false);
        mesh.nodes[7] = [1.2, 1.3, 0.9];
        Cell::new(&mesh, mesh.groups["a"].elements[0])
    }

    #[test]
    fn the_parts_of_a_warped_hexahedron_have_its_volume_each_positive() {
        let cell = warped();
        let volumes: Vec<f64> = cell.parts().iter().map(|p| p.shape.measure()).collect();
        assert_eq!(volumes.len(), 24);
        assert!(volumes.iter().all(|&v| v > 0.0));
        // Four triangles around the middle of a bilinear face hold the volume below it.
        assert!((volumes.iter().sum::<f64>() - cell.measure()).abs() < 1e-14);
    }

    #[test]
    fn the_inverse_map_of_a_bar_does_not_depend_on_its_sense() {
        let mut mesh = generate::line("a", [0.0; 3], [2.0, 0.0, 0.0], 1, 1);
        for [first, last] in [[0.0, 2.0], [2.0, 0.0]] {
            (mesh.nodes[0][0], mesh.nodes[1][0]) = (first, last);
            let cell = Cell::new(&mesh, mesh.groups["a"].elements[0]);
            assert_eq!(cell.measure(), 2.0);
            let xi = [0.25, 0.0, 0.0];
            assert_eq!(cell.reference(&cell.point(&xi)), Some(xi));
        }
    }

    #[test]
    fn the_inverse_map_finds_reference_points_inside_and_just_outside() {
        let cell = warped();
        assert!(!cell.is_affine());
        for xi in [[0.3, -0.8, 0.5], [1.0, 1.0, 1.0], [1.05, -1.02, 0.4]] {
            let found = cell.reference(&cell.point(&xi)).unwrap();
            assert!((0..3).all(|i| (found[i] - xi[i]).abs() < 1e-13));
        }
        assert!(cell.contains(&[0.0, 0.0, 0.9]));
        assert!(!cell.contains(&[0.0, 0.0, 1.3]));
    }
}
