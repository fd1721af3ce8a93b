//! The progress of a run on a terminal: time left, simulated time, energy residual.

use carom_dynamics::{Error, Interrupt, Observer, Scope, Stepper};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Parts of the simulated time that the bar counts.
const PARTS: f64 = 1e4;

/// A bar on standard error; nothing where that is no terminal.
pub struct Progress {
    bar: ProgressBar,
    end: f64,
    interrupt: Interrupt,
}

impl Progress {
    /// A bar up to a simulated time in s, of a run that `interrupt` ends. `hidden` draws nothing.
    pub fn new(end: f64, hidden: bool, interrupt: Interrupt) -> Progress {
        let parts = Some(PARTS as u64);
        let bar = ProgressBar::with_draw_target(parts, ProgressDrawTarget::stderr_with_hz(5));
        if hidden {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let style = ProgressStyle::with_template("{bar:30} {percent} %, {eta} left, {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Progress {
            bar,
            end,
            interrupt,
        }
    }

    fn show(&self, time: f64) {
        self.bar.set_position((PARTS * time / self.end) as u64);
    }
}

impl Observer for Progress {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        let (state, report) = (run.state(), run.report());
        // the text is renewed as rarely as the bar: formatting would show in small models
        if report.step.is_multiple_of(64) {
            let ledger = &state.ledger;
            let relative =
                ledger.balance.energy_residual / ledger.largest_energy.max(f64::MIN_POSITIVE);
            self.bar.set_message(format!(
                "step {}, t = {:.3e} s, energy residual {relative:+.0e}",
                report.step, report.time
            ));
            self.show(report.time);
        }
        Ok(())
    }

    fn looks(&self, _: &dyn Stepper) -> Scope {
        Scope::Watched
    }

    fn finish(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        self.show(run.state().time);
        self.bar.finish_and_clear();
        Ok(())
    }

    fn interrupt(&self) -> Option<&Interrupt> {
        Some(&self.interrupt)
    }
}
