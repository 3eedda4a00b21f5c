//! What happens when the program is told to stop.

use std::sync::OnceLock;

use darkroot_batch::Stop;

/// Set by commands that can end in order.
static STOP: OnceLock<Stop> = OnceLock::new();

/// Interrupts are heard by this from now on; without it they end the program at once.
pub(crate) fn stop() -> Stop {
    STOP.get_or_init(Stop::default).clone()
}

/// An interrupted program leaves no half-written file behind.
pub(crate) fn handle() {
    const INTERRUPTED: i32 = 130;
    let handler = || {
        if let Some(stop) = STOP.get() {
            if !stop.asked() {
                crate::say(format_args!("finishing the files in flight; once more to stop at once"));
            }
            stop.ask();
            return;
        }
        darkroot::abandon();
        std::process::exit(INTERRUPTED);
    };
    // Without a handler the program still works; only a temporary file may stay after an interrupt.
    if let Err(error) = ctrlc::set_handler(handler) {
        crate::say(format_args!("warning: interrupts cannot be handled: {error}"));
    }
}
