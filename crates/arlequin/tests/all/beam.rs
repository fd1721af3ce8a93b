//! Overlaps of a beam and a solid: where they are, weights, rows, refusals.

use carom_arlequin::{
    BeamCell, BeamModels, BeamOverlap, Error, Model, Region, Row, SectionMotion, Weighting,
};
use carom_mesh::{ElementId, Mesh, generate};

const HEIGHT: f64 = 0.2;

/// A solid from 0 to 1 and a beam between two places, in the plane: mesh, cells of the solid, elements.
fn models(beam: [f64; 2], elements: usize) -> (Mesh, Vec<ElementId>, Vec<BeamCell>) {
    let mut mesh = generate::rectangle("solid", [0.0, -0.1], [1.0, HEIGHT], [10, 2], false);
    let ends = beam.map(|x| [x, 0.0, 0.0]);
    mesh.merge(
        "beam",
        generate::line("beam", ends[0], ends[1], elements, 2),
    )
    .unwrap();
    let solid = mesh.groups["solid"].elements.clone();
    let cells = mesh.groups["beam"].elements.iter().map(|&cell| {
        let nodes = mesh.element_nodes(cell);
        let mut second_moment = [[0.0; 3]; 3];
        second_moment[1][1] = HEIGHT.powi(3) / 12.0;
        BeamCell {
            cell,
            ends: [0, 1].map(|i| mesh.nodes[nodes[i] as usize]),
            area: HEIGHT,
            second_moment,
        }
    });
    let cells = cells.collect();
    (mesh, solid, cells)
}

/// Displacement and rotation linear along the element.
fn motion(_: usize, xi: f64) -> SectionMotion {
    std::array::from_fn(|i| {
        std::array::from_fn(|k| match (k % 6 == i, k < 6) {
            (false, _) => 0.0,
            (true, true) => 1.0 - xi,
            (true, false) => xi,
        })
    })
}

fn with<T>(
    beam: [f64; 2],
    elements: usize,
    region: impl Fn(&Mesh) -> Region,
    then: impl FnOnce(&Mesh, Result<BeamOverlap, Error>) -> T,
) -> T {
    let (mesh, solid, cells) = models(beam, elements);
    let models = BeamModels {
        mesh: &mesh,
        solid: &solid,
        thickness: 1.0,
        beam: &cells,
        motion: &motion,
        beam_is: Model::Outer,
    };
    then(&mesh, BeamOverlap::new(models, &region(&mesh)))
}

fn all(_: &Mesh) -> Region {
    Region::Intersection
}

/// Cells of the solid within 0.3 of its two ends.
fn both_ends(mesh: &Mesh) -> Region {
    let cells = mesh.groups["solid"].elements.iter().copied();
    let near = |cell: &ElementId| {
        let x = mesh.nodes[mesh.element_nodes(*cell)[0] as usize][0];
        !(0.25..0.65).contains(&x)
    };
    Region::Cells(cells.filter(near).collect())
}

#[test]
fn a_beam_through_a_solid_falls_away_between_the_ends_of_the_region() {
    with([-1.0, 2.0], 30, both_ends, |mesh, overlap| {
        let overlap = overlap.unwrap();
        assert!((overlap.length() - 0.6).abs() < 1e-12);
        assert_eq!(overlap.removed().len(), 4);
        let weights = overlap.weights(&Weighting::default()).unwrap();
        // the two weights add up to one along the axis, and are linear in each part
        let solid = |x: f64| (x / 0.3).min((1.0 - x) / 0.3).clamp(0.0, 1.0);
        for (k, &cell) in overlap.cells(Model::Outer).iter().enumerate() {
            for (i, &node) in mesh.element_nodes(cell).iter().enumerate() {
                let x = mesh.nodes[node as usize][0];
                let expected = if (0.0..=1.0).contains(&x) {
                    1.0 - solid(x)
                } else {
                    1.0
                };
                assert!(
                    (weights.outer.stiffness[2 * k + i] - expected).abs() < 1e-12,
                    "{x}"
                );
            }
        }
        for (k, &cell) in overlap.cells(Model::Inner).iter().enumerate() {
            for (i, &node) in mesh.element_nodes(cell).iter().enumerate() {
                let x = mesh.nodes[node as usize][0];
                assert!(
                    (weights.inner.inertia[4 * k + i] - solid(x)).abs() < 1e-12,
                    "{x}"
                );
            }
        }
        // four nodes of the mediator in each part
        assert_eq!(overlap.rows().unwrap().rows.len(), 2 * 4 * 3);
    });
}

#[test]
fn rows_vanish_for_every_motion_of_the_sections_of_the_beam() {
    // u and θ linear along x: of the solid u(x) + θ(x) × r, which bilinear cells have; elements do not match cells
    let field = |x: &[f64; 3], component: usize, on_beam: bool| {
        let turned = 0.3 - 0.7 * x[0];
        match component {
            0 => 0.2 + 0.5 * x[0] - if on_beam { 0.0 } else { turned * x[1] },
            1 => -0.4 + 0.9 * x[0],
            _ => turned,
        }
    };
    with([0.47, 1.9], 13, all, |mesh, overlap| {
        let rows = overlap.unwrap().rows().unwrap();
        assert!(rows.rank(|_, _| false).unwrap().smallest > 1e-3);
        for row in &rows.rows {
            let side = |terms, on_beam| {
                Row::apply(terms, |node, k| {
                    field(&mesh.nodes[node as usize], k, on_beam)
                })
            };
            // rounding of some hundred products of the size of the cells
            let (solid, beam) = (side(&row.inner, false), side(&row.outer, true));
            assert!((solid - beam).abs() < 1e-15, "{solid} {beam}");
        }
    });
}

#[test]
fn overlaps_without_two_ends_or_with_other_sections_are_refused() {
    with([-1.0, 2.0], 30, all, |_, overlap| {
        assert!(matches!(
            overlap.err(),
            Some(Error::NoEnd {
                model: Model::Outer
            })
        ));
    });
    with([0.2, 0.8], 6, all, |_, overlap| {
        assert!(matches!(
            overlap.err(),
            Some(Error::NoEnd {
                model: Model::Inner
            })
        ));
    });
    with([1.1, 2.0], 9, all, |_, overlap| {
        assert!(matches!(overlap.err(), Some(Error::Empty)));
    });
    with([0.95, 1.95], 10, all, |_, overlap| {
        assert!(matches!(overlap.err(), Some(Error::Short { .. })));
    });
    let short = |_: &Mesh| Region::Box {
        min: [0.4, -1.0, 0.0],
        max: [0.8, 1.0, 0.0],
    };
    with([0.4, 2.0], 16, short, |_, overlap| {
        assert!(matches!(
            overlap.err(),
            Some(Error::SolidEndsOutside { .. })
        ));
    });
    let (mesh, solid, mut cells) = models([0.5, 2.0], 15);
    cells.iter_mut().for_each(|cell| cell.area *= 2.0);
    let models = BeamModels {
        mesh: &mesh,
        solid: &solid,
        thickness: 1.0,
        beam: &cells,
        motion: &motion,
        beam_is: Model::Outer,
    };
    let error = BeamOverlap::new(models, &Region::Intersection).err();
    assert!(matches!(error, Some(Error::Section { what: "area", .. })));
}
