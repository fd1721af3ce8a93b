//! CSV tables, read back with another library, whole and cut by a full disk.

use std::io::Read;
use std::path::Path;
use std::process::Command;

use carom_output::history::column;
use carom_output::{Error, History, ImpactRow, ImpactTable};

pub fn read(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names = reader
        .headers()
        .unwrap()
        .iter()
        .map(str::to_owned)
        .collect();
    let rows = reader
        .records()
        .map(|row| row.unwrap().iter().map(str::to_owned).collect());
    (names, rows.collect())
}

#[test]
fn columns_are_paths_in_snake_case_with_the_unit() {
    assert_eq!(column(&["time"], "s"), "time_s");
    assert_eq!(
        column(&["contact", "shock", "force"], "N"),
        "contact.shock.force_n"
    );
    assert_eq!(
        column(&["probe", "A", "acceleration", "x"], "m/s²"),
        "probe.a.acceleration.x_m_s2"
    );
    assert_eq!(
        column(&["contact", " Shock--1 ", "impulse"], "N s"),
        "contact.shock_1.impulse_n_s"
    );
    assert_eq!(
        column(&["contact", "shock", "closed"], ""),
        "contact.shock.closed"
    );
}

#[test]
fn every_number_comes_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("histories.csv");
    let mut history = History::create(&path, &["time_s", "energy.kinetic_j"]).unwrap();
    let special = [
        0.0,
        -0.0,
        0.1,
        1.0 / 3.0,
        5e-324,
        f64::MAX,
        -1e-7,
        1e16,
        f64::INFINITY,
        f64::NAN,
    ];
    for (step, value) in special.into_iter().enumerate() {
        history.push(&[step as f64 * 1e-7, value]).unwrap();
    }
    history.finish().unwrap();
    let (names, rows) = read(&path);
    assert_eq!(names, ["time_s", "energy.kinetic_j"]);
    assert_eq!(rows.len(), special.len());
    for (step, (row, value)) in rows.iter().zip(special).enumerate() {
        assert_eq!(
            row[0].parse::<f64>().unwrap().to_bits(),
            (step as f64 * 1e-7).to_bits()
        );
        let read: f64 = row[1].parse().unwrap();
        assert!(read.to_bits() == value.to_bits() || read.is_nan() && value.is_nan());
    }
}

#[test]
fn rows_reach_the_file_without_being_asked_and_when_the_run_is_dropped() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("histories.csv");
    let mut history = History::create(&path, &["time_s"]).unwrap();
    for step in 0..100_000 {
        history.push(&[f64::from(step) + 1.0 / 3.0]).unwrap();
    }
    assert!(read(&path).1.len() > 50_000);
    drop(history);
    assert_eq!(read(&path).1.len(), 100_000);
}

#[test]
fn rows_and_columns_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("histories.csv");
    let error = History::create(&path, &["time_s", "a", "time_s"]).unwrap_err();
    assert!(
        matches!(error, Error::TwinColumns { ref name, .. } if name == "time_s"),
        "{error}"
    );
    let mut history = History::create(&path, &["time_s", "a"]).unwrap();
    let error = history.push(&[1.0]).unwrap_err();
    assert!(
        matches!(
            error,
            Error::RowLength {
                expected: 2,
                found: 1,
                ..
            }
        ),
        "{error}"
    );
    history.push(&[1.0, 2.0]).unwrap();
    history.finish().unwrap();
    assert_eq!(read(&path).1, [["1.0", "2.0"]]);
}

#[test]
fn an_impact_that_is_not_over_has_empty_cells() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("impacts.csv");
    let over = ImpactRow {
        pair: "a, \"b\"".to_owned(),
        start: 1e-4,
        duration: Some(2e-4),
        peak_force: 7e4,
        peak_steps: 12,
        peak_mean_force: Some(6.6e4),
        window: 5e-6,
        impulse: 6.6,
        approach_speed: Some(5.0),
        rebound_speed: Some(4.5),
        restitution: Some(0.9),
        energy_given: Some(16.0),
        energy_taken: 15.0,
        energy_lost: 0.1,
        energy_crushed: 0.04,
        friction_loss: 0.03,
        intervals: 2,
        impulsive: 0.0,
    };
    let open = ImpactRow {
        duration: None,
        rebound_speed: None,
        restitution: None,
        ..over.clone()
    };
    let mut table = ImpactTable::create(&path).unwrap();
    table.push(&over).unwrap();
    let (names, rows) = read(&path);
    assert_eq!(rows.len(), 1, "an impact is on the disk at once");
    assert_eq!(names, carom_output::impacts::COLUMNS);
    assert_eq!(
        rows[0],
        [
            "a, \"b\"", "0.0001", "0.0002", "70000.0", "66000.0", "5e-6", "6.6", "5.0", "4.5",
            "0.9", "16.0", "15.0", "0.1", "0.04", "2.0", "0.0", "12.0", "0.03"
        ]
    );
    table.push(&open).unwrap();
    table.finish().unwrap();
    let last = &read(&path).1[1];
    assert_eq!([&last[2], &last[8], &last[9]], ["", "", ""]);
}

/// The other side of the next test: fills a table until the system refuses, then says what it said.
#[test]
fn fill_until_refused() {
    let Ok(path) = std::env::var("CAROM_TEST_FILL") else {
        return;
    };
    let path = Path::new(&path);
    let mut history = History::create(path, &["time_s", "contact.shock.force_n"]).unwrap();
    let refused = (0..1_000_000)
        .map(f64::from)
        .find_map(|step| history.push(&[step / 3.0, step]).err())
        .unwrap();
    let length = std::fs::metadata(path).unwrap().len();
    // Rows still in memory are tried again, refused again, and spoil nothing.
    history.flush().unwrap_err();
    drop(history);
    assert_eq!(std::fs::metadata(path).unwrap().len(), length);
    std::fs::write(path.with_extension("said"), refused.to_string()).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_size_limit_leaves_complete_rows_and_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("histories.csv");
    // 200 blocks of 512 or of 1024 bytes, by the shell. The signal is ignored, so that the write returns an error.
    let status = Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 200; exec \"$0\" --exact tables::fill_until_refused --quiet",
        ])
        .arg(std::env::current_exe().unwrap())
        .env("CAROM_TEST_FILL", &path)
        .stdout(std::process::Stdio::null())
        .status()
        .unwrap();
    assert!(status.success());
    let said = std::fs::read_to_string(path.with_extension("said")).unwrap();
    assert!(
        said.starts_with(&format!("cannot write '{}': ", path.display())),
        "{said}"
    );
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.ends_with('\n'));
    let rows = read(&path).1;
    // The limit is not a whole number of rows: whole ones fill it to less than the length of a row.
    assert!(rows.len() > 1000);
    let limit = if text.len() > 102_400 {
        204_800
    } else {
        102_400
    };
    assert!(
        text.len() <= limit && text.len() + 40 > limit,
        "{} of {limit}",
        text.len()
    );
    for (step, row) in rows.iter().enumerate() {
        let found: Vec<f64> = row.iter().map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(found, [step as f64 / 3.0, step as f64]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_size_limit_leaves_all_compressed_rows_that_fit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("histories.csv.gz");
    let status = Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 200; exec \"$0\" --exact tables::fill_until_refused --quiet",
        ])
        .arg(std::env::current_exe().unwrap())
        .env("CAROM_TEST_FILL", &path)
        .stdout(std::process::Stdio::null())
        .status()
        .unwrap();
    assert!(status.success());
    let found = std::fs::read(&path).unwrap();
    let limit = if found.len() > 102_400 {
        204_800
    } else {
        102_400
    };
    // a member of one row takes up to 18 bytes of head and tail (RFC 1952), and its row of less than 40
    assert!(
        found.len() <= limit && found.len() + 58 > limit,
        "{} of {limit}",
        found.len()
    );
    let mut text = String::new();
    flate2::read::MultiGzDecoder::new(&found[..])
        .read_to_string(&mut text)
        .unwrap();
    let rows: Vec<&str> = text.lines().skip(1).collect();
    assert!(rows.len() > 1000);
    for (step, row) in rows.iter().enumerate() {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(cells, [step as f64 / 3.0, step as f64]);
    }
}

#[test]
fn a_compressed_table_has_the_rows_of_a_plain_one_and_is_read_up_to_its_last_member() {
    let folder = tempfile::tempdir().unwrap();
    let [plain, packed] = ["a.csv", "a.csv.gz"].map(|name| folder.path().join(name));
    let read = |path: &Path| {
        let (mut text, file) = (String::new(), std::fs::File::open(path).unwrap());
        let outcome = flate2::read::MultiGzDecoder::new(file).read_to_string(&mut text);
        (text, outcome.is_ok())
    };
    let row = |k: usize| [k as f64, (k as f64).sqrt()];
    let push = |table: &mut History, rows: std::ops::Range<usize>| {
        rows.for_each(|k| table.push(&row(k)).unwrap());
    };
    let names = ["time_s", "root"];
    let mut tables = [&plain, &packed].map(|path| History::create(path, &names).unwrap());
    let [_, kept] = tables.each_mut().map(|table| {
        push(table, 0..500);
        table.sync().unwrap()
    });
    let half = std::fs::read_to_string(&plain).unwrap();
    assert_eq!(read(&packed), (half.clone(), true));
    // a kill in the middle of a write leaves a part of a member
    push(&mut tables[1], 500..900);
    tables[1].flush().unwrap();
    let whole = std::fs::read(&packed).unwrap();
    assert!(whole.len() as u64 > kept && whole.len() < half.len());
    std::fs::write(&packed, &whole[..whole.len() - 9]).unwrap();
    let (text, complete) = read(&packed);
    assert!(!complete && text.starts_with(&half));
    // cut back to the checkpoint, it goes on like the plain one
    let mut table = History::go_on(&packed, 2, kept).unwrap();
    for table in [&mut table, &mut tables[0]] {
        push(table, 500..1000);
        table.flush().unwrap();
    }
    let text = std::fs::read_to_string(&plain).unwrap();
    assert_eq!(text.lines().count(), 1001);
    assert_eq!(read(&packed), (text, true));
}
