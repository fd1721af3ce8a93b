//! The largest values of the fields: of stresses over the steps that were looked at, of others at the instants that were kept.

use carom_dynamics::System;

use crate::maxima::{Maxima, Maximum};
use crate::results::Results;
use crate::results::cells::middle;
use crate::results::page::model;
use crate::results::stills::{Largest, Still};
use crate::results::stressed::Peak;

/// Those of a run that has ended.
pub(crate) fn maxima(results: &Results) -> Maxima {
    let stills = stills(results);
    let bodies = 0..results.system.bodies.len();
    let of_bodies = bodies.filter_map(|body| {
        let peak = stress(results, &stills, body).filter(|peak| peak.value > 0.0)?;
        let middle = middle(&results.system, peak.cell)?;
        let found = (peak.value, peak.time);
        Some(maximum(&results.system, found, (body, &middle)))
    });
    let of_bodies: Vec<Maximum> = of_bodies.collect();
    let larger = |best: Maximum, other: Maximum| match other.value > best.value {
        true => other,
        false => best,
    };
    Maxima {
        instants: stills.len(),
        stress_every: results.stressed.every,
        von_mises: of_bodies.iter().cloned().reduce(larger),
        von_mises_of_bodies: of_bodies,
        strain: of_cells(results, &stills, 2),
        plastic_strain: of_cells(results, &stills, 1),
        displacement: of_nodes(results, &stills),
    }
}

/// The kept instants.
pub(crate) fn stills(results: &Results) -> Vec<&Still> {
    let instants = model::instants(results);
    instants.iter().map(|(still, _)| *still).collect()
}

/// The largest equivalent stress of a body, over the steps that were looked at and the kept instants.
pub(crate) fn stress(results: &Results, stills: &[&Still], body: usize) -> Option<Peak> {
    let kept = stills.iter().filter_map(|still| {
        let (value, cell) = still.of_bodies.get(body)?[0]?;
        let time = still.time;
        Some(Peak { value, cell, time })
    });
    let all = results.stressed.of(body).into_iter().chain(kept);
    all.reduce(|best, other| {
        if other.value > best.value {
            other
        } else {
            best
        }
    })
}

/// The largest of the values at cells: plastic strain or strain.
fn of_cells(results: &Results, stills: &[&Still], field: usize) -> Option<Maximum> {
    let (system, seen) = (&results.system, &results.stills.seen);
    let values = stills.iter();
    let values = values.filter_map(|still| Some((still.largest[field]?, still.time)));
    let larger = |best: (Largest, f64), other: (Largest, f64)| match other.0.value > best.0.value {
        true => other,
        false => best,
    };
    let best = values.reduce(larger).filter(|best| best.0.value > 0.0);
    let (Largest { value, cell, .. }, time) = best?;
    let middle = middle(system, cell)?;
    let body = seen.body_of_cell[cell as usize] as usize;
    Some(maximum(system, (value, time), (body, &middle)))
}

/// The largest displacement of a node that is seen.
fn of_nodes(results: &Results, stills: &[&Still]) -> Option<Maximum> {
    let (system, seen) = (&results.system, &results.stills.seen);
    let moved = stills.iter().flat_map(|still| {
        let nodes = still.moved.iter().zip(&seen.nodes);
        nodes.map(|(u, node)| {
            let length = u.iter().map(|u| f64::from(*u).powi(2)).sum::<f64>().sqrt();
            (length, *node, still.time)
        })
    });
    let best = moved.reduce(|best, other| if other.0 > best.0 { other } else { best });
    let (length, node, time) = best?;
    let mut bodies = system.body_masses.iter();
    let has = |masses: &Vec<(u32, f64)>| masses.iter().any(|(own, _)| *own == node);
    let body = bodies.position(has).unwrap_or(usize::MAX);
    Some(maximum(
        system,
        (length, time),
        (body, &system.x[node as usize]),
    ))
}

fn maximum(system: &System, (value, time): (f64, f64), (body, x): (usize, &[f64; 3])) -> Maximum {
    let body = system.bodies.get(body);
    Maximum {
        value,
        body: body.map_or(String::new(), |body| body.name().to_owned()),
        place: x[..system.dim].to_vec(),
        time,
    }
}
