use carom_laws::{Adhesion, Damped, Displacement, Law, Local};
use carom_testing::Random;

use super::*;
use crate::Compliance;

fn candidate(law: Law, gap_free: f64) -> Candidate {
    Candidate {
        law,
        local: Local {
            area: 1.0,
            share: 1.0,
            gap_free,
            ..Local::default()
        },
        rate_free: 0.0,
        status: Status::Open,
        faces_itself: false,
        instant: [1.0; 2],
    }
}

/// Random positive definite matrices B Bᵀ + small I.
fn random_problem(n: usize, random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    let (b, q) = (random.vector(n * n), random.vector(n));
    let mut d = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            d[i * n + j] = (0..n).map(|k| b[i * n + k] * b[j * n + k]).sum::<f64>()
                + if i == j { 1e-3 } else { 0.0 };
        }
    }
    (d, q)
}

#[test]
fn random_complementarity_problems_are_solved() {
    let mut random = Random(1);
    for trial in 0..300 {
        let n = 1 + trial % 40;
        let (d, q) = random_problem(n, &mut random);
        let candidates: Vec<_> = q
            .iter()
            .map(|&q| candidate(Law::Displacement(Displacement::default()), q))
            .collect();
        let mut interface = Interface::default();
        interface
            .solve(&candidates, (Compliance::Dense(&d), 0), [1.0, 0.0])
            .unwrap();
        for i in 0..n {
            let gap = q[i]
                + (0..n)
                    .map(|j| d[i * n + j] * interface.forces[j])
                    .sum::<f64>();
            let force = interface.forces[i];
            let size = 1.0 + interface.forces.iter().fold(0.0_f64, |m, p| m.max(*p));
            assert!(
                gap > -1e-10 * size && force >= 0.0 && (gap * force).abs() < 1e-9 * size * size,
                "{gap} {force}"
            );
        }
    }
}

#[test]
fn points_of_a_surface_that_faces_itself_share_their_force_where_they_say_the_same() {
    // two pairs of equal points, and one point that depends on both pairs
    let b = [[2.0, 0.3], [2.0, 0.3], [0.5, 1.0], [0.5, 1.0], [1.0, 0.4]];
    let d: Vec<f64> = (0..25)
        .map(|k| (0..2).map(|m| b[k / 5][m] * b[k % 5][m]).sum())
        .collect();
    let law = Law::Displacement(Displacement::default());
    let consistent = [-1.0, -1.0, -2.0, -2.0, 5.0];
    // the deeper one of a pair rules
    let differing = [-1.0, -1.1, -2.0, -1.5, 5.0];
    for gaps in [consistent, differing] {
        let candidates = gaps.map(|gap| Candidate {
            faces_itself: true,
            instant: [1.0; 2],
            ..candidate(law, gap)
        });
        let mut interface = Interface::default();
        interface
            .solve(&candidates, (Compliance::Dense(&d), 1), [1.0, 0.0])
            .unwrap();
        for (i, gap) in gaps.iter().enumerate() {
            let force = interface.forces[i];
            let end = gap
                + (0..5)
                    .map(|j| d[i * 5 + j] * interface.forces[j])
                    .sum::<f64>();
            // the shift, 1e-12 of the gaps closed, times ten for rounding
            assert!(end > -1e-11 && force >= 0.0, "{end} {force}");
            assert!((end * force).abs() < 1e-10, "{end} {force}");
        }
    }
}

#[test]
fn a_point_that_nothing_moves_carries_no_force_unless_its_law_says_it() {
    let exact = Law::Displacement(Displacement::default());
    let soft = Law::Damped(Damped {
        stiffness: 2.0,
        damping: 0.0,
        adhesion: Adhesion::Clip,
    });
    // on a plane of symmetry, through it by rounding; the second point is free
    let mut interface = Interface::default();
    let d = [0.0, 0.0, 0.0, 1.0];
    let gaps = [-1e-17, -1.0];
    let solved = |interface: &mut Interface, law| {
        let candidates = gaps.map(|gap| Candidate {
            status: Status::Closed,
            ..candidate(law, gap)
        });
        interface
            .solve(&candidates, (Compliance::Dense(&d), 1), [1.0, 0.0])
            .unwrap();
        interface.forces.clone()
    };
    assert_eq!(solved(&mut interface, exact), [0.0, 1.0]);
    let mut interface = Interface::default();
    // P = -2 (g + P), to rounding
    let soft = solved(&mut interface, soft);
    assert!((soft[0] - 2e-17).abs() < 1e-31);
    assert!((soft[1] - 2.0 / 3.0).abs() < 1e-15);
}

#[test]
fn a_force_that_the_step_cannot_change_is_told_by_its_law() {
    let soft = |damping| {
        Law::Damped(Damped {
            stiffness: 2.0,
            damping,
            adhesion: Adhesion::AsPrinted,
        })
    };
    // explicit: s_g = 0. The first point has no damper, so its force is 2 x 10; the second feels it through D.
    let first = candidate(soft(0.0), -10.0);
    let second = Candidate {
        rate_free: -4.0,
        ..candidate(soft(3.0), -10.0)
    };
    let mut interface = Interface::default();
    let d = [1.0, 0.25, 0.25, 1.0];
    interface
        .solve(&[first, second], (Compliance::Dense(&d), 1), [0.0, 1.0])
        .unwrap();
    let [p, q] = interface.forces[..] else {
        panic!()
    };
    assert_eq!(p, 20.0);
    assert!((q + 2.0 * -10.0 + 3.0 * (-4.0 + 0.25 * p + q)).abs() < 1e-12);
}

#[test]
fn a_damper_that_is_cut_off_does_not_pull_its_neighbour() {
    let law = Law::Damped(Damped {
        stiffness: 2.0,
        damping: 3.0,
        adhesion: Adhesion::Clip,
    });
    // the first point is inside and leaves so fast that its damper would pull
    let rates = [10.0, -4.0];
    let candidates = rates.map(|rate_free| Candidate {
        rate_free,
        ..candidate(law, -1.0)
    });
    let (d, s) = ([1.0, 0.5, 0.5, 1.0], [0.01, 1.0]);
    let mut interface = Interface::default();
    interface
        .solve(&candidates, (Compliance::Dense(&d), 1), s)
        .unwrap();
    let [p, q] = interface.forces[..] else {
        panic!()
    };
    let pull = |own: f64, other: f64, rate: f64| {
        let product = own + 0.5 * other;
        2.0 * (-1.0 + s[0] * product) + 3.0 * (rate + s[1] * product)
    };
    assert_eq!(p, 0.0);
    assert!(pull(p, q, rates[0]) > 0.0);
    // the solve of one equation, to rounding
    assert!((q + pull(q, p, rates[1])).abs() < 1e-12, "{q}");
    assert_eq!(interface.unsettled, None);
}

/// Three dampers of which each that is cut off lets another one press: they go in a circle.
#[test]
fn tension_that_does_not_settle_is_told_with_a_point_that_has_it() {
    let law = Law::Damped(Damped {
        stiffness: 2.0,
        damping: 3.0,
        adhesion: Adhesion::Clip,
    });
    let candidates = [-7.0, 9.0, 3.0].map(|rate_free| Candidate {
        rate_free,
        ..candidate(law, -1.0)
    });
    let d = [14.1, -18.0, -15.0, -18.0, 27.1, 24.0, -15.0, 24.0, 22.1];
    let mut interface = Interface::default();
    interface
        .solve(&candidates, (Compliance::Dense(&d), 1), [0.01, 1.0])
        .unwrap();
    assert!(interface.unsettled.is_some());
    assert!(interface.forces.iter().all(|force| *force >= 0.0));
}

#[test]
fn damped_point_obeys_its_law_or_its_corner() {
    let law = |stiffness, damping| {
        Law::Damped(Damped {
            stiffness,
            damping,
            adhesion: Adhesion::AsPrinted,
        })
    };
    let mut interface = Interface::default();
    // g₊ = -1 + 0.5 P, ġ₊ = -4 + P; P = -(2 g₊ + 3 ġ₊)
    let soft = Candidate {
        rate_free: -4.0,
        ..candidate(law(2.0, 3.0), -10.0)
    };
    interface
        .solve(&[soft], (Compliance::Dense(&[1.0]), 0), [0.5, 1.0])
        .unwrap();
    let p = interface.forces[0];
    assert!((p + 2.0 * (-10.0 + 0.5 * p) + 3.0 * (-4.0 + p)).abs() < 1e-12);
    assert_eq!(interface.statuses, [Status::Closed]);
    // a strong damper on a shallow penetration would throw the point open: corner, g₊ = 0
    let strong = Candidate {
        rate_free: -4.0,
        ..candidate(law(2.0, 300.0), -0.1)
    };
    interface
        .solve(&[strong], (Compliance::Dense(&[1.0]), 1), [0.5, 1.0])
        .unwrap();
    assert_eq!(interface.statuses, [Status::Corner]);
    assert!((interface.forces[0] - 0.2).abs() < 1e-12);
}
