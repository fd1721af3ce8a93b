//! The patch test in its static sense: in a state of constant stress the weighted internal forces of both models are
//! balanced by some multiplier, C_cᵀ L = f_c and -C_sᵀ L = f_s, at every node off the surface of the body.
//!
//! Also its kinematic half: the rows are the same for both models on every affine field.

use carom_arlequin::{
    Bracket, Coupling, Integration, Mediator, Model, Overlap, Region, Row, Weighting,
};
use carom_mesh::Mesh;

use crate::support::{
    Pair, Random, block, imbalance, imbalance_of_constant, internal_forces, plate,
};

/// A stress without symmetry axes, in Pa.
const STRESS: [[f64; 3]; 3] = [[1.0, 0.4, -0.3], [0.4, -0.7, 0.2], [-0.3, 0.2, 0.5]];

/// Models of a body with one corner at the origin; `size` of the body.
struct Body {
    pair: Pair,
    region: Region,
    /// Whether a node is on the surface of the body.
    surface: Vec<bool>,
}

impl Body {
    fn new(inner: Mesh, outer: Mesh, size: &[f64], region: Region) -> Body {
        let pair = Pair::new(inner, outer);
        let on = |x: &[f64; 3]| {
            let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
            size.iter()
                .zip(x)
                .any(|(&l, &x)| near(x, 0.0) || near(x, l))
        };
        Body {
            surface: pair.mesh.nodes.iter().map(on).collect(),
            pair,
            region,
        }
    }

    /// Moves all nodes by an affine map, under which a strip stays a strip.
    fn mapped(mut self, map: impl Fn([f64; 3]) -> [f64; 3]) -> Body {
        self.pair = self.pair.mapped(map);
        self
    }

    /// Moves the nodes in S and off the surface of the body at random: cells lose their parallel sides.
    fn shaken(mut self, amount: f64, model: Model) -> Body {
        let mut random = Random(7);
        let cells = match model {
            Model::Inner => &self.pair.inner,
            Model::Outer => &self.pair.outer,
        };
        let mut own = vec![false; self.surface.len()];
        for &id in cells {
            for &node in self.pair.mesh.element_nodes(id) {
                own[node as usize] = true;
            }
        }
        // The nodes on the borders of S stay, so that it remains a strip.
        let ends = [2.0, 3.2, 1.5, 2.8, 3.0];
        for (i, x) in self.pair.mesh.nodes.iter_mut().enumerate() {
            let on_end = ends.iter().any(|e| (x[0] - e).abs() < 1e-9);
            for k in 0..self.pair.mesh.dim {
                let d = amount * (random.unit() - 0.5);
                if own[i] && !on_end && !self.surface[i] {
                    x[k] += d;
                }
            }
        }
        self
    }

    fn overlap(&self) -> Overlap<'_> {
        Overlap::new(self.pair.models(), &self.region).unwrap()
    }

    /// Least imbalance of the forces relative to the largest, over all multipliers or over the constant ones.
    fn imbalance(&self, coupling: &Coupling, constant: bool) -> f64 {
        let mesh = &self.pair.mesh;
        let overlap = self.overlap();
        let weights = overlap.weights(&Weighting::default()).unwrap();
        let rows = overlap.rows(coupling).unwrap();
        let deltas = [&weights.inner.stiffness, &weights.outer.stiffness];
        let mut force = vec![0.0; 3 * mesh.nodes.len()];
        for (model, delta) in [Model::Inner, Model::Outer].into_iter().zip(deltas) {
            let own = internal_forces(mesh, overlap.cells(model), delta, &STRESS);
            force.iter_mut().zip(&own).for_each(|(f, own)| *f += own);
        }
        let counts = (0..force.len()).map(|i| !self.surface[i / 3] && i % 3 < mesh.dim);
        let counts: Vec<bool> = counts.collect();
        match constant {
            true => imbalance_of_constant(&rows, &force, &counts, mesh.dim),
            false => imbalance(&rows, &force, &counts),
        }
    }

    /// Largest difference of the two sides of a row on an affine field, relative to its size.
    fn kinematic_defect(&self, coupling: &Coupling) -> f64 {
        let rows = self.overlap().rows(coupling).unwrap();
        let nodes = &self.pair.mesh.nodes;
        let (mut worst, mut largest) = (0.0f64, 0.0f64);
        for row in &rows.rows {
            for slope in 0..4 {
                let field = |node: u32, k: usize| match slope {
                    3 => 1.0,
                    slope => nodes[node as usize][(slope + k) % 3] - 0.3 * k as f64,
                };
                let (c, s) = (Row::apply(&row.inner, field), Row::apply(&row.outer, field));
                worst = worst.max((c - s).abs());
                largest = largest.max(c.abs());
            }
        }
        worst / largest
    }
}

fn shear(x: [f64; 3]) -> [f64; 3] {
    [x[0] + 0.7 * x[1] - 0.2 * x[2], x[1] + 0.3 * x[2], x[2]]
}

fn turn(x: [f64; 3]) -> [f64; 3] {
    let (c, s) = (0.6, 0.8);
    [c * x[0] - s * x[1] + 5.0, s * x[0] + c * x[1] - 1.0, x[2]]
}

/// A plate 6 by 2: inner cells up to x = 3.2, outer ones of 0.5 from x = 2.
fn plates(n: [usize; 2], triangles: [bool; 2]) -> Body {
    let inner = plate([0.0, 0.0], [3.2, 2.0], n, triangles[0]);
    let outer = plate([2.0, 0.0], [6.0, 2.0], [8, 4], triangles[1]);
    Body::new(inner, outer, &[6.0, 2.0], Region::Intersection)
}

/// A block 4 by 1 by 1: inner cells up to x = 2.8, outer ones of 0.5 from x = 1.5.
fn blocks(n: [usize; 3], tets: [bool; 2]) -> Body {
    let inner = block([0.0; 3], [2.8, 1.0, 1.0], n, tets[0]);
    let outer = block([1.5, 0.0, 0.0], [4.0, 1.0, 1.0], [5, 2, 2], tets[1]);
    Body::new(inner, outer, &[4.0, 1.0, 1.0], Region::Intersection)
}

/// Mediators and brackets in all pairs.
fn couplings() -> Vec<Coupling> {
    let mut all = Vec::new();
    for mediator in [Mediator::Coarser, Mediator::Of(Model::Inner)] {
        for bracket in [Bracket::L2, Bracket::H1 { kappa: None }] {
            all.push(Coupling {
                mediator,
                bracket,
                ..Coupling::default()
            });
        }
    }
    all
}

fn assert_passes(body: &Body, coupling: &Coupling) {
    // On a strip the multiplier is σ grad δ, a constant.
    let imbalance = body.imbalance(coupling, true);
    let defect = body.kinematic_defect(coupling);
    // 1e-10 is the bound for the patch; sums of a few hundred terms leave some 1e-14 in the rows.
    assert!(imbalance < 1e-10, "{coupling:?}: {imbalance}");
    assert!(defect < 1e-13, "{coupling:?}: {defect}");
}

#[test]
fn plates_pass_nested_and_not_straight_and_oblique() {
    for triangles in [[true, false], [false, false], [false, true], [true, true]] {
        // 0.1 nested in 0.5; 0.2 by 2/11 in no way nested.
        for n in [[32, 20], [16, 11]] {
            for coupling in couplings() {
                assert_passes(&plates(n, triangles), &coupling);
                assert_passes(&plates(n, triangles).mapped(shear), &coupling);
                assert_passes(&plates(n, triangles).mapped(turn), &coupling);
            }
        }
    }
}

#[test]
fn blocks_pass_nested_and_not_straight_and_oblique() {
    for (tets, n) in [
        ([true, false], [14, 5, 5]),
        ([true, false], [28, 10, 10]),
        ([false, false], [14, 5, 5]),
        ([false, true], [10, 3, 4]),
        ([true, true], [10, 3, 4]),
    ] {
        let coupling = Coupling::default();
        assert_passes(&blocks(n, tets), &coupling);
    }
    for coupling in couplings() {
        assert_passes(
            &blocks([10, 3, 4], [true, false]).mapped(shear).mapped(turn),
            &coupling,
        );
    }
}

#[test]
fn an_outer_mesh_over_the_whole_body_passes_in_a_box_that_fits_no_mesh() {
    // The box cuts outer cells at 1.7 and ends beyond the inner model, at x = 3.2.
    let region = Region::Box {
        min: [1.7, -9.0, -9.0],
        max: [9.0; 3],
    };
    for triangles in [[false, true], [true, true], [true, false]] {
        let inner = plate([0.0, 0.0], [3.2, 2.0], [16, 11], triangles[0]);
        let outer = plate([0.0, 0.0], [6.0, 2.0], [12, 4], triangles[1]);
        let body = Body::new(inner, outer, &[6.0, 2.0], region.clone());
        let overlap = body.overlap();
        // Three of twelve columns of cells lie left of the box.
        let columns = if triangles[1] { 2 } else { 1 };
        assert_eq!(overlap.removed().len(), 3 * 4 * columns);
        assert!((overlap.measure() - 1.5 * 2.0).abs() < 1e-12);
        assert_passes(&body, &Coupling::default());
    }
}

#[test]
fn distorted_cells_pass_to_the_error_of_their_quadrature() {
    let amount = 0.1;
    let aligned = |triangles| {
        let inner = plate([0.0, 0.0], [3.0, 2.0], [15, 11], triangles);
        let outer = plate([2.0, 0.0], [6.0, 2.0], [8, 4], false);
        Body::new(inner, outer, &[6.0, 2.0], Region::Intersection)
    };
    let outer = 2.0 * amount;
    let cut = || plates([16, 11], [false, false]);
    // Distorted cells whose borders the overlap follows miss by the error of their rule; those that it cuts, by what a
    // weight with a kink loses when it is given at four or eight nodes.
    for (name, body, least, largest) in [
        ("inner", cut().shaken(amount, Model::Inner), 0.0, 1e-8),
        (
            "outer",
            aligned(false).shaken(outer, Model::Outer),
            0.0,
            1e-8,
        ),
        (
            "under triangles",
            aligned(true).shaken(outer, Model::Outer),
            0.0,
            1e-8,
        ),
        ("cut outer", cut().shaken(outer, Model::Outer), 1e-6, 1e-2),
        (
            "cut block",
            blocks([10, 3, 4], [true, false]).shaken(amount, Model::Outer),
            1e-6,
            1e-2,
        ),
    ] {
        let coupling = Coupling::default();
        let imbalance = body.imbalance(&coupling, true);
        println!("{name}: imbalance {imbalance:.1e}");
        assert!(
            least <= imbalance && imbalance < largest,
            "{name}: {imbalance}"
        );
        assert!(body.kinematic_defect(&coupling) < 1e-13, "{name}");
    }
}

#[test]
fn quadrature_on_one_mesh_fails_in_the_plane_and_in_space() {
    let flat = plates([16, 11], [true, false]);
    let solid = blocks([10, 3, 4], [true, false]);
    for integration in [Integration::InnerOnly, Integration::OuterOnly] {
        let coupling = Coupling {
            integration,
            ..Coupling::default()
        };
        for body in [&flat, &solid] {
            let (imbalance, defect) = (
                body.imbalance(&coupling, false),
                body.kinematic_defect(&coupling),
            );
            println!("{integration:?}: {imbalance}");
            assert!(imbalance > 1e-4, "{integration:?}: {imbalance}");
            // The motion is still the same in both models: only the forces miss.
            assert!(defect < 1e-13);
        }
    }
}
