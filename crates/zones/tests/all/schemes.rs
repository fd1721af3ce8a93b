//! The step of two linked bars under every scheme against one dense system of all its unknowns at once.
//!
//! Two bars with random weights, rows with random coefficients, which act on the node in contact too; the equations are those of a step
//! map, with the unknowns x, the multipliers of the links, and of schemes whose contact forces act on the motion by themselves the
//! acceleration c = M⁻¹ (Nᵀ P + Cᵀ J), C c = 0.

use carom_contact::Law;
use carom_contact::law::Displacement;
use carom_dynamics::scheme::{EnergyMomentum, Row, StepMap};
use carom_dynamics::{Driver, Scheme, State};
use carom_zones::LinkKind;

use crate::dense::{Dense, Matrix, dot, error};
use crate::monolithic::Problem;

/// Both bars in one numbering.
struct Joined {
    mass: Vec<f64>,
    stiffness: Matrix,
    rows: Matrix,
    map: StepMap,
    scheme: Scheme,
    dt: f64,
    /// Whether the law of the wall is one in the rate.
    of_rate: bool,
}

/// Vectors at an instant, and the force of the wall.
struct Motion {
    u: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    memory: Vec<f64>,
    force: f64,
}

impl Joined {
    fn new(problem: &Problem) -> Joined {
        let scheme = problem.schemes[0];
        let [inner, outer] = &problem.bars;
        let n = inner.nodes() + outer.nodes();
        let mut stiffness = vec![vec![0.0; n]; n];
        for (first, bar) in [(0, inner), (inner.nodes(), outer)] {
            for (i, row) in bar.stiffness().iter().enumerate() {
                stiffness[first + i][first..first + row.len()].copy_from_slice(row);
            }
        }
        let rows = problem.rows[0].iter().zip(&problem.rows[1]);
        let row = |(c, s): (&Vec<f64>, &Vec<f64>)| {
            let outer = s.iter().map(|s| -s);
            c.iter().copied().chain(outer).collect()
        };
        Joined {
            mass: [inner.mass(), outer.mass()].concat(),
            stiffness,
            rows: rows.map(row).collect(),
            map: scheme.get().step_map(problem.dt),
            scheme,
            dt: problem.dt,
            of_rate: !matches!(problem.law, Law::Displacement(_)),
        }
    }

    fn unknowns(&self) -> usize {
        self.mass.len()
    }

    /// M⁻¹ (force + Cᵀ J) with C of it zero.
    fn pushed(&self, force: &[f64]) -> Vec<f64> {
        let (n, m) = (self.unknowns(), self.rows.len());
        let mut system = Dense::new(n + m);
        for (i, force) in force.iter().enumerate() {
            system.matrix[i][i] = self.mass[i];
            system.right[i] = *force;
        }
        self.add_rows(&mut system, (0, n), [1.0, 1.0]);
        system.solve()[..n].to_vec()
    }

    /// Rows on the unknowns from the first place on, and their multipliers from the second on.
    fn add_rows(&self, system: &mut Dense, (x, l): (usize, usize), [rate, force]: [f64; 2]) {
        for (k, row) in self.rows.iter().enumerate() {
            for (i, c) in row.iter().enumerate() {
                system.matrix[l + k][x + i] += rate * c;
                system.matrix[x + i][l + k] -= force * c;
            }
        }
    }

    /// One step; with contact at the first node, which is closed.
    fn step(&self, start: &Motion, contact: bool) -> Motion {
        let mut start = Motion {
            u: start.u.clone(),
            v: start.v.clone(),
            a: start.a.clone(),
            memory: start.memory.clone(),
            force: 0.0,
        };
        let mut first = vec![0.0; self.unknowns()];
        first[0] = 1.0;
        if self.scheme.get().projects_predictor() {
            start.a.fill(0.0);
            let gap = start.u[0] + self.dt * start.v[0];
            if contact && gap < 0.0 {
                let w = self.pushed(&first);
                let scale = -gap / w[0] * 2.0 / (self.dt * self.dt);
                start.a = w.iter().map(|w| scale * w).collect();
            }
        }
        let mut end = self.solve(&start, contact);
        if self.scheme.get().restores_contact_work() && contact {
            let taken = -end.force * (end.u[0] - start.u[0]);
            let (d, r) = (self.pushed(&first), end.v[0]);
            let impulse = (f64::sqrt(r * r + 2.0 * d[0] * taken) - r) / d[0];
            end.v
                .iter_mut()
                .zip(&d)
                .for_each(|(v, d)| *v += impulse * d);
        }
        end
    }

    fn solve(&self, start: &Motion, contact: bool) -> Motion {
        let (n, m) = (self.unknowns(), self.rows.len());
        // x, c, L, J, P
        let (c, l, j, p) = (n, 2 * n, 2 * n + m, 2 * n + 2 * m);
        let mut system = Dense::new(2 * n + 2 * m + 1);
        let known = |row: &Row, i: usize| {
            let memory = start.memory.get(i).unwrap_or(&0.0);
            row.u * start.u[i] + row.v * start.v[i] + row.a * start.a[i] + row.m * memory
        };
        let half = match self.scheme {
            // the force between two states is that of their mean
            Scheme::EnergyMomentum(_) => Row {
                u: 1.0,
                v: 0.5 * self.map.displacement.v,
                x: 0.5 * self.map.displacement.x,
                ..Row::default()
            },
            _ => self.map.force,
        };
        let map = &self.map;
        for i in 0..n {
            system.matrix[i][i] += self.mass[i] * map.inertia.x;
            system.right[i] -= self.mass[i] * known(&map.inertia, i);
            for (k, stiffness) in self.stiffness[i].iter().enumerate() {
                system.matrix[i][k] += stiffness * half.x;
                system.right[i] -= stiffness * known(&half, k);
            }
            system.matrix[c + i][c + i] = self.mass[i];
        }
        system.matrix[0][p] -= map.contact;
        system.matrix[c][p] -= 1.0;
        for (k, row) in self.rows.iter().enumerate() {
            let of = match map.velocity.x == 0.0 {
                true => &map.rate,
                false => &map.velocity,
            };
            for (i, c) in row.iter().enumerate() {
                system.right[l + k] -= c * known(of, i);
                system.matrix[i][j + k] -= map.contact * c;
            }
        }
        let of = match map.velocity.x == 0.0 {
            true => map.rate.x,
            false => map.velocity.x,
        };
        self.add_rows(&mut system, (0, l), [of, 1.0]);
        self.add_rows(&mut system, (c, j), [1.0, 1.0]);
        match (contact, self.of_rate) {
            (false, _) => system.matrix[p][p] = 1.0,
            (true, true) => {
                system.matrix[p][0] = map.rate.x;
                system.matrix[p][c] = map.rate.c;
                system.right[p] = -known(&map.rate, 0);
            }
            (true, false) => {
                system.matrix[p][0] = map.gap.x;
                system.right[p] = -known(&map.gap, 0);
            }
        }
        let z = system.solve();
        let end = |row: &Row| -> Vec<f64> {
            let of = |i: usize| known(row, i) + row.x * z[i] + row.c * z[c + i];
            (0..n).map(of).collect()
        };
        Motion {
            u: end(&map.displacement),
            v: end(&map.velocity),
            a: end(&map.acceleration),
            memory: end(&map.memory),
            force: z[p],
        }
    }
}

fn motion_of(state: &State) -> Motion {
    let motion = &state.motion;
    Motion {
        u: motion.u.clone(),
        v: motion.v.clone(),
        a: motion.a.clone(),
        memory: motion.memory.clone(),
        force: 0.0,
    }
}

/// Errors of the motion and of the force after some steps, the last in contact or none; `None` where the contact would pull.
fn compare(scheme: Scheme, seed: u64, contact: bool) -> Option<[f64; 2]> {
    let mut problem = Problem::random((seed, 0), LinkKind::GravouilCombescure, 1, contact);
    problem.schemes = [scheme; 2];
    if !scheme.get().takes(carom_contact::law::Level::Rate) {
        problem.law = Law::Displacement(Displacement { projection: false });
    }
    let system = problem.zoned().together().unwrap().expect("one system");
    let mut driver = Driver::new(system.clone()).unwrap();
    let [inner, outer] = problem.motions(seed);
    let both = |k: usize| [&inner[k][..], &outer[k]].concat();
    driver.restart(&both(0), &both(1)).unwrap();
    let dense = Joined::new(&problem);
    let rows = |x: &[f64]| -> Vec<f64> { dense.rows.iter().map(|row| dot(row, x)).collect() };
    // the start satisfies the rows
    let v = &driver.state().motion.v;
    assert!(rows(v).iter().all(|rate| rate.abs() < 1e-12), "{v:?}");
    if contact {
        let mut state = driver.state().clone();
        // touches the wall
        state.motion.u[0] = 0.0;
        state.interface.gap[0] = 0.0;
        driver = Driver::resume(system, state).unwrap();
    }
    let mut exact = motion_of(driver.state());
    for _ in 0..if contact { 1 } else { 5 } {
        exact = dense.step(&exact, contact);
        driver.step().unwrap();
    }
    if contact && exact.force <= 0.0 {
        return None;
    }
    let found = &driver.state().motion;
    let mut motion = error(&found.u, &exact.u).max(error(&found.v, &exact.v));
    if scheme.get().keeps_acceleration() {
        motion = motion.max(error(&found.a, &exact.a));
    }
    if !found.memory.is_empty() {
        motion = motion.max(error(&found.memory, &exact.memory));
    }
    let force = match contact {
        true => error(&[driver.report().contacts[0].force], &[exact.force]),
        false => 0.0,
    };
    let state = driver.state();
    let largest = state.ledger.largest_energy;
    let balance = &state.ledger.balance;
    let works = driver.links().map(|(_, _, works)| works[0] + works[1]);
    assert!((works.sum::<f64>() - balance.work_links).abs() < 1e-12 * largest);
    // the ledger does not know that the bar was put to the wall
    let residual = balance.energy_residual.abs();
    assert!(contact || residual < 1e-11 * largest, "{balance:?}");
    Some([motion, force])
}

/// Rounding, that of H with random rows, up to a thousandth of which comes with the contact, in the force (as for the schemes of
/// `contact_and_links_of_equal_steps_are_one_problem`).
#[test]
fn the_step_of_every_scheme_with_links_is_that_of_the_whole_system() {
    let mut schemes = Scheme::registered();
    // the reference here takes a step at once
    schemes.retain(|scheme| scheme.get().stages().len() == 1);
    schemes.push(Scheme::EnergyMomentum(EnergyMomentum {}));
    schemes.push(Scheme::Kane(carom_dynamics::scheme::Kane {
        beta: 0.49,
        gamma: 0.9,
    }));
    for scheme in schemes {
        let mut closed = 0;
        for seed in 0..30 {
            for contact in [false, true] {
                let Some(found) = compare(scheme, seed, contact) else {
                    continue;
                };
                closed += usize::from(contact);
                assert!(
                    found[0] < 1e-10 && found[1] < 1e-10,
                    "{scheme:?} {seed} {contact}: {found:?}"
                );
            }
        }
        assert!(closed > 10, "{scheme:?}: {closed} closed contacts");
    }
}
