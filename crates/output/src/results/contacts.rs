//! What the summary says of the contacts of a run that has ended.

use std::collections::BTreeMap;

use carom_contact::Integration;
use carom_dynamics::ContactPair;
use carom_dynamics::{ContactRecord, Impact, NoRestitution};

use crate::results::impacts::ContactTotals;
use crate::results::{LevelSettings, Results};
use crate::statistics::{Depth, Level, Statistics, takes_energy};
use crate::summary::{Contact, Friction};

/// Each contact by its name.
pub(crate) fn contacts(results: &Results) -> BTreeMap<String, Contact> {
    let system = &results.system;
    let all = system.contacts.iter().zip(&results.impacts.told.contacts);
    let in_time = |value: f64| (!results.is_static()).then_some(value);
    let all_impacts = &results.impacts.all;
    let name = |k: usize| system.contacts[k].name.as_str();
    let one = |(k, (contact, totals)): (usize, (&ContactPair, &ContactTotals))| {
        let none = ContactRecord::default();
        let records = &results.last.records;
        let record = records.contacts.get(k).unwrap_or(&none);
        let closed = totals.closed;
        let still_closed = results.last.closed.get(k) == Some(&true);
        let impacts = || {
            records
                .ended()
                .filter(|impact| impact.contact as usize == k)
        };
        // with none that has ended the one that goes on
        let last = impacts().last().or_else(|| {
            let mut own = all_impacts.iter().rev();
            own.find(|impact| impact.contact as usize == k).cloned()
        });
        (
            contact.name.clone(),
            Contact {
                law: contact.law.get().name().to_owned(),
                preload: totals.preload.filter(|_| !results.is_static()),
                peak_force: record.peak_force,
                peak_resultant: totals.resultant,
                peak_moment: totals.moment,
                peak_mean_force: in_time(totals.mean.peak()).filter(|_| totals.window > 0.0),
                window: totals.window,
                mean_force: in_time(match closed > 0.0 {
                    true => record.impulse() / closed,
                    false => 0.0,
                }),
                impulse: in_time(record.impulse()),
                impulsive: record.impulse_of_jumps(),
                friction: system.contacts[k].friction.acts().then(|| Friction {
                    coefficient: system.contacts[k].friction.get().sticks(),
                    kinetic: system.contacts[k].friction.kinetic(),
                    peak_force: totals.peak_friction,
                    loss: record.friction_loss(),
                }),
                first_closing: record.first_closing,
                last_release: record.last_force.filter(|_| !still_closed),
                status_changes: record.status_changes,
                chatter: record.chatter(),
                max_penetration: record.penetration,
                persistency_defect: record.persistency_defect(),
                energy_crushed: record.energy_crushed,
                mixed_supports: matches!(contact.integration, Integration::Weak { .. })
                    .then_some(record.mixed),
                impacts: impacts().filter(|impact| record.counts(impact)).count()
                    + usize::from(still_closed && !results.is_static()),
                restitution: last
                    .as_ref()
                    .and_then(|impact| impact.restitution)
                    .filter(|_| !totals.of_parts),
                no_restitution: no_restitution(last.as_ref(), totals.of_parts),
                statistics: {
                    let own = |impact: &&Impact| impact.contact as usize == k;
                    let own: Vec<&Impact> = all_impacts.iter().filter(own).collect();
                    let some = || Statistics::of(&own, name, record.friction_loss());
                    (!own.is_empty()).then(some)
                },
            },
        )
    };
    all.enumerate().map(one).collect()
}

/// Why the last impact of a contact has no restitution.
fn no_restitution(impact: Option<&Impact>, of_parts: bool) -> Option<String> {
    let why = match impact?.no_restitution {
        Some(NoRestitution::Unfinished) => "the contact is closed at the end",
        Some(NoRestitution::NoApproach) => {
            "the mean motions of the bodies did not approach each other"
        }
        Some(NoRestitution::NoParting) => {
            "the mean motions of the bodies still approach each other after the impact"
        }
        Some(NoRestitution::OtherForces) => {
            "supports, loads, joints or further contacts gave more than 1 % of the impulse"
        }
        Some(NoRestitution::TurnedForce) => {
            "the direction of the force turned during the impact, as where bodies slide over each other"
        }
        Some(NoRestitution::ManyBodies) => {
            "a side has several bodies; a contact for each, or `general-contact.by = \"bodies\"`, tells them apart"
        }
        Some(NoRestitution::MovingObstacle) => "the obstacle moves",
        None if of_parts => "links join further bodies to one of the two",
        None => return None,
    };
    Some(why.to_owned())
}

/// The levels of the case.
pub(crate) fn levels(results: &Results) -> BTreeMap<String, Level> {
    let name = |k: usize| results.system.contacts[k].name.as_str();
    let records = &results.last.records.contacts;
    let one = |level: &LevelSettings| {
        let own = |impact: &&Impact| level.contacts.contains(&(impact.contact as usize));
        let impacts: Vec<&Impact> = results.impacts.all.iter().filter(own).collect();
        let losses = level.contacts.iter().filter_map(|k| records.get(*k));
        let loss = losses
            .map(ContactRecord::friction_loss)
            .fold(0.0, |a, b| a + b);
        let depths = level.contacts.iter().filter_map(|&k| {
            let record = records.get(k)?;
            Some(Depth {
                contact: k,
                stroke: record.penetration,
                crush: results.last.crushes.get(k).copied().unwrap_or(0.0),
                time: record.peak_time,
            })
        });
        let depths: Vec<Depth> = depths.collect();
        let of_both = (&impacts[..], &depths[..]);
        let takes = |contact: usize| takes_energy(&results.system, contact);
        let allowed = (loss, level.allowable);
        let of = Level::of(&level.contacts, of_both, name, allowed, takes);
        (level.name.clone(), of)
    };
    results.settings.levels.iter().map(one).collect()
}
