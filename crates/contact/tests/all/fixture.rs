//! Small contacts, and what must hold for the pairing of any of them.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_contact::law::Displacement;
use carom_contact::{Contact, Integration, Law, Pairing, Places, Point, Search, Sliding, Target};
use carom_elements::Kind;
use carom_mesh::{ElementId, Face, Rim, face_nodes};

pub fn face(kind: Kind, nodes: &[u32]) -> Face {
    Face {
        kind,
        nodes: face_nodes(nodes),
        parent: ElementId { block: 0, index: 0 },
        axis: [0.0; 3],
        radius: None,
        rim: Rim::default(),
    }
}

pub fn contact(points: Vec<Point>, target: Target) -> Contact {
    Contact {
        name: "pair".into(),
        law: Law::Displacement(Displacement::default()),
        sliding: Sliding::Finite,
        integration: Integration::Node,
        points,
        mortar: None,
        target,
        sight: None,
        edges: None,
        offsets: Vec::new(),
        near_only: false,
    }
}

pub fn paired(contact: &Contact, places: &Places) -> Pairing {
    let mut pairing = Pairing::default();
    pairing.clear();
    contact.pair_fully(places, &mut Search::default(), &mut pairing);
    pairing
}

/// Row of a point as a full vector.
pub fn full(pairing: &Pairing, point: usize, n: usize) -> Vec<f64> {
    let mut row = vec![0.0; n];
    pairing.rows.add_force(point, 1.0, &mut row);
    row
}

/// The forces of a point have no resultant and no moment about the origin, hence about no point.
pub fn assert_balanced(pairing: &Pairing, point: usize, places: &Places, tolerance: f64) {
    let row = full(pairing, point, places.u.len());
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for node in 0..places.x.len() {
        let x = places.of(node as u32);
        let f = places.unknowns.vector(node as u32, &row);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            force[i] += f[i];
            moment[i] += x[j] * f[k] - x[k] * f[j];
        }
    }
    for i in 0..3 {
        assert!(force[i].abs() < tolerance, "force {force:?}");
        assert!(moment[i].abs() < tolerance, "moment {moment:?}");
    }
}

/// A matrix that takes the curvature of any point of the pairing.
pub fn matrix(pairing: &Pairing, n: usize) -> Csr {
    let mut cliques = Cliques::new();
    for point in 0..pairing.len() {
        pairing.cliques(point, |unknowns| cliques.push(unknowns));
    }
    Csr::from_cliques(n, &cliques)
}

/// Rows are the derivatives of gaps and curvatures those of rows, by central differences of step 1e-5: they err by its
/// square, times third and fourth derivatives of the order of a hundred in SI units at most, and by rounding over the step.
///
/// `held`: what a pairing at another displacement is; it keeps what the derivatives keep. Points that face nothing are left out.
pub fn assert_derivatives(places: &Places, held: impl Fn(&Places) -> Pairing) {
    const STEP: f64 = 1e-5;
    let n = places.u.len();
    let pairing = held(places);
    for point in (0..pairing.len()).filter(|&point| pairing.rows.gap(point).is_finite()) {
        let row = full(&pairing, point, n);
        let mut curvature = matrix(&pairing, n);
        pairing.add_curvature(point, 2.0, 0.5, &mut curvature);
        for dof in 0..n {
            let moved = |step: f64| {
                let mut u = places.u.to_vec();
                u[dof] += step;
                let places = Places { u: &u, ..*places };
                let pairing = held(&places);
                (pairing.rows.gap(point), full(&pairing, point, n))
            };
            let ((gap, after), (gap_before, before)) = (moved(STEP), moved(-STEP));
            let slope = (gap - gap_before) / (2.0 * STEP);
            assert!((slope - row[dof]).abs() < 1e-7, "{slope} {}", row[dof]);
            for i in 0..n {
                let slope = (after[i] - before[i]) / (2.0 * STEP);
                let entry = curvature.get(i, dof);
                let error = (slope - entry).abs() / (1.0 + entry.abs());
                assert!(error < 1e-6, "{i} {dof} {slope} {entry}");
            }
        }
    }
}
