//! The progress of a run on a terminal: time left, simulated time, energy residual.

use carom_dynamics::{Error, Observer, State, StepReport, System};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar on standard error; nothing where that is no terminal.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar of as many steps. `hidden` draws nothing.
    pub fn new(steps: u64, hidden: bool) -> Progress {
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr_with_hz(5));
        if hidden {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} steps, {eta} left, {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Progress { bar }
    }
}

impl Observer for Progress {
    fn accepted(
        &mut self,
        _system: &System,
        state: &State,
        report: &StepReport,
    ) -> Result<(), Error> {
        // the text is renewed as rarely as the bar: formatting would show in small models
        if report.step.is_multiple_of(64) {
            let ledger = &state.ledger;
            let relative =
                ledger.balance.energy_residual / ledger.largest_energy.max(f64::MIN_POSITIVE);
            self.bar.set_message(format!(
                "t = {:.3e} s, energy residual {relative:+.0e}",
                report.time
            ));
            self.bar.set_position(report.step);
        }
        Ok(())
    }

    fn finish(&mut self, _system: &System, state: &State) -> Result<(), Error> {
        self.bar.set_position(state.step);
        self.bar.finish_and_clear();
        Ok(())
    }
}
