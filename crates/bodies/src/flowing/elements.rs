//! Elements of two nodes whose sections flow.

use carom_algebra::csr::Csr;

use super::section::{FibreSection, Strains};
use crate::{Placement, Stored};

/// A section of an element: the length that it stands for (m), and its strains by the unknowns of the element.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub(crate) length: f64,
    pub(crate) rows: [[f64; 12]; 3],
}

/// Elements with up to twelve unknowns: forces Σ Bᵀ (N, M_y, M_z) dx over their points, and K u of what stays elastic.
#[derive(Debug)]
pub(crate) struct Flowing {
    section: FibreSection,
    /// Unknowns and points of an element.
    count: usize,
    per: usize,
    /// Unknowns of all elements in a system vector.
    unknowns: Vec<u32>,
    points: Vec<Point>,
    /// K of what stays elastic, row-major, of each element; empty where nothing does.
    elastic: Vec<f64>,
}

impl Flowing {
    /// Elements of `count` unknowns and `per` points each.
    pub(crate) fn new(section: FibreSection, count: usize, per: usize) -> Flowing {
        Flowing {
            section,
            count,
            per,
            unknowns: Vec::new(),
            points: Vec::new(),
            elastic: Vec::new(),
        }
    }

    /// Adds an element. `elastic`: K of what stays elastic, empty if nothing does.
    pub(crate) fn push(
        &mut self,
        unknowns: impl Iterator<Item = usize>,
        points: impl Iterator<Item = Point>,
        elastic: &[f64],
    ) {
        self.unknowns.extend(unknowns.map(|unknown| unknown as u32));
        self.points.extend(points);
        self.elastic.extend_from_slice(elastic);
    }

    /// Its section alone.
    pub(crate) fn into_section(self) -> FibreSection {
        self.section
    }

    /// Number of fibres of a section.
    pub(crate) fn fibres(&self) -> usize {
        self.section.fibres()
    }

    /// Numbers that all elements keep from one step to the next.
    pub(crate) fn history_len(&self) -> usize {
        self.points.len() * self.section.history_len()
    }

    fn elements(&self) -> usize {
        self.unknowns.len() / self.count
    }

    fn of_element(&self, element: usize) -> &[u32] {
        &self.unknowns[self.count * element..][..self.count]
    }

    fn values(&self, element: usize, u: &[f64]) -> [f64; 12] {
        let mut own = [0.0; 12];
        for (own, &unknown) in own.iter_mut().zip(self.of_element(element)) {
            *own = u[unknown as usize];
        }
        own
    }

    fn strains(&self, point: &Point, own: &[f64; 12]) -> Strains {
        let product = |row: &[f64; 12]| {
            let pairs = row.iter().zip(own).take(self.count);
            pairs.map(|(row, u)| row * u).sum::<f64>()
        };
        [0, 1, 2].map(|i| product(&point.rows[i]))
    }

    fn stiffness(&self, element: usize) -> &[f64] {
        let size = self.count * self.count;
        self.elastic
            .get(size * element..size * (element + 1))
            .unwrap_or(&[])
    }

    /// Adds the internal forces (N) to `f`, writes the history at the end of the step into `new` and returns the energies.
    pub(crate) fn force(&self, at: &Placement, new: &mut [f64], f: &mut [f64]) -> Stored {
        let mut sum = Stored::default();
        let kept = self.section.history_len();
        for element in 0..self.elements() {
            let own = self.values(element, at.u);
            let mut forces = [0.0; 12];
            for number in self.per * element..self.per * (element + 1) {
                let point = &self.points[number];
                let strains = self.strains(point, &own);
                let range = kept * number..kept * (number + 1);
                let history = (&at.old[range.clone()], &mut new[range]);
                let (section, stored) = self.section.update(&strains, at.dt, history);
                for (row, force) in point.rows.iter().zip(section) {
                    for (sum, row) in forces.iter_mut().zip(row) {
                        *sum += point.length * force * row;
                    }
                }
                sum.strain += point.length * stored.strain;
                sum.hardening += point.length * stored.hardening;
                sum.dissipated += point.length * stored.dissipated;
            }
            let rows = self.stiffness(element).chunks_exact(self.count);
            for ((force, row), u) in forces.iter_mut().zip(rows).zip(own) {
                let elastic = row.iter().zip(&own).map(|(k, u)| k * u).sum::<f64>();
                *force += elastic;
                sum.strain += 0.5 * elastic * u;
            }
            for (&unknown, force) in self.of_element(element).iter().zip(forces) {
                f[unknown as usize] += force;
            }
        }
        sum
    }

    /// Adds `factor` ∂f/∂u to a matrix over all unknowns.
    pub(crate) fn add_tangent(&self, at: &Placement, factor: f64, matrix: &mut Csr) {
        let (kept, n) = (self.section.history_len(), self.count);
        for element in 0..self.elements() {
            let own = self.values(element, at.u);
            let mut k = [[0.0; 12]; 12];
            for (to, from) in k.iter_mut().zip(self.stiffness(element).chunks_exact(n)) {
                to[..n].copy_from_slice(from);
            }
            for number in self.per * element..self.per * (element + 1) {
                let point = &self.points[number];
                let strains = self.strains(point, &own);
                let old = &at.old[kept * number..kept * (number + 1)];
                let (_, tangent) = self.section.tangent(&strains, at.dt, old);
                for a in 0..n {
                    let column = tangent.map(|row| {
                        let parts = row.iter().zip(&point.rows);
                        point.length * parts.map(|(t, row)| t * row[a]).sum::<f64>()
                    });
                    for b in 0..n {
                        k[b][a] += (0..3).map(|i| point.rows[i][b] * column[i]).sum::<f64>();
                    }
                }
            }
            let unknowns = self.of_element(element);
            for (row, &i) in k.iter().zip(unknowns) {
                for (value, &j) in row.iter().zip(unknowns) {
                    matrix.add(i as usize, j as usize, factor * value);
                }
            }
        }
    }

    fn history<'a>(&self, number: usize, all: &'a [f64]) -> &'a [f64] {
        let kept = self.section.history_len();
        &all[kept * number..kept * (number + 1)]
    }

    /// Normal force (N) and moments (N m) at a point of an element in the history of all, that at `u`.
    pub(crate) fn forces(
        &self,
        element: usize,
        point: usize,
        (u, all): (&[f64], &[f64]),
    ) -> Strains {
        let number = self.per * element + point;
        let strains = self.strains(&self.points[number], &self.values(element, u));
        self.section.forces(&strains, self.history(number, all))
    }

    /// Normal stress at a place of the section at a point of an element in the history of all, that at `u`, Pa.
    pub(crate) fn stress(
        &self,
        (element, point): (usize, usize),
        place: [f64; 2],
        (u, all): (&[f64], &[f64]),
    ) -> f64 {
        let number = self.per * element + point;
        let strains = self.strains(&self.points[number], &self.values(element, u));
        self.section
            .stress(&strains, place, self.history(number, all))
    }

    /// Mean stress of an element in the history of all, that at `u`, Pa.
    pub(crate) fn mean_stress(&self, element: usize, (u, all): (&[f64], &[f64])) -> f64 {
        let own = self.values(element, u);
        let of = |point: usize| {
            let number = self.per * element + point;
            let [strain, ..] = self.strains(&self.points[number], &own);
            self.section.mean_stress(strain, self.history(number, all))
        };
        (0..self.per).map(of).sum::<f64>() / self.per as f64
    }

    /// Largest equivalent plastic strain of the fibres of each element.
    pub(crate) fn plastic_strains(&self, all: &[f64]) -> Vec<f64> {
        let of = |element: usize| {
            let points = self.per * element..self.per * (element + 1);
            let strains =
                points.map(|number| self.section.plastic_strain(self.history(number, all)));
            strains.fold(0.0, f64::max)
        };
        (0..self.elements()).map(of).collect()
    }
}
