//! The mass matrix of a system.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::unknowns::{Kind, Unknowns};
use carom_bodies::{Body, MassKind, ReducedMass};

use crate::cliques::push_cliques;
use crate::model::ModelBody;

/// Mass of the system: a diagonal, and the consistent part where there is one. Reduced bodies keep their own, which equal bodies
/// share.
#[derive(Debug)]
pub struct Mass {
    /// Row sums of the lumped bodies, kg, one entry per unknown.
    pub lumped: Vec<f64>,
    /// Consistent mass of the other bodies.
    consistent: Option<Csr>,
    /// Masses of the reduced bodies, each with its factor.
    reduced: Vec<(f64, ReducedMass)>,
    /// What of it has no weight: that of fluids around beams.
    weightless: Option<Box<Mass>>,
}

/// Visits a body's part of a vector.
type AddLumped<'a> = dyn Fn(usize, &mut [f64]) + 'a;

/// Visits a body's part of a matrix over so many unknowns.
type AddConsistent<'a> = dyn Fn(usize, usize, &mut Csr) + 'a;

/// What each body adds to a mass.
#[derive(Clone, Copy)]
struct Parts<'a> {
    bodies: &'a [Body],
    unknowns: &'a Unknowns,
    kind: &'a dyn Fn(usize) -> MassKind,
    lumped: &'a AddLumped<'a>,
    consistent: &'a AddConsistent<'a>,
    /// Factor of the mass of a reduced body.
    reduced: &'a dyn Fn(usize) -> f64,
}

impl Parts<'_> {
    /// The sum over some of the bodies.
    fn gather(&self, takes: &dyn Fn(usize) -> bool) -> Mass {
        let n = self.unknowns.len();
        let mut mass = Mass::of_diagonal(vec![0.0; n]);
        let mut cliques = Cliques::new();
        let mut consistent = Vec::new();
        for (k, body) in self.bodies.iter().enumerate().filter(|(k, _)| takes(*k)) {
            if let Body::Reduced(reduced) = body {
                mass.reduced.push(((self.reduced)(k), reduced.mass()));
                continue;
            }
            match (self.kind)(k) {
                MassKind::Lumped => (self.lumped)(k, &mut mass.lumped),
                MassKind::Consistent => {
                    push_cliques(body, self.unknowns, &(0..n), &mut cliques);
                    consistent.push(k);
                }
            }
        }
        if consistent.is_empty() {
            return mass;
        }
        let mut matrix = Csr::from_cliques(n, &cliques);
        for k in consistent {
            (self.consistent)(k, n, &mut matrix);
        }
        mass.consistent = Some(matrix);
        mass
    }
}

impl Mass {
    /// A diagonal one, kg, one entry per unknown.
    /// The entry of an unknown on the diagonal, kg or kg m²; of reduced bodies nothing.
    pub fn diagonal(&self, unknown: usize) -> f64 {
        let consistent = self.consistent.as_ref();
        self.lumped[unknown] + consistent.map_or(0.0, |mass| mass.get(unknown, unknown))
    }

    pub(crate) fn of_diagonal(lumped: Vec<f64>) -> Mass {
        Mass {
            lumped,
            consistent: None,
            reduced: Vec::new(),
            weightless: None,
        }
    }

    /// Whether it is a diagonal.
    pub fn is_lumped(&self) -> bool {
        self.consistent.is_none() && self.reduced.is_empty()
    }

    /// Whether it has a consistent part among these unknowns.
    pub fn couples(&self, unknowns: &Range<usize>) -> bool {
        let of = |matrix: &Csr| unknowns.clone().any(|i| matrix.get(i, i) != 0.0);
        let mut reduced = self.reduced.iter();
        self.consistent.as_ref().is_some_and(of) || reduced.any(|(_, mass)| mass.is_in(unknowns))
    }

    /// y = M x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        match &self.consistent {
            Some(matrix) => matrix.multiply(x, y),
            None => y.fill(0.0),
        }
        for (factor, mass) in &self.reduced {
            mass.add_product(*factor, x, y);
        }
        for i in 0..y.len() {
            y[i] += self.lumped[i] * x[i];
        }
    }

    /// M g in N, without the mass of fluids around beams: of a consistent mass the work of gravity (m/s²) over the shapes of the elements, moments included.
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
        if let Some(weightless) = &self.weightless {
            let mut without = vec![0.0; unknowns.len()];
            weightless.multiply(&field, &mut without);
            for (load, without) in load.iter_mut().zip(without) {
                *load -= without;
            }
        }
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
        let kind = |k: usize| match bodies[k].couples_mass() {
            true => MassKind::Consistent,
            // point masses are on the diagonal
            false => specs.get(k).map_or(MassKind::Lumped, |spec| spec.mass),
        };
        let whole = Parts {
            bodies,
            unknowns,
            kind: &kind,
            lumped: &|k, mass| bodies[k].add_lumped_mass(mass),
            consistent: &|k, n, matrix| bodies[k].assemble([0.0, 0.0, 1.0], &(0..n), matrix),
            reduced: &|_| 1.0,
        };
        let mut mass = whole.gather(&|_| true);
        let fluid = Parts {
            lumped: &|k, mass| {
                if let Some(beam) = bodies[k].in_fluid() {
                    beam.add_lumped_fluid(mass);
                }
            },
            consistent: &|k, _, matrix| {
                if let Some(beam) = bodies[k].in_fluid() {
                    beam.add_fluid_mass(matrix);
                }
            },
            ..whole
        };
        let wet = |k: usize| bodies[k].in_fluid().is_some();
        if (0..bodies.len()).any(wet) {
            mass.weightless = Some(Box::new(fluid.gather(&wet)));
        }
        mass
    }

    /// Σ α M of bodies with the factors α of Rayleigh's damping, kg/s; `None` where all are zero. `masses`: of the nodes of each
    /// body, which contacts without mass have moved.
    pub(crate) fn of_damping(
        (bodies, specs): (&[Body], &[ModelBody]),
        factors: &dyn Fn(usize) -> f64,
        masses: &[Vec<(u32, f64)>],
        unknowns: &Unknowns,
    ) -> Option<Mass> {
        let damped = |k: usize| factors(k) != 0.0;
        if !(0..bodies.len()).any(damped) {
            return None;
        }
        let kind = |k: usize| match bodies[k].couples_mass() {
            true => MassKind::Consistent,
            false => specs.get(k).map_or(MassKind::Lumped, |spec| spec.mass),
        };
        let parts = Parts {
            bodies,
            unknowns,
            kind: &kind,
            lumped: &|k, sum| {
                let mut own = vec![0.0; sum.len()];
                bodies[k].add_lumped_mass(&mut own);
                for &(node, m) in &masses[k] {
                    own[unknowns.translations_of(node)].fill(m);
                }
                for (sum, m) in sum.iter_mut().zip(own) {
                    *sum += factors(k) * m;
                }
            },
            consistent: &|k, n, matrix| {
                bodies[k].assemble([0.0, 0.0, factors(k)], &(0..n), matrix);
            },
            reduced: factors,
        };
        Some(parts.gather(&damped))
    }

    /// Adds factor · M over the unknowns of `part` to a matrix whose first unknown is `origin`.
    pub fn add_to(&self, factor: f64, part: &Range<usize>, origin: usize, a: &mut Csr) {
        for (i, m) in part.clone().zip(&self.lumped[part.clone()]) {
            a.add(i - origin, i - origin, factor * m);
        }
        for (own, mass) in self.reduced.iter().filter(|(_, mass)| mass.is_in(part)) {
            mass.each_entry(|i, j, m| a.add(i - origin, j - origin, factor * own * m));
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
