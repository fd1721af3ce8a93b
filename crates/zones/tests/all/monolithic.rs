//! The condensed step of linked zones against one dense system of all its unknowns at once.
//!
//! Two bars of 3 to 6 elements with random weights, sizes and moduli, rows with random coefficients, the end of the inner
//! bar free or against a rigid wall that it presses on. Matrices, equations and elimination are all written here.

use carom_arlequin::{Row, Term};
use carom_bodies::{BodySpec, CellWeights, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Plane, Sliding};
use carom_dynamics::scheme::{CentralDifference, Newmark, Theta};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelLink, ModelTarget, Scheme, State,
};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};
use carom_zones::{LinkKind, ModelZone, Zoned, Zones, ZonesState};

use crate::dense::{Dense, Matrix, Random, dot, error};

/// A bar of equal elements with weights at the ends of each.
pub struct Bar {
    from: f64,
    size: f64,
    material: Elastic,
    weights: CellWeights,
}

const AREA: f64 = 0.7;

impl Bar {
    fn random(random: &mut Random, from: f64) -> Bar {
        let elements = 3 + (4.0 * random.next()) as usize;
        let mut list = || {
            random
                .list(2 * elements)
                .iter()
                .map(|w| 0.2 + 0.8 * w)
                .collect()
        };
        let (inertia, stiffness) = (list(), list());
        Bar {
            from,
            size: 0.5 + random.next(),
            material: Elastic {
                density: 0.5 + random.next(),
                young: 0.5 + random.next(),
                poisson: 0.0,
            },
            weights: CellWeights { inertia, stiffness },
        }
    }

    fn elements(&self) -> usize {
        self.weights.inertia.len() / 2
    }

    pub fn nodes(&self) -> usize {
        self.elements() + 1
    }

    /// E A δ / h (1, -1; -1, 1), δ the mean of both ends.
    pub fn stiffness(&self) -> Matrix {
        let mut k = vec![vec![0.0; self.nodes()]; self.nodes()];
        for (e, w) in self.weights.stiffness.chunks(2).enumerate() {
            let rate = self.material.young * AREA / self.size * 0.5 * (w[0] + w[1]);
            for (i, j, sign) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
                k[e + i][e + j] += sign * rate;
            }
        }
        k
    }

    /// ∫ α ρ A N_a dx with α linear in each element.
    pub fn mass(&self) -> Vec<f64> {
        let mut m = vec![0.0; self.nodes()];
        for (e, w) in self.weights.inertia.chunks(2).enumerate() {
            let sixth = self.material.density * AREA * self.size / 6.0;
            m[e] += sixth * (2.0 * w[0] + w[1]);
            m[e + 1] += sixth * (w[0] + 2.0 * w[1]);
        }
        m
    }
}

/// What is solved both ways.
pub struct Problem {
    pub bars: [Bar; 2],
    /// Rows C_c and C_s.
    pub rows: [Matrix; 2],
    theta: f64,
    /// Newmark's β outside; zero for central differences.
    beta: f64,
    /// Schemes of both zones, and the law of the wall.
    pub schemes: [Scheme; 2],
    pub law: Law,
    /// Outer step.
    pub dt: f64,
    substeps: usize,
    kind: LinkKind,
    contact: bool,
}

impl Problem {
    /// `free`: nodes of the inner bar from that in contact on which no row acts.
    pub fn random(
        (seed, free): (u64, usize),
        kind: LinkKind,
        substeps: usize,
        contact: bool,
    ) -> Problem {
        let mut random = Random(seed);
        let bars = [Bar::random(&mut random, 0.0), Bar::random(&mut random, 1.0)];
        let mut row = |bar: &Bar, free: usize| {
            let mut row: Vec<f64> = random.list(bar.nodes()).iter().map(|c| c - 0.3).collect();
            row[..free].fill(0.0);
            row
        };
        let inner = (0..2).map(|_| row(&bars[0], free)).collect();
        let outer = (0..2).map(|_| row(&bars[1], 0)).collect();
        let rows = [inner, outer];
        let theta = 0.5 + 0.5 * random.next();
        let beta = [0.0, 0.25][usize::from(random.next() > 0.5)];
        let outside = match beta {
            0.0 => Scheme::CentralDifference(CentralDifference {}),
            _ => Scheme::Newmark(Newmark { beta, gamma: 0.5 }),
        };
        Problem {
            theta,
            beta,
            schemes: [Scheme::Theta(Theta { theta }), outside],
            law: Law::Velocity(Velocity {
                capture: Capture::Now,
                reading: Reading::Closed,
            }),
            dt: 0.05 + 0.1 * random.next(),
            bars,
            rows,
            substeps,
            kind,
            contact,
        }
    }

    fn zones(&self) -> Zones {
        Zones::new(&self.zoned()).unwrap()
    }

    pub fn zoned(&self) -> Zoned {
        let [inner, outer] = &self.bars;
        let line = |name: &str, bar: &Bar| {
            let to = bar.from + bar.size * bar.elements() as f64;
            generate::line(
                name,
                [bar.from, 0.0, 0.0],
                [to, 0.0, 0.0],
                bar.elements(),
                1,
            )
        };
        let mut mesh = line("inner", inner);
        mesh.merge("outer", line("outer", outer)).unwrap();
        let body = |name: &str, bar: &Bar| {
            ModelBody::new(BodySpec {
                weights: Some(bar.weights.clone()),
                ..BodySpec::new(
                    name,
                    mesh.groups[name].elements.clone(),
                    Kinematics::Bar { area: AREA },
                    bar.material,
                )
            })
        };
        let bodies = vec![body("inner", inner), body("outer", outer)];
        let end = Surface::new(&mesh, &mesh.groups["inner.left"], &bodies[0].spec.cells).unwrap();
        let wall = ModelContact {
            sliding: Sliding::Finite,
            ..ModelContact::new(
                "wall",
                end,
                ModelTarget::rigid(Plane {
                    point: [0.0; 3],
                    normal: [1.0, 0.0, 0.0],
                }),
                self.law,
            )
        };
        let terms = |c: &[f64], first: usize| {
            let term = |(i, c): (usize, &f64)| Term {
                node: (first + i) as u32,
                component: 0,
                coefficient: *c,
            };
            c.iter().enumerate().map(term).collect::<Vec<_>>()
        };
        let row = |(number, (c, s)): (usize, (&Vec<f64>, &Vec<f64>))| Row {
            node: number as u32,
            component: 0,
            inner: terms(c, 0),
            outer: terms(s, inner.nodes()),
            ..Row::default()
        };
        let [inside, outside] = self.schemes;
        let zone = |name: &str, body, scheme, substeps| {
            ModelZone::new(name, vec![body], (scheme, substeps))
        };
        Zoned {
            zones: vec![
                zone("inner", 0, inside, self.substeps as u32),
                zone("outer", 1, outside, 1),
            ],
            links: vec![ModelLink {
                name: "link".into(),
                zones: [0, 1],
                rows: self.rows[0]
                    .iter()
                    .zip(&self.rows[1])
                    .enumerate()
                    .map(row)
                    .collect(),
            }],
            kind: self.kind,
            model: Model {
                contacts: if self.contact { vec![wall] } else { Vec::new() },
                ..Model::new(bodies, mesh.clone(), inside, self.dt)
            },
        }
    }

    /// The motions of a start, towards the wall.
    pub fn motions(&self, seed: u64) -> [[Vec<f64>; 2]; 2] {
        let mut random = Random(900 + seed);
        self.bars.each_ref().map(|bar| {
            let u = random.list(bar.nodes()).iter().map(|u| 0.02 * u).collect();
            let v = random.list(bar.nodes()).iter().map(|v| -1.0 - v).collect();
            [u, v]
        })
    }

    /// As [`Problem::compare`], of both bars in one system, whose contact and links are one problem.
    /// `None` where the contact opens.
    fn compare_together(&self, seed: u64) -> Option<[f64; 2]> {
        let system = self.zoned().together().unwrap().expect("one system");
        let mut driver = Driver::new(system.clone()).unwrap();
        let [inner, outer] = self.motions(seed);
        let both = |k: usize| [&inner[k][..], &outer[k]].concat();
        driver.restart(&both(0), &both(1)).unwrap();
        let mut state = driver.state().clone();
        // touches the wall
        state.motion.u[0] = 0.0;
        let split = |state: &State| ZonesState {
            multipliers: state.links.multipliers.clone(),
            zones: [0..inner[0].len(), inner[0].len()..system.unknowns()]
                .map(|range| {
                    let mut own = state.clone();
                    let motion = &mut own.motion;
                    for vector in [&mut motion.u, &mut motion.v, &mut motion.a] {
                        *vector = vector[range.clone()].to_vec();
                    }
                    own
                })
                .to_vec(),
            ..ZonesState::default()
        };
        let exact = self.monolithic(&split(&state));
        if exact.force.iter().any(|force| *force <= 0.0) {
            return None;
        }
        let mut driver = Driver::resume(system.clone(), state).unwrap();
        driver.step().unwrap();
        let after = split(driver.state());
        let forces: Vec<f64> = driver.report().contacts.iter().map(|c| c.force).collect();
        let [inner, outer] = [0, 1].map(|k| &after.zones[k].motion);
        let motion = error(&inner.u, &exact.inner[0]).max(error(&inner.v, &exact.inner[1]));
        let multipliers = error(&after.multipliers, &exact.multipliers);
        let forces = error(&forces, &exact.force).max(multipliers);
        let work: f64 = driver
            .links()
            .map(|(_, _, works)| works[0] + works[1])
            .sum();
        let balance = driver.state().ledger.balance;
        let (found, scale) = (balance.work_links, driver.state().ledger.largest_energy);
        assert!(
            (work - found).abs() < 1e-12 * scale,
            "work of the links: {work} {found}"
        );
        Some([motion, error(&outer.a, &exact.acceleration).max(forces)])
    }

    /// Errors of one step from random motions towards the wall, with H or without it, relative to the largest entry: of motion, and of forces and
    /// accelerations.
    fn compare(&self, seed: u64, without_matrix: bool) -> [f64; 2] {
        let mut zones = self.zones();
        if without_matrix {
            zones.solve_without_matrix().unwrap();
        }
        zones.restart(&self.motions(seed)).unwrap();
        let mut state = zones.state();
        // touches the wall
        state.zones[0].motion.u[0] = 0.0;
        zones.resume(&state);
        let exact = self.monolithic(&state);
        // the guess that the contact is closed in all inner steps is right
        assert!(exact.force.iter().all(|force| *force > 0.0));
        zones.step().unwrap();
        let after = zones.state();
        let samples = zones.samples().iter().filter(|s| !s.contacts.is_empty());
        let forces: Vec<f64> = samples.map(|s| s.contacts[0].force).collect();
        let [inner, outer] = [0, 1].map(|k| &after.zones[k].motion);
        let motion = error(&inner.u, &exact.inner[0]).max(error(&inner.v, &exact.inner[1]));
        let multipliers = error(&after.multipliers, &exact.multipliers);
        let forces = error(&forces, &exact.force).max(multipliers);
        [motion, error(&outer.a, &exact.acceleration).max(forces)]
    }

    /// One outer step as one dense system in (v_1 .. v_m, P_1 .. P_m, a₊, the multipliers that are looked for).
    fn monolithic(&self, state: &ZonesState) -> Solved {
        let layout = Layout::of(self);
        let mut system = Dense::new(layout.size);
        for j in 1..=self.substeps {
            self.inner_balance(&layout, state, j, &mut system);
            self.rows_at(&layout, state, j, &mut system);
        }
        self.outer_balance(&layout, state, &mut system);
        let x = system.solve();
        let (m, n) = (self.substeps, layout.inner);
        let v = |j: usize| match j {
            0 => state.zones[0].motion.v.clone(),
            j => x[(j - 1) * n..j * n].to_vec(),
        };
        let dt = self.dt / m as f64;
        let mut u = state.zones[0].motion.u.clone();
        for j in 1..=m {
            let pair = v(j - 1).into_iter().zip(v(j));
            for (u, (old, new)) in u.iter_mut().zip(pair) {
                *u += dt * ((1.0 - self.theta) * old + self.theta * new);
            }
        }
        Solved {
            inner: [u, v(m)],
            force: x[layout.force..layout.acceleration].to_vec(),
            acceleration: x[layout.acceleration..layout.multiplier].to_vec(),
            multipliers: x[layout.size - self.rows[0].len()..].to_vec(),
        }
    }

    /// `M (v_j - v_{j-1}) + dt K (u_{j-1} + θ dt ((1-θ) v_{j-1} + θ v_j)) = dt (Cᵀ Λ_j + Nᵀ P_j)`.
    fn inner_balance(&self, layout: &Layout, state: &ZonesState, j: usize, system: &mut Dense) {
        let (mass, stiffness) = (self.bars[0].mass(), self.bars[0].stiffness());
        let dt = self.dt / self.substeps as f64;
        let (th, motion) = (self.theta, &state.zones[0].motion);
        // factors of v_0 .. v_j in u_{j-1} + θ dt (...)
        let mut lag = vec![0.0; j + 1];
        for i in 1..j {
            lag[i - 1] += dt * (1.0 - th);
            lag[i] += dt * th;
        }
        lag[j - 1] += th * (1.0 - th) * dt;
        lag[j] += th * th * dt;
        for i in 0..layout.inner {
            let row = layout.v(j) + i;
            layout.add_velocity(system, row, (j, i), mass[i], &motion.v);
            layout.add_velocity(system, row, (j - 1, i), -mass[i], &motion.v);
            for c in 0..layout.inner {
                let k = dt * stiffness[i][c];
                system.right[row] -= k * motion.u[c];
                for (at, lag) in lag.iter().enumerate() {
                    layout.add_velocity(system, row, (at, c), k * lag, &motion.v);
                }
            }
            for (l, c) in self.rows[0].iter().enumerate() {
                for (instant, part) in self.force_parts(j) {
                    let force = -dt * part * c[i];
                    layout.add_multiplier(system, row, (instant, l), force, &state.multipliers);
                }
            }
            if self.contact && i == 0 {
                system.matrix[row][layout.force + j - 1] -= dt;
            }
        }
        if self.contact {
            // closed: N v_j = 0
            system.matrix[layout.force + j - 1][layout.v(j)] = 1.0;
        }
    }

    /// Λ_j as parts of multipliers: 0 those at the start, k the k-th looked for.
    fn force_parts(&self, j: usize) -> [(usize, f64); 2] {
        match self.kind {
            LinkKind::GravouilCombescure => [(j - 1, 1.0 - self.theta), (j, self.theta)],
            LinkKind::PrakashHjelmstad => {
                let part = ((j - 1) as f64 + self.theta) / self.substeps as f64;
                [(0, 1.0 - part), (1, part)]
            }
        }
    }

    /// `(M + β DT² K) a₊ + C_sᵀ L_m = -K (u + DT v + DT² (½ - β) a)`.
    fn outer_balance(&self, layout: &Layout, state: &ZonesState, system: &mut Dense) {
        let (matrix, force) = (self.outer_matrix(), self.outer_force(state));
        for i in 0..layout.outer {
            let row = layout.acceleration + i;
            system.right[row] += force[i];
            for c in 0..layout.outer {
                system.matrix[row][layout.acceleration + c] += matrix[i][c];
            }
            for (l, c) in self.rows[1].iter().enumerate() {
                system.matrix[row][layout.multiplier(layout.last) + l] += c[i];
            }
        }
    }

    fn outer_matrix(&self) -> Matrix {
        let mut matrix = self.bars[1].stiffness();
        for (i, row) in matrix.iter_mut().enumerate() {
            row.iter_mut()
                .for_each(|k| *k *= self.beta * self.dt * self.dt);
            row[i] += self.bars[1].mass()[i];
        }
        matrix
    }

    fn outer_force(&self, state: &ZonesState) -> Vec<f64> {
        let (motion, dt) = (&state.zones[1].motion, self.dt);
        let predicted: Vec<f64> = (0..motion.u.len())
            .map(|i| motion.u[i] + dt * motion.v[i] + dt * dt * (0.5 - self.beta) * motion.a[i])
            .collect();
        let stiffness = self.bars[1].stiffness();
        stiffness.iter().map(|row| -dot(row, &predicted)).collect()
    }

    /// The rows at inner instant j: pointwise multipliers at each, with the velocity of the outer side that is
    /// interpolated but for its part from L; linear ones at the end, with the velocity of a₊.
    fn rows_at(&self, layout: &Layout, state: &ZonesState, j: usize, system: &mut Dense) {
        let pointwise = self.kind == LinkKind::GravouilCombescure;
        if !pointwise && j < self.substeps {
            return;
        }
        let (motion, half) = (&state.zones[1].motion, 0.5 * self.dt);
        let part = j as f64 / self.substeps as f64;
        // DT/2 A⁻¹ C_sᵀ, and the velocity that the outer side would have at the end
        let answers: Matrix = self.rows[1].iter().map(|c| self.outer_solve(c)).collect();
        let free = self.outer_solve(&self.outer_force(state));
        let instant = if pointwise { j } else { 1 };
        for (l, (c, s)) in self.rows[0].iter().zip(&self.rows[1]).enumerate() {
            let row = layout.multiplier(instant) + l;
            for (i, c) in c.iter().enumerate() {
                system.matrix[row][layout.v(j) + i] += c;
            }
            for (i, s) in s.iter().enumerate() {
                let end = motion.v[i] + half * (motion.a[i] + free[i]);
                let own =
                    |l: &[f64]| half * answers.iter().zip(l).map(|(a, l)| a[i] * l).sum::<f64>();
                let start = motion.v[i] + own(&state.multipliers);
                system.right[row] += s * ((1.0 - part) * start + part * end);
                for (k, answer) in answers.iter().enumerate() {
                    system.matrix[row][layout.multiplier(instant) + k] += s * half * answer[i];
                }
            }
        }
    }

    fn outer_solve(&self, right: &[f64]) -> Vec<f64> {
        let system = Dense {
            matrix: self.outer_matrix(),
            right: right.to_vec(),
        };
        system.solve()
    }
}

/// First places of the unknowns.
struct Layout {
    inner: usize,
    outer: usize,
    force: usize,
    acceleration: usize,
    multiplier: usize,
    rows: usize,
    /// Number of the multipliers at the end of the step.
    last: usize,
    size: usize,
}

impl Layout {
    fn of(problem: &Problem) -> Layout {
        let [inner, outer] = problem.bars.each_ref().map(Bar::nodes);
        let (m, rows) = (problem.substeps, problem.rows[0].len());
        let force = m * inner;
        let acceleration = force + if problem.contact { m } else { 0 };
        let multiplier = acceleration + outer;
        let last = match problem.kind {
            LinkKind::GravouilCombescure => m,
            LinkKind::PrakashHjelmstad => 1,
        };
        Layout {
            inner,
            outer,
            force,
            acceleration,
            multiplier,
            rows,
            last,
            size: multiplier + last * rows,
        }
    }

    fn v(&self, j: usize) -> usize {
        (j - 1) * self.inner
    }

    fn multiplier(&self, instant: usize) -> usize {
        self.multiplier + (instant - 1) * self.rows
    }

    /// Adds a factor of a velocity of the inner bar at an instant, which is known at the first.
    fn add_velocity(
        &self,
        system: &mut Dense,
        row: usize,
        (instant, i): (usize, usize),
        factor: f64,
        start: &[f64],
    ) {
        match instant {
            0 => system.right[row] -= factor * start[i],
            j => system.matrix[row][self.v(j) + i] += factor,
        }
    }

    /// The same of a multiplier.
    fn add_multiplier(
        &self,
        system: &mut Dense,
        row: usize,
        (instant, l): (usize, usize),
        factor: f64,
        start: &[f64],
    ) {
        match instant {
            0 => system.right[row] -= factor * start[l],
            j => system.matrix[row][self.multiplier(j) + l] += factor,
        }
    }
}

struct Solved {
    inner: [Vec<f64>; 2],
    force: Vec<f64>,
    acceleration: Vec<f64>,
    multipliers: Vec<f64>,
}

/// Without contact the second pass is the end: rounding, in a and L that of H with random rows besides (2e-12 found).
///
/// With contact the passes end when the rows hold to 1e-12 of the velocities, which is how far these may be from the
/// solution, the other motions of the bars included; a and L follow with the inverses of the step and of H, up to a
/// thousandth (1e-9 found).
#[test]
fn condensed_step_is_that_of_the_whole_system() {
    let kinds = [LinkKind::GravouilCombescure, LinkKind::PrakashHjelmstad];
    for seed in 0..40 {
        for (kind, substeps) in kinds.into_iter().flat_map(|kind| [(kind, 1), (kind, 3)]) {
            for (contact, motion, force) in [(false, 1e-14, 1e-11), (true, 5e-12, 1e-8)] {
                // the node in contact and the next one are outside the overlap
                let problem = Problem::random((seed, 2), kind, substeps, contact);
                for without_matrix in [false, true] {
                    let found = problem.compare(seed, without_matrix);
                    assert!(
                        found[0] < motion && found[1] < force,
                        "{seed} {kind:?} {substeps} {contact} {without_matrix}: {found:?}"
                    );
                }
            }
        }
    }
}

/// One problem for contact and links, solved without passes: rounding, in a and L that of H with random rows besides, up to a thousandth
/// of which comes with the contact (bounds as above). Rows act on the node in contact too.
#[test]
fn contact_and_links_of_equal_steps_are_one_problem() {
    let mut closed = 0;
    for seed in 0..40 {
        for (free, contact) in [(2, false), (2, true), (0, true)] {
            let kind = LinkKind::GravouilCombescure;
            let problem = Problem::random((seed, free), kind, 1, contact);
            let Some(found) = problem.compare_together(seed) else {
                continue;
            };
            closed += usize::from(free == 0);
            let [motion, force] = [1e-13, 1e-10];
            assert!(
                found[0] < motion && found[1] < force,
                "{seed} {free} {contact}: {found:?}"
            );
        }
    }
    assert!(closed > 10, "rows on a node in contact: {closed}");
}
