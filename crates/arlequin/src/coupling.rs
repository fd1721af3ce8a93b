//! Mediator, bracket, and the assembly of the rows.
//!
//! <L, w>_S = ∫_S (L·w + κ² ε(L):ε(w)). For the mediator function N_A e_k and the shape function N_b e_l the second term
//! is κ²/2 (δ_kl ∇N_A·∇N_b + ∂_l N_A ∂_k N_b).

use std::collections::BTreeMap;

use carom_elements::MAX_NODES;

use crate::cell::Cell;
use crate::error::{Error, Model};
use crate::overlap::Overlap;
use crate::polytope::dot;
use crate::refine::{Part, Point, Rules};
use crate::rows::{Row, Rows, Sliver, Term};

/// Whose shape functions, restricted to S, carry the multiplier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mediator {
    /// The model with the larger cells in S: the default. A finer one locks the fine field and reflects short waves.
    Coarser,
    /// This model.
    Of(Model),
}

/// The product of a multiplier and a velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bracket {
    /// ∫ L·w. Needs continuous weights.
    L2,
    /// ∫ (L·w + κ² ε(L):ε(w)).
    H1 {
        /// κ in m; `None` for the size of the outer cells in S.
        kappa: Option<f64>,
    },
}

/// On which mesh the products are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integration {
    /// On the pieces common to a cell of each: exact on affine cells.
    CommonRefinement,
    /// At the points of each inner cell: a control, which fails the patch test on meshes that are not nested.
    InnerOnly,
    /// At the points of each outer cell: a control, which fails the patch test.
    OuterOnly,
}

/// What happens to mediator functions with a sliver of support in S.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SliverRule {
    /// Added to the neighbour with the most support: the space keeps the constants, which the patch test needs.
    Merge,
    /// Dropped.
    Drop,
}

/// The choice of mediator, bracket and integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// The mediator.
    pub mediator: Mediator,
    /// The bracket.
    pub bracket: Bracket,
    /// The integration.
    pub integration: Integration,
    /// Fraction of its support below which a mediator function is a sliver.
    pub sliver: f64,
    /// What happens to slivers.
    pub slivers: SliverRule,
}

impl Default for Coupling {
    fn default() -> Coupling {
        Coupling {
            mediator: Mediator::Coarser,
            bracket: Bracket::L2,
            integration: Integration::CommonRefinement,
            sliver: 0.02,
            slivers: SliverRule::Merge,
        }
    }
}

impl Overlap<'_> {
    /// The rows of the coupling condition, one per mediator function and component.
    ///
    /// Errors: κ negative or not finite; a sliver fraction outside [0, 1]; no mediator function left; a distorted cell that cannot be inverted.
    pub fn rows(&self, coupling: &Coupling) -> Result<Rows, Error> {
        let model = match coupling.mediator {
            Mediator::Coarser => self.coarser(),
            Mediator::Of(model) => model,
        };
        let kappa = match coupling.bracket {
            Bracket::L2 => None,
            Bracket::H1 { kappa } => Some(kappa.unwrap_or_else(|| self.size(Model::Outer))),
        };
        in_range("kappa", kappa.unwrap_or(0.0), f64::MAX)?;
        in_range("the fraction of a sliver", coupling.sliver, 1.0)?;
        let supports = self.supports(model);
        let slivers = self.slivers(model, &supports, coupling);
        let mut assembly = Assembly::new(self, model, kappa, &supports, &slivers);
        if assembly.nodes.is_empty() {
            return Err(Error::NoMediator);
        }
        self.sample(coupling.integration, |inner, outer, points| {
            assembly.add(inner, outer, points);
        })?;
        Ok(Rows {
            rows: assembly.finish(),
            slivers,
        })
    }

    /// Nodes of a model that S touches, with the fraction of their support in S.
    fn supports(&self, model: Model) -> BTreeMap<u32, f64> {
        let side = self.side(model);
        let mut sums: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
        for i in 0..side.len() {
            let inside = self.measure_in(model, i);
            for &node in side.nodes(i) {
                let sum = sums.entry(node).or_default();
                sum[0] += inside;
                sum[1] += side.measures[i];
            }
        }
        let fractions = sums.into_iter().map(|(node, [s, all])| (node, s / all));
        fractions.filter(|(_, fraction)| *fraction > 0.0).collect()
    }

    /// The functions with a sliver of support, and who takes them over.
    fn slivers(
        &self,
        model: Model,
        supports: &BTreeMap<u32, f64>,
        coupling: &Coupling,
    ) -> Vec<Sliver> {
        let thin = |node: &u32| supports.get(node).is_none_or(|&f| f < coupling.sliver);
        let mut best: BTreeMap<u32, u32> = BTreeMap::new();
        let side = self.side(model);
        for i in 0..side.len() {
            let nodes = side.nodes(i);
            for &node in nodes.iter().filter(|n| supports.contains_key(n) && thin(n)) {
                for &other in nodes.iter().filter(|n| !thin(n)) {
                    let taker = best.entry(node).or_insert(other);
                    if supports[&other] > supports[&*taker] {
                        *taker = other;
                    }
                }
            }
        }
        let sliver = |(&node, &fraction): (&u32, &f64)| Sliver {
            node,
            fraction,
            into: match coupling.slivers {
                SliverRule::Merge => best.get(&node).copied(),
                SliverRule::Drop => None,
            },
        };
        let slivers = supports.iter().filter(|(node, _)| thin(node));
        slivers.map(sliver).collect()
    }

    /// Hands out quadrature points, those of one inner and one outer cell together.
    fn sample(
        &self,
        integration: Integration,
        mut each: impl FnMut(usize, usize, &[Point]),
    ) -> Result<(), Error> {
        match integration {
            Integration::CommonRefinement => {
                let models = [Model::Inner, Model::Outer];
                let ids = models.iter().flat_map(|&m| self.cells(m));
                let degrees = ids.map(|&id| self.mesh().kind(id).table().degree);
                let rules = Rules::new(self.mesh().dim, 2 * degrees.fold(1, usize::max), 2);
                let mut points = Vec::new();
                for piece in self.refinement.pieces.iter().filter(|p| p.measure > 0.0) {
                    self.refinement
                        .points(piece, Part::Overlap, &rules, &mut points)?;
                    each(piece.inner as usize, piece.outer as usize, &points);
                }
            }
            Integration::InnerOnly => self.sample_one(Model::Inner, each),
            Integration::OuterOnly => self.sample_one(Model::Outer, each),
        }
        Ok(())
    }

    /// The points of the mass rule of each cell of one model, where S has them.
    fn sample_one(&self, model: Model, mut each: impl FnMut(usize, usize, &[Point])) {
        let side = self.side(model);
        for i in 0..side.len() {
            let cell = side.cell(i);
            let rule = cell.kind.table().mass_rule;
            for (xi, w) in rule.points.iter().zip(rule.weights) {
                let x = cell.point(xi);
                let found = self.pieces_of(model, i).find_map(|p| {
                    let piece = &self.refinement.pieces[p];
                    let (inner, outer) = (piece.inner as usize, piece.outer as usize);
                    let other = match model {
                        Model::Inner => self.refinement.outer.cell(outer),
                        Model::Outer => self.refinement.inner.cell(inner),
                    };
                    let sides = &self.refinement.sides;
                    let counts = piece.measure > 0.0 && sides.iter().all(|s| s.distance(&x) <= 0.0);
                    (counts && other.contains(&x)).then(|| (inner, outer, other.reference(&x)))
                });
                if let Some((inner, outer, Some(other))) = found {
                    let (at_inner, at_outer) = match model {
                        Model::Inner => (*xi, other),
                        Model::Outer => (other, *xi),
                    };
                    let point = Point {
                        x,
                        weight: w * cell.jacobian(xi).1,
                        inner: at_inner,
                        outer: at_outer,
                    };
                    each(inner, outer, &[point]);
                }
            }
        }
    }
}

/// Refuses a value that is negative, not a number, or above a bound.
pub(crate) fn in_range(what: &'static str, value: f64, to: f64) -> Result<(), Error> {
    match (0.0..=to).contains(&value) {
        true => Ok(()),
        false => Err(Error::Range {
            what,
            value,
            from: 0.0,
            to,
        }),
    }
}

/// Rows in the making. With the L2 bracket all components have the same coefficients and are summed once.
struct Assembly<'a> {
    overlap: &'a Overlap<'a>,
    model: Model,
    kappa: Option<f64>,
    /// Mediator nodes, ascending.
    nodes: Vec<u32>,
    /// Row of a node of the model; `u32::MAX` without one.
    row_of: Vec<u32>,
    /// Rows of both models; keys are nodes, or node times dim plus component.
    sums: [Vec<Sum>; 2],
    /// Components summed apart: 1 for L2.
    components: usize,
}

impl<'a> Assembly<'a> {
    fn new(
        overlap: &'a Overlap<'a>,
        model: Model,
        kappa: Option<f64>,
        supports: &BTreeMap<u32, f64>,
        slivers: &[Sliver],
    ) -> Assembly<'a> {
        let thin: BTreeMap<u32, Option<u32>> = slivers.iter().map(|s| (s.node, s.into)).collect();
        let own = supports.keys().filter(|node| !thin.contains_key(node));
        let nodes: Vec<u32> = own.copied().collect();
        let mut row_of = vec![u32::MAX; overlap.mesh().nodes.len()];
        for (row, &node) in nodes.iter().enumerate() {
            row_of[node as usize] = row as u32;
        }
        for (&node, into) in &thin {
            if let Some(into) = into {
                row_of[node as usize] = row_of[*into as usize];
            }
        }
        let components = if kappa.is_some() {
            overlap.mesh().dim
        } else {
            1
        };
        let sums = || vec![Sum::default(); nodes.len() * components];
        Assembly {
            overlap,
            model,
            kappa,
            row_of,
            sums: [sums(), sums()],
            components,
            nodes,
        }
    }

    /// Adds the points of one inner and one outer cell.
    fn add(&mut self, inner: usize, outer: usize, points: &[Point]) {
        let sides = [Model::Inner, Model::Outer].map(|model| self.overlap.side(model));
        let cells = [sides[0].cell(inner), sides[1].cell(outer)];
        let nodes = [sides[0].nodes(inner), sides[1].nodes(outer)];
        for of in 0..2 {
            let block = self.block(&cells, of, points);
            let c = self.components;
            for (a, &mediator) in nodes[self.model as usize].iter().enumerate() {
                let row = self.row_of[mediator as usize];
                if row == u32::MAX {
                    continue;
                }
                for (b, &node) in nodes[of].iter().enumerate() {
                    for k in 0..c {
                        for l in 0..c {
                            let value = block[((a * MAX_NODES + b) * c + k) * c + l];
                            let key = node * c as u32 + l as u32;
                            self.sums[of][row as usize * c + k].add(key, value);
                        }
                    }
                }
            }
        }
    }

    /// Products <N_A e_k, N_b e_l> over some points, at ((A·MAX_NODES + b)·c + k)·c + l with c components; `of`: 0 for shape functions of the
    /// inner cell, 1 for those of the outer one.
    fn block(&self, cells: &[Cell; 2], of: usize, points: &[Point]) -> Vec<f64> {
        let (mediator, c) = (self.model as usize, self.components);
        let mut block = vec![0.0; c * c * MAX_NODES * MAX_NODES];
        for point in points {
            let xi = [&point.inner, &point.outer];
            let (mut m, mut n) = ([0.0; MAX_NODES], [0.0; MAX_NODES]);
            let m = cells[mediator].shape(xi[mediator], &mut m);
            let n = cells[of].shape(xi[of], &mut n);
            for (a, m) in m.iter().enumerate() {
                for (b, n) in n.iter().enumerate() {
                    let at = (a * MAX_NODES + b) * c * c;
                    (0..c).for_each(|k| block[at + (c + 1) * k] += point.weight * m * n);
                }
            }
            let Some(kappa) = self.kappa else { continue };
            let half = 0.5 * kappa * kappa * point.weight;
            let (mut dm, mut dn) = ([[0.0; 3]; MAX_NODES], [[0.0; 3]; MAX_NODES]);
            let dm = cells[mediator].gradients(xi[mediator], &mut dm);
            let dn = cells[of].gradients(xi[of], &mut dn);
            for (a, dm) in dm.iter().enumerate() {
                for (b, dn) in dn.iter().enumerate() {
                    let at = (a * MAX_NODES + b) * c * c;
                    let both = half * dot(dm, dn);
                    for k in 0..c {
                        block[at + (c + 1) * k] += both;
                        (0..c).for_each(|l| block[at + c * k + l] += half * dm[l] * dn[k]);
                    }
                }
            }
        }
        block
    }

    fn finish(self) -> Vec<Row> {
        let dim = self.overlap.mesh().dim;
        let c = self.components;
        let mut rows = Vec::with_capacity(self.nodes.len() * dim);
        let [mut inner, mut outer] = self.sums;
        for (i, &node) in self.nodes.iter().enumerate() {
            for k in 0..dim {
                // With L2 the one list serves every component.
                let terms = |sums: &mut Vec<Sum>| {
                    let sum = sums[i * c + k.min(c - 1)].sorted();
                    let term = |&(key, coefficient): &(u32, f64)| Term {
                        node: key / c as u32,
                        component: if c == 1 { k as u32 } else { key % c as u32 },
                        coefficient,
                    };
                    sum.iter().map(term).collect::<Vec<Term>>()
                };
                rows.push(Row {
                    node,
                    component: k as u32,
                    inner: terms(&mut inner),
                    outer: terms(&mut outer),
                    ..Row::default()
                });
            }
        }
        rows
    }
}

/// A sparse sum: entries are gathered and put together when they have doubled.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sum {
    entries: Vec<(u32, f64)>,
    limit: usize,
}

impl Sum {
    pub fn add(&mut self, key: u32, value: f64) {
        self.entries.push((key, value));
        if self.entries.len() > self.limit.max(256) {
            self.sorted();
            self.limit = 2 * self.entries.len();
        }
    }

    /// The entries, sorted, each key once.
    pub fn sorted(&mut self) -> &[(u32, f64)] {
        // The sort is stable: equal keys are summed in the order in which they came.
        self.entries.sort_by_key(|entry| entry.0);
        self.entries.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        &self.entries
    }
}
