//! What the overlap of a beam and a solid is: its parts along the axis, and what of the beam stays.

use carom_mesh::ElementId;

use super::model::{BeamModels, common};
use super::runs::Run;
use crate::cell::Cell;
use crate::error::Model;

/// The overlap S of a beam and a solid, ready for weights and rows.
///
/// The solid has weight 1 outside S. The beam has weight 0 where it lies in the solid outside S; its cells there are
/// [removed](BeamOverlap::removed).
pub struct BeamOverlap<'a> {
    pub(super) models: BeamModels<'a>,
    pub(super) runs: Vec<Run>,
    pub(super) parts: Vec<Part>,
    /// Elements of the beam that stay.
    pub(super) kept: Vec<usize>,
    pub(super) cells: Vec<ElementId>,
    pub(super) removed: Vec<ElementId>,
    /// Mean size along the axis of the cells of the solid, and length of the elements.
    pub(super) sizes: [f64; 2],
}

/// A connected part of S, on a straight run of the axis.
pub(super) struct Part {
    pub run: usize,
    /// Where the solid ends, and where the beam ends.
    pub from: f64,
    pub to: f64,
    /// The cells of the solid that it touches: places in the body.
    pub solid: Vec<usize>,
    /// Nodes of the mediator with their places along the axis, ascending.
    pub stations: Vec<(u32, f64)>,
}

impl Part {
    pub fn range(&self) -> [f64; 2] {
        [self.from.min(self.to), self.from.max(self.to)]
    }
}

impl BeamOverlap<'_> {
    /// Cells of a model that stay, in the order in which they were given.
    pub fn cells(&self, model: Model) -> &[ElementId] {
        match model == self.models.beam_is {
            true => &self.cells,
            false => self.models.solid,
        }
    }

    /// Cells of the beam that fall away: inside the solid, outside S.
    pub fn removed(&self) -> &[ElementId] {
        &self.removed
    }

    /// Cells that S touches, of both models.
    pub fn touched(&self) -> Vec<ElementId> {
        let solid = self.parts.iter().flat_map(|part| &part.solid);
        let mut all: Vec<ElementId> = solid.map(|&c| self.models.solid[c]).collect();
        for (part, (element, _)) in self.parts.iter().flat_map(|part| {
            let elements = self.runs[part.run].elements.iter();
            elements.map(move |element| (part, *element))
        }) {
            let range = self.runs[part.run].range_of(element);
            if common(range, part.range()).is_some() {
                all.push(self.models.beam[element].cell);
            }
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Length of S along the axis, m.
    pub fn length(&self) -> f64 {
        let lengths = self.parts.iter().map(|part| (part.to - part.from).abs());
        lengths.sum()
    }

    /// Measure of S, m² in the plane and m³ in space: that of the sections of the beam.
    pub fn measure(&self) -> f64 {
        self.length() * self.models.beam[0].area / self.models.thickness
    }

    /// Mean size along the axis of the cells of a model in S, m.
    pub fn size(&self, model: Model) -> f64 {
        self.sizes[usize::from(model == self.models.beam_is)]
    }

    /// Least length of a connected part of S, in cells of the coarser model.
    pub fn layers(&self) -> f64 {
        let lengths = self.parts.iter().map(|part| (part.to - part.from).abs());
        lengths.fold(f64::INFINITY, f64::min) / self.coarser()
    }

    /// The larger of both sizes along the axis, m.
    pub(super) fn coarser(&self) -> f64 {
        self.sizes[0].max(self.sizes[1])
    }

    /// A cell of the solid.
    pub(super) fn solid(&self, place: usize) -> Cell {
        Cell::new(self.models.mesh, self.models.solid[place])
    }
}
