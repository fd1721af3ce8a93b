//! Work done and time spent, and what each zone did.

use std::collections::BTreeMap;

use carom_dynamics::{Costs, Driver, ModelLink, Stepper, System};
use carom_zones::{ModelZone, Whole, Zoned};

use crate::results::{Ending, Results};
use crate::summary::{Counts, Link, Newton, Zone, ZoneCosts, Zones};

pub(super) fn counts(costs: &Costs, passes: u64) -> Counts {
    let factors = &costs.factors;
    Counts {
        factorisations: costs.work.factorisations as u64,
        sweeps: costs.work.sweeps as u64,
        factor_entries: factors.iter().map(|f| f.nnz_factor as u64).sum(),
        factor_bytes: factors.iter().map(|f| f.bytes as u64).sum(),
        contact_columns: costs.work.columns as u64,
        matrix_products: costs.work.products as u64,
        compliance_bytes: costs.compliance_bytes as u64,
        force_sweeps: costs.force_sweeps as u64,
        element_updates: costs.element_updates,
        solves: costs.solves(),
        status_iterations: passes,
    }
}

pub(super) fn newton(results: &Results, ending: &Ending) -> Newton {
    let (totals, last) = (&results.totals, &results.last);
    let per_step = |count: u64| match last.step {
        0 => 0.0,
        steps => count as f64 / steps as f64,
    };
    Newton {
        iterations: totals.passes,
        iterations_per_step: per_step(totals.passes),
        most_iterations: totals.most_passes,
        factorisations_per_step: per_step(ending.costs.work.factorisations as u64),
        halvings: last.control.failed,
    }
}

pub(super) fn timings(results: &Results, ending: &Ending) -> BTreeMap<String, f64> {
    let phases = &ending.costs.phases;
    let parts = [
        ("total", results.earlier + ending.wall),
        ("factorisation", phases.factorisation),
        ("internal forces", phases.forces),
        ("triangular sweeps", phases.sweeps),
        ("contact", phases.contact),
        ("friction", phases.friction),
        ("balance", phases.balance),
        ("links", phases.links),
        ("output", results.totals.spent),
    ];
    let mut timings: BTreeMap<String, f64> = parts
        .map(|(name, time)| (name.to_owned(), time.as_secs_f64()))
        .into();
    if results
        .system
        .contacts
        .iter()
        .all(|pair| !pair.friction.acts())
    {
        timings.remove("friction");
    }
    if phases.links.is_zero() {
        timings.remove("links");
    }
    if results.last.step > 0 {
        let steps = phases.forces
            + phases.sweeps
            + phases.contact
            + phases.friction
            + phases.balance
            + phases.links;
        let per_step = steps.as_secs_f64() / results.last.step as f64;
        timings.insert("per step".to_owned(), per_step);
    }
    timings
}

impl Zones {
    /// What zones did so far that are one system.
    pub fn together(run: &Driver, zoned: &Zoned) -> Zones {
        let (system, ledger) = (run.system(), &run.state().ledger);
        let works: Vec<[f64; 2]> = run.links().map(|(_, _, works)| works).collect();
        let one = |(k, zone): (usize, &ModelZone)| {
            let scheme = zone.scheme.get();
            let bodies = || zone.bodies.iter().map(|&body| &system.bodies[body]);
            let sides = zoned.links.iter().zip(&works);
            let given = sides.flat_map(|(link, works)| link.zones.iter().zip(works));
            let given = given.filter(|(zone, _)| **zone == k).map(|(_, work)| work);
            Zone {
                name: zone.name.clone(),
                scheme: scheme.name().to_owned(),
                has_identity: system.closes_energy(),
                step: system.dt,
                substeps: 1,
                bodies: bodies().map(|body| body.name().to_owned()).collect(),
                elements: bodies().map(|body| body.cells().len()).sum(),
                unknowns: free_of(system, &zone.bodies),
                courant: courant_of(system, zone.bodies.iter().copied(), system.dt),
                work_of_links: given.sum(),
                costs: None,
            }
        };
        let link = |(link, (_, rows, works)): (&ModelLink, (&str, usize, [f64; 2]))| Link {
            work: works[0] + works[1],
            name: link.name.clone(),
            zones: link.zones.map(|zone| zoned.zones[zone].name.clone()),
            rows,
        };
        let (work, start) = (ledger.balance.work_links, ledger.initial.energy());
        Zones {
            zones: zoned.zones.iter().enumerate().map(one).collect(),
            links: zoned.links.iter().zip(run.links()).map(link).collect(),
            work_of_links: work,
            relative_work_of_links: (start > 0.0).then(|| work / start),
            passes_per_step: None,
        }
    }

    /// What the zones of a run did so far that step apart.
    pub fn of(run: &Whole) -> Zones {
        let zones = run.zones();
        let names = run.names();
        let one = |(k, driver): (usize, &Driver)| {
            let (system, costs) = (driver.system(), driver.costs());
            let ledger = &driver.state().ledger;
            let scheme = system.scheme.get();
            Zone {
                name: names[k].clone(),
                scheme: scheme.name().to_owned(),
                has_identity: system.closes_energy(),
                step: system.dt,
                substeps: (run.system().dt / system.dt).round() as u32,
                bodies: system
                    .bodies
                    .iter()
                    .map(|body| body.name().to_owned())
                    .collect(),
                elements: system.bodies.iter().map(|body| body.cells().len()).sum(),
                unknowns: free(system),
                courant: courant(system, system.dt),
                work_of_links: ledger.balance.work_links,
                costs: Some(ZoneCosts {
                    largest_residual: ledger.largest_energy_residual,
                    factorisations: costs.work.factorisations as u64,
                    element_updates: costs.element_updates,
                    solves: costs.solves(),
                }),
            }
        };
        type Of<'a> = ((&'a str, [usize; 2], usize), &'a f64);
        let link = |((name, [inner, outer], rows), work): Of| Link {
            work: *work,
            name: name.to_owned(),
            zones: [names[inner].clone(), names[outer].clone()],
            rows,
        };
        let ledger = &run.state().ledger;
        let (work, start) = (ledger.balance.work_links, ledger.initial.energy());
        Zones {
            zones: zones.drivers().iter().enumerate().map(one).collect(),
            links: run.links().zip(zones.link_works()).map(link).collect(),
            work_of_links: work,
            relative_work_of_links: (start > 0.0).then(|| work / start),
            passes_per_step: Some(match zones.outer_step() {
                0 => 0.0,
                steps => zones.all_passes() as f64 / steps as f64,
            }),
        }
    }
}

/// Unknowns that no support holds.
fn free(system: &System) -> usize {
    system.fixed.iter().filter(|fixed| !**fixed).count()
}

/// Largest step times wave speed over element size.
pub(super) fn courant(system: &System, step: f64) -> Option<f64> {
    courant_of(system, 0..system.bodies.len(), step)
}

/// Unknowns of some bodies that no support holds.
fn free_of(system: &System, bodies: &[usize]) -> usize {
    let mut own = vec![false; system.x.len()];
    for body in bodies {
        system.bodies[*body]
            .each_element(&mut |nodes| nodes.iter().for_each(|&node| own[node as usize] = true));
    }
    let nodes = (0..own.len() as u32).filter(|&node| own[node as usize]);
    let unknowns = nodes.flat_map(|node| system.unknowns.of(node));
    unknowns.filter(|&unknown| !system.fixed[unknown]).count()
}

fn courant_of(system: &System, bodies: impl Iterator<Item = usize>, step: f64) -> Option<f64> {
    let passages = bodies.map(|body| system.bodies[body].passage());
    let all = passages.filter(|passage| *passage > 0.0);
    all.map(|passage| step / passage).reduce(f64::max)
}
