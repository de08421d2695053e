//! What the program says to whoever runs it.

use std::{
    borrow::Cow,
    fmt,
    io::{self, ErrorKind, Write},
    sync::atomic::{AtomicBool, Ordering},
};

use bevy::{
    log::{Level, LogPlugin, tracing_subscriber::fmt::Layer},
    prelude::*,
};

/// True if the other end of standard error was closed, as `head` does.
static IS_CLOSED: AtomicBool = AtomicBool::new(false);

/// Says a line on standard error.
pub(super) fn say(line: impl fmt::Display) {
    let said = writeln!(io::stderr(), "{}", printable(&line.to_string()));
    if said.is_err_and(|error| error.kind() == ErrorKind::BrokenPipe) {
        IS_CLOSED.store(true, Ordering::Relaxed);
    }
}

/// True if nobody hears any more what is said.
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
                    .with_ansi(false)
                    .with_writer(PrintableStderr::default)
                    .log_internal_errors(false),
            ))
        },
        ..default()
    });
}

/// A text in which characters that a terminal obeys, as those of ids in a stranger's file may be, are written out.
pub(super) fn printable(text: &str) -> Cow<'_, str> {
    let obeyed = |letter: char| letter.is_control() && !matches!(letter, '\n' | '\t');
    if !text.contains(obeyed) {
        return text.into();
    }
    let mut printable = String::with_capacity(text.len());
    for letter in text.chars() {
        match obeyed(letter) {
            true => printable.extend(letter.escape_default()),
            false => printable.push(letter),
        }
    }
    printable.into()
}

/// Standard error, which gets each text as it is printable.
#[derive(Default)]
struct PrintableStderr(Vec<u8>);

impl Write for PrintableStderr {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        let text = std::mem::take(&mut self.0);
        io::stderr().write_all(printable(&String::from_utf8_lossy(&text)).as_bytes())
    }
}

impl Drop for PrintableStderr {
    fn drop(&mut self) {
        // Nobody hears it, then.
        let _ = self.flush();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_written_out() {
        assert_eq!(printable("two\nlines\t\u{e4}"), "two\nlines\t\u{e4}");
        assert_eq!(
            printable("a\u{1b}[31mred\u{9b}2J\r\u{7}"),
            "a\\u{1b}[31mred\\u{9b}2J\\r\\u{7}"
        );
    }
}
