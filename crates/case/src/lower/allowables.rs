//! What bodies, supports, springs and bolts may bear.

use carom_dynamics::System;
use carom_output::{AllowableSettings, Bearer};

use super::context::Context;
use super::problems::Problems;
use crate::error::Problem;

/// All that the case allows, bodies and supports by their places in the system.
pub(super) fn lower(
    context: &Context,
    system: &System,
    problems: &mut Problems,
) -> Vec<AllowableSettings> {
    let Some(given) = &context.case.output.allowable else {
        return Vec::new();
    };
    let mut all = Vec::new();
    let mut add = |of: Bearer, allowable: Option<f64>| {
        all.extend(allowable.map(|allowable| AllowableSettings { of, allowable }));
    };
    let names: Vec<&str> = system.bodies.iter().map(|body| body.name()).collect();
    for (name, body) in given.body.iter() {
        let Some(number) = names.iter().position(|own| *own == name) else {
            let own = context.case.body.names();
            unknown_bearer("body", name, own.collect(), problems);
            continue;
        };
        add(Bearer::Stress(number), body.stress.map(|stress| stress.0));
        add(Bearer::PlasticStrain(number), body.plastic_strain);
    }
    let names: Vec<&str> = system.supports.iter().map(|s| s.name.as_str()).collect();
    for (name, support) in given.support.iter() {
        let Some(number) = names.iter().position(|own| *own == name) else {
            unknown_bearer("support", name, names.clone(), problems);
            continue;
        };
        add(Bearer::Support(number), Some(support.force.0));
    }
    let names: Vec<&str> = context.case.spring.names().collect();
    for (name, spring) in given.spring.iter() {
        if !names.contains(&name) {
            unknown_bearer("spring", name, names.clone(), problems);
            continue;
        }
        add(
            Bearer::SpringForce(name.to_owned()),
            spring.force.map(|force| force.0),
        );
        add(
            Bearer::SpringStroke(name.to_owned()),
            spring.stroke.map(|stroke| stroke.0),
        );
    }
    let tightened: Vec<&str> = context.case.pretension.names().collect();
    for (name, bolt) in given.pretension.iter() {
        if !tightened.contains(&name) {
            unknown_bearer("pretension", name, tightened.clone(), problems);
            continue;
        }
        let bolts = system.bodies.iter().flat_map(|body| body.bolts());
        let own = bolts.filter(|bolt| is_of(&bolt.name, name));
        let own = own.map(|bolt| bolt.name.clone()).collect();
        add(Bearer::Bolts(name.to_owned(), own), Some(bolt.force.0));
    }
    all
}

fn unknown_bearer(kind: &str, name: &str, names: Vec<&str>, problems: &mut Problems) {
    let path = format!("output.allowable.{kind}.{name}");
    let problem = Problem::new(path, format!("no {kind} of this name"));
    problems.push(problem.unknown(name, names));
}

/// Whether a bolt is the one of this name, or one of several.
fn is_of(bolt: &str, name: &str) -> bool {
    let number = bolt
        .strip_prefix(name)
        .and_then(|rest| rest.strip_prefix('-'));
    let is_number = |text: &str| text.chars().all(|c| c.is_ascii_digit());
    bolt == name || number.is_some_and(is_number)
}
