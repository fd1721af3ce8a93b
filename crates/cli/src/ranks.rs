//! The processes of a run that `mpirun` has started, if it has.

use carom_ranks::Ranks;

use crate::exit::{BAD_INPUT, FAILED};
use crate::terminal::{be_silent, err};

/// Variables by which starters of processes tell each of them that there are several: Open MPI, PMIx, MPICH and Intel MPI.
const STARTED: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"];

/// Whether a starter of MPI has started this process.
fn is_started() -> bool {
    STARTED.iter().any(|name| std::env::var_os(name).is_some())
}

/// Whether a starter of MPI has started this process, and says that it is not the first one.
pub fn is_another() -> bool {
    let ranks = ["OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"];
    let mut ranks = ranks.iter().filter_map(|name| std::env::var(name).ok());
    is_started() && ranks.next().is_some_and(|rank| rank != "0")
}

/// Gives `work` the ranks of this run: one, unless `mpirun` has started several. The others than the first tell nothing; `takes`: whether
/// the command goes on several.
pub fn with_ranks(takes: bool, work: impl FnOnce(&Ranks) -> u8) -> u8 {
    if !is_started() {
        return work(&Ranks::alone());
    }
    begun(takes, work)
}

#[cfg(feature = "mpi")]
fn begun(takes: bool, work: impl FnOnce(&Ranks) -> u8) -> u8 {
    let Some((session, ranks)) = carom_mpi::begin() else {
        err!("error: MPI did not begin");
        return FAILED;
    };
    if !ranks.is_first() {
        be_silent();
    }
    if ranks.count() > 1 && !takes {
        err!("error: several ranks take `run` and `resume` alone");
        return BAD_INPUT;
    }
    // a rank that panics must not wait for the others at the end of MPI, nor they for it
    let told = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        told(panic);
        std::process::exit(FAILED.into());
    }));
    let code = work(&ranks);
    drop(session);
    code
}

#[cfg(not(feature = "mpi"))]
fn begun(takes: bool, work: impl FnOnce(&Ranks) -> u8) -> u8 {
    let alone = std::env::var(STARTED[0]).is_ok_and(|count| count == "1");
    if alone || !takes {
        return work(&Ranks::alone());
    }
    if is_another() {
        be_silent();
    }
    err!(
        "error: this program was built without MPI; build it with `cargo build --release --features mpi`"
    );
    BAD_INPUT
}

/// Uses as many threads in each process as it has processors for, where several share a machine; `threads`: as many as somebody asked for.
pub fn threads(ranks: &Ranks, threads: Option<std::num::NonZeroUsize>) -> Option<usize> {
    let own = threads.map(std::num::NonZeroUsize::get);
    if ranks.count() == 1 {
        return own;
    }
    let here = std::env::var("OMPI_COMM_WORLD_LOCAL_SIZE").ok();
    let here = here.and_then(|count| count.parse().ok());
    let here = here.unwrap_or(ranks.count()).max(1);
    let processors = std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get);
    Some(own.unwrap_or((processors / here).max(1)))
}

/// Whether all ranks have what they need; where another one has not, the first tells it.
pub fn all_have<T>(ranks: &Ranks, own: Result<T, u8>) -> Result<T, u8> {
    let text = own.as_ref().err().map(|code| code.to_string());
    match (ranks.first_text(text.as_deref()), own) {
        (_, Err(code)) => Err(code),
        (None, Ok(found)) => Ok(found),
        (Some((rank, code)), Ok(_)) => {
            err!("error: rank {rank} cannot read or build the case, which this one can");
            Err(code.parse().unwrap_or(FAILED))
        }
    }
}
