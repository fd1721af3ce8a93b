//! Rows of a rank are those of all.

// Tests panic where a model is refused.
#![allow(clippy::unwrap_used)]

use std::slice;
use std::sync::Arc;

use carom_bodies::{BodySpec, Kinematics};
use carom_materials::Elastic;
use carom_mesh::generate;
use carom_ranks::threads;

use super::*;
use crate::operator::{assembled, assembled_at};
use crate::scheme::{self, Scheme};
use crate::system::{Model, ModelBody};

/// A column of hexahedra with 81 nodes in a layer, two chunks of rows and a bit.
fn column() -> Arc<System> {
    let mesh = generate::box_("column", [0.0; 3], [1.0, 1.0, 4.0], [8, 8, 32], false);
    let cells = mesh.groups["column"].elements.clone();
    let rubber = Elastic {
        density: 1000.0,
        young: 1e9,
        poisson: 0.3,
    };
    let body = ModelBody::new(BodySpec::new("column", cells, Kinematics::Solid, rubber));
    let theta = Scheme::Theta(scheme::Theta { theta: 0.5 });
    System::new(Model::new(vec![body], mesh, theta, 1e-4)).unwrap()
}

#[test]
fn a_rank_has_the_elements_at_its_rows_alone_and_these_rows_whole() {
    let system = column();
    let (part, all) = (&system.parts[0], system.bodies[0].cells().len());
    let factors = ([1.0, 0.0], |_: usize| 0.25e-8);
    let whole = assembled(&system, part, factors.0, &factors.1);
    let of_ranks = std::thread::scope(|scope| {
        let own = threads(3).into_iter().map(|ranks| {
            let (system, whole) = (&system, &whole);
            scope.spawn(move || {
                let parts = slice::from_ref(part);
                let rows = shared_rows(system, parts, &[], &ranks);
                let at = AtRows::new(system, &[(parts, &rows)]);
                let a = assembled_at((system, &at), part, factors.0, &factors.1);
                let needed = rows.needed();
                assert!(needed.clone().all(|i| a.row(i) == whole.row(i)));
                let (x, mut y, mut product) = (
                    vec![1.5; part.len()],
                    vec![0.0; part.len()],
                    vec![9.0; part.len()],
                );
                whole.multiply(&x, &mut y);
                at.multiply(&a, &x, &mut product);
                assert!(product == y);
                let mut diagonal: Vec<f64> = (0..part.len()).map(|i| a.get(i, i)).collect();
                at.complete(part, &mut diagonal);
                assert!((0..part.len()).all(|i| diagonal[i] == whole.get(i, i)));
                (needed.len(), at.body(system, 0).cells().len())
            })
        });
        let own: Vec<_> = own.collect();
        own.into_iter()
            .map(|rank| rank.join().unwrap())
            .collect::<Vec<_>>()
    });
    for (rows, elements) in of_ranks {
        // layers of 81 nodes: with a layer of elements more at each end than rows fill
        let layers = rows.div_ceil(3 * 81) + 1;
        assert!(
            elements <= 64 * layers && elements < all,
            "{elements} at {rows}"
        );
    }
}

#[test]
fn one_rank_that_fails_tells_all() {
    let system = column();
    let parts = slice::from_ref(&system.parts[0]);
    std::thread::scope(|scope| {
        for ranks in threads(3) {
            let system = &system;
            scope.spawn(move || {
                let rows = shared_rows(system, parts, &[], &ranks);
                let at = AtRows::new(system, &[(parts, &rows)]);
                let own = match ranks.rank() {
                    1 => Err(Error::RanksDiffer { time: 2.0 }),
                    _ => Ok(()),
                };
                let told = at.agree(own).unwrap_err();
                assert!(matches!(told, Error::OnRank { rank: 1, .. }), "{told}");
                at.agree(Ok(())).unwrap();
            });
        }
    });
}
