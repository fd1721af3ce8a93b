//! Ctrl-C, SIGTERM and SIGHUP: an orderly end.

use carom_dynamics::Interrupt;

use crate::exit::INTERRUPTED;
use crate::terminal::err;

/// What the signals set, so that the run ends within its step, with all that it leaves; `without`: what there is not where they cannot be
/// caught. A second signal ends the program at once: a factorisation, or the start of a large model, looks at nothing before it is done.
pub fn interrupt(without: &str) -> Interrupt {
    let interrupt = Interrupt::default();
    let flag = interrupt.clone();
    let handled = ctrlc::set_handler(move || {
        if flag.set() {
            err!("ended at once; what the last checkpoint holds is there");
            std::process::exit(i32::from(INTERRUPTED));
        }
    });
    // without a handler Ctrl-C ends the program at once, as it would any other
    if let Err(error) = handled {
        tracing::warn!("Ctrl-C will not leave {without}: {error}");
    }
    interrupt
}
