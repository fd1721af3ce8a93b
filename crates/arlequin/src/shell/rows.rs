//! The rows between a shell and a solid.
//!
//! A row is ⟨μ, x_solid - x_shell⟩, with places: in the frame R_A of the node A of its function,
//!
//! `Σ_n (R_A a_n)·x_n - Σ_B Σ_ac G_ac (R_A e_a)·(R_B e_c)`
//!
//! with the axes e of coordinates. The place of the shell is linear in places and rotations of its nodes, Σ N_B x_B + R_B ((e + z) N_B d_B + w_B). In the
//! deflection R_B w_B that of a rotation about the normal, which membrane strains do not know of, is left out: the skew part of R_Aᵀ R_B across the
//! director of A. For small rotations the row has the coefficients that follow from G.

use std::collections::BTreeMap;

use carom_elements::MAX_NODES;

use super::mediator::{Function, Mediator};
use super::model::{Prisms, ShellCell, ShellModels};
use super::motion::MOST;
use crate::cell::Cell;
use crate::coupling::Sum;
use crate::edge::terms;
use crate::error::{Error, Model};
use crate::faces::unit;
use crate::overlap::Overlap;
use crate::polytope::{cross, dot};
use crate::refine::{Part, Point, Rules};
use crate::rows::{AxisProducts, Row};
use crate::weights::degree_along;

/// Rows of a function of the mediator: three translations and two rotations.
const MODES: usize = 5;

/// A matrix.
type Mat = [[f64; 3]; 3];

/// A row of a function, as it grows.
#[derive(Clone, Default)]
struct Sums {
    solid: Sum,
    shell: Sum,
    /// G of each node of the shell.
    axes: BTreeMap<u32, Mat>,
}

/// The rows of the coupling condition: <μ, v_solid - v_shell> = 0 for each function of the mediator, its translations and then its
/// rotations, these over the radius of gyration h/√12.
pub(super) fn rows(
    models: &ShellModels,
    prisms: &Prisms,
    overlap: &Overlap,
    mediator: &Mediator,
) -> Result<Vec<Row>, Error> {
    let kinds = models.solid.iter().map(|&id| models.mesh.kind(id).table());
    // a shape function times z and one of the shell, and of these and a deflection
    let degree = kinds
        .clone()
        .map(|kind| kind.degree + 3)
        .fold(6, usize::max);
    let along = kinds.map(|kind| degree_along(kind) + 1).fold(3, usize::max);
    let rules = Rules::new(3, degree, along);
    let mut sums = vec![Sums::default(); MODES * mediator.functions.len()];
    let [solid, shell] = [Model::Inner, Model::Outer].map(|model| overlap.side(model));
    let mut points = Vec::new();
    for piece in overlap.refinement.pieces.iter().filter(|p| p.measure > 0.0) {
        let pair = (piece.inner as usize, piece.outer as usize);
        let Some(element) = prisms.element(shell.ids[pair.1]) else {
            continue;
        };
        overlap
            .refinement
            .points(piece, Part::Overlap, &rules, &mut points)?;
        let own = &models.shell[element];
        let products = Products::new(own, &solid.cell(pair.0), &points);
        let nodes = [solid.nodes(pair.0), models.nodes(own)];
        for (a, node) in nodes[1].iter().enumerate() {
            if let Some(&place) = mediator.of_node.get(node) {
                let rows = &mut sums[MODES * place..MODES * (place + 1)];
                products.add(a, &mediator.functions[place], nodes, rows);
            }
        }
    }
    Ok(finish(mediator, sums, models.shell_is))
}

/// Integrals over a piece, for each function A of the shell: ∫ N_A times something.
struct Products {
    /// N_b of the solid, and N_b z d.
    solid: Vec<[f64; MAX_NODES]>,
    solid_arm: Vec<[[f64; 3]; MAX_NODES]>,
    /// N_b of the shell, and N_b z d.
    shell: [[f64; MOST]; MOST],
    shell_arm: [[[f64; 3]; MOST]; MOST],
    /// (e + z) N_b d_b, z d times that, and w_b.
    ends: [[[f64; 3]; MOST]; MOST],
    ends_arm: [[Mat; MOST]; MOST],
    bent: [[[f64; 3]; MOST]; MOST],
}

impl Products {
    fn new(shell: &ShellCell, solid: &Cell, points: &[Point]) -> Products {
        let count = shell.x.len();
        let mut sums = Products {
            solid: vec![[0.0; MAX_NODES]; count],
            solid_arm: vec![[[0.0; 3]; MAX_NODES]; count],
            shell: [[0.0; MOST]; MOST],
            shell_arm: [[[0.0; 3]; MOST]; MOST],
            ends: [[[0.0; 3]; MOST]; MOST],
            ends_arm: [[[[0.0; 3]; 3]; MOST]; MOST],
            bent: [[[0.0; 3]; MOST]; MOST],
        };
        for point in points {
            let motion = shell.motion(&point.outer);
            let mut n = [0.0; MAX_NODES];
            let n = solid.shape(&point.inner, &mut n);
            let arm = &motion.arm;
            for a in 0..count {
                let mediator = point.weight * motion.n[a];
                for (b, n) in n.iter().enumerate() {
                    let value = mediator * n;
                    sums.solid[a][b] += value;
                    (0..3).for_each(|i| sums.solid_arm[a][b][i] += value * arm[i]);
                }
                for b in 0..count {
                    let value = mediator * motion.n[b];
                    sums.shell[a][b] += value;
                    for i in 0..3 {
                        let end = mediator * motion.ends[b][i];
                        sums.shell_arm[a][b][i] += value * arm[i];
                        sums.ends[a][b][i] += end;
                        sums.bent[a][b][i] += mediator * motion.bent[b][i];
                        (0..3).for_each(|k| sums.ends_arm[a][b][k][i] += arm[k] * end);
                    }
                }
            }
        }
        sums
    }

    /// Adds those of the node `a` of the element to the rows of its function.
    fn add(&self, a: usize, function: &Function, [solid, shell]: [&[u32]; 2], rows: &mut [Sums]) {
        let (places, moments) = rows.split_at_mut(3);
        for (i, row) in places.iter_mut().enumerate() {
            for (b, &node) in solid.iter().enumerate() {
                row.solid.add(6 * node + i as u32, self.solid[a][b]);
            }
            for (b, &node) in shell.iter().enumerate() {
                row.shell.add(6 * node + i as u32, self.shell[a][b]);
                let end = product(&unit(i), &self.ends[a][b]);
                let bent = of_deflection(i, &self.bent[a][b], &function.director);
                row.turn(node, &end);
                row.turn(node, &bent);
            }
        }
        for ((_, axis), row) in function.axes.iter().zip(moments) {
            // (t × z d)·x component by component
            let axis = axis.map(|x| x / function.gyration);
            for (b, &node) in solid.iter().enumerate() {
                add_vector(&mut row.solid, node, &cross(&axis, &self.solid_arm[a][b]));
            }
            for (b, &node) in shell.iter().enumerate() {
                add_vector(&mut row.shell, node, &cross(&axis, &self.shell_arm[a][b]));
                let g = &self.ends_arm[a][b];
                let columns = [0, 1, 2].map(|c| cross(&axis, &[g[0][c], g[1][c], g[2][c]]));
                row.turn(
                    node,
                    &[0, 1, 2].map(|a| [0, 1, 2].map(|c: usize| columns[c][a])),
                );
            }
        }
    }
}

impl Sums {
    /// Adds to G of a node.
    fn turn(&mut self, node: u32, by: &Mat) {
        let own = self.axes.entry(node).or_default();
        for (own, by) in own.iter_mut().flatten().zip(by.iter().flatten()) {
            *own += by;
        }
    }
}

fn add_vector(sum: &mut Sum, node: u32, by: &[f64; 3]) {
    for (i, value) in by.iter().enumerate() {
        sum.add(6 * node + i as u32, *value);
    }
}

/// u ⊗ v.
fn product(u: &[f64; 3], v: &[f64; 3]) -> Mat {
    u.map(|u| v.map(|v| u * v))
}

/// G of e_i·R_Aᵀ R_B w without the skew part of R_Aᵀ R_B across the director.
fn of_deflection(i: usize, w: &[f64; 3], director: &[f64; 3]) -> Mat {
    let across = |x: &[f64; 3]| {
        let along = dot(x, director);
        [0, 1, 2].map(|k| x[k] - along * director[k])
    };
    let own = product(&unit(i), w);
    let skew = product(&across(&unit(i)), &across(w));
    let at = |a: usize, c: usize| own[a][c] - 0.5 * (skew[a][c] - skew[c][a]);
    [0, 1, 2].map(|a| [0, 1, 2].map(|c| at(a, c)))
}

fn finish(mediator: &Mediator, sums: Vec<Sums>, shell_is: Model) -> Vec<Row> {
    let sign = match shell_is {
        Model::Inner => 1.0,
        Model::Outer => -1.0,
    };
    let functions = mediator.functions.iter().flat_map(|function| {
        let [(first, _), (second, _)] = function.axes;
        [0, 1, 2, 3 + first, 3 + second].map(|component| (function.node, component as u32))
    });
    let finished = functions.zip(sums).map(|((node, component), mut sums)| {
        for (node, factors) in &sums.axes {
            let turns = AxisProducts::of_small_turns(factors);
            for (k, value) in turns.into_iter().enumerate() {
                sums.shell.add(6 * node + 3 + k as u32, value);
            }
        }
        let (solid, shell) = (terms(&mut sums.solid), terms(&mut sums.shell));
        let (inner, outer) = match shell_is {
            Model::Outer => (solid, shell),
            Model::Inner => (shell, solid),
        };
        let axes = sums.axes.iter().map(|(&node, factors)| AxisProducts {
            node,
            factors: factors.map(|row| row.map(|g| sign * g)),
        });
        Row {
            node,
            component,
            inner,
            outer,
            axes: axes.collect(),
        }
    });
    let mut rows: Vec<Row> = finished.collect();
    rows.sort_by_key(|row| (row.node, row.component));
    rows
}
