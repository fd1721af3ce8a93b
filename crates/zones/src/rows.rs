//! The rows between the velocities of zones: those of links, then those of constraints.

use std::ops::Range;
use std::sync::Arc;

use crate::error::Error;
use crate::model::Zoned;
use crate::turning::ByZone;
use carom_arlequin::Term;
use carom_system::{LinkRow, ModelConstraint, System};

impl Zoned {
    /// Name and range of the rows of each link and each constraint.
    pub(crate) fn row_ranges(&self) -> Vec<(String, Range<usize>)> {
        let links = self.links.iter().map(|link| (&link.name, link.rows.len()));
        let constraints = self.model.constraints.iter();
        let constraints = constraints.map(|some| (&some.name, some.rows.len()));
        let mut first = 0;
        let range = |(name, count): (&String, usize)| {
            first += count;
            (name.clone(), first - count..first)
        };
        links.chain(constraints).map(range).collect()
    }

    /// The two zones of each link, and those of the first and the last term of each constraint.
    pub(crate) fn zones_of_rows(&self) -> Vec<[usize; 2]> {
        let of_node = self.zones_of_nodes();
        let zone = |term: Option<&(u32, _, f64)>| {
            term.and_then(|(node, ..)| of_node[*node as usize])
                .unwrap_or(0)
        };
        let of_constraint = |some: &ModelConstraint| {
            let row = some.rows.first();
            [
                zone(row.and_then(|row| row.first())),
                zone(row.and_then(|row| row.last())),
            ]
        };
        let links = self.links.iter().map(|link| link.zones);
        let constraints = self.model.constraints.iter().map(of_constraint);
        links.chain(constraints).collect()
    }

    /// The terms of all rows by zone, on its unknowns, with the sign of the side.
    ///
    /// # Errors
    /// A constraint of an unknown that a node does not have.
    pub(crate) fn rows(&self, systems: &[Arc<System>]) -> Result<ByZone, Error> {
        let mut by_zone: ByZone = vec![Vec::new(); systems.len()];
        let mut numbers = 0..;
        for link in &self.links {
            for (row, number) in link.rows.iter().zip(&mut numbers) {
                let sides = [(1.0, &row.inner), (-1.0, &row.outer)];
                for (zone, (sign, terms)) in link.zones.into_iter().zip(sides) {
                    let terms = terms.iter().map(|term| own(&systems[zone], sign, term));
                    by_zone[zone].push((number, terms.collect()));
                }
            }
        }
        let of_node = self.zones_of_nodes();
        for constraint in &self.model.constraints {
            for (row, number) in constraint.rows.iter().zip(&mut numbers) {
                let mut of_zones: Vec<LinkRow> = vec![Vec::new(); systems.len()];
                for &(node, kind, c) in row {
                    let unknown = of_node[node as usize].and_then(|zone| {
                        let system = &systems[zone];
                        let own = system.number[node as usize];
                        Some((zone, system.unknowns.find(own, kind)? as u32))
                    });
                    let missing = || carom_system::Error::NoSuchUnknown {
                        constraint: constraint.name.clone(),
                        node,
                    };
                    let (zone, unknown) = unknown.ok_or_else(missing)?;
                    of_zones[zone].push((unknown, c));
                }
                for (rows, terms) in by_zone.iter_mut().zip(of_zones) {
                    if !terms.is_empty() {
                        rows.push((number, terms));
                    }
                }
            }
        }
        Ok(by_zone)
    }
}

/// A term of a link on the unknowns of a zone.
fn own(system: &System, sign: f64, term: &Term) -> (u32, f64) {
    let node = system.number[term.node as usize];
    let unknown = system.unknowns.first(node) as u32 + term.component;
    (unknown, sign * term.coefficient)
}
