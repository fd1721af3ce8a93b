//! Fields of runs on several ranks: each writes the elements that it has.

use std::path::{Path, PathBuf};

use carom_mesh::read::vtu::{Numbers, Stored, stored};

use crate::ranks::{METAL, block, resume_on, run_alone, run_on};

/// The attributes of this name in a text.
fn named<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    let start = format!("{name}=\"");
    let parts = text.split(&start[..]).skip(1);
    parts.filter_map(|part| part.split('"').next()).collect()
}

/// The files of each instant of the bodies, in which all must be.
fn files(folder: &Path) -> Vec<Vec<PathBuf>> {
    let collection = std::fs::read_to_string(folder.join("fields.pvd")).unwrap();
    let of_instant = |name: &&str| {
        let path = folder.join(name);
        if path.extension().is_some_and(|ending| ending == "vtu") {
            assert!(path.is_file(), "{}", path.display());
            return vec![path];
        }
        let list = std::fs::read_to_string(&path).unwrap();
        let pieces = named(&list, "Source").into_iter();
        let pieces = pieces.map(|piece| path.with_file_name(piece));
        pieces
            .inspect(|piece| assert!(piece.is_file(), "{}", piece.display()))
            .collect()
    };
    let names = named(&collection, "file");
    let bodies = names.iter().filter(|name| name.contains("bodies-"));
    bodies.map(of_instant).collect()
}

fn read(path: &Path) -> Stored {
    stored(path, &std::fs::read(path).unwrap()).unwrap()
}

/// Middle of each cell, m.
fn middles(grid: &Stored) -> Vec<[f64; 3]> {
    let starts = std::iter::once(0).chain(grid.ends.iter().copied());
    let cells = starts.zip(&grid.ends);
    let middle = |(from, to): (i64, &i64)| {
        let nodes = &grid.connectivity[from as usize..*to as usize];
        nodes.iter().fold([0.0; 3], |sum, node| {
            let x = grid.points[*node as usize];
            [0, 1, 2].map(|i| sum[i] + x[i] / nodes.len() as f64)
        })
    };
    cells.map(middle).collect()
}

/// The place nearest to `x`, and how far it is, m.
fn nearest(x: &[f64; 3], all: &[[f64; 3]]) -> (usize, f64) {
    let distance = |y: &[f64; 3]| (0..3).map(|i| (x[i] - y[i]).powi(2)).sum::<f64>().sqrt();
    let all = all.iter().map(distance).enumerate();
    all.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
}

fn values(grid: &Stored, name: &str) -> Option<(usize, bool, Vec<f64>)> {
    let array = grid.arrays.iter().find(|array| array.name == name)?;
    let values = match &array.values {
        Numbers::Reals(values) => values.clone(),
        Numbers::Integers(values) => values.iter().map(|value| *value as f64).collect(),
    };
    Some((array.components, array.of_points, values))
}

/// That pieces together have the cells and the fields of the whole: motion and stress of two runs that differ by the order of sums, 1e-9 of the
/// largest as in the tests of states.
fn assert_pieces_of(whole: &Stored, pieces: &[Stored]) {
    let (cells, points) = (middles(whole), &whole.points);
    let mut found = vec![0; cells.len()];
    for (rank, piece) in pieces.iter().enumerate() {
        let middles = middles(piece);
        let places: Vec<usize> = middles.iter().map(|x| nearest(x, &cells).0).collect();
        places.iter().for_each(|place| found[*place] += 1);
        let of_points = piece.points.iter().map(|x| nearest(x, points));
        let (nodes, apart): (Vec<usize>, Vec<f64>) = of_points.unzip();
        assert!(apart.iter().all(|apart| *apart < 1e-10));
        let (_, _, ranks) = values(piece, "rank").unwrap();
        assert!(ranks.iter().all(|found| *found == rank as f64));
        for array in &whole.arrays {
            let name = &array.name;
            let (components, of_points, all) = values(whole, name).unwrap();
            let (_, _, own) = values(piece, name).unwrap_or_else(|| panic!("no {name}"));
            let most = all.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
            let places = if of_points { &nodes } else { &places };
            assert_eq!(own.len(), components * places.len(), "{name}");
            for (own, place) in own.chunks(components).zip(places) {
                for (a, b) in own.iter().zip(&all[components * place..]) {
                    assert!((a - b).abs() <= 1e-9 * most, "{name}: {a} {b}");
                }
            }
        }
    }
    // each cell once
    assert!(found.iter().all(|count| *count == 1));
}

fn text() -> String {
    block(METAL).replace(
        r#"record = ["displacement", "stress"] }"#,
        r#"record = ["displacement", "velocity", "stress", "strain", "principal-stress"] }"#,
    )
}

#[test]
fn the_pieces_of_ranks_are_the_fields_of_one_process() {
    let folder = tempfile::tempdir().unwrap();
    let alone = folder.path().join("alone");
    run_alone(&text(), &alone);
    let several = folder.path().join("several");
    for end in run_on(3, &text(), &several, u64::MAX) {
        end.unwrap();
    }
    let (whole, pieces) = (files(&alone), files(&several));
    assert!(whole.len() > 4);
    assert_eq!(whole.len(), pieces.len());
    for (whole, pieces) in whole.iter().zip(&pieces) {
        let found: Vec<Stored> = pieces.iter().map(|piece| read(piece)).collect();
        assert_eq!(found.len(), 3);
        assert_pieces_of(&read(&whole[0]), &found);
    }
    // means over elements of several ranks are written by the first one
    let nodal = text().replace(r#""strain","#, r#""nodal-stress","#);
    let whole = folder.path().join("whole");
    for end in run_on(2, &nodal, &whole, 5) {
        end.unwrap();
    }
    assert!(files(&whole).iter().all(|files| files.len() == 1));
}

#[test]
fn fields_go_on_in_other_pieces_from_a_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let alone = folder.path().join("alone");
    run_alone(&text(), &alone);
    let cut = folder.path().join("cut");
    for end in run_on(3, &text(), &cut, 25) {
        end.unwrap();
    }
    let before = files(&cut).len();
    resume_on(2, &cut);
    // the end of the first part is an instant more than in one run, and is taken back
    let (whole, pieces) = (files(&alone), files(&cut));
    assert_eq!(whole.len(), pieces.len());
    let counts: Vec<usize> = pieces.iter().map(Vec::len).collect();
    assert!(
        counts.starts_with(&[3]) && counts.ends_with(&[2]),
        "{counts:?} {before}"
    );
    for (whole, pieces) in whole.iter().zip(&pieces) {
        let found: Vec<Stored> = pieces.iter().map(|piece| read(piece)).collect();
        assert_pieces_of(&read(&whole[0]), &found);
    }
}
