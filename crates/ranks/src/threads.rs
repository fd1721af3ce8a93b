//! Ranks that are threads of one process, for tests without MPI.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use crate::link::{Link, Message, Ranks};

/// The channels of one thread, by the other rank.
struct Threads {
    rank: usize,
    to: Vec<Sender<Vec<f64>>>,
    from: Vec<Mutex<Receiver<Vec<f64>>>>,
}

/// The ranks of so many threads, one for each of them. A thread that waits for one that has ended panics.
pub fn threads(count: usize) -> Vec<Ranks> {
    let mut ends: Vec<Threads> = (0..count)
        .map(|rank| Threads {
            rank,
            to: Vec::new(),
            from: Vec::new(),
        })
        .collect();
    for from in 0..count {
        for to in 0..count {
            let (sender, receiver) = channel();
            ends[from].to.push(sender);
            ends[to].from.push(Mutex::new(receiver));
        }
    }
    let ranks = ends.into_iter();
    ranks.map(|own| Ranks::over(Arc::new(own))).collect()
}

impl Threads {
    #[allow(
        clippy::panic,
        reason = "a rank without the others cannot go on, as a process whose MPI ends"
    )]
    fn send(&self, to: usize, values: Vec<f64>) {
        if self.to[to].send(values).is_err() {
            panic!("rank {to} has ended");
        }
    }

    #[allow(
        clippy::panic,
        reason = "a rank without the others cannot go on, as a process whose MPI ends"
    )]
    fn receive(&self, from: usize) -> Vec<f64> {
        let receiver = self.from[from].lock();
        let received = receiver.unwrap_or_else(PoisonError::into_inner).recv();
        match received {
            Ok(values) => values,
            Err(_) => panic!("rank {from} has ended"),
        }
    }
}

impl Link for Threads {
    fn place(&self) -> [usize; 2] {
        [self.rank, self.to.len()]
    }

    fn exchange(&self, sends: &[Message], receives: &mut [Message], meanwhile: &mut dyn FnMut()) {
        for message in sends {
            self.send(message.with, message.values.clone());
        }
        meanwhile();
        for message in receives {
            // a message of another length would be a defect of the program: it fails here
            message.values.copy_from_slice(&self.receive(message.with));
        }
    }

    fn reduce(&self, sums: &mut [f64], largest: &mut [f64]) {
        let own: Vec<f64> = sums.iter().chain(largest.iter()).copied().collect();
        for to in (0..self.to.len()).filter(|to| *to != self.rank) {
            self.send(to, own.clone());
        }
        let count = sums.len();
        sums.fill(0.0);
        for from in 0..self.to.len() {
            let other = match from == self.rank {
                true => own.clone(),
                false => self.receive(from),
            };
            for (sum, value) in sums.iter_mut().zip(&other) {
                *sum += value;
            }
            for (most, value) in largest.iter_mut().zip(&other[count..]) {
                *most = most.max(*value);
            }
        }
    }

    fn broadcast(&self, values: &mut Vec<f64>) {
        if self.rank == 0 {
            for to in 1..self.to.len() {
                self.send(to, values.clone());
            }
        } else {
            *values = self.receive(0);
        }
    }

    fn gather(&self, values: &mut [f64], starts: &[usize]) {
        let part = |rank: usize| starts[rank]..starts[rank + 1];
        for to in (0..self.to.len()).filter(|to| *to != self.rank) {
            self.send(to, values[part(self.rank)].to_vec());
        }
        for from in (0..self.to.len()).filter(|from| *from != self.rank) {
            values[part(from)].copy_from_slice(&self.receive(from));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_all<T: Send>(count: usize, work: impl Fn(Ranks) -> T + Sync) -> Vec<T> {
        std::thread::scope(|scope| {
            let ranks = threads(count).into_iter();
            let started: Vec<_> = ranks.map(|own| scope.spawn(|| work(own))).collect();
            started.into_iter().map(|one| one.join().unwrap()).collect()
        })
    }

    #[test]
    fn sums_and_largest_are_those_of_all_ranks_on_each() {
        let found = on_all(3, |ranks| {
            let own = ranks.rank() as f64;
            let (mut sums, mut largest) = ([own, 10.0 * own], [-own]);
            ranks.reduce(&mut sums, &mut largest);
            (sums, largest)
        });
        assert_eq!(found, [([3.0, 30.0], [0.0]); 3]);
    }

    #[test]
    fn the_text_of_the_first_rank_that_has_one_reaches_all() {
        let found = on_all(4, |ranks| {
            let own = format!("of {}", ranks.rank());
            let text = (ranks.rank() >= 2).then_some(&own[..]);
            (ranks.first_text(None), ranks.first_text(text))
        });
        for one in found {
            assert_eq!(one, (None, Some((2, "of 2".to_owned()))));
        }
    }

    #[test]
    fn parts_of_all_ranks_reach_each() {
        let found = on_all(3, |ranks| {
            let starts = ranks.starts(7);
            let mut values = [-1.0; 7];
            let own = starts[ranks.rank()]..starts[ranks.rank() + 1];
            own.for_each(|k| values[k] = k as f64);
            ranks.gather(&mut values, &starts);
            values
        });
        assert_eq!(found, [[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]; 3]);
    }

    #[test]
    fn numbers_of_all_ranks_reach_each_however_many_they_are() {
        let found = on_all(3, |ranks| {
            let own = vec![ranks.rank() as f64; [2, 0, 1][ranks.rank()]];
            ranks.gather_all(&own)
        });
        assert_eq!(found, [[0.0, 0.0, 2.0]; 3]);
        assert_eq!(Ranks::alone().gather_all(&[4.0]), [4.0]);
    }

    #[test]
    fn messages_arrive_and_their_bytes_are_counted() {
        let found = on_all(2, |ranks| {
            let with = 1 - ranks.rank();
            let sends = [Message {
                with,
                values: vec![ranks.rank() as f64; 5],
            }];
            let mut receives = [Message {
                with,
                values: vec![-1.0; 5],
            }];
            let mut done = false;
            ranks.exchange(&sends, &mut receives, || done = true);
            assert!(done);
            (receives[0].values[4], ranks.sent_bytes())
        });
        assert_eq!(found, [(1.0, 40), (0.0, 40)]);
    }
}
