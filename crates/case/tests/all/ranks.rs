//! Runs on several ranks, here threads that send each other messages as processes do: the results of one process, and its folder.

use std::cell::Cell;
use std::path::Path;

use carom_case::schema::Case;
use carom_case::{
    Built, Failed, Finished, Input, Locator, Resume, build, model, parse, run, run_on_ranks,
    whole_on_ranks,
};
use carom_dynamics::{ContactRecord, Driver, State, Watched};
use carom_output::checkpoint;
use carom_ranks::{Ranks, threads};

use carom_dynamics::Silent;

/// Two bars, one faster than the other.
const BARS: &str = r#"
carom = 1
[mesh]
generate.striker.line = { from = [-0.2], to = [0.0], elements = 40 }
generate.target.line = { from = [0.0], to = [0.2], elements = 40 }
[material.steel]
density = 7800.0
elastic = { young = "210 GPa", poisson = 0.0 }
[body.striker]
region = "striker"
material = "steel"
section.bar = { area = "100 mm^2" }
initial = { velocity = [5.0] }
[body.target]
region = "target"
material = "steel"
section.bar = { area = "100 mm^2" }
[contact.shock]
secondary = "striker.right"
primary = "target.left"
law.velocity = {}
[time]
end = "100 us"
step = { courant = 0.5 }
scheme.central-difference = {}
[probe.tip]
on = "target.right"
record = ["displacement", "velocity"]
"#;

/// A block that falls on a plane and tilts. The law of the material is added.
const BLOCK: &str = r#"
carom = 1
[mesh]
generate.block.box = { origin = [0.0, 0.0, 0.002], size = [0.1, 0.08, 0.12], elements = [5, 4, 6] }
[material.soft]
density = 1000.0
MATERIAL
[body.block]
region = "block"
material = "soft"
initial = { velocity = [0.3, 0.0, -5.0] }
[contact.ground]
secondary = "block.bottom"
obstacle.plane = { point = [0.0, 0.0, 0.0], normal = [0.1, 0.0, 1.0] }
law.velocity = {}
[time]
end = "1.5 ms"
step = { critical = 0.2 }
scheme.central-difference = {}
[load.weight]
acceleration = [0.0, 0.0, -9.81]
[probe.top]
on = "block.top"
record = ["displacement", "velocity"]
[output]
fields = { every = "0.3 ms", record = ["displacement", "stress"] }
"#;

/// Two rectangles of which one falls on the other, which a support holds.
const PAIR: &str = r#"
carom = 1
[mesh]
generate.lower.rectangle = { origin = [0.0, 0.0], size = [0.2, 0.1], elements = [10, 5] }
generate.upper.rectangle = { origin = [0.03, 0.1005], size = [0.1, 0.08], elements = [7, 6] }
[material.soft]
density = 1000.0
elastic = { young = "50 MPa", poisson = 0.3 }
[body.lower]
region = "lower"
material = "soft"
section.plane-strain = { thickness = 1.0 }
[body.upper]
region = "upper"
material = "soft"
section.plane-strain = { thickness = 1.0 }
initial = { velocity = [0.0, -2.0] }
[support.floor]
on = "lower.bottom"
fix = ["x", "y"]
[contact.pair]
secondary = "upper.bottom"
primary = "lower.top"
law.velocity = {}
friction.coulomb = 0.2
sliding = "finite"
[time]
end = "1.2 ms"
step = { critical = 0.5 }
scheme.central-difference = {}
"#;

pub const SMALL: &str = r#"elastic = { young = "5 MPa", poisson = 0.3 }"#;
const FINITE: &str = r#"neo-hooke = { young = "5 MPa", poisson = 0.3 }"#;
pub const METAL: &str =
    r#"j2 = { young = "50 MPa", poisson = 0.3, yield-stress = "0.2 MPa", hardening = "1 MPa" }"#;

pub fn block(material: &str) -> String {
    BLOCK.replace("MATERIAL", material)
}

pub fn read(text: &str) -> (Input, Case, Locator) {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap_or_else(|problems| panic!("{problems:?}"));
    (input, case, locator)
}

pub fn built(text: &str) -> (Input, Case, Built) {
    let (input, case, locator) = read(text);
    let built = build(&case, &locator, &input).unwrap_or_else(|problems| panic!("{problems:?}"));
    (input, case, built)
}

/// Stops a run after so many steps.
fn after(steps: u64) -> impl Fn() -> bool {
    let left = Cell::new(steps);
    move || left.replace(left.get().saturating_sub(1)) == 0
}

pub fn on_all<T: Send>(count: usize, work: impl Fn(&Ranks) -> T + Sync) -> Vec<T> {
    std::thread::scope(|scope| {
        let ranks = threads(count).into_iter();
        let work = &work;
        let started: Vec<_> = ranks.map(|own| scope.spawn(move || work(&own))).collect();
        started.into_iter().map(|one| one.join().unwrap()).collect()
    })
}

/// What takes the steps of a case on a rank.
pub fn driver_on(ranks: &Ranks, text: &str) -> Driver {
    let (input, case, locator) = read(text);
    if ranks.is_first() {
        let system = build(&case, &locator, &input).unwrap().system;
        return Driver::on_ranks(system, None, ranks, &Watched::default()).unwrap();
    }
    let model = model(&case, &locator, &input).unwrap();
    Driver::beside(model, ranks).unwrap().0
}

/// Runs a case on so many ranks, with the end of each.
pub fn run_on(
    count: usize,
    text: &str,
    folder: &Path,
    steps: u64,
) -> Vec<Result<Option<Finished>, Failed>> {
    on_all(count, |ranks| {
        let (input, case, locator) = read(text);
        let first = ranks.is_first();
        let built = first.then(|| build(&case, &locator, &input).unwrap());
        let read = (&input, &case, &locator);
        let folder = folder.to_owned();
        run_on_ranks(ranks, read, built, folder, &mut Silent, &after(steps))
    })
}

/// Goes on with the run of a folder on so many ranks.
pub fn resume_on(count: usize, folder: &Path) {
    on_all(count, |ranks| {
        let opened = match ranks.is_first() {
            true => Resume::open(folder, &[]),
            false => Resume::open_beside(folder, &[]),
        };
        let Ok(resume) = opened else {
            panic!("the folder is refused")
        };
        resume.run_on_ranks(ranks, &mut Silent, &|| false).unwrap();
    });
}

/// Runs a case in one process.
pub fn run_alone(text: &str, folder: &Path) {
    let (input, case, model) = built(text);
    let parts = (&input, &case, &model);
    run(parts, folder.to_owned(), &mut Silent, &|| false).unwrap();
}

/// The state of the last checkpoint.
pub fn last(text: &str, folder: &Path) -> State {
    let (_, _, built) = built(text);
    let (checkpoint, _) = checkpoint::latest(folder).unwrap();
    State::from_bytes(&built.system, &checkpoint.state).unwrap()
}

/// The largest difference of two vectors, over the largest entry of the first.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    let most = one
        .iter()
        .fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let differences = one.iter().zip(other).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / most
}

/// That two runs have the same motion, forces, histories and balances. Sums of forces are in another order, and rounding grows by some ten
/// times in each impact of a point: 1e-9 is a million roundings.
pub fn assert_same(name: &str, one: &State, other: &State) {
    const TOLERANCE: f64 = 1e-9;
    assert_eq!(one.step, other.step, "{name}");
    let (a, b) = (&one.motion, &other.motion);
    let vectors = [
        ("displacement", &a.u, &b.u),
        ("velocity", &a.v, &b.v),
        ("acceleration", &a.a, &b.a),
        ("internal force", &a.internal_force, &b.internal_force),
        ("history", &a.history, &b.history),
        (
            "contact force",
            &one.interface.force,
            &other.interface.force,
        ),
    ];
    for (of, a, b) in vectors {
        let apart = apart(a, b);
        assert!(apart < TOLERANCE, "{name}: {of} differs by {apart:e}");
    }
    let (a, b) = (&one.interface, &other.interface);
    assert_eq!(a.status, b.status, "{name}");
    assert_eq!(a.watched, b.watched, "{name}");
    let finite = |values: &[f64]| -> Vec<f64> {
        let finite = |x: &f64| if x.is_finite() { *x } else { -1.0 };
        values.iter().map(finite).collect()
    };
    let points = [
        ("gap", &a.gap, &b.gap),
        ("flight", &a.flight, &b.flight),
        ("crush", &a.crush, &b.crush),
        ("carried force", &a.carried, &b.carried),
    ];
    for (of, a, b) in points {
        let apart = apart(&finite(a), &finite(b));
        assert!(apart < TOLERANCE, "{name}: {of} differs by {apart:e}");
    }
    // rates of closed points are rounding
    let speed = one
        .motion
        .v
        .iter()
        .fold(0.0f64, |most, v| most.max(v.abs()));
    for (a, b) in a.rate.iter().zip(&b.rate) {
        assert!((a - b).abs() < TOLERANCE * speed, "{name}: rate");
    }
    let slid = a.friction.as_flattened();
    assert!(
        apart(slid, b.friction.as_flattened()) < TOLERANCE,
        "{name}: friction"
    );
    for (a, b) in one.records.contacts.iter().zip(&other.records.contacts) {
        let counts = |record: &ContactRecord| {
            let ContactRecord {
                peak_closed,
                peak_sharp,
                status_changes,
                hasty_closings,
                closings,
                ..
            } = record;
            [
                *peak_closed,
                *peak_sharp,
                *status_changes,
                *hasty_closings,
                *closings,
            ]
        };
        assert_eq!(counts(a), counts(b), "{name}");
        let numbers = |record: &ContactRecord| {
            [
                record.peak_force,
                record.penetration,
                record.energy_crushed,
                record.friction_loss(),
                record.impulse(),
                record.chatter(),
            ]
        };
        for (k, (a, b)) in numbers(a).into_iter().zip(numbers(b)).enumerate() {
            assert!((a - b).abs() <= 1e-8 * a.abs(), "{name}: {k}: {a:e} {b:e}");
        }
    }
    let most = one.ledger.largest_energy;
    for (a, b) in one.records.contacts.iter().zip(&other.records.contacts) {
        let defects = [a, b].map(ContactRecord::persistency_defect);
        assert!((defects[0] - defects[1]).abs() < TOLERANCE * most, "{name}");
    }
    let (a, b) = (&one.ledger.balance, &other.ledger.balance);
    for (of, a, b) in [
        ("kinetic energy", a.kinetic, b.kinetic),
        ("strain energy", a.strain, b.strain),
        ("work of contacts", a.work_contact, b.work_contact),
        ("energy residual", a.energy_residual, b.energy_residual),
    ] {
        assert!((a - b).abs() < TOLERANCE * most, "{name}: {of} {a:e} {b:e}");
    }
    assert_eq!(one.impacts_count(), other.impacts_count(), "{name}");
}

trait Count {
    fn impacts_count(&self) -> usize;
}

impl Count for State {
    fn impacts_count(&self) -> usize {
        self.records.ended().count()
    }
}

/// Rows of `histories.csv`.
fn rows(folder: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.join("histories.csv")).unwrap();
    let row = |line: &str| {
        line.split(',')
            .map(|cell| cell.parse().unwrap_or(0.0))
            .collect()
    };
    text.lines().skip(1).map(row).collect()
}

pub fn compare_on_ranks(name: &str, text: &str, counts: &[usize]) {
    let folder = tempfile::tempdir().unwrap();
    let alone = folder.path().join("alone");
    run_alone(text, &alone);
    let state = last(text, &alone);
    let histories = rows(&alone);
    for &count in counts {
        let name = format!("{name} on {count} ranks");
        let several = folder.path().join(count.to_string());
        let ended = run_on(count, text, &several, u64::MAX);
        let mut ended = ended.into_iter().map(|end| end.unwrap());
        let finished = ended.next().unwrap().unwrap();
        assert!(ended.all(|end| end.is_none()), "{name}: one tells the end");
        assert_same(&name, &state, &last(text, &several));
        // the balances are as good as those of one process: rounding of the energies
        assert!(finished.summary.energy.relative_residual < 1e-9, "{name}");
        assert!(finished.summary.momentum.relative_residual < 1e-9, "{name}");
        let others = rows(&several);
        assert_eq!(histories.len(), others.len(), "{name}");
        for column in 0..histories[0].len() {
            let of =
                |rows: &[Vec<f64>]| -> Vec<f64> { rows.iter().map(|row| row[column]).collect() };
            let (one, other) = (of(&histories), of(&others));
            let most = one.iter().fold(0.0f64, |most, x| most.max(x.abs()));
            let residual = most < 1e-9;
            assert!(
                residual || apart(&one, &other) < 1e-8,
                "{name}: column {column}"
            );
        }
        for file in ["summary.json", "report.html", "impacts.csv"] {
            assert!(several.join(file).is_file(), "{name}: {file}");
        }
    }
}

#[test]
fn bars_are_those_of_one_process_on_several_ranks() {
    compare_on_ranks("bars", BARS, &[2, 4]);
}

#[test]
fn a_block_is_that_of_one_process_on_several_ranks() {
    compare_on_ranks("block", &block(SMALL), &[2, 4]);
}

#[test]
fn a_block_at_finite_strain_is_that_of_one_process_on_several_ranks() {
    compare_on_ranks("finite block", &block(FINITE), &[3]);
}

#[test]
fn a_block_of_metal_keeps_its_histories_on_several_ranks() {
    compare_on_ranks("metal block", &block(METAL), &[2]);
}

/// The fall is fast enough that elements shorten, so that steps change: each rank looks at its own elements.
#[test]
fn steps_that_follow_the_critical_step_are_those_of_one_process_on_several_ranks() {
    let text = block(METAL)
        .replace("-5.0]", "-15.0]")
        .replace("critical = 0.2", "critical = 0.7")
        .replace("initial =", "mass-scaling.factor = 2.0\ninitial =");
    compare_on_ranks("followed steps", &text, &[2, 3]);
    let folder = tempfile::tempdir().unwrap();
    let several = folder.path().join("several");
    for end in run_on(2, &text, &several, u64::MAX) {
        end.unwrap();
    }
    let times: Vec<f64> = rows(&several).iter().map(|row| row[0]).collect();
    let steps: Vec<f64> = times.windows(2).map(|ends| ends[1] - ends[0]).collect();
    let [least, most] =
        [f64::min, f64::max].map(|of| steps[1..].iter().copied().fold(steps[0], of));
    assert!(least < 0.9 * most, "{least:e} {most:e}");
}

#[test]
fn two_bodies_with_friction_and_a_support_are_those_of_one_process_on_several_ranks() {
    compare_on_ranks("pair", PAIR, &[2, 4]);
}

#[test]
fn three_ranks_and_one_go_on_from_the_checkpoint_of_four() {
    let text = block(METAL);
    let folder = tempfile::tempdir().unwrap();
    let alone = folder.path().join("alone");
    run_alone(&text, &alone);
    for count in [3, 1] {
        let cut = folder.path().join(format!("cut-{count}"));
        let ended = run_on(4, &text, &cut, 25);
        let finished = ended.into_iter().next().unwrap().unwrap().unwrap();
        assert!(finished.interrupted);
        let first = last(&text, &cut).step;
        assert_eq!(first, 25);
        if count == 1 {
            let Ok(resume) = Resume::open(&cut, &[]) else {
                panic!("the folder is refused")
            };
            resume.run(&mut Silent, &|| false).unwrap();
        } else {
            resume_on(count, &cut);
        }
        assert_same("resumed", &last(&text, &alone), &last(&text, &cut));
    }
}

#[test]
fn a_step_that_fails_on_one_rank_fails_on_all_with_one_message_and_a_checkpoint() {
    // nodes that the plane has stopped are overtaken in one step, by five elements: these turn inside out, and steps are not halved
    let text = block(FINITE).replace("-5.0]", "-5000.0]").replace(
        "step = { critical = 0.2 }",
        "step = \"20 us\"\nnewton = { halvings = 0 }",
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("failed");
    let ended = run_on(4, &text, &path, u64::MAX);
    let messages = ended
        .iter()
        .map(|end| end.as_ref().unwrap_err().to_string());
    let messages: Vec<String> = messages.collect();
    assert!(messages[0].starts_with("rank "), "{messages:?}");
    assert!(
        messages.iter().all(|message| *message == messages[0]),
        "{messages:?}"
    );
    let state = last(&text, &path);
    assert!(state.step > 0 && state.motion.u.iter().all(|u| u.is_finite()));
}

#[test]
fn results_that_cannot_be_written_end_all_ranks() {
    let folder = tempfile::tempdir().unwrap();
    // a folder with files of somebody else
    std::fs::write(folder.path().join("letter.txt"), "dear").unwrap();
    let ended = run_on(2, BARS, folder.path(), u64::MAX);
    assert!(ended.iter().all(Result::is_err));
    assert!(
        ended[1]
            .as_ref()
            .unwrap_err()
            .to_string()
            .starts_with("rank 0: ")
    );
}

/// What ranks count and send a step over some steps of a block, which begins so high above the plane (m).
fn sent(height: &str, steps: u64) -> Vec<[f64; 2]> {
    let text = block(SMALL).replace("0.002]", height);
    on_all(4, |ranks| {
        let mut driver = driver_on(ranks, &text);
        let before = driver.rank_share().unwrap();
        (0..steps).for_each(|_| driver.step().unwrap());
        let sent = driver.rank_share().unwrap().sent_bytes - before.sent_bytes;
        [before.halo_bytes as f64, sent as f64 / steps as f64]
    })
}

#[test]
fn ranks_send_what_is_counted() {
    let flying = sent("0.2]", 20);
    for (rank, [counted, sent]) in flying.iter().enumerate() {
        assert!(
            *counted > 0.0 && counted == sent,
            "rank {rank}: {counted} {sent}"
        );
    }
    // velocities go to the first rank besides, where impacts begin or end
    for (rank, [counted, sent]) in sent("0.002]", 100).iter().enumerate() {
        assert!(
            (1.0..1.1).contains(&(sent / counted)),
            "rank {rank}: {counted} {sent}"
        );
    }
    // four parts of 5 x 4 x 6 elements: the first cut is a plane of 6 x 5 nodes across the longest side, each half is cut across 5 elements, in
    // the plane of 5 x 4 nodes; all these nodes are sent both ways, those on both planes to three ranks, and contact forces of the bottom of
    // 6 x 5 nodes at most
    let nodes = flying.iter().map(|[counted, _]| counted).sum::<f64>() / 24.0;
    let cuts = 2.0 * (30.0 + 2.0 * 20.0);
    assert!((cuts..=1.5 * cuts + 60.0).contains(&nodes), "{nodes} nodes");
}

#[test]
fn steps_that_every_rank_takes_have_the_bits_of_one_process() {
    let text = PAIR
        .replace("scheme.central-difference = {}", "scheme.newmark = {}")
        .replace("step = { critical = 0.5 }", "step = \"0.1 ms\"");
    let folder = tempfile::tempdir().unwrap();
    let alone = folder.path().join("alone");
    run_on(1, &text, &alone, u64::MAX);
    for ranks in [2, 3] {
        let several = folder.path().join(ranks.to_string());
        let ended = run_on(ranks, &text, &several, u64::MAX);
        assert!(ended.iter().all(Result::is_ok));
        let histories = |folder: &Path| std::fs::read(folder.join("histories.csv")).unwrap();
        assert_eq!(histories(&alone), histories(&several));
    }
}

#[test]
fn what_several_ranks_do_not_share_is_told() {
    let newmark = BARS.replace("scheme.central-difference", "scheme.newmark");
    let damped = PAIR.replace("[body.lower]", "[body.lower]\ndamping = { mass = 1.0 }");
    for (text, what) in [(newmark, "other schemes"), (damped, "damping")] {
        let (_, _, built) = built(&text);
        let told = whole_on_ranks(&built).unwrap();
        assert!(told.contains(what), "{told}");
    }
    let (_, _, model) = built(BARS);
    assert_eq!(whole_on_ranks(&model), None);
}
