//! Progress, Ctrl-C and exceptions while a run holds no lock of Python.

use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use carom_dynamics::{Error, Observer, Stepper};
use pyo3::prelude::*;

/// Wall time between two looks at signals, or two reports, ms.
const PAUSE: u64 = 50;

/// What a run asks and tells Python.
pub(crate) struct Watch {
    /// Called with a simulated time and the end, s.
    progress: Option<Py<PyAny>>,
    raised: Mutex<Option<PyErr>>,
    stopped: AtomicBool,
    begin: Instant,
    /// When it last looked and last told, ms after the beginning.
    looked: AtomicU64,
    told: AtomicU64,
}

impl Watch {
    pub(crate) fn new(progress: Option<Py<PyAny>>) -> Arc<Watch> {
        Arc::new(Watch {
            progress,
            raised: Mutex::new(None),
            stopped: AtomicBool::new(false),
            begin: Instant::now(),
            looked: AtomicU64::new(0),
            told: AtomicU64::new(0),
        })
    }

    fn is_due(&self, last: &AtomicU64) -> bool {
        let now = self.begin.elapsed().as_millis() as u64;
        let due = now >= last.load(Ordering::Relaxed) + PAUSE;
        if due {
            last.store(now, Ordering::Relaxed);
        }
        due
    }

    fn keep(&self, outcome: PyResult<()>) {
        if let Err(error) = outcome {
            let mut raised = self.raised.lock().unwrap_or_else(|e| e.into_inner());
            raised.get_or_insert(error);
            self.stopped.store(true, Ordering::Relaxed);
        }
    }

    /// Whether the run is to end before its next step: after Ctrl-C, or an exception in the report of progress.
    pub(crate) fn stops(&self) -> bool {
        if self.is_due(&self.looked) {
            self.keep(Python::attach(|py| py.check_signals()));
        }
        self.stopped.load(Ordering::Relaxed)
    }

    fn tell(&self, time: f64, end: f64) {
        if let Some(progress) = &self.progress {
            self.keep(Python::attach(|py| {
                progress.call1(py, (time, end)).map(|_| ())
            }));
        }
    }

    /// # Errors
    /// The exception that stopped the run.
    pub(crate) fn outcome(&self) -> PyResult<()> {
        let mut raised = self.raised.lock().unwrap_or_else(|e| e.into_inner());
        raised.take().map_or(Ok(()), Err)
    }
}

/// Tells the progress of a run up to a time (s).
pub(crate) struct Shown(pub(crate) Arc<Watch>, pub(crate) f64);

impl Observer for Shown {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        if self.0.progress.is_some() && self.0.is_due(&self.0.told) {
            self.0.tell(run.state().time, self.1);
        }
        Ok(())
    }

    fn finish(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        self.0.tell(run.state().time, self.1);
        Ok(())
    }
}
