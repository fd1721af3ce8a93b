//! Springs, dashpots and point masses.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::unknowns::Unknowns;
use carom_bodies::{Body, Curve, DiscreteKind, DiscreteSpec, Error, Link, Placement, Scratch};
use carom_elements::Kind;
use carom_mesh::Mesh;
use carom_testing::Random;

const AXIS: [f64; 3] = [0.6, 0.0, -0.8];

/// Four nodes in space: springs between the first three, and one node on the ground.
fn body(kind: DiscreteKind, between: bool) -> Body {
    let mut mesh = Mesh::new(3);
    mesh.nodes = vec![[0.0; 3], [1.0, 0.2, 0.0], [1.0, 0.2, 0.0], [0.3, 0.0, 1.0]];
    let cells = match between {
        true => vec![
            mesh.push(Kind::Bar2, &[0, 1]),
            mesh.push(Kind::Bar2, &[2, 1]),
        ],
        false => vec![mesh.push(Kind::Point1, &[3])],
    };
    let spec = DiscreteSpec {
        name: "s".into(),
        cells,
        kind,
    };
    Body::discrete(&mesh, spec, &[0, 1, 2, 3], &Unknowns::translations(3, 4)).unwrap()
}

fn curve() -> Curve {
    Curve::new(vec![[-0.5, -3.0], [-0.1, -0.2], [0.2, 0.1], [0.4, 2.0]]).unwrap()
}

/// Every kind between nodes and on the ground, along an axis and in all directions.
fn bodies() -> Vec<Body> {
    let mut bodies = Vec::new();
    for between in [true, false] {
        for axis in [Some(AXIS), None] {
            for curve in [Curve::line(3.0), curve()] {
                let link = Link { curve, axis };
                bodies.push(body(DiscreteKind::Spring(link.clone()), between));
                bodies.push(body(DiscreteKind::Dashpot(link), between));
            }
        }
    }
    bodies
}

fn random(seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    (0..12).map(|_| 0.4 * random.next()).collect()
}

/// Forces of springs and dashpots, and the energy stored.
fn force(body: &Body, (u, v): (&[f64], &[f64]), from: Option<&[f64]>) -> (Vec<f64>, f64) {
    let mut f = vec![0.0; 12];
    let at = placement((u, v), from);
    let stored = body.force(&at, &mut [], &mut Scratch::default(), &mut f);
    body.add_damping_force(v, &mut f);
    (f, stored.unwrap().strain)
}

fn placement<'a>((u, v): (&'a [f64], &'a [f64]), from: Option<&'a [f64]>) -> Placement<'a> {
    Placement {
        u,
        v,
        from,
        frames: &[],
        dt: 0.1,
        old: &[],
    }
}

fn tangent(body: &Body, at: &Placement, factors: [f64; 2]) -> Csr {
    let mut cliques = Cliques::new();
    cliques.push(&(0..12).collect::<Vec<u32>>());
    let mut matrix = Csr::from_cliques(12, &cliques);
    body.add_tangent(at, factors, &mut matrix).unwrap();
    matrix
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[test]
fn the_tangents_are_the_derivatives_of_the_forces_by_place_and_velocity() {
    const STEP: f64 = 1e-6;
    for body in bodies() {
        for from in [None, Some(random(3))] {
            let (u, v) = (random(1), random(2));
            let at = placement((&u, &v), from.as_deref());
            let [by_u, by_v] = [[1.0, 0.0], [0.0, 1.0]].map(|by| tangent(&body, &at, by));
            for j in 0..12 {
                let moved = |x: &[f64], step: f64| {
                    let mut x = x.to_vec();
                    x[j] += step;
                    x
                };
                let differences = [
                    [moved(&u, STEP), v.clone(), moved(&u, -STEP), v.clone()],
                    [u.clone(), moved(&v, STEP), u.clone(), moved(&v, -STEP)],
                ];
                for ([u1, v1, u0, v0], matrix) in differences.iter().zip([&by_u, &by_v]) {
                    let [ahead, behind] =
                        [(u1, v1), (u0, v0)].map(|(u, v)| force(&body, (u, v), from.as_deref()).0);
                    for i in 0..12 {
                        let found = (ahead[i] - behind[i]) / (2.0 * STEP);
                        // rounding of the difference; forces are straight between their corners
                        assert!((found - matrix.get(i, j)).abs() < 1e-7, "{body:?} {i} {j}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_force_is_the_derivative_of_the_energy_and_a_dashpot_only_dissipates() {
    for (k, body) in bodies().iter().enumerate() {
        let (u, v, way) = (random(5), random(6), random(7));
        let moved = |step: f64| -> Vec<f64> { (0..12).map(|i| u[i] + step * way[i]).collect() };
        let still = vec![0.0; 12];
        let energy = |step: f64| force(body, (&moved(step), &still), None).1;
        let change = (energy(1e-6) - energy(-1e-6)) / 2e-6;
        let (f, _) = force(body, (&u, &still), None);
        // a curve of a dashpot is not zero at rest here
        if !body.has_damping() {
            assert!((dot(&f, &way) - change).abs() < 1e-8, "{k}");
        }
        let mut damped = vec![0.0; 12];
        body.add_damping_force(&v, &mut damped);
        if body.is_linear() {
            assert!(dot(&damped, &v) >= 0.0, "{k}");
        }
    }
}

#[test]
fn between_two_displacements_the_work_is_the_change_of_the_energy() {
    for body in bodies().iter().filter(|body| !body.has_damping()) {
        let (from, to, still) = (random(8), random(9), vec![0.0; 12]);
        let (f, end) = force(body, (&to, &still), Some(&from));
        let (_, start) = force(body, (&from, &still), None);
        let work: f64 = (0..12).map(|i| f[i] * (to[i] - from[i])).sum();
        assert!((work - (end - start)).abs() < 1e-14);
    }
}

#[test]
fn forces_between_nodes_have_no_resultant_and_the_mass_and_row_sums_are_those_given() {
    for between in [true, false] {
        let link = Link {
            curve: Curve::line(3.0),
            axis: Some(AXIS),
        };
        let spring = body(DiscreteKind::Spring(link), between);
        assert!(!spring.balances_itself());
        let (f, _) = force(&spring, (&random(4), &[0.0; 12]), None);
        let resultant = |i: usize| (0..4).map(|node| f[3 * node + i]).sum::<f64>();
        let largest = (0..3).map(|i| resultant(i).abs()).fold(0.0, f64::max);
        assert_eq!(largest < 1e-15, between);
        let [mut stiffness, mut damping] = [vec![0.0; 12], vec![0.0; 12]];
        spring.add_row_sums(&mut stiffness, &mut damping);
        // |K| of one axis: k (n n^T), twice in a row where there are two ends
        let one = 3.0 * 0.6 * (0.6 + 0.8);
        let found = if between { stiffness[0] } else { stiffness[9] };
        let ends = if between { 2.0 } else { 1.0 };
        assert!((found - ends * one).abs() < 1e-14);
        assert_eq!(damping, [0.0; 12]);
    }
    let mut mass = vec![0.0; 12];
    body(DiscreteKind::Mass(2.5.into()), false).add_lumped_mass(&mut mass);
    assert_eq!((&mass[..9], &mass[9..]), (&[0.0; 9][..], &[2.5; 3][..]));
}

#[test]
fn a_mass_between_nodes_is_refused() {
    let mut mesh = Mesh::new(1);
    mesh.nodes = vec![[0.0; 3], [1.0, 0.0, 0.0]];
    let spec = DiscreteSpec {
        name: "m".into(),
        cells: vec![mesh.push(Kind::Bar2, &[0, 1])],
        kind: DiscreteKind::Mass(1.0.into()),
    };
    let error = Body::discrete(&mesh, spec, &[0, 1], &Unknowns::translations(1, 2)).unwrap_err();
    assert!(matches!(error, Error::NotDiscrete { found: "bar2", .. }));
}
