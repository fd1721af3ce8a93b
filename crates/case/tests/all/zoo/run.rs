//! A run of a scene, with all that is seen of it.

use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};

use carom_case::{Failed, Input, build, parse, run};
use carom_dynamics::{Error, Observer, StepReport, Stepper};
use carom_output::Summary;

use super::parts::{self, Vec3};
use super::scene::{self, Scene, Step};

/// The accepted states of a run: of each the places of the nodes of all bodies, m, and of the centre of the disc.
struct States<'a> {
    scene: &'a Scene,
    all: Vec<Vec<Vec<Vec3>>>,
    energies: Vec<Energies>,
}

/// Energies after a step, J.
#[derive(Clone, Copy, Debug)]
pub struct Energies {
    /// Time, s.
    pub time: f64,
    /// Kinetic energy.
    pub kinetic: f64,
    /// All energy that the scheme balances.
    pub total: f64,
    /// Work of the contacts so far.
    pub contact: f64,
    /// Whether the step was taken in parts, or cut: nobody knows the way between its ends then.
    pub in_parts: bool,
}

impl Energies {
    fn of(time: f64, report: &StepReport) -> Energies {
        let balance = &report.balance;
        Energies {
            time,
            in_parts: report.attempts > 1,
            kinetic: balance.kinetic,
            total: balance.kinetic + balance.strain + balance.scheme_energy,
            contact: balance.work_contact,
        }
    }
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
        let bodies = self.scene.bodies.iter();
        let mut nodes: Vec<_> = bodies.map(|body| next(body.part.nodes.len())).collect();
        nodes.extend(self.scene.disc.map(|disc| vec![disc.centre]));
        self.all.push(nodes);
        self.energies.push(Energies::of(state.time, run.report()));
        Ok(())
    }

    fn finish(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        Ok(())
    }
}

/// What a run gives.
pub struct Outcome {
    /// Of each accepted state the places of the nodes of all bodies, and of the disc, m.
    pub states: Vec<Vec<Vec<Vec3>>>,
    /// The energies of these states.
    pub energies: Vec<Energies>,
    /// What was written.
    pub summary: Summary,
    /// Why a step failed.
    pub failed: Option<String>,
}

/// Writes the mesh and the case file of a scene to a folder, and gives the path of the latter.
pub fn write(scene: &Scene, step: Step, folder: &Path) -> PathBuf {
    let names: Vec<String> = (0..scene.bodies.len()).map(scene::name).collect();
    let bodies = scene.bodies.iter().map(|body| &body.part);
    let named: Vec<_> = names.iter().map(|name| &**name).zip(bodies).collect();
    let path = folder.join("case.toml");
    std::fs::write(folder.join("m.msh"), parts::gmsh(&named)).unwrap();
    std::fs::write(&path, scene.case(step)).unwrap();
    path
}

/// Runs a scene; one whose step fails has the verdict of the states before it.
///
/// # Errors
/// Why there is no run: the case is refused, or the program panics.
pub fn run_of(scene: &Scene, step: Step) -> Result<Outcome, String> {
    let caught = panic::catch_unwind(AssertUnwindSafe(|| tried(scene, step)));
    caught.unwrap_or_else(|payload| {
        let text = payload.downcast_ref::<String>().cloned();
        let text = text.or(payload
            .downcast_ref::<&str>()
            .map(|text| (*text).to_owned()));
        Err(format!("it panics: {}", text.unwrap_or_default()))
    })
}

fn tried(scene: &Scene, step: Step) -> Result<Outcome, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = write(scene, step, folder.path());
    let input = Input::read(&path, &[]).unwrap();
    let refused = |problems: &dyn std::fmt::Debug| format!("it is refused: {problems:?}");
    let (case, locator) = parse(&input).map_err(|problems| refused(&problems))?;
    let built = build(&case, &locator, &input).map_err(|problems| refused(&problems))?;
    let mut states = States {
        scene,
        all: Vec::new(),
        energies: Vec::new(),
    };
    let results = folder.path().join("results");
    let finished = run(
        (&input, &case, &built),
        results.clone(),
        &mut states,
        &|| false,
    );
    let (summary, failed) = match finished {
        Ok(finished) => (finished.summary, None),
        Err(Failed::Step(error)) => (written(&results), Some(error.to_string())),
        Err(other) => return Err(refused(&other.to_string())),
    };
    Ok(Outcome {
        states: states.all,
        energies: states.energies,
        summary,
        failed,
    })
}

/// The summary that a run left behind.
fn written(results: &Path) -> Summary {
    let text = std::fs::read_to_string(results.join("summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}
