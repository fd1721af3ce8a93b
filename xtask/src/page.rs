//! Reports in a real browser: no error on the console, every plot drawn and its texts sound, the model moves, is coloured, marked and cut, and a
//! browser without WebGL shows the static figures; pages of a comparison and a study, which fit narrow windows too.
//!
//! Where no browser is installed the check says so and is left out. `report/check.js` does what a reader does, inside of a copy of the page;
//! nothing but the browser is needed.

use std::fs;
use std::path::Path;
use std::process::Command;

/// Names under which the browser may be installed.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Cases of seconds: in one dimension, a linear solid on an obstacle, beams, friction in the plane with large strain, many contacts.
const CASES: [&str; 5] = [
    "two-bars",
    "block-drop",
    "beam-on-stop",
    "rolling-rod",
    "assembly-row",
];

/// The case that is opened once more without WebGL.
const WITHOUT: &str = "block-drop";

/// A comparison with curves that hide the others, and a study.
const TABLES: [&[&str]; 2] = [
    &[
        "compare",
        "cases/two-bars/case.toml",
        "--with",
        "theta",
        "newmark",
        "--law",
        "velocity",
    ],
    &[
        "study",
        "cases/two-bars/case.toml",
        "--vary",
        "time.step.courant=1,0.5",
    ],
];

/// Draws the model by the processor.
const WEBGL: [&str; 3] = [
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
];

/// Longest page, bytes.
const BYTES: usize = 5_000_000;

/// Watches for errors from the first line of the page on.
const WATCH: &str = "<script>window.faults = [];
addEventListener(\"error\", (e) => faults.push(`error: ${e.message}`));
addEventListener(\"unhandledrejection\", (e) => faults.push(`rejection: ${e.reason}`));
console.error = (...all) => faults.push(`console: ${all.join(\" \")}`);
window.written = [];
const write = CanvasRenderingContext2D.prototype.fillText;
CanvasRenderingContext2D.prototype.fillText = function (text, ...all) { written.push(`${text}`); write.call(this, text, ...all); };
</script>";

const FLAGS: [&str; 11] = [
    "--headless=new",
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1200,900",
    "--virtual-time-budget=20000",
    "--timeout=60000",
    "--dump-dom",
];

/// What is wrong with the reports of the cases.
pub fn check(root: &Path) -> Vec<String> {
    let Some(browser) = BROWSERS.into_iter().find(|name| is_there(name)) else {
        println!(
            "LEFT OUT: no browser is installed ({})",
            BROWSERS.join(", ")
        );
        return Vec::new();
    };
    let mut problems = Vec::new();
    let cases = CASES.map(|case| (case, of_case(root, browser, case)));
    let tables = TABLES.map(|arguments| (arguments[0], of_table(root, browser, arguments)));
    for (name, outcome) in cases.into_iter().chain(tables) {
        if let Err(problem) = outcome {
            problems.push(format!("{name}: {problem}"));
        }
    }
    problems
}

fn is_there(browser: &str) -> bool {
    let output = Command::new(browser).arg("--version").output();
    output.is_ok_and(|output| output.status.success())
}

fn of_case(root: &Path, browser: &str, case: &str) -> Result<(), String> {
    let folder = root.join("target/page");
    let results = folder.join(format!("{case}.carom"));
    let input = format!("cases/{case}/case.toml");
    let page = made(root, &["run", "--quiet", &input], &results)?;
    println!("{case}: {} kB", page.len() / 1000);
    let script = read(&root.join("report/check.js"))?;
    let with = script.replace("WITHOUT_WEBGL", "false");
    open((browser, &WEBGL), (&folder, case), &page, &with)?;
    match case == WITHOUT {
        true => {
            let script = script.replace("WITHOUT_WEBGL", "true");
            let outcome = open(
                (browser, &["--disable-3d-apis"]),
                (&folder, case),
                &page,
                &script,
            );
            outcome.map_err(|problem| format!("without WebGL: {problem}"))
        }
        false => Ok(()),
    }
}

/// The page of a comparison or a study, in a wide and in a narrow window.
fn of_table(root: &Path, browser: &str, arguments: &[&str]) -> Result<(), String> {
    let folder = root.join("target/page");
    let name = arguments[0];
    let page = made(root, arguments, &folder.join(format!("{name}.carom")))?;
    println!("{name}: {} kB", page.len() / 1000);
    let script = read(&root.join("report/check.js"))?.replace("WITHOUT_WEBGL", "false");
    for window in ["--window-size=1200,900", "--window-size=500,900"] {
        let flags = [&WEBGL[..], &[window]].concat();
        open((browser, &flags), (&folder, name), &page, &script)
            .map_err(|problem| format!("{window}: {problem}"))?;
    }
    Ok(())
}

/// The page that a command of the program writes.
fn made(root: &Path, arguments: &[&str], results: &Path) -> Result<String, String> {
    let status = Command::new("cargo")
        .args(["run", "--release", "--quiet", "--"])
        .args(arguments)
        .arg("--results")
        .arg(results)
        .current_dir(root)
        .stdout(std::process::Stdio::null())
        .status()
        .map_err(|cause| format!("cargo cannot be started: {cause}"))?;
    if !status.success() {
        return Err(format!("the run failed: {status}"));
    }
    let page = read(&results.join("report.html"))?;
    match page.len() > BYTES {
        true => Err(format!(
            "its page has {} bytes; at most {BYTES}",
            page.len()
        )),
        false => Ok(page),
    }
}

/// Opens a copy of the page that tries itself, and reads what it found.
fn open(
    (browser, flags): (&str, &[&str]),
    (folder, case): (&Path, &str),
    page: &str,
    script: &str,
) -> Result<(), String> {
    let copy = folder.join(format!("{case}.html"));
    let watched = page.replacen("<head>", &format!("<head>{WATCH}"), 1);
    let tried = format!("<script>{script}</script>\n</body>");
    fs::write(&copy, watched.replace("</body>", &tried)).map_err(|cause| cause.to_string())?;
    let profile = folder.join("profile");
    // a profile that is left over may be locked
    let _ = fs::remove_dir_all(&profile);
    let output = Command::new(browser)
        .args(FLAGS)
        .args(flags)
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}", copy.display()))
        .output()
        .map_err(|cause| format!("{browser} cannot be started: {cause}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let outcome = text.split_once("<pre id=\"outcome\">");
    let outcome = outcome.and_then(|(_, rest)| rest.split_once("</pre>"));
    match outcome {
        Some(("GOOD", _)) => Ok(()),
        Some((problems, _)) => Err(problems.replace('\n', "; ")),
        None => Err("the page did not end its own check".to_owned()),
    }
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|cause| format!("{}: {cause}", path.display()))
}
