//! Reads damaged files for a time, and tells whether a reader panics, hangs or takes too much memory:
//!
//! ```text
//! cargo run --release -p carom-case --features hdf5 --example damaged -- SECONDS FOLDER FILE...
//! ```
//!
//! The files are taken in turn, each damaged anew. Meshes are read, of tables the columns too. A case (`.toml`) is read and built, with the files
//! beside it. Of a checkpoint (`.state`) the report of its results folder is written; every other one has a checksum that is right again. A file that fails is kept in the folder.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use carom_algebra::fingerprint::Fingerprint;
use carom_case::{Input, Resume, build, parse};
use carom_mesh::Mesh;
use carom_testing::damage::{damaged, forged};
use carom_testing::{Counter, held};

#[global_allocator]
static COUNTER: Counter = Counter;

/// Most bytes that a reader may hold, 1 GiB.
const BYTES: isize = 1 << 30;

/// Time after which a reader hangs.
const HANGS: Duration = Duration::from_secs(20);

/// Number of the file that is read, for the watch.
static NUMBER: AtomicUsize = AtomicUsize::new(0);

type Anyhow<T> = Result<T, Box<dyn std::error::Error>>;

/// A sound file, and the folder where its damaged copies are read.
struct Sound {
    content: Vec<u8>,
    copy: PathBuf,
    /// Case or results folder that the copy belongs to.
    folder: PathBuf,
}

fn main() -> Anyhow<()> {
    let mut arguments = std::env::args().skip(1);
    let mut next = || arguments.next().ok_or("SECONDS FOLDER FILE...");
    let time = Duration::from_secs(next()?.parse()?);
    let folder = PathBuf::from(next()?);
    let files = arguments.enumerate();
    let sound: Vec<Sound> = files
        .map(|(k, file)| sound(Path::new(&file), &folder.join(k.to_string())))
        .collect::<Anyhow<_>>()?;
    std::thread::spawn(watch);
    let (mut state, mut longest, mut most) = (0x2545_f491_4f6c_dd1d, Duration::ZERO, 0);
    let (mut read, mut taken, mut failed) = (0, 0, 0);
    let begin = Instant::now();
    while begin.elapsed() < time {
        let file = &sound[read % sound.len()];
        let forges = read / sound.len() % 2 == 1;
        let content = match forges && file.copy.extension().is_some_and(|end| end == "state") {
            true => forged(&file.content, &mut state, |rest| {
                Fingerprint::default().bytes(rest).digits()
            }),
            false => damaged(&file.content, &mut state),
        };
        std::fs::write(&file.copy, &content)?;
        NUMBER.store(read + 1, Ordering::Relaxed);
        let [before, _] = held();
        let one = Instant::now();
        let outcome = catch_unwind(AssertUnwindSafe(|| read_one(file)));
        let (took, bytes) = (one.elapsed(), held()[1] - before);
        read += 1;
        taken += usize::from(matches!(outcome, Ok(true)));
        longest = longest.max(took);
        most = most.max(bytes);
        if outcome.is_err() || took > HANGS || bytes > BYTES {
            let name = file.copy.file_name().unwrap_or_default().to_string_lossy();
            let kept = folder.join(format!("failed-{failed}-{name}"));
            std::fs::write(&kept, &content)?;
            println!("{}: {took:.1?}, {bytes} bytes", kept.display());
            failed += 1;
        }
    }
    println!(
        "{read} files in {:.0?}: {taken} taken, {failed} failed; longest {longest:.1?}, most {:.1} MiB",
        begin.elapsed(),
        most as f64 / f64::from(1 << 20)
    );
    Ok(())
}

/// Reads a file, and copies what it needs into a folder.
fn sound(file: &Path, folder: &Path) -> Anyhow<Sound> {
    let name = file.file_name().ok_or("no file")?;
    let is_state = file.extension().is_some_and(|end| end == "state");
    let mut from = file.parent().ok_or("no folder")?;
    if is_state {
        from = from.parent().ok_or("no results folder")?;
    }
    std::fs::create_dir_all(folder.join("checkpoints"))?;
    for entry in std::fs::read_dir(from)? {
        let entry = entry?.path();
        if entry.is_file() {
            std::fs::copy(&entry, folder.join(entry.file_name().ok_or("no name")?))?;
        }
    }
    let inside = if is_state { "checkpoints" } else { "." };
    Ok(Sound {
        content: std::fs::read(file)?,
        copy: folder.join(inside).join(name),
        folder: folder.to_owned(),
    })
}

/// Reads the copy of a file; whether it is taken.
fn read_one(file: &Sound) -> bool {
    let built = |case: &Path| {
        let input = Input::read(case, &[])?;
        let (case, locator) = parse(&input)?;
        build(&case, &locator, &input)
    };
    let end = file.copy.extension().unwrap_or_default();
    match end.to_str() {
        Some("state") => Resume::open(&file.folder, &[]).is_ok_and(|run| run.report().is_ok()),
        Some("toml" | "csv") => built(&file.folder.join("case.toml")).is_ok(),
        _ => carom_med::read(&file.copy).is_ok_and(|mesh| {
            assert_consistent(&mesh);
            true
        }),
    }
}

/// Panics where a mesh has a number of something that it has not.
fn assert_consistent(mesh: &Mesh) {
    let nodes = mesh.nodes.len();
    assert!(mesh.nodes.iter().flatten().all(|x| x.is_finite()));
    for block in &mesh.blocks {
        assert_eq!(block.nodes.len(), block.len() * block.kind.table().nodes);
        assert!(block.nodes.iter().all(|node| (*node as usize) < nodes));
    }
    let elements = mesh.groups.values().flat_map(|group| &group.elements);
    for id in elements {
        assert!((id.index as usize) < mesh.blocks[id.block as usize].len());
    }
}

/// Ends the program where a file is not read in time; its copy stays.
fn watch() {
    loop {
        let number = NUMBER.load(Ordering::Relaxed);
        std::thread::sleep(3 * HANGS);
        if number > 0 && NUMBER.load(Ordering::Relaxed) == number {
            eprintln!("file {number} hangs");
            std::process::exit(1);
        }
    }
}
