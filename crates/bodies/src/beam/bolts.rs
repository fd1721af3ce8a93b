//! Cells of beams that a static stage tightens: bolts by their shanks.
//!
//! The elongation of the bolt is that of the cell, its stiffness E A/L. In the static stage the cell has no axial stiffness, and bends and
//! twists as always.

use super::Beam;
use super::element::{EndWeights, Matrix};
use crate::discrete::VisitRow;
use crate::{Bolt, Error};

/// Places of the elongation among the unknowns of an element.
const ALONG: [usize; 2] = [0, 6];

impl Beam {
    /// Bolts that a static stage tightens.
    pub(crate) fn bolts(&self) -> &[Bolt] {
        &self.bolts.all
    }

    /// Completes the bolts of a body whose elements are known.
    ///
    /// # Errors
    /// An element that shares its volume with another model, or of metal that flows.
    pub(super) fn complete_bolts(&mut self) -> Result<(), Error> {
        for k in 0..self.bolts.all.len() {
            let element = self.bolts.elements[k];
            let refused = |why| {
                Err(Error::Tightened {
                    body: self.name.clone(),
                    cell: self.cells[element],
                    why,
                })
            };
            if self.flowing.is_some() {
                return refused("its metal flows; take an elastic material for the shank");
            }
            if self.weights[element] != EndWeights::ONE {
                return refused("it shares its volume with another model");
            }
            let t = self.transformation(element);
            let unknowns = self.unknowns(element).enumerate();
            let row = unknowns.map(|(k, unknown)| (unknown, t[ALONG[1]][k] - t[ALONG[0]][k]));
            let row = row.filter(|(_, c)| *c != 0.0).collect();
            let stiffness = self.material.young * self.section.properties.area;
            let bolt = &mut self.bolts.all[k];
            (bolt.row, bolt.stiffness) = (row, stiffness / self.lengths[element]);
        }
        Ok(())
    }

    /// Takes the axial stiffness from an element that is tightened.
    pub(super) fn loosen(&self, element: usize, k: &mut Matrix) {
        if !self.bolts.loosens(element) {
            return;
        }
        for i in ALONG {
            for j in ALONG {
                k[i][j] = 0.0;
            }
        }
    }

    /// System numbers of the nodes of each element that joins them in all directions.
    pub(crate) fn each_joining_element(&self, visit: &mut dyn FnMut(&[u32])) {
        for (element, nodes) in self.nodes.iter().enumerate() {
            if !self.bolts.loosens(element) {
                visit(nodes);
            }
        }
    }

    /// Visits what the elements without axial stiffness hold: rotations against the chord, and the twist.
    pub(super) fn each_row_of_loose(&self, visit: &mut VisitRow) {
        for &element in self.bolts.elements.iter().filter(|_| self.bolts.tighten) {
            let t = self.transformation(element);
            let over = 1.0 / self.lengths[element];
            let released = &self.released[element];
            // the angle of the chord about z is (v₂ - v₁)/L, about y -(w₂ - w₁)/L
            for (rotation, across, sign) in [(5, 1, 1.0), (11, 1, 1.0), (4, 2, -1.0), (10, 2, -1.0)]
            {
                if !released[rotation] {
                    let chord = [(across + 6, -sign * over), (across, sign * over)];
                    self.visit_row(element, &t, &[(rotation, 1.0), chord[0], chord[1]], visit);
                }
            }
            if !released[3] && !released[9] {
                self.visit_row(element, &t, &[(9, 1.0), (3, -1.0)], visit);
            }
        }
    }

    /// Visits a combination of the unknowns of an element in its own axes; nothing where the plane has none of them.
    fn visit_row(
        &self,
        element: usize,
        t: &[Vec<f64>],
        terms: &[(usize, f64)],
        visit: &mut VisitRow,
    ) {
        let value = |k: usize| terms.iter().map(|&(i, c)| c * t[i][k]).sum::<f64>();
        let unknowns = self.unknowns(element).enumerate();
        let row = unknowns.map(|(k, unknown)| (unknown, value(k)));
        let row: Vec<(usize, f64)> = row.filter(|(_, c)| *c != 0.0).collect();
        if !row.is_empty() {
            visit(&row);
        }
    }

    /// Normal force that an element keeps beside E A ε, N; `history`: of this body.
    pub(crate) fn kept_force(&self, element: usize, history: &[f64]) -> f64 {
        let place = self.bolts.elements.iter().position(|own| *own == element);
        place.and_then(|k| history.get(k)).copied().unwrap_or(0.0)
    }
}
