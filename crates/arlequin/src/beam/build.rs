//! How an overlap of a beam and a solid is found.

use carom_mesh::ElementId;

use super::model::{BeamModels, NOTHING, check, common, radius};
use super::overlap::{BeamOverlap, Part};
use super::runs::{self, Span};
use super::slabs;
use super::stations::stations;
use crate::error::Error;
use crate::overlap::Region;
use crate::polytope::dot;

/// Radius around the axis in which cells of the solid belong to the section, in polar radii of gyration: that of the corners of a
/// rectangle is √3, of other usual sections less.
const REACH: f64 = 1.9;
/// Relative differences of area and second moments up to which sections count as the same: those of a circle of eight straight
/// sides, 10 and 19 %, are within.
const SAME: [f64; 2] = [0.12, 0.22];
/// Largest distance of the centroids of the same section, in polar radii of gyration.
const CENTRED: f64 = 0.05;

impl<'a> BeamOverlap<'a> {
    /// The overlap of a beam and a solid in a region: a box, cells of either model, or all that the axis has in the solid.
    ///
    /// Errors: no cells, or unfit ones; no solid around the axis; an axis that bends there; a solid that ends outside S; S with two
    /// ends of one model; S shorter than a cell; sections that differ.
    pub fn new(models: BeamModels<'a>, region: &Region) -> Result<BeamOverlap<'a>, Error> {
        check(&models)?;
        let reach = REACH * radius(&models.beam[0]);
        let runs = runs::straight(&models, reach, region)?;
        let mut overlap = BeamOverlap {
            models,
            parts: Vec::new(),
            kept: Vec::new(),
            cells: Vec::new(),
            removed: Vec::new(),
            sizes: [0.0; 2],
            runs,
        };
        overlap.take_parts()?;
        overlap.measure_sizes();
        overlap.place_stations()?;
        overlap.remove();
        overlap.check_sections()?;
        Ok(overlap)
    }

    /// Finds the parts of S on each run, with their cells.
    fn take_parts(&mut self) -> Result<(), Error> {
        for (number, run) in self.runs.iter().enumerate() {
            for span in &run.spans {
                let Span::Shared { from, to } = *span else {
                    continue;
                };
                let range = [from.min(to), from.max(to)];
                let within = |&(_, own): &&(usize, [f64; 2])| {
                    let thin = NOTHING * (own[1] - own[0]);
                    common(*own, range).is_some_and(|[a, b]| b - a > thin)
                };
                let solid = run.solid.iter().filter(within);
                self.parts.push(Part {
                    run: number,
                    from,
                    to,
                    solid: solid.map(|&(cell, _)| cell).collect(),
                    stations: Vec::new(),
                });
            }
        }
        match self.parts.is_empty() {
            true => Err(Error::Empty),
            false => Ok(()),
        }
    }

    fn measure_sizes(&mut self) {
        let mut sums = [[0.0; 2]; 2];
        for part in &self.parts {
            let run = &self.runs[part.run];
            for (cell, own) in &run.solid {
                if part.solid.binary_search(cell).is_ok() {
                    sums[0][0] += own[1] - own[0];
                    sums[0][1] += 1.0;
                }
            }
            for &(element, _) in &run.elements {
                let own = run.range_of(element);
                if common(own, part.range()).is_some() {
                    sums[1][0] += own[1] - own[0];
                    sums[1][1] += 1.0;
                }
            }
        }
        self.sizes = sums.map(|[length, count]| length / count);
    }

    /// Chooses the nodes of the mediator in each part.
    fn place_stations(&mut self) -> Result<(), Error> {
        let coarser = self.coarser();
        for k in 0..self.parts.len() {
            let part = &self.parts[k];
            let run = &self.runs[part.run];
            let layers = (part.to - part.from).abs() / coarser;
            if layers < 1.0 - 1e-6 {
                return Err(Error::Short {
                    layers,
                    cells: self.beam_in(part),
                });
            }
            self.parts[k].stations =
                stations(self.models.mesh, run, part, self.models.beam, coarser);
        }
        Ok(())
    }

    fn beam_in(&self, part: &Part) -> Vec<ElementId> {
        let run = &self.runs[part.run];
        let elements = run.elements.iter().map(|&(element, _)| element);
        let inside = elements.filter(|&e| common(run.range_of(e), part.range()).is_some());
        inside.map(|e| self.models.beam[e].cell).collect()
    }

    /// Takes away the elements that lie in the solid outside S.
    fn remove(&mut self) {
        let mut gone = vec![false; self.models.beam.len()];
        for run in &self.runs {
            for &(element, _) in &run.elements {
                let [a, b] = run.range_of(element);
                let inside = run.spans.iter().filter_map(|span| match span {
                    Span::Covered(range) => common(*range, [a, b]),
                    Span::Shared { .. } => None,
                });
                let covered: f64 = inside.map(|[a, b]| b - a).sum();
                gone[element] = covered >= (1.0 - NOTHING) * (b - a);
            }
        }
        for (element, cell) in self.models.beam.iter().enumerate() {
            match gone[element] {
                true => self.removed.push(cell.cell),
                false => {
                    self.kept.push(element);
                    self.cells.push(cell.cell);
                }
            }
        }
    }
}

impl BeamOverlap<'_> {
    /// Compares the sections of the solid with those of the beam, between the nodes of the mediator.
    fn check_sections(&self) -> Result<(), Error> {
        for part in &self.parts {
            let run = &self.runs[part.run];
            let Some(&(first, _)) = run.elements.first() else {
                continue;
            };
            let beam = &self.models.beam[first];
            let radius = radius(beam);
            let cuts = slabs::cuts(part.range(), part.stations.iter().map(|s| s.1));
            let moments = self.moments(part, &cuts)?;
            for (between, sum) in cuts.windows(2).zip(moments) {
                let length = between[1] - between[0];
                let area = sum.area / length;
                let refused = |(what, unit), found, expected| Error::Section {
                    what,
                    unit,
                    found,
                    expected,
                    cells: part.solid.iter().map(|&c| self.models.solid[c]).collect(),
                };
                if (area / beam.area - 1.0).abs() > SAME[0] {
                    return Err(refused(("area", "m²"), area, beam.area));
                }
                let beside = dot(&sum.first, &sum.first).sqrt() / sum.area;
                if beside > CENTRED * radius {
                    return Err(refused(("distance of the centroid", "m"), beside, 0.0));
                }
                for i in 0..self.models.mesh.dim {
                    let (found, expected) = (sum.second[i] / length, beam.second_moment[i][i]);
                    if (found - expected).abs() > SAME[1] * radius * radius * beam.area {
                        return Err(refused(("second moment", "m⁴"), found, expected));
                    }
                }
            }
        }
        Ok(())
    }
}
