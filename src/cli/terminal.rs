//! What the program says to whoever runs it.

use std::{
    fmt,
    io::{self, ErrorKind, Write as _},
    sync::atomic::{AtomicBool, Ordering},
};

/// Whether the other end of standard error was closed, as `head` does.
static IS_CLOSED: AtomicBool = AtomicBool::new(false);

/// Says a line on standard error.
pub(super) fn say(line: impl fmt::Display) {
    let said = writeln!(io::stderr(), "{line}");
    if said.is_err_and(|error| error.kind() == ErrorKind::BrokenPipe) {
        IS_CLOSED.store(true, Ordering::Relaxed);
    }
}

/// Whether nobody hears any more what is said.
pub(super) fn is_unheard() -> bool {
    IS_CLOSED.load(Ordering::Relaxed)
}
