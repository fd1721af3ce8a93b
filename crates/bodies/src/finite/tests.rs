//! The kernels of W elements against the sweep over one element after the other, which shares no sum over nodes with them.

use carom_algebra::unknowns::Unknowns;
use carom_elements::Kind;
use carom_materials::{
    Branch, Elastic, HardeningPoint, J2Plasticity, J2Table, JohnsonCook, Law, Maxwell,
    MooneyRivlin, NeoHooke, StVenantKirchhoff, Thermal,
};
use pulp::{Arch, Scalar, Simd};

use super::body::{Finite, Outcome};
use super::cell::Shape;
use super::kernel::Sweep;
use super::tangents::Tangents;
use super::{Formulation, Placement};
use crate::Kinematics;
use crate::block::{Block, Physics};
use crate::continuum;
use crate::nodes::Nodes;
use crate::weights::CellWeights;

const INITIAL: Elastic = Elastic {
    density: 1.0,
    young: 2.0,
    poisson: 0.3,
};

fn laws() -> [Law; 7] {
    let branch = |ratio, time| Some(Branch { ratio, time });
    [
        Law::StVenantKirchhoff(StVenantKirchhoff { initial: INITIAL }),
        Law::NeoHooke(NeoHooke { initial: INITIAL }),
        Law::MooneyRivlin(MooneyRivlin {
            density: 1.0,
            c10: 0.3,
            c01: 0.1,
            bulk: 2.0,
        }),
        Law::J2Plasticity(J2Plasticity {
            initial: INITIAL,
            yield_stress: 0.05,
            hardening: 0.3,
        }),
        Law::Maxwell(Maxwell {
            initial: INITIAL,
            branches: [branch(0.3, 0.4), branch(0.2, 3.0), None, None],
        }),
        Law::J2Table(J2Table {
            initial: INITIAL,
            hardening: std::array::from_fn(|k| {
                let point = [[0.0, 0.05], [0.05, 0.07], [0.3, 0.1]].get(k);
                point.map(|&[strain, stress]| HardeningPoint { strain, stress })
            }),
        }),
        Law::JohnsonCook(JohnsonCook {
            initial: INITIAL,
            yield_stress: 0.05,
            hardening: 0.1,
            exponent: 0.6,
            rate_factor: 0.1,
            reference_rate: 0.02,
            thermal: Some(Thermal {
                exponent: 1.1,
                melting_rise: 3.0,
                specific_heat: 0.4,
                converted: 0.9,
            }),
        }),
    ]
}

/// Elements that share no node: reference cells, each distorted, and a displacement of moderate strain.
fn block(kind: Kind, kinematics: Kinematics, count: usize, weighted: bool) -> (Block, Vec<f64>) {
    let element = kind.table();
    let total = count * element.nodes;
    // nodes of quadratic cells are half as far apart
    let size = if element.is_quadratic() { 0.3 } else { 1.0 };
    let x = (0..total).map(|node| {
        let wave = |i: usize| 0.1 * size * ((3 * node + i) as f64).sin();
        let corner = element.reference[node % element.nodes];
        [0, 1, 2].map(|i| corner[i] + wave(i) + if i == 0 { 3.0 } else { 0.0 })
    });
    let law = continuum::Law::new(kinematics, INITIAL, element.dim);
    let weights = weighted.then(|| CellWeights {
        inertia: vec![1.0; total],
        stiffness: (0..total).map(|a| (a as f64).sin().powi(2)).collect(),
    });
    let elements: Vec<u32> = (0..total as u32).collect();
    let nodes = Nodes {
        elements: &elements,
        x: &x.collect::<Vec<_>>(),
        unknowns: &Unknowns::translations(element.dim, total),
    };
    let block = Block::new(
        (kind, kind.table().stiffness_rule),
        Physics::Continuum(law),
        &nodes,
        weights.as_ref(),
    );
    let u = (0..element.dim * total).map(|i| 0.15 * size * (i as f64).cos());
    (block, u.collect())
}

/// What a sweep leaves behind.
struct Swept {
    f: Vec<[f64; 3]>,
    new: Vec<f64>,
    outcome: Outcome,
}

/// Two steps, so that the second one begins with a history. `way`: 0 one by one, 1 by the best instruction set, 2 by none.
/// `between`: with the forces between the displacements of the first and of the second step.
fn swept(finite: &Finite, block: &Block, u: &[f64], way: usize, between: bool) -> Swept {
    let chunk = &block.chunks[0];
    let kept = finite.history_len(std::slice::from_ref(block));
    let mut old = vec![0.0; kept];
    let mut swept = None;
    let from: Vec<f64> = u.iter().rev().map(|u| 0.3 * u).collect();
    for scale in [0.5, 1.0] {
        let u: Vec<f64> = u.iter().map(|u| scale * u).collect();
        let at = Placement {
            u: &u,
            v: &[],
            from: between.then_some(&from[..]),
            frames: &[],
            dt: 0.7,
            old: &old,
        };
        let (mut new, mut f) = (vec![0.0; kept], vec![[0.0; 3]; chunk.nodes.len()]);
        let sweep = |new, f| Sweep {
            finite,
            block,
            chunk,
            at: &at,
            new,
            f,
        };
        let outcome = match way {
            0 => finite.singly((block, chunk), &at, &mut new, &mut f),
            1 => Arch::new().dispatch(sweep(&mut new, &mut f)),
            _ => Scalar.vectorize(sweep(&mut new, &mut f)),
        };
        old.clone_from(&new);
        swept = Some(Swept { f, new, outcome });
    }
    swept.unwrap()
}

fn near(found: f64, right: f64, scale: f64) -> bool {
    (found - right).abs() <= 1e-12 * scale
}

fn compare(finite: &Finite, (block, u): &(Block, Vec<f64>), between: bool, name: &str) {
    let right = swept(finite, block, u, 0, between);
    assert!(right.outcome.fault.is_none(), "{name}");
    let largest = right
        .f
        .iter()
        .flatten()
        .fold(0.0_f64, |m, f| m.max(f.abs()));
    for way in [1, 2] {
        let found = swept(finite, block, u, way, between);
        assert!(found.outcome.fault.is_none(), "{name}");
        for (a, b) in found.f.iter().flatten().zip(right.f.iter().flatten()) {
            assert!(near(*a, *b, largest), "{name}: force {a} {b}");
        }
        for (a, b) in found.new.iter().zip(&right.new) {
            assert!(near(*a, *b, 1.0), "{name}: history {a} {b}");
        }
        let (a, b) = (&found.outcome.stored, &right.outcome.stored);
        for (a, b) in [
            (a.strain, b.strain),
            (a.hardening, b.hardening),
            (a.dissipated, b.dissipated),
            (a.hourglass, b.hourglass),
            (a.viscous, b.viscous),
            (a.compression, b.compression),
        ] {
            assert!(near(a, b, right.outcome.stored.strain), "{name}: {a} {b}");
        }
        assert!(a.viscous >= 0.0);
        let is_viscous = finite.kept > finite.kept_by_law;
        assert_eq!(a.viscous > 0.0, is_viscous, "{name}");
    }
}

/// Some thousand operations on numbers of like size: 1e-12 of the largest.
#[test]
fn kernels_give_what_one_element_after_the_other_gives() {
    let strain = Kinematics::PlaneStrain { thickness: 0.2 };
    for (kind, kinematics) in [
        (Kind::Tri3, strain),
        (Kind::Tri3, Kinematics::Axisymmetric),
        (Kind::Quad4, strain),
        (Kind::Quad4, Kinematics::Axisymmetric),
        (Kind::Tri6, strain),
        (Kind::Tri6, Kinematics::Axisymmetric),
        (Kind::Tet4, Kinematics::Solid),
        (Kind::Tet10, Kinematics::Solid),
        (Kind::Wedge6, Kinematics::Solid),
        (Kind::Hex8, Kinematics::Solid),
    ] {
        let one_point = Formulation::Reduced { hourglass: 0.3 };
        let has_one_point = matches!(kind, Kind::Quad4 | Kind::Hex8);
        let formulations = [Formulation::Full, Formulation::BBar, one_point];
        let own = 2 + usize::from(has_one_point);
        for formulation in formulations.into_iter().take(own) {
            for (count, weighted) in [(1, false), (8, true), (19, false), (19, true)] {
                let sample = block(kind, kinematics, count, weighted);
                let mut damped = block(kind, kinematics, count, weighted);
                let coefficients = (0..count).map(|k| [0.1 + 0.01 * k as f64, 0.05]);
                damped.0.chunks[0].viscosity = coefficients.collect();
                for law in laws() {
                    let shape = Shape {
                        kinematics,
                        formulation,
                        shear_modulus: INITIAL.shear_modulus(),
                    };
                    let name = format!(
                        "{kind:?} {kinematics:?} {formulation:?} {} {count}",
                        law.key()
                    );
                    let finite = Finite::new(law, shape, false, None);
                    compare(&finite, &sample, false, &name);
                    let viscous = Finite::new(law, shape, true, None);
                    compare(&viscous, &damped, false, &format!("{name} viscous"));
                    if !law.dissipates() {
                        compare(&finite, &sample, true, &format!("{name} between"));
                    }
                }
            }
        }
    }
}

/// Tangents at a displacement; `way` and `between` as above.
fn tangents(
    finite: &Finite,
    (block, u): (&Block, &[f64]),
    way: usize,
    between: bool,
) -> Result<Vec<f64>, usize> {
    let from: Vec<f64> = u.iter().rev().map(|u| 0.3 * u).collect();
    let at = Placement {
        u,
        v: &[],
        from: between.then_some(&from[..]),
        frames: &[],
        dt: 0.7,
        old: &[],
    };
    let entries = (finite.shape.dim() * block.kind.table().nodes).pow(2);
    let mut out = vec![f64::NAN; block.len() * entries];
    let several = |out| Tangents {
        finite,
        block,
        chunk: &block.chunks[0],
        at: &at,
        first: 0,
        out,
    };
    let done = match way {
        0 => finite.tangents_singly(block, &at, (0, &mut out)),
        1 => Arch::new().dispatch(several(&mut out)),
        _ => Scalar.vectorize(several(&mut out)),
    };
    done.map(|()| out).map_err(|(place, _)| place)
}

/// As the forces.
#[test]
fn tangents_of_several_elements_are_those_of_one_after_the_other() {
    let strain = Kinematics::PlaneStrain { thickness: 0.2 };
    for (kind, kinematics) in [
        (Kind::Tri3, strain),
        (Kind::Quad4, strain),
        (Kind::Quad4, Kinematics::Axisymmetric),
        (Kind::Tri6, Kinematics::Axisymmetric),
        (Kind::Tet4, Kinematics::Solid),
        (Kind::Tet10, Kinematics::Solid),
        (Kind::Wedge6, Kinematics::Solid),
        (Kind::Hex8, Kinematics::Solid),
    ] {
        for (count, weighted) in [(1, false), (19, true)] {
            let (block, u) = block(kind, kinematics, count, weighted);
            for law in laws() {
                let shape = Shape {
                    kinematics,
                    formulation: Formulation::Full,
                    shear_modulus: INITIAL.shear_modulus(),
                };
                let finite = Finite::new(law, shape, false, None);
                assert_eq!(finite.takes_tangents(&block), !law.dissipates());
                for between in [false, true] {
                    if law.dissipates() {
                        continue;
                    }
                    let of = |way| tangents(&finite, (&block, &u), way, between).unwrap();
                    let right = of(0);
                    let largest = right.iter().fold(0.0_f64, |m, k| m.max(k.abs()));
                    for way in [1, 2] {
                        for (a, b) in of(way).iter().zip(&right) {
                            let name = format!("{kind:?} {kinematics:?} {} {between}", law.key());
                            assert!(near(*a, *b, largest), "{name}: tangent {a} {b}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn an_element_inside_out_is_named() {
    let (block, mut u) = block(Kind::Hex8, Kinematics::Solid, 19, false);
    for law in laws() {
        for formulation in [Formulation::Full, Formulation::BBar] {
            let shape = Shape {
                kinematics: Kinematics::Solid,
                formulation,
                shear_modulus: 1.0,
            };
            // the eleventh element is turned about no axis: all its nodes in one plane and beyond
            for node in 80..88 {
                u[3 * node] = -2.5 * block.chunks[0].x[node][0];
            }
            let finite = Finite::new(law, shape, false, None);
            for way in [0, 1, 2] {
                for between in [false, true] {
                    let fault = swept(&finite, &block, &u, way, between).outcome.fault;
                    // a law without a stress between two displacements has none in the first element
                    let right = if between && law.dissipates() { 0 } else { 10 };
                    assert_eq!(fault.map(|(place, _)| place), Some(right), "{}", law.key());
                    if finite.takes_tangents(&block) {
                        let found = tangents(&finite, (&block, &u), way, between);
                        assert_eq!(found.err(), Some(right), "{}", law.key());
                    }
                }
            }
        }
    }
}
