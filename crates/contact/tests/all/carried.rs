//! Points and faces that another node carries.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use carom_algebra::unknowns::{Carrier, NodeKind, Unknowns};
use carom_contact::{Balance, Frames, Places, Target};
use carom_contact::{Plane, Point};
use carom_elements::Kind;

use crate::fixture::{contact, face, full, paired};

/// A node with rotations at the origin, number 0; a carried triangle below it; a free node over the triangle, number 4.
fn scene() -> (Unknowns, Vec<[f64; 3]>, Rotation) {
    let x = vec![
        [0.0; 3],
        [-1.0, -1.0, -0.3],
        [1.5, -1.0, -0.2],
        [0.0, 1.5, -0.4],
        [0.1, 0.2, -0.7],
    ];
    let axes = Rotation::cayley(&Vec3::new(0.3, -0.2, 0.5));
    let kinds = x.iter().enumerate().map(|(node, x)| match node {
        0 => NodeKind::Turning,
        4 => NodeKind::Translations,
        _ => NodeKind::Carried(Carrier {
            node: 0,
            arm: axes.matrix().tr_mul(&Vec3::from(*x)).into(),
        }),
    });
    (Unknowns::new(3, kinds), x.clone(), axes)
}

/// Rows about increments of zero are the derivatives of gaps, by central differences of step 1e-5: they err by its square, times
/// third derivatives of the order of ten, and by rounding over the step.
#[test]
fn rows_are_the_derivatives_of_gaps_by_translations_and_rotations() {
    const STEP: f64 = 1e-5;
    let (unknowns, x, axes) = scene();
    let frames = [axes];
    let plane = Plane {
        point: [0.0, 0.0, -2.0],
        normal: [0.0, 0.6, 0.8],
    };
    let carried = Point::at_node(2, 1.0, 1.0);
    let over_face = Point::at_node(4, 1.0, 1.0);
    // its normal points down, to the free node
    let triangle = face(Kind::Tri3, &[1, 3, 2]);
    let contacts = [
        contact(vec![carried], Target::Rigid(plane.into())),
        contact(vec![over_face], Target::Surface(vec![triangle])),
    ];
    for contact in contacts {
        let at = |u: &[f64]| {
            let places = Places {
                unknowns: &unknowns,
                time: 0.0,
                x: &x,
                u,
                frames: Frames {
                    start: &frames,
                    ..Frames::default()
                },
            };
            let pairing = paired(&contact, &places);
            (pairing.rows.gap(0), full(&pairing, 0, unknowns.len()))
        };
        let mut u = vec![0.0; unknowns.len()];
        let (gap, row) = at(&u);
        assert!(gap.is_finite());
        for unknown in 0..unknowns.len() {
            u[unknown] = STEP;
            let after = at(&u).0;
            u[unknown] = -STEP;
            let slope = (after - at(&u).0) / (2.0 * STEP);
            u[unknown] = 0.0;
            assert!(
                (slope - row[unknown]).abs() < 1e-8,
                "{unknown}: {slope} {}",
                row[unknown]
            );
        }
    }
}

/// In a mid-point rule the moment on the rotations, turned by R A⁻¹, is that of the force about the mean place, and its product
/// with the increment is the work of the force on the way of the point: exact.
#[test]
fn a_force_in_the_middle_of_a_step_does_its_work_and_has_its_moment() {
    let (unknowns, x, axes) = scene();
    let (frames, increment) = ([axes], Vec3::new(0.4, 0.7, -0.3));
    let rotations = unknowns.rotations_of(0);
    let (mut middle, mut end) = (vec![0.0; unknowns.len()], vec![0.0; unknowns.len()]);
    for (axis, unknown) in rotations.clone().enumerate() {
        (middle[unknown], end[unknown]) = (0.5 * increment[axis], increment[axis]);
    }
    let places = |u, middle| Places {
        unknowns: &unknowns,
        time: 0.0,
        x: &x,
        u,
        frames: Frames {
            start: &frames,
            middle,
            balance: Some(Balance {
                end: &end,
                fraction: 0.5,
            }),
        },
    };
    let force = [0.3, -0.5, 0.9];
    let mut moment = Vec3::zeros();
    places(&middle[..], true).each_derivative(3, &force, |unknown, n| {
        if rotations.contains(&unknown) {
            moment[unknown - rotations.start] = n;
        }
    });
    let still = vec![0.0; unknowns.len()];
    let [before, mean, after] = [(&still, false), (&middle, true), (&end, false)]
        .map(|(u, middle)| Vec3::from(places(&u[..], middle).of(3)));
    assert!((mean - (before + after) / 2.0).norm() < 1e-15);
    let force = Vec3::from(force);
    let work = force.dot(&(after - before));
    assert!((moment.dot(&increment) - work).abs() < 1e-15 * 10.0);
    // R A⁻¹ is the mean of the rotations at both ends
    let turned = axes.then(&Rotation::cayley(&increment)).matrix();
    let of_space = (axes.matrix() + turned) / 2.0 * moment;
    assert!((of_space - mean.cross(&force)).norm() < 1e-15 * 10.0);
}
