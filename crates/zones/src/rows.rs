//! The rows between the velocities of zones: those of links, then those of constraints.

use std::ops::Range;
use std::sync::Arc;

use crate::error::Error;
use crate::model::Zoned;
use crate::turning::ByZone;
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
        let mut number = 0;
        for row in self.links.iter().flat_map(|link| {
            let zones = link.zones;
            link.rows.iter().map(move |row| (row, zones))
        }) {
            let (row, zones) = row;
            for (zone, sign, terms) in [(zones[0], 1.0, &row.inner), (zones[1], -1.0, &row.outer)] {
                let system = &systems[zone];
                let term = |term: &carom_arlequin::Term| {
                    let node = system.number[term.node as usize];
                    let unknown = system.unknowns.first(node) as u32 + term.component;
                    (unknown, sign * term.coefficient)
                };
                by_zone[zone].push((number, terms.iter().map(term).collect()));
            }
            number += 1;
        }
        let of_node = self.zones_of_nodes();
        for constraint in &self.model.constraints {
            for row in &constraint.rows {
                let mut of_zones: Vec<LinkRow> = vec![Vec::new(); systems.len()];
                for &(node, kind, c) in row {
                    let zone = of_node[node as usize];
                    let unknown = zone.and_then(|zone| {
                        let system = &systems[zone];
                        let own = system.number[node as usize];
                        Some((zone, system.unknowns.find(own, kind)? as u32))
                    });
                    let (zone, unknown) =
                        unknown.ok_or_else(|| carom_system::Error::NoSuchUnknown {
                            constraint: constraint.name.clone(),
                            node,
                        })?;
                    of_zones[zone].push((unknown, c));
                }
                for (own, terms) in by_zone.iter_mut().zip(of_zones) {
                    if !terms.is_empty() {
                        own.push((number, terms));
                    }
                }
                number += 1;
            }
        }
        Ok(by_zone)
    }
}
