//! An element of a shell.

use super::one_point::Hourglass;
use super::products::{Configuration, MOST};
use super::section::{ElasticSection, Inertia};
use super::shares::PointWeights;
use super::strain::{Form, Strains};
use crate::Stored;

/// Unknowns of a node.
pub(super) const PER_NODE: usize = 6;

/// An element.
#[derive(Debug)]
pub(super) struct Element {
    /// Nodes: three or four.
    pub count: usize,
    /// Their numbers in the system, first unknowns and frames.
    pub nodes: [u32; MOST],
    pub first: [usize; MOST],
    pub frames: [usize; MOST],
    /// Places of the nodes and the axes that turn with them.
    pub reference: Configuration,
    pub form: Form,
    /// From the nodes to the middle surface along the directors, m.
    pub offset: f64,
    /// At the points: thickness, m, and section.
    pub thickness: [f64; MOST],
    pub sections: [ElasticSection; MOST],
    /// Mass per area at the points of the mass, kg/m², and that of the mean section.
    pub density: [f64; MOST],
    pub inertia: Inertia,
    pub weights: PointWeights,
    /// With one point.
    pub hourglass: Option<Hourglass>,
}

impl Element {
    /// The unknowns in a system vector.
    pub(super) fn unknowns(&self) -> impl Iterator<Item = usize> + '_ {
        let first = self.first[..self.count].iter();
        first.flat_map(|&first| first..first + PER_NODE)
    }

    pub(super) fn area(&self) -> f64 {
        self.form.inert.iter().sum()
    }

    /// m, over the points.
    pub(super) fn mean_thickness(&self) -> f64 {
        let points = self.form.areas.iter().zip(&self.thickness);
        let (mut volume, mut area) = (0.0, 0.0);
        for (own, thickness) in points {
            volume += own * thickness;
            area += own;
        }
        volume / area
    }

    /// Area of each point times its weight of internal work, m².
    pub(super) fn working(&self) -> impl Iterator<Item = f64> + '_ {
        let points = self.form.areas.iter().zip(&self.weights.stiffness);
        points.map(|(area, delta)| area * delta)
    }

    /// Forces and moments per length at all points, times their areas, and what holds the motions that one point does not see.
    pub(super) fn weighted(&self, strains: &Strains) -> Strains {
        let mut forces = Strains::default();
        for (point, area) in self.working().enumerate() {
            let found = self.sections[point].forces(&strains[point]);
            forces[point] = found.map(|force| force * area);
        }
        if let Some(hourglass) = &self.hourglass {
            hourglass.force(strains, &mut forces);
        }
        forces
    }

    /// Energies of an elastic section.
    pub(super) fn stored(&self, strains: &Strains) -> Stored {
        let points = strains.iter().zip(&self.sections).zip(self.working());
        let seen: f64 = points
            .map(|((strains, section), area)| area * section.energy(strains))
            .sum();
        let [unseen, hourglass] = match &self.hourglass {
            Some(hourglass) => hourglass.force(strains, &mut Strains::default()),
            None => [0.0; 2],
        };
        Stored {
            strain: seen + unseen,
            hourglass,
            ..Stored::default()
        }
    }
}
