//! What the program says to whoever runs it.

use std::{
    fmt,
    io::{self, ErrorKind, IsTerminal as _, Write as _},
    sync::atomic::{AtomicBool, Ordering},
};

use bevy::{
    log::{Level, LogPlugin, tracing_subscriber::fmt::Layer},
    prelude::*,
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

/// Has the warnings of a simulation without a window said on standard error.
pub(super) fn show_warnings() {
    App::empty().add_plugins(LogPlugin {
        level: Level::WARN,
        // The command that wanted a recording says that it has failed, and the one that names a task file its faults.
        filter: "tabletop_recorder::recording::recorder=off,tabletop_xml::plugin=off".into(),
        fmt_layer: |_| {
            Some(Box::new(
                Layer::default()
                    .without_time()
                    .with_target(false)
                    .with_ansi(io::stderr().is_terminal())
                    .with_writer(io::stderr)
                    .log_internal_errors(false),
            ))
        },
        ..default()
    });
}
