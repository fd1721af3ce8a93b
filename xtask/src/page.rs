//! Reports in a real browser: no error on the console, every plot drawn, the model turns, moves and is cut, and a browser without
//! WebGL shows the static figures.
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

/// Longest page, bytes.
const BYTES: usize = 5_000_000;

/// Watches for errors from the first line of the page on.
const WATCH: &str = "<script>window.faults = [];
addEventListener(\"error\", (e) => faults.push(`error: ${e.message}`));
addEventListener(\"unhandledrejection\", (e) => faults.push(`rejection: ${e.reason}`));
console.error = (...all) => faults.push(`console: ${all.join(\" \")}`);
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
    for case in CASES {
        if let Err(problem) = of_case(root, browser, case) {
            problems.push(format!("{case}: {problem}"));
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
    let status = Command::new("cargo")
        .args([
            "run",
            "--release",
            "--quiet",
            "--",
            "run",
            "--quiet",
            &input,
            "--results",
        ])
        .arg(&results)
        .current_dir(root)
        .stdout(std::process::Stdio::null())
        .status()
        .map_err(|cause| format!("cargo cannot be started: {cause}"))?;
    if !status.success() {
        return Err(format!("the run failed: {status}"));
    }
    let page = read(&results.join("report.html"))?;
    if page.len() > BYTES {
        return Err(format!(
            "its page has {} bytes; at most {BYTES}",
            page.len()
        ));
    }
    println!("{case}: {} kB", page.len() / 1000);
    let script = read(&root.join("report/check.js"))?;
    let webgl = [
        "--use-gl=angle",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
    ];
    open(
        (browser, &webgl),
        (&folder, case),
        &page,
        &script.replace("WITHOUT_WEBGL", "false"),
    )?;
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
