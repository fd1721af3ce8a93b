//! Faces of a secondary surface and the shape functions of the multipliers on them.

use carom_elements::{Element, Kind, MAX_FACE_NODES, map};
use carom_mesh::Face;
use serde::{Deserialize, Serialize};

use crate::Point;

/// The largest number of multipliers of a face: that of its corners.
pub(crate) const CORNERS: usize = 4;

/// Shape functions of the multipliers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// The linear shape functions of the corners of the faces.
    Standard,
    /// Their biorthogonal functions, `∫ ψ_A φ_B = δ_AB ∫ φ_B` on each face: weak gaps of neighbours then share no
    /// secondary node of linear faces. On a face partly opposite to nothing the integrals are those over the rest
    /// (Cichosz and Bischoff 2011); where that rest is too thin to tell the functions apart they are the standard ones.
    Dual,
}

/// Faces of a secondary surface with the numbers of their multipliers.
///
/// Multipliers sit at the corners of the faces, and their functions are linear between them: midside nodes of quadratic
/// faces have none, because the integrals of their corners' own shape functions vanish or are negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Mortar {
    pub(crate) faces: Vec<Face>,
    /// For each face the points of its corners.
    pub(crate) multipliers: Vec<[u32; CORNERS]>,
    /// For each face the factor of its measure at its nodes.
    factors: Vec<[f64; MAX_FACE_NODES]>,
}

impl Mortar {
    /// The multipliers of a surface and their points: the corners of the faces, sorted, with the areas `∫ φ_A dΓ` of the
    /// whole surface. The ends of bars have one multiplier each.
    ///
    /// `x`: reference coordinates by system number, m. `factor`: area in m² that a unit of the measure of the faces
    /// stands for at a place, as in [`Point::of_faces`]; between nodes it is interpolated.
    pub fn new(
        faces: Vec<Face>,
        x: &[[f64; 3]],
        factor: impl Fn(&[f64; 3]) -> f64,
    ) -> (Mortar, Vec<Point>) {
        let corners = |face: &Face| linear(face.kind.table()).nodes;
        let mut nodes: Vec<u32> = faces
            .iter()
            .flat_map(|face| face.corners()[..corners(face)].to_vec())
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        let multipliers = faces.iter().map(|face| {
            let mut numbers = [u32::MAX; CORNERS];
            for (number, node) in numbers.iter_mut().zip(&face.corners()[..corners(face)]) {
                *number = nodes.partition_point(|other| other < node) as u32;
            }
            numbers
        });
        let factors = faces.iter().map(|face| {
            let mut factors = [0.0; MAX_FACE_NODES];
            for (to, &node) in factors.iter_mut().zip(face.corners()) {
                *to = factor(&x[node as usize]);
            }
            factors
        });
        let mortar = Mortar {
            multipliers: multipliers.collect(),
            factors: factors.collect(),
            faces,
        };
        let points = mortar.points(x, &nodes);
        (mortar, points)
    }

    /// The same with the faces in other numbers of nodes.
    pub(crate) fn with_faces(&self, faces: Vec<Face>) -> Mortar {
        Mortar {
            faces,
            ..self.clone()
        }
    }

    fn points(&self, x: &[[f64; 3]], nodes: &[u32]) -> Vec<Point> {
        let (mut areas, mut radii) = (vec![0.0; nodes.len()], vec![0.0_f64; nodes.len()]);
        for index in 0..self.faces.len() {
            let face = &self.faces[index];
            let rule = face.kind.table().mass_rule;
            for &number in &self.multipliers[index] {
                if let Some(most) = radii.get_mut(number as usize) {
                    *most = most.max(face.radius.unwrap_or(0.0));
                }
            }
            for (xi, weight) in rule.points.iter().zip(rule.weights) {
                let weight = weight * self.measure(index, xi, x);
                for (&number, phi) in self.multipliers[index].iter().zip(self.phi(index, xi)) {
                    if number != u32::MAX {
                        areas[number as usize] += weight * phi;
                    }
                }
            }
        }
        let total: f64 = areas.iter().sum();
        let points = nodes.iter().zip(areas).zip(radii);
        points
            .map(|((&node, area), radius)| Point::at_node(node, area, area / total).around(radius))
            .collect()
    }

    /// Whether the surface is made of ends of bars: there is nothing to integrate over.
    pub(crate) fn is_ends(&self) -> bool {
        self.faces.iter().all(|face| face.kind.table().dim == 0)
    }

    /// Area per unit of the reference cell, from the reference coordinates.
    pub(crate) fn measure(&self, index: usize, xi: &[f64; 3], x: &[[f64; 3]]) -> f64 {
        let table = self.faces[index].kind.table();
        let mut shape = [0.0; MAX_FACE_NODES];
        (table.shape)(xi, &mut shape[..table.nodes]);
        self.stretch(index, xi, x) * self.factor(index, &shape)
    }

    /// Factor of the measure where the shape functions of the nodes have these values.
    pub(crate) fn factor(&self, index: usize, shape: &[f64; MAX_FACE_NODES]) -> f64 {
        let nodes = self.faces[index].kind.table().nodes;
        let factors = self.factors[index].iter().zip(&shape[..nodes]);
        factors.map(|(factor, n)| factor * n).sum()
    }

    /// Measure of the face per unit of the reference cell, from the reference coordinates.
    pub(crate) fn stretch(&self, index: usize, xi: &[f64; 3], x: &[[f64; 3]]) -> f64 {
        let face = &self.faces[index];
        let (table, mut positions) = (face.kind.table(), [[0.0; 3]; MAX_FACE_NODES]);
        for (position, &node) in positions.iter_mut().zip(face.corners()) {
            *position = x[node as usize];
        }
        let mut gradients = [[0.0; 3]; MAX_FACE_NODES];
        let nodes = table.nodes;
        (table.gradient)(xi, &mut gradients[..nodes]);
        map::measure(&positions[..nodes], &gradients[..nodes], table.dim).0
    }

    /// Linear functions of the corners, zero beyond their number.
    pub(crate) fn phi(&self, index: usize, xi: &[f64; 3]) -> [f64; CORNERS] {
        let element = linear(self.faces[index].kind.table());
        let mut phi = [0.0; CORNERS];
        (element.shape)(xi, &mut phi[..element.nodes]);
        phi
    }
}

/// The element whose shape functions carry the multipliers of a face: that of its corners.
pub(crate) fn linear(element: &Element) -> &'static Element {
    let square = (element.contains)(&[0.9, 0.9, 0.0], 0.0);
    match (element.dim, square) {
        (0, _) => Kind::Point1.table(),
        (1, _) => Kind::Bar2.table(),
        (_, true) => Kind::Quad4.table(),
        (_, false) => Kind::Tri3.table(),
    }
}
