//! Messages over MPI. Nothing else names it.

use std::sync::Arc;

#[cfg(feature = "petsc")]
use carom_ranks::{Engine, Graph, OwnRows};
use mpi::Threading;
use mpi::collective::SystemOperation;
use mpi::datatype::PartitionMut;
use mpi::environment::Universe;
use mpi::request::multiple_scope;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, Root, Source};

use carom_ranks::{Link, Message, Ranks};

/// MPI from its beginning to its end.
pub struct Session {
    // ends before MPI does
    #[cfg(feature = "petsc")]
    _petsc: crate::petsc::Library,
    _universe: Universe,
}

impl Session {
    /// Ends all ranks at once, when one of them cannot go on and the others do not know.
    pub fn abort(&self, code: i32) -> ! {
        SimpleCommunicator::world().abort(code)
    }
}

/// Begins MPI; the ranks of this run. None if it has begun already, or does not let several threads compute.
pub fn begin() -> Option<(Session, Ranks)> {
    let (universe, threading) = mpi::initialize_with_threading(Threading::Funneled)?;
    if threading < Threading::Funneled {
        return None;
    }
    let session = Session {
        #[cfg(feature = "petsc")]
        _petsc: crate::petsc::begin().ok()?,
        _universe: universe,
    };
    let ranks = match SimpleCommunicator::world().size() {
        1 => Ranks::alone(),
        _ => Ranks::over(Arc::new(World)),
    };
    Some((session, ranks))
}

/// All ranks that MPI has started. The communicator is a pointer of MPI's and is asked for anew in each call.
struct World;

/// A rank or a number of ranks, which MPI counts with sign.
fn number(of: i32) -> usize {
    usize::try_from(of).unwrap_or(0)
}

impl Link for World {
    fn place(&self) -> [usize; 2] {
        let world = SimpleCommunicator::world();
        [number(world.rank()), number(world.size())]
    }

    fn exchange(&self, sends: &[Message], receives: &mut [Message], meanwhile: &mut dyn FnMut()) {
        let world = SimpleCommunicator::world();
        let count = sends.len() + receives.len();
        let process = |with: usize| world.process_at_rank(with as i32);
        multiple_scope(count, |scope, requests| {
            for message in receives.iter_mut() {
                let from = process(message.with);
                requests.add(from.immediate_receive_into(scope, &mut message.values[..]));
            }
            for message in sends {
                let to = process(message.with);
                requests.add(to.immediate_send(scope, &message.values[..]));
            }
            meanwhile();
            let mut done = Vec::with_capacity(count);
            requests.wait_all(&mut done);
        });
    }

    fn reduce(&self, sums: &mut [f64], largest: &mut [f64]) {
        let world = SimpleCommunicator::world();
        let all = [
            (sums, SystemOperation::sum()),
            (largest, SystemOperation::max()),
        ];
        for (values, operation) in all {
            if !values.is_empty() {
                let own = values.to_vec();
                world.all_reduce_into(&own[..], values, operation);
            }
        }
    }

    fn broadcast(&self, values: &mut Vec<f64>) {
        let world = SimpleCommunicator::world();
        let first = world.process_at_rank(0);
        let mut length = values.len() as u64;
        first.broadcast_into(&mut length);
        values.resize(length as usize, 0.0);
        first.broadcast_into(&mut values[..]);
    }

    #[cfg(feature = "petsc")]
    fn has_engine(&self) -> bool {
        true
    }

    #[cfg(feature = "petsc")]
    fn engine(&self, ranks: &Ranks, rows: &OwnRows) -> Result<Option<Box<dyn Engine>>, String> {
        let solver = crate::petsc::Solver::new(ranks, rows)?;
        Ok(Some(Box::new(solver)))
    }

    #[cfg(feature = "petsc")]
    fn parts_of_graph(&self, graph: &Graph, parts: usize) -> Result<Option<Vec<u32>>, String> {
        crate::scotch::parts(graph, parts).map(Some)
    }

    fn gather(&self, values: &mut [f64], starts: &[usize]) {
        let world = SimpleCommunicator::world();
        let own = number(world.rank());
        let own = values[starts[own]..starts[own + 1]].to_vec();
        let places: Vec<i32> = starts.iter().map(|start| *start as i32).collect();
        let counts: Vec<i32> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let ranks = counts.len();
        let mut parts = PartitionMut::new(values, counts, &places[..ranks]);
        world.all_gather_varcount_into(&own[..], &mut parts);
    }
}
