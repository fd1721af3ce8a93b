//! `carom run`.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use carom_case::Finished;
use carom_dynamics::RankShare;

use carom_output::summary::{Contact, Newton};
use carom_output::{Grade, Summary};
use carom_pages::plot::quantity;
use carom_ranks::Ranks;

use crate::contacts::{print_contact, print_level, print_margin};
use crate::exit::{BAD, FAILED, INTERRUPTED};
use crate::expectations;
use crate::load::{load_on, warn_of_ranks};
use crate::progress::Progress;
use crate::ranks::all_have;
use crate::signals;
use crate::terminal::{err, line, out, write_json};

/// Arguments of `carom run`.
#[derive(clap::Args)]
pub struct Arguments {
    /// The case file
    case: PathBuf,
    /// Replace a value of the case: `--set time.scheme.theta.theta=0.6`
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Results folder; default: the name of the case file with the ending `.carom`, beside it
    #[arg(long, value_name = "FOLDER")]
    results: Option<PathBuf>,
    /// Show no progress bar
    #[arg(long)]
    quiet: bool,
    /// Print `summary.json` in place of a text
    #[arg(long)]
    json: bool,
}

/// Runs a case; returns the exit code.
pub fn run(arguments: &Arguments, ranks: &Ranks) -> u8 {
    let loaded = load_on(ranks, &arguments.case, &arguments.set);
    let (input, case, locator, built) = match all_have(ranks, loaded) {
        Ok(loaded) => loaded,
        Err(code) => return code,
    };
    for warning in built.iter().flat_map(|built| &built.warnings) {
        err!("warning: {}", line(warning));
    }
    warn_of_ranks(ranks, built.as_ref());
    for (body, told) in built.iter().flat_map(|built| &built.reductions) {
        err!("{}", line(&format!("reduction of {body}: {told}")));
    }
    let folder = arguments
        .results
        .clone()
        .unwrap_or_else(|| arguments.case.with_extension("carom"));
    let quiet = arguments.quiet || !ranks.is_first();
    let ended = until_stopped(case.time.end.0, quiet, |progress, stop| {
        let folder = folder.clone();
        match (built, ranks.count()) {
            (Some(built), 1) => {
                let case = (&input, &case, &built);
                carom_case::run(case, folder, progress, stop).map(Some)
            }
            (built, _) => {
                let read = (&input, &case, &locator);
                carom_case::run_on_ranks(ranks, read, built, folder, progress, stop)
            }
        }
    });
    end(ended, &folder, arguments.json)
}

/// Tells how a run ended, by its summary as JSON if `json` says so; returns the exit code. Another rank than the first has nothing to tell.
pub fn end(ended: Result<Option<Finished>, carom_case::Failed>, folder: &Path, json: bool) -> u8 {
    match ended {
        Ok(None) => 0,
        Ok(Some(finished)) => {
            match json.then(|| finished.summary.to_json()) {
                None => {
                    print(&finished.summary, folder);
                    if let Some(share) = &finished.ranks {
                        out!("  {}", busiest(share));
                    }
                }
                Some(Ok(text)) => write_json(&text),
                Some(Err(error)) => {
                    err!("error: {error}");
                    return FAILED;
                }
            }
            if finished.interrupted {
                err!("interrupted; `carom resume {}` goes on", folder.display());
            }
            match (finished.interrupted, finished.summary.verdict.grade) {
                (true, _) => INTERRUPTED,
                (false, Grade::Good | Grade::Look) => 0,
                (false, Grade::Bad) => BAD,
            }
        }
        Err(error) => {
            tell(&error, folder);
            FAILED
        }
    }
}

/// A run up to a simulated time (s) with its progress on the terminal, which Ctrl-C, SIGTERM and SIGHUP stop within the step under way; on
/// several ranks before the next one.
pub fn until_stopped<T>(
    until: f64,
    quiet: bool,
    run: impl FnOnce(&mut Progress, &dyn Fn() -> bool) -> T,
) -> T {
    let interrupt = signals::interrupt("a summary");
    let hidden = quiet || !std::io::stderr().is_terminal();
    let mut progress = Progress::new(until, hidden, interrupt.clone());
    run(&mut progress, &|| interrupt.is_set())
}

/// The summary for people: forces, impulses, energy, verdict, where to look.
fn print(summary: &Summary, folder: &Path) {
    out!("{}", line(&summary.title));
    let time = &summary.time;
    let [smallest, largest] = [time.smallest_step, time.largest_step].map(|s| quantity(s, "s"));
    let sizes = match smallest == largest {
        true => largest,
        false => format!("{smallest} to {largest}"),
    };
    let causes = [
        (time.rejected.closing, "a contact closed"),
        (time.rejected.passage, "a point passed what it faces"),
        (time.rejected.energy_growth, "energy grew"),
        (time.rejected.failure, "there was no solution"),
    ];
    let causes: Vec<String> = causes
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, cause)| format!("{count} because {cause}"))
        .collect();
    let rejected = match causes.is_empty() {
        true => String::new(),
        false => format!("; attempts rejected: {}", causes.join(", ")),
    };
    out!(
        "  {} steps of {sizes} to {}{rejected}",
        time.steps,
        quantity(time.end, "s")
    );
    if let Some(zones) = &summary.zones {
        for zone in &zones.zones {
            out!(
                "  zone {}: {}, {} per outer step, step {}, {} unknowns",
                zone.name,
                zone.scheme,
                zone.substeps,
                quantity(zone.step, "s"),
                zone.unknowns
            );
        }
        let passes = match zones.passes_per_step {
            Some(passes) => format!(", {passes:.2} passes a step"),
            None => String::new(),
        };
        let rows = zones.links.iter().map(|link| link.rows).sum::<usize>();
        if rows > 0 {
            let work = quantity(zones.work_of_links, "J");
            out!("  links: {rows} constraints, work {work}{passes}");
        }
    }
    // contacts that are judged together are told together
    let together = summary
        .levels
        .values()
        .filter(|level| level.contacts.len() > 1);
    let together: Vec<&String> = together.flat_map(|level| &level.contacts).collect();
    for (name, level) in &summary.levels {
        print_level(name, level);
    }
    for check in &summary.allowables {
        let of = format!("{} of {} {}", check.quantity, check.kind, check.name);
        print_margin("  ", &of, (&check.margin, &check.unit));
    }
    let alone = summary.contacts.iter();
    let alone = alone.filter(|(name, _)| !together.contains(name));
    // of many contacts those that never closed share a line
    let many = summary.contacts.len() > MANY;
    let is_idle = |contact: &Contact| many && contact.first_closing.is_none();
    for (name, contact) in alone.clone().filter(|(_, contact)| !is_idle(contact)) {
        print_contact(name, contact);
    }
    let idle: Vec<&str> = alone
        .filter(|(_, contact)| is_idle(contact))
        .map(|(name, _)| name.as_str())
        .collect();
    if !idle.is_empty() {
        let further = match idle.len().saturating_sub(MANY) {
            0 => String::new(),
            count => format!(" and {count} more"),
        };
        let names = &idle[..idle.len().min(MANY)];
        out!("  never closed: contacts {}{further}", names.join(", "));
    }
    if let Some(exact) = &summary.exact {
        let percent = |error: Option<f64>| {
            error.map_or("-".to_string(), |error| format!("{:+.2} %", 100.0 * error))
        };
        out!("  against the exact solution `{}`:", exact.name);
        out!(
            "    force {} (L2), peak of the mean {}, impulse {}, displacement {} (L2)",
            percent(exact.force_error),
            percent(exact.mean_overshoot),
            percent(Some(exact.impulse_error)),
            percent(exact.displacement_error)
        );
    }
    if let Some(newton) = &summary.newton {
        out!("  {}", iterations(newton));
    }
    let terms = further(summary);
    if !terms.is_empty() {
        out!("  {}", terms.join(", "));
    }
    let angular = match &summary.momentum.angular {
        Some(angular) => format!(", {:.1e} of angular momentum", angular.relative_residual),
        None => String::new(),
    };
    out!(
        "  the equations are solved to {:.1e} of energy, {:.1e} of momentum{angular}{}",
        summary.energy.relative_residual,
        summary.momentum.relative_residual,
        of_scheme(summary)
    );
    for notice in &summary.notices {
        out!("  note: {}", line(notice));
    }
    out!("  {}", cost(summary));
    if let Some(found) = &summary.expectations {
        expectations::print(found);
    }
    out!("  {}", verdict(summary));
    out!("  report: {}", folder.join("report.html").display());
    out!("  figures: {}", folder.join("plots").display());
}

/// What the busiest of several ranks had and sent.
fn busiest(share: &RankShare) -> String {
    let RankShare {
        elements,
        nodes,
        points,
        looked_points,
        contact_shares,
        halo_bytes,
        sent_bytes,
        shared_nodes: shared,
    } = share;
    if *elements == 0 {
        return format!("ranks: {:.3} MB sent by each", *sent_bytes as f64 / 1e6);
    }
    let by = match (shared.by_graph, shared.is_by_graph()) {
        (Some(by_graph), true) => {
            format!(
                "Scotch ({by_graph} shared nodes, {} by planes)",
                shared.by_planes
            )
        }
        (Some(by_graph), false) => {
            format!(
                "planes ({} shared nodes, {by_graph} by Scotch)",
                shared.by_planes
            )
        }
        (None, _) => format!("planes ({} shared nodes)", shared.by_planes),
    };
    let looked = match looked_points < points || *contact_shares > 1 {
        true => format!(
            " (at most {looked_points} near something at a time, shared out {contact_shares} times)"
        ),
        false => String::new(),
    };
    format!(
        "ranks: at most {elements} elements, {nodes} nodes and {points} contact points{looked} each, shared out by {by}; {halo_bytes} bytes sent a step and {:.3} MB in all",
        *sent_bytes as f64 / 1e6
    )
}

/// Contacts from which on those that never closed are not told one by one.
const MANY: usize = 6;

/// What the scheme itself took from the energy, or made.
fn of_scheme(summary: &Summary) -> String {
    let energy = &summary.energy;
    let taken = energy.dissipations.get("scheme").copied().unwrap_or(0.0);
    if !energy.identity || energy.largest == 0.0 || taken == 0.0 {
        return String::new();
    }
    let verb = if taken > 0.0 { "took" } else { "made" };
    let share = (taken / energy.largest).abs();
    format!("; the scheme {verb} {share:.1e} of the largest energy")
}

/// The error and those of its causes that it does not already say; where the results so far are.
fn tell(error: &carom_case::Failed, folder: &Path) {
    let mut said = error.to_string();
    err!("error: {}", line(&said));
    let mut cause: &dyn std::error::Error = error;
    while let Some(source) = cause.source() {
        let text = source.to_string();
        if !said.contains(&text) {
            err!("  because: {}", line(&text));
            said = text;
        }
        cause = source;
    }
    if let carom_case::Failed::Step(_) = error {
        err!("the results so far are in {}", folder.display());
    }
}

/// What Newton's method took.
fn iterations(newton: &Newton) -> String {
    let halves = match newton.halvings {
        0 => String::new(),
        1 => ", 1 halving".to_string(),
        count => format!(", {count} halvings"),
    };
    format!(
        "{} Newton iterations, {:.2} a step, at most {}; {:.2} factorisations a step{halves}",
        newton.iterations,
        newton.iterations_per_step,
        newton.most_iterations,
        newton.factorisations_per_step
    )
}

/// The terms of the energy balance that only some runs have: works positive when the bodies gain, losses positive.
fn further(summary: &Summary) -> Vec<String> {
    let energy = &summary.energy;
    let work = |name: &str| energy.works.get(name).map(|work| (name.to_string(), *work));
    let works = ["supports", "obstacles"].into_iter().filter_map(work);
    let joules = |value: f64| quantity(energy.shown(value), "J");
    let works = works.map(|(name, work)| format!("work of {name} {}", joules(work)));
    let lost = energy
        .dissipations
        .iter()
        .filter(|(name, _)| *name != "scheme");
    let lost = lost.map(|(name, lost)| format!("dissipated ({name}) {}", joules(*lost)));
    let stored = energy.stored.get("hardening").map(|kept| joules(*kept));
    let stored = stored.map(|kept| format!("stored (hardening) {kept}"));
    works.chain(lost).chain(stored).collect()
}

/// Factorisations, memory, time per step.
fn cost(summary: &Summary) -> String {
    let counts = &summary.counts;
    let megabytes = |bytes: u64| format!("{:.3} MB", bytes as f64 / 1e6);
    let factor = match counts.factorisations {
        0 if counts.matrix_products > 0 => {
            format!(
                "no factor, {} products with the matrix",
                counts.matrix_products
            )
        }
        0 => "no factorisation".to_string(),
        1 => format!(
            "1 factorisation for the run, {}",
            megabytes(counts.factor_bytes)
        ),
        n => format!(
            "{n} factorisations for the run, {}",
            megabytes(counts.factor_bytes)
        ),
    };
    let step = match summary.timings.get("per step") {
        Some(&time) => format!("{} a step", quantity(time, "s")),
        None => "no step taken".to_string(),
    };
    format!(
        "{factor}; {} contact columns, {}; {step}",
        counts.contact_columns,
        megabytes(counts.compliance_bytes)
    )
}

/// The grade, the lines that are not good, and what could not be checked.
fn verdict(summary: &Summary) -> String {
    let verdict = &summary.verdict;
    let head = match verdict.grade {
        Grade::Good => "verdict: good, every line within its bounds".to_string(),
        Grade::Look => "verdict: LOOK".to_string(),
        Grade::Bad => "verdict: BAD".to_string(),
    };
    let unfinished = verdict.unfinished.iter().map(|why| format!("bad: {why}"));
    let of = |grade: Grade| verdict.lines.iter().filter(move |line| line.grade == grade);
    let lines = of(Grade::Bad).chain(of(Grade::Look));
    let lines = lines.map(|line| format!("{}: {}", line.grade.word(), line.text()));
    let unchecked = verdict.unchecked.iter();
    let unchecked = unchecked.map(|what| format!("not checked: {what}"));
    let all = unfinished.chain(lines).chain(unchecked);
    std::iter::once(head)
        .chain(all)
        .collect::<Vec<_>>()
        .join("\n    ")
}
