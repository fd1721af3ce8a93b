//! The background thread that writes fields.
//!
//! The run fills one of a fixed number of buffers and sends it; the thread derives, compresses and writes. While all
//! buffers are out the run waits, so memory is bounded by their number. The error of a buffer comes back with it, at
//! the next [`Writer::check`], [`Writer::buffer`] or [`Writer::finish`]; the thread then writes nothing more.

use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, channel, sync_channel};
use std::thread::{Builder, JoinHandle};

use crate::Error;

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

    /// A buffer to fill; waits while all are out.
    ///
    /// # Errors
    /// As [`Writer::check`].
    pub(crate) fn buffer(&mut self) -> Result<B, Error> {
        self.check()?;
        if let Some(buffer) = self.idle.pop() {
            return Ok(buffer);
        }
        let (buffer, outcome) = self.back.recv().map_err(|_| Error::Writer)?;
        outcome?;
        Ok(buffer)
    }

    /// Sends a filled buffer.
    ///
    /// # Errors
    /// [`Error::Writer`] if the thread is gone.
    pub(crate) fn send(&mut self, buffer: B) -> Result<(), Error> {
        match &self.to {
            Some(to) => to.send(buffer).map_err(|_| Error::Writer),
            None => Err(Error::Writer),
        }
    }

    /// Waits until everything sent is written, and ends the thread. Nothing to do the second time.
    ///
    /// # Errors
    /// The error of a buffer; [`Error::Writer`] if the thread is gone without one.
    pub(crate) fn finish(&mut self) -> Result<(), Error> {
        self.to = None;
        let outcomes: Result<(), Error> = self.back.iter().map(|(_, outcome)| outcome).collect();
        let ended = self.thread.take().map_or(Ok(()), JoinHandle::join);
        outcomes?;
        ended.map_err(|_| Error::Writer)
    }
}

impl<B> Drop for Writer<B> {
    /// Lets the thread end its file.
    fn drop(&mut self) {
        self.to = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
