//! Bodies that meet do not cross, and no crossing is silent: where an independent program finds bodies in each other, the verdict tells, and where bodies stay apart it does not.
//!
//! Scenes of bodies, or of a body and a disc, are made of seeds ([`scenes`], [`hollows`], [`crowds`], [`sections`]) and run, rigid and deformable, implicit
//! and explicit, at three steps. All accepted states are looked at by trying ([`brute`]). A crossing that is certain must stand in one of the lines that
//! tell of crossings, and the verdict may not be good; where bodies are certainly apart, none of these lines may be above zero. What is between, bodies
//! that are less than the certificate's depth in each other, is left open.
//!
//! Momentum comes from the contact forces alone, in all bodies alike: it stays in all runs that come to their end. Contact makes no energy.
//!
//! `CAROM_ZOO_SEEDS=8` makes more scenes of each kind, and runs those too that are known to go wrong ([`OPEN`]); `CAROM_ZOO_KEEP=folder` keeps the case
//! files of runs with which something is wrong.

mod brute;
mod crowds;
mod hollows;
mod parts;
mod run;
mod scene;
mod scenes;
mod sections;
mod shapes;
mod tally;

use std::path::Path;
use std::thread;

use carom_testing::Random;

use self::run::Outcome;
use self::scene::{Pose, Scene, Step};
use self::scenes::{CROSSINGS, FEW, IMPLICIT, JUMPS, MEETINGS, MISSES, Maker, OPEN};
use self::tally::Tally;

/// Scenes of each kind and pose.
const SEEDS: u64 = 2;

/// Kinds that are run alike.
#[derive(Clone, Copy)]
struct Group {
    makers: &'static [Maker],
    /// Whether contact has to keep the bodies apart.
    are_held: bool,
    /// The first seed of the first kind; those of the next kind are a hundred further.
    first: u64,
    /// Scenes of each kind and pose.
    seeds: u64,
}

impl Group {
    /// With as many seeds as are asked for.
    fn new(makers: &'static [Maker], are_held: bool, first: u64) -> Group {
        Group {
            makers,
            are_held,
            first,
            seeds: asked().unwrap_or(SEEDS),
        }
    }

    /// With the first seeds alone, whatever is asked for.
    fn with_few(self) -> Group {
        Group {
            seeds: SEEDS,
            ..self
        }
    }
}

/// The number of scenes of each kind that is asked for, if it is.
fn asked() -> Option<u64> {
    let seeds = std::env::var("CAROM_ZOO_SEEDS").ok()?;
    Some(seeds.parse().unwrap())
}

/// Keeps the case of a run with what is wrong with it, where that is asked for.
fn keep(scene: &Scene, step: Step, (folder, wrong): (&str, &[String])) {
    let Ok(root) = std::env::var("CAROM_ZOO_KEEP") else {
        return;
    };
    let folder = Path::new(&root).join(folder);
    std::fs::create_dir_all(&folder).unwrap();
    run::write(scene, step, &folder);
    std::fs::write(folder.join("wrong.txt"), wrong.join("\n") + "\n").unwrap();
}

/// Runs a scene of a seed in a pose.
fn of_seed((make, are_held): (Maker, bool), seed: u64, pose: Pose) -> Tally {
    let mut tally = Tally::default();
    let scene = make(&mut Random(seed), pose);
    if scene.is_refused {
        return tally;
    }
    for step in scene.steps() {
        let run: Result<Outcome, String> = run::run_of(&scene, step);
        let wrong = tally.take((&scene, pose), &run, are_held);
        if !wrong.is_empty() {
            let words = format!("{} seed{seed} {pose:?} {step}", scene.name);
            let folder: String = words
                .replace(['{', '}', '='], "")
                .split_whitespace()
                .collect::<Vec<_>>()
                .join("-");
            keep(&scene, step, (&folder, &wrong));
        }
        let name = format!("{} (seed {seed}, {pose:?}, step {step})", scene.name);
        let named = wrong.into_iter().map(|what| format!("{name}: {what}"));
        tally.wrong.extend(named);
    }
    tally
}

/// Runs all scenes of a kind of a group.
fn of_kind(group: Group, make: Maker, first: u64) -> Tally {
    let mut tally = Tally::default();
    for seed in 0..group.seeds {
        let implicit = match seed % 2 {
            0 => Pose::Rigid,
            _ => Pose::Deformable,
        };
        for pose in [implicit, Pose::Explicit] {
            tally = tally.add(of_seed((make, group.are_held), first + seed, pose));
        }
    }
    tally
}

/// Runs all scenes of a group. Each kind has a thread: most of the time of so small a run goes by until its files are on the disk.
fn of_group(group: Group) -> Tally {
    thread::scope(|scope| {
        let threads: Vec<_> = group
            .makers
            .iter()
            .zip((group.first..).step_by(100))
            .map(|(make, first)| scope.spawn(move || of_kind(group, *make, first)))
            .collect();
        let tallies = threads.into_iter().map(|thread| thread.join().unwrap());
        tallies.fold(Tally::default(), Tally::add)
    })
}

/// Runs a group and asserts that nothing is wrong with it; `each`: runs of a seed of a kind.
#[track_caller]
fn right(group: Group, each: usize) -> Tally {
    let tally = of_group(group);
    let wrong = &tally.wrong;
    assert!(
        wrong.is_empty(),
        "{} of {} runs:\n{}",
        wrong.len(),
        tally.runs,
        wrong.join("\n")
    );
    assert_eq!(tally.runs, group.makers.len() * group.seeds as usize * each);
    tally
}

/// Corners, edges, tips, rods and discs that meet between nodes touch: nothing goes through.
#[test]
fn what_meets_does_not_cross() {
    let tally = right(Group::new(MEETINGS, true, 1000), 6);
    assert_eq!(tally.crossed, 0, "of {} runs", tally.runs);
}

#[test]
fn what_meets_with_the_first_seeds_does_not_cross() {
    let tally = right(Group::new(FEW, true, 1400).with_few(), 6);
    assert_eq!(tally.crossed, 0, "of {} runs", tally.runs);
}

/// Where the program takes the bodies in implicit steps alone.
#[test]
fn what_meets_in_implicit_steps_does_not_cross() {
    let tally = right(Group::new(IMPLICIT, true, 20_000), 3);
    assert_eq!(tally.crossed, 0, "of {} runs", tally.runs);
}

/// Kinds with which something is known to be wrong.
#[test]
fn what_is_open() {
    if asked().is_some() {
        let tally = of_group(Group::new(OPEN, true, 30_000));
        assert!(
            tally.wrong.is_empty(),
            "{} runs:\n{}",
            tally.runs,
            tally.wrong.join("\n")
        );
    }
}

/// What a step carries to the other side is stopped or told.
#[test]
fn what_jumps_is_told_where_it_goes_through() {
    right(Group::new(&JUMPS, false, 2200), 6);
}

/// Nothing is between these bodies, or they pass within a step: all of them cross, and the brute force finds it. With other seeds a cell is inside out
/// after the first of such long steps, and the run ends.
#[test]
fn what_goes_through_by_construction_is_told() {
    let tally = right(Group::new(&CROSSINGS, false, 5000).with_few(), 4);
    assert_eq!(tally.crossed, tally.runs);
}

#[test]
fn what_passes_by_is_not_told() {
    let tally = right(Group::new(&MISSES, false, 9000), 4);
    assert_eq!(tally.clear, tally.runs);
}
