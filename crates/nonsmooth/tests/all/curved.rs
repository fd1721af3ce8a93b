//! Problems of laws that are not linear: every force is that of its law at the gap and the rate to which all forces lead.
//!
//! Tolerance: 1e-12 of the largest term, the force of a law for the gap without any force; the gap with forces is a difference, in
//! which rounding of that size remains. Solvers of problems with friction leave 1e-12 of the terms of a point.

use carom_laws::{Hertz, HuntCrossley, Law, Local, Status};
use carom_nonsmooth::Compliance;
use carom_nonsmooth::coulomb::{Coulomb, Posed, Tangential};
use carom_nonsmooth::interface::{Candidate, Interface};
use carom_testing::Random;

use crate::lumped::{rows, surface};

/// Factors of D P in gap and rate, of a step of 0.1 s, and in the sliding.
const FACTORS: [f64; 3] = [0.05, 1.0, 1.0];

fn law(random: &mut Random) -> Law {
    let spring = Hertz {
        stiffness: 10.0_f64.powf(random.between(0.0, 4.0)),
        exponent: random.between(1.0, 3.0),
    };
    match random.next() > 0.0 {
        true => Law::Hertz(spring),
        false => Law::HuntCrossley(HuntCrossley {
            spring,
            damping: random.between(0.0, 1.0),
        }),
    }
}

/// Points that come from anywhere: the relations begin about gaps that say nothing of the end.
fn candidates(count: usize, random: &mut Random) -> Vec<Candidate> {
    let one = |_| Candidate {
        law: law(random),
        local: Local {
            share: 1.0,
            ..Candidate::unilateral(random.between(-0.6, 0.2))
                .local
                .about(random.between(-0.5, 0.5), random.next())
        },
        rate_free: random.between(-3.0, 3.0),
        status: [Status::Open, Status::Closed][usize::from(random.next() > 0.0)],
        ..Candidate::unilateral(0.0)
    };
    (0..count).map(one).collect()
}

/// The force of a law at a gap and a rate, N, by its formula.
fn force(law: &Law, gap: f64, rate: f64) -> f64 {
    let (spring, damping) = match law {
        Law::Hertz(spring) => (spring, 0.0),
        Law::HuntCrossley(law) => (&law.spring, law.damping),
        _ => unreachable!(),
    };
    let static_force = spring.stiffness * (-gap).max(0.0).powf(spring.exponent);
    static_force * (1.0 - damping * rate).max(0.0)
}

/// The largest |P - P(g, ġ)| over the largest P for g and ġ without forces. `p`: forces of all rows; `d`: D over them, row-major.
fn defect(candidates: &[Candidate], p: &[f64], d: &[f64]) -> f64 {
    let width = p.len() / candidates.len();
    let (mut missing, mut largest) = (0.0_f64, 0.0_f64);
    for (i, candidate) in candidates.iter().enumerate() {
        let row = &d[i * width * p.len()..(i * width + 1) * p.len()];
        let moved: f64 = row.iter().zip(p).map(|(d, p)| d * p).sum();
        let gap = candidate.local.gap_free + FACTORS[0] * moved;
        let rate = candidate.rate_free + FACTORS[1] * moved;
        let found = p[i * width];
        missing = missing.max((found - force(&candidate.law, gap, rate)).abs());
        largest = largest.max(force(&candidate.law, -candidate.local.gap_free.abs(), -3.0));
    }
    missing / largest
}

#[test]
fn each_force_is_that_of_its_law_whichever_the_form_of_the_compliance() {
    let mut random = Random(4);
    let mut closed = 0;
    for trial in 0..60 {
        let n = 1 + trial % 7;
        let rows = rows(&surface(n, 1.7), 1.7, 0);
        let (candidates, mut entries) = (candidates(n * n, &mut random), Vec::new());
        rows.dense(&mut entries);
        let mut forces = Vec::new();
        for d in [Compliance::Dense(&entries), Compliance::Lumped(&rows)] {
            let mut interface = Interface::default();
            interface
                .solve(&candidates, (d, 1), [FACTORS[0], FACTORS[1]])
                .unwrap();
            assert!(defect(&candidates, &interface.forces, &entries) < 1e-12);
            closed += interface.forces.iter().filter(|p| **p > 0.0).count();
            forces.push(interface.forces);
        }
        let largest = forces[0].iter().fold(1e-3_f64, |most, p| most.max(*p));
        for (one, other) in forces[0].iter().zip(&forces[1]) {
            assert!((one - other).abs() < 1e-11 * largest);
        }
    }
    assert!(closed > 1000, "{closed}");
}

#[test]
fn each_force_is_that_of_its_law_with_friction() {
    let mut random = Random(5);
    for trial in 0..40 {
        let (n, tangents) = (1 + trial % 4, 1 + trial % 2);
        let rows = rows(&surface(n, 1.7), 1.7, tangents);
        let (candidates, mut entries) = (candidates(n * n, &mut random), Vec::new());
        rows.dense(&mut entries);
        let slides = |_| Tangential {
            mu: 0.3,
            free: [random.next(), random.next()],
            ..Tangential::default()
        };
        let friction: Vec<Tangential> = (0..n * n).map(slides).collect();
        for d in [Compliance::Dense(&entries), Compliance::Lumped(&rows)] {
            let mut coulomb = Coulomb::default();
            let posed = Posed {
                candidates: &candidates,
                friction: &friction,
                tangents,
                d,
                s: FACTORS,
                tolerance: 1e-12,
            };
            coulomb.solve(&posed).unwrap();
            let mut p = Vec::new();
            for (force, t) in coulomb.forces.iter().zip(&coulomb.tangential) {
                p.push(*force);
                p.extend(&t[..tangents]);
                assert!(t[0].hypot(t[1]) <= 0.3 * force.max(0.0) * (1.0 + 1e-9));
            }
            assert!(defect(&candidates, &p, &entries) < 1e-12);
        }
    }
}
