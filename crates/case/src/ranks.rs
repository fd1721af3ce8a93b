//! A run that several processes compute together.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use carom_dynamics::{Costs, Error, Observer, OnRanks, RankShare, march, why_not_on_ranks};
use carom_output::{Results, Settings, watched};
use carom_ranks::Ranks;

use crate::build::Built;
use crate::error::Problem;
use crate::input::Input;
use crate::origin::Origin;
use crate::run::{Failed, Finished, March, conclude, settings};
use crate::schema::Case;
use crate::stepping::Stepping;

/// Runs a case on several ranks, each of which has built it: the first one writes the results folder, and has the end to tell. `progress` and
/// `stop` count there alone.
///
/// # Errors
/// As [`run`](crate::run()), on all ranks: where it happened on another one, with that rank.
pub fn run_on_ranks(
    ranks: &Ranks,
    (input, case, built): (&Input, &Case, &Built),
    folder: PathBuf,
    progress: &mut dyn Observer,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Finished>, Failed> {
    let origin = Origin::of(input, case, &folder);
    let settings = settings((input, case, built), folder, &origin);
    let run = shared((ranks, built, &settings), None, &Costs::default())?;
    let results = || Results::create(settings, Arc::clone(&built.system));
    go_through((ranks, built), (run, march), results, (progress, stop))
}

/// What takes the steps together with the other ranks, from the bytes of a state or from the start.
pub(crate) fn shared(
    (ranks, built, settings): (&Ranks, &Built, &Settings),
    saved: Option<&[u8]>,
    costs: &Costs,
) -> Result<Stepping, Failed> {
    let begun = Stepping::new(built, saved).and_then(|mut run| {
        run.add_earlier(costs);
        let nodes = watched(settings, &built.system);
        let nodes = nodes.map_err(|error| Error::Observer(Box::new(error)))?;
        Ok((run, nodes))
    });
    let (mut run, nodes) = together(ranks, begun, Failed::Start)?;
    run.share(ranks, &nodes).map_err(Failed::Start)?;
    Ok(run)
}

/// Takes the steps to the end of the case, with results on the first rank.
pub(crate) fn go_through(
    (ranks, built): (&Ranks, &Built),
    (mut run, march): (Stepping, March),
    results: impl FnOnce() -> Result<Results, carom_output::Error>,
    (progress, stop): (&mut dyn Observer, &dyn Fn() -> bool),
) -> Result<Option<Finished>, Failed> {
    let now = Instant::now();
    let results = match ranks.is_first() {
        true => results().map(Some),
        false => Ok(None),
    };
    let Some(mut results) = together(ranks, results, Failed::Output)? else {
        let outcome = march(run.get_mut(), built.end, &mut [], &|| false);
        busiest(ranks, &run);
        return outcome.map(|_| None).map_err(Failed::Step);
    };
    let observers: &mut [&mut dyn Observer] = &mut [&mut results, progress];
    let outcome = march(run.get_mut(), built.end, observers, stop);
    let share = busiest(ranks, &run);
    let zones = run.zones(built);
    let finished = conclude((results, outcome), (run.get(), zones), (now, built.end))?;
    Ok(Some(Finished {
        ranks: Some(share),
        ..finished
    }))
}

/// The most that a rank has and sends.
fn busiest(ranks: &Ranks, run: &Stepping) -> RankShare {
    let own = run.rank_share().unwrap_or_default();
    let counts = [
        own.elements as u64,
        own.nodes as u64,
        own.halo_bytes,
        own.sent_bytes,
    ];
    let mut most = counts.map(|count| count as f64);
    ranks.reduce(&mut [], &mut most);
    RankShare {
        elements: most[0] as usize,
        nodes: most[1] as usize,
        halo_bytes: most[2] as u64,
        sent_bytes: most[3] as u64,
    }
}

/// What all ranks have found, or the error of the first that has found none.
fn together<T, E: std::error::Error>(
    ranks: &Ranks,
    own: Result<T, E>,
    failed: impl FnOnce(E) -> Failed,
) -> Result<T, Failed> {
    let text = own.as_ref().err().map(E::to_string);
    match (ranks.first_text(text.as_deref()), own) {
        (_, Err(error)) => Err(failed(error)),
        (None, Ok(found)) => Ok(found),
        (Some((rank, cause)), Ok(_)) => Err(Failed::Start(Error::OnRank { rank, cause })),
    }
}

/// What of a case several ranks do not take, if anything.
pub fn refused_on_ranks(case: &Case, built: &Built) -> Option<Problem> {
    let one = "one process, with as many threads as the machine has";
    if built.zoned.is_some() {
        let problem = Problem::new("zone", "several ranks take no zones");
        return Some(problem.accepted([one]));
    }
    let why = why_not_on_ranks(&built.system)?;
    let path = match &why {
        OnRanks::Scheme => "time.scheme".to_owned(),
        OnRanks::StaticStage => "time.static".to_owned(),
        OnRanks::Links => "tie".to_owned(),
        OnRanks::Damping => match case.body.iter().find(|(_, body)| body.damping.is_some()) {
            Some((name, _)) => format!("body.{name}.damping"),
            None => "dashpot".to_owned(),
        },
        OnRanks::Body(name) | OnRanks::Share(name, _) => format!("body.{name}"),
        OnRanks::Follower => "load".to_owned(),
        OnRanks::Contact(name) => format!("contact.{name}"),
    };
    let problem = Problem::new(path, format!("several ranks take no {why}"));
    Some(match why {
        OnRanks::Scheme => problem.accepted(["central-difference", one]),
        _ => problem.accepted([one]),
    })
}
