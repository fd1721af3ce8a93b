//! Matrices that the iterations make anew: pattern, assembly, factors, and what links change with them.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::part::Part;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::{Iterative, SharedRows};
use carom_bodies::Placement;

use super::effective::{At, Matrices, Turning};
use super::pieces::Pieces;
use crate::at_rows::AtRows;
use crate::choice::{self, Use};
use crate::costs::Work;
use crate::driver::links::linking::{Linking, Made};
use crate::driver::loads::damping_rate;
use crate::error::{Error, MeshNode};
use crate::iterated::Iterated;
use crate::operator::{Operator, add_rows, push_rows};
use crate::system::{System, push_cliques};

impl Matrices {
    /// Makes the matrices that are not those of linear parts, their factors, and what links change with them.
    pub(crate) fn renew(
        &mut self,
        system: &System,
        at: &At,
        turning: &Turning,
        (loads, retired): (&mut Vec<f64>, &mut Work),
    ) -> Result<(), Error> {
        let first = self.first;
        self.compliance.forget(|group| group >= first);
        self.renew_pattern(system, turning, at.apart, retired);
        let Some(mut a) = self.matrix.take() else {
            return Ok(());
        };
        a.clear();
        let assembled = self.assemble(system, at, &mut a);
        let assembled = self.at.agree(assembled);
        match &mut self.whole {
            whole if !at.whole || first > 0 => *whole = None,
            Some(whole) => whole.copy_values(&a),
            whole => *whole = Some(a.clone()),
        }
        a.symmetrise();
        let forces = turning.forces.iter().copied().enumerate();
        let forces = forces.filter(|(_, force)| *force != 0.0);
        // the matrix of a linear part stays
        let iterates = |unknown: u32| self.iterated[system.part_of(unknown as usize)];
        let apart: Option<&dyn Fn(u32) -> bool> = match at.apart {
            true => Some(&iterates),
            false => None,
        };
        turning
            .pairing
            .add_curvatures(forces, -turning.factor, (loads, apart), &mut a);
        for group in &mut self.operators.groups[first..] {
            for part in &group.parts {
                for i in part.clone() {
                    self.diagonal[i] = a.get(i, i);
                }
                self.at.complete(part, &mut self.diagonal);
            }
        }
        let factored = assembled.and_then(|()| self.factorise(system, at, &a, retired));
        self.matrix = Some(a);
        factored?;
        self.renew_links(system, at)
    }

    /// Makes what the rows of links change anew with the factors.
    fn renew_links(&mut self, system: &System, at: &At) -> Result<(), Error> {
        if !self.links_iterate {
            return Ok(());
        }
        let before = self.linking.as_ref().map(Linking::version);
        let made = Made {
            matrix: self.matrix.as_ref(),
            iterated: &self.iterated,
            coupled: self.coupled.iter().any(|rows| !rows.is_empty()),
            version: before.unwrap_or(self.compliance.version),
        };
        let maps = (at.maps, at.between);
        let linking = Linking::new((system, at.rows), maps, (&mut self.operators, &made))?;
        self.linking = Some(linking);
        Ok(())
    }

    fn factorise(
        &mut self,
        system: &System,
        at: &At,
        a: &Csr,
        retired: &mut Work,
    ) -> Result<(), Error> {
        for (k, group) in self.operators.groups[self.first..].iter_mut().enumerate() {
            let fixed: Vec<bool> = group
                .parts
                .iter()
                .cloned()
                .flatten()
                .map(|i| system.fixed[i])
                .collect();
            match self.free.get_mut(k) {
                Some(free) => free.renew(a),
                None => self
                    .free
                    .push(Part::new(a, &group.parts, |i| system.fixed[i])),
            }
            let free = self.free[k].matrix_mut();
            let of = (&group.parts[..], &fixed[..]);
            let without = stiffest_bolt(system)
                .unwrap_or(at.without)
                .max(f64::MIN_POSITIVE);
            add_proximal((at.proximal, &self.diagonal[..]), of, without, free);
            let all = system.unknowns.node_of_each();
            let unknowns = group.parts.iter().cloned().flatten();
            let nodes: Vec<u32> = unknowns.map(|unknown| all[unknown]).collect();
            let factored = match &mut group.operator {
                Some(Operator::Factored(factor)) => factor.refactor(free),
                Some(Operator::Iterated(Iterated {
                    solver: Some(solver),
                    ..
                })) => solver.renew(free),
                Some(Operator::Distributed(factor)) => factor.renew(free),
                other => {
                    let of = Use {
                        part: None,
                        inertia: at.maps.all().iter().all(|map| map.inertia.x != 0.0),
                        others: self.solver,
                        ranks: &self.ranks,
                    };
                    let new = match self.rows.get(k) {
                        Some(rows) => Iterative::on(free, rows.clone()).and_then(|solver| {
                            let of = (&*free, &group.parts[..]);
                            choice::operator_on_ranks(system, Box::new(solver), of)
                        }),
                        None => {
                            let none = vec![false; free.n];
                            choice::operator((system, of), free, &none, &nodes)
                        }
                    };
                    new.map(|new| *other = Some(new))
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
                    node: MeshNode::of(system, system.unknowns.node(unknown)),
                    cause,
                });
            }
        }
        Ok(())
    }

    /// Pattern of the bodies and of the points whose forces turn, and the groups of parts that these join; the factor of a group is dropped where
    /// its pattern changes.
    fn renew_pattern(
        &mut self,
        system: &System,
        turning: &Turning,
        apart: bool,
        retired: &mut Work,
    ) {
        let part_of = |unknown: u32| system.part_of(unknown as usize);
        let mut rows: Vec<(usize, Vec<u32>)> = Vec::new();
        let mut joined: Vec<usize> = (0..self.iterated.len()).collect();
        let loaded = turning.forces.iter().enumerate();
        for (point, _) in loaded.filter(|(_, force)| **force != 0.0 && !apart) {
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
        self.take_rows(system, &wanted);
        let mut cliques = Cliques::new();
        let n = system.unknowns();
        for (k, part) in system.part_of_body.iter().enumerate() {
            if self.iterated[*part] {
                let body = self.at.body(system, k);
                push_cliques(body, &system.unknowns, &(0..n), &mut cliques);
            }
        }
        push_rows(system, &(0..n), &mut cliques);
        for row in self.coupled.iter().flatten() {
            cliques.push(row);
        }
        self.matrix = Some(self.at.matrix(&(0..n), &cliques));
        (self.whole, self.free) = (None, Vec::new());
    }

    /// The rows that this rank has of the groups of these parts, and the elements that give them.
    fn take_rows(&mut self, system: &System, groups: &[Vec<Range<usize>>]) {
        let of = Use {
            part: None,
            inertia: true,
            others: self.solver,
            ranks: &self.ranks,
        };
        let rows = groups.iter().zip(&self.coupled);
        let rows = rows.map(|(parts, coupled)| choice::rows_on_ranks((system, of), parts, coupled));
        let rows: Option<Vec<SharedRows>> = rows.collect();
        self.rows = rows.unwrap_or_default();
        let needed = groups.iter().map(Vec::as_slice).zip(&self.rows);
        let needed: Vec<_> = needed.collect();
        if needed.is_empty() {
            self.at = AtRows::all();
        } else if !self.at.are_of(&needed) {
            self.at = AtRows::new(system, &needed);
        }
    }

    /// `inertia.x M + force.x K + damping` of the parts that are not linear, into a matrix of zeros.
    fn assemble(&self, system: &System, at: &At, a: &mut Csr) -> Result<(), Error> {
        let mut history = Vec::new();
        for k in 0..system.bodies.len() {
            if !self.iterated[system.part_of_body[k]] {
                continue;
            }
            let body = self.at.body(system, k);
            let map = &at.maps.all()[system.zone_of_body[k]];
            let rate = damping_rate(map).x;
            let of_all = &at.history[system.nonlinear.histories[k].clone()];
            let placement = Placement {
                u: at.u,
                v: at.v,
                from: at.from,
                frames: at.frames,
                dt: match at.between {
                    true => at.dt,
                    false => map.instant(at.dt),
                },
                old: self.at.history(k, of_all, &mut history),
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
            match inertia == 0.0 {
                true => add_rows((system, at.rows), part, 0, a),
                false => system.mass.add_to(inertia, part, 0, a),
            }
            if let Some(mass) = &system.damping_mass {
                mass.add_to(damping_rate(at.maps.of(part.start)).x, part, 0, a);
            }
        }
        crate::driver::loads::add_tangent(system, (at.maps, at.start, at.dt), (at.from, at.u), a);
        Ok(())
    }
}

/// Adds the proximal term of the pieces to the matrix of a group, `free`, from the diagonal of all unknowns. What has no stiffness of its own, as a
/// point mass, has that of the stiffest unknown; where none has any, `without` (N/m).
fn add_proximal(
    ((pieces, weight), diagonal): ((Option<&Pieces>, f64), &[f64]),
    (parts, fixed): (&[Range<usize>], &[bool]),
    without: f64,
    free: &mut Csr,
) {
    let Some(pieces) = pieces else { return };
    let stiffest = diagonal.iter().fold(0.0_f64, |most, k| most.max(k.abs()));
    let stiffest = if stiffest > 0.0 { stiffest } else { without };
    let unknowns = parts.iter().cloned().flatten().enumerate();
    for (place, unknown) in unknowns.filter(|(place, _)| !fixed[*place]) {
        if pieces.of(unknown).is_some() {
            let own = diagonal[unknown].abs();
            let scale = if own > 0.0 { own } else { stiffest };
            free.add(place, place, weight * scale);
        }
    }
}

/// Stiffness of the stiffest bolt that is tightened, N/m: what holds a model without any other; none without bolts.
fn stiffest_bolt(system: &System) -> Option<f64> {
    let bolts = system.bodies.iter().flat_map(|body| body.bolts());
    bolts.map(|bolt| bolt.stiffness).reduce(f64::max)
}

/// Counts the work with a factor that is dropped.
pub(super) fn retire(operator: &Operator, retired: &mut Work) {
    if let Some(stats) = operator.stats() {
        retired.add_factor(stats);
    }
    retired.products += operator.products();
}
