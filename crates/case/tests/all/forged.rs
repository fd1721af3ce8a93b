//! Checkpoints with something wrong and a checksum that is right: refused, or taken, and never a panic.

use std::path::Path;

use carom_algebra::fingerprint::Fingerprint;
use carom_case::{Input, Resume, build, parse};
use carom_testing::damage::forged;

use carom_dynamics::Silent;

/// Forged checkpoints of each case.
const COUNT: usize = 150;

/// Blocks that rub, with histories of cells, probes and frames of fields.
const BLOCKS: &str = r#"
carom = 1
mesh.generate.a.rectangle = { origin = [0.0, 0.0], size = [0.2, 0.1], elements = [4, 2] }
mesh.generate.b.rectangle = { origin = [0.05, 0.1001], size = [0.1, 0.1], elements = [2, 2] }
material.m = { density = 1000.0, j2 = { young = 1e7, poisson = 0.3, yield-stress = 2e4, hardening = 1e5 } }
body.a = { region = "a", material = "m", section.plane-strain.thickness = 0.5 }
body.b = { region = "b", material = "m", section.plane-strain.thickness = 0.5, initial.velocity = [0.5, -1.0] }
support.s = { on = "a.bottom", fix = ["x", "y"] }
contact.c = { secondary = "b.bottom", primary = "a.top", law.velocity = {}, friction.coulomb = 0.3, sliding = "finite", filter = ["cfc-1000"] }
probe.p = { on = "b.top", record = ["velocity"] }
time = { end = "2 ms", step = "0.1 ms", scheme.theta = {} }
output = { fields = { every = "0.5 ms", record = ["displacement", "stress"] }, checkpoint = { every = "0.5 ms" } }
"#;

/// Zones of which one takes several steps.
const ZONES: &str = r#"
carom = 1
mesh.generate.a.line = { from = [0.0], to = [0.1], elements = 10 }
mesh.generate.b.line = { from = [0.1], to = [0.2], elements = 10 }
material.m = { density = 1000.0, elastic = { young = 1e7, poisson = 0.0 } }
body.a = { region = "a", material = "m", section.bar.area = 0.01, initial.velocity = [-1.0] }
body.b = { region = "b", material = "m", section.bar.area = 0.01, initial.velocity = [-1.0] }
zone.near = { bodies = ["a"], substeps = 2 }
zone.far.bodies = ["b"]
interface.i = { inner = "a", outer = "b" }
contact.c = { secondary = "a.left", obstacle.plane = { point = [-0.001], normal = [1.0] }, law.velocity = {} }
time = { end = "4 ms", step = "0.1 ms", scheme.theta = {} }
output.checkpoint.every = "1 ms"
"#;

/// Reads forged checkpoints of a run of a case; how many of them are taken.
fn taken(text: &str) -> usize {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap_or_else(|problems| panic!("{problems:?}"));
    let built = build(&case, &locator, &input).unwrap_or_else(|problems| panic!("{problems:?}"));
    let work = tempfile::tempdir().unwrap();
    let folder = work.path().join("results");
    carom_case::run(
        (&input, &case, &built),
        folder.clone(),
        &mut Silent,
        &|| false,
    )
    .unwrap();
    let file = folder.join("checkpoints/last.state");
    let sound = std::fs::read(&file).unwrap();
    for entry in std::fs::read_dir(folder.join("checkpoints")).unwrap() {
        std::fs::remove_file(entry.unwrap().path()).unwrap();
    }
    let (mut state, mut taken) = (7, 0);
    for _ in 0..COUNT {
        let content = forged(&sound, &mut state, |rest| {
            Fingerprint::default().bytes(rest).digits()
        });
        std::fs::write(&file, content).unwrap();
        taken += usize::from(reads(&folder));
    }
    taken
}

fn reads(folder: &Path) -> bool {
    Resume::open(folder, &[]).is_ok_and(|run| run.report().is_ok())
}

#[test]
fn forged_checkpoints_are_refused_or_reported() {
    for case in [BLOCKS, ZONES] {
        // a byte of a number is another number, of which nothing can be told; lengths, counts and kinds are
        let taken = taken(case);
        assert!((1..COUNT).contains(&taken), "{taken}");
    }
}
