//! Shells: rigid motions, patches of membrane and bending, mass, energies, tangents, refusals.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::{NodeKind, Unknowns};
use carom_bodies::{
    Body, BodySpec, CellWeights, Error, Formulation, Kinematics, Placement, Rotations, Scratch,
    ShellSection,
};
use carom_elements::Kind;
use carom_materials::{Elastic, J2Plasticity, Law, NeoHooke};
use carom_mesh::{ElementId, Mesh};
use carom_testing::Random;

pub(crate) const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.3,
};

pub(crate) const THICKNESS: f64 = 0.02;

/// Four quadrilaterals around an inner node, or the triangles of their halves; the outer square has the side 1. `bulge`: how far nodes lie out of its plane.
pub(crate) fn mesh(triangles: bool, bulge: f64) -> (Mesh, Vec<ElementId>) {
    let mut mesh = Mesh::new(3);
    let at = [
        [0.0, 0.0],
        [0.6, 0.0],
        [1.0, 0.0],
        [0.0, 0.4],
        [0.45, 0.55],
        [1.0, 0.65],
        [0.0, 1.0],
        [0.35, 1.0],
        [1.0, 1.0],
    ];
    let mut random = Random(3);
    mesh.nodes = at
        .iter()
        .map(|[x, y]| [*x, *y, bulge * random.between(-1.0, 1.0)])
        .collect();
    let mut cells = Vec::new();
    for [a, b, c, d] in [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]] {
        if triangles {
            cells.push(mesh.push(Kind::Tri3, &[a, b, c]));
            cells.push(mesh.push(Kind::Tri3, &[a, c, d]));
        } else {
            cells.push(mesh.push(Kind::Quad4, &[a, b, c, d]));
        }
    }
    (mesh, cells)
}

pub(crate) fn section(rotations: Rotations, offset: f64) -> ShellSection {
    ShellSection {
        rotations,
        offset,
        ..ShellSection::new(THICKNESS)
    }
}

pub(crate) fn map(rotations: Rotations) -> Unknowns {
    let kind = match rotations {
        Rotations::Small => NodeKind::SmallRotations,
        Rotations::Finite => NodeKind::Turning,
    };
    Unknowns::new(3, [kind; 9])
}

fn spec(cells: Vec<ElementId>, section: ShellSection) -> BodySpec {
    BodySpec::new("s", cells, Kinematics::Shell(section), STEEL)
}

fn built((mesh, cells): &(Mesh, Vec<ElementId>), section: ShellSection) -> Body {
    let number: Vec<u32> = (0..9).collect();
    let spec = spec(cells.clone(), section);
    Body::new(mesh, spec, &number, &map(section.rotations)).unwrap()
}

fn force(body: &Body, u: &[f64]) -> (Vec<f64>, f64) {
    let mut f = vec![0.0; u.len()];
    let energy = body.internal_force(u, &mut Scratch::default(), &mut f);
    (f, energy)
}

pub(crate) fn placement<'a>(
    u: &'a [f64],
    from: Option<&'a [f64]>,
    frames: &'a [Rotation],
    still: &'a [f64],
) -> Placement<'a> {
    Placement {
        u,
        v: still,
        from,
        frames,
        dt: 1.0,
        old: &[],
    }
}

/// Unknowns of all nodes from their place.
pub(crate) fn field(mesh: &Mesh, of: &dyn Fn(Vec3) -> [Vec3; 2]) -> Vec<f64> {
    let nodes = mesh.nodes.iter();
    let values = nodes.flat_map(|x| of(Vec3::from(*x)));
    values.flat_map(|v| [v.x, v.y, v.z]).collect()
}

#[test]
fn rigid_motions_have_no_force_and_all_forces_no_resultant() {
    for (triangles, offset) in [(false, 0.0), (false, 0.03), (true, 0.0), (true, -0.03)] {
        let made = mesh(triangles, 0.05);
        let body = built(&made, section(Rotations::Small, offset));
        let (moved, turned) = (Vec3::new(0.3, -0.2, 0.5), Vec3::new(0.4, 0.7, -0.6));
        let u = field(&made.0, &|x| [moved + turned.cross(&x), turned]);
        let (f, energy) = force(&body, &u);
        let mut random = Random(5);
        let other: Vec<f64> = u.iter().map(|_| random.next()).collect();
        let (g, scale) = force(&body, &other);
        // rounding of K u, of a condition of (L/h)²
        let largest = g.iter().fold(0.0, |m: f64, g| m.max(g.abs()));
        assert!(f.iter().all(|f| f.abs() < 1e-12 * largest));
        assert!(
            energy.abs() < 1e-20 * scale.max(1.0) * 1e10,
            "{energy} {scale}"
        );
        let (mut resultant, mut moment) = (Vec3::zeros(), Vec3::zeros());
        for (x, g) in made.0.nodes.iter().zip(g.chunks_exact(6)) {
            let force = Vec3::new(g[0], g[1], g[2]);
            resultant += force;
            moment += Vec3::from(*x).cross(&force) + Vec3::new(g[3], g[4], g[5]);
        }
        assert!(resultant.norm() < 1e-12 * largest && moment.norm() < 1e-12 * largest);
    }
}

#[test]
fn a_patch_has_constant_membrane_forces_and_constant_moments() {
    let plane = STEEL.young / (1.0 - STEEL.poisson.powi(2));
    for triangles in [false, true] {
        let made = mesh(triangles, 0.0);
        let body = built(&made, section(Rotations::Small, 0.0));
        let shell = body.as_shell().unwrap();
        let [xx, yy, xy] = [2e-3, -1e-3, 1.5e-3];
        // with the rotation that a linear displacement has
        let stretched = field(&made.0, &|x| {
            let moved = Vec3::new(xx * x.x + 0.4 * xy * x.y, 0.6 * xy * x.x + yy * x.y, 0.0);
            [moved, Vec3::new(0.0, 0.0, 0.1 * xy)]
        });
        // w = -½ κ x², rotations about x and y are w,y and -w,x
        let bent = field(&made.0, &|x| {
            let slope = [xx * x.x + 0.5 * xy * x.y, 0.5 * xy * x.x + yy * x.y];
            let w = -0.5 * (slope[0] * x.x + slope[1] * x.y);
            [Vec3::new(0.0, 0.0, w), Vec3::new(-slope[1], slope[0], 0.0)]
        });
        let forces = [
            plane * (xx + STEEL.poisson * yy),
            plane * (yy + STEEL.poisson * xx),
            STEEL.shear_modulus() * xy,
        ];
        for (u, factor) in [(stretched, THICKNESS), (bent, THICKNESS.powi(3) / 12.0)] {
            for found in shell.resultants(&[], &u, &[]) {
                let tensors = [found.membrane, found.bending];
                let of = &tensors[usize::from(factor != THICKNESS)];
                let components = [of[(0, 0)], of[(1, 1)], of[(0, 1)]];
                for (component, force) in components.iter().zip(forces) {
                    assert!((component / (force * factor) - 1.0).abs() < 1e-10);
                }
                assert!(Vec3::from(found.shear).norm() < 1e-9 * forces[0] * factor);
            }
            let (f, energy) = force(&body, &u);
            let scale = f.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
            let inner = &f[6 * 4..6 * 5];
            assert!(
                inner.iter().all(|f| f.abs() < 1e-10 * scale),
                "{inner:?} {scale}"
            );
            let exact = 0.5 * factor * (forces[0] * xx + forces[1] * yy + forces[2] * xy);
            assert!((energy / exact - 1.0).abs() < 1e-10, "{energy} {exact}");
        }
    }
}

#[test]
fn a_warped_shell_turned_by_any_angle_stores_nothing() {
    for triangles in [false, true] {
        let made = mesh(triangles, 0.05);
        let body = built(&made, section(Rotations::Finite, 0.0));
        let turn = Rotation::cayley(&Vec3::new(1.5, -0.8, 2.0));
        let moved = Vec3::new(3.0, 1.0, -2.0);
        let u = field(&made.0, &|x| [turn.matrix() * x + moved - x, Vec3::zeros()]);
        let frames = [turn; 9];
        let still = vec![0.0; u.len()];
        let mut f = vec![0.0; u.len()];
        let at = placement(&u, None, &frames, &still);
        let stored = body
            .force(&at, &mut [], &mut Scratch::default(), &mut f)
            .unwrap();
        // rounding of products of places, 10, times membrane stiffness
        let scale = STEEL.young * THICKNESS;
        assert!(stored.strain.abs() < 1e-24 * scale, "{}", stored.strain);
        assert!(f.iter().all(|f| f.abs() < 1e-13 * scale));
    }
}

/// A cell of 1 m by 10 mm, stretched along its short sides by 1e-6. The stress along them is that of the stretch up to the rounding of places, ε times the ratio of the sides, 2e-14, over the
/// stretch: 2e-8. Products of the long ways from a node would round by ε times the square of the ratio, 2e-12, or 2e-6 of the stress.
#[test]
fn a_cell_a_hundred_times_as_wide_as_long_rounds_as_its_places_do() {
    let mut mesh = Mesh::new(3);
    let (width, length, stretch) = (1.0, 0.01, 1e-6);
    mesh.nodes = vec![
        [0.0; 3],
        [length, 0.0, 0.0],
        [length, width, 0.0],
        [0.0, width, 0.0],
    ];
    let cells = vec![mesh.push(Kind::Quad4, &[0, 1, 2, 3])];
    let unknowns = Unknowns::new(3, [NodeKind::Turning; 4]);
    let spec = spec(cells, section(Rotations::Finite, 0.0));
    let body = Body::new(&mesh, spec, &[0, 1, 2, 3], &unknowns).unwrap();
    for angle in [0.0, 0.3, 2.0] {
        let turn = Rotation::cayley(&Vec3::new(0.5 * angle, -0.8 * angle, angle));
        let u = field(&mesh, &|x| {
            let stretched = Vec3::new(x.x * (1.0 + stretch), x.y, 0.0);
            [turn.matrix() * stretched - x, Vec3::zeros()]
        });
        let (still, frames) = (vec![0.0; u.len()], [turn; 4]);
        let mut f = vec![0.0; u.len()];
        let at = placement(&u, None, &frames, &still);
        body.force(&at, &mut [], &mut Scratch::default(), &mut f)
            .unwrap();
        let strain = stretch + 0.5 * stretch * stretch;
        let per_length = STEEL.young / (1.0 - STEEL.poisson.powi(2)) * THICKNESS * strain;
        // half of the width, and the stretched tangent
        let exact = turn.matrix() * Vec3::new(0.5 * width * per_length * (1.0 + stretch), 0.0, 0.0);
        let found = Vec3::new(f[6] + f[12], f[7] + f[13], f[8] + f[14]) * 0.5;
        let error = (found - exact).norm() / exact.norm();
        assert!(error < 1e-7, "{angle}: {error:e}");
    }
}

/// A motion of all nodes of size `part`.
pub(crate) fn random_motion(random: &mut Random, part: f64) -> Vec<f64> {
    (0..54).map(|_| part * random.between(-1.0, 1.0)).collect()
}

#[test]
fn forces_are_the_derivative_of_the_energy_and_tangents_that_of_forces() {
    let mut random = Random(11);
    for triangles in [false, true] {
        let made = mesh(triangles, 0.05);
        let body = built(&made, section(Rotations::Finite, 0.0));
        let frames: Vec<Rotation> = (0..9)
            .map(|_| Rotation::cayley(&Vec3::from_fn(|_, _| 0.1 * random.next())))
            .collect();
        let still = vec![0.0; 54];
        let at = |u: &[f64]| {
            let mut f = vec![0.0; 54];
            let at = placement(u, None, &frames, &still);
            let mut scratch = Scratch::default();
            let stored = body.force(&at, &mut [], &mut scratch, &mut f).unwrap();
            (f, stored.strain)
        };
        // no increment of the rotations: moments are those of the energy there
        let mut u = random_motion(&mut random, 0.03);
        u.chunks_exact_mut(6).for_each(|own| own[3..].fill(0.0));
        let way = random_motion(&mut random, 1.0);
        let moved =
            |step: f64| -> Vec<f64> { u.iter().zip(&way).map(|(u, w)| u + step * w).collect() };
        let step = 1e-5;
        let slope = (at(&moved(step)).1 - at(&moved(-step)).1) / (2.0 * step);
        let f = at(&u).0;
        let work: f64 = f.iter().zip(&way).map(|(f, w)| f * w).sum();
        // the square of the step
        assert!((work / slope - 1.0).abs() < 1e-7, "{work} {slope}");

        let unknowns = map(Rotations::Finite);
        let mut cliques = Cliques::new();
        body.each_element(&mut |nodes| {
            let own = nodes.iter().flat_map(|&node| unknowns.of(node));
            cliques.push(&own.map(|i| i as u32).collect::<Vec<_>>());
        });
        let mut matrix = Csr::from_cliques(unknowns.len(), &cliques);
        let placed = placement(&u, None, &frames, &still);
        body.add_tangent(&placed, [1.0, 0.0], &mut matrix).unwrap();
        let mut product = vec![0.0; 54];
        matrix.multiply(&way, &mut product);
        let second: f64 = product.iter().zip(&way).map(|(k, w)| k * w).sum();
        let difference =
            (at(&moved(step)).1 + at(&moved(-step)).1 - 2.0 * at(&u).1) / (step * step);
        // rounding of the energy over the square of the step, and the square of the step
        assert!(
            (second / difference - 1.0).abs() < 1e-4,
            "{second} {difference}"
        );
    }
}

#[test]
fn forces_over_a_step_do_the_work_of_the_energy_and_have_no_moment_in_its_middle() {
    let mut random = Random(17);
    for triangles in [false, true] {
        let made = mesh(triangles, 0.05);
        let body = built(&made, section(Rotations::Finite, 0.0));
        let frames: Vec<Rotation> = (0..9)
            .map(|_| Rotation::cayley(&Vec3::from_fn(|_, _| 0.2 * random.next())))
            .collect();
        let still = vec![0.0; 54];
        let mut from = random_motion(&mut random, 0.03);
        from.chunks_exact_mut(6).for_each(|own| own[3..].fill(0.0));
        let by = random_motion(&mut random, 0.4);
        let to: Vec<f64> = from.iter().zip(&by).map(|(u, w)| u + w).collect();
        let energy = |u: &[f64]| {
            let at = placement(u, None, &frames, &still);
            let mut f = vec![0.0; 54];
            let mut scratch = Scratch::default();
            body.force(&at, &mut [], &mut scratch, &mut f)
                .unwrap()
                .strain
        };
        let at = placement(&to, Some(&from), &frames, &still);
        let mut f = vec![0.0; 54];
        let mut scratch = Scratch::default();
        let stored = body.force(&at, &mut [], &mut scratch, &mut f).unwrap();
        assert_eq!(stored.strain, energy(&to));
        // the equation has J Ẇ = T with T = A z, and the increment θ is that of W
        let (mut work, mut moment, mut scale) = (0.0, Vec3::zeros(), 0.0);
        for (node, (f, by)) in f.chunks_exact(6).zip(by.chunks_exact(6)).enumerate() {
            let vector = |of: &[f64]| Vec3::new(of[0], of[1], of[2]);
            work += vector(f).dot(&vector(by)) + vector(&f[3..]).dot(&vector(&by[3..]));
            let [start, end] = [&from, &to].map(|u| vector(&u[6 * node..]));
            let middle = Vec3::from(made.0.nodes[node]) + (start + end) * 0.5;
            // R₊ W₊ - R W of equal moments of inertia: R (I + θ̂/2)/(1 + θ²/4) … of T
            let turn = vector(&by[3..]);
            let space = frames[node].matrix() * average(&turn) * vector(&f[3..]);
            moment += middle.cross(&vector(f)) + space;
            scale += vector(f).norm();
        }
        let change = stored.strain - energy(&from);
        assert!((work / change - 1.0).abs() < 1e-12, "{work} {change}");
        assert!(moment.norm() < 1e-12 * scale, "{moment} {scale}");
    }
}

/// The shell of a metal.
fn of_metal(made: &(Mesh, Vec<ElementId>), section: ShellSection, yield_stress: f64) -> Body {
    let mut spec = spec(made.1.clone(), section);
    spec.material = Law::J2Plasticity(J2Plasticity {
        initial: STEEL,
        yield_stress,
        hardening: 2e9,
    });
    let number: Vec<u32> = (0..9).collect();
    Body::new(&made.0, spec, &number, &map(section.rotations)).unwrap()
}

#[test]
fn a_metal_that_does_not_yield_is_the_elastic_shell() {
    let mut random = Random(23);
    for (rotations, triangles) in [
        (Rotations::Small, false),
        (Rotations::Finite, false),
        (Rotations::Finite, true),
    ] {
        let made = mesh(triangles, 0.05);
        let section = section(rotations, 0.0);
        let (elastic, metal) = (built(&made, section), of_metal(&made, section, 1e15));
        let mut u = random_motion(&mut random, 0.01);
        u.chunks_exact_mut(6).for_each(|own| own[3..].fill(0.0));
        let (old, still) = (vec![0.0; metal.history_len()], vec![0.0; 54]);
        let frames = [Rotation::default(); 9];
        let at = |history| Placement {
            old: history,
            ..placement(&u, None, &frames, &still)
        };
        let mut scratch = Scratch::default();
        let (mut f, mut g, mut new) = (vec![0.0; 54], vec![0.0; 54], old.clone());
        let one = elastic
            .force(&at(&[]), &mut [], &mut scratch, &mut f)
            .unwrap();
        let other = metal
            .force(&at(&old), &mut new, &mut Scratch::default(), &mut g)
            .unwrap();
        let scale = f.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        // rounding, and that of the iterations on the stress across
        assert!(f.iter().zip(&g).all(|(f, g)| (f - g).abs() < 1e-11 * scale));
        assert!((one.strain / other.strain - 1.0).abs() < 1e-11);
        assert!(other.dissipated == 0.0 && new == old);
        assert_eq!(
            metal.plastic_strains(&new).unwrap(),
            vec![0.0; made.1.len()]
        );
    }
}

#[test]
fn a_shell_that_flows_dissipates_what_is_not_stored_and_has_its_tangent() {
    let mut random = Random(29);
    let made = mesh(false, 0.05);
    let metal = of_metal(&made, section(Rotations::Small, 0.03), 3e8);
    let still = vec![0.0; 54];
    let way = random_motion(&mut random, 3e-3);
    let run = |u: &[f64], old: &[f64]| {
        let at = Placement {
            old,
            ..placement(u, None, &[], &still)
        };
        let (mut f, mut new) = (vec![0.0; 54], old.to_vec());
        let mut scratch = Scratch::default();
        let stored = metal.force(&at, &mut new, &mut scratch, &mut f).unwrap();
        (f, new, stored)
    };
    let (mut old, mut last, mut before) =
        (vec![0.0; metal.history_len()], still.clone(), still.clone());
    let (mut work, mut dissipated, mut kept, count) = (0.0, 0.0, 0.0, 2000);
    for k in 1..=count {
        let part = (3.0 * f64::from(k) / f64::from(count)).sin();
        let u: Vec<f64> = way.iter().map(|w| part * w).collect();
        let (f, new, stored) = run(&u, &old);
        for i in 0..54 {
            work += 0.5 * (f[i] + before[i]) * (u[i] - last[i]);
        }
        dissipated += stored.dissipated;
        kept = stored.strain + stored.hardening;
        (old, last, before) = (new, u, f);
    }
    assert!(dissipated > 0.1 * work, "{dissipated} {work}");
    // first order in the step, a 2000th of the way
    assert!(
        (work - dissipated - kept).abs() < 2e-3 * work,
        "{work} {dissipated} {kept}"
    );

    let unknowns = map(Rotations::Small);
    let mut cliques = Cliques::new();
    metal.each_element(&mut |nodes| {
        let own = nodes.iter().flat_map(|&node| unknowns.of(node));
        cliques.push(&own.map(|i| i as u32).collect::<Vec<_>>());
    });
    let mut matrix = Csr::from_cliques(54, &cliques);
    let end: Vec<f64> = last.iter().zip(&way).map(|(u, w)| u - 0.3 * w).collect();
    let at = Placement {
        old: &old,
        ..placement(&end, None, &[], &still)
    };
    metal.add_tangent(&at, [1.0, 0.0], &mut matrix).unwrap();
    let by = random_motion(&mut random, 1.0);
    let mut product = vec![0.0; 54];
    matrix.multiply(&by, &mut product);
    let moved = |step: f64| -> Vec<f64> {
        let u: Vec<f64> = end.iter().zip(&by).map(|(u, b)| u + step * b).collect();
        run(&u, &old).0
    };
    let (after, ahead) = (moved(1e-9), moved(-1e-9));
    let scale = product.iter().fold(0.0, |m: f64, p| m.max(p.abs()));
    for ((a, b), p) in after.iter().zip(&ahead).zip(&product) {
        // rounding over the step
        assert!(((a - b) / 2e-9 - p).abs() < 1e-4 * scale);
    }
}

/// A⁻¹ of T = A Rᵀ m, A = I - θ̂/2.
fn average(turn: &Vec3) -> Mat3 {
    let a = Mat3::identity() - (turn * 0.5).cross_matrix();
    a.try_inverse().unwrap()
}

#[test]
fn mass_is_that_of_the_plate_and_moves_rigidly() {
    for (triangles, offset) in [(false, 0.0), (false, 0.03), (true, 0.03)] {
        let made = mesh(triangles, 0.0);
        let body = built(&made, section(Rotations::Small, offset));
        let unknowns = map(Rotations::Small);
        let mut cliques = Cliques::new();
        body.each_element(&mut |nodes| {
            let own = nodes.iter().flat_map(|&node| unknowns.of(node));
            cliques.push(&own.map(|i| i as u32).collect::<Vec<_>>());
        });
        let mut matrix = Csr::from_cliques(unknowns.len(), &cliques);
        body.assemble([0.0, 0.0, 1.0], &(0..54), &mut matrix);
        let (speed, spin) = (Vec3::new(0.3, 0.2, -0.4), Vec3::new(0.5, -1.0, 0.0));
        let v = field(&made.0, &|x| [speed + spin.cross(&x), spin]);
        let mut p = vec![0.0; 54];
        matrix.multiply(&v, &mut p);
        let kinetic = 0.5 * p.iter().zip(&v).map(|(p, v)| p * v).sum::<f64>();
        // a plate of side 1: m/2 |v at the centre|² + ½ m (L² + h²)/12 about both axes in it
        let m = STEEL.density * THICKNESS;
        let centre = speed + spin.cross(&Vec3::new(0.5, 0.5, offset));
        let about = m * (1.0 + THICKNESS.powi(2)) / 12.0;
        let exact = 0.5 * m * centre.norm_squared() + 0.5 * about * spin.norm_squared();
        assert!((kinetic / exact - 1.0).abs() < 1e-12, "{kinetic} {exact}");
        let mut lumped = vec![0.0; 54];
        body.add_lumped_mass(&mut lumped);
        let sum: f64 = lumped.chunks_exact(6).map(|own| own[0]).sum();
        assert!((sum / m - 1.0).abs() < 1e-13);
        assert!(body.lumps());
    }
}

#[test]
fn cells_that_make_no_shell_are_refused() {
    let refused = |(mesh, cells): (Mesh, Vec<ElementId>), change: &dyn Fn(&mut BodySpec)| {
        let mut spec = spec(cells, section(Rotations::Small, 0.0));
        change(&mut spec);
        let number: Vec<u32> = (0..9).collect();
        let unknowns = map(Rotations::Small);
        Body::new(&mesh, spec, &number, &unknowns).unwrap_err()
    };
    let mut turned = mesh(false, 0.0);
    turned.1[3] = turned.0.push(Kind::Quad4, &[4, 7, 8, 5]);
    let said = refused(turned, &|_| {}).to_string();
    assert!(said.contains("against that of its neighbour"), "{said}");
    let mut concave = mesh(false, 0.0);
    concave.0.nodes[4] = [0.01, 0.01, 0.0];
    let said = refused(concave, &|_| {}).to_string();
    assert!(said.contains("not convex"), "{said}");
    let mut warped = mesh(false, 0.0);
    warped.0.nodes[8][2] = 0.8;
    let said = refused(warped, &|_| {}).to_string();
    assert!(said.contains("is warped"), "{said}");
    let mut flat = mesh(true, 0.0);
    flat.0.nodes[0] = [0.45, 0.55, 0.0];
    let said = refused(flat, &|_| {}).to_string();
    assert!(said.contains("has no area"), "{said}");
    let rubber = NeoHooke { initial: STEEL };
    let error = refused(mesh(false, 0.0), &|spec| {
        spec.material = Law::NeoHooke(rubber)
    });
    assert!(matches!(error, Error::FiniteKinematics { .. }), "{error}");
    let weights = CellWeights {
        inertia: vec![1.0; 16],
        stiffness: vec![1.0; 16],
    };
    let error = refused(mesh(false, 0.0), &|spec| {
        spec.kinematics = Kinematics::Shell(section(Rotations::Finite, 0.0));
        spec.formulation = Formulation::Reduced { hourglass: 0.05 };
        spec.weights = Some(weights.clone())
    });
    assert!(matches!(error, Error::ShellRefused { .. }), "{error}");
    let error = refused(mesh(false, 0.0), &|spec| {
        let mut weights = weights.clone();
        weights.stiffness[5] = -2.0;
        spec.weights = Some(weights)
    });
    assert!(matches!(error, Error::NegativeStiffness { .. }), "{error}");
}
