//! What the program of the report reads: the head and the arrays of a page, decoded from their description.

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::Path;

use base64::Engine;
use serde_json::Value;

use crate::models;
use crate::runs::{columns, run};

/// The head of a page and its arrays.
struct Page {
    head: Value,
    bytes: Vec<u8>,
}

impl Page {
    fn read(folder: &Path) -> Page {
        let html = fs::read_to_string(folder.join("report.html")).unwrap();
        let element = |id: &str| {
            let (_, rest) = html.split_once(&format!("<script id=\"{id}\"")).unwrap();
            let (text, _) = rest.split_once("</script>").unwrap();
            text.split_once('>').unwrap().1.to_owned()
        };
        let compressed = base64::engine::general_purpose::STANDARD.decode(element("carom-data"));
        let mut bytes = Vec::new();
        flate2::read::DeflateDecoder::new(&compressed.unwrap()[..])
            .read_to_end(&mut bytes)
            .unwrap();
        Page {
            head: serde_json::from_str(&element("carom-page")).unwrap(),
            bytes,
        }
    }

    /// The numbers of an array.
    fn numbers(&self, array: &Value) -> Vec<f64> {
        let number = |key: &str| array[key].as_u64().unwrap() as usize;
        let (at, count, kind) = (
            number("at"),
            number("count"),
            array["type"].as_str().unwrap(),
        );
        let size = BTreeMap::from([("f32", 4), ("u32", 4), ("u16", 2), ("u8", 1)])[kind];
        let word = |k: usize| {
            let byte = |plane: usize| u64::from(self.bytes[at + plane * count + k]) << (8 * plane);
            (0..size).map(byte).sum::<u64>()
        };
        let words = (0..count).map(word);
        let modulus = 1_u64 << (8 * size);
        let mut sum = 0;
        let sums = |word: u64| {
            sum = (sum + word) % modulus;
            sum as f64
        };
        match kind {
            "f32" => words
                .map(|word| f64::from(f32::from_bits(word as u32)))
                .collect(),
            "u8" => words.map(|word| word as f64).collect(),
            _ if array["low"].is_null() => words.map(sums).collect(),
            _ => {
                let [low, high, most] =
                    ["low", "high", "most"].map(|key| array[key].as_f64().unwrap());
                words
                    .map(sums)
                    .map(|q| low + q * (high - low) / most)
                    .collect()
            }
        }
    }

    /// The curve of this name in a section.
    fn curve(&self, section: &str, name: &str) -> [Vec<f64>; 2] {
        let plots = self.head["plots"].as_array().unwrap().iter();
        let mut own = plots.filter(|plot| plot["id"] == section);
        let curves = own.next().unwrap()["curves"].as_array().unwrap();
        let curve = curves
            .iter()
            .find(|c| c["name"].as_str().unwrap().starts_with(name));
        ["x", "y"].map(|key| self.numbers(&curve.unwrap()[key]))
    }

    /// The instant that was kept for a reason.
    fn frame(&self, kind: &str) -> &Value {
        let frames = self.head["model"]["frames"].as_array().unwrap();
        let has = |frame: &&Value| frame["kinds"].as_array().unwrap().iter().any(|k| k == kind);
        frames.iter().find(has).unwrap()
    }
}

#[test]
fn the_page_of_two_bars_has_the_raw_force_and_the_instants_of_the_contact() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("bars.carom");
    let system = models::two_bars(50);
    let (dt, end) = (system.dt, 1.5 * models::duration());
    let mut settings = models::settings(&folder);
    settings.end = end;
    settings.reference = Some(models::exact(end + dt));
    settings.probes = vec![models::probe(&system, "Tip", "striker.right")];
    let (_, summary) = run(&system, settings, end);
    let page = Page::read(&folder);
    let table = columns(&folder.join("histories.csv"));
    let (times, forces) = (&table["time_s"], &table["contact.shock.force_n"]);
    let largest = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);

    // single precision: 2^-24
    let close = |a: f64, b: f64| (a - b).abs() <= 6e-8 * b.abs();
    let [x, y] = page.curve("plot-force", "raw");
    let peak = summary.contacts["shock"].peak_force;
    assert!(close(largest(&y), peak));
    let at = y.iter().position(|f| close(*f, peak)).unwrap();
    let row = forces.iter().position(|f| *f == peak).unwrap();
    assert!(close(x[at], times[row]));
    let mean = summary.contacts["shock"].peak_mean_force.unwrap();
    assert!(close(
        largest(&page.curve("plot-force", "mean over")[1]),
        mean
    ));
    let exact = summary.exact.as_ref().unwrap().peak_force;
    assert!(close(largest(&page.curve("plot-force", "exact")[1]), exact));
    let impulse = summary.contacts["shock"].impulse.unwrap();
    assert!(close(
        *page.curve("plot-impulse", "shock")[1].last().unwrap(),
        impulse
    ));

    let force_at = |frame: &Value| {
        let time = frame["time"].as_f64().unwrap();
        forces[times.iter().position(|t| *t == time).unwrap()]
    };
    let first = forces.iter().position(|f| *f > 0.0).unwrap();
    assert_eq!(
        page.frame("first closing")["time"].as_f64(),
        Some(times[first])
    );
    assert!(force_at(page.frame("largest force")) >= peak / 1.02);
    let last = forces.iter().rposition(|f| *f > 0.0).unwrap();
    assert_eq!(
        page.frame("last release")["time"].as_f64(),
        Some(times[last + 1])
    );
    let frames = page.head["model"]["frames"].as_array().unwrap();
    let equal = |f: &&Value| {
        f["kinds"]
            .as_array()
            .unwrap()
            .iter()
            .any(|k| k == "equal times")
    };
    let equal: Vec<f64> = frames
        .iter()
        .filter(equal)
        .map(|frame| frame["time"].as_f64().unwrap())
        .collect();
    // the run ends with the step that passes its end
    assert!((31..=32).contains(&equal.len()), "{}", equal.len());
    for (k, time) in equal[..31].iter().enumerate() {
        let wanted = end * k as f64 / 30.0;
        assert!(
            *time >= wanted - 1e-6 * end && *time < wanted + dt,
            "{k} {time} {wanted}"
        );
    }
}

#[test]
fn the_page_of_a_block_has_its_surface_and_the_motion_of_its_nodes() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("block.carom");
    let system = models::block(4, true);
    let mut settings = models::settings(&folder);
    settings.end = 5e-3;
    settings.probes = vec![models::probe(&system, "Bottom", "block.bottom")];
    let (reports, _) = run(&system, settings, 5e-3);
    let page = Page::read(&folder);
    let model = &page.head["model"];
    let number = |key: &str| model[key]["count"].as_u64().unwrap();
    // six sides of 16 squares in two triangles; twelve edges of four pieces, and on each side 2 · 3 · 4 pieces inside
    assert_eq!(number("triangles") / 3, 6 * 16 * 2);
    assert_eq!(number("edges") / 2, 12 * 4 + 6 * 24);
    assert_eq!(model["nodes"], 5 * 5 * 5 - 3 * 3 * 3);
    assert_eq!(model["obstacles"].as_array().unwrap().len(), 1);
    assert!(model["decimated_from"].is_null());

    let x = page.numbers(&model["x"]);
    let table = columns(&folder.join("histories.csv"));
    let (times, moved) = (&table["time_s"], &table["probe.bottom.displacement_z_m"]);
    for frame in model["frames"].as_array().unwrap() {
        let time = frame["time"].as_f64().unwrap();
        let row = times.iter().position(|t| *t == time).unwrap();
        let array = &frame["moved"][2];
        let offset = frame["offsets"][0][2].as_f64().unwrap();
        let values = page.numbers(array);
        let bottom = (0..values.len()).filter(|n| x[3 * n + 2] < 0.002);
        let bottom: Vec<f64> = bottom.map(|n| offset + values[n]).collect();
        assert_eq!(bottom.len(), 25);
        let mean = bottom.iter().sum::<f64>() / 25.0;
        // half a level of each node, and the single precision of a displacement of 25 mm at most
        let [low, high] = ["low", "high"].map(|key| array[key].as_f64().unwrap());
        let tolerance = (high - low) / 131_070.0 + 0.025 * 6e-8;
        assert!(
            (mean - moved[row]).abs() <= tolerance,
            "{time} {mean} {}",
            moved[row]
        );
        let status = page.numbers(&frame["values"]["status"]);
        let closed = status.iter().filter(|status| **status >= 2.0).count();
        assert_eq!(closed, reports[row].contacts[0].closed);
    }
    // the largest stress of all cells is that of a drawn one or of one inside, and the instant called after it has the largest of all
    let largest = |frame: &Value| {
        frame["largest"]["von_mises"]["value"]
            .as_f64()
            .unwrap_or(0.0)
    };
    for frame in model["frames"].as_array().unwrap() {
        let array = &frame["values"]["von_mises"];
        let drawn = page.numbers(array).into_iter().fold(0.0, f64::max);
        let level = array["high"].as_f64().unwrap() / array["most"].as_f64().unwrap();
        assert!(largest(frame) >= drawn - level, "{drawn}");
        assert!(largest(frame) <= largest(page.frame("largest stress")));
    }
    let place = &page.frame("largest stress")["largest"]["von_mises"]["place"];
    // the middle of one of the cells, whose sides are a quarter of the block
    let x = place
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap());
    let size = page.numbers(&model["x"]).into_iter().fold(0.0, f64::max);
    for x in x {
        let middle = 4.0 * x / size - 0.5;
        assert!((middle - middle.round()).abs() < 0.05, "{x}");
    }
}
