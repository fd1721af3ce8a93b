//! How inertia and internal work are shared between two overlapping models.
//!
//! With d_i the distance to the border of S where the inner model ends and d_o to that where the outer one ends,
//! s = d_i/(d_i + d_o) goes from 0 to 1, and the weight of the inner model is w_i = w(s) on S, 1 elsewhere; that of the
//! outer model is w_o = 1 - w_i on S, 0 in the inner model outside S, 1 elsewhere. The two add up to one wherever a model
//! is. Each is given cell by cell as its L2 projection on the shape functions of the cell, integrated on the common
//! refinement: ∫ w N_a is that of the weight itself.

use carom_elements::{Element, MAX_NODES};
use carom_mesh::{ElementId, Mesh};

use crate::cell::Cell;
use crate::error::{Error, Model};
use crate::overlap::Overlap;
use crate::refine::{Part, Point, Rules};

/// Least constant weight of the inner model: below, nearly all is on the outer one, which reflects waves.
const LEAST_INNER: f64 = 0.05;
/// Degree of the rule for weights that are no polynomials (borders that are not plane).
const CURVED_DEGREE: usize = 6;

/// How the weight of the inner model goes from border to border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Profile {
    /// This value in all of S. For the stiffness it fails the patch test: a control, not a choice.
    Constant(f64),
    /// w = s, the default: affine on a strip, the only one that passes the patch test.
    Linear,
    /// w = 3s² - 2s³.
    Smooth,
}

/// The choice of weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighting {
    /// Profile of the weight α of the inertia.
    pub inertia: Profile,
    /// Profile of the weight δ of the internal work.
    pub stiffness: Profile,
    /// Least weight φ of either model in S, 0 <= φ < 0.5: w = φ + (1 - 2φ) w(s) for the profiles that vary. Above zero
    /// the weights jump at the borders, and constant strains are missed by about as much.
    pub floor: f64,
}

impl Default for Weighting {
    fn default() -> Weighting {
        Weighting {
            inertia: Profile::Linear,
            stiffness: Profile::Linear,
            floor: 0.0,
        }
    }
}

/// Weights of the cells of one model: for each cell in the order of [`Overlap::cells`] one value per node, in the node
/// order of its kind. Inside a cell the weight is Σ_a w_a N_a; it is not continuous from cell to cell. Values at nodes
/// may be slightly negative or above one; at the points of the kind's mass rule (α) and stiffness rule (δ) they are not
/// negative.
#[derive(Clone, Debug, PartialEq)]
pub struct CellWeights {
    /// α, dimensionless.
    pub inertia: Vec<f64>,
    /// δ, dimensionless.
    pub stiffness: Vec<f64>,
}

/// What is doubtful about weights that can be used all the same.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// The stiffness weights are not affine on S, so a field of constant strain is not reproduced. With the coarse
    /// mediator and a ratio of cell sizes of 4 the strain errs by 63 % for constant weights, by 15 % for smooth ones
    /// (1D); linear weights err only where a border turns a corner, and less the finer the outer mesh.
    NotPatchExact,
    /// The critical step of a model falls below half of its own: least √(∫α/∫δ) over its cells.
    SmallStep {
        /// The model.
        model: Model,
        /// Factor on the critical step of its weakest cell, estimated from the mean weights.
        factor: f64,
    },
}

/// Weights of both models.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    /// Of the inner model.
    pub inner: CellWeights,
    /// Of the outer model, for the cells that stay.
    pub outer: CellWeights,
    /// What is doubtful about them.
    pub warnings: Vec<Warning>,
    /// Cells whose projection went below zero at an integration point of masses or stiffness and was flattened towards
    /// its mean: there ∫ w is kept, ∫ w N_a is not. This happens where a border of S cuts cells of the model that ends
    /// there, and leaves them little of it.
    pub flattened: Vec<ElementId>,
}

/// Mean weight of each cell, ∫ w / |cell|, for pictures.
///
/// `values`: as in [`CellWeights`], for these cells.
pub fn means(mesh: &Mesh, cells: &[ElementId], values: &[f64]) -> Vec<f64> {
    let mut rest = values;
    let mean = |&id: &ElementId| {
        let (here, after) = rest.split_at(mesh.kind(id).table().nodes);
        rest = after;
        mean(&Cell::new(mesh, id), here)
    };
    cells.iter().map(mean).collect()
}

impl Overlap<'_> {
    /// The weights of both models.
    ///
    /// Errors: a constant outside (0, 1), or with nearly all on the outer model; a floor outside [0, 0.5); a varying
    /// profile where a model does not end in S.
    pub fn weights(&self, weighting: &Weighting) -> Result<Weights, Error> {
        weighting.check()?;
        let profiles = [weighting.inertia, weighting.stiffness];
        if profiles.iter().any(|p| !matches!(p, Profile::Constant(_))) {
            self.refuse_missing_border()?;
        }
        let mut flattened = Vec::new();
        let inner = self.weights_of(Model::Inner, weighting, &mut flattened)?;
        let outer = self.weights_of(Model::Outer, weighting, &mut flattened)?;
        let mut warnings = Vec::new();
        if weighting.stiffness != Profile::Linear || weighting.floor > 0.0 || !self.is_strip() {
            warnings.push(Warning::NotPatchExact);
        }
        for (model, weights) in [(Model::Inner, &inner), (Model::Outer, &outer)] {
            let factor = self.step_factor(model, weights);
            if factor < 0.5 {
                warnings.push(Warning::SmallStep { model, factor });
            }
        }
        Ok(Weights {
            inner,
            outer,
            warnings,
            flattened,
        })
    }

    fn refuse_missing_border(&self) -> Result<(), Error> {
        for borders in &self.parts {
            let ends = [&borders.inner_end, &borders.outer_end];
            for (model, end) in [Model::Inner, Model::Outer].into_iter().zip(ends) {
                if end.is_none() {
                    return Err(Error::NoBorder { model });
                }
            }
        }
        Ok(())
    }

    fn weights_of(
        &self,
        model: Model,
        weighting: &Weighting,
        flattened: &mut Vec<ElementId>,
    ) -> Result<CellWeights, Error> {
        let side = self.side(model);
        let dim = self.mesh().dim;
        let both = [Model::Inner, Model::Outer];
        let kinds = both.iter().flat_map(|&m| self.cells(m));
        let kinds = kinds.map(|&id| self.mesh().kind(id).table());
        let largest = kinds.clone().map(|kind| kind.degree).fold(1, usize::max);
        let profile = match self.is_strip() {
            true => weighting.degree(),
            false => CURVED_DEGREE,
        };
        let along = kinds.map(degree_along).fold(1, usize::max);
        let degree = largest + profile.max(largest);
        let rules = Rules::new(dim, degree, along + profile.max(along));
        let mut weights = CellWeights {
            inertia: Vec::new(),
            stiffness: Vec::new(),
        };
        let mut hints = [0; 2];
        for i in 0..side.len() {
            let cell = side.cell(i);
            let nodes = cell.x().len();
            let values = match self.pieces_of(model, i).next() {
                None => [[1.0; MAX_NODES]; 2],
                Some(_) => self.project(model, i, weighting, &rules, &mut hints)?,
            };
            let (mut alpha, mut delta) = (values[0], values[1]);
            let flat = [
                flatten(&cell, &mut alpha[..nodes], cell.kind.table().mass_rule),
                flatten(
                    &cell,
                    &mut delta[..nodes],
                    cell.kind.table().weighted_stiffness_rule(),
                ),
            ];
            if flat.contains(&true) {
                flattened.push(side.ids[i]);
            }
            weights.inertia.extend_from_slice(&alpha[..nodes]);
            weights.stiffness.extend_from_slice(&delta[..nodes]);
        }
        Ok(weights)
    }

    /// Projection of both weights on the shape functions of a cell. What is projected is 1 - w, which is zero where no
    /// piece is; the mass matrix comes from the pieces where these fill the cell, so that an affine weight is
    /// reproduced whatever the shape of the cell.
    fn project(
        &self,
        model: Model,
        i: usize,
        weighting: &Weighting,
        rules: &Rules,
        hints: &mut [usize; 2],
    ) -> Result<[[f64; MAX_NODES]; 2], Error> {
        let side = self.side(model);
        let cell = side.cell(i);
        let mut sums = Sums::new(cell.x().len());
        let mut points = Vec::new();
        for p in self.pieces_of(model, i) {
            let piece = &self.refinement.pieces[p];
            if model == Model::Outer {
                // The outer model has no weight in the inner one outside S: all that is common, less S.
                self.refinement
                    .points(piece, Part::Common, rules, &mut points)?;
                for point in &points {
                    sums.add(&cell, &point.outer, point.weight, [1.0; 2]);
                }
            }
            if piece.measure == 0.0 {
                continue;
            }
            self.refinement
                .points(piece, Part::Overlap, rules, &mut points)?;
            for point in &points {
                let inner = self.inner_weights(p, point, weighting, hints);
                let (xi, rest) = match model {
                    Model::Inner => (&point.inner, inner.map(|w| 1.0 - w)),
                    Model::Outer => (&point.outer, inner.map(|w| w - 1.0)),
                };
                sums.add(&cell, xi, point.weight, rest);
                sums.add_mass(&cell, xi, point.weight);
            }
        }
        let filled = self.measure_in(model, i) >= (1.0 - 1e-9) * side.measures[i];
        if !filled {
            sums.mass = [[0.0; MAX_NODES]; MAX_NODES];
            for (xi, weight) in cell.points(rules.of_cell(&cell, cell.is_affine())) {
                sums.add_mass(&cell, &xi, weight);
            }
        }
        Ok(sums.solve())
    }

    /// Weights (α, δ) of the inner model at a point of a piece in S.
    fn inner_weights(
        &self,
        piece: usize,
        point: &Point,
        weighting: &Weighting,
        hints: &mut [usize; 2],
    ) -> [f64; 2] {
        let borders = &self.parts[self.part_of[piece] as usize];
        let s = match (&borders.inner_end, &borders.outer_end) {
            (Some(inner_end), Some(outer_end)) => {
                let (d_i, d_o) = (
                    inner_end.distance(&point.x, &mut hints[0]),
                    outer_end.distance(&point.x, &mut hints[1]),
                );
                d_i / (d_i + d_o).max(f64::MIN_POSITIVE)
            }
            // Only constant profiles get here, and they do not ask.
            _ => 0.5,
        };
        [weighting.inertia, weighting.stiffness].map(|profile| profile.value(s, weighting.floor))
    }

    fn step_factor(&self, model: Model, weights: &CellWeights) -> f64 {
        let cells = self.cells(model);
        let alpha = means(self.mesh(), cells, &weights.inertia);
        let delta = means(self.mesh(), cells, &weights.stiffness);
        let ratio = alpha.iter().zip(&delta).map(|(a, d)| a / d);
        ratio.fold(1.0, f64::min).max(0.0).sqrt()
    }
}

/// Degree of the shape functions of a kind in each reference coordinate.
pub(crate) fn degree_along(kind: &Element) -> usize {
    1 + usize::from(kind.is_quadratic())
}

impl Profile {
    pub(crate) fn value(self, s: f64, floor: f64) -> f64 {
        let rise = match self {
            Profile::Constant(value) => return value,
            Profile::Linear => s,
            Profile::Smooth => s * s * (3.0 - 2.0 * s),
        };
        floor + (1.0 - 2.0 * floor) * rise
    }
}

impl Weighting {
    pub(crate) fn check(&self) -> Result<(), Error> {
        if !(0.0..0.5).contains(&self.floor) {
            return Err(Error::Range {
                what: "the floor of the weights",
                value: self.floor,
                from: 0.0,
                to: 0.5,
            });
        }
        for profile in [self.inertia, self.stiffness] {
            let Profile::Constant(inner) = profile else {
                continue;
            };
            if !(inner > 0.0 && inner < 1.0) {
                return Err(Error::Range {
                    what: "a constant weight",
                    value: inner,
                    from: 0.0,
                    to: 1.0,
                });
            }
            if inner < LEAST_INNER {
                return Err(Error::Reflects { inner });
            }
        }
        Ok(())
    }

    /// Degree of the weights on a strip.
    pub(crate) fn degree(&self) -> usize {
        let degree = |profile: Profile| match profile {
            Profile::Constant(_) => 0,
            Profile::Linear => 1,
            Profile::Smooth => 3,
        };
        degree(self.inertia).max(degree(self.stiffness))
    }
}

/// Integrals over one cell: of N_a N_b, and of both 1 - w times N_a.
pub(crate) struct Sums {
    nodes: usize,
    mass: [[f64; MAX_NODES]; MAX_NODES],
    rest: [[f64; MAX_NODES]; 2],
}

impl Sums {
    pub fn new(nodes: usize) -> Sums {
        Sums {
            nodes,
            mass: [[0.0; MAX_NODES]; MAX_NODES],
            rest: [[0.0; MAX_NODES]; 2],
        }
    }

    pub fn add(&mut self, cell: &Cell, xi: &[f64; 3], weight: f64, values: [f64; 2]) {
        let mut n = [0.0; MAX_NODES];
        for (a, n) in cell.shape(xi, &mut n).iter().enumerate() {
            self.rest[0][a] += weight * n * values[0];
            self.rest[1][a] += weight * n * values[1];
        }
    }

    pub fn add_mass(&mut self, cell: &Cell, xi: &[f64; 3], weight: f64) {
        let mut n = [0.0; MAX_NODES];
        let n = cell.shape(xi, &mut n);
        for a in 0..n.len() {
            for b in 0..n.len() {
                self.mass[a][b] += weight * n[a] * n[b];
            }
        }
    }

    /// Nodal values of both weights: 1 - M⁻¹ ∫ (1 - w) N.
    pub fn solve(mut self) -> [[f64; MAX_NODES]; 2] {
        let (n, m) = (self.nodes, &mut self.mass);
        // Gauss elimination without pivoting: a mass matrix is positive definite and well conditioned.
        for k in 0..n {
            for i in k + 1..n {
                let factor = m[i][k] / m[k][k];
                (k..n).for_each(|j| m[i][j] -= factor * m[k][j]);
                self.rest.iter_mut().for_each(|r| r[i] -= factor * r[k]);
            }
        }
        for r in &mut self.rest {
            for i in (0..n).rev() {
                let known: f64 = (i + 1..n).map(|j| m[i][j] * r[j]).sum();
                r[i] = (r[i] - known) / m[i][i];
            }
        }
        self.rest.map(|r| r.map(|rest| 1.0 - rest))
    }
}

/// Shrinks the weight of a cell towards its mean until it is not negative at the points of a rule, where masses and
/// stiffness take it. Returns whether it was. The mean is kept.
pub(crate) fn flatten(cell: &Cell, values: &mut [f64], rule: &carom_elements::Rule) -> bool {
    let mean = mean(cell, values);
    let least = rule.points.iter().fold(f64::MAX, |least, xi| {
        let mut n = [0.0; MAX_NODES];
        let n = cell.shape(xi, &mut n);
        least.min(n.iter().zip(&*values).map(|(n, w)| n * w).sum())
    });
    // Round-off of zero weights is no reason.
    if least >= -1e-12 {
        return false;
    }
    let factor = mean.max(0.0) / (mean.max(0.0) - least);
    for w in values {
        *w = mean + factor * (*w - mean);
    }
    true
}

/// ∫ w / |cell| of a weight given at the nodes.
pub(crate) fn mean(cell: &Cell, values: &[f64]) -> f64 {
    let rule = cell.kind.table().mass_rule;
    let mut sum = 0.0;
    for (xi, w) in rule.points.iter().zip(rule.weights) {
        let mut n = [0.0; MAX_NODES];
        let n = cell.shape(xi, &mut n);
        let here: f64 = n.iter().zip(values).map(|(n, w)| n * w).sum();
        sum += w * cell.jacobian(xi).1 * here;
    }
    sum / cell.measure()
}
