//! The rows between a beam and a solid.

use carom_elements::MAX_NODES;

use super::model::{NOTHING, SectionMotion, radius};
use super::overlap::{BeamOverlap, Part};
use super::slabs::{Rules, cuts};
use super::stations::hats;
use crate::coupling::Sum;
use crate::error::{Error, Model};
use crate::rows::{Row, Rows, Term};

/// Degree in the position of the products of a linear function, an arm r, and the shapes of a beam.
const BEAM_DEGREE: usize = 5;
impl BeamOverlap<'_> {
    /// The rows of the coupling condition: <μ, v_solid - v_beam> = 0 for each node of the mediator, its translations and then its
    /// rotations. A row of a rotation is divided by the polar radius of gyration of the section.
    ///
    /// Errors: a distorted cell that cannot be inverted at a point.
    pub fn rows(&self) -> Result<Rows, Error> {
        let mut rows = Vec::new();
        for part in &self.parts {
            rows.extend(self.rows_of(part)?);
        }
        rows.sort_by_key(|row: &Row| (row.node, row.component));
        Ok(Rows {
            rows,
            slivers: Vec::new(),
        })
    }

    fn rows_of(&self, part: &Part) -> Result<Vec<Row>, Error> {
        let (run, mesh) = (&self.runs[part.run], self.models.mesh);
        let dim = mesh.dim;
        let turns: std::ops::Range<usize> = if dim == 2 { 2..3 } else { 0..3 };
        let modes = dim + turns.len();
        let scale = 1.0 / radius(&self.models.beam[run.elements[0].0]);
        let nodes = run.elements.iter().flat_map(|(_, ends)| *ends);
        let cuts = cuts(part.range(), nodes.chain(part.stations.iter().map(|s| s.1)));
        let degrees = part.solid.iter().map(|&c| self.solid(c).degree() + 2);
        let mut rules = Rules::new(degrees.fold(BEAM_DEGREE, usize::max));
        let count = part.stations.len() * modes;
        let mut sums: [Vec<Sum>; 2] = [0, 1].map(|_| vec![Sum::default(); count]);
        let mut points = Vec::new();
        for &place in &part.solid {
            let cell = self.solid(place);
            let own = mesh.element_nodes(self.models.solid[place]);
            self.points((place, run), &cuts, &mut rules, &mut points)?;
            // one block over the cell: modes of two functions for each interval
            for point in &points {
                let middle = 0.5 * (cuts[point.interval] + cuts[point.interval + 1]);
                let Some((element, _)) = run.at(middle) else {
                    continue;
                };
                let ends = run.ends_of(element);
                let xi = (point.s - ends[0]) / (ends[1] - ends[0]);
                let beam_nodes = mesh.element_nodes(self.models.beam[element].cell);
                let motion = (self.models.motion)(element, xi);
                let mut n = [0.0; MAX_NODES];
                let n = cell.shape(&point.xi, &mut n);
                for (station, hat) in hats(&part.stations, point.s) {
                    if hat == 0.0 {
                        continue;
                    }
                    for mode in 0..modes {
                        let mu =
                            function(mode, dim, &point.r, scale).map(|x| x * hat * point.weight);
                        let row = station * modes + mode;
                        for (b, &node) in own.iter().enumerate() {
                            for l in (0..dim).filter(|&l| mu[l] != 0.0) {
                                sums[0][row].add(node * 6 + l as u32, mu[l] * n[b]);
                            }
                        }
                        let on_beam = beam_products(&mu, &point.r, &motion);
                        for (k, value) in on_beam.into_iter().enumerate() {
                            let Some(component) = component(k % 6, dim) else {
                                continue;
                            };
                            sums[1][row].add(beam_nodes[k / 6] * 6 + component, value);
                        }
                    }
                }
            }
        }
        Ok(self.finish(part, modes, sums))
    }

    fn finish(&self, part: &Part, modes: usize, sums: [Vec<Sum>; 2]) -> Vec<Row> {
        let [mut solid, mut beam] = sums;
        let mut rows = Vec::with_capacity(solid.len());
        for (i, &(node, _)) in part.stations.iter().enumerate() {
            for mode in 0..modes {
                let terms = |sums: &mut Vec<Sum>| {
                    let sum = sums[i * modes + mode].sorted();
                    let largest = sum.iter().fold(0.0_f64, |m, t| m.max(t.1.abs()));
                    let kept = sum
                        .iter()
                        .filter(|t| t.1.abs() > NOTHING * NOTHING * largest);
                    let term = |&(key, coefficient): &(u32, f64)| Term {
                        node: key / 6,
                        component: key % 6,
                        coefficient,
                    };
                    kept.map(term).collect::<Vec<Term>>()
                };
                let (solid, beam) = (terms(&mut solid), terms(&mut beam));
                let (inner, outer) = match self.models.beam_is {
                    Model::Outer => (solid, beam),
                    Model::Inner => (beam, solid),
                };
                rows.push(Row {
                    node,
                    component: mode as u32,
                    inner,
                    outer,
                    ..Row::default()
                });
            }
        }
        rows
    }
}

/// A mode of the section at r from its centroid: a translation, or e × r times `scale`.
fn function(mode: usize, dim: usize, r: &[f64; 3], scale: f64) -> [f64; 3] {
    let mut mu = [0.0; 3];
    let axis = match mode.checked_sub(dim) {
        None => {
            mu[mode] = 1.0;
            return mu;
        }
        Some(_) if dim == 2 => 2,
        Some(axis) => axis,
    };
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    (mu[j], mu[k]) = (-scale * r[k], scale * r[j]);
    mu
}

/// μ·(u + θ × r) by the twelve unknowns of an element.
fn beam_products(mu: &[f64; 3], r: &[f64; 3], motion: &SectionMotion) -> [f64; 12] {
    // μ·(θ × r) = θ·(r × μ)
    let turned = crate::polytope::cross(r, mu);
    std::array::from_fn(|k| {
        (0..3)
            .map(|i| mu[i] * motion[i][k] + turned[i] * motion[3 + i][k])
            .sum()
    })
}

/// The component of an unknown of a node in a mesh of a dimension.
fn component(k: usize, dim: usize) -> Option<u32> {
    match (dim, k) {
        (2, 0 | 1) => Some(k as u32),
        (2, 5) => Some(2),
        (2, _) => None,
        _ => Some(k as u32),
    }
}
