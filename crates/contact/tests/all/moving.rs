//! Obstacles that move: what their motion adds to the rates of gaps and to sliding.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{
    Basis, Frames, Integration, Mortar, Motion, Obstacle, Places, Plane, Rows, Search, Target,
    Translation,
};
use carom_elements::Kind;

use crate::fixture::{contact, face, paired};

#[test]
fn rows_of_gaps_and_of_sliding_have_the_velocity_of_the_obstacle() {
    let x = [
        [0.0, 0.0, 0.4],
        [1.0, 0.1, 0.5],
        [1.1, 1.0, 0.4],
        [0.0, 0.9, 0.3],
    ];
    let faces = vec![face(Kind::Quad4, &[0, 1, 2, 3])];
    let (mortar, points) = Mortar::new(faces, &x, |_| 1.0);
    let velocity = [3.0, -1.0, 2.0];
    let plane = Plane {
        point: [0.0; 3],
        normal: [0.0, 0.6, 0.8],
    };
    let moving = Obstacle {
        motion: Motion {
            translation: Some(Translation::Velocity(velocity)),
            turn: None,
        },
        ..plane.into()
    };
    let mut contact = contact(points, Target::Rigid(moving));
    assert!(contact.moves());
    let unknowns = Unknowns::translations(3, x.len());
    let places = |time| Places {
        unknowns: &unknowns,
        time,
        x: &x,
        u: &[0.0; 12],
        frames: Frames::default(),
    };
    let along = |n: [f64; 3]| -(0..3).map(|i| n[i] * velocity[i]).sum::<f64>();
    for integration in [
        Integration::Node,
        Integration::Mortar {
            basis: Basis::Standard,
        },
    ] {
        contact.mortar = match integration {
            Integration::Node => None,
            _ => Some(mortar.clone()),
        };
        contact.integration = integration;
        let (before, after) = (
            paired(&contact, &places(0.1)),
            paired(&contact, &places(0.3)),
        );
        let mut rows = Rows::default();
        rows.clear();
        contact.pair(&places(0.1), &mut Search::default(), &mut rows);
        for point in 0..4 {
            let rate = before.rows.rate(point);
            assert!((rate - along(before.rows.normal(point))).abs() < 1e-14);
            assert!((rows.rate(point) - rate).abs() < 1e-14);
            // a plane that moves at constant velocity changes gaps at a constant rate
            let change = after.rows.gap(point) - before.rows.gap(point);
            assert!((change - 0.2 * rate).abs() < 1e-14, "{change} {rate}");
            for tangent in &before.tangents {
                let expected = along(tangent.normal(point));
                assert!((tangent.rate(point) - expected).abs() < 1e-14);
            }
        }
    }
}
