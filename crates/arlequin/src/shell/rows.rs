//! The rows between a shell and a solid.

use carom_elements::MAX_NODES;

use super::mediator::Mediator;
use super::model::{Prisms, ShellCell, ShellModels};
use super::motion::{MOST, Mat};
use crate::cell::Cell;
use crate::coupling::Sum;
use crate::edge::terms;
use crate::error::{Error, Model};
use crate::overlap::Overlap;
use crate::polytope::cross;
use crate::refine::{Part, Point, Rules};
use crate::rows::Row;
use crate::weights::degree_along;

/// Rows of a function of the mediator: three translations and two rotations.
const MODES: usize = 5;

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
    let count = MODES * mediator.functions.len();
    let mut sums = [0, 1].map(|_| vec![Sum::default(); count]);
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
        products.add(mediator, nodes, &mut sums);
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
    /// G_b, and z d × G_b.
    turned: [[Mat; MOST]; MOST],
    turned_arm: [[Mat; MOST]; MOST],
}

impl Products {
    fn new(shell: &ShellCell, solid: &Cell, points: &[Point]) -> Products {
        let count = shell.x.len();
        let mut sums = Products {
            solid: vec![[0.0; MAX_NODES]; count],
            solid_arm: vec![[[0.0; 3]; MAX_NODES]; count],
            shell: [[0.0; MOST]; MOST],
            shell_arm: [[[0.0; 3]; MOST]; MOST],
            turned: [[[[0.0; 3]; 3]; MOST]; MOST],
            turned_arm: [[[[0.0; 3]; 3]; MOST]; MOST],
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
                    (0..3).for_each(|i| sums.shell_arm[a][b][i] += value * arm[i]);
                    let g = &motion.turned[b];
                    for j in 0..3 {
                        let column = [0, 1, 2].map(|i| mediator * g[i][j]);
                        let crossed = cross(arm, &column);
                        for i in 0..3 {
                            sums.turned[a][b][i][j] += column[i];
                            sums.turned_arm[a][b][i][j] += crossed[i];
                        }
                    }
                }
            }
        }
        sums
    }

    /// Adds them to the rows of the solid and of the shell.
    fn add(&self, mediator: &Mediator, [solid, shell]: [&[u32]; 2], sums: &mut [Vec<Sum>; 2]) {
        for (a, node) in shell.iter().enumerate() {
            let Some(&place) = mediator.of_node.get(node) else {
                continue;
            };
            let (function, first) = (&mediator.functions[place], MODES * place);
            let [of_solid, of_shell] = sums;
            for i in 0..3 {
                let (of_solid, of_shell) = (&mut of_solid[first + i], &mut of_shell[first + i]);
                for (b, &node) in solid.iter().enumerate() {
                    of_solid.add(6 * node + i as u32, self.solid[a][b]);
                }
                for (b, &node) in shell.iter().enumerate() {
                    of_shell.add(6 * node + i as u32, self.shell[a][b]);
                    for (j, value) in self.turned[a][b][i].iter().enumerate() {
                        of_shell.add(6 * node + 3 + j as u32, *value);
                    }
                }
            }
            for (k, (_, axis)) in function.axes.iter().enumerate() {
                let row = first + 3 + k;
                let axis = axis.map(|x| x / function.gyration);
                // (t × z d)·v = (t × z d) component by component, t·(z d × G)
                for (b, &node) in solid.iter().enumerate() {
                    let values = cross(&axis, &self.solid_arm[a][b]);
                    for (i, value) in values.into_iter().enumerate() {
                        of_solid[row].add(6 * node + i as u32, value);
                    }
                }
                for (b, &node) in shell.iter().enumerate() {
                    let values = cross(&axis, &self.shell_arm[a][b]);
                    for (i, value) in values.into_iter().enumerate() {
                        of_shell[row].add(6 * node + i as u32, value);
                    }
                    let g = &self.turned_arm[a][b];
                    for j in 0..3 {
                        let value = (0..3).map(|i| axis[i] * g[i][j]).sum();
                        of_shell[row].add(6 * node + 3 + j as u32, value);
                    }
                }
            }
        }
    }
}

fn finish(mediator: &Mediator, sums: [Vec<Sum>; 2], shell_is: Model) -> Vec<Row> {
    let [mut solid, mut shell] = sums;
    let mut rows = Vec::with_capacity(solid.len());
    for (place, function) in mediator.functions.iter().enumerate() {
        let [(first, _), (second, _)] = function.axes;
        for (mode, component) in [0, 1, 2, 3 + first, 3 + second].into_iter().enumerate() {
            let at = MODES * place + mode;
            let (solid, shell) = (terms(&mut solid[at]), terms(&mut shell[at]));
            let (inner, outer) = match shell_is {
                Model::Outer => (solid, shell),
                Model::Inner => (shell, solid),
            };
            rows.push(Row {
                node: function.node,
                component: component as u32,
                inner,
                outer,
            });
        }
    }
    rows.sort_by_key(|row| (row.node, row.component));
    rows
}
