//! Forces that are found with the motion.

use std::cell::RefCell;

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::{Cholesky, Iterative, Saddle, SparseRow};

use super::*;

/// Nodes in a row, each with springs to the next and to the ground in random directions, and a mass: three unknowns each.
fn row_of_nodes(nodes: usize, random: &mut Random) -> Csr {
    let mut cliques = Cliques::new();
    for node in 0..nodes as u32 - 1 {
        let first = 3 * node;
        cliques.push(&[first, first + 1, first + 2, first + 3, first + 4, first + 5]);
    }
    let mut matrix = Csr::from_cliques(3 * nodes, &cliques);
    let mut add = |ends: &[(usize, f64)], axis: [f64; 3]| {
        for &(one, a) in ends {
            for &(other, b) in ends {
                for i in 0..3 {
                    for j in 0..3 {
                        matrix.add(3 * one + i, 3 * other + j, a * b * axis[i] * axis[j]);
                    }
                }
            }
        }
    };
    for node in 0..nodes {
        for i in 0..3 {
            let mut axis = [0.0; 3];
            axis[i] = 1.0;
            add(&[(node, 1.0)], axis);
            let axis = [random.next(), random.next(), random.next()];
            add(&[(node, 0.5)], axis);
            if node + 1 < nodes {
                add(&[(node, 1.0), (node + 1, -1.0)], axis);
            }
        }
    }
    matrix
}

/// Forces that are found together with the motion, by iterations, obey the laws with the D that a factor gives, by code that knows no
/// solver; and are those of the passes with this D, since friction of this size has one solution.
#[test]
fn forces_found_with_the_motion_are_those_of_known_compliances() {
    let mut random = Random(57);
    let (mut stuck, mut slipped, mut opened) = (0, 0, 0);
    for tangents in [1, 2] {
        for _ in 0..30 {
            let nodes = 8;
            let matrix = row_of_nodes(nodes, &mut random);
            let groups: Vec<u32> = (0..3 * nodes as u32).map(|unknown| unknown / 3).collect();
            let width = 1 + tangents;
            let mut rows = Vec::new();
            for node in 0..nodes {
                for axis in frame(&mut random).iter().take(width) {
                    rows.push(SparseRow {
                        dofs: (0..3).map(|i| (3 * node + i) as u32).collect(),
                        coefficients: axis.to_vec(),
                    });
                }
            }
            let mut factor = Cholesky::new(&matrix, &groups).unwrap();
            let mut d = Vec::new();
            for row in &rows {
                let mut column = vec![0.0; 3 * nodes];
                for (&dof, n) in row.dofs.iter().zip(&row.coefficients) {
                    column[dof as usize] = *n;
                }
                factor.solve(&mut column);
                let along = |row: &SparseRow| -> f64 {
                    let terms = row.dofs.iter().zip(&row.coefficients);
                    terms.map(|(&dof, n)| n * column[dof as usize]).sum()
                };
                d.extend(rows.iter().map(along));
            }
            let mut known = problem(nodes, tangents, d, &mut random);
            known.tolerance = 1e-10;
            let expected = known.solve().unwrap();
            let mut saddle = Saddle::default();
            let solver = Box::new(Iterative::new(&matrix, &groups).unwrap());
            saddle.begin(
                vec![(0, solver)],
                rows.into_iter(),
                (1e-13, |_: &mut [f64]| ()),
            );
            let saddle = RefCell::new(saddle);
            let mut coulomb = Coulomb::default();
            let posed = Posed {
                d: Compliance::Iterated(&saddle),
                ..known.posed()
            };
            coulomb.solve(&posed).unwrap();
            let found = FrictionSolution {
                forces: coulomb.forces.clone(),
                tangential: coulomb.tangential.clone(),
                statuses: coulomb.statuses.clone(),
                slips: coulomb.slips.clone(),
                passes: coulomb.passes,
                sweeps: 0,
            };
            // defects of 1e-10 of the largest force, in points that may carry a hundredth of it
            assert!(known.defect(&found) < 1e-8, "{}", known.defect(&found));
            let most = expected.forces.iter().fold(0.0f64, |most, p| most.max(*p));
            for (one, other) in expected.forces.iter().zip(&found.forces) {
                assert!((one - other).abs() < 1e-8 * most, "{one} {other}");
            }
            assert_eq!(expected.statuses, found.statuses);
            for slip in &found.slips {
                match slip {
                    Slip::Stick => stuck += 1,
                    Slip::Slip => slipped += 1,
                    Slip::Open => opened += 1,
                }
            }
        }
    }
    assert!(
        stuck > 30 && slipped > 30 && opened > 30,
        "{stuck} {slipped} {opened}"
    );
}
