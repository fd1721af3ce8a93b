//! Runs that somebody ends within a step: the step leaves nothing behind, and the run goes on with the bytes of one that was not ended.

use std::fs;

use carom_case::{Input, build, parse};
use carom_dynamics::{Error, Interrupt, Observer, Stepper};

use crate::resume::{cases, content, open, run, words};
use carom_dynamics::Silent;

/// Asks for the end once so many steps are taken: the next one has begun when it is looked at.
struct Ends {
    after: u64,
    interrupt: Interrupt,
}

impl Observer for Ends {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        if run.state().step == self.after {
            self.interrupt.set();
        }
        Ok(())
    }

    fn finish(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        Ok(())
    }

    fn interrupt(&self) -> Option<&Interrupt> {
        Some(&self.interrupt)
    }
}

/// Ends a run within a step and goes on with it.
fn ended_within_a_step(name: &str, overrides: &[&str], after: u64) {
    let input = Input::read(&cases().join(name).join("case.toml"), &words(overrides)).unwrap();
    let work = tempfile::tempdir().unwrap();
    let [whole, cut] = ["whole", "cut"].map(|folder| work.path().join(folder));
    assert!(run(&input, &whole, u64::MAX));
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    let mut ends = Ends {
        after,
        interrupt: Interrupt::default(),
    };
    // nobody asks between two steps
    let parts = (&input, &case, &built);
    let finished = carom_case::run(parts, cut.clone(), &mut ends, &|| false).unwrap();
    assert!(finished.interrupted, "{name}");
    let of_problems = |name: &str| name.starts_with("interface-");
    let files = fs::read_dir(&cut).unwrap().map(Result::unwrap);
    let mut names = files.map(|file| file.file_name().into_string().unwrap());
    assert!(
        !names.any(|name| of_problems(&name)),
        "{name}: no problem failed"
    );
    let resume = open(&cut, &[]);
    assert_eq!(resume.instant().0, after, "{name}");
    resume.run(&mut Silent, &|| false).unwrap();
    let [whole, cut] = [&whole, &cut].map(|folder| content(folder));
    for (file, bytes) in &whole {
        assert!(cut[file] == *bytes, "{name}: {file} differs");
    }
}

#[test]
fn a_step_that_is_ended_leaves_nothing_behind() {
    // one step of linear bodies, with iterations and friction, in zones of unequal steps, cut at closings, explicit
    ended_within_a_step("two-bars", &[], 30);
    ended_within_a_step("conveyor", &["time.end=\"30 ms\""], 9);
    ended_within_a_step("arlequin-bars", &["time.end=\"2 ms\""], 30);
    let adaptive = "time.step={ adaptive = { largest = \"1 us\", smallest = \"10 ns\" } }";
    ended_within_a_step("two-bars", &[adaptive], 30);
    ended_within_a_step("two-bars", &["time.scheme={ central-difference = {} }"], 30);
}

#[test]
fn halves_of_a_step_that_is_ended_are_taken_back() {
    // so few iterations find no equilibrium: steps go in halves of halves, and none of them stays
    let few = "time.newton={ passes = 3 }";
    ended_within_a_step("conveyor", &["time.end=\"12 ms\"", few], 9);
}
