//! What runs came to, and what is wrong with them.

use carom_output::Grade;

use super::brute::{self, Seen, Skin};
use super::run::{Energies, Outcome};
use super::scene::{Body, Fate, Pose, Scene, name};

/// Lines that tell of bodies that went through each other.
const LINES: [&str; 3] = ["surfaces", "met", "surfaces-under-force"];

/// Bound of the residual of the momentum, relative. Iterations end at 1e-10 of the forces, and the last one leaves far less than that; over a run it
/// adds up to no more than ten times as much.
const MOMENTUM: f64 = 1e-9;

/// Rounding of places that a state has and the file does not, m.
const ROUNDING: f64 = 1e-12;

/// Energy that a run may gain where nothing from outside acts, as a part of that at the start: what schemes that do not keep the energy at finite
/// strain make in so short a time, implicit and explicit. Contact only takes energy.
const GROWTH: [f64; 2] = [0.01, 0.05];

/// What the runs of some scenes came to.
#[derive(Debug, Default)]
pub struct Tally {
    /// Number of runs.
    pub runs: usize,
    /// How many cross for certain.
    pub crossed: usize,
    /// How many are apart for certain.
    pub clear: usize,
    /// What is wrong, by scene, seed, pose and step.
    pub wrong: Vec<String>,
}

impl Tally {
    /// That of both.
    pub fn add(mut self, other: Tally) -> Tally {
        self.runs += other.runs;
        self.crossed += other.crossed;
        self.clear += other.clear;
        self.wrong.extend(other.wrong);
        self
    }

    /// Takes a run, of bodies that contact has to keep apart (`are_held`) or not, and gives what is wrong with it.
    pub fn take(
        &mut self,
        (scene, pose): (&Scene, Pose),
        run: &Result<Outcome, String>,
        are_held: bool,
    ) -> Vec<String> {
        self.runs += 1;
        let outcome = match run {
            Ok(outcome) => outcome,
            Err(why) => return vec![why.clone()],
        };
        let skins = skins(scene);
        let in_parts: Vec<bool> = outcome.energies.iter().map(|now| now.in_parts).collect();
        let seen = brute::look(&skins, &outcome.states, &in_parts);
        self.crossed += usize::from(matches!(seen, Seen::Crossed(..)));
        self.clear += usize::from(seen == Seen::Clear);
        let mut wrong: Vec<String> = told(scene.fate, seen, outcome).collect();
        wrong.extend(begun(scene, &skins, outcome));
        let momentum = outcome.summary.momentum.relative_residual;
        if outcome.failed.is_none() && (momentum.is_nan() || momentum >= MOMENTUM) {
            wrong.push(format!("momentum {momentum:e}"));
        }
        if are_held {
            wrong.extend(held(seen, outcome));
            wrong.extend(grown((scene, pose), outcome));
        }
        wrong
    }
}

fn skins(scene: &Scene) -> Vec<Skin> {
    let skin = |(k, body): (usize, &Body)| match scene.folds == Some(k) {
        true => Skin::of(&body.part).folding(),
        false => Skin::of(&body.part),
    };
    let mut skins: Vec<Skin> = scene.bodies.iter().enumerate().map(skin).collect();
    skins.extend(scene.disc.map(|disc| Skin::disc(disc.radius)));
    skins
}

/// What the verdict tells that is not so, or does not tell; and where a scene is not as it is made.
fn told(fate: Fate, seen: Seen, outcome: &Outcome) -> impl Iterator<Item = String> {
    let verdict = &outcome.summary.verdict;
    let lines = LINES.iter().filter_map(|line| verdict.line(line));
    let told: Vec<&str> = lines
        .filter(|line| line.value > 0.0 && line.grade != Grade::Good)
        .map(|line| &*line.name)
        .collect();
    let silent = told.is_empty() || verdict.grade == Grade::Good;
    let wrong = match seen {
        Seen::Crossed(step, _) if silent => Some(format!("in each other at step {step}, silent")),
        // of steps in parts the brute force has not seen the parts
        Seen::Clear if !told.is_empty() && outcome.summary.time.rejected.passage == 0 => {
            Some(format!("apart, and yet {told:?}"))
        }
        _ => None,
    };
    let unlike = match (fate, seen) {
        (Fate::Crosses, Seen::Crossed(..)) | (Fate::Misses, Seen::Clear) | (Fate::Open, _) => None,
        (fate, seen) => Some(format!("{fate:?} as it is made, and yet {seen:?}")),
    };
    wrong.into_iter().chain(unlike)
}

/// What is wrong with the first state.
fn begun(scene: &Scene, skins: &[Skin], outcome: &Outcome) -> impl Iterator<Item = String> {
    let first = &outcome.states[0];
    let within = !brute::are_apart(skins, first);
    let first = scene.bodies.iter().zip(first);
    let mut nodes = first.flat_map(|(body, places)| body.part.nodes.iter().zip(places));
    let other = nodes.any(|(x, y)| (0..3).any(|i| (x[i] - y[i]).abs() > ROUNDING));
    let within = within.then(|| "in each other at the start".to_owned());
    let other = other.then(|| "nodes that are not those of the file".to_owned());
    within.into_iter().chain(other)
}

/// What is wrong where contact keeps bodies apart.
fn held(seen: Seen, outcome: &Outcome) -> impl Iterator<Item = String> {
    let time = |step: usize| outcome.energies[step].time;
    let crossed = match seen {
        Seen::Crossed(step, [one, other]) => Some(format!(
            "crossed at step {step}, {:.4e} s, {} and {}",
            time(step),
            name(one),
            name(other)
        )),
        Seen::Clear | Seen::Between => None,
    };
    let failed = outcome.failed.as_ref();
    let failed = failed.map(|why| format!("failed after step {}: {why}", outcome.states.len() - 1));
    crossed.into_iter().chain(failed)
}

/// Energy that comes from nowhere, or from contact where the scheme makes some by itself.
fn grown((scene, pose): (&Scene, Pose), outcome: &Outcome) -> Option<String> {
    let [implicit, explicit] = GROWTH;
    let bound = match pose {
        Pose::Explicit => explicit,
        Pose::Rigid | Pose::Deformable => implicit,
    };
    let first = outcome.energies.first()?;
    let part = |now: &Energies| match scene.keeps_energy() {
        true => (now.total - first.total) / first.kinetic,
        false => now.contact / first.kinetic,
    };
    let begin = outcome.energies.iter().position(|now| part(now) > bound)?;
    let most = outcome.energies.iter().map(part).fold(0.0, f64::max);
    let contact = outcome
        .energies
        .iter()
        .map(|now| now.contact / first.kinetic);
    Some(format!(
        "energy grows from step {begin}, {:.4e} s, by {:.1} %, contact gives {:.1} % at most",
        outcome.energies[begin].time,
        100.0 * most,
        100.0 * contact.fold(0.0, f64::max)
    ))
}
