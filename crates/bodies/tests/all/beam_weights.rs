//! Beams that share their volume with another body: weights, and the motion of sections.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::tensor::Vec3;
use carom_algebra::unknowns::{NodeKind, Unknowns};
use carom_bodies::{
    BeamAxis, BeamSection, BeamTheory, Body, BodySpec, CellWeights, Kinematics, SectionShape,
};
use carom_materials::Elastic;
use carom_testing::Random;

use crate::beams::mesh;

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.25,
};

fn section(theory: BeamTheory, dim: usize) -> BeamSection {
    let shape = SectionShape::Rectangle {
        height: 0.2,
        width: 0.1,
    };
    BeamSection {
        orientation: (dim == 3).then_some([0.1, 0.2, 1.0]),
        offset: if dim == 3 { [0.03, -0.02] } else { [0.03, 0.0] },
        ..BeamSection::new(theory, shape.properties(STEEL.poisson))
    }
}

fn unknowns(dim: usize) -> Unknowns {
    Unknowns::new(dim, [NodeKind::SmallRotations; 3])
}

/// `factors` of K and of the consistent mass; weights of both at the four ends of two elements.
fn matrix(section: BeamSection, dim: usize, weights: Option<[f64; 4]>, factors: [f64; 3]) -> Csr {
    let (mesh, cells) = mesh(dim);
    let mut spec = BodySpec::new("b", cells, Kinematics::Beam(section), STEEL);
    spec.weights = weights.map(|w| CellWeights {
        inertia: w.to_vec(),
        stiffness: w.to_vec(),
    });
    let map = unknowns(dim);
    let body = Body::new(&mesh, spec, &[0, 1, 2], &map).unwrap();
    let mut cliques = Cliques::new();
    body.each_element(&mut |nodes| {
        let own = nodes
            .iter()
            .flat_map(|&node| map.of(node).map(|i| i as u32));
        cliques.push(&own.collect::<Vec<u32>>());
    });
    let mut matrix = Csr::from_cliques(map.len(), &cliques);
    body.assemble(factors, &(0..map.len()), &mut matrix);
    matrix
}

fn cases() -> Vec<(usize, BeamTheory)> {
    let theories = [BeamTheory::EulerBernoulli, BeamTheory::Timoshenko];
    theories
        .into_iter()
        .flat_map(|t| [(2, t), (3, t)])
        .collect()
}

#[test]
fn weights_that_add_up_to_one_share_the_stiffness() {
    let w = [0.2, 0.9, 0.9, 0.4];
    for (dim, theory) in cases() {
        let of = |weights| matrix(section(theory, dim), dim, weights, [1.0, 0.0, 0.0]);
        let (whole, one, other) = (of(None), of(Some(w)), of(Some(w.map(|w| 1.0 - w))));
        let n = unknowns(dim).len();
        let pairs = || (0..n).flat_map(move |i| (0..n).map(move |j| (i, j)));
        let largest = pairs().fold(0.0_f64, |m, (i, j)| m.max(whole.get(i, j).abs()));
        for (i, j) in pairs() {
            let sum = one.get(i, j) + other.get(i, j);
            // rounding of two products of matrices
            assert!(
                (sum - whole.get(i, j)).abs() < 1e-13 * largest,
                "{dim} {theory:?}"
            );
        }
    }
}

#[test]
fn a_weighted_mass_moves_like_the_weighted_length() {
    // of a translation along an axis of coordinates ∫ α ρ A dx
    let w = [0.2, 0.9, 0.9, 0.4];
    let (mesh, cells) = mesh(3);
    let area = section(BeamTheory::Timoshenko, 3).properties.area;
    let mut mass = 0.0;
    for (k, &cell) in cells.iter().enumerate() {
        let nodes = mesh.element_nodes(cell);
        let [a, b] = [0, 1].map(|i| Vec3::from(mesh.nodes[nodes[i] as usize]));
        mass += STEEL.density * area * (b - a).norm() * 0.5 * (w[2 * k] + w[2 * k + 1]);
    }
    for theory in [BeamTheory::EulerBernoulli, BeamTheory::Timoshenko] {
        let m = matrix(section(theory, 3), 3, Some(w), [0.0, 0.0, 1.0]);
        for axis in 0..3 {
            let v: Vec<f64> = (0..18).map(|i| f64::from(i % 6 == axis)).collect();
            let mut product = vec![0.0; 18];
            m.multiply(&v, &mut product);
            let found: f64 = product.iter().zip(&v).map(|(p, v)| p * v).sum();
            assert!((found - mass).abs() < 1e-12 * mass, "{theory:?} {axis}");
        }
    }
}

#[test]
fn sections_of_a_rigid_motion_move_with_it() {
    let mut random = Random(5);
    for (dim, theory) in cases() {
        let (mesh, cells) = mesh(dim);
        let mut vector = || Vec3::new(random.next(), random.next(), random.next());
        let (mut moved, mut turned) = (vector(), vector());
        if dim == 2 {
            (moved.z, turned.x, turned.y) = (0.0, 0.0, 0.0);
        }
        for &cell in &cells {
            let axis = BeamAxis::new(&mesh, cell, section(theory, dim), STEEL).unwrap();
            let of = |x: [f64; 3]| moved + turned.cross(&Vec3::from(x));
            let nodes = mesh.element_nodes(cell);
            let unknowns: Vec<f64> = nodes
                .iter()
                .flat_map(|&n| {
                    let moved: [f64; 3] = of(mesh.nodes[n as usize]).into();
                    let turned: [f64; 3] = turned.into();
                    moved.into_iter().chain(turned)
                })
                .collect();
            for xi in [0.0, 0.3, 1.0] {
                let x = [0, 1, 2].map(|i| (1.0 - xi) * axis.ends[0][i] + xi * axis.ends[1][i]);
                let rows = axis.motion(xi);
                let found = rows.map(|r| r.iter().zip(&unknowns).map(|(r, u)| r * u).sum::<f64>());
                for i in 0..3 {
                    assert!((found[i] - of(x)[i]).abs() < 1e-13, "{dim} {theory:?}");
                    assert!((found[3 + i] - turned[i]).abs() < 1e-13, "{dim} {theory:?}");
                }
            }
        }
    }
}

#[test]
fn rotations_of_an_euler_bernoulli_beam_are_the_slopes_of_its_axis() {
    let (mesh, cells) = mesh(2);
    let slender = BeamSection {
        offset: [0.0; 2],
        ..section(BeamTheory::EulerBernoulli, 2)
    };
    let axis = BeamAxis::new(&mesh, cells[0], slender, STEEL).unwrap();
    let [a, b] = axis.ends.map(Vec3::from);
    let (length, across) = ((b - a).norm(), Vec3::from(axis.across()[0]));
    let step = 1e-5;
    for column in 0..12 {
        let at = |xi: f64| -> f64 {
            let rows = axis.motion(xi);
            (0..3).map(|i| rows[i][column] * across[i]).sum()
        };
        let slope = (at(0.4 + step) - at(0.4 - step)) / (2.0 * step * length);
        // the difference errs by step² times the third derivative
        assert!(
            (slope - axis.motion(0.4)[5][column]).abs() < 1e-8,
            "{column}"
        );
    }
}
