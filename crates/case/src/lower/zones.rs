//! Zones: who is in which, with which scheme and step, and how their joints run.

use std::collections::BTreeMap;

use carom_dynamics::ModelContact;
use carom_mesh::ElementId;
use carom_zones::LinkKind;

use super::context::Context;
use super::plan::{self, Plan, Zone};
use super::problems::Problems;
use super::{lookup, time};
use crate::error::Problem;
use crate::schema::{self, Case, InnerSteps, Link, Substeps};

/// Resolves the zones; refuses what can be told without the mesh.
pub(super) fn lower(case: &Case, problems: &mut Problems) -> Plan {
    let mut zones = zones(case, problems);
    substeps(case, &mut zones, problems);
    let kind = link_kind(case, zones.iter().any(|zone| zone.substeps > 1), problems);
    let plan = Plan { zones, kind };
    joints(case, &plan, problems);
    if !plan.zones.is_empty()
        && case.time.scheme.is_some()
        && case.zone.iter().all(|(_, zone)| zone.scheme.is_some())
    {
        problems.warn("time.scheme: every zone has its own scheme, so this one is not used".into());
    }
    plan
}

/// The zones with their bodies; each body in one of them.
fn zones(case: &Case, problems: &mut Problems) -> Vec<Zone> {
    let names: Vec<&str> = case.body.names().collect();
    let mut owner: Vec<Option<&str>> = vec![None; names.len()];
    let mut zones = Vec::new();
    for (name, given) in case.zone.iter() {
        let mut bodies = Vec::new();
        for (k, body) in given.bodies.iter().enumerate() {
            let path = format!("zone.{name}.bodies[{k}]");
            let Some(number) = names.iter().position(|one| one == body) else {
                let problem = Problem::new(path, "no body of this name");
                problems.push(problem.unknown(body, names.iter().copied()));
                continue;
            };
            if let Some(other) = owner[number] {
                let message = format!("this body is in the zone `{other}` too");
                let problem = Problem::new(path, message).found(body);
                problems.push(problem.accepted(["a body of one zone"]));
                continue;
            }
            owner[number] = Some(name);
            bodies.push(number);
        }
        zones.push(Zone {
            name: name.to_string(),
            bodies,
            scheme: given.scheme.unwrap_or(case.time.scheme()),
            scheme_path: match given.scheme {
                Some(_) => format!("zone.{name}.scheme"),
                None => "time.scheme".to_string(),
            },
            substeps: 1,
            far: 1,
        });
    }
    if !zones.is_empty() {
        for (body, _) in names.iter().zip(&owner).filter(|(_, zone)| zone.is_none()) {
            let problem = Problem::new(format!("body.{body}"), "this body is in no zone");
            let zones = zones.iter().map(|zone| zone.name.clone());
            problems.push(problem.accepted(zones));
        }
    }
    zones
}

/// Inner steps of each zone: one of them at least takes the outer step.
fn substeps(case: &Case, zones: &mut [Zone], problems: &mut Problems) {
    let mut given: Vec<(String, &str, [u32; 2])> = Vec::new();
    for (name, zone) in case.zone.iter() {
        let path = format!("zone.{name}.substeps");
        match &zone.substeps {
            None => {}
            Some(Substeps::Own(count)) => given.push((path, name, [count.0; 2])),
            Some(Substeps::Of(counts)) => {
                for (inner, count) in counts.iter() {
                    let steps = match count {
                        InnerSteps::Always(count) => [count.0; 2],
                        InnerSteps::Choice(choice) => [choice.near.0, choice.far.0],
                    };
                    given.push((format!("{path}.{inner}"), inner, steps));
                }
            }
        }
    }
    let names: Vec<&str> = case.zone.names().collect();
    let mut said = vec![false; zones.len()];
    for (path, name, [count, far]) in given {
        let Some(zone) = names.iter().position(|one| *one == name) else {
            let problem = Problem::new(path, "no zone of this name");
            problems.push(problem.unknown(name, names.iter().copied()));
            continue;
        };
        if std::mem::replace(&mut said[zone], true) {
            let message = format!("the steps of the zone `{name}` are given twice");
            problems.push(Problem::new(path, message).found(count));
            continue;
        }
        (zones[zone].substeps, zones[zone].far) = (count, far);
    }
    if !zones.is_empty() && zones.iter().all(|zone| zone.substeps > 1) {
        let problem = Problem::new("zone", "no zone takes the outer step, `time.step`");
        problems.push(problem.accepted(["one zone at least with substeps = 1"]));
    }
}

/// The link of all joints: the one given, or that which suits the steps.
fn link_kind(case: &Case, inner_steps: bool, problems: &mut Problems) -> LinkKind {
    let given: Vec<(String, Link)> = plan::pairs(case)
        .filter_map(|pair| Some((format!("{}.link", pair.path), pair.link?)))
        .collect();
    let text = |link: Link| match link {
        Link::GravouilCombescure => "gravouil-combescure",
        Link::PrakashHjelmstad => "prakash-hjelmstad",
    };
    let Some((first, link)) = given.first() else {
        return match inner_steps {
            false => LinkKind::GravouilCombescure,
            true => LinkKind::PrakashHjelmstad,
        };
    };
    for (path, other) in given.iter().filter(|(_, other)| other != link) {
        let message = format!("all joints of a case have the same link, and `{first}` differs");
        let problem = Problem::new(path, message).found(text(*other));
        problems.push(problem.accepted([text(*link)]));
    }
    match link {
        Link::GravouilCombescure => LinkKind::GravouilCombescure,
        Link::PrakashHjelmstad => LinkKind::PrakashHjelmstad,
    }
}

/// Refuses joints of unknown bodies, and of one zone.
fn joints(case: &Case, plan: &Plan, problems: &mut Problems) {
    for (name, _) in case.interface.iter() {
        if case.arlequin.get(name).is_some() {
            let message = "an overlap has this name too, and results name both by it";
            let problem = Problem::new(format!("interface.{name}"), message);
            problems.push(problem.accepted(["another name"]));
        }
    }
    for plan::Pair { path, bodies, .. } in plan::pairs(case) {
        let Some([inner, outer]) = lookup::bodies(case, &path, bodies, problems) else {
            continue;
        };
        if plan.zones.is_empty() {
            let problem = Problem::new(path, "this joins two zones, and the case has none");
            problems.push(problem.accepted(["a table [zone.<name>] for each of them"]));
            continue;
        }
        let (Some(one), Some(other)) = (plan.zone_of(inner), plan.zone_of(outer)) else {
            continue;
        };
        if one == other {
            let message = format!(
                "both bodies are in the zone `{}`: only zones are joined",
                plan.zones[one].name
            );
            let problem = Problem::new(format!("{path}.outer"), message).found(bodies[1]);
            problems.push(problem.accepted(["a body of another zone"]));
        }
    }
}

/// The scheme that moves a cell.
pub(super) fn scheme_at(
    context: &Context,
    cell: Option<ElementId>,
    of: &[Vec<ElementId>],
) -> schema::Scheme {
    let body = cell.and_then(|cell| body_of(cell, of));
    body.map_or(context.case.time.scheme(), |body| context.scheme_of(body))
}

/// Refuses laws that the schemes of zones cannot take.
pub(super) fn laws(
    context: &Context,
    contacts: &[ModelContact],
    of: &[Vec<ElementId>],
    problems: &mut Problems,
) {
    if context.plan.zones.is_empty() {
        return;
    }
    let mut schemes: BTreeMap<&str, schema::Scheme> = BTreeMap::new();
    for contact in contacts {
        let faces = lookup::faces_of(contact).into_iter().flatten();
        let zones = faces.filter_map(|face| context.plan.zone_of(body_of(face.parent, of)?));
        // of several the one that comes first
        if let Some(zone) = zones.min() {
            schemes.insert(&contact.name, context.plan.zones[zone].scheme);
        }
    }
    let default = context.case.time.scheme();
    let scheme_of = |name: &str| schemes.get(name).copied().unwrap_or(default);
    time::laws(context, scheme_of, problems);
}

/// The body of a cell.
pub(super) fn body_of(cell: ElementId, of: &[Vec<ElementId>]) -> Option<usize> {
    of.iter()
        .position(|cells| cells.binary_search(&cell).is_ok())
}
