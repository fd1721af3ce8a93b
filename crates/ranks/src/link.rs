//! Ranks and the messages between them.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::engine::{Engine, Graph, OwnRows};

/// Numbers to or from a rank; their count is known to both.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Message {
    /// The other rank.
    pub with: usize,
    /// What is sent, or the room for what is received.
    pub values: Vec<f64>,
}

/// What carries the messages.
pub trait Link: Send + Sync {
    /// This rank, and the number of all.
    fn place(&self) -> [usize; 2];
    /// Sends and receives; computes `meanwhile` while messages are under way.
    fn exchange(&self, sends: &[Message], receives: &mut [Message], meanwhile: &mut dyn FnMut());
    /// Replaces numbers by their sums, and others by their largest, over all ranks: the same bits on all.
    fn reduce(&self, sums: &mut [f64], largest: &mut [f64]);
    /// Gives what the first rank has to all others.
    fn broadcast(&self, values: &mut Vec<f64>);
    /// Gives each rank's own part of some numbers to all others; `starts`: where the parts begin, and their end.
    fn gather(&self, values: &mut [f64], starts: &[usize]);
    /// Whether these ranks are those of an engine, which makes the two that follow.
    fn has_engine(&self) -> bool {
        false
    }
    /// The solver of [`Ranks::engine`].
    ///
    /// # Errors
    /// What the engine says.
    fn engine(&self, _ranks: &Ranks, _rows: &OwnRows) -> Result<Option<Box<dyn Engine>>, String> {
        Ok(None)
    }
    /// The parts of [`Ranks::parts_of_graph`].
    ///
    /// # Errors
    /// What the engine says.
    fn parts_of_graph(&self, _graph: &Graph, _parts: usize) -> Result<Option<Vec<u32>>, String> {
        Ok(None)
    }
}

/// The ranks of a run as one of them sees them.
#[derive(Clone)]
pub struct Ranks {
    link: Option<Arc<dyn Link>>,
    /// Numbers sent by exchanges.
    sent: Arc<AtomicU64>,
}

impl fmt::Debug for Ranks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "rank {} of {}", self.rank(), self.count())
    }
}

impl Default for Ranks {
    fn default() -> Ranks {
        Ranks::alone()
    }
}

impl Ranks {
    /// One process.
    pub fn alone() -> Ranks {
        Ranks {
            link: None,
            sent: Arc::default(),
        }
    }

    /// The ranks whose messages `link` carries.
    pub fn over(link: Arc<dyn Link>) -> Ranks {
        Ranks {
            link: Some(link),
            sent: Arc::default(),
        }
    }

    fn place(&self) -> [usize; 2] {
        self.link.as_ref().map_or([0, 1], |link| link.place())
    }

    /// This rank, from 0.
    pub fn rank(&self) -> usize {
        self.place()[0]
    }

    /// Number of ranks.
    pub fn count(&self) -> usize {
        self.place()[1]
    }

    /// Whether this is the first rank, which writes the results.
    pub fn is_first(&self) -> bool {
        self.rank() == 0
    }

    /// Sends and receives messages; computes `meanwhile` while they are under way. Every send has its receive on the other rank, in the
    /// same order.
    pub fn exchange(
        &self,
        sends: &[Message],
        receives: &mut [Message],
        mut meanwhile: impl FnMut(),
    ) {
        let count: usize = sends.iter().map(|message| message.values.len()).sum();
        self.sent.fetch_add(count as u64, Ordering::Relaxed);
        match &self.link {
            Some(link) => link.exchange(sends, receives, &mut meanwhile),
            None => meanwhile(),
        }
    }

    /// Bytes that this rank has sent in exchanges so far.
    pub fn sent_bytes(&self) -> u64 {
        8 * self.sent.load(Ordering::Relaxed)
    }

    /// Replaces numbers by their sums, and others by their largest, over all ranks: the same bits on all.
    pub fn reduce(&self, sums: &mut [f64], largest: &mut [f64]) {
        if let Some(link) = &self.link {
            link.reduce(sums, largest);
        }
    }

    /// Gives what the first rank has to all others.
    pub fn broadcast(&self, values: &mut Vec<f64>) {
        if let Some(link) = &self.link {
            link.broadcast(values);
        }
    }

    /// Whether an engine solves linear equations over these ranks: PETSc, with the feature `petsc`.
    pub fn has_engine(&self) -> bool {
        self.link.as_ref().is_some_and(|link| link.has_engine())
    }

    /// The engine's solver of a matrix of which each rank gives its rows; none without an engine.
    ///
    /// # Errors
    /// What the engine says.
    pub fn engine(&self, rows: &OwnRows) -> Result<Option<Box<dyn Engine>>, String> {
        self.link
            .as_ref()
            .map_or(Ok(None), |link| link.engine(self, rows))
    }

    /// The rank of each element by the engine, so that elements of different ranks share few faces; none without an engine. One rank asks alone,
    /// so that the same graph is always shared out alike: what several find together depends on when their messages come.
    ///
    /// # Errors
    /// What the engine says.
    pub fn parts_of_graph(&self, graph: &Graph) -> Result<Option<Vec<u32>>, String> {
        self.link
            .as_ref()
            .map_or(Ok(None), |link| link.parts_of_graph(graph, self.count()))
    }

    /// Where the parts of `count` things begin that ranks share in their order, and their end.
    pub fn starts(&self, count: usize) -> Vec<usize> {
        let ranks = self.count();
        (0..=ranks).map(|rank| count * rank / ranks).collect()
    }

    /// Gives each rank's own part of some numbers to all others; `starts`: where the parts begin, and their end.
    pub fn gather(&self, values: &mut [f64], starts: &[usize]) {
        let Some(link) = &self.link else { return };
        let [rank, count] = self.place();
        let own = starts[rank + 1] - starts[rank];
        let sent = own * (count - 1);
        self.sent.fetch_add(sent as u64, Ordering::Relaxed);
        link.gather(values, starts);
    }

    /// Gives each rank's numbers, however many, to all: those of the first rank first.
    pub fn gather_all(&self, own: &[f64]) -> Vec<f64> {
        let [rank, count] = self.place();
        let mut counts = vec![0.0; count];
        counts[rank] = own.len() as f64;
        self.gather(&mut counts, &(0..=count).collect::<Vec<_>>());
        let mut starts = vec![0];
        for count in counts {
            starts.push(starts[starts.len() - 1] + count as usize);
        }
        let mut all = vec![0.0; starts[count]];
        all[starts[rank]..starts[rank + 1]].copy_from_slice(own);
        self.gather(&mut all, &starts);
        all
    }

    /// The text of the first rank that has one, with that rank; none if none has. All ranks ask together.
    pub fn first_text(&self, own: Option<&str>) -> Option<(usize, String)> {
        let [rank, count] = self.place();
        // the first of those that have one is the largest of these
        let mut first = [own.map_or(0.0, |_| (count - rank) as f64)];
        self.reduce(&mut [], &mut first);
        if first[0] == 0.0 {
            return None;
        }
        let first = count - first[0] as usize;
        let own = own.filter(|_| rank == first).unwrap_or("");
        let mut text = numbers(own.as_bytes());
        self.pass_to_first(first, &mut text);
        self.broadcast(&mut text);
        Some((first, String::from_utf8_lossy(&bytes(&text)).into_owned()))
    }

    /// Gives the bytes that the first rank has to all others.
    pub fn broadcast_bytes(&self, own: &[u8]) -> Vec<u8> {
        let mut values = match self.is_first() {
            true => numbers(own),
            false => Vec::new(),
        };
        self.broadcast(&mut values);
        bytes(&values)
    }

    /// Brings numbers of a rank to the first one.
    fn pass_to_first(&self, from: usize, values: &mut Vec<f64>) {
        let rank = self.rank();
        if from == 0 || rank != 0 && rank != from {
            return;
        }
        let message = |values: Vec<f64>| {
            let with = if rank == 0 { from } else { 0 };
            [Message { with, values }]
        };
        if rank == from {
            self.exchange(&message(vec![values.len() as f64]), &mut [], || ());
            self.exchange(&message(std::mem::take(values)), &mut [], || ());
        } else {
            let mut length = message(vec![0.0]);
            self.exchange(&[], &mut length, || ());
            let mut received = message(vec![0.0; length[0].values[0] as usize]);
            self.exchange(&[], &mut received, || ());
            *values = std::mem::take(&mut received[0].values);
        }
    }
}

/// Bytes that a number carries: so many bits are exact.
const BYTES: usize = 4;

/// Bytes as numbers: how many they are, and then four of them in each.
fn numbers(bytes: &[u8]) -> Vec<f64> {
    let number = |part: &[u8]| {
        let mut four = [0; BYTES];
        four[..part.len()].copy_from_slice(part);
        f64::from(u32::from_le_bytes(four))
    };
    let count = std::iter::once(bytes.len() as f64);
    count.chain(bytes.chunks(BYTES).map(number)).collect()
}

/// The reverse.
fn bytes(numbers: &[f64]) -> Vec<u8> {
    let Some((count, numbers)) = numbers.split_first() else {
        return Vec::new();
    };
    let all = numbers.iter().map(|number| *number as u32);
    let mut bytes: Vec<u8> = all.flat_map(u32::to_le_bytes).collect();
    bytes.truncate(*count as usize);
    bytes
}
