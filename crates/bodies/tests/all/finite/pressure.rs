//! Follower pressure on whole boundaries: work, resultant, tangent.

use carom_algebra::csr::Csr;
use carom_bodies::{FollowerPressure, Kinematics};
use carom_elements::map;
use carom_mesh::{Group, Mesh, Surface};

use super::{Step, displacement, elastic, samples};
use crate::sample::{Sample, cells, dense, distance, largest};

/// Pressure on all of the boundary: the faces that belong to one cell.
fn all_around(sample: &Sample) -> FollowerPressure {
    let mesh = &sample.mesh;
    let mut faces: Vec<(Vec<u32>, carom_elements::Kind)> = Vec::new();
    let mut keys: Vec<Vec<u32>> = Vec::new();
    for cell in cells(mesh, sample.dim()) {
        let nodes = mesh.element_nodes(cell);
        for face in mesh.kind(cell).table().faces {
            let list: Vec<u32> = face.nodes.iter().map(|&a| nodes[a]).collect();
            let mut key = list.clone();
            key.sort_unstable();
            keys.push(key);
            faces.push((list, face.kind));
        }
    }
    let mut loaded: Mesh = mesh.clone();
    let mut facets = Vec::new();
    for (place, (nodes, kind)) in faces.iter().enumerate() {
        if keys.iter().filter(|key| **key == keys[place]).count() == 1 {
            facets.push(loaded.push(*kind, nodes));
        }
    }
    let group = Group::new(sample.dim() - 1, facets);
    let surface = Surface::new(&loaded, &group, &cells(mesh, sample.dim())).unwrap();
    let kinematics = sample.body.kinematics();
    FollowerPressure::new(
        &surface.faces,
        &mesh.nodes,
        &sample.number,
        &sample.unknowns(),
        kinematics,
    )
}

fn bodies() -> Vec<Sample> {
    let all = samples(&elastic()[0]);
    all.into_iter()
        .filter(|s| s.name.contains("Full"))
        .collect()
}

fn force(sample: &Sample, pressure: &FollowerPressure, u: &[f64]) -> Vec<f64> {
    let mut f = vec![0.0; sample.n];
    pressure.add_force(1.3, u, &mut f);
    f
}

/// Current volume, by the rule of the mass, which is exact where elements bend.
fn volume(sample: &Sample, u: &[f64]) -> f64 {
    let (mesh, dim) = (&sample.mesh, sample.dim());
    let kinematics = sample.body.kinematics();
    let mut volume = 0.0;
    for cell in cells(mesh, dim) {
        let x: Vec<[f64; 3]> = mesh
            .element_nodes(cell)
            .iter()
            .map(|&node| {
                let system = sample.number[node as usize] as usize;
                let mut x = sample.x[system];
                (0..dim).for_each(|i| x[i] += u[dim * system + i]);
                x
            })
            .collect();
        let table = mesh.kind(cell).table();
        let (mut n, mut dn) = (vec![0.0; table.nodes], vec![[0.0; 3]; table.nodes]);
        let rule = table.mass_rule;
        for (xi, weight) in rule.points.iter().zip(rule.weights) {
            (table.shape)(xi, &mut n);
            (table.gradient)(xi, &mut dn);
            let det = map::jacobian(&x, &dn, dim).1;
            let section = match dim {
                2 => kinematics.surface_factor(&map::point(&x, &n)),
                _ => 1.0,
            };
            volume += weight * det * section;
        }
    }
    volume
}

/// The work of a uniform pressure on a closed surface is p times the loss of volume.
#[test]
fn force_is_the_derivative_of_pressure_times_volume() {
    const STEP: f64 = 1e-5;
    for sample in bodies() {
        let pressure = all_around(&sample);
        let u = displacement(&sample, 71);
        let f = force(&sample, &pressure, &u);
        for i in 0..sample.n {
            let at = |side: f64| {
                let mut moved = u.clone();
                moved[i] += side * STEP;
                volume(&sample, &moved)
            };
            let slope = -1.3 * (at(1.0) - at(-1.0)) / (2.0 * STEP);
            // volumes of order one, rounded to 1e-16, over a step of 1e-5
            assert!(
                (slope - f[i]).abs() < 1e-9,
                "{}: {slope} {}",
                sample.name,
                f[i]
            );
        }
    }
}

/// However far the way is: volumes are of third degree of the displacement at most.
#[test]
fn the_mean_force_on_a_way_does_the_work_of_the_change_of_volume() {
    for sample in bodies() {
        let pressure = all_around(&sample);
        let [from, to] = [81, 82].map(|seed| displacement(&sample, seed));
        let mut mean = vec![0.0; sample.n];
        pressure.add_mean_force(1.3, [&from, &to], &mut mean);
        let way = mean.iter().zip(&from).zip(&to);
        let work: f64 = way.map(|((f, from), to)| f * (to - from)).sum();
        let change = volume(&sample, &to) - volume(&sample, &from);
        // volumes of order one, rounded
        assert!((work + 1.3 * change).abs() < 1e-12, "{}", sample.name);
        // where the way has no length it is the force there
        let (mut still, force) = (vec![0.0; sample.n], force(&sample, &pressure, &to));
        pressure.add_mean_force(1.3, [&to, &to], &mut still);
        assert!(distance(&still, &force) < 1e-14 * largest(&force));
    }
}

#[test]
fn the_mean_tangent_is_the_derivative_of_the_mean_force_by_the_end_of_the_way() {
    const STEP: f64 = 1e-5;
    for sample in bodies() {
        let pressure = all_around(&sample);
        let [from, to] = [83, 84].map(|seed| displacement(&sample, seed));
        let mut matrix: Csr = sample.pattern();
        pressure.add_mean_tangent(1.3, [&from, &to], -1.0, &mut matrix);
        let k = dense(&matrix, sample.n);
        for i in (0..sample.n).step_by(7) {
            let at = |side: f64| {
                let (mut moved, mut f) = (to.clone(), vec![0.0; sample.n]);
                moved[i] += side * STEP;
                pressure.add_mean_force(1.3, [&from, &moved], &mut f);
                f
            };
            let pair = at(1.0).into_iter().zip(at(-1.0));
            let slope: Vec<f64> = pair.map(|(a, b)| (b - a) / (2.0 * STEP)).collect();
            let column: Vec<f64> = (0..sample.n).map(|row| k[row * sample.n + i]).collect();
            let error = distance(&slope, &column);
            assert!(error < 1e-9 * largest(&k), "{}: {error}", sample.name);
        }
    }
}

#[test]
fn a_closed_surface_is_pushed_nowhere() {
    for sample in bodies() {
        let f = force(&sample, &all_around(&sample), &displacement(&sample, 72));
        let axisymmetric = sample.body.kinematics() == Kinematics::Axisymmetric;
        for i in usize::from(axisymmetric)..sample.dim() {
            let sum: f64 = f.iter().skip(i).step_by(sample.dim()).sum();
            assert!(
                sum.abs() < 1e-14 * sample.n as f64,
                "{}: {sum}",
                sample.name
            );
        }
    }
}

/// On a closed surface the symmetric part is the whole.
#[test]
fn tangent_is_the_derivative_of_the_force() {
    const STEP: f64 = 1e-5;
    for sample in bodies() {
        let pressure = all_around(&sample);
        let u = displacement(&sample, 73);
        let mut matrix: Csr = sample.pattern();
        pressure.add_tangent(1.3, &u, -1.0, &mut matrix);
        let k = dense(&matrix, sample.n);
        for i in 0..sample.n {
            let at = |side: f64| {
                let mut moved = u.clone();
                moved[i] += side * STEP;
                force(&sample, &pressure, &moved)
            };
            let slope: Vec<f64> = at(1.0)
                .iter()
                .zip(&at(-1.0))
                .map(|(a, b)| (b - a) / (2.0 * STEP))
                .collect();
            let column: Vec<f64> = (0..sample.n).map(|row| k[row * sample.n + i]).collect();
            let error = distance(&slope, &column);
            assert!(error < 1e-9 * largest(&k), "{}: {error}", sample.name);
        }
    }
}

/// A hydrostatic state: the body pressed all around by p has the stress -p and is in balance.
#[test]
fn pressure_balances_the_stress_of_a_uniform_compression() {
    for sample in bodies() {
        if sample.body.kinematics() != Kinematics::Solid {
            continue;
        }
        let u = sample.field(|x| x.map(|x| -0.1 * x));
        let stresses = sample.body.stresses(&u, &[]);
        let p = -stresses[0].1[(0, 0)];
        let inner = Step::new(&sample).force(&u);
        let mut outer = vec![0.0; sample.n];
        all_around(&sample).add_force(p, &u, &mut outer);
        let error = distance(&inner, &outer);
        assert!(
            error < 1e-14 * largest(&inner).max(1.0),
            "{}: {error}",
            sample.name
        );
    }
}
