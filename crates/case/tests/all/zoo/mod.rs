//! Bodies that meet do not cross, and no crossing is silent: where an independent program finds bodies in each other, the verdict tells, and where bodies stay apart it does not.
//!
//! Scenes of two bodies, or of a body and a disc, are made of seeds ([`scenes`]) and run, rigid and deformable, implicit and explicit, at two
//! steps. All accepted states are looked at by trying ([`brute`]). A crossing that is certain must stand in one of the lines [`LINES`], and the verdict
//! may not be good; where bodies are certainly apart, none of these lines may be above zero. What is between, bodies that are less than
//! the certificate's depth in each other, is left open.
//!
//! Momentum comes from the contact forces alone, in both bodies alike: it stays in all runs that come to their end.

mod brute;
mod parts;
mod scene;
mod scenes;

use std::path::Path;
use std::thread;

use carom_case::{Failed, Input, build, parse, run};
use carom_dynamics::{Error, Observer, Stepper};
use carom_output::{Grade, Summary};
use carom_testing::Random;

use self::brute::{Seen, Skin};
use self::parts::Vec3;
use self::scene::{Fate, NAMES, Pose, Scene};
use self::scenes::{CROSSINGS, JUMPS, MEETINGS, MISSES, Maker};

/// Scenes of each kind and pose.
const SEEDS: u64 = 2;

/// Lines that tell of bodies that went through each other.
const LINES: [&str; 3] = ["surfaces", "met", "surfaces-under-force"];

/// Bound of the residual of the momentum, relative. Iterations end at 1e-10 of the forces, and the last one leaves far less than that; over a run it
/// adds up to no more than ten times as much.
const MOMENTUM: f64 = 1e-9;

/// Rounding of places that a state has and the file does not, m.
const ROUNDING: f64 = 1e-12;

/// The accepted states of a run: of each the places of the nodes of both bodies, m, or of one and of the centre of the disc.
struct States<'a> {
    scene: &'a Scene,
    all: Vec<[Vec<Vec3>; 2]>,
}

impl Observer for States<'_> {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        let (system, state) = (run.system(), run.state());
        let places = system.places(state.time, &state.motion.u, &state.motion.frames);
        let mut numbers = system.number.iter();
        let mut next = |count: usize| -> Vec<Vec3> {
            let own = numbers.by_ref().take(count);
            own.map(|number| places.of(*number)).collect()
        };
        let mut nodes = self
            .scene
            .bodies
            .iter()
            .map(|body| next(body.part.nodes.len()));
        let first = nodes.next().unwrap_or_default();
        let second = match self.scene.disc {
            Some(disc) => vec![disc.centre],
            None => nodes.next().unwrap_or_default(),
        };
        self.all.push([first, second]);
        Ok(())
    }

    fn finish(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        Ok(())
    }
}

/// What a run gives.
struct Outcome {
    states: Vec<[Vec<Vec3>; 2]>,
    summary: Summary,
    is_finished: bool,
}

/// Runs a scene; one whose step fails has the verdict of the states before it.
fn run_of(scene: &Scene, step: f64, name: &str) -> Outcome {
    let folder = tempfile::tempdir().unwrap();
    let named: Vec<_> = NAMES
        .into_iter()
        .zip(scene.bodies.iter().map(|body| &body.part))
        .collect();
    let path = folder.path().join("case.toml");
    std::fs::write(folder.path().join("m.msh"), parts::gmsh(&named)).unwrap();
    std::fs::write(&path, scene.case(step)).unwrap();
    let input = Input::read(&path, &[]).unwrap();
    let (case, locator) = parse(&input).unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
    let built = build(&case, &locator, &input);
    let built = built.unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
    let mut states = States {
        scene,
        all: Vec::new(),
    };
    let results = folder.path().join("results");
    let finished = run(
        (&input, &case, &built),
        results.clone(),
        &mut states,
        &|| false,
    );
    let (summary, is_finished) = match finished {
        Ok(finished) => (finished.summary, true),
        Err(Failed::Step(_)) => (written(&results), false),
        Err(other) => panic!("{name}: {other}"),
    };
    Outcome {
        states: states.all,
        summary,
        is_finished,
    }
}

/// The summary that a run left behind.
fn written(results: &Path) -> Summary {
    let text = std::fs::read_to_string(results.join("summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// What the runs of some scenes came to.
#[derive(Debug, Default)]
struct Tally {
    runs: usize,
    crossed: usize,
    clear: usize,
    /// What is wrong, by scene, seed, pose and step.
    wrong: Vec<String>,
}

impl Tally {
    fn add(mut self, other: Tally) -> Tally {
        self.runs += other.runs;
        self.crossed += other.crossed;
        self.clear += other.clear;
        self.wrong.extend(other.wrong);
        self
    }

    /// Takes a run.
    fn take(&mut self, scene: &Scene, outcome: &Outcome, name: &str) {
        let mut skins: Vec<Skin> = scene
            .bodies
            .iter()
            .map(|body| Skin::of(&body.part))
            .collect();
        skins.extend(scene.disc.map(|disc| Skin::disc(disc.radius)));
        let skins = [&skins[0], &skins[1]];
        let seen = brute::look(skins, &outcome.states);
        self.runs += 1;
        self.crossed += usize::from(matches!(seen, Seen::Crossed(_)));
        self.clear += usize::from(seen == Seen::Clear);
        let verdict = &outcome.summary.verdict;
        let lines = LINES.iter().filter_map(|line| verdict.line(line));
        let told: Vec<&str> = lines
            .filter(|line| line.value > 0.0 && line.grade != Grade::Good)
            .map(|line| &*line.name)
            .collect();
        let silent = told.is_empty() || verdict.grade == Grade::Good;
        let mut wrong = |what: String| self.wrong.push(format!("{name}: {what}"));
        match seen {
            Seen::Crossed(step) if silent => wrong(format!("in each other at step {step}, silent")),
            // of steps in parts the brute force has not seen the parts
            Seen::Clear if !told.is_empty() && outcome.summary.time.rejected.passage == 0 => {
                wrong(format!("apart, and yet {told:?}"))
            }
            _ => {}
        }
        match (scene.fate, seen) {
            (Fate::Crosses, Seen::Crossed(_)) | (Fate::Misses, Seen::Clear) | (Fate::Open, _) => {}
            (fate, seen) => wrong(format!("{fate:?} as it is made, and yet {seen:?}")),
        }
        if !brute::are_apart(skins, &outcome.states[0]) {
            wrong("in each other at the start".to_owned());
        }
        let first = scene.bodies.iter().zip(&outcome.states[0]);
        let mut nodes = first.flat_map(|(body, places)| body.part.nodes.iter().zip(places));
        if nodes.any(|(x, y)| (0..3).any(|i| (x[i] - y[i]).abs() > ROUNDING)) {
            wrong("nodes that are not those of the file".to_owned());
        }
        let momentum = outcome.summary.momentum.relative_residual;
        if outcome.is_finished && (momentum.is_nan() || momentum >= MOMENTUM) {
            wrong(format!("momentum {momentum:e}"));
        }
    }
}

/// Runs all scenes of a kind.
fn of_kind(make: Maker, first: u64) -> Tally {
    let mut tally = Tally::default();
    for seed in first..first + SEEDS {
        let implicit = match seed == first {
            true => Pose::Rigid,
            false => Pose::Deformable,
        };
        for pose in [implicit, Pose::Explicit] {
            let scene = make(&mut Random(seed), pose);
            for step in scene.steps {
                let name = format!("{} (seed {seed}, {pose:?}, step {step} s)", scene.name);
                let outcome = run_of(&scene, step, &name);
                tally.take(&scene, &outcome, &name);
            }
        }
    }
    tally
}

/// Runs all scenes of some kinds. Each kind has a thread: most of the time of so small a run goes by until its files are on the disk.
fn of_kinds(makers: &[Maker], first: u64) -> Tally {
    thread::scope(|scope| {
        let threads: Vec<_> = makers
            .iter()
            .zip((first..).step_by(100))
            .map(|(make, first)| scope.spawn(move || of_kind(*make, first)))
            .collect();
        let tallies = threads.into_iter().map(|thread| thread.join().unwrap());
        tallies.fold(Tally::default(), Tally::add)
    })
}

/// Runs scenes and asserts that nothing is wrong with them.
#[track_caller]
fn right(makers: &[Maker], first: u64) -> Tally {
    let tally = of_kinds(makers, first);
    let wrong = &tally.wrong;
    assert!(
        wrong.is_empty(),
        "{} of {} runs:\n{}",
        wrong.len(),
        tally.runs,
        wrong.join("\n")
    );
    // two poses of each seed, at two steps
    assert_eq!(tally.runs, makers.len() * SEEDS as usize * 4);
    tally
}

/// Corners, edges, tips, rods and discs that meet between nodes touch: nothing goes through.
#[test]
fn what_meets_does_not_cross() {
    let tally = right(&MEETINGS, 1000);
    assert_eq!(tally.crossed, 0, "of {} runs", tally.runs);
}

/// What a step carries to the other side is stopped or told.
#[test]
fn what_jumps_is_told_where_it_goes_through() {
    right(&JUMPS, 2200);
}

/// Nothing is between these bodies, or they pass within a step: all of them cross, and the brute force finds it.
#[test]
fn what_goes_through_by_construction_is_told() {
    let tally = right(&CROSSINGS, 5000);
    assert_eq!(tally.crossed, tally.runs);
}

#[test]
fn what_passes_by_is_not_told() {
    let tally = right(&MISSES, 9000);
    assert_eq!(tally.clear, tally.runs);
}
