//! What bodies, supports, springs and bolts had to bear, against what the case allows.

use crate::results::settings::{AllowableSettings, Bearer};
use crate::results::stills::Still;
use crate::results::{Results, largest};
use crate::statistics::{Check, Margin};

/// All that the case allows, with what was found.
pub(crate) fn checks(results: &Results, stills: &[&Still]) -> Vec<Check> {
    let settings = results.settings.allowables.iter();
    settings
        .map(|allowed| check(results, stills, allowed))
        .collect()
}

fn check(results: &Results, stills: &[&Still], allowed: &AllowableSettings) -> Check {
    let body = |body: usize| results.system.bodies[body].name().to_owned();
    let all = results.discrete.all();
    let (quantity, kind, name, unit, found) = match &allowed.of {
        Bearer::Stress(number) => {
            let found = largest::stress(results, stills, *number);
            let found = found.map(|peak| [peak.value, peak.time]);
            ("von Mises stress", "body", body(*number), "Pa", found)
        }
        Bearer::PlasticStrain(number) => {
            let found = plastic_strain(stills, *number);
            ("plastic strain", "body", body(*number), "", found)
        }
        Bearer::Support(number) => {
            let name = results.system.supports[*number].name.clone();
            let found = results.supports.peaks.get(*number).copied();
            ("force", "support", name, "N", found)
        }
        Bearer::SpringForce(name) => {
            let found = all.get(name).map(|spring| [spring.peak_force, spring.time]);
            ("force", "spring", name.clone(), "N", found)
        }
        Bearer::SpringStroke(name) => {
            let found = all.get(name).map(|spring| [spring.extent, spring.time]);
            ("stroke", "spring", name.clone(), "m", found)
        }
        Bearer::Bolts(name, bolts) => {
            let stage = results.system.nonlinear.preload;
            let end = stage.map_or(0.0, |stage| stage.end);
            let all = results.bolts.all(&results.system);
            let all = bolts.iter().filter_map(|bolt| all.get(bolt));
            let forces = all.flat_map(|bolt| {
                let begin = bolt.end_of_stage.map(|force| [force, end]);
                bolt.largest.into_iter().chain(begin)
            });
            let found = forces.reduce(|most, other| if other[0] > most[0] { other } else { most });
            ("force", "pretension", name.clone(), "N", found)
        }
    };
    let governing = found.map(|[value, time]| (value, (name.clone(), time)));
    Check {
        quantity: quantity.to_owned(),
        kind: kind.to_owned(),
        unit: unit.to_owned(),
        margin: Margin::of(allowed.allowable, governing),
        name,
    }
}

/// The largest plastic strain of a body at the kept instants, and when.
fn plastic_strain(stills: &[&Still], body: usize) -> Option<[f64; 2]> {
    let values = stills.iter();
    let values = values.filter_map(|still| {
        let (value, _) = still.of_bodies.get(body)?[1]?;
        Some([value, still.time])
    });
    values.reduce(|best, other| if other[0] > best[0] { other } else { best })
}
