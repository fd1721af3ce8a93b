//! What must not change the answer: the frame of reference, where the origin lies and how the axes stand, the size of all, who else is there,
//! and the order of names.
//!
//! Models from seeds ([`model`]): one to three blocks that collide, fall on a plane or on each other, with all laws and some schemes, with and without
//! friction, at small and finite strain. Each is computed as it is and changed, and impulses, largest forces and all grades are
//! compared.
//!
//! The bound of a difference is stated before the runs. Places are known to 1e-16 of their size L (the distance from the origin, or
//! the way of the frame); a contact force of a node is its gap over the step squared times its mass, or its strain times its
//! stiffness: it is wrong by the rounding of the place over the displacement of an impact, v dt. So the relative difference is at most
//! 1e-16 L / (v dt) times the number of operations, a hundred; where places stay 1e-9, solves of a condition of 1e6, and at finite strain
//! 1e-6, tolerances of 1e-12 of iterations over some two hundred steps. Where a motion answers to its start more than that, which laws do that
//! make energy or friction that sticks and slips, its condition is measured: the model is also computed from starts that differ by
//! up to a hundred roundings of a place, and twice what its forces change by comes on top. A grade that these starts change is at its bound.

mod file;
mod model;

use carom_output::{Grade, Summary};

use self::file::Meshed;
use self::model::{Bystander, Change, Model};
use crate::verdict::result;

/// Models of a change, each computed as it is and changed, unless the variable CAROM_MODELS of the environment has another number: 200 take some ten
/// minutes.
const MODELS: u64 = 20;

/// How many there are.
fn models() -> u64 {
    std::env::var("CAROM_MODELS").map_or(MODELS, |number| number.parse().unwrap())
}

/// Rounding of a place, relative.
const ROUNDING: f64 = 1e-16;

/// How far starts nearby are, in roundings of a place.
const STARTS: [f64; 4] = [100.0, -100.0, 30.0, -30.0];

/// The same where these do not tell how far apart answers are: the largest of a few differences is less than that of many.
const MORE: [f64; 24] = {
    let mut all = [0.0; 24];
    let mut k = 0;
    while k < 24 {
        all[k] = 8.0 * (k as f64 - 11.5);
        k += 1;
    }
    all
};

/// What is compared of a run.
struct Answer {
    grade: Grade,
    /// Grade and value by name of the line.
    grades: Vec<(String, Grade, f64)>,
    /// Impulse and largest force of each contact.
    forces: Vec<[f64; 2]>,
}

fn answer_of(model: &Model, change: &Change) -> Answer {
    let folder = tempfile::tempdir().unwrap();
    let file = change.meshed.map(|meshed| {
        let text = file::msh(model.blocks(), change, meshed);
        file::write(&folder, &text)
    });
    let (summary, _) = result(&model.text(change, file.as_deref()));
    let contact = |name: &str| -> [f64; 2] {
        let contact = &summary.contacts[name];
        [contact.impulse.unwrap(), contact.peak_force]
    };
    let mut own: Vec<&str> = summary.contacts.keys().map(String::as_str).collect();
    own.retain(|name| name.starts_with('c'));
    if change.reversed {
        own.reverse();
    }
    Answer {
        grade: summary.verdict.grade,
        grades: grades(&summary),
        forces: own.into_iter().map(contact).collect(),
    }
}

fn grades(summary: &Summary) -> Vec<(String, Grade, f64)> {
    let lines = summary.verdict.lines.iter();
    lines
        .map(|line| (line.name.clone(), line.grade, line.value))
        .collect()
}

/// Compares the models of the `number`-th change with their changed ones; with the change: the size of places, m.
fn hold(number: u64, change: impl Fn(&Model) -> (Change, f64)) {
    let seeds = number * models()..(number + 1) * models();
    hold_all(seeds.map(|seed| (seed, Model::new(seed))), change);
}

/// The same of models that are changed both times ([`Model::matching`]).
fn hold_of(number: u64, of: impl Fn(Model) -> Model, change: Change) {
    let seeds = number * models()..(number + 1) * models();
    let models = seeds.map(|seed| (seed, of(Model::new(seed))));
    hold_all(models, |_| (change, 1.0));
}

fn hold_all(models: impl Iterator<Item = (u64, Model)>, change: impl Fn(&Model) -> (Change, f64)) {
    let (mut broken, mut text) = (Vec::new(), String::new());
    for (seed, model) in models {
        let (change, place) = change(&model);
        let tolerance = match change.bystander {
            // what is not linear is iterated
            Some(Bystander::Rigid | Bystander::Loaded | Bystander::Strikes) => 1e-6,
            _ => model.tolerance(),
        };
        let bound = tolerance + 100.0 * ROUNDING * place / (model.speed() * model.step());
        let [plain, changed] = [Change::default(), change].map(|change| answer_of(&model, &change));
        let mut near = Vec::new();
        for starts in [&STARTS[..], &MORE] {
            if differences((&plain, &changed), &near, &change, bound).is_empty() {
                break;
            }
            let raised = starts.iter().map(|roundings| Change {
                raised: roundings * ROUNDING * place,
                ..Change::default()
            });
            near.extend(raised.map(|change| answer_of(&model, &change)));
        }
        let all = differences((&plain, &changed), &near, &change, bound);
        if !all.is_empty() && text.is_empty() {
            text = model.text(&change, None);
        }
        broken.extend(all.iter().map(|one| format!("{seed}: {one}")));
    }
    assert!(broken.is_empty(), "{}\n\n{text}", broken.join("\n"));
}

/// What differs between the answers to a model as it is and changed, beyond the bound and what starts nearby differ by.
fn differences(
    (plain, changed): (&Answer, &Answer),
    near: &[Answer],
    change: &Change,
    bound: f64,
) -> Vec<String> {
    let mut all = Vec::new();
    let scales = [change.scale.powi(3), change.scale.powi(2)];
    for (contact, (one, other)) in plain.forces.iter().zip(&changed.forces).enumerate() {
        for (k, name) in ["impulse", "peak"].into_iter().enumerate() {
            let by = |near: &Answer| (one[k] - near.forces[contact][k]).abs() * scales[k];
            let condition = near.iter().map(by).fold(0.0, f64::max);
            let (one, other) = (one[k] * scales[k], other[k]);
            let bound = bound * one.abs().max(other.abs()) + 2.0 * condition;
            if (one - other).abs() > bound {
                all.push(format!("{name} {one:e} {other:e}, bound {bound:e}"));
            }
        }
    }
    for (name, grade, value) in &plain.grades {
        // one body has no other to meet
        if ["met", "surfaces"].contains(&name.as_str()) && change.meshed == Some(Meshed::Joined) {
            continue;
        }
        let of = |all: &Answer| {
            let mut lines = all.grades.iter();
            lines.find(|(other, ..)| other == name).map(|line| line.1)
        };
        let other = of(changed);
        // what strikes by itself has lines of its own, and the worst is told
        if change.bystander == Some(Bystander::Strikes) && other > Some(*grade) {
            continue;
        }
        if other != Some(*grade) && near.iter().all(|near| other != of(near)) {
            all.push(format!("{name} {grade:?} {value:e} {other:?}"));
        }
    }
    let strikes = change.bystander == Some(Bystander::Strikes);
    let differs = |answer: &Answer| match strikes {
        true => answer.grade > changed.grade,
        false => answer.grade != changed.grade,
    };
    if differs(plain) && near.iter().all(differs) {
        all.push(format!("{:?} {:?}", plain.grade, changed.grade));
    }
    all
}

#[test]
fn a_uniform_velocity_along_what_holds_nothing_changes_no_answer() {
    for (number, speed) in [(0, 1.0), (1, 100.0), (2, 1e4)] {
        hold(number, |model| {
            let change = Change {
                velocity: speed,
                ..Change::default()
            };
            (change, speed * model.end())
        });
    }
}

#[test]
fn the_order_of_bodies_and_contacts_changes_no_answer() {
    hold(9, |_| {
        let change = Change {
            reversed: true,
            ..Change::default()
        };
        (change, 1.0)
    });
}

#[test]
fn the_order_of_nodes_and_elements_changes_no_answer() {
    let change = Change {
        meshed: Some(Meshed::Renumbered),
        ..Change::default()
    };
    hold_of(15, Model::matching, change);
}

#[test]
fn two_bodies_of_one_material_are_one() {
    for (number, meshed) in [(16, Meshed::Split), (17, Meshed::Joined)] {
        let change = Change {
            meshed: Some(meshed),
            ..Change::default()
        };
        hold_of(number, Model::together, change);
    }
}

/// Where nodes stay on nodes: elsewhere the sides have other points.
#[test]
fn the_choice_of_the_secondary_side_changes_no_answer() {
    let change = Change {
        swapped: true,
        ..Change::default()
    };
    hold_of(18, Model::symmetric, change);
}

#[test]
fn the_axes_change_no_answer() {
    for (number, turned, mirrored) in [(3, true, false), (4, false, true), (5, true, true)] {
        hold(number, |_| {
            let change = Change {
                turned,
                mirrored,
                ..Change::default()
            };
            (change, 1.0)
        });
    }
}

#[test]
fn the_distance_of_the_origin_changes_no_answer() {
    for (number, distance) in [(6, 1e3), (7, 1e6)] {
        hold(number, |_| {
            let change = Change {
                distance,
                ..Change::default()
            };
            (change, distance)
        });
    }
}

#[test]
fn the_size_of_all_changes_no_answer() {
    for (number, scale) in [(10, 1e-3), (11, 1e3)] {
        hold(number, |_| {
            let change = Change {
                scale,
                ..Change::default()
            };
            (change, 1.0)
        });
    }
}

#[test]
fn a_body_that_touches_nothing_changes_no_answer() {
    let bystanders = [
        (12, Bystander::Flies),
        (13, Bystander::Rigid),
        (14, Bystander::Loaded),
        (19, Bystander::Strikes),
    ];
    for (number, bystander) in bystanders {
        hold(number, |model| {
            let change = Change {
                bystander: model.takes(bystander).then_some(bystander),
                ..Change::default()
            };
            // it moves by 60 m/s and makes the model larger
            (change, 100.0)
        });
    }
}

#[test]
fn the_angular_momentum_is_about_a_point_of_the_model_wherever_it_lies() {
    for distance in [0.0, 1e3, 1e6] {
        let corner = [distance, -0.3 * distance];
        let (summary, _) = result(&format!(
            r#"
carom = 1
mesh.generate.b.rectangle = {{ origin = {corner:?}, size = [0.2, 0.1], elements = [2, 1] }}
material.m = {{ density = 1000.0, neo-hooke = {{ young = 1e8, poisson = 0.3 }} }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [3.0, 1.0] }}
time = {{ end = 1e-3, step = 1e-4, scheme.theta = {{}} }}
"#
        ));
        let angular = summary.momentum.angular.unwrap();
        for i in 0..2 {
            // the end of the block nearest to the origin: its first corner, and its last one where the block lies below the axis
            let far = if i == 1 && distance > 0.0 { 0.1 } else { 0.0 };
            assert!((angular.about[i] - corner[i] - far).abs() <= 4e-10);
        }
        // m (x v_y - y v_x) of the middle of 20 kg; places are known to 1e-16 of the distance
        let [x, y] = [0, 1].map(|i| corner[i] + [0.1, 0.05][i] - angular.about[i]);
        let exact = 20.0 * (x * 1.0 - y * 3.0);
        let bound = 1e-12 + 20.0 * 3.0 * 4e-16 * distance;
        assert!((angular.initial[2] - exact).abs() < bound, "{angular:?}");
        assert!(angular.relative_residual < 1e-9, "{angular:?}");
    }
}
