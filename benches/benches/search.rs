//! Pairing of n points with n faces: time over n log2 n, and memory for a face.
//!
//! `cargo bench -p carom-benches --bench search`. The faces are a waved sheet of quadrilaterals with one secondary node over
//! each. "first": tree and all; "fast": the sheet moves by a face per pairing, forth and back, boxes are refitted and all points searched;
//! "slow": by a hundredth of a face, most points ask the faces that they have kept. "refit" and "query" are two parts of "fast": the boxes
//! of all faces, and the closest points of all points without their rows. `CAROM_BENCH_THREADS=2` sets the threads (1 unless given).
//! The last lines print the best times, since other processes may be running.

use std::hint::black_box;
use std::time::{Duration, Instant};

use carom_algebra::unknowns::Unknowns;
use carom_contact::law::Displacement;
use carom_contact::{
    Contact, Frames, Integration, Law, Places, Point, Rows, Search, Sliding, Target,
};
use carom_elements::Kind;
use carom_mesh::{ElementId, Face, Rim, face_nodes};
use criterion::{BenchmarkId, Criterion, SamplingMode};

/// What of a pairing is timed.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    All,
    Refit,
    Query,
}

fn main() -> Result<(), rayon::ThreadPoolBuildError> {
    let threads = std::env::var("CAROM_BENCH_THREADS").ok();
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.and_then(|n| n.parse().ok()).unwrap_or(1))
        .build_global()?;
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(1))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    let mut lines = Vec::new();
    for side in [100, 316, 1000] {
        lines.extend(sheet(&mut criterion, side));
    }
    for line in lines {
        println!("{line}");
    }
    criterion.final_summary();
    Ok(())
}

fn sheet(criterion: &mut Criterion, side: u32) -> Vec<String> {
    let (x, contact) = scene(side);
    let n = f64::from(side * side);
    let unknowns = Unknowns::translations(3, x.len());
    let mut lines = Vec::new();
    let kinds = [
        ("first", 0.0, Part::All),
        ("fast", 1.0, Part::All),
        ("refit", 1.0, Part::Refit),
        ("query", 1.0, Part::Query),
        ("slow", 0.01, Part::All),
    ];
    for (name, step, part) in kinds {
        let mut u = vec![0.0; 3 * x.len()];
        let (mut search, mut rows) = (Search::default(), Rows::default());
        let (mut feet, mut best) = (Vec::new(), Duration::MAX);
        let mut way = step;
        let mut pair = |search: &mut Search| {
            // the sheet moves forth and back, the points over it stay
            let sheet = &mut u[..3 * ((side + 1) * (side + 1)) as usize];
            sheet.iter_mut().step_by(3).for_each(|u| *u += way);
            way = -way;
            let places = Places {
                unknowns: &unknowns,
                time: 0.0,
                x: &x,
                u: &u,
                frames: Frames::default(),
            };
            let mut begin = Instant::now();
            if part == Part::All {
                rows.clear();
                contact.pair(&places, search, &mut rows);
                black_box(&rows);
                return begin.elapsed();
            }
            contact.renew(&places, search);
            let refit = begin.elapsed();
            begin = Instant::now();
            contact.feet(&places, search, &mut feet);
            black_box(&feet);
            match part {
                Part::Refit => refit,
                Part::Query | Part::All => begin.elapsed(),
            }
        };
        // lists of faces are made once the boxes have stood for some steps
        let before = if step == 0.0 { 0 } else { 6 };
        for _ in 0..before {
            pair(&mut search);
        }
        let mut group = criterion.benchmark_group(name);
        group.sampling_mode(SamplingMode::Flat);
        group.bench_function(BenchmarkId::from_parameter(side * side), |bencher| {
            bencher.iter_custom(|count| {
                let mut sum = Duration::ZERO;
                for _ in 0..count {
                    if step == 0.0 {
                        search = Search::default();
                    }
                    let elapsed = pair(&mut search);
                    best = best.min(elapsed);
                    sum += elapsed;
                }
                sum
            });
        });
        group.finish();
        if best == Duration::MAX {
            // left out by the filter of the command line
            continue;
        }
        let seconds = best.as_secs_f64();
        lines.push(format!(
            "{name} {n:.0}: {seconds:.4} s, {:.2} ns / (n log2 n), {:.2} projections a point, {:.0} bytes a face",
            1e9 * seconds / (n * n.log2()),
            search.projections() as f64 / n,
            search.bytes() as f64 / n,
        ));
    }
    lines
}

fn scene(side: u32) -> (Vec<[f64; 3]>, Contact) {
    let n = side + 1;
    let wave = |x: f64, y: f64| (0.1 * x).sin() * (0.13 * y).cos();
    let node = |i: u32| {
        let [x, y] = [f64::from(i % n), f64::from(i / n)];
        [x, y, wave(x, y)]
    };
    let mut x: Vec<[f64; 3]> = (0..n * n).map(node).collect();
    let face = |i: u32| {
        let a = i % side + n * (i / side);
        Face {
            kind: Kind::Quad4,
            nodes: face_nodes(&[a, a + 1, a + n + 1, a + n]),
            parent: ElementId { block: 0, index: i },
            axis: [0.0; 3],
            radius: None,
            rim: Rim::default(),
        }
    };
    let faces = (0..side * side).map(face).collect();
    let over = |i: u32| {
        let [x, y] = [f64::from(i % side) + 0.3, f64::from(i / side) + 0.6];
        [x, y, wave(x, y) + 0.2]
    };
    x.extend((0..side * side).map(over));
    let points = (n * n..n * n + side * side).map(|node| Point::at_node(node, 1.0, 1.0));
    let contact = Contact {
        name: "sheet".into(),
        law: Law::Displacement(Displacement::default()),
        sliding: Sliding::Finite,
        integration: Integration::Node,
        points: points.collect(),
        mortar: None,
        target: Target::Surface(faces),
        sight: None,
        edges: None,
        offsets: Vec::new(),
        near_only: false,
    };
    (x, contact)
}
