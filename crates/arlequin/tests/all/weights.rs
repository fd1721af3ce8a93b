//! Weights: partition of unity, moments, values, pictures.

use carom_arlequin::{CellWeights, Model, Overlap, Profile, Region, Weighting, Weights, means};
use carom_mesh::{ElementId, Mesh};

use crate::support::{Flat, Pair, at_points, block, keep, line, plate};

/// ∫ w and ∫ w x over some cells, by the mass rule.
fn moments(mesh: &Mesh, cells: &[ElementId], values: &[f64]) -> [f64; 4] {
    let weights = Flat::new(mesh, cells, values);
    let mut sums = [0.0; 4];
    at_points(mesh, cells, true, |i, n, _, w| {
        let here = w * weights.at(i, n);
        sums[0] += here;
        for (&node, n) in mesh.element_nodes(cells[i]).iter().zip(n) {
            let x = mesh.nodes[node as usize];
            (0..3).for_each(|k| sums[k + 1] += here * n * x[k]);
        }
    });
    sums
}

fn both(profile: Profile) -> Weighting {
    Weighting {
        inertia: profile,
        stiffness: profile,
        floor: 0.0,
    }
}

fn list(weights: &CellWeights) -> [&[f64]; 2] {
    [&weights.inertia, &weights.stiffness]
}

/// Sum of the moments of both models, for inertia and stiffness.
fn total(overlap: &Overlap, weights: &Weights) -> [[f64; 4]; 2] {
    let mesh = overlap.mesh();
    [0, 1].map(|k| {
        let inner = moments(mesh, overlap.cells(Model::Inner), list(&weights.inner)[k]);
        let outer = moments(mesh, overlap.cells(Model::Outer), list(&weights.outer)[k]);
        [0, 1, 2, 3].map(|i| inner[i] + outer[i])
    })
}

#[test]
fn the_integrals_of_both_weights_add_up_to_those_of_the_body() {
    let lines = Pair::new(line(0.0, 2.0, 23), line(0.0, 4.0, 20));
    let plates = |triangles: bool| {
        let inner = plate([0.0, 0.0], [2.0, 1.0], [11, 7], triangles);
        Pair::new(inner, plate([0.0, 0.0], [4.0, 1.0], [16, 4], !triangles))
    };
    let blocks = |tets: bool| {
        let inner = block([0.0; 3], [2.0, 1.0, 1.0], [7, 3, 2], tets);
        Pair::new(inner, block([0.0; 3], [4.0, 1.0, 1.0], [8, 2, 2], !tets))
    };
    let region = Region::Box {
        min: [1.0, -9.0, -9.0],
        max: [9.0; 3],
    };
    for pair in [
        lines,
        plates(false),
        plates(true),
        blocks(false),
        blocks(true),
    ] {
        let overlap = Overlap::new(pair.models(), &region).unwrap();
        for profile in [Profile::Constant(0.3), Profile::Linear, Profile::Smooth] {
            let weights = overlap.weights(&both(profile)).unwrap();
            assert!(weights.flattened.is_empty());
            let dim = pair.mesh.dim;
            for sums in total(&overlap, &weights) {
                // Measure 4, first moments 8, 2, 2: no point of the body is counted twice or not at all.
                for (found, exact) in sums[..=dim].iter().zip([4.0, 8.0, 2.0, 2.0]) {
                    assert!(
                        (found - exact).abs() < 1e-11,
                        "{dim} {profile:?}: {found} {exact}"
                    );
                }
            }
        }
    }
}

#[test]
fn integrals_of_the_weights_of_one_model_are_those_of_the_profile() {
    // The inner model loses ∫ (1 - w): 1/2 of S for linear and smooth weights. First moments over S = [1, 2]:
    // ∫ (1-w) x = 1 + 1/2 - 1/3 for 1 - w = t, x = 1 + t ... = ∫ t (1 + t) = 5/6; smooth: ∫ (3t² - 2t³)(1 + t) = 17/20.
    let pair = Pair::new(line(0.0, 2.0, 23), line(1.0, 4.0, 7));
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    for (profile, exact) in [(Profile::Linear, 5.0 / 6.0), (Profile::Smooth, 17.0 / 20.0)] {
        let weights = overlap.weights(&both(profile)).unwrap();
        let [mass, moment, ..] = moments(&pair.mesh, &pair.inner, &weights.inner.stiffness);
        assert!((mass - 1.5).abs() < 1e-13);
        assert!(
            (moment - (2.0 - exact)).abs() < 1e-13,
            "{profile:?} {moment}"
        );
    }
}

#[test]
fn linear_weights_are_the_linear_function_and_its_floor_is_kept() {
    let pair = Pair::new(
        plate([0.0, 0.0], [2.0, 1.0], [20, 5], true),
        plate([1.0, 0.0], [4.0, 1.0], [12, 4], false),
    );
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    for floor in [0.0, 0.1] {
        let weighting = Weighting {
            floor,
            ..Weighting::default()
        };
        let weights = overlap.weights(&weighting).unwrap();
        let flat = Flat::new(&pair.mesh, &pair.inner, &weights.inner.inertia);
        for (i, &id) in pair.inner.iter().enumerate() {
            let nodes = pair.mesh.element_nodes(id);
            let inside = nodes.iter().all(|&n| pair.mesh.nodes[n as usize][0] > 0.95);
            for (&node, w) in nodes.iter().zip(flat.of(i)) {
                let s = 2.0 - pair.mesh.nodes[node as usize][0];
                let exact = if inside {
                    floor + (1.0 - 2.0 * floor) * s
                } else {
                    1.0
                };
                assert!((w - exact).abs() < 1e-12, "{w} {exact}");
            }
        }
    }
}

#[test]
fn cells_outside_s_have_weight_one_and_those_inside_the_inner_model_are_removed() {
    let pair = Pair::new(line(0.0, 2.0, 20), line(0.0, 4.0, 20));
    let cells = pair.outer[5..9].to_vec();
    let overlap = Overlap::new(pair.models(), &Region::Cells(pair.outer[5..10].to_vec())).unwrap();
    assert_eq!(overlap.removed(), &pair.outer[..5]);
    assert_eq!(overlap.cells(Model::Outer), &pair.outer[5..]);
    assert!((overlap.measure() - 1.0).abs() < 1e-14 && (overlap.layers() - 5.0).abs() < 1e-9);
    assert!((overlap.size(Model::Inner) - 0.1).abs() < 1e-14 && overlap.coarser() == Model::Outer);
    let touched = overlap.touched(Model::Outer);
    assert_eq!(touched.len(), 5);
    assert!(
        touched
            .iter()
            .all(|(_, fraction)| (fraction - 1.0).abs() < 1e-12)
    );
    let weights = overlap.weights(&Weighting::default()).unwrap();
    assert_eq!(&weights.outer.inertia[10..], &[1.0; 20]);
    assert_eq!(&weights.inner.inertia[..20], &[1.0; 20]);
    let picture = means(
        &pair.mesh,
        overlap.cells(Model::Outer),
        &weights.outer.inertia,
    );
    for (i, mean) in picture.iter().enumerate() {
        let exact = if i < 5 { 0.1 + 0.2 * i as f64 } else { 1.0 };
        assert!((mean - exact).abs() < 1e-12);
    }
    // A group of the outer model that stops short of the end of the inner one leaves that end without coupling.
    let short = Overlap::new(pair.models(), &Region::Cells(cells)).unwrap_err();
    let end = vec![pair.inner[19]];
    assert_eq!(short, carom_arlequin::Error::EndsOutside { cells: end });
}

#[test]
fn a_border_that_cuts_cells_of_the_model_that_ends_there_never_makes_a_mass_negative() {
    // The box starts at nine tenths of an outer cell: the projection of the little weight in it would go below zero.
    let region = Region::Box {
        min: [0.98, -9.0, 0.0],
        max: [9.0, 9.0, 0.0],
    };
    let pair = Pair::new(
        plate([0.0, 0.0], [2.0, 1.0], [20, 5], true),
        plate([0.0, 0.0], [4.0, 1.0], [20, 5], true),
    );
    let overlap = Overlap::new(pair.models(), &region).unwrap();
    let weights = overlap.weights(&Weighting::default()).unwrap();
    assert!(!weights.flattened.is_empty());
    let flat = Flat::new(
        &pair.mesh,
        overlap.cells(Model::Outer),
        &weights.outer.inertia,
    );
    at_points(
        &pair.mesh,
        overlap.cells(Model::Outer),
        true,
        |i, n, _, _| {
            assert!(flat.at(i, n) >= -1e-12);
        },
    );
    for sums in total(&overlap, &weights) {
        assert!((sums[0] - 4.0).abs() < 1e-12);
    }
}

#[test]
fn two_separate_overlaps_have_borders_of_their_own() {
    // A zone in the middle of a bar: the weight of the inner model falls towards both of its ends.
    let outer = keep(line(0.0, 6.0, 30), |x| (x[0] - 3.0).abs() > 1.0);
    let pair = Pair::new(line(1.0, 5.0, 40), outer);
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    assert!(overlap.is_strip() && (overlap.measure() - 2.0).abs() < 1e-13);
    let weights = overlap.weights(&Weighting::default()).unwrap();
    for (i, pair) in weights.inner.stiffness.chunks(2).enumerate() {
        let x = [1.0 + 0.1 * i as f64, 1.1 + 0.1 * i as f64];
        for (w, x) in pair.iter().zip(x) {
            let exact = (2.0 - (x - 3.0f64).abs()).min(1.0);
            assert!((w - exact).abs() < 1e-12, "{x} {w}");
        }
    }
}

#[test]
fn the_partition_holds_where_borders_turn_a_corner() {
    let plates = Pair::new(
        plate([0.0, 0.0], [2.0, 2.0], [9, 10], true),
        keep(plate([0.0, 0.0], [4.0, 4.0], [12, 12], false), |x| {
            x[0] > 1.0 || x[1] > 1.0
        }),
    );
    let blocks = Pair::new(
        block([0.0; 3], [2.0; 3], [5, 5, 5], true),
        keep(block([0.0; 3], [4.0; 3], [8, 8, 8], false), |x| {
            x.iter().any(|&x| x > 1.0)
        }),
    );
    for (pair, measure) in [(plates, 3.0), (blocks, 7.0)] {
        let dim = pair.mesh.dim;
        let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
        assert!((overlap.measure() - measure).abs() < 1e-11 && !overlap.is_strip());
        // Two cells of 1/2 along the axes; the diagonal of a corner counts its cells along itself.
        assert!(
            overlap.layers() > 1.4 && overlap.layers() < 3.1,
            "{}",
            overlap.layers()
        );
        let weights = overlap.weights(&Weighting::default()).unwrap();
        let body = 4f64.powi(dim as i32);
        for sums in total(&overlap, &weights) {
            for (found, exact) in
                sums[..=dim]
                    .iter()
                    .zip([body, 2.0 * body, 2.0 * body, 2.0 * body])
            {
                assert!(
                    (found - exact).abs() < 1e-10 * body,
                    "{dim}: {found} {exact}"
                );
            }
        }
    }
}

#[test]
fn a_group_of_inner_cells_bounds_s_within_outer_ones() {
    // S = [0.9, 2]: the outer mesh, of step 0.2, is cut at 0.9.
    let pair = Pair::new(line(0.0, 2.0, 20), line(0.0, 4.0, 20));
    let region = Region::Cells(pair.inner[9..].to_vec());
    let overlap = Overlap::new(pair.models(), &region).unwrap();
    assert!((overlap.measure() - 1.1).abs() < 1e-13);
    assert_eq!(overlap.removed(), &pair.outer[..4]);
    assert!((overlap.touched(Model::Outer)[0].1 - 0.5).abs() < 1e-12);
    let weights = overlap.weights(&Weighting::default()).unwrap();
    // In the cell cut in half the projection is negative where the mass is integrated: its mass is kept, not its centre.
    assert_eq!(weights.flattened, [pair.outer[4]]);
    let [inertia, stiffness] = total(&overlap, &weights);
    assert!((inertia[0] - 4.0).abs() < 1e-12 && (inertia[1] - 8.0).abs() > 1e-6);
    assert!((stiffness[0] - 4.0).abs() < 1e-12 && (stiffness[1] - 8.0).abs() < 1e-12);
}

#[test]
fn meshes_that_differ_along_a_curved_side_still_make_a_strip() {
    // Sides swell by a tenth: the outer polygon cuts corners that the inner one follows, and the other way round.
    let swell = |x: [f64; 3]| {
        let factor = 1.0 + 0.1 * (1.1 * x[0]).sin();
        [x[0], factor * x[1], factor * x[2]]
    };
    let plates = Pair::new(
        plate([0.0, -0.5], [3.2, 0.5], [25, 7], true),
        plate([2.0, -0.5], [6.0, 0.5], [8, 2], false),
    );
    let blocks = Pair::new(
        block([0.0, -0.5, -0.5], [3.2, 0.5, 0.5], [13, 3, 3], true),
        block([2.0, -0.5, -0.5], [6.0, 0.5, 0.5], [8, 2, 2], false),
    );
    for pair in [plates.mapped(swell), blocks.mapped(swell)] {
        let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
        assert!(overlap.is_strip());
        assert!(
            (overlap.layers() - 2.4).abs() < 1e-6,
            "{}",
            overlap.layers()
        );
        let weights = overlap.weights(&Weighting::default()).unwrap();
        // The inner model keeps the thin parts that the outer one lacks, and the other way round: together they fill
        // their union.
        let mesh = &pair.mesh;
        let whole = |cells: &[ElementId]| {
            let mut sum = 0.0;
            at_points(mesh, cells, true, |_, _, _, w| sum += w);
            sum
        };
        let union = whole(&pair.inner) + whole(&pair.outer) - overlap.measure();
        for sums in total(&overlap, &weights) {
            assert!(
                (sums[0] - union).abs() < 1e-7 * union,
                "{} {union}",
                sums[0]
            );
        }
    }
}
