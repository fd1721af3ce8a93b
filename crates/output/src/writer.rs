//! The background thread that writes fields.
//!
//! The run fills one of a fixed number of buffers and sends it; the thread derives, compresses and writes. While all
//! buffers are out the run waits, so memory is bounded by their number. The error of a buffer comes back with it, at
//! the next [`Writer::check`], [`Writer::buffer`] or [`Writer::finish`]; the thread then writes nothing more.

use std::sync::mpsc::{
    Receiver, RecvTimeoutError, SyncSender, TryRecvError, channel, sync_channel,
};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

use rayon::Yield;

use crate::Error;

/// Time after which a thread that waits looks for its share of work again.
const IDLE: Duration = Duration::from_millis(1);

/// A thread with the buffers that go to it and come back.
#[derive(Debug)]
pub(crate) struct Writer<B> {
    to: Option<SyncSender<B>>,
    back: Receiver<(B, Result<(), Error>)>,
    idle: Vec<B>,
    thread: Option<JoinHandle<()>>,
}

impl<B: Send + 'static> Writer<B> {
    /// Starts the thread, which does `work` on every buffer sent. There are never more buffers than these.
    ///
    /// # Errors
    /// [`Error::Thread`].
    pub(crate) fn start(
        buffers: Vec<B>,
        mut work: impl FnMut(&B) -> Result<(), Error> + Send + 'static,
    ) -> Result<Writer<B>, Error> {
        let (to, jobs) = sync_channel::<B>(buffers.len());
        let (done, back) = channel();
        let thread = Builder::new().name("carom-fields".to_owned());
        let thread = thread.spawn(move || {
            for buffer in jobs {
                let outcome = work(&buffer);
                let failed = outcome.is_err();
                if done.send((buffer, outcome)).is_err() || failed {
                    break;
                }
            }
        });
        Ok(Writer {
            to: Some(to),
            back,
            idle: buffers,
            thread: Some(thread.map_err(Error::Thread)?),
        })
    }

    /// Takes back what is done.
    ///
    /// # Errors
    /// The error of a buffer; [`Error::Writer`] if the thread is gone.
    pub(crate) fn check(&mut self) -> Result<(), Error> {
        loop {
            match self.back.try_recv() {
                Ok((buffer, outcome)) => {
                    self.idle.push(buffer);
                    outcome?;
                }
                Err(TryRecvError::Empty) => return Ok(()),
                Err(TryRecvError::Disconnected) => return Err(Error::Writer),
            }
        }
    }

    /// Waits for a buffer. Where this thread is one of those that share the loops over elements, as that of a rank is, the thread of the fields
    /// may wait for it in turn: it does its share meanwhile.
    fn receive(&self) -> Result<(B, Result<(), Error>), Error> {
        loop {
            let wait = match rayon::yield_now() {
                None => return self.back.recv().map_err(|_| Error::Writer),
                Some(Yield::Executed) => Duration::ZERO,
                Some(Yield::Idle) => IDLE,
            };
            match self.back.recv_timeout(wait) {
                Ok(done) => return Ok(done),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(Error::Writer),
            }
        }
    }

    /// A buffer to fill; waits while all are out.
    ///
    /// # Errors
    /// As [`Writer::check`].
    pub(crate) fn buffer(&mut self) -> Result<B, Error> {
        self.check()?;
        if let Some(buffer) = self.idle.pop() {
            return Ok(buffer);
        }
        let (buffer, outcome) = self.receive()?;
        outcome?;
        Ok(buffer)
    }

    /// Sends a filled buffer.
    ///
    /// # Errors
    /// The error of an earlier buffer that ended the thread; [`Error::Writer`] if the thread is gone without one.
    pub(crate) fn send(&mut self, buffer: B) -> Result<(), Error> {
        let sent = self.to.as_ref().is_some_and(|to| to.send(buffer).is_ok());
        if sent {
            return Ok(());
        }
        // the thread is gone, so everything that it told has arrived
        self.back.try_iter().try_for_each(|(_, outcome)| outcome)?;
        Err(Error::Writer)
    }

    /// Waits until everything sent is written. `all`: the number of buffers.
    ///
    /// # Errors
    /// As [`Writer::check`].
    pub(crate) fn wait(&mut self, all: usize) -> Result<(), Error> {
        while self.idle.len() < all {
            let (buffer, outcome) = self.receive()?;
            self.idle.push(buffer);
            outcome?;
        }
        Ok(())
    }

    /// Waits until everything sent is written, and ends the thread. Nothing to do the second time.
    ///
    /// # Errors
    /// The error of a buffer; [`Error::Writer`] if the thread is gone without one.
    pub(crate) fn finish(&mut self) -> Result<(), Error> {
        self.to = None;
        let mut outcomes = Ok(());
        while let (Ok(()), Ok((_, outcome))) = (&outcomes, self.receive()) {
            outcomes = outcome;
        }
        let ended = self.thread.take().map_or(Ok(()), JoinHandle::join);
        outcomes?;
        ended.map_err(|_| Error::Writer)
    }
}

impl<B> Drop for Writer<B> {
    /// Lets the thread end its file.
    fn drop(&mut self) {
        self.to = None;
        // what it still writes may need this thread
        while self
            .thread
            .as_ref()
            .is_some_and(|thread| !thread.is_finished())
        {
            match rayon::yield_now() {
                None => break,
                Some(Yield::Executed) => {}
                Some(Yield::Idle) => std::thread::sleep(IDLE),
            }
        }
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn a_thread_that_shares_loops_does_its_share_while_it_waits() {
        use rayon::prelude::*;
        // one thread, which is that of the run, as in a rank
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
        let pool = std::sync::Arc::new(pool.build().unwrap());
        let of_fields = std::sync::Arc::clone(&pool);
        let ended = pool.install(|| {
            let mut writer = Writer::start(vec![0], move |n: &i32| {
                let sum: i32 = of_fields.install(|| (0..100).into_par_iter().map(|k| k + n).sum());
                assert_eq!(sum, 4950);
                Ok(())
            })
            .unwrap();
            for _ in 0..3 {
                let buffer = writer.buffer().unwrap();
                writer.send(buffer).unwrap();
            }
            writer.finish()
        });
        ended.unwrap();
    }

    #[test]
    fn the_run_waits_while_both_buffers_are_out() {
        let (open_gate, gate) = channel::<()>();
        let mut writer = Writer::start(vec![0, 0], move |_: &i32| {
            gate.recv().map_err(|_| Error::Writer)
        })
        .unwrap();
        for _ in 0..2 {
            let buffer = writer.buffer().unwrap();
            writer.send(buffer).unwrap();
        }
        writer.check().unwrap();
        assert!(writer.idle.is_empty(), "both are out");
        open_gate.send(()).unwrap();
        // the one that came back, and no third one
        let buffer = writer.buffer().unwrap();
        writer.check().unwrap();
        assert!(writer.idle.is_empty());
        writer.send(buffer).unwrap();
        (0..2).for_each(|_| open_gate.send(()).unwrap());
        writer.finish().unwrap();
        writer.finish().unwrap();
    }

    #[test]
    fn buffers_are_written_in_their_order_and_all_of_them() {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        let mut writer = Writer::start(vec![0, 0], |number: &usize| {
            assert_eq!(NEXT.fetch_add(1, Ordering::SeqCst), *number);
            Ok(())
        })
        .unwrap();
        for number in 0..100 {
            writer.buffer().unwrap();
            writer.send(number).unwrap();
        }
        writer.finish().unwrap();
        assert_eq!(NEXT.load(Ordering::SeqCst), 100);
    }

    #[test]
    fn an_error_comes_back_and_ends_the_thread() {
        let full = || Error::Thread(io::Error::from(io::ErrorKind::StorageFull));
        let mut writer = Writer::start(vec![0, 0], move |_: &i32| Err(full())).unwrap();
        let buffer = writer.buffer().unwrap();
        writer.send(buffer).unwrap();
        let failed = loop {
            if let Err(error) = writer.check() {
                break error;
            }
        };
        assert!(matches!(failed, Error::Thread(_)), "{failed}");
        assert!(matches!(writer.finish(), Ok(())), "told once");
        assert!(writer.buffer().is_ok() || writer.send(0).is_err());
    }

    #[test]
    fn a_buffer_sent_after_the_thread_ended_brings_the_error_that_ended_it() {
        let full = || Error::Thread(io::Error::from(io::ErrorKind::StorageFull));
        let mut writer = Writer::start(vec![0, 0], move |_: &i32| Err(full())).unwrap();
        let (first, second) = (writer.buffer().unwrap(), writer.buffer().unwrap());
        writer.send(first).unwrap();
        while !writer.thread.as_ref().unwrap().is_finished() {
            std::thread::yield_now();
        }
        let failed = writer.send(second).unwrap_err();
        assert!(matches!(failed, Error::Thread(_)), "{failed}");
    }

    #[test]
    fn a_thread_that_panics_is_an_error() {
        let mut writer = Writer::start(vec![0], |_: &i32| panic!("a bug")).unwrap();
        let buffer = writer.buffer().unwrap();
        writer.send(buffer).unwrap();
        assert!(matches!(writer.finish(), Err(Error::Writer)));
    }
}
