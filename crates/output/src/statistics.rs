//! Statistics of impacts: what the impacts of a contact, or of all contacts of a level, come to over a run.

use carom_bodies::Body;
use carom_contact::Law;
use carom_dynamics::{Impact, System};
use serde::{Deserialize, Serialize};

/// Classes of a histogram.
const CLASSES: usize = 10;
/// Strongest impacts that are listed.
const WORST: usize = 5;

/// The impacts of one contact or of a level.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// Number of impacts, one that goes on at the end included.
    pub count: usize,
    /// Largest force of a single contact, N.
    pub peak_force: f64,
    /// Mean of the largest forces of the impacts, N.
    pub mean_peak_force: f64,
    /// Impulse over duration, both summed over the impacts, N.
    pub mean_force: f64,
    /// Sum of the impulses, N s.
    pub impulse: f64,
    /// Largest impulse of an impact, N s.
    pub largest_impulse: f64,
    /// Sum of the durations, s.
    pub duration: f64,
    /// Longest impact, s.
    pub longest: f64,
    /// Largest energy that a contact took up in an impact, J ([`Impact::energy_taken`]).
    pub energy_taken: f64,
    /// Sum of these energies, J.
    pub energy_taken_sum: f64,
    /// Energy lost in the impacts, J.
    pub energy_lost: f64,
    /// Energy that friction took, J.
    pub friction_loss: f64,
    /// Impacts by their largest force, N.
    pub force_classes: Histogram,
    /// Impacts by the energy taken up, J.
    pub energy_classes: Histogram,
    /// The strongest impacts, by their largest force.
    pub worst: Vec<Worst>,
}

/// Numbers of impacts in classes of equal width.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Histogram {
    /// Width of a class: class k goes from k to k + 1 widths, the last one includes its end.
    pub width: f64,
    /// Impacts in each class.
    pub counts: Vec<u64>,
}

/// A strong impact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// Name of the contact.
    pub contact: String,
    /// Time of the largest force, s.
    pub time: f64,
    /// Largest force, N.
    pub peak_force: f64,
    /// Steps of the closed interval in which it is.
    #[serde(default)]
    pub peak_steps: u64,
    /// Impulse, N s.
    pub impulse: f64,
    /// Duration, s.
    pub duration: f64,
    /// Energy taken up, J.
    pub energy_taken: f64,
    /// Energy that friction took, J.
    #[serde(default)]
    pub friction_loss: f64,
}

/// What contacts of a level may bear in one impact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Allowable {
    /// Force, N.
    pub force: Option<f64>,
    /// Energy taken up, J.
    pub energy: Option<f64>,
    /// Penetration, of a stop its stroke, over the run, m.
    pub stroke: Option<f64>,
    /// Crush that stays, m.
    pub crush: Option<f64>,
}

/// How deep a contact went over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Depth {
    /// The contact.
    pub contact: usize,
    /// Largest penetration, m.
    pub stroke: f64,
    /// Largest crush of a point that stays, m.
    pub crush: f64,
    /// When its force was largest, s.
    pub time: f64,
}

/// A level of contacts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// Names of its contacts.
    pub contacts: Vec<String>,
    /// Their impacts.
    pub statistics: Statistics,
    /// Against the allowable force, N; `None` without one.
    pub force_margin: Option<Margin>,
    /// Against the allowable energy of an impact, J; `None` without one.
    pub energy_margin: Option<Margin>,
    /// Of the largest penetration against the allowable stroke, m; `None` without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stroke_margin: Option<Margin>,
    /// Of the crush that stays against the allowable one, m; `None` without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crush_margin: Option<Margin>,
}

/// A largest value against what is allowed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Margin {
    /// What is allowed.
    pub allowable: f64,
    /// What was found.
    pub found: f64,
    /// Allowable over found, less one: negative where it is exceeded. `None` where nothing was found.
    pub margin: Option<f64>,
    /// What has the largest value, and when, s: of an impact its start, of a stroke or a crush the largest force of the contact.
    pub governing: Option<(String, f64)>,
}

/// A largest value of the run against what is allowed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// What is compared: `von Mises stress`.
    pub quantity: String,
    /// Of what: `body`, `support`, `spring` or `pretension`.
    pub kind: String,
    /// Its name in the case.
    pub name: String,
    /// Unit of the values.
    pub unit: String,
    /// The values. The governing one is what it is of; a plastic strain is that of the kept instants ([`crate::maxima::Maxima`]).
    pub margin: Margin,
}

impl Margin {
    /// Of a largest value, with what it is of and when; `None` where nothing was found.
    pub(crate) fn of(allowable: f64, found: Option<(f64, (String, f64))>) -> Margin {
        let found = found.filter(|(value, _)| *value > 0.0);
        let value = found.as_ref().map(|(value, _)| *value);
        Margin {
            allowable,
            found: value.unwrap_or(0.0),
            margin: value.map(|value| allowable / value - 1.0),
            governing: found.map(|(_, governing)| governing),
        }
    }
}

impl Statistics {
    /// Those of some impacts; `name`: of a contact by its index; `friction_loss` in J.
    pub fn of<'a>(
        impacts: &[&Impact],
        name: impl Fn(usize) -> &'a str,
        friction_loss: f64,
    ) -> Statistics {
        let sum =
            |value: fn(&Impact) -> f64| impacts.iter().map(|i| value(i)).fold(0.0, |a, b| a + b);
        let most = |value: fn(&Impact) -> f64| impacts.iter().map(|i| value(i)).fold(0.0, f64::max);
        let classes = |value: fn(&Impact) -> f64| {
            Histogram::of(impacts.iter().map(|i| value(i)), most(value))
        };
        let over = |value: f64, by: f64| if by > 0.0 { value / by } else { 0.0 };
        let mut order: Vec<&Impact> = impacts.to_vec();
        order.sort_by(|a, b| b.peak_force.total_cmp(&a.peak_force));
        let worst = |impact: &&Impact| Worst {
            contact: name(impact.contact as usize).to_owned(),
            time: impact.peak_time,
            peak_force: impact.peak_force,
            peak_steps: impact.peak_steps,
            impulse: impact.impulse,
            duration: impact.duration,
            energy_taken: impact.energy_taken,
            friction_loss: impact.friction_loss,
        };
        Statistics {
            count: impacts.len(),
            peak_force: most(|i| i.peak_force),
            mean_peak_force: over(sum(|i| i.peak_force), impacts.len() as f64),
            mean_force: over(sum(|i| i.impulse), sum(|i| i.duration)),
            impulse: sum(|i| i.impulse),
            largest_impulse: most(|i| i.impulse),
            duration: sum(|i| i.duration),
            longest: most(|i| i.duration),
            energy_taken: most(|i| i.energy_taken),
            energy_taken_sum: sum(|i| i.energy_taken),
            energy_lost: sum(|i| i.energy_lost),
            friction_loss,
            force_classes: classes(|i| i.peak_force),
            energy_classes: classes(|i| i.energy_taken),
            worst: order.iter().take(WORST).map(worst).collect(),
        }
    }
}

impl Histogram {
    fn of(values: impl Iterator<Item = f64>, largest: f64) -> Histogram {
        if largest <= 0.0 {
            return Histogram::default();
        }
        let width = largest / CLASSES as f64;
        let mut counts = vec![0; CLASSES];
        for value in values {
            counts[((value / width) as usize).min(CLASSES - 1)] += 1;
        }
        Histogram { width, counts }
    }
}

/// Whether a contact takes up energy, by its law: the exact laws take none of bodies that deform, whose loss where they touch is that of mesh
/// and step. Between bodies that cannot deform the velocity law is an impact without restitution.
pub fn takes_energy(system: &System, contact: usize) -> bool {
    let is_stiff = |body: &Body| body.as_rigid().is_some() || body.as_discrete().is_some();
    let mut bodies = system.contacts[contact].bodies.iter();
    match &system.contacts[contact].law {
        Law::Displacement(_) => false,
        Law::Velocity(_) => bodies.all(|body| is_stiff(&system.bodies[*body])),
        Law::Restitution(law) => law.coefficient < 1.0,
        // a spring or a damper of its own
        _ => true,
    }
}

impl Level {
    /// The level of these contacts. `impacts`, `depths`: theirs; `takes`: whether a contact takes up energy ([`takes_energy`]).
    pub fn of<'a>(
        contacts: &[usize],
        (impacts, depths): (&[&Impact], &[Depth]),
        name: impl Fn(usize) -> &'a str + Copy,
        (friction_loss, allowable): (f64, Allowable),
        takes: impl Fn(usize) -> bool,
    ) -> Level {
        let taking = impacts.iter().filter(|i| takes(i.contact as usize));
        let taking: Vec<&Impact> = taking.copied().collect();
        let margin = |allowed: Option<f64>, judged: &[&Impact], value: fn(&Impact) -> f64| {
            let order = |a: &&&Impact, b: &&&Impact| value(a).total_cmp(&value(b));
            let governing = judged.iter().filter(|i| value(i) > 0.0).max_by(order);
            let told = |impact: &&Impact| {
                let name = name(impact.contact as usize).to_owned();
                (value(impact), (name, impact.start))
            };
            Some(Margin::of(allowed?, governing.map(told)))
        };
        let deepest = |allowed: Option<f64>, value: fn(&Depth) -> f64| {
            let order = |a: &&Depth, b: &&Depth| value(a).total_cmp(&value(b));
            let told = |depth: &Depth| (value(depth), (name(depth.contact).to_owned(), depth.time));
            Some(Margin::of(allowed?, depths.iter().max_by(order).map(told)))
        };
        Level {
            contacts: contacts.iter().map(|k| name(*k).to_owned()).collect(),
            statistics: Statistics::of(impacts, name, friction_loss),
            force_margin: margin(allowable.force, impacts, |i| i.peak_force),
            energy_margin: margin(allowable.energy, &taking, |i| i.energy_taken),
            stroke_margin: deepest(allowable.stroke, |d| d.stroke),
            crush_margin: deepest(allowable.crush, |d| d.crush),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn impact(contact: u32, force: f64, energy: f64) -> Impact {
        Impact {
            contact,
            peak_force: force,
            peak_time: 10.0 * force,
            energy_taken: energy,
            impulse: 0.1 * force,
            duration: 0.5,
            ..Impact::default()
        }
    }

    #[test]
    fn sums_means_classes_and_margins_are_those_of_the_impacts() {
        let all = [
            impact(0, 1.0, 0.5),
            impact(1, 4.0, 0.1),
            impact(0, 2.0, 0.0),
        ];
        let impacts: Vec<&Impact> = all.iter().collect();
        let name = |k: usize| ["a", "b"][k];
        let allowable = Allowable {
            force: Some(5.0),
            energy: Some(0.4),
            stroke: Some(2e-3),
            crush: Some(1e-3),
        };
        let depth = |contact, stroke, crush| Depth {
            contact,
            stroke,
            crush,
            time: 7.0,
        };
        let depths = [depth(0, 1e-3, 0.0), depth(1, 4e-3, 5e-4)];
        let of_both = (&impacts[..], &depths[..]);
        let level = Level::of(&[0, 1], of_both, name, (3.0, allowable), |_| true);
        let found = &level.statistics;
        assert_eq!(
            (found.count, found.peak_force, found.energy_taken),
            (3, 4.0, 0.5)
        );
        assert!((found.mean_peak_force - 7.0 / 3.0).abs() < 1e-15);
        assert!((found.mean_force - 0.7 / 1.5).abs() < 1e-15);
        assert_eq!(found.force_classes.counts, [0, 0, 1, 0, 0, 1, 0, 0, 0, 1]);
        assert_eq!(found.force_classes.counts.iter().sum::<u64>(), 3);
        assert_eq!(found.worst[0].contact, "b");
        assert_eq!(found.worst[0].time, 40.0);
        let force = level.force_margin.unwrap();
        assert!((force.margin.unwrap() - 0.25).abs() < 1e-15);
        let energy = level.energy_margin.unwrap();
        assert!((energy.margin.unwrap() + 0.2).abs() < 1e-15);
        assert_eq!(energy.governing.unwrap().0, "a");
        let stroke = level.stroke_margin.unwrap();
        assert!((stroke.margin.unwrap() + 0.5).abs() < 1e-15);
        assert_eq!(stroke.governing.unwrap(), ("b".to_owned(), 7.0));
        assert!((level.crush_margin.unwrap().margin.unwrap() - 1.0).abs() < 1e-15);
        // of contacts that take up no energy there is no margin of it
        let judged = |takes: fn(usize) -> bool| {
            let level = Level::of(&[0, 1], of_both, name, (3.0, allowable), takes);
            level.energy_margin.unwrap()
        };
        assert_eq!(judged(|k| k == 1).found, 0.1);
        assert_eq!(judged(|_| false).margin, None);
    }

    #[test]
    fn without_impacts_there_is_nothing_and_no_margin() {
        let allowable = Allowable {
            force: Some(5.0),
            ..Allowable::default()
        };
        let level = Level::of(&[0], (&[], &[]), |_| "a", (0.0, allowable), |_| true);
        assert_eq!(level.statistics.count, 0);
        assert_eq!(level.force_margin.unwrap().margin, None);
        assert_eq!(level.energy_margin, None);
        assert!(level.statistics.force_classes.counts.is_empty());
    }
}
