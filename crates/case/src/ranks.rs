//! A run that several processes compute together.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use carom_dynamics::{
    Alike, Costs, Driver, Error, Observer, Outcome, RankShare, march, why_not_on_ranks,
};
use carom_output::checkpoint::Checkpoint;
use carom_output::{Pieces, Results, Settings, watched};
use carom_ranks::Ranks;

use crate::error::Problem;
use crate::input::Input;
use crate::locate::Locator;
use crate::lower::{self, Built, model};
use crate::origin::Origin;
use crate::run::{Failed, Finished, March, conclude, settings};
use crate::schema::Case;
use crate::stepping::Stepping;

/// Runs a case on several ranks, each of which has read it, and the first one `built` it: that writes the results folder, and has the end to tell.
/// `progress` and `stop` count there alone. The others build their parts of the system where ranks share the elements, and all of it where not.
///
/// # Errors
/// As [`run`](crate::run()), on all ranks: where it happened on another one, with that rank.
pub fn run_on_ranks(
    ranks: &Ranks,
    read: (&Input, &Case, &Locator),
    built: Option<Built>,
    folder: PathBuf,
    progress: &mut dyn Observer,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Finished>, Failed> {
    let (input, case, _) = read;
    let origin = Origin::of(input, case, &folder);
    let begun = begin((ranks, read), built, (folder, &origin), None)?;
    let system = Arc::clone(&begun.built.system);
    let results = |settings| Results::create(settings, system);
    go_through(ranks, begun, march, (results, None), (progress, stop))
}

/// A run that has begun on a rank.
pub(crate) struct Begun {
    run: Stepping,
    /// The case as built; on other ranks than the first, where these share the elements, with their part of the system.
    pub(crate) built: Built,
    settings: Settings,
}

/// Begins a run on several ranks, from the bytes of a state and what the run has cost up to it, or from the start.
pub(crate) fn begin(
    (ranks, read): (&Ranks, (&Input, &Case, &Locator)),
    built: Option<Built>,
    (folder, origin): (PathBuf, &Origin),
    saved: Option<(Vec<u8>, Costs)>,
) -> Result<Begun, Failed> {
    let (input, case, locator) = read;
    let (saved, costs) = saved.unzip();
    let settings = |built: &Built| settings((input, case, built), folder, origin);
    let refused = |problems: Vec<Problem>| {
        let first = problems.first().map(|problem| problem.message.clone());
        Error::Observer(first.unwrap_or_default().into())
    };
    let (mut run, built, mut settings) = match (share_elements(ranks, built.as_ref()), built) {
        (true, Some(built)) => {
            let settings = settings(&built);
            let watched = watched(&settings, &built.system);
            let watched = watched.map_err(|error| Error::Observer(Box::new(error)));
            let watched = together(ranks, watched, Failed::Start)?;
            let system = Arc::clone(&built.system);
            let driver = Driver::on_ranks(system, saved.as_deref(), ranks, &watched);
            let driver = together(ranks, driver, Failed::Start)?;
            (Stepping::One(Box::new(driver)), built, settings)
        }
        (true, None) => {
            // the first rank has the state
            drop(saved);
            let model = model(case, locator, input).map_err(refused);
            let model = together(ranks, model, Failed::Start)?;
            let (driver, system) = together(ranks, Driver::beside(model, ranks), Failed::Start)?;
            let built = Built::beside(system, case.time.end.0);
            let settings = settings(&built);
            (Stepping::One(Box::new(driver)), built, settings)
        }
        (false, built) => {
            let built = match built {
                Some(built) => Ok(built),
                None => lower::built(case, locator, (input, true), &[]).map_err(refused),
            };
            let built = together(ranks, built, Failed::Start)?;
            let settings = settings(&built);
            let run = Stepping::alike(&built, saved.as_deref(), ranks);
            (together(ranks, run, Failed::Start)?, built, settings)
        }
    };
    run.add_earlier(&costs.unwrap_or_default());
    settings.piece = run.piece(ranks);
    Ok(Begun {
        run,
        built,
        settings,
    })
}

/// Whether ranks share the elements of a case, which the first one has built.
fn share_elements(ranks: &Ranks, built: Option<&Built>) -> bool {
    let shares = built.is_some_and(|built| whole_on_ranks(built).is_none());
    let mut said = vec![f64::from(shares && ranks.count() > 1)];
    ranks.broadcast(&mut said);
    said[0] != 0.0
}

/// Takes the steps to the end of the case, with results on the first rank, and pieces of the fields on the others; from a `checkpoint` or from the
/// start.
pub(crate) fn go_through(
    ranks: &Ranks,
    begun: Begun,
    march: March,
    (results, checkpoint): (
        impl FnOnce(Settings) -> Result<Results, carom_output::Error>,
        Option<&Checkpoint>,
    ),
    (progress, stop): (&mut dyn Observer, &dyn Fn() -> bool),
) -> Result<Option<Finished>, Failed> {
    let Begun {
        mut run,
        built,
        settings,
    } = begun;
    let now = Instant::now();
    let system = Arc::clone(&built.system);
    let observer = match ranks.is_first() {
        true => results(settings).map(|results| Written::Results(Box::new(results))),
        false => match checkpoint {
            Some(checkpoint) => Pieces::resume(&settings, system, checkpoint),
            None => Ok(Pieces::create(&settings, system)),
        }
        .map(|pieces| Written::Pieces(pieces.map(Box::new))),
    };
    let mut results = match together(ranks, observer, Failed::Output)? {
        Written::Results(results) => results,
        Written::Pieces(mut pieces) => {
            let pieces = pieces
                .as_deref_mut()
                .map(|pieces| pieces as &mut dyn Observer);
            let observers: &mut [&mut dyn Observer] = &mut Vec::from_iter(pieces);
            let outcome = take((ranks, &mut run), march, built.end, (observers, &|| false));
            let outcome = together(ranks, outcome, Failed::Step);
            busiest(ranks, &run);
            return outcome.map(|_| None);
        }
    };
    let observers: &mut [&mut dyn Observer] = &mut [&mut *results, progress];
    let outcome = take((ranks, &mut run), march, built.end, (observers, stop));
    // what has failed at the end of another rank has failed here too
    let text = outcome.as_ref().err().map(Error::to_string);
    let outcome = match (ranks.first_text(text.as_deref()), outcome) {
        (Some((rank, cause)), Ok(_)) => Err(Error::OnRank { rank, cause }),
        (_, own) => own,
    };
    let share = busiest(ranks, &run);
    let zones = run.zones(&built);
    let finished = conclude((*results, outcome), (run.get(), zones), (now, built.end))?;
    Ok(Some(Finished {
        ranks: Some(share),
        ..finished
    }))
}

/// What a rank writes.
enum Written {
    Results(Box<Results>),
    Pieces(Option<Box<Pieces>>),
}

/// Takes the steps: of a run whose elements ranks do not share each rank takes all.
fn take(
    (ranks, run): (&Ranks, &mut Stepping),
    march: March,
    end: f64,
    (observers, stop): (&mut [&mut dyn Observer], &dyn Fn() -> bool),
) -> Result<Outcome, Error> {
    match run.rank_share() {
        Some(_) => march(run.get_mut(), end, observers, stop),
        None => march(&mut Alike::new(run.get_mut(), ranks), end, observers, stop),
    }
}

/// The most that a rank has and sends.
fn busiest(ranks: &Ranks, run: &Stepping) -> RankShare {
    let own = run.rank_share().unwrap_or_default();
    let counts = [
        own.elements as u64,
        own.nodes as u64,
        own.points as u64,
        own.looked_points as u64,
        own.contact_shares as u64,
        own.halo_bytes,
        ranks.sent_bytes(),
    ];
    let mut most = counts.map(|count| count as f64);
    ranks.reduce(&mut [], &mut most);
    RankShare {
        elements: most[0] as usize,
        nodes: most[1] as usize,
        points: most[2] as usize,
        looked_points: most[3] as usize,
        contact_shares: most[4] as usize,
        halo_bytes: most[5] as u64,
        sent_bytes: most[6] as u64,
        shared_nodes: own.shared_nodes,
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

/// What several ranks do not share of a case, in words; none if they share its elements.
pub fn whole_on_ranks(built: &Built) -> Option<String> {
    let why = match built.zoned {
        Some(_) => "zones".to_owned(),
        None => why_not_on_ranks(&built.system)?.to_string(),
    };
    Some(format!(
        "each rank computes all elements and contacts: ranks share none with {why}; where steps have iterations (`time.solver`), they share the rows of their matrices, tangents and products"
    ))
}
