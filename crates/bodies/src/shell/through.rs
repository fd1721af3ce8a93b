//! Sections of the elements of a body: of one material, whose thickness may change from node to node, or of plies.

use carom_materials::{Elastic, Plane};

use super::defects::longest;
use super::element::Element;
use super::layers::Layers;
use super::products::{Configuration, MOST};
use super::section::ShellSection;
use super::section::{ElasticSection, Inertia, Ply, heights};
use super::shares::PointWeights;
use super::strain::Form;
use crate::spec::BodySpec;

/// Resistance of triangles to shear: h² over h² and this part of the square of the longest edge.
const TRIANGLE: f64 = 0.1;

/// What a body has through its thickness.
pub(super) struct Through<'a> {
    spec: &'a BodySpec,
    section: ShellSection,
    /// Where the thickness is constant.
    uniform: (ElasticSection, Inertia),
}

impl Through<'_> {
    pub(super) fn new(spec: &BodySpec, section: ShellSection) -> Through<'_> {
        let plies = plies(spec, section.thickness);
        Through {
            spec,
            section,
            uniform: (ElasticSection::new(&plies), Inertia::new(&plies)),
        }
    }

    /// Undeformed materials at the faces, that to which the normal points first.
    pub(super) fn faces(&self) -> [Elastic; 2] {
        let own = &self.spec.material;
        let plies = &self.spec.plies;
        [plies.last(), plies.first()].map(|ply| ply.map_or(own, |ply| &ply.material).initial())
    }

    /// Undeformed materials on both sides of where plies meet, and the height above the middle over the thickness.
    pub(super) fn borders(&self) -> Vec<(Elastic, f64)> {
        let plies = heights(&self.spec.plies);
        let meets = plies.windows(2).flat_map(|pair| {
            let (below, above) = (&pair[0], &pair[1]);
            let height = above.1[0] / self.section.thickness;
            [(below.0, height), (above.0, height)]
        });
        meets.collect()
    }

    /// Speed of membrane waves, m/s.
    pub(super) fn wave_speed(&self) -> f64 {
        let (section, inertia) = &self.uniform;
        match self.spec.plies.is_empty() {
            true => self.spec.material.initial().wave_speed(Plane::Stress),
            false => (section.membrane[0] / inertia.density).sqrt(),
        }
    }

    /// Points through the thickness where a material flows.
    pub(super) fn layers(&self) -> Option<Layers> {
        if !self.spec.plies.is_empty() {
            return Layers::of_plies(&self.spec.plies);
        }
        let law = self.spec.material.plane_stress();
        law.map(|law| Layers::new(law, self.section.layers))
    }

    /// Section and mass where it is this thick, m.
    fn at(&self, thickness: f64) -> (ElasticSection, Inertia) {
        if self.spec.nodal_thickness.is_none() {
            return self.uniform;
        }
        let plies = plies(self.spec, thickness);
        (ElasticSection::new(&plies), Inertia::new(&plies))
    }

    /// An element on these nodes of the mesh, which have no numbers of the system yet.
    pub(super) fn element(
        &self,
        (reference, form): (Configuration, Form),
        nodes: &[u32],
    ) -> Element {
        let count = nodes.len();
        let longest = longest(&reference.x[..count]);
        let mut nodal = [self.section.thickness; MOST];
        for (nodal, &node) in nodal.iter_mut().zip(nodes) {
            *nodal = self.spec.thickness_at(&self.section, node);
        }
        let at = |n: &[f64; MOST]| n.iter().zip(&nodal).map(|(n, h)| n * h).sum::<f64>();
        let mean = nodal[..count].iter().sum::<f64>() / count as f64;
        let of_mass: Vec<f64> = form.shapes.iter().map(at).collect();
        // one point is at the centre
        let of_strains = match form.areas.len() == form.shapes.len() {
            true => of_mass.clone(),
            false => vec![mean; form.areas.len()],
        };
        let (section, inertia) = self.at(mean);
        let mut element = Element {
            count,
            nodes: [0; MOST],
            first: [0; MOST],
            frames: [usize::MAX; MOST],
            reference,
            form,
            offset: self.section.offset,
            thickness: [mean; MOST],
            sections: [section; MOST],
            density: [inertia.density; MOST],
            inertia,
            weights: PointWeights::default(),
            hourglass: None,
        };
        for (point, &thickness) in of_strains.iter().enumerate() {
            element.thickness[point] = thickness;
            element.sections[point] = self.at(thickness).0;
        }
        for (density, &thickness) in element.density.iter_mut().zip(&of_mass) {
            *density = self.at(thickness).1.density;
        }
        if count == 3 {
            for (section, thickness) in element.sections.iter_mut().zip(&element.thickness) {
                let square = thickness * thickness;
                let factor = square / (square + TRIANGLE * longest * longest);
                *section = section.with_shear(factor);
            }
        }
        element
    }
}

/// The plies, or one of the material.
fn plies(spec: &BodySpec, thickness: f64) -> Vec<Ply> {
    match spec.plies.is_empty() {
        true => vec![Ply {
            material: spec.material,
            thickness,
        }],
        false => spec.plies.clone(),
    }
}
