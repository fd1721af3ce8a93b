//! The measured tables and the picture of the chapter "Which scheme should I use?": `cargo xtask chapter` makes them anew.

use std::fs;
use std::path::Path;
use std::process::Command;

/// Time schemes of the table, as `carom compare --with` takes them.
const SCHEMES: [&str; 18] = [
    "theta",
    "theta={theta=0.6}",
    "theta={theta=1.0}",
    "newmark",
    "newmark={beta=0.49,gamma=0.9}",
    "central-difference",
    "generalised-alpha={rho-inf=0.8}",
    "tchamwa-wielgosz",
    "nonsmooth-alpha",
    "nonsmooth-alpha={rho-inf=0.0}",
    "krenk",
    "paoli-schatzman",
    "paoli-schatzman={restitution=0.5}",
    "laursen-chawla",
    "laursen-love",
    "kane",
    "contact-stabilised",
    "bathe",
];

/// Contact laws of the table.
const LAWS: [&str; 4] = [
    "velocity",
    "displacement",
    "displacement={projection=true}",
    "damped",
];

/// Schemes of the picture: few enough to be told apart.
const DRAWN: [&str; 3] = [
    "theta",
    "newmark={beta=0.49,gamma=0.9}",
    "central-difference",
];

/// Columns of the table: name in the file, title, factor.
const COLUMNS: [(&str, &str, f64); 6] = [
    ("force_error", "force error, %", 100.0),
    ("overshoot", "overshoot of a step, %", 100.0),
    ("status_changes", "changes of status", 1.0),
    ("energy_change", "energy, %", 100.0),
    ("restitution", "restitution", 1.0),
    ("persistency_defect_j", "persistency defect, J", 1.0),
];

/// Examples of the verification crate that print a table, and its file.
const EXAMPLES: [(&str, &str); 4] = [
    ("long_run", "long-run.md"),
    ("rings", "rings.md"),
    ("combinations", "combinations.md"),
    ("pairs", "pairs.md"),
];

/// Writes `docs/tables` and the picture; what went wrong, if anything.
pub fn write(root: &Path) -> Result<(), String> {
    let work = root.join("target/chapter");
    let tables = root.join("docs/tables");
    fs::create_dir_all(&tables).map_err(|cause| cause.to_string())?;
    compare(root, &work.join("table"), &SCHEMES, &LAWS)?;
    let csv = work.join("table/comparison.csv");
    let csv = fs::read_to_string(&csv).map_err(|cause| format!("{}: {cause}", csv.display()))?;
    save(&tables.join("schemes.md"), &table(&csv)?)?;
    compare(root, &work.join("picture"), &DRAWN, &["velocity"])?;
    let picture = fs::read_to_string(work.join("picture/plots/force.svg"))
        .map_err(|cause| cause.to_string())?;
    save(&root.join("docs/src/pictures/schemes-force.svg"), &picture)?;
    for (example, file) in EXAMPLES {
        save(&tables.join(file), &printed(root, example)?)?;
    }
    Ok(())
}

/// What an example of the verification crate prints.
fn printed(root: &Path, example: &str) -> Result<String, String> {
    let package = ["--package", "carom-verification", "--example", example];
    output(root, &[&["run", "--release"], &package[..]].concat())
}

fn save(path: &Path, text: &str) -> Result<(), String> {
    println!("{}", path.display());
    fs::write(path, text).map_err(|cause| format!("{}: {cause}", path.display()))
}

fn compare(root: &Path, results: &Path, schemes: &[&str], laws: &[&str]) -> Result<(), String> {
    let results = results.display().to_string();
    let mut arguments = vec![
        "run",
        "--release",
        "--",
        "compare",
        "cases/two-bars/case.toml",
        "--quiet",
        "--results",
        &results,
    ];
    schemes
        .iter()
        .for_each(|scheme| arguments.extend(["--with", scheme]));
    laws.iter().for_each(|law| arguments.extend(["--law", law]));
    output(root, &arguments).map(|_| ())
}

fn output(root: &Path, arguments: &[&str]) -> Result<String, String> {
    let output = Command::new("cargo")
        .args(arguments)
        .current_dir(root)
        .output()
        .map_err(|cause| cause.to_string())?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    match output.status.success() {
        true => Ok(text(&output.stdout)),
        false => Err(format!(
            "cargo {}: {}",
            arguments.join(" "),
            text(&output.stderr)
        )),
    }
}

/// The comparison as Markdown: one row a variant that ran.
fn table(csv: &str) -> Result<String, String> {
    let mut lines = csv.lines().map(fields);
    let names = lines.next().ok_or("an empty comparison")?;
    let place = |name: &str| {
        names
            .iter()
            .position(|n| n == name)
            .ok_or(format!("no column {name}"))
    };
    let columns = COLUMNS
        .iter()
        .map(|(name, ..)| place(name))
        .collect::<Result<Vec<_>, _>>()?;
    let (variant, scheme, verdict) = (place("variant")?, place("scheme")?, place("verdict")?);
    let titles: Vec<&str> = COLUMNS.iter().map(|(_, title, _)| *title).collect();
    let mut text = format!(
        "| scheme | law | {} | verdict |\n|---|---|{}---|\n",
        titles.join(" | "),
        "---|".repeat(titles.len())
    );
    for row in lines.filter(|row| row[verdict] != "refused") {
        let law = row[variant].split_once('_').map_or("", |(_, law)| law);
        let cell = |(&place, (.., factor)): (&usize, &(&str, &str, f64))| match row[place]
            .parse::<f64>()
        {
            Ok(value) => digits(value * factor),
            Err(_) => String::new(),
        };
        let cells: Vec<String> = columns.iter().zip(&COLUMNS).map(cell).collect();
        text += &format!(
            "| {} | {} | {} | {} |\n",
            row[scheme],
            law,
            cells.join(" | "),
            row[verdict]
        );
    }
    Ok(text)
}

/// Fields of a line, quoted or not.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            _ => fields
                .last_mut()
                .into_iter()
                .for_each(|field| field.push(letter)),
        }
    }
    fields
}

/// Three digits, powers of ten for the very small and the very large.
fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_string(),
        size if size < 1e5 && value.fract() == 0.0 => format!("{value:.0}"),
        size if !(1e-3..1e5).contains(&size) => format!("{value:.1e}"),
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 1.0 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_has_its_example() {
        let examples =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/verification/examples");
        for (example, _) in EXAMPLES {
            assert!(
                examples.join(example).with_extension("rs").is_file(),
                "{example}"
            );
        }
    }

    #[test]
    fn a_quoted_comma_ends_no_field() {
        assert_eq!(fields("a,\"b, c\",,d"), ["a", "b, c", "", "d"]);
    }
}
