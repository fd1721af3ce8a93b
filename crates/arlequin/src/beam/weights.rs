//! Weights of a beam and a solid along the axis.

use carom_elements::MAX_NODES;

use super::model::common;
use super::overlap::BeamOverlap;
use super::runs::{Run, Span};
use super::slabs::{Rules, cuts};
use crate::error::{Error, Model};
use crate::weights::{CellWeights, Profile, Sums, Warning, Weighting, Weights, flatten};

/// Gauss's points on [0, 1] and weights: exact to degree 7.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl BeamOverlap<'_> {
    /// The weights of both models, those of the beam at the two ends of each element that stays.
    ///
    /// Weights of cells in which S ends are projected on their shape functions, so that ∫ w N_a is kept.
    /// Errors: a constant outside (0, 1), or with nearly all on the outer model; a floor outside [0, 0.5).
    pub fn weights(&self, weighting: &Weighting) -> Result<Weights, Error> {
        weighting.check()?;
        let mut flattened = Vec::new();
        let beam = self.beam_weights(weighting, &mut flattened);
        let solid = self.solid_weights(weighting, &mut flattened)?;
        let mut warnings = Vec::new();
        if weighting.stiffness != Profile::Linear || weighting.floor > 0.0 {
            warnings.push(Warning::NotPatchExact);
        }
        let (inner, outer) = match self.models.beam_is {
            Model::Inner => (beam, solid),
            Model::Outer => (solid, beam),
        };
        Ok(Weights {
            inner,
            outer,
            warnings,
            flattened,
        })
    }

    /// Weights (α, δ) of the beam at a place of a part from where the solid ends to where the beam ends.
    fn in_part(&self, weighting: &Weighting, [from, to]: [f64; 2], s: f64) -> [f64; 2] {
        // from the end of the solid, which is that of the inner model if the beam is the outer one
        let along = (s - from) / (to - from);
        [weighting.inertia, weighting.stiffness].map(|profile| match self.models.beam_is {
            Model::Outer => 1.0 - profile.value(along, weighting.floor),
            Model::Inner => profile.value(1.0 - along, weighting.floor),
        })
    }

    /// 1 - w of the beam at the two ends of an element, w projected on linear functions.
    fn projected(&self, run: &Run, ends: [f64; 2], weighting: &Weighting) -> [[f64; 2]; 2] {
        let own = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let mut sums = [[0.0; 2]; 2];
        for span in &run.spans {
            let range = match *span {
                Span::Shared { from, to } => [from.min(to), from.max(to)],
                Span::Covered(range) => range,
            };
            let Some([a, b]) = common(range, own) else {
                continue;
            };
            for (t, weight) in GAUSS {
                let s = a + t * (b - a);
                let rest = match *span {
                    Span::Shared { from, to } => {
                        self.in_part(weighting, [from, to], s).map(|w| 1.0 - w)
                    }
                    Span::Covered(_) => [1.0; 2],
                };
                let xi = (s - ends[0]) / (ends[1] - ends[0]);
                let part = weight * (b - a) / (own[1] - own[0]);
                for (sum, rest) in sums.iter_mut().zip(rest) {
                    sum[0] += part * rest * (1.0 - xi);
                    sum[1] += part * rest * xi;
                }
            }
        }
        // the inverse of [1/3, 1/6; 1/6, 1/3]
        sums.map(|[a, b]| [4.0 * a - 2.0 * b, 4.0 * b - 2.0 * a])
    }

    fn beam_weights(
        &self,
        weighting: &Weighting,
        flattened: &mut Vec<carom_mesh::ElementId>,
    ) -> CellWeights {
        let count = self.models.beam.len();
        let mut all = vec![[[1.0; 2]; 2]; count];
        for run in &self.runs {
            for &(element, ends) in &run.elements {
                for (to, rest) in all[element]
                    .iter_mut()
                    .zip(self.projected(run, ends, weighting))
                {
                    let values = rest.map(|rest| 1.0 - rest);
                    let least = values[0].min(values[1]);
                    *to = values.map(|w| w.max(0.0));
                    if least < -1e-12 {
                        // towards the mean, which is kept
                        let mean = 0.5 * (values[0] + values[1]);
                        let factor = mean.max(0.0) / (mean.max(0.0) - least);
                        *to = values.map(|w| (mean + factor * (w - mean)).max(0.0));
                        flattened.push(self.models.beam[element].cell);
                    }
                }
            }
        }
        let values = |which: usize| self.kept.iter().flat_map(|&e| all[e][which]).collect();
        CellWeights {
            inertia: values(0),
            stiffness: values(1),
        }
    }

    fn solid_weights(
        &self,
        weighting: &Weighting,
        flattened: &mut Vec<carom_mesh::ElementId>,
    ) -> Result<CellWeights, Error> {
        let mut touched: Vec<Option<usize>> = vec![None; self.models.solid.len()];
        for (number, part) in self.parts.iter().enumerate() {
            part.solid.iter().for_each(|&c| touched[c] = Some(number));
        }
        let (mut inertia, mut stiffness) = (Vec::new(), Vec::new());
        for (place, part) in touched.iter().enumerate() {
            let Some(part) = part else {
                let nodes = self.models.mesh.kind(self.models.solid[place]);
                let ones = std::iter::repeat_n(1.0, nodes.table().nodes);
                inertia.extend(ones.clone());
                stiffness.extend(ones);
                continue;
            };
            let cell = self.solid(place);
            let nodes = cell.x().len();
            let [mut alpha, mut delta] = self.solid_weight(place, *part, weighting)?;
            let flat = [
                flatten(&cell, &mut alpha[..nodes], cell.kind.table().mass_rule),
                flatten(
                    &cell,
                    &mut delta[..nodes],
                    cell.kind.table().weighted_stiffness_rule(),
                ),
            ];
            if flat.contains(&true) {
                flattened.push(self.models.solid[place]);
            }
            inertia.extend_from_slice(&alpha[..nodes]);
            stiffness.extend_from_slice(&delta[..nodes]);
        }
        Ok(CellWeights { inertia, stiffness })
    }

    /// Nodal values of both weights of a cell in a part: those at its nodes where the weight is linear in it, else a projection.
    fn solid_weight(
        &self,
        place: usize,
        part: usize,
        weighting: &Weighting,
    ) -> Result<[[f64; MAX_NODES]; 2], Error> {
        let part = &self.parts[part];
        let run = &self.runs[part.run];
        let (cell, range) = (self.solid(place), part.range());
        let weight = |s: f64| self.in_part(weighting, [part.from, part.to], s);
        let near = 1e-9 * (range[1] - range[0]);
        let places = cell.x().iter().map(|x| run.place(x));
        let linear = weighting.degree() <= 1;
        if linear
            && places
                .clone()
                .all(|s| s >= range[0] - near && s <= range[1] + near)
        {
            let mut values = [[0.0; MAX_NODES]; 2];
            for (a, s) in places.enumerate() {
                let beam = weight(s.clamp(range[0], range[1]));
                (0..2).for_each(|k| values[k][a] = 1.0 - beam[k]);
            }
            return Ok(values);
        }
        let degree = cell.degree();
        let mut rules = Rules::new((2 * degree).max(degree + weighting.degree()));
        let mut points = Vec::new();
        let mut sums = Sums::new(cell.x().len());
        let outside = [range[0] - 2.0 * cell.size, range[1] + 2.0 * cell.size];
        let cuts = cuts(outside, range.into_iter());
        self.points((place, run), &cuts, &mut rules, &mut points)?;
        for point in &points {
            if point.interval == 1 {
                sums.add(&cell, &point.xi, point.weight, weight(point.s));
            }
            sums.add_mass(&cell, &point.xi, point.weight);
        }
        Ok(sums.solve())
    }
}
