//! Beams of metal that flows: fibres at the two points of Gauss of each element.
//!
//! The curvature of an element is linear along it, so that two points give the elastic stiffness exactly. Shear and torsion stay elastic,
//! and the shape in which an element shears and bends stays that of the elastic one.

use carom_materials::Uniaxial;

use super::Beam;
use super::fibres::GAUSS;
use crate::Error;
use crate::flowing::{FibreSection, Flowing, Point};

impl Beam {
    /// The fibres of all elements.
    pub(super) fn fibred(&self, law: Box<dyn Uniaxial>) -> Result<Flowing, Error> {
        let body = || self.name.clone();
        if self.released.iter().flatten().any(|released| *released) {
            return Err(Error::FlowingHinges { body: body() });
        }
        let shape = self.section.shape;
        let shape = shape.ok_or_else(|| Error::NoShape { body: body() })?;
        let fibres = shape.fibres(self.section.layers, self.dim);
        let section = FibreSection::new(law, fibres);
        let count = 2 * self.per_node();
        let mut flowing = Flowing::new(section, count, GAUSS.len());
        for element in 0..self.nodes.len() {
            let (own, t) = (self.element(element), self.transformation(element));
            let turned = |row: [f64; 12]| {
                let mut turned = [0.0; 12];
                for (value, t) in row.iter().zip(&t) {
                    for (turned, t) in turned.iter_mut().zip(t) {
                        *turned += value * t;
                    }
                }
                turned
            };
            let points = GAUSS.map(|xi| Point {
                length: 0.5 * self.lengths[element],
                rows: own.strain_rows(xi).map(turned),
            });
            let mut elastic = own.shear_and_torsion();
            let ground = own.foundation();
            for (k, ground) in elastic.iter_mut().flatten().zip(ground.iter().flatten()) {
                *k += ground;
            }
            let elastic = self.turned(element, &elastic);
            flowing.push(self.unknowns(element), points.into_iter(), &elastic);
        }
        Ok(flowing)
    }

    /// Forces of an element in its own axes, without those of a foundation. `local`: its unknowns there.
    pub(super) fn flowed(
        &self,
        flowing: &Flowing,
        (element, local): (usize, &[f64; 12]),
        at: (&[f64], &[f64]),
    ) -> [f64; 12] {
        let own = self.element(element);
        let k = own.shear_and_torsion();
        let mut f = k.map(|row| row.iter().zip(local).map(|(k, u)| k * u).sum::<f64>());
        for (point, xi) in GAUSS.into_iter().enumerate() {
            let forces = flowing.forces(element, point, at);
            for (row, force) in own.strain_rows(xi).iter().zip(forces) {
                for (f, row) in f.iter_mut().zip(row) {
                    *f += 0.5 * self.lengths[element] * force * row;
                }
            }
        }
        f
    }

    /// That there is no stress between two displacements.
    pub(super) fn no_between(&self) -> Error {
        Error::NoBetween {
            body: self.name.clone(),
        }
    }

    /// Numbers that its fibres or bolts keep from one step to the next.
    pub(crate) fn history_len(&self) -> usize {
        let bolts = self.bolts().len();
        self.flowing.as_ref().map_or(bolts, Flowing::history_len)
    }

    /// Largest equivalent plastic strain of the fibres of each element; none where nothing flows.
    pub(crate) fn plastic_strains(&self, history: &[f64]) -> Option<Vec<f64>> {
        let flowing = self.flowing.as_ref()?;
        Some(flowing.plastic_strains(history))
    }

    /// Number of fibres of a section; none where nothing flows.
    pub fn fibres(&self) -> Option<usize> {
        self.flowing.as_ref().map(Flowing::fibres)
    }
}
