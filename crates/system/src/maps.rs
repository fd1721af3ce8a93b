//! The step maps of the zones of a system: how everything in a step depends on its one unknown x, zone by zone.
//!
//! A row N of a contact or a link may have terms in several zones. Each term takes the coefficients of its own zone,
//! `q = Σ_z N_z (row_z of u, v, a, x)`. Where zones differ, the unknown of each is what forces change in its rate
//! ([`StepMap::by_rate`]), so that N x has one meaning.

use std::ops::Range;

use carom_algebra::reduce::dot;
use carom_contact::Rows;

use crate::motion::Motion;
use crate::system::System;
use carom_schemes::Scheme;
use carom_schemes::step_map::{Known, Row, StepMap};

/// The map of each zone, and where its unknowns are.
#[derive(Clone, Debug)]
pub struct Maps {
    maps: Vec<StepMap>,
    /// Factor of |a|²_M in the energy that the scheme of each conserves, s².
    factors: Vec<f64>,
    /// Weights of the multipliers of links at the start and the end of the step in the balance of each.
    weights: Vec<[f64; 2]>,
    /// Whether there are links, and whether rows of them turn.
    linked: bool,
    turning: bool,
    /// Unknowns that follow each other and have one map, and its number; ascending.
    spans: Vec<(Range<usize>, usize)>,
}

impl Maps {
    /// The maps of steps of `dt` before steps of the size `next` (both s); of the first stage of a scheme of several.
    pub fn new(system: &System, dt: f64, next: f64) -> Maps {
        let mut maps = Maps {
            maps: system
                .schemes
                .iter()
                .map(|s| s.get().stage_map(0, dt))
                .collect(),
            factors: vec![0.0; system.schemes.len()],
            weights: vec![[0.0, 1.0]; system.schemes.len()],
            linked: !system.links.rows.is_empty(),
            turning: !system.links.turning.is_empty(),
            spans: system.spans.clone(),
        };
        match maps.maps.len() == 1 && system.has_stages() {
            true => maps.stage(&system.scheme, 0, dt),
            false => maps.resize(&system.schemes, (dt, next)),
        }
        maps
    }

    /// Makes these the maps of a stage of a step of `dt` (s) of the only scheme.
    pub fn stage(&mut self, scheme: &Scheme, number: usize, dt: f64) {
        let scheme = scheme.get();
        let identity = scheme.energy_identity(dt);
        let identity = identity.filter(|_| scheme.keeps_acceleration());
        self.factors
            .fill(identity.map_or(0.0, |identity| identity.inertia));
        self.weights.fill(scheme.link_weights());
        self.maps.fill(scheme.stage_map(number, dt));
    }

    /// Makes these the maps of another size of the step.
    pub fn resize(&mut self, schemes: &[Scheme], (dt, next): (f64, f64)) {
        let one = schemes.len() == 1;
        for (factor, scheme) in self.factors.iter_mut().zip(schemes) {
            let scheme = scheme.get();
            let identity = scheme
                .energy_identity(dt)
                .filter(|_| scheme.keeps_acceleration());
            *factor = identity.map_or(0.0, |identity| identity.inertia);
        }
        for (weights, scheme) in self.weights.iter_mut().zip(schemes) {
            *weights = scheme.get().link_weights();
        }
        for (map, scheme) in self.maps.iter_mut().zip(schemes) {
            let own = scheme.get().step_map_before(dt, next);
            // systems of several zones have rates that depend on x
            *map = if one {
                own
            } else {
                own.by_rate().unwrap_or(own)
            };
        }
    }

    /// Makes these the maps of a static step.
    pub fn rest(&mut self) {
        self.maps.fill(StepMap::equilibrium());
        self.factors.fill(0.0);
        self.weights.fill([0.0, 1.0]);
    }

    /// The map of the first zone; of all where no zones differ.
    pub fn first(&self) -> &StepMap {
        &self.maps[0]
    }

    /// The maps, by zone.
    pub fn all(&self) -> &[StepMap] {
        &self.maps
    }

    /// The map of the only zone.
    pub fn only(&self) -> Option<&StepMap> {
        match &self.maps[..] {
            [map] => Some(map),
            _ => None,
        }
    }

    /// Whether the steps have no inertia.
    pub fn is_static(&self) -> bool {
        self.maps[0].inertia.x == 0.0
    }

    /// Factor of contact forces in the balance of momentum: 1 of several zones.
    pub fn contact(&self) -> f64 {
        self.maps[0].contact
    }

    /// The velocity that links join: that of the end, or where the unknown is not in it the rate that contact laws constrain; in a
    /// static step, and where rows turn, the way. Accelerations that forces give by themselves satisfy the links and are left out.
    pub fn link_row(&self, map: &StepMap) -> Row {
        let row = match (self.is_static() || self.turning, map.velocity.x == 0.0) {
            (true, _) => map.displacement.since(&Row::START),
            (false, true) => map.rate,
            (false, false) => map.velocity,
        };
        Row { c: 0.0, ..row }
    }

    /// Weights of the multipliers of links at the start and the end of the step in the balance of a zone.
    pub fn link_weights(&self, zone: usize) -> [f64; 2] {
        self.weights[zone]
    }

    /// The factor of x in the rows of links, which are part of the matrices of the step; zero without links.
    pub fn link_factor(&self, map: &StepMap) -> f64 {
        match self.linked {
            true => self.link_row(map).x,
            false => 0.0,
        }
    }

    /// Whether no internal force depends on the unknown.
    pub fn is_explicit(&self) -> bool {
        self.maps.iter().all(|map| map.force.x == 0.0)
    }

    /// The map of an unknown.
    pub fn of(&self, unknown: usize) -> &StepMap {
        if let [map] = &self.maps[..] {
            return map;
        }
        let span = self.spans.partition_point(|(span, _)| span.end <= unknown);
        &self.maps[self.spans[span].1]
    }

    /// The unknowns in ranges of one map each.
    pub fn spans(&self) -> impl Iterator<Item = (Range<usize>, &StepMap)> {
        let spans = self.spans.iter();
        spans.map(|(span, zone)| (span.clone(), &self.maps[*zone]))
    }

    /// Σ_z f_z |a|²_M over the zones, with the factor f of |a|²_M in the energy that the scheme of each conserves, in J.
    pub fn square_of_acceleration(&self, system: &System, motion: &Motion) -> f64 {
        let mut force = vec![0.0; motion.a.len()];
        system.mass.multiply(&motion.a, &mut force);
        let own = |(span, zone): &(Range<usize>, usize)| {
            let factor = self.factors[*zone];
            factor * dot(&motion.a[span.clone()], &force[span.clone()])
        };
        self.spans.iter().map(own).sum()
    }

    /// Writes a row of each map on its unknowns, x and c left out.
    pub fn known(&self, row: impl Fn(&StepMap) -> Row, motion: &Motion, out: &mut [f64]) {
        let start = Known::from(motion);
        for (span, map) in self.spans() {
            row(map).known(start.within(span.clone()), &mut out[span]);
        }
    }

    /// Writes a row of each map on its unknowns.
    pub fn whole(
        &self,
        row: impl Fn(&StepMap) -> Row,
        motion: &Motion,
        [x, c]: [&[f64]; 2],
        out: &mut [f64],
    ) {
        let start = Known::from(motion);
        for (span, map) in self.spans() {
            let c = if c.is_empty() { c } else { &c[span.clone()] };
            let start = start.within(span.clone());
            row(map).whole(start, &x[span.clone()], c, &mut out[span]);
        }
    }

    /// N applied to a row of the step, for one point.
    pub fn on(
        &self,
        (rows, point): (&Rows, usize),
        row: impl Fn(&StepMap) -> Row,
        motion: &Motion,
        [x, c]: [&[f64]; 2],
    ) -> f64 {
        if let Some(map) = self.only() {
            return on_row(rows, point, &row(map), motion, [x, c]);
        }
        let (dofs, coefficients) = rows.row(point);
        let term = |(&dof, n): (&u32, &f64)| {
            let i = dof as usize;
            let row = row(self.of(i));
            let memory = motion.memory.get(i).unwrap_or(&0.0);
            let push = c.get(i).unwrap_or(&0.0);
            let known = row.u * motion.u[i] + row.v * motion.v[i] + row.a * motion.a[i];
            n * (known + row.x * x[i] + row.m * memory + row.c * push)
        };
        dofs.iter().zip(coefficients).map(term).sum()
    }
}

/// N applied to a row of a step of one map, for one point.
fn on_row(rows: &Rows, point: usize, row: &Row, motion: &Motion, [x, c]: [&[f64]; 2]) -> f64 {
    let term = |factor: f64, vector: &[f64]| match factor == 0.0 {
        true => 0.0,
        false => factor * rows.product(point, vector),
    };
    term(row.u, &motion.u)
        + term(row.v, &motion.v)
        + term(row.a, &motion.a)
        + term(row.x, x)
        + term(row.m, &motion.memory)
        + term(row.c, c)
}
