//! Whole runs: what the results folder says against the run itself and against exact figures.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::time::{Duration, Instant};

use carom_dynamics::{Driver, Error, Observer, StepReport, Stepper, System, march};
use carom_output::{Ending, Grade, Results, Settings, Summary};

use crate::models::{self, AREA, LENGTH, SPEED};
use crate::{grids, tables};

/// What a run told its observers.
#[derive(Default)]
pub struct Reports(pub Vec<StepReport>);

impl Observer for Reports {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        self.0.push(run.report().clone());
        Ok(())
    }

    fn finish(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        Ok(())
    }
}

/// A run with its conclusion, successful or not.
fn attempt(
    system: &Arc<System>,
    settings: Settings,
    end: f64,
) -> (
    Vec<StepReport>,
    Result<(), Error>,
    Result<Summary, carom_output::Error>,
) {
    let begin = Instant::now();
    let mut driver = Driver::new(Arc::clone(system)).unwrap();
    let mut results = Results::create(settings, Arc::clone(system)).unwrap();
    let mut reports = Reports::default();
    let outcome = march(&mut driver, end, &mut [&mut reports, &mut results], &|| {
        false
    });
    let ending = Ending {
        unfinished: outcome.as_ref().err().map(ToString::to_string),
        costs: &driver.costs(),
        zones: None,
        wall: begin.elapsed(),
    };
    (reports.0, outcome.map(|_| ()), results.conclude(&ending))
}

/// A run that comes to its end.
pub fn run(system: &Arc<System>, settings: Settings, end: f64) -> (Vec<StepReport>, Summary) {
    let (reports, outcome, summary) = attempt(system, settings, end);
    outcome.unwrap();
    (reports, summary.unwrap())
}

/// The columns of a table of numbers.
pub fn columns(path: &Path) -> BTreeMap<String, Vec<f64>> {
    let (names, rows) = tables::read(path);
    let column = |k: usize| rows.iter().map(|row| row[k].parse().unwrap()).collect();
    names
        .into_iter()
        .enumerate()
        .map(|(k, name)| (name, column(k)))
        .collect()
}

fn read_summary(folder: &Path) -> Summary {
    let text = fs::read_to_string(folder.join("summary.json")).unwrap();
    Summary::from_json(&text).unwrap()
}

/// Time and file of every entry of the collection, by part.
pub fn collection(folder: &Path) -> Vec<(f64, u32, String)> {
    let text = fs::read_to_string(folder.join("fields.pvd")).unwrap();
    let entries = text.lines().filter(|line| line.contains("<DataSet"));
    let value = |line: &str, name: &str| {
        let (_, rest) = line.split_once(&format!("{name}=\"")).unwrap();
        rest.split_once('"').unwrap().0.to_owned()
    };
    let entry = |line: &str| {
        let time = value(line, "timestep").parse().unwrap();
        (
            time,
            value(line, "part").parse().unwrap(),
            value(line, "file"),
        )
    };
    entries.map(entry).collect()
}

#[test]
fn two_bars_leave_a_row_per_step_and_figures_that_follow_from_the_rows() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("bars.carom");
    let system = models::two_bars(50);
    let (dt, end) = (system.dt, 1.5 * models::duration());
    let mut settings = models::settings(&folder);
    settings.reference = Some(models::exact(end + dt));
    settings.probes = vec![models::probe(&system, "Tip", "striker.right")];
    let (reports, summary) = run(&system, settings, end);
    assert!(
        summary.verdict.grade == Grade::Good,
        "{:?}",
        summary.verdict
    );
    assert_eq!(read_summary(&folder), summary);
    assert_eq!(
        fs::read_to_string(folder.join("case.toml")).unwrap(),
        "carom = 1\n"
    );

    let table = columns(&folder.join("histories.csv"));
    let of = |name: &str| &table[name];
    let force = of("contact.shock.force_n");
    assert_eq!(force.len() as u64, 1 + summary.time.steps);
    let told: Vec<f64> = reports
        .iter()
        .map(|report| report.contacts[0].force)
        .collect();
    assert_eq!(*force, told, "to the last bit");
    let told: Vec<f64> = reports
        .iter()
        .map(|report| report.balance.kinetic)
        .collect();
    assert_eq!(*of("energy.kinetic_j"), told);
    // the contact point is the tip of the striker
    for motion in ["displacement", "velocity", "acceleration"] {
        let starts = |start: &str| {
            let start = format!("{start}{motion}");
            let named = table.iter().find(|(name, _)| name.starts_with(&start));
            named.unwrap().1
        };
        assert_eq!(starts("probe.tip."), starts("contact.shock.secondary."));
    }

    let contact = &summary.contacts["shock"];
    let largest = force.iter().copied().fold(0.0, f64::max);
    assert_eq!(contact.peak_force, largest);
    let impulse = dt * force.iter().sum::<f64>();
    assert!((contact.impulse.unwrap() / impulse - 1.0).abs() < 1e-13);
    let closed = force.iter().filter(|force| **force > 0.0).count() as f64;
    assert!((contact.mean_force.unwrap() / (impulse / (closed * dt)) - 1.0).abs() < 1e-13);
    let steps = (contact.window / dt).round() as usize;
    assert_eq!(
        steps, 10,
        "a tenth of the way of a wave through 50 elements at CFL 1/2"
    );
    let means = force
        .windows(steps)
        .map(|w| w.iter().sum::<f64>() / steps as f64);
    let peak = means.fold(0.0, f64::max);
    assert!((contact.peak_mean_force.unwrap() / peak - 1.0).abs() < 1e-13);
    let gap = of("contact.shock.gap_m")
        .iter()
        .copied()
        .fold(0.0, f64::min);
    assert_eq!(contact.max_penetration, -gap);

    // the definition of the error in the force, on the steps that meet (0, T)
    let f0 = 0.5 * 7844.0 * models::wave_speed() * AREA * SPEED;
    let duration = models::duration();
    let inside = (1..force.len()).filter(|k| (*k as f64 - 1.0) * dt < duration * (1.0 - 1e-12));
    let (mut error, mut size) = (0.0, 0.0);
    for k in inside {
        let part = ((duration - (k as f64 - 1.0) * dt) / dt).min(1.0);
        error += (force[k] - part * f0).powi(2);
        size += (part * f0).powi(2);
    }
    let exact = summary.exact.as_ref().unwrap();
    assert!((exact.force_error.unwrap() / (error / size).sqrt() - 1.0).abs() < 1e-9);
    assert!((exact.peak_force / f0 - 1.0).abs() < 1e-12);
    assert!((exact.impulse / (f0 * duration) - 1.0).abs() < 1e-12);
    assert!((exact.overshoot.unwrap() - (largest / f0 - 1.0)).abs() < 1e-12);
    // a step keeps the overshoot of the front, the mean does not
    assert!(exact.overshoot.unwrap() > 0.1 && exact.mean_overshoot.unwrap().abs() < 0.02);
    assert!((exact.exact_restitution.unwrap() - 1.0).abs() < 1e-12);
    let mass = 7844.0 * AREA * LENGTH;
    // the striker keeps what its impulse has left it
    let separation = 2.0 * contact.impulse.unwrap() / mass - SPEED;
    assert!((exact.restitution.unwrap() - separation / SPEED).abs() < 1e-12);

    let (_, impacts) = tables::read(&folder.join("impacts.csv"));
    assert_eq!(impacts.len(), 1);
    assert_eq!(impacts[0][0], "shock");
    assert_eq!(
        impacts[0][4].parse::<f64>().unwrap(),
        contact.peak_mean_force.unwrap()
    );
    for name in ["plots/contact.svg", "plots/energy.svg", "report.html"] {
        assert!(
            fs::read_to_string(folder.join(name))
                .unwrap()
                .contains("exact")
                || name.contains("energy")
        );
        assert!(summary.outputs.iter().any(|output| output == name));
    }
}

#[test]
fn fields_of_a_block_carry_its_contact_force_and_its_motion() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("block.carom");
    let system = models::block(4, true);
    let mut settings = models::settings(&folder);
    let every = 7.3e-4;
    settings.fields = models::all_fields(every);
    let end = 5e-3;
    let (reports, summary) = run(&system, settings, end);
    assert_eq!(summary.verdict.unfinished, None);

    let entries = collection(&folder);
    let times: Vec<f64> = entries.iter().filter(|e| e.1 == 0).map(|e| e.0).collect();
    // the first step at or after each multiple, then the end
    let due = (0..=6).map(|k| (f64::from(k) * every / system.dt).ceil() * system.dt);
    let expected: Vec<f64> = due.chain([end]).collect();
    assert_eq!(times.len(), expected.len(), "{times:?}");
    for (time, expected) in times.iter().zip(&expected) {
        assert!((time - expected).abs() < 1e-12, "{times:?}");
    }

    let contact = &system.contacts[0];
    let mut in_contact = 0;
    for (time, part, file) in entries {
        let report = &reports[(time / system.dt).round() as usize];
        let (_, arrays) = grids::read(&folder.join(file));
        assert_eq!(arrays["TimeValue"].floats(), [time]);
        if part == 0 {
            assert_eq!(arrays["displacement"].attributes["NumberOfComponents"], "3");
            assert_eq!(arrays["Points"].floats().len(), 3 * 125);
            // momentum of the lumped nodes from the field of velocities
            let v = arrays["velocity"].floats();
            let masses = &system.body_masses[0];
            let momentum: f64 = masses.iter().map(|(n, m)| m * v[3 * *n as usize + 2]).sum();
            let told = report.balance.momentum.linear[2];
            assert!((momentum - told).abs() < 1e-9 * 5000.0);
            let (stress, mises) = (arrays["stress"].floats(), arrays["von_mises"].floats());
            assert_eq!((stress.len(), mises.len()), (6 * 64, 64));
            for (s, mises) in stress.chunks_exact(6).zip(mises) {
                let p = (s[0] + s[1] + s[2]) / 3.0;
                let normal = (s[0] - p).powi(2) + (s[1] - p).powi(2) + (s[2] - p).powi(2);
                let shear = s[3].powi(2) + s[4].powi(2) + s[5].powi(2);
                assert!(
                    (mises.powi(2) - 1.5 * (normal + 2.0 * shear)).abs() <= 1e-9 * mises.powi(2)
                );
            }
            continue;
        }
        assert_eq!(arrays["Points"].floats().len(), 3 * 25);
        assert_eq!(arrays["types"].integers(), [9; 16], "quadrilaterals");
        let (pressure, force) = (arrays["pressure"].floats(), arrays["force"].floats());
        let product: f64 = contact
            .points
            .iter()
            .zip(&pressure)
            .map(|(p, q)| p.area * q)
            .sum();
        let told = report.contacts[0].force;
        assert!((product - told).abs() <= 1e-12 * told);
        assert!((force.iter().sum::<f64>() - told).abs() <= 1e-12 * told);
        let signs = arrays["S_g"].integers();
        let closed = force.iter().filter(|force| **force > 0.0).count();
        assert_eq!(signs.iter().sum::<i64>() as usize, closed);
        in_contact += closed;
        // the plane is at z = 0: the gap is the height of the point
        let (x, u) = (arrays["Points"].floats(), arrays["displacement"].floats());
        for (k, gap) in arrays["gap"].floats().into_iter().enumerate() {
            assert!((x[3 * k + 2] + u[3 * k + 2] - gap).abs() < 1e-15);
        }
    }
    assert!(in_contact > 0);
}

#[test]
fn a_probe_is_the_mean_of_its_nodes_and_is_drawn_where_there_is_no_contact() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("fall.carom");
    let system = models::block(2, false);
    let mut settings = models::settings(&folder);
    settings.probes = vec![models::probe(&system, "top", "block.top")];
    let (_, summary) = run(&system, settings, 0.01);
    assert!(summary.verdict.grade == Grade::Good && summary.contacts.is_empty());
    let table = columns(&folder.join("histories.csv"));
    let (t, z) = (&table["time_s"], &table["probe.top.displacement_z_m"]);
    for (t, z) in t.iter().zip(z) {
        // free fall, which Newmark's family follows exactly
        assert!((z + 5.0 * t + 0.5 * 9.81 * t * t).abs() < 1e-14);
    }
    assert!(
        table["probe.top.acceleration_z_m_s2"]
            .iter()
            .all(|a| (a + 9.81).abs() < 1e-9)
    );
    let plot = fs::read_to_string(folder.join("plots/probe.svg")).unwrap();
    assert!(plot.contains("Displacement (mm)") && !plot.contains("Contact force"));
}

#[test]
fn an_impact_cut_by_the_end_of_the_run_is_unfinished() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("cut.carom");
    let system = models::two_bars(20);
    let (_, summary) = run(&system, models::settings(&folder), 0.5 * models::duration());
    let contact = &summary.contacts["shock"];
    assert_eq!((contact.impacts, contact.restitution), (1, None));
    assert_eq!(
        (contact.first_closing, contact.last_release),
        (Some(0.0), None)
    );
    let (names, impacts) = tables::read(&folder.join("impacts.csv"));
    let at = |name: &str| &impacts[0][names.iter().position(|n| n == name).unwrap()];
    assert!(at("duration_s").is_empty() && at("rebound_speed_m_s").is_empty());
    let impulse: f64 = at("impulse_n_s").parse().unwrap();
    assert!((impulse / contact.impulse.unwrap() - 1.0).abs() < 1e-13);
}

#[test]
fn settings_that_are_wrong_leave_no_folder() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("none.carom");
    let system = models::two_bars(4);
    let mut settings = models::settings(&folder);
    settings.probes = vec![models::probe(&system, "a", "striker.left")];
    settings.probes[0].nodes.clear();
    let error = Results::create(settings.clone(), Arc::clone(&system)).unwrap_err();
    assert_eq!(error.to_string(), "probe 'a' follows no node of a body");
    let twin = |name| models::probe(&system, name, "striker.left");
    settings.probes = vec![twin("a"), twin("A")];
    let error = Results::create(settings, system).unwrap_err();
    assert!(
        matches!(error, carom_output::Error::TwinColumns { .. }),
        "{error}"
    );
    assert!(!folder.exists());
}

#[test]
fn a_field_file_that_cannot_be_written_ends_the_run_and_the_rest_stays_readable() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("full.carom");
    let system = models::two_bars(200);
    let mut settings = models::settings(&folder);
    settings.fields = models::all_fields(5e-6);
    // a run has left the list of files; then something of the user's stands where a field file should be
    fs::create_dir(&folder).unwrap();
    fs::write(
        folder.join("files.txt"),
        "# results of carom: the files below are replaced by the next run\n",
    )
    .unwrap();
    fs::create_dir_all(folder.join("fields/bodies-000003.vtu/mine")).unwrap();
    let (reports, outcome, summary) = attempt(&system, settings, 1.5 * models::duration());
    let error = outcome.unwrap_err();
    let said = error.to_string();
    assert!(matches!(error, Error::Observer(_)), "{said}");
    assert!(
        said.starts_with("cannot write '") && said.contains("bodies-000003.vtu"),
        "{said}"
    );

    // everything else is written, and the summary names the cause
    let summary = summary.unwrap();
    assert_eq!(read_summary(&folder), summary);
    assert!(summary.verdict.grade == Grade::Bad);
    assert_eq!(summary.verdict.reasons(), [said]);
    let report = fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(report.contains("Not to be relied on") && report.contains("bodies-000003.vtu"));
    let table = columns(&folder.join("histories.csv"));
    assert_eq!(table["time_s"].len(), reports.len());
    let entries = collection(&folder);
    assert_eq!(entries.len(), 6, "three instants of bodies and contact");
    for (_, _, file) in entries {
        grids::read(&folder.join(file));
    }
}

#[test]
fn a_run_stopped_by_the_user_has_a_summary_that_says_so() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("stopped.carom");
    let system = models::two_bars(20);
    let driver = Driver::new(Arc::clone(&system)).unwrap();
    let results = Results::create(models::settings(&folder), system).unwrap();
    let ending = Ending {
        unfinished: Some("stopped by the user".to_owned()),
        costs: &driver.costs(),
        zones: None,
        wall: Duration::ZERO,
    };
    // before the first state, even
    let summary = results.conclude(&ending).unwrap();
    assert_eq!(summary.verdict.reasons(), ["stopped by the user"]);
    assert_eq!(read_summary(&folder), summary);
}

/// The other side of the next test: a run that the system refuses to hold.
#[test]
fn run_until_refused() {
    let Ok(folder) = std::env::var("CAROM_TEST_RUN") else {
        return;
    };
    let folder = Path::new(&folder);
    let system = models::two_bars(100);
    let end = 100.0 * models::duration();
    let (_, outcome, _) = attempt(&system, models::settings(folder), end);
    fs::write(folder.join("said"), outcome.unwrap_err().to_string()).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_and_what_was_written_before_is_readable() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("refused.carom");
    let status = Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 400; exec \"$0\" --exact runs::run_until_refused --quiet",
        ])
        .arg(std::env::current_exe().unwrap())
        .env("CAROM_TEST_RUN", &folder)
        .stdout(std::process::Stdio::null())
        .status()
        .unwrap();
    assert!(status.success());
    let said = fs::read_to_string(folder.join("said")).unwrap();
    assert!(
        said.starts_with("cannot write '") && said.contains("histories.csv"),
        "{said}"
    );
    let summary = read_summary(&folder);
    assert!(summary.verdict.grade == Grade::Bad && summary.verdict.unfinished == Some(said));
    let times = &columns(&folder.join("histories.csv"))["time_s"];
    assert!(times.len() > 300);
    let dt = models::two_bars(100).dt;
    assert!(
        times
            .iter()
            .enumerate()
            .all(|(k, t)| (t - k as f64 * dt).abs() <= 1e-12 * t)
    );
}
