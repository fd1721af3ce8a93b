//! Runs in zones: what their results folder says against the zones' own.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use carom_arlequin::{Coupling, Model as Side, Models, Overlap, Region, Weighting};
use carom_bodies::{BodySpec, CellWeights, Kinematics};
use carom_dynamics::scheme::{CentralDifference, Theta};
use carom_dynamics::{
    Model, ModelBody, ModelContact, ModelLink, ModelTarget, Scheme, Stepper, march,
};
use carom_mesh::{ElementId, Surface, generate};
use carom_output::summary::Zones;
use carom_output::{Ending, Grade, Results, Summary, Zoning, checkpoint};
use carom_studies::compare::Recorder;
use carom_zones::{LinkKind, ModelZone, Whole, Zoned};

use crate::models::{self, AREA, LENGTH, SPEED, STEEL};
use crate::{grids, tables};

/// Cells of the rest over the length of a bar, and of the tips over one of these; steps of the tips to one of the rest.
const COARSE: usize = 25;
const RATIO: usize = 4;

/// The two bars with their tips, two fifths of the length, in a fine zone by the theta scheme, the rest coarse and
/// explicit at Courant number 1/2; overlaps of a fifth of the length, inner steps as fine as the cells.
fn two_bars() -> Zoned {
    let h = LENGTH / COARSE as f64;
    let line = |name: &str, from: f64, to: f64, h: f64| {
        let n = ((to - from) / h).round() as usize;
        generate::line(name, [from, 0.0, 0.0], [to, 0.0, 0.0], n, 1)
    };
    let fine = h / RATIO as f64;
    let mut mesh = line("striker-tip", -0.4 * LENGTH, 0.0, fine);
    for (name, from, to, h) in [
        ("target-tip", 0.0, 0.4 * LENGTH, fine),
        ("striker", -LENGTH, -0.2 * LENGTH, h),
        ("target", 0.2 * LENGTH, LENGTH, h),
    ] {
        mesh.merge(name, line(name, from, to, h)).unwrap();
    }
    let (mut bodies, mut links) = (vec![None, None, None, None], Vec::new());
    for (k, (inner, outer, speed)) in [
        ("striker-tip", "striker", SPEED),
        ("target-tip", "target", 0.0),
    ]
    .into_iter()
    .enumerate()
    {
        let models = Models {
            mesh: &mesh,
            inner: &mesh.groups[inner].elements,
            outer: &mesh.groups[outer].elements,
        };
        let overlap = Overlap::new(models, &Region::Intersection).unwrap();
        let weights = overlap.weights(&Weighting::default()).unwrap();
        let body = |name: &str, cells: &[ElementId], weights: carom_arlequin::CellWeights| {
            Some(ModelBody {
                velocity: [speed, 0.0, 0.0],
                ..ModelBody::new(BodySpec {
                    weights: Some(CellWeights {
                        inertia: weights.inertia,
                        stiffness: weights.stiffness,
                    }),
                    ..BodySpec::new(name, cells.to_vec(), Kinematics::Bar { area: AREA }, STEEL)
                })
            })
        };
        bodies[k] = body(inner, overlap.cells(Side::Inner), weights.inner);
        bodies[2 + k] = body(outer, overlap.cells(Side::Outer), weights.outer);
        links.push(ModelLink {
            name: outer.to_owned(),
            zones: [0, 1],
            rows: overlap.rows(&Coupling::default()).unwrap().rows,
        });
    }
    let bodies: Vec<ModelBody> = bodies.into_iter().flatten().collect();
    let surface = |group: &str, body: &ModelBody| {
        Surface::new(&mesh, &mesh.groups[group], &body.spec.cells).unwrap()
    };
    let contacts = vec![ModelContact::new(
        "shock",
        surface("striker-tip.right", &bodies[0]),
        ModelTarget::Surface(surface("target-tip.left", &bodies[1])),
        models::velocity_law(),
    )];
    let zone =
        |name: &str, bodies, scheme, substeps| ModelZone::new(name, bodies, (scheme, substeps));
    let rest = Scheme::CentralDifference(CentralDifference {});
    Zoned {
        zones: vec![
            zone(
                "tips",
                vec![0, 1],
                Scheme::Theta(Theta { theta: 0.6 }),
                RATIO as u32,
            ),
            zone("rest", vec![2, 3], rest, 1),
        ],
        links,
        kind: LinkKind::PrakashHjelmstad,
        model: Model {
            contacts,
            ..Model::new(bodies, mesh, rest, 0.5 * h / models::wave_speed())
        },
    }
}

/// A run with its folder, its histories and the zones at the end.
fn run(folder: &Path, end: f64) -> (Summary, Recorder, Whole) {
    let zoned = two_bars();
    let system = zoned.whole().unwrap();
    let mut settings = models::settings(folder);
    settings.reference = Some(models::exact(end + system.dt));
    settings.fields = models::all_fields(0.5 * models::duration());
    settings.zoning = Some(Zoning::of(&zoned));
    settings.probes = vec![models::probe(&system, "tip", "striker-tip.right")];
    let mut recorder = Recorder::new(&system, settings.reference.as_ref(), None);
    let mut whole = Whole::new(&zoned, Arc::clone(&system)).unwrap();
    let mut results = Results::create(settings, system).unwrap();
    march(&mut whole, end, &mut [&mut results, &mut recorder], &|| {
        false
    })
    .unwrap();
    let ending = Ending {
        unfinished: None,
        costs: &whole.costs(),
        zones: Some(Zones::of(&whole)),
        wall: Duration::from_secs(1),
    };
    (results.conclude(&ending).unwrap(), recorder, whole)
}

/// Impulse that the multipliers may leave in sum, N s: to the theta scheme a multiplier linear over the outer step has the
/// mean 1/2 + (θ - 1/2)/m of its growth, to the explicit one half of it. Over all steps that is the growth since the
/// start, a force of the contact in each of the two overlaps at most.
fn slip(dt: f64) -> f64 {
    let f0 = 0.5 * STEEL.density * models::wave_speed() * AREA * SPEED;
    2.0 * 0.1 / RATIO as f64 * dt * f0
}

/// A column of a table of numbers.
fn column(path: &Path, name: &str) -> Vec<f64> {
    let (names, rows) = tables::read(path);
    let k = names.iter().position(|n| n == name).unwrap();
    rows.iter().map(|row| row[k].parse().unwrap()).collect()
}

#[test]
fn every_inner_step_is_in_the_table_of_contacts_and_in_what_is_made_of_it() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("zones.carom");
    let end = 1.2 * models::duration();
    let (summary, recorder, whole) = run(&folder, end);
    assert!(
        summary.verdict.grade == Grade::Good,
        "{:?}",
        summary.verdict
    );
    let dt = whole.system().dt;
    let fine = dt / RATIO as f64;

    let outer = folder.join("histories.csv");
    let inner = folder.join("contact.csv");
    let (times, force) = (
        column(&inner, "time_s"),
        column(&inner, "contact.shock.force_n"),
    );
    let steps = summary.time.steps as usize;
    assert_eq!(times.len(), 1 + RATIO * steps);
    for (k, time) in times.iter().enumerate() {
        assert!((time - k as f64 * fine).abs() <= 1e-12 * time);
    }
    // forces of outer steps are the means of the inner ones
    let means = column(&outer, "contact.shock.force_n");
    assert_eq!(means.len(), 1 + steps);
    for (mean, parts) in means[1..].iter().zip(force[1..].chunks_exact(RATIO)) {
        let sum: f64 = parts.iter().sum();
        assert!((RATIO as f64 * mean - sum).abs() <= 1e-14 * sum.abs());
    }
    // sums, peaks and means as the records of the zone have them
    let contact = &summary.contacts["shock"];
    let record = &whole.zones().drivers()[0].state().records.contacts[0];
    let impulse = fine * force.iter().sum::<f64>();
    assert!((contact.impulse.unwrap() / impulse - 1.0).abs() < 1e-12);
    assert_eq!(
        contact.peak_force,
        force.iter().copied().fold(0.0, f64::max)
    );
    assert_eq!(contact.peak_force, record.peak_force);
    assert_eq!(contact.first_closing, record.first_closing);
    let steps = (contact.window / fine).round() as usize;
    assert_eq!(
        steps,
        5 * RATIO,
        "a tenth of the way of a wave through the whole bar, not through its tip"
    );
    let means = force
        .windows(steps)
        .map(|w| w.iter().sum::<f64>() / steps as f64);
    assert!((contact.peak_mean_force.unwrap() / means.fold(0.0, f64::max) - 1.0).abs() < 1e-12);

    // the definition of the error in the force, with inner steps that meet (0, T)
    let f0 = 0.5 * STEEL.density * models::wave_speed() * AREA * SPEED;
    let (mut error, mut size) = (0.0, 0.0);
    for (k, force) in force.iter().enumerate().skip(1) {
        let part = (models::duration() / fine - (k as f64 - 1.0)).min(1.0);
        if part > 1e-9 {
            error += (force - part * f0).powi(2);
            size += (part * f0).powi(2);
        }
    }
    let exact = summary.exact.as_ref().unwrap();
    let found = exact.force_error.unwrap();
    assert!((found / (error / size).sqrt() - 1.0).abs() < 1e-9);
    // the bars part, tips and rests together, as the impulse has it
    let mass = STEEL.density * AREA * LENGTH;
    let separation = 2.0 * contact.impulse.unwrap() / mass - SPEED;
    let found = exact.restitution.unwrap() * SPEED;
    assert!((found - separation).abs() < 2.0 * slip(dt) / mass);
    // which the two tips alone do not show
    assert_eq!((contact.impacts, contact.restitution), (1, None));
    // and a comparison sees the inner steps too
    let history = recorder.into_history();
    assert!((history.force.impulse(end) / impulse - 1.0).abs() < 1e-12);
    let half = 0.5 * fine;
    let first = history.force.impulse(half) / half;
    assert!(
        (first - force[1]).abs() < 1e-12 * force[1],
        "not the mean of four"
    );
}

#[test]
fn zones_links_and_costs_are_in_summary_report_and_picture() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("zones.carom");
    let (summary, _, whole) = run(&folder, 0.5 * models::duration());
    let zones = summary.zones.as_ref().unwrap();
    let balance = whole.state().ledger.balance;
    assert_eq!(summary.energy.works["links"], balance.work_links);
    let works = zones.zones.iter().map(|zone| zone.work_of_links);
    assert_eq!(works.sum::<f64>(), zones.work_of_links);
    // what one side gives the other takes; inner steps behind a jump of the force lose a little
    let given = zones.zones[0].work_of_links;
    let part = zones.relative_work_of_links.unwrap();
    assert!(given > 0.0 && zones.zones[1].work_of_links < 0.0);
    assert!(part.abs() < 1e-3 && zones.work_of_links.abs() < 0.1 * given);
    assert!((part * summary.energy.kinetic_initial / zones.work_of_links - 1.0).abs() < 1e-12);
    assert_eq!(
        *column(&folder.join("histories.csv"), "work.links_j")
            .last()
            .unwrap(),
        balance.work_links
    );
    // both links move momentum from one zone to the other, and make no more than they may
    assert!(summary.momentum.impulses["links"][0].abs() < slip(whole.system().dt));

    let [tips, rest] = &zones.zones[..] else {
        panic!("two zones");
    };
    assert_eq!([tips.substeps, rest.substeps], [RATIO as u32, 1]);
    assert_eq!([tips.elements, rest.elements], [80, 40]);
    assert_eq!([tips.unknowns, rest.unknowns], [82, 42]);
    assert!((tips.courant.unwrap() / rest.courant.unwrap() - 1.0).abs() < 1e-9);
    assert_eq!(
        [tips.costs, rest.costs].map(|costs| costs.unwrap().solves > 0),
        [true, false],
        "one side is explicit"
    );
    let (updates, solves) = (summary.counts.element_updates, summary.counts.solves);
    let [tips, rest] = [tips, rest].map(|zone| zone.costs.unwrap());
    assert_eq!(updates, tips.element_updates + rest.element_updates);
    assert_eq!(solves, tips.solves);
    assert!(tips.element_updates >= 80 * RATIO as u64 * summary.time.steps);
    // five elements of the mediator and their ends on each side
    let rows: Vec<usize> = zones.links.iter().map(|link| link.rows).collect();
    assert_eq!(rows, [6, 6]);
    assert!(zones.passes_per_step.is_none_or(|passes| passes >= 1.0));
    assert_eq!(
        Summary::from_json(&fs::read_to_string(folder.join("summary.json")).unwrap()).unwrap(),
        summary
    );

    let report = fs::read_to_string(folder.join("report.html")).unwrap();
    for text in [
        "Zones and links",
        "<th scope=\"row\">tips</th>",
        "work of links",
        "Element updates",
        "Zones of the model",
    ] {
        assert!(report.contains(text), "{text}");
    }
    let picture = fs::read_to_string(folder.join("plots/model.svg")).unwrap();
    assert!(picture.contains("tips") && picture.contains("rest") && picture.contains("weight"));
    // the two models share the mass of the bars, cell by cell in the first file of the fields
    let (_, arrays) = grids::read(&folder.join("fields/bodies-000000.vtu"));
    let (zone, weights) = (arrays["zone"].integers(), arrays["inertia_weight"].floats());
    assert_eq!(weights, arrays["stiffness_weight"].floats(), "one profile");
    let h = LENGTH / COARSE as f64;
    let length = |zone: i64| if zone == 0 { h / RATIO as f64 } else { h };
    let sum: f64 = zone.iter().zip(&weights).map(|(z, w)| length(*z) * w).sum();
    assert!((sum / (2.0 * LENGTH) - 1.0).abs() < 1e-12);
    let (_, arrays) = grids::read(&folder.join("fields/bodies-000001.vtu"));
    assert!(!arrays.contains_key("zone"), "it never changes");
}

#[test]
fn the_checkpoint_of_a_run_in_zones_is_what_it_goes_on_from() {
    let parent = tempfile::tempdir().unwrap();
    let (cut, through) = (
        parent.path().join("cut.carom"),
        parent.path().join("all.carom"),
    );
    let (end, half) = (models::duration(), 0.5 * models::duration());
    run(&cut, half);
    let (_, _, whole) = run(&through, end);
    let saved = checkpoint::read(&cut.join(checkpoint::name(0))).unwrap();
    let zoned = two_bars();
    let system = zoned.whole().unwrap();
    let mut resumed = Whole::resume(&zoned, system, &saved.state).unwrap();
    assert!(resumed.state().time < 0.6 * end);
    march(&mut resumed, end, &mut [], &|| false).unwrap();
    assert_eq!(resumed.saved().unwrap(), whole.saved().unwrap());
    assert_eq!(resumed.state(), whole.state());
}
