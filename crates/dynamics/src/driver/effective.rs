//! The effective matrices of a step, their factors, and the compliance of the contact points in them.
//!
//! Each connected part has a matrix of its own. That of a linear part changes with the size of the step and the stage only, and
//! so does its factor. Those of the other parts are made anew within the iterations; while contact forces that turn act
//! between two of them, these parts have one matrix together.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::rotation::Rotation;
use carom_algebra::solver::FactorStats;
use carom_bodies::Placement;
use carom_contact::Pairing;

use super::linking::Linking;
use super::loads::damping_rate;
use super::part_matrix::part_matrix;
use crate::compliance::Compliance;
use crate::costs::Work;
use crate::error::Error;
use crate::operator::{Operator, Operators, factored, single};
use crate::step_map::StepMap;
use crate::system::{Maps, System, push_cliques};

/// Sizes of the step and stages whose factors are kept beside those of the present one.
const KEPT: usize = 3;

/// What the matrices of linear parts depend on, of each zone: factors of mass, stiffness and damping, and of x in the rows of links.
type Key = Vec<[f64; 4]>;

/// The key of a step.
fn key(maps: &Maps) -> impl Iterator<Item = [f64; 4]> {
    let of_zone = |map: &StepMap| {
        let links = maps.link_factor(map);
        [map.inertia.x, map.force.x, damping_rate(map).x, links]
    };
    maps.all().iter().map(of_zone)
}

/// The matrices of all sizes of the step that are kept.
pub(super) struct Effective {
    now: Option<Matrices>,
    kept: Vec<Matrices>,
    /// Number of all made so far.
    made: u64,
    /// Work with factors that are not kept any more.
    retired: Work,
    /// Scratch of the curvature.
    loads: Vec<f64>,
}

/// The matrices of one size of the step.
struct Matrices {
    key: Key,
    /// Which parts the iterations make anew.
    iterated: Vec<bool>,
    operators: Operators,
    /// Number of the first group of the operators that the iterations make anew; those of linear parts are before it.
    first: usize,
    compliance: Compliance,
    /// What the rows of links change; none without links.
    linking: Option<Linking>,
    /// The matrices of linear parts with the rows and columns of held unknowns, where supports move, by group.
    held: Vec<Option<Csr>>,
    /// Those of the other parts together, with the rows and columns of held unknowns.
    matrix: Option<Csr>,
    /// Unknowns of the contact points whose curvature the pattern has room for, by group, one after the other.
    coupled: Vec<Vec<Vec<u32>>>,
    /// Diagonals, by unknown.
    diagonal: Vec<f64>,
}

/// Where the tangent of the bodies is taken.
pub(super) struct At<'a> {
    /// The maps of the step.
    pub(super) maps: &'a Maps,
    /// Size of the step, s.
    pub(super) dt: f64,
    /// Whether forces belong to the way of the step.
    pub(super) between: bool,
    /// Start of the step, s.
    pub(super) start: f64,
    /// Configuration of the internal forces, m.
    pub(super) u: &'a [f64],
    /// Velocity at the same instant, m/s.
    pub(super) v: &'a [f64],
    /// The one at the start, for stresses between the two.
    pub(super) from: Option<&'a [f64]>,
    /// Rotations at the start of the step.
    pub(super) frames: &'a [Rotation],
    /// Histories at the start of the step.
    pub(super) history: &'a [f64],
    /// Parts with a proximal term, and its part of the diagonal.
    pub(super) proximal: (&'a [Range<usize>], f64),
}

/// The contact points whose forces turn with the configuration.
pub(super) struct Turning<'a> {
    /// Rows and their derivatives.
    pub(super) pairing: &'a Pairing,
    /// Force of each point in N, times the derivative of its configuration by the unknown.
    pub(super) forces: Vec<f64>,
    /// Factor of contact forces in the balance.
    pub(super) factor: f64,
}

impl Effective {
    pub(super) fn new() -> Effective {
        Effective {
            now: None,
            kept: Vec::new(),
            made: 0,
            retired: Work::default(),
            loads: Vec::new(),
        }
    }

    /// Whether the matrices at hand are those of these maps.
    pub(super) fn stands(&self, maps: &Maps) -> bool {
        let stands = |now: &Matrices| now.key.iter().copied().eq(key(maps));
        self.now.as_ref().is_some_and(stands)
    }

    /// Takes the matrices of this step: those kept from before, or new ones, in which linear parts are factored. `iterated`: the parts that
    /// are not linear; `between`: whether internal forces are means over the step.
    ///
    /// # Errors
    /// A matrix that is not positive definite.
    pub(super) fn take(
        &mut self,
        system: &System,
        maps: &Maps,
        iterated: Vec<bool>,
        between: bool,
    ) -> Result<(), Error> {
        let key: Key = key(maps).collect();
        if let Some(now) = &mut self.now {
            if now.key == key {
                return Ok(());
            }
            if now.first == 0 && now.iterated == iterated {
                // nothing of it outlives a step
                now.key = key;
                return Ok(());
            }
        }
        let of_key = |kept: &Matrices| kept.key == key && kept.iterated == iterated;
        let next = match self.kept.iter().position(of_key) {
            Some(place) => self.kept.remove(place),
            None => {
                self.made += 1;
                Matrices::new(system, maps, iterated, (between, self.made))?
            }
        };
        if let Some(before) = self.now.replace(next) {
            if self.kept.len() == KEPT {
                let forgotten = self.kept.remove(0);
                forgotten.add_work(&mut self.retired);
            }
            self.kept.push(before);
        }
        Ok(())
    }

    /// Whether the iterations make any matrix anew.
    pub(super) fn iterates(&self) -> bool {
        let now = self.now.as_ref();
        now.is_some_and(|now| now.iterated.contains(&true))
    }

    /// Flops of the factorisations of an iteration per flop of a pair of sweeps; none without a factor.
    pub(super) fn price(&self) -> Option<f64> {
        let now = self.now.as_ref()?;
        let groups = &now.operators.groups[now.first..];
        let (mut flops, mut entries) = (0.0, 0);
        for group in groups {
            if let Some(stats) = group.operator.as_ref()?.stats() {
                flops += stats.flops;
                entries += stats.nnz_factor;
            }
        }
        (entries > 0).then(|| flops / (4.0 * entries as f64))
    }

    /// Makes the matrices that are not those of linear parts, and their factors, anew.
    ///
    /// # Errors
    /// A matrix that is not positive definite, an element without tangent.
    pub(super) fn renew(
        &mut self,
        system: &System,
        at: &At,
        turning: &Turning,
    ) -> Result<(), Error> {
        match &mut self.now {
            Some(now) => now.renew(system, at, turning, (&mut self.loads, &mut self.retired)),
            None => Ok(()),
        }
    }

    /// y = A_held x: what a motion of held unknowns does to the others, N.
    pub(super) fn load_of(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        let Some(now) = &self.now else { return };
        if let Some(matrix) = &now.matrix {
            matrix.multiply(x, y);
        }
        for (group, matrix) in now.operators.groups.iter().zip(&now.held) {
            if let ([part], Some(matrix)) = (&group.parts[..], matrix) {
                matrix.multiply(&x[part.clone()], &mut y[part.clone()]);
            }
        }
    }

    /// The factors, and the compliance that goes with them; none before all are made.
    pub(super) fn both(&mut self) -> Option<(&mut Operators, &mut Compliance)> {
        let now = self.now.as_mut()?;
        let ready = now.operators.groups.iter().all(|g| g.operator.is_some());
        ready.then_some((&mut now.operators, &mut now.compliance))
    }

    /// The factors, the compliance, and what links change, none without links; none of all before all factors are made.
    pub(super) fn all(
        &mut self,
    ) -> Option<(&mut Operators, &mut Compliance, Option<&mut Linking>)> {
        let now = self.now.as_mut()?;
        let ready = now.operators.groups.iter().all(|g| g.operator.is_some());
        ready.then_some((
            &mut now.operators,
            &mut now.compliance,
            now.linking.as_mut(),
        ))
    }

    /// N x of the free motion, from the y of `begin`, of a point whose column is at hand.
    pub(super) fn free(&self, point: u32, y: &[f64]) -> f64 {
        let now = self.now.as_ref();
        now.map_or(0.0, |now| now.compliance.free(point, &now.operators, y))
    }

    /// Norm of the diagonal of the stiffness in A times `x`, N.
    pub(super) fn stiffness_norm(
        &self,
        system: &System,
        maps: &Maps,
        x: impl Iterator<Item = f64>,
    ) -> f64 {
        let Some(now) = self.now.as_ref() else {
            return 0.0;
        };
        let mut x = x;
        let mut square = 0.0;
        for (span, map) in maps.spans() {
            let own = x.by_ref().take(span.len());
            if map.force.x == 0.0 {
                own.for_each(drop);
                continue;
            }
            let of = |(i, x): (usize, f64)| {
                let stiffness = now.diagonal[i] - map.inertia.x * system.mass.lumped[i];
                (stiffness * x).powi(2)
            };
            square += span.zip(own).map(of).sum::<f64>() / (map.force.x * map.force.x);
        }
        square.sqrt()
    }

    /// Sizes and uses of the factors at hand.
    pub(super) fn stats(&self) -> impl Iterator<Item = &FactorStats> {
        let now = self.now.iter();
        now.flat_map(|now| now.operators.stats())
    }

    pub(super) fn work(&self) -> Work {
        let mut work = self.retired;
        for matrices in self.now.iter().chain(&self.kept) {
            matrices.add_work(&mut work);
        }
        work
    }

    pub(super) fn compliance_bytes(&self) -> usize {
        self.now.as_ref().map_or(0, |now| now.compliance.bytes())
    }
}

impl Matrices {
    /// Factors the matrices of the linear parts. `made`: a number that no other matrices of the run have.
    fn new(
        system: &System,
        maps: &Maps,
        iterated: Vec<bool>,
        (between, made): (bool, u64),
    ) -> Result<Matrices, Error> {
        let (others, linear): (Vec<_>, Vec<_>) = single(iterated.len())
            .into_iter()
            .partition(|group| iterated[group[0]]);
        let first = linear.len();
        let coupled = vec![Vec::new(); others.len()];
        let mut operators = Operators::of(&system.parts, [linear, others].concat());
        let mut diagonal = vec![0.0; system.unknowns()];
        let mut held = Vec::new();
        for group in &mut operators.groups[..first] {
            let part = group.parts[0].clone();
            let map = maps.of(part.start);
            let (operator, matrix) = linear_part(system, &part, map, between, &mut diagonal)?;
            group.operator = Some(operator);
            held.push(matrix);
        }
        let mut compliance = Compliance::new(
            system.points() * (1 + system.tangents()),
            system.rigid_points(),
        );
        compliance.version = made << 32;
        let linking = match system.link_rows.is_empty() {
            true => None,
            false => Some(Linking::new(system, (maps, between), &mut operators)?),
        };
        Ok(Matrices {
            linking,
            key: key(maps).collect(),
            iterated,
            operators,
            first,
            compliance,
            held,
            matrix: None,
            coupled,
            diagonal,
        })
    }

    fn renew(
        &mut self,
        system: &System,
        at: &At,
        turning: &Turning,
        (loads, retired): (&mut Vec<f64>, &mut Work),
    ) -> Result<(), Error> {
        let first = self.first;
        self.compliance.forget(|group| group >= first);
        self.renew_pattern(system, turning, retired);
        let Some(mut a) = self.matrix.take() else {
            return Ok(());
        };
        a.clear();
        let assembled = self.assemble(system, at, &mut a);
        let forces = turning.forces.iter().copied().enumerate();
        let forces = forces.filter(|(_, force)| *force != 0.0);
        turning
            .pairing
            .add_curvatures(forces, -turning.factor, loads, &mut a);
        for group in &mut self.operators.groups[first..] {
            for i in group.parts.iter().cloned().flatten() {
                self.diagonal[i] = a.get(i, i);
            }
        }
        let factored = assembled.and_then(|()| self.factorise(system, at, &a, retired));
        self.matrix = Some(a);
        factored
    }

    fn factorise(
        &mut self,
        system: &System,
        at: &At,
        a: &Csr,
        retired: &mut Work,
    ) -> Result<(), Error> {
        let (floating, weight) = at.proximal;
        for group in &mut self.operators.groups[self.first..] {
            let fixed: Vec<bool> = group
                .parts
                .iter()
                .cloned()
                .flatten()
                .map(|i| system.fixed[i])
                .collect();
            let mut free = a.restricted(&group.parts).with_identity(&fixed);
            let mut begin = 0;
            for part in &group.parts {
                if floating.contains(part) {
                    for i in (0..part.len()).filter(|&i| !fixed[begin + i]) {
                        let own = a.get(part.start + i, part.start + i).abs();
                        free.add(begin + i, begin + i, weight * own);
                    }
                }
                begin += part.len();
            }
            let all = system.unknowns.node_of_each();
            let unknowns = group.parts.iter().cloned().flatten();
            let nodes: Vec<u32> = unknowns.map(|unknown| all[unknown]).collect();
            let factored = match &mut group.operator {
                Some(Operator::Factored(factor)) => factor.refactor(&free),
                other => {
                    let none = vec![false; free.n];
                    Operator::factored(&free, &none, &nodes).map(|new| *other = Some(new))
                }
            };
            if let Err(cause) = factored {
                // the factor is of no use any more, but it was computed
                if let Some(operator) = group.operator.take() {
                    retire(&operator, retired);
                }
                let place = match &cause {
                    carom_algebra::Error::NotPositiveDefinite { unknown, .. } => *unknown,
                    _ => 0,
                };
                let unknown = group
                    .parts
                    .iter()
                    .cloned()
                    .flatten()
                    .nth(place)
                    .unwrap_or(0);
                return Err(Error::Factor {
                    matrix: "effective matrix",
                    node: system.mesh_node[system.unknowns.node(unknown) as usize],
                    cause,
                });
            }
        }
        Ok(())
    }

    /// Pattern of the bodies and of the points whose forces turn, and the groups of parts that these join; the factor of a group is dropped where
    /// its pattern changes.
    fn renew_pattern(&mut self, system: &System, turning: &Turning, retired: &mut Work) {
        let part_of = |unknown: u32| system.part_of(unknown as usize);
        let mut rows: Vec<(usize, Vec<u32>)> = Vec::new();
        let mut joined: Vec<usize> = (0..self.iterated.len()).collect();
        let loaded = turning.forces.iter().enumerate();
        for (point, _) in loaded.filter(|(_, force)| **force != 0.0) {
            turning.pairing.cliques(point, |unknowns| {
                let parts = unknowns.iter().map(|&unknown| part_of(unknown));
                let mut parts = parts.filter(|&part| self.iterated[part]);
                let Some(first) = parts.next() else { return };
                for part in parts {
                    let (a, b) = (joined[first], joined[part]);
                    let (low, high) = (a.min(b), a.max(b));
                    joined
                        .iter_mut()
                        .filter(|j| **j == high)
                        .for_each(|j| *j = low);
                }
                rows.push((first, unknowns.to_vec()));
            });
        }
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut coupled: Vec<Vec<Vec<u32>>> = Vec::new();
        for part in (0..self.iterated.len()).filter(|&part| self.iterated[part]) {
            let mates = |group: &Vec<usize>| joined[group[0]] == joined[part];
            match groups.iter().position(mates) {
                Some(place) => groups[place].push(part),
                None => {
                    groups.push(vec![part]);
                    coupled.push(Vec::new());
                }
            }
        }
        for (part, row) in rows {
            let mates = |group: &Vec<usize>| joined[group[0]] == joined[part];
            if let Some(place) = groups.iter().position(mates) {
                coupled[place].push(row);
            }
        }
        if self.matrix.is_some() && coupled == self.coupled {
            return;
        }
        let ranges = |group: &[usize]| -> Vec<Range<usize>> {
            group
                .iter()
                .map(|&part| system.parts[part].clone())
                .collect()
        };
        let wanted: Vec<Vec<Range<usize>>> = groups.iter().map(|group| ranges(group)).collect();
        let mut old = self.operators.regroup(self.first, groups);
        for (k, group) in self.operators.groups[self.first..].iter_mut().enumerate() {
            let same = |(place, of): (usize, &crate::operator::Group)| {
                of.parts == wanted[k] && self.coupled[place] == coupled[k]
            };
            if let Some(place) = old.iter().enumerate().position(same) {
                group.operator = old[place].operator.take();
            }
        }
        for operator in old.iter().filter_map(|group| group.operator.as_ref()) {
            retire(operator, retired);
        }
        self.coupled = coupled;
        let mut cliques = Cliques::new();
        let n = system.unknowns();
        for (body, &part) in system.bodies.iter().zip(&system.part_of_body) {
            if self.iterated[part] {
                push_cliques(body, &system.unknowns, &(0..n), &mut cliques);
            }
        }
        for row in self.coupled.iter().flatten() {
            cliques.push(row);
        }
        self.matrix = Some(Csr::from_cliques(n, &cliques));
    }

    /// `inertia.x M + force.x K + damping` of the parts that are not linear, into a matrix of zeros.
    fn assemble(&self, system: &System, at: &At, a: &mut Csr) -> Result<(), Error> {
        for (k, body) in system.bodies.iter().enumerate() {
            if !self.iterated[system.part_of_body[k]] {
                continue;
            }
            let map = &at.maps.all()[system.zone_of_body[k]];
            let rate = damping_rate(map).x;
            let placement = Placement {
                u: at.u,
                v: at.v,
                from: at.from,
                frames: at.frames,
                dt: match at.between {
                    true => at.dt,
                    false => map.instant(at.dt),
                },
                old: &at.history[system.nonlinear.histories[k].clone()],
            };
            body.add_tangent(&placement, [map.force.x, rate], a)?;
            let damping = system.nonlinear.damping.get(k).copied().unwrap_or_default();
            if damping.stiffness != 0.0 {
                let now = Placement {
                    from: None,
                    ..placement
                };
                body.add_tangent(&now, [rate * damping.stiffness, 0.0], a)?;
            }
        }
        for (part, _) in system
            .parts
            .iter()
            .zip(&self.iterated)
            .filter(|(_, is)| **is)
        {
            let inertia = at.maps.of(part.start).inertia.x;
            if inertia != 0.0 {
                system.mass.add_to(inertia, part, 0, a);
            }
            if let Some(mass) = &system.damping_mass {
                mass.add_to(damping_rate(at.maps.of(part.start)).x, part, 0, a);
            }
        }
        super::loads::add_tangent(system, (at.maps, at.start, at.dt), at.u, a);
        Ok(())
    }

    fn add_work(&self, work: &mut Work) {
        work.add_factors(&self.operators);
        work.columns += self.compliance.columns_computed;
    }
}

/// Counts the work with a factor that is dropped.
fn retire(operator: &Operator, retired: &mut Work) {
    if let Some(stats) = operator.stats() {
        retired.add_factor(stats);
    }
}

/// The factor of the matrix of a linear part, and the matrix itself where supports of the part move; adds its diagonal.
fn linear_part(
    system: &System,
    part: &Range<usize>,
    map: &StepMap,
    between: bool,
    diagonal: &mut [f64],
) -> Result<(Operator, Option<Csr>), Error> {
    let fixed = &system.fixed[part.clone()];
    let Some(a) = part_matrix(system, part, map, between) else {
        let lumped = &system.mass.lumped[part.clone()];
        let masses: Vec<f64> = lumped.iter().map(|m| map.inertia.x * m).collect();
        diagonal[part.clone()].copy_from_slice(&masses);
        return Ok((Operator::diagonal(&masses, fixed), None));
    };
    for (place, entry) in diagonal[part.clone()].iter_mut().enumerate() {
        *entry = a.get(place, place);
    }
    let operator = factored(system, part, &a, fixed, "effective matrix")?;
    let follows = &system.nonlinear.follows;
    let moved = follows.iter().any(|f| part.contains(&(f.unknown as usize)));
    Ok((operator, moved.then_some(a)))
}
