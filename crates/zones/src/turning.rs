//! Links whose rows turn with their nodes, between zones that step apart.
//!
//! Rows of an overlap of a body with finite rotations depend on the places of both sides ([`TurningRows`]), which are known together only
//! where the outer step begins and ends. There they are C₀ and C₁, and the force of the multipliers on each zone is linear in between,
//!
//! `F(t) = (1 - s) C₀ᵀ L₀ + s C₁ᵀ L₁`, `s = (t - t₀)/DT`,
//!
//! with its components in space for translations and about the axes of the body for rotations: both sides get opposite forces at every
//! instant. C₁ is that of the pass before, and the rows hold for the velocities at the end of the step,
//!
//! `C₁ v₁ = -m/(4 T)`, `m ← m + (h₀ - m) DT/T`,
//!
//! with h₀ what places miss at its start ([`TurningRows::values`]) and m its running mean over a time T. Velocities alone do not keep
//! places: where both sides turn by φ in an outer step, the places of several steps and of one differ by φ³/12 of their distance from
//! the axis. What is given back in a step is a small part of a mean over many, because places of elastic waves miss by
//! -(DT² - dt²)/12 of the relative acceleration, in phase with the multipliers: giving that back would do work. T is that of many
//! waves across the bodies, whatever the step, so that what is left of a drift converges with it; and that of so many steps that a wave
//! which they hardly resolve is averaged. With 4 T in one row and T in the other the recursion `h ← h - m DT/(4 T)` is damped critically; of a
//! constant drift d in each step `4 d T/DT` remains.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use carom_algebra::rotation::Rotation;
use carom_algebra::unknowns::{NodeKind, Unknowns};
use carom_dynamics::Driver;
use carom_dynamics::linearised::Origin;
use carom_system::{LinkRow, ModelLink, System, Turned, TurningRows};

use crate::error::Error;
use crate::model::Zoned;

/// Time over which what places miss is averaged, over that of a wave across the longer of the bodies that the link joins.
const WAVES: f64 = 100.0;

/// Least number of steps of that time.
const LEAST: f64 = 100.0;

/// Time in which the mean is given back, over that in which it is taken.
const GIVEN: f64 = 4.0;

/// Rows by zone: number of the row and its terms there.
pub(crate) type ByZone = Vec<Vec<(u32, LinkRow)>>;

/// The links that turn, on a numbering of their own nodes.
pub(crate) struct TurningLinks {
    turning: TurningRows,
    unknowns: Unknowns,
    /// Zone of each unknown, and its number there.
    homes: Vec<(usize, u32)>,
    /// Zone of each frame, and its place there.
    frames_of: Vec<(usize, usize)>,
    /// By row that turns: its number among all, and its two zones with its place in each.
    rows: Vec<(u32, [(usize, usize); 2])>,
    /// T of each of them without regard to steps, s.
    times: Vec<f64>,
    /// The configuration in which rows are taken.
    u: Vec<f64>,
    frames: Vec<Rotation>,
    terms: Vec<LinkRow>,
    /// C₀ by zone, of links that do not turn, too.
    start: ByZone,
    /// m before the step, m times the unit of the row, and in the step under way.
    missed: [Vec<f64>; 2],
}

impl TurningLinks {
    /// Takes the links that turn, and writes their rows in the reference position; none where no link turns.
    ///
    /// # Errors
    /// A mediator without all rows of a node.
    pub(crate) fn new(
        zoned: &Zoned,
        systems: &[Arc<System>],
        rows: &mut ByZone,
    ) -> Result<Option<TurningLinks>, Error> {
        let dim = zoned.model.mesh.dim;
        let turning = zoned.turning_nodes();
        let (mut nodes, mut links) = (Nodes::default(), Vec::new());
        let mut first = 0;
        for link in &zoned.links {
            if link.has_arms(dim, &|node| turning.contains(&node)) {
                links.push((first, nodes.renumbered(link, &turning)));
            }
            first += link.rows.len() as u32;
        }
        if links.is_empty() {
            return Ok(None);
        }
        let mut made = TurningLinks::on(&nodes.list, systems);
        let x = nodes.list.iter();
        let x = x.map(|(_, node)| zoned.model.mesh.nodes[*node as usize]);
        let x: Vec<[f64; 3]> = x.collect();
        let number: Vec<u32> = (0..x.len() as u32).collect();
        for (first, link) in &links {
            let from = made.terms.len();
            let time = WAVES * crossing(link, &nodes.list, systems);
            let at = (&number[..], &made.unknowns, &x[..]);
            made.turning.add(link, at, &mut made.terms)?;
            for row in (*first..).take(made.terms.len() - from) {
                made.times.push(time);
                let [inner, outer] = link.zones.map(|zone| {
                    let place = rows[zone].partition_point(|(own, _)| *own < row);
                    (zone, place)
                });
                // both sides in one zone have a place each
                let second = outer.1 + usize::from(inner.0 == outer.0);
                made.rows.push((row, [inner, (outer.0, second)]));
            }
        }
        let zeros = vec![0.0; made.rows.len()];
        made.missed = [zeros.clone(), zeros];
        made.write(rows);
        made.start.clone_from(rows);
        Ok(Some(made))
    }

    /// The numbering of some nodes of zones, without rows.
    fn on(nodes: &[(usize, u32)], systems: &[Arc<System>]) -> TurningLinks {
        let dim = systems[0].dim;
        let (mut kinds, mut homes, mut frames_of) = (Vec::new(), Vec::new(), Vec::new());
        for &(zone, node) in nodes {
            let system = &systems[zone];
            let own = system.number[node as usize];
            let all = system.unknowns.of(own);
            let frame = system.unknowns.frame(own);
            kinds.push(match frame {
                Some(_) => NodeKind::Turning,
                None if all.len() > dim => NodeKind::SmallRotations,
                None => NodeKind::Translations,
            });
            homes.extend(all.map(|unknown| (zone, unknown as u32)));
            frames_of.extend(frame.map(|frame| (zone, frame)));
        }
        TurningLinks {
            turning: TurningRows::default(),
            unknowns: Unknowns::new(dim, kinds),
            u: vec![0.0; homes.len()],
            frames: vec![Rotation::IDENTITY; frames_of.len()],
            homes,
            frames_of,
            rows: Vec::new(),
            times: Vec::new(),
            terms: Vec::new(),
            start: Vec::new(),
            missed: Default::default(),
        }
    }

    /// The mean of what places miss in the rows, m times the unit of the row.
    pub(crate) fn missed(&self) -> &[f64] {
        &self.missed[0]
    }

    /// Goes on from such a mean.
    pub(crate) fn resume(&mut self, missed: &[f64]) {
        self.missed[0].copy_from_slice(missed);
    }

    /// Begins anew.
    pub(crate) fn restart(&mut self) {
        self.missed[0].fill(0.0);
    }

    /// Makes the mean of the step that of the state.
    pub(crate) fn accept(&mut self) {
        let [old, new] = &mut self.missed;
        old.copy_from_slice(new);
    }

    /// The rows at the present states of the zones.
    pub(crate) fn at_states(&mut self, drivers: &[Driver], rows: &mut ByZone) {
        self.look_at_states(drivers);
        self.write(rows);
    }

    /// The rows where the zones are linearised.
    pub(crate) fn at_origins(&mut self, origins: &[Origin], rows: &mut ByZone) {
        let motion = |zone: usize| (&origins[zone].u[..], &origins[zone].frames[..]);
        self.look(motion);
        self.write(rows);
    }

    /// Begins an outer step of `dt` (s): C₀, what is given back, and for C₁ the rows where the present velocities lead.
    pub(crate) fn begin(&mut self, drivers: &[Driver], dt: f64, rows: &mut ByZone) {
        self.at_states(drivers, rows);
        for (start, rows) in self.start.iter_mut().zip(rows.iter()) {
            for ((_, start), (_, row)) in start.iter_mut().zip(rows) {
                start.clone_from(row);
            }
        }
        let at = Turned {
            frames: &self.frames,
            u: &self.u,
            from: None,
        };
        let [before, mean] = &mut self.missed;
        for (row, h) in self.turning.values(&self.unknowns, &at) {
            mean[row] = averaged(before[row], h, share(dt, self.times[row]));
        }
        for (u, &(zone, unknown)) in self.u.iter_mut().zip(&self.homes) {
            *u += dt * drivers[zone].state().motion.v[unknown as usize];
        }
        self.write(rows);
    }

    /// C₁ at the ends that the zones have come to, which take so many steps, and adds what is given back in a step of `dt` (s) to the defects of the rows.
    pub(crate) fn end(
        &mut self,
        (drivers, substeps, dt): (&[Driver], &[u32], f64),
        (rows, defect): (&mut ByZone, &mut [f64]),
    ) {
        self.look(|zone| {
            let motion = match substeps[zone] {
                1 => &drivers[zone].ended().motion,
                _ => &drivers[zone].state().motion,
            };
            (&motion.u[..], &motion.frames[..])
        });
        self.write(rows);
        let means = self.missed[1].iter().zip(&self.times);
        for ((row, _), (mean, time)) in self.rows.iter().zip(means) {
            defect[*row as usize] += given_back(*mean, share(dt, *time)) / dt;
        }
    }

    /// The force of the multipliers on a zone at `part` of the outer step, term by term in the order of its `rows`, N.
    pub(crate) fn forces(
        &self,
        (zone, part): (usize, f64),
        rows: &[(u32, LinkRow)],
        [old, new]: &[Vec<f64>; 2],
        forces: &mut Vec<f64>,
    ) {
        forces.clear();
        for ((row, first), (_, last)) in self.start[zone].iter().zip(rows) {
            let row = *row as usize;
            let [old, new] = [(1.0 - part) * old[row], part * new[row]];
            let terms = first.iter().zip(last);
            forces.extend(terms.map(|((_, first), (_, last))| first * old + last * new));
        }
    }

    /// Number of each row and what of its second derivative by time these velocities of the zones give by themselves.
    pub(crate) fn centripetal(
        &mut self,
        drivers: &[Driver],
        velocities: &[Vec<f64>],
    ) -> Vec<(u32, f64)> {
        self.look_at_states(drivers);
        let of = |&(zone, unknown): &(usize, u32)| velocities[zone][unknown as usize];
        let v: Vec<f64> = self.homes.iter().map(of).collect();
        let at = Turned {
            frames: &self.frames,
            u: &self.u,
            from: None,
        };
        let own = self.turning.centripetal(&self.unknowns, &at, &v);
        own.map(|(row, own)| (self.rows[row].0, own)).collect()
    }

    fn look_at_states(&mut self, drivers: &[Driver]) {
        self.look(|zone| {
            let motion = &drivers[zone].state().motion;
            (&motion.u[..], &motion.frames[..])
        });
    }

    /// Takes the configuration from displacements and rotations of the zones.
    fn look<'a>(&mut self, of: impl Fn(usize) -> (&'a [f64], &'a [Rotation])) {
        for (u, &(zone, unknown)) in self.u.iter_mut().zip(&self.homes) {
            *u = of(zone).0[unknown as usize];
        }
        for (frame, &(zone, place)) in self.frames.iter_mut().zip(&self.frames_of) {
            *frame = of(zone).1[place];
        }
    }

    /// Writes the rows of the configuration.
    fn write(&mut self, rows: &mut ByZone) {
        if !self.start.is_empty() {
            let at = Turned {
                frames: &self.frames,
                u: &self.u,
                from: None,
            };
            self.turning
                .coefficients(&self.unknowns, &at, &mut self.terms);
        }
        for ((number, places), terms) in self.rows.iter().zip(&self.terms) {
            for &(zone, place) in places {
                let row = &mut rows[zone][place];
                row.0 = *number;
                row.1.clear();
            }
            let [(inner, of_inner), (_, of_outer)] = *places;
            for &(unknown, c) in terms {
                let (zone, dof) = self.homes[unknown as usize];
                let place = if zone == inner { of_inner } else { of_outer };
                rows[zone][place].1.push((dof, c));
            }
        }
    }
}

/// The part of the time of the mean that a step of `dt` (s) takes. `time`: of the waves, s.
fn share(dt: f64, time: f64) -> f64 {
    dt / time.max(LEAST * dt)
}

/// The running mean of what places miss, after `missed` in a step of this share.
fn averaged(mean: f64, missed: f64, share: f64) -> f64 {
    mean + share * (missed - mean)
}

/// What a step of this share gives back.
fn given_back(mean: f64, share: f64) -> f64 {
    mean * share / GIVEN
}

/// Time that a wave takes across the longer of the bodies that a link joins, s; zero of bodies without waves. `nodes`: zone and number in
/// the mesh of each node of the link.
fn crossing(link: &ModelLink, nodes: &[(usize, u32)], systems: &[Arc<System>]) -> f64 {
    let terms = link
        .rows
        .iter()
        .flat_map(|row| row.inner.iter().chain(&row.outer));
    let joined: BTreeSet<usize> = terms.map(|term| term.node as usize).collect();
    let mut longest = 0.0_f64;
    for (zone, system) in systems.iter().enumerate() {
        let own = joined
            .iter()
            .map(|&node| nodes[node])
            .filter(|(of, _)| *of == zone);
        let own: Vec<u32> = own.map(|(_, node)| system.number[node as usize]).collect();
        let sizes = system.diagonals.iter().zip(&system.body_masses);
        for (body, (size, masses)) in system.bodies.iter().zip(sizes) {
            let has = |node: &u32| masses.binary_search_by_key(node, |(own, _)| *own).is_ok();
            if let Some(waves) = body.wave_speed().filter(|_| own.iter().any(has)) {
                longest = longest.max(size / waves);
            }
        }
    }
    longest
}

/// Nodes of links, by zone and number in the mesh, in the order of their own numbers.
#[derive(Default)]
struct Nodes {
    list: Vec<(usize, u32)>,
    numbers: BTreeMap<(usize, u32), u32>,
}

impl Nodes {
    fn number(&mut self, zone: usize, node: u32) -> u32 {
        let list = &mut self.list;
        *self.numbers.entry((zone, node)).or_insert_with(|| {
            list.push((zone, node));
            list.len() as u32 - 1
        })
    }

    /// The link on these nodes. Its mediator belongs to the body that turns.
    fn renumbered(&mut self, link: &ModelLink, turning: &BTreeSet<u32>) -> ModelLink {
        let mut link = link.clone();
        let rows = link.rows.iter();
        let mut inside = rows.flat_map(|row| &row.inner);
        let thin = match inside.any(|term| turning.contains(&term.node)) {
            true => link.zones[0],
            false => link.zones[1],
        };
        for row in &mut link.rows {
            for (zone, terms) in link.zones.iter().zip([&mut row.inner, &mut row.outer]) {
                for term in terms {
                    term.node = self.number(*zone, term.node);
                }
            }
            row.node = self.number(thin, row.node);
            for axes in &mut row.axes {
                axes.node = self.number(thin, axes.node);
            }
        }
        link
    }
}

#[cfg(test)]
mod tests {
    use super::{GIVEN, LEAST, averaged, given_back, share};

    /// Places after so many steps of this share that miss by `missed` at first and by `drift` more in each, and the least of them.
    fn places(mut missed: f64, drift: f64, (steps, share): (usize, f64)) -> [f64; 2] {
        let (mut mean, mut least) = (0.0, missed);
        for _ in 0..steps {
            mean = averaged(mean, missed, share);
            missed += drift - given_back(mean, share);
            least = f64::min(least, missed);
        }
        [missed, least]
    }

    /// With both roots at 1 - s/2, a miss behaves as (1 + a k) q^k. A root of larger imaginary part would swing to minus exp(-π) = 4 %, and a slower one
    /// would leave more than e^-9 after 30 T.
    #[test]
    fn what_places_miss_is_given_back_without_swinging() {
        let [left, least] = places(1.0, 0.0, ((30.0 * LEAST) as usize, 1.0 / LEAST));
        assert!(left.abs() < 1e-4, "{left}");
        assert!(least > -1e-2, "{least}");
    }

    /// The fixed point of the recursion.
    #[test]
    fn of_a_drift_as_much_remains_as_is_given_back() {
        let [left, _] = places(0.0, 1e-6, ((30.0 * LEAST) as usize, 1.0 / LEAST));
        assert!((left / (GIVEN * LEAST * 1e-6) - 1.0).abs() < 1e-3, "{left}");
    }

    /// After a T, (1 + ½) e^(-½) = 0.91 of a miss is left, to first order in the step over T; steps that are too large for T take a
    /// hundred.
    #[test]
    fn what_is_left_of_a_miss_belongs_to_the_time_not_to_the_steps() {
        let exact = 1.5 * (-0.5_f64).exp();
        for steps in [100, 1000, 10_000] {
            let [left, _] = places(1.0, 0.0, (steps, share(1.0 / steps as f64, 1.0)));
            assert!((left - exact).abs() < 1.0 / steps as f64, "{steps}: {left}");
        }
        assert_eq!(share(2.0, 1.0), 1.0 / LEAST);
    }
}
