//! What shells tell of a displacement.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_materials::Elastic;

use super::Shell;
use super::element::Element;
use super::section::AtPoint;
use super::strain::Strains;
use crate::distortion::{Distortion, Extreme};

/// Forces and moments per length in the middle of an element, and stresses at its faces, as tensors over the axes of coordinates, per length and area of the
/// reference configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resultants {
    /// Membrane forces N, N/m.
    pub membrane: Mat3,
    /// Bending moments M, N: positive where the side to which the normal points is in tension.
    pub bending: Mat3,
    /// Shear forces q·n, N/m: the force along the normal on a section is q·ν, ν its outward normal.
    pub shear: [f64; 3],
    /// Stress in the plane of the shell at its faces, Pa, that to which the normal points first; of metals that flow at the outermost points.
    pub faces: [Mat3; 2],
    /// The largest equivalent stress of von Mises between the faces, Pa: where plies meet, and at the points of metals that flow; zero in a section of
    /// one elastic material, which has its largest stress at a face.
    pub between: f64,
}

impl Shell {
    /// Strains at the points of each element.
    fn each_strain(
        &self,
        frames: &[Rotation],
        u: &[f64],
        visit: &mut dyn FnMut(&Element, &Strains),
    ) {
        for element in &self.elements {
            let strains = match self.turns() {
                true => element.form.strains(&element.now(frames, u).configuration),
                false => element.small_strains(u),
            };
            visit(element, &strains);
        }
    }

    /// Forces and moments in the middle of each element. `frames`: of the nodes, with finite rotations.
    /// `history`: of this body there.
    pub fn resultants(&self, frames: &[Rotation], u: &[f64], history: &[f64]) -> Vec<Resultants> {
        let mut all: Vec<Resultants> = Vec::with_capacity(self.elements.len());
        self.each_strain(frames, u, &mut |element, strains| {
            let now = match self.turns() {
                true => element.now(frames, u).configuration,
                false => element.reference,
            };
            let mut mean = Resultants {
                membrane: Mat3::zeros(),
                bending: Mat3::zeros(),
                shear: [0.0; 3],
                faces: [Mat3::zeros(); 2],
                between: 0.0,
            };
            let mut between = vec![0.0; self.stations()];
            let form = &element.form;
            let whole: f64 = form.areas.iter().sum();
            for (point, area) in form.areas.iter().enumerate() {
                let strain = &strains[point];
                let (forces, faces) = match &self.layers {
                    None => {
                        let forces = element.sections[point].forces(strain);
                        let thickness = element.thickness[point];
                        for (sum, (material, height)) in between.iter_mut().zip(&self.borders) {
                            let stress = in_plane(material, strain, height * thickness);
                            *sum += von_mises(&stress) * form.areas[point] / whole;
                        }
                        (forces, self.at_faces(strain, thickness))
                    }
                    Some(layers) => {
                        let own = &history[self.history_of(all.len())];
                        let kept = layers.history_len();
                        let own = &own[kept * point..kept * (point + 1)];
                        let of = (strain, element.thickness[point]);
                        let forces = element.beside(point, strain, &layers.forces(of, own));
                        for (sum, station) in between.iter_mut().zip(0..) {
                            let stress = layers.stress(station, of, own);
                            *sum += von_mises(&stress) * form.areas[point] / whole;
                        }
                        (forces, layers.outermost(of, own))
                    }
                };
                let (tangents, part) = (form.tangents(&now, point), area / whole);
                mean.membrane += in_space(&tangents, &forces, 0) * part;
                mean.bending += in_space(&tangents, &forces, 3) * part;
                let shear = (tangents[0] * forces[6] + tangents[1] * forces[7]) * part;
                (0..3).for_each(|i| mean.shear[i] += shear[i]);
                for (mean, stress) in mean.faces.iter_mut().zip(&faces) {
                    *mean += in_space(&tangents, stress, 0) * part;
                }
            }
            mean.between = between.into_iter().fold(0.0, f64::max);
            all.push(mean);
        });
        all
    }

    /// Stresses at both faces of an elastic section, C (e ± h/2 κ) with C of the material there.
    fn at_faces(&self, strain: &AtPoint, thickness: f64) -> [[f64; 3]; 2] {
        let [top, bottom] = &self.faces;
        let half = 0.5 * thickness;
        [in_plane(top, strain, half), in_plane(bottom, strain, -half)]
    }

    /// Number of places between the faces at which stresses are looked at.
    fn stations(&self) -> usize {
        match &self.layers {
            None => self.borders.len(),
            Some(layers) => layers.stations(),
        }
    }

    /// Volume (m³) and mean stress (Pa) of each element: the membrane forces over the thickness. Bending has no mean.
    pub(crate) fn stresses(&self, u: &[f64], history: &[f64]) -> Vec<(f64, Mat3)> {
        // membrane strains do not depend on rotations
        let found = self.resultants(&[], u, history);
        let elements = self.elements.iter().zip(found);
        elements
            .map(|(element, found)| {
                let thickness = element.mean_thickness();
                (element.area() * thickness, found.membrane / thickness)
            })
            .collect()
    }

    /// Thickness of each element, m, over its points.
    pub(crate) fn mean_thicknesses(&self) -> impl Iterator<Item = f64> {
        self.elements.iter().map(Element::mean_thickness)
    }

    /// The largest rotation of a node, and the largest strain of a face, of shells with small rotations.
    pub(crate) fn distortion(&self, u: &[f64], before: &Distortion) -> Option<Distortion> {
        if self.turns() {
            return None;
        }
        let (mut found, mut cell) = (*before, 0);
        self.each_strain(&[], u, &mut |element, strains| {
            for &first in &element.first[..element.count] {
                let value = Vec3::new(u[first + 3], u[first + 4], u[first + 5]).norm();
                found.rotation = found.rotation.or(Extreme { value, cell });
            }
            let points = strains.iter().zip(&element.thickness);
            for (s, thickness) in points.take(element.form.areas.len()) {
                let half = 0.5 * thickness;
                let of = |face: f64| largest([0, 1, 2].map(|i| s[i] + face * s[3 + i]));
                let value = of(half).max(of(-half));
                found.strain = found.strain.or(Extreme { value, cell });
            }
            cell += 1;
        });
        Some(found)
    }
}

/// Stress of an elastic material at the height z above the middle, C (e + z κ), Pa.
fn in_plane(material: &Elastic, strain: &AtPoint, z: f64) -> [f64; 3] {
    let [x, y, xy] = [0, 1, 2].map(|i| strain[i] + z * strain[3 + i]);
    let plane = material.young / (1.0 - material.poisson.powi(2));
    [
        plane * (x + material.poisson * y),
        plane * (y + material.poisson * x),
        material.shear_modulus() * xy,
    ]
}

/// Equivalent stress of von Mises of a plane stress, Pa.
fn von_mises([x, y, xy]: &[f64; 3]) -> f64 {
    (x * x - x * y + y * y + 3.0 * xy * xy).sqrt()
}

/// Σ f_ij g_i ⊗ g_j of three numbers from `from` on.
fn in_space(tangents: &[Vec3; 2], of: &[f64], from: usize) -> Mat3 {
    let (x, y, xy) = (of[from], of[from + 1], of[from + 2]);
    let [first, second] = tangents;
    let mixed = first * second.transpose();
    first * first.transpose() * x
        + second * second.transpose() * y
        + (mixed + mixed.transpose()) * xy
}

/// Largest principal value, by magnitude, of a plane strain ε₁₁, ε₂₂, 2ε₁₂.
fn largest([x, y, xy]: [f64; 3]) -> f64 {
    0.5 * (x + y).abs() + 0.5 * (x - y).hypot(xy)
}
