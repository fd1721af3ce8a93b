//! The mass matrix of a system.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::unknowns::{Kind, Unknowns};
use carom_bodies::{Body, MassKind};

use crate::cliques::push_cliques;
use crate::model::ModelBody;

/// Mass of the system: a diagonal, and the consistent part where there is one.
#[derive(Debug)]
pub struct Mass {
    /// Row sums of the lumped bodies, kg, one entry per unknown.
    pub lumped: Vec<f64>,
    /// Consistent mass of the other bodies.
    pub consistent: Option<Csr>,
}

impl Mass {
    /// y = M x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        match &self.consistent {
            Some(matrix) => matrix.multiply(x, y),
            None => y.fill(0.0),
        }
        for i in 0..y.len() {
            y[i] += self.lumped[i] * x[i];
        }
    }

    /// M g in N: of a consistent mass the work of gravity (m/s²) over the shapes of the elements, moments included.
    pub(crate) fn weight(
        &self,
        (bodies, unknowns): (&[Body], &Unknowns),
        gravity: [f64; 3],
    ) -> Vec<f64> {
        let along = |unknown: usize| match unknowns.kind(unknown) {
            Kind::Translation(axis) => gravity[axis],
            Kind::Rotation(_) | Kind::Amplitude(_) => 0.0,
        };
        let mut field: Vec<f64> = (0..unknowns.len()).map(along).collect();
        for (unknown, amplitude) in unknowns.amplitudes() {
            let terms = amplitude.translation.iter().zip(gravity);
            field[unknown] = terms.map(|(part, g)| part * g).sum();
        }
        let mut load = vec![0.0; unknowns.len()];
        self.multiply(&field, &mut load);
        for body in bodies.iter().filter_map(Body::as_reduced) {
            for (axis, g) in gravity.iter().enumerate().filter(|(_, g)| **g != 0.0) {
                for (unknown, missing) in body.missing(axis) {
                    load[unknown] += g * missing;
                }
            }
        }
        load
    }

    /// That of bodies.
    pub fn of(bodies: &[Body], specs: &[ModelBody], unknowns: &Unknowns) -> Mass {
        let n = unknowns.len();
        let mut lumped = vec![0.0; n];
        let mut cliques = Cliques::new();
        let mut consistent = Vec::new();
        for (k, body) in bodies.iter().enumerate() {
            // point masses are on the diagonal
            match specs.get(k).map_or(MassKind::Lumped, |spec| spec.mass) {
                MassKind::Lumped => body.add_lumped_mass(&mut lumped),
                MassKind::Consistent => {
                    push_cliques(body, unknowns, &(0..n), &mut cliques);
                    consistent.push(body);
                }
            }
        }
        if consistent.is_empty() {
            return Mass {
                lumped,
                consistent: None,
            };
        }
        let mut matrix = Csr::from_cliques(n, &cliques);
        for body in consistent {
            body.assemble([0.0, 0.0, 1.0], &(0..n), &mut matrix);
        }
        Mass {
            lumped,
            consistent: Some(matrix),
        }
    }

    /// Adds factor · M over the unknowns of `part` to a matrix whose first unknown is `origin`.
    pub fn add_to(&self, factor: f64, part: &Range<usize>, origin: usize, a: &mut Csr) {
        for (i, m) in part.clone().zip(&self.lumped[part.clone()]) {
            a.add(i - origin, i - origin, factor * m);
        }
        let Some(mass) = &self.consistent else {
            return;
        };
        for i in part.clone() {
            let (columns, values) = mass.row(i);
            for (&j, m) in columns.iter().zip(values).filter(|(_, m)| **m != 0.0) {
                a.add(i - origin, j as usize - origin, factor * m);
            }
        }
    }
}
