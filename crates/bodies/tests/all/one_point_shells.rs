//! Quadrilaterals of shells with one point: patches, rigid motions, energies and tangents, elements side by side against those alone.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use carom_bodies::{
    Body, BodySpec, Error, Formulation, Kinematics, Placement, Ply, Rotations, Scratch,
    ShellSection, Stored,
};
use carom_materials::{Elastic, J2Plasticity, Law};
use carom_mesh::{ElementId, Mesh};
use carom_testing::Random;

use crate::shells::{STEEL, THICKNESS, field, map, mesh, placement, random_motion, section};

const FULL_WEIGHT: Formulation = Formulation::Reduced { hourglass: 1.0 };

fn made(
    (mesh, cells): &(Mesh, Vec<ElementId>),
    material: impl Into<Law>,
    section: ShellSection,
) -> Result<Body, Error> {
    let mut spec = BodySpec::new("s", cells.clone(), Kinematics::Shell(section), material);
    spec.formulation = FULL_WEIGHT;
    let number: Vec<u32> = (0..9).collect();
    Body::new(mesh, spec, &number, &map(section.rotations))
}

fn elastic(made_of: &(Mesh, Vec<ElementId>)) -> Body {
    made(made_of, STEEL, section(Rotations::Finite, 0.0)).unwrap()
}

/// In the nodes; beside them with a thickness that changes; beside them of two plies.
fn sections(made_of: &(Mesh, Vec<ElementId>), formulation: Formulation) -> [Body; 3] {
    let nodes = made_of.0.nodes.iter();
    let taper = nodes.map(|x| THICKNESS * (1.0 - 0.3 * x[0] - 0.2 * x[1] * x[1]));
    let taper: Vec<f64> = taper.collect();
    let ply = |young, thickness| Ply {
        material: Law::Elastic(Elastic { young, ..STEEL }),
        thickness,
    };
    let plies = vec![ply(2e11, 0.4 * THICKNESS), ply(7e10, 0.6 * THICKNESS)];
    [
        (0.0, None, vec![]),
        (0.03, Some(taper), vec![]),
        (-0.02, None, plies),
    ]
    .map(|(offset, taper, plies)| {
        let section = section(Rotations::Finite, offset);
        let cells = made_of.1.clone();
        let mut spec = BodySpec::new("s", cells, Kinematics::Shell(section), STEEL);
        (spec.formulation, spec.plies) = (formulation, plies);
        spec.nodal_thickness = taper;
        let number: Vec<u32> = (0..9).collect();
        Body::new(&made_of.0, spec, &number, &map(Rotations::Finite)).unwrap()
    })
}

fn metal(made_of: &(Mesh, Vec<ElementId>)) -> Body {
    let law = J2Plasticity {
        initial: STEEL,
        yield_stress: 3e8,
        hardening: 2e9,
    };
    made(
        made_of,
        Law::J2Plasticity(law),
        section(Rotations::Finite, 0.0),
    )
    .unwrap()
}

fn forces(body: &Body, at: &Placement) -> (Vec<f64>, Stored) {
    let mut f = vec![0.0; 54];
    let mut scratch = Scratch::default();
    let mut new = vec![0.0; body.history_len()];
    let stored = body.force(at, &mut new, &mut scratch, &mut f).unwrap();
    (f, stored)
}

fn frames(random: &mut Random) -> Vec<Rotation> {
    let turn = |_| Rotation::cayley(&Vec3::from_fn(|_, _| 0.1 * random.next()));
    (0..9).map(turn).collect()
}

/// A motion without increments of the rotations.
fn start(random: &mut Random) -> Vec<f64> {
    let mut u = random_motion(random, 0.03);
    u.chunks_exact_mut(6).for_each(|own| own[3..].fill(0.0));
    u
}

/// Forces over a step without motion are those at its start; they come from the lists of the elements one by one.
#[test]
fn elements_side_by_side_are_those_alone() {
    let mut random = Random(41);
    let made_of = mesh(false, 0.05);
    let (frames, u) = (frames(&mut random), start(&mut random));
    let still = vec![0.0; 54];
    for body in sections(&made_of, FULL_WEIGHT) {
        let (f, stored) = forces(&body, &placement(&u, None, &frames, &still));
        let (g, other) = forces(&body, &placement(&u, Some(&u), &frames, &still));
        let scale = f.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        assert!(f.iter().zip(&g).all(|(f, g)| (f - g).abs() < 1e-12 * scale));
        assert!((stored.strain / other.strain - 1.0).abs() < 1e-12);
        // the stiffness of full integration is that of the material
        assert_eq!([stored.hourglass, other.hourglass], [0.0; 2]);
    }
    for body in sections(&made_of, Formulation::Reduced { hourglass: 0.05 }) {
        let (_, stored) = forces(&body, &placement(&u, None, &frames, &still));
        let (_, other) = forces(&body, &placement(&u, Some(&u), &frames, &still));
        assert!((stored.hourglass / other.hourglass - 1.0).abs() < 1e-12);
        assert!(stored.hourglass > 0.0);
    }
}

#[test]
fn forces_are_the_derivative_of_the_energy_and_tangents_that_of_forces() {
    let mut random = Random(43);
    let made_of = mesh(false, 0.05);
    for formulation in [FULL_WEIGHT, Formulation::Full] {
        for body in sections(&made_of, formulation) {
            differentiates(&body, &mut random);
        }
    }
}

fn differentiates(body: &Body, random: &mut Random) {
    let (frames, u) = (frames(random), start(random));
    let (way, still) = (random_motion(random, 1.0), vec![0.0; 54]);
    let at = |step: f64| {
        let moved: Vec<f64> = u.iter().zip(&way).map(|(u, w)| u + step * w).collect();
        forces(body, &placement(&moved, None, &frames, &still))
    };
    let energies = |step: f64| [step, 0.0, -step].map(|step| at(step).1.strain);
    let step = 1e-6;
    let [after, _, before] = energies(step);
    let slope = (after - before) / (2.0 * step);
    let work: f64 = at(0.0).0.iter().zip(&way).map(|(f, w)| f * w).sum();
    // the square of the step over the motion of 0.03
    assert!((work / slope - 1.0).abs() < 1e-7, "{work} {slope}");
    let second = product(body, &placement(&u, None, &frames, &still), &way);
    let second: f64 = second.iter().zip(&way).map(|(k, w)| k * w).sum();
    let step = 1e-5;
    let [after, middle, before] = energies(step);
    let difference = (after + before - 2.0 * middle) / (step * step);
    // rounding of the energy over the square of the step, and the square of the step
    assert!(
        (second / difference - 1.0).abs() < 1e-4,
        "{second} {difference}"
    );
}

/// The tangent times a motion.
fn product(body: &Body, at: &Placement, way: &[f64]) -> Vec<f64> {
    let unknowns = map(Rotations::Finite);
    let mut cliques = Cliques::new();
    body.each_element(&mut |nodes| {
        let own = nodes.iter().flat_map(|&node| unknowns.of(node));
        cliques.push(&own.map(|i| i as u32).collect::<Vec<_>>());
    });
    let mut matrix = Csr::from_cliques(unknowns.len(), &cliques);
    body.add_tangent(at, [1.0, 0.0], &mut matrix).unwrap();
    let mut product = vec![0.0; way.len()];
    matrix.multiply(way, &mut product);
    product
}

/// Points side by side flow; the tangent takes them one by one.
#[test]
fn forces_of_metal_have_its_tangent() {
    let mut random = Random(47);
    let body = metal(&mesh(false, 0.0));
    let frames = [Rotation::default(); 9];
    let (way, still) = (random_motion(&mut random, 3e-3), vec![0.0; 54]);
    let mut old = vec![0.0; body.history_len()];
    let first = Placement {
        old: &old.clone(),
        ..placement(&way, None, &frames, &still)
    };
    let (mut f, mut scratch) = (vec![0.0; 54], Scratch::default());
    let stored = body.force(&first, &mut old, &mut scratch, &mut f).unwrap();
    assert!(stored.dissipated > 0.1 * stored.strain, "{stored:?}");
    // in the same direction, so that what flows goes on; no increments of the rotations
    let mut end: Vec<f64> = way.iter().map(|w| 1.2 * w).collect();
    end.chunks_exact_mut(6).for_each(|own| own[3..].fill(0.0));
    let mut by = random_motion(&mut random, 1.0);
    by.chunks_exact_mut(6).for_each(|own| own[3..].fill(0.0));
    let at = |u: &[f64]| {
        let placed = Placement {
            old: &old,
            ..placement(u, None, &frames, &still)
        };
        forces(&body, &placed).0
    };
    let moved = |step: f64| -> Vec<f64> {
        let u: Vec<f64> = end.iter().zip(&by).map(|(u, b)| u + step * b).collect();
        at(&u)
    };
    let (after, ahead) = (moved(1e-9), moved(-1e-9));
    let placed = Placement {
        old: &old,
        ..placement(&end, None, &frames, &still)
    };
    let product = product(&body, &placed, &by);
    let scale = product.iter().fold(0.0, |m: f64, p| m.max(p.abs()));
    for ((a, b), p) in after.iter().zip(&ahead).zip(&product) {
        // rounding over the step
        assert!(((a - b) / 2e-9 - p).abs() < 1e-4 * scale);
    }
}

#[test]
fn a_warped_shell_turned_by_any_angle_stores_nothing() {
    let made_of = mesh(false, 0.05);
    let turn = Rotation::cayley(&Vec3::new(1.5, -0.8, 2.0));
    let moved = Vec3::new(3.0, 1.0, -2.0);
    let u = field(&made_of.0, &|x| {
        [turn.matrix() * x + moved - x, Vec3::zeros()]
    });
    let (frames, still) = ([turn; 9], vec![0.0; 54]);
    for body in sections(&made_of, FULL_WEIGHT) {
        let (f, stored) = forces(&body, &placement(&u, None, &frames, &still));
        // rounding of products of places, 10, times membrane stiffness
        let scale = STEEL.young * THICKNESS;
        assert!(stored.strain.abs() < 1e-24 * scale, "{}", stored.strain);
        assert!(f.iter().all(|f| f.abs() < 1e-13 * scale));
    }
}

/// A plate whose thickness falls linearly from 0.02 to 0.01 over a side has the mean of both.
#[test]
fn the_mass_of_a_taper_is_that_of_its_mean() {
    let made_of = mesh(false, 0.0);
    let section = section(Rotations::Finite, 0.0);
    let mut spec = BodySpec::new("s", made_of.1.clone(), Kinematics::Shell(section), STEEL);
    let nodes = made_of.0.nodes.iter();
    spec.nodal_thickness = Some(nodes.map(|x| THICKNESS * (1.0 - 0.5 * x[0])).collect());
    spec.formulation = FULL_WEIGHT;
    let number: Vec<u32> = (0..9).collect();
    let body = Body::new(&made_of.0, spec, &number, &map(Rotations::Finite)).unwrap();
    let mut mass = vec![0.0; 54];
    body.add_lumped_mass(&mut mass);
    let whole: f64 = mass.chunks_exact(6).map(|own| own[0]).sum();
    let exact = STEEL.density * 0.75 * THICKNESS;
    // linear between nodes: exact
    assert!((whole / exact - 1.0).abs() < 1e-12, "{whole} {exact}");
}

/// Small motions: what is quadratic in them is the square of 1e-7, of membrane forces that of slopes.
#[test]
fn a_patch_has_constant_membrane_forces_and_constant_moments_without_hourglass() {
    let plane = STEEL.young / (1.0 - STEEL.poisson.powi(2));
    let made_of = mesh(false, 0.0);
    let body = elastic(&made_of);
    let shell = body.as_shell().unwrap();
    let [xx, yy, xy] = [2e-7, -1e-7, 1.5e-7];
    let stretched = field(&made_of.0, &|x| {
        let moved = Vec3::new(xx * x.x + 0.5 * xy * x.y, 0.5 * xy * x.x + yy * x.y, 0.0);
        [moved, Vec3::zeros()]
    });
    let bent = field(&made_of.0, &|x| {
        let slope = [xx * x.x + 0.5 * xy * x.y, 0.5 * xy * x.x + yy * x.y];
        let w = -0.5 * (slope[0] * x.x + slope[1] * x.y);
        [Vec3::new(0.0, 0.0, w), Vec3::new(-slope[1], slope[0], 0.0)]
    });
    let expected = [
        plane * (xx + STEEL.poisson * yy),
        plane * (yy + STEEL.poisson * xx),
        STEEL.shear_modulus() * xy,
    ];
    let (frames, still) = ([Rotation::default(); 9], vec![0.0; 54]);
    for (u, factor) in [(stretched, THICKNESS), (bent, THICKNESS.powi(3) / 12.0)] {
        for found in shell.resultants(&frames, &u, &[]) {
            let of = [found.membrane, found.bending][usize::from(factor != THICKNESS)];
            let components = [of[(0, 0)], of[(1, 1)], of[(0, 1)]];
            for (component, force) in components.iter().zip(expected) {
                assert!((component / (force * factor) - 1.0).abs() < 1e-5);
            }
        }
        let (f, stored) = forces(&body, &placement(&u, None, &frames, &still));
        let scale = f.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        let inner = &f[6 * 4..6 * 5];
        let quadratic = plane * THICKNESS * xx * xx;
        let bound = 1e-5 * scale + quadratic;
        assert!(inner.iter().all(|f| f.abs() < bound), "{inner:?} {scale}");
        let exact = expected[0] * xx + expected[1] * yy + expected[2] * xy;
        let exact = 0.5 * factor * exact;
        assert!(
            (stored.strain / exact - 1.0).abs() < 1e-5,
            "{} {exact}",
            stored.strain
        );
        assert!(stored.hourglass < 1e-10 * exact, "{}", stored.hourglass);
    }
}

/// A thin ply of metal that flows on an elastic one: the law of each goes to its own points.
#[test]
fn an_elastic_ply_under_metal_does_not_flow() {
    let made_of = mesh(false, 0.0);
    let metal = J2Plasticity {
        initial: STEEL,
        yield_stress: 3e8,
        hardening: 0.0,
    };
    let ply = |material| Ply {
        material,
        thickness: 0.5 * THICKNESS,
    };
    let kinematics = Kinematics::Shell(section(Rotations::Finite, 0.0));
    let mut spec = BodySpec::new("s", made_of.1.clone(), kinematics, Law::J2Plasticity(metal));
    spec.formulation = FULL_WEIGHT;
    spec.plies = vec![ply(Law::Elastic(STEEL)), ply(Law::J2Plasticity(metal))];
    let number: Vec<u32> = (0..9).collect();
    let body = Body::new(&made_of.0, spec, &number, &map(Rotations::Finite)).unwrap();
    // stretched by ε in x and free across as far as metal and elastic part are alike: no stress but σ_x
    let strain = 1e-2;
    let u = field(&made_of.0, &|x| {
        [Vec3::new(strain * x.x, 0.0, 0.0), Vec3::zeros()]
    });
    let (frames, still) = ([Rotation::default(); 9], vec![0.0; 54]);
    let old = vec![0.0; body.history_len()];
    let mut new = old.clone();
    let at = Placement {
        old: &old,
        ..placement(&u, None, &frames, &still)
    };
    let (mut f, mut scratch) = (vec![0.0; 54], Scratch::default());
    body.force(&at, &mut new, &mut scratch, &mut f).unwrap();
    let shell = body.as_shell().unwrap();
    let plane = STEEL.young / (1.0 - STEEL.poisson.powi(2));
    // strain of Green and Lagrange
    let elastic = plane * (strain + 0.5 * strain * strain);
    for found in shell.resultants(&frames, &u, &new) {
        let [top, bottom] = found
            .faces
            .map(|face| face[(0, 0)] / (1.0 + strain).powi(2));
        assert!((bottom / elastic - 1.0).abs() < 1e-10, "{bottom} {elastic}");
        // between the yield stress in uniaxial and that in plane strain
        assert!(top > 3e8 && top < 3e8 * 2.0 / 3.0_f64.sqrt(), "{top}");
    }
}

#[test]
fn one_point_is_for_quadrilaterals_that_turn_by_any_angle() {
    let small = made(&mesh(false, 0.0), STEEL, section(Rotations::Small, 0.0));
    assert!(matches!(small, Err(Error::ShellRefused { .. })));
    let triangles = made(&mesh(true, 0.0), STEEL, section(Rotations::Finite, 0.0));
    assert!(matches!(triangles, Err(Error::NotReduced { .. })));
}
