//! What is refused, and what is named; rank.

use carom_arlequin::{
    Bracket, Coupling, Error, Mediator, Model, Models, Overlap, Profile, Region, SliverRule,
    Weighting,
};

use crate::support::{Pair, Random, line, plate};

fn region(min: f64, max: f64) -> Region {
    Region::Box {
        min: [min, -9.0, -9.0],
        max: [max, 9.0, 9.0],
    }
}

fn bars() -> Pair {
    Pair::new(line(0.0, 2.0, 40), line(0.0, 4.0, 20))
}

fn refusal(pair: &Pair, region: &Region) -> Error {
    Overlap::new(pair.models(), region).unwrap_err()
}

#[test]
fn overlaps_that_cannot_couple_are_refused_with_their_cells() {
    let pair = bars();
    assert_eq!(refusal(&pair, &region(3.0, 4.0)), Error::Empty);
    // Half an outer cell.
    match refusal(&pair, &region(1.9, 9.0)) {
        Error::Thin { layers, cells } => {
            assert!((layers - 0.5).abs() < 1e-9);
            assert_eq!(cells, [pair.outer[9]]);
        }
        other => panic!("{other:?}"),
    }
    let ends = refusal(&pair, &region(1.0, 1.7));
    assert!(matches!(ends, Error::EndsOutside { cells } if cells == [pair.inner[39]]));
    match refusal(&pair, &Region::Cells(pair.outer[6..12].to_vec())) {
        Error::NotCovered { cells, least } => {
            assert_eq!(cells, &pair.outer[10..12]);
            assert_eq!(least, 0.0);
        }
        other => panic!("{other:?}"),
    }
    let models = |inner, outer| Models {
        mesh: &pair.mesh,
        inner,
        outer,
    };
    let model = Model::Outer;
    let none = Overlap::new(models(&pair.inner, &[]), &Region::Intersection);
    assert_eq!(none.unwrap_err(), Error::NoCells { model });
    let same = Overlap::new(models(&pair.inner, &pair.inner), &Region::Intersection);
    assert_eq!(same.unwrap_err(), Error::SharedNode { node: 0 });
    let flat = Pair::new(
        line(0.0, 1.0, 2),
        plate([0.0; 2], [2.0, 1.0], [4, 2], false),
    );
    assert!(matches!(
        refusal(&flat, &Region::Intersection),
        Error::Dimension { found: 1, .. }
    ));
}

#[test]
fn cells_that_cannot_be_cut_are_refused_by_kind() {
    let pair = bars();
    let mesh = carom_mesh::raise(&pair.mesh, false).unwrap();
    let models = Models {
        mesh: &mesh,
        ..pair.models()
    };
    let error = Overlap::new(models, &region(1.0, 9.0)).unwrap_err();
    assert!(matches!(error, Error::Kind { kind: "bar3", .. }));
}

#[test]
fn weights_that_reflect_or_have_no_border_are_refused() {
    let pair = bars();
    let overlap = Overlap::new(pair.models(), &region(1.0, 9.0)).unwrap();
    let with = |inertia, floor| {
        let weighting = Weighting {
            inertia,
            stiffness: Profile::Linear,
            floor,
        };
        overlap.weights(&weighting)
    };
    let inner = 0.01;
    assert_eq!(
        with(Profile::Constant(inner), 0.0).unwrap_err(),
        Error::Reflects { inner }
    );
    for (profile, floor) in [
        (Profile::Constant(1.0), 0.0),
        (Profile::Constant(f64::NAN), 0.0),
        (Profile::Linear, 0.5),
        (Profile::Linear, -0.1),
    ] {
        assert!(matches!(with(profile, floor), Err(Error::Range { .. })));
    }
    assert!(with(Profile::Constant(0.5), 0.0).is_ok());
    // An outer model that goes on through the whole inner one has no end there.
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    assert!(overlap.removed().is_empty());
    let model = Model::Outer;
    assert_eq!(
        overlap.weights(&Weighting::default()).unwrap_err(),
        Error::NoBorder { model }
    );
    let constant = Weighting {
        inertia: Profile::Constant(0.5),
        stiffness: Profile::Constant(0.5),
        floor: 0.0,
    };
    assert!(overlap.weights(&constant).is_ok());
}

/// Plates whose inner mesh ends just beyond a line of outer nodes.
fn with_slivers() -> Pair {
    Pair::new(
        plate([0.0, 0.0], [2.001, 1.0], [20, 5], true),
        plate([1.0, 0.0], [4.0, 1.0], [12, 4], false),
    )
}

#[test]
fn functions_with_a_sliver_of_support_are_merged_or_dropped_and_named() {
    let pair = with_slivers();
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    let rows = |slivers, sliver| {
        overlap
            .rows(&Coupling {
                slivers,
                sliver,
                ..Coupling::default()
            })
            .unwrap()
    };
    let all = rows(SliverRule::Merge, 0.0);
    let (merged, dropped) = (rows(SliverRule::Merge, 0.02), rows(SliverRule::Drop, 0.02));
    assert_eq!(all.rows.len(), 2 * 6 * 5);
    assert!(all.slivers.is_empty());
    for rows in [&merged, &dropped] {
        assert_eq!(rows.rows.len(), 2 * 5 * 5);
        assert_eq!(rows.slivers.len(), 5);
        // A strip of 0.001 of the cell of 0.25 on one side of x = 2.25, and half of the support is beyond it.
        for sliver in &rows.slivers {
            assert!((sliver.fraction - 0.002).abs() < 1e-9);
            assert!((pair.mesh.nodes[sliver.node as usize][0] - 2.25).abs() < 1e-12);
        }
    }
    assert!(merged.slivers.iter().all(|s| s.into.is_some()));
    assert!(dropped.slivers.iter().all(|s| s.into.is_none()));
    let free = |_, _| false;
    let [all, merged, dropped] =
        [all, merged, dropped].map(|rows| rows.rank(free).unwrap().smallest);
    println!("least eigenvalues: all {all:.2e}, merged {merged:.2e}, dropped {dropped:.2e}");
    assert!(merged > 0.01 && dropped > 0.01 && all < merged);
}

#[test]
fn the_rank_tells_dependent_rows_and_dropping_them_helps() {
    // Equal meshes, the lower side held in y in both models: as many differences as nodes off the side, but a row for
    // each node.
    let pair = Pair::new(
        plate([0.0, 0.0], [2.0, 1.0], [8, 4], false),
        plate([1.0, 0.0], [3.0, 1.0], [8, 4], false),
    );
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    let mut rows = overlap.rows(&Coupling::default()).unwrap();
    let nodes = &pair.mesh.nodes;
    let blocked = |node: u32, component: u32| component == 1 && nodes[node as usize][1] == 0.0;
    let before = rows.rank(blocked).unwrap();
    assert!(before.smallest < 1e-12, "{}", before.smallest);
    assert_eq!(before.weakest.1, 1);
    let gone = rows.drop(blocked);
    assert_eq!(gone.len(), 5);
    assert!(
        gone.iter()
            .all(|&(node, component)| blocked(node, component))
    );
    assert!(rows.rank(blocked).unwrap().smallest > 1e-3);
    // The same row twice.
    let twice = rows.rows[3].clone();
    rows.rows.push(twice);
    assert!(rows.rank(blocked).unwrap().smallest < 1e-12);
}

#[test]
fn the_least_eigenvalue_is_that_of_the_gram_matrix() {
    // Two unit rows at a known angle: eigenvalues 1 ± cos.
    let pair = bars();
    let overlap = Overlap::new(pair.models(), &region(1.0, 9.0)).unwrap();
    let mut rows = overlap.rows(&Coupling::default()).unwrap();
    rows.rows.truncate(2);
    let mut random = Random(3);
    for angle in [1.0, 0.3, 0.01] {
        let cos = f64::cos(angle);
        for (row, entries) in rows.rows.iter_mut().zip([[1.0, 0.0], [cos, angle.sin()]]) {
            let term = row.outer[0];
            let scale = 1.0 + random.unit();
            row.inner.clear();
            row.outer = entries
                .iter()
                .enumerate()
                .map(|(i, e)| carom_arlequin::Term {
                    node: i as u32,
                    coefficient: scale * e,
                    ..term
                })
                .collect();
        }
        let found = rows.rank(|_, _| false).unwrap().smallest;
        assert!((found - (1.0 - cos)).abs() < 1e-5 * (1.0 - cos), "{found}");
    }
}

#[test]
fn unknowns_of_two_overlaps_are_found() {
    // Two zones of one outer bar, whose overlaps meet at one outer node.
    let left = Pair::new(line(0.0, 2.0, 40), line(1.0, 4.0, 15));
    let overlap = Overlap::new(left.models(), &Region::Intersection).unwrap();
    let one = overlap.rows(&Coupling::default()).unwrap();
    let mut other = one.clone();
    other
        .rows
        .retain(|row| left.mesh.nodes[row.node as usize][0] > 1.9);
    assert_eq!(
        one.shared(&other),
        [(other.rows[0].node, 0)].into_iter().collect()
    );
    let shared = one.shared(&other);
    other.drop(|node, component| shared.contains(&(node, component)));
    assert!(other.rows.is_empty());
}

#[test]
fn the_mediator_is_the_coarser_model_or_the_one_chosen() {
    let pair = bars();
    let overlap = Overlap::new(pair.models(), &region(1.0, 9.0)).unwrap();
    let count = |mediator| {
        let coupling = Coupling {
            mediator,
            ..Coupling::default()
        };
        overlap.rows(&coupling).unwrap().rows.len()
    };
    for kappa in [-1.0, f64::NAN, f64::INFINITY] {
        let coupling = Coupling {
            bracket: Bracket::H1 { kappa: Some(kappa) },
            ..Coupling::default()
        };
        assert!(matches!(overlap.rows(&coupling), Err(Error::Range { .. })));
    }
    assert_eq!(count(Mediator::Coarser), 6);
    assert_eq!(count(Mediator::Of(Model::Outer)), 6);
    assert_eq!(count(Mediator::Of(Model::Inner)), 21);
}
