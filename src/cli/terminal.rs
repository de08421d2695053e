//! Output of the program to its user.

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

/// Prints a line on standard error.
pub(super) fn say(line: impl fmt::Display) {
    let said = writeln!(io::stderr(), "{}", printable(&line.to_string()));
    if said.is_err_and(|error| error.kind() == ErrorKind::BrokenPipe) {
        IS_CLOSED.store(true, Ordering::Relaxed);
    }
}

/// True if nobody reads the output any more.
pub(super) fn is_unheard() -> bool {
    IS_CLOSED.load(Ordering::Relaxed)
}

/// Prints the warnings of a simulation without a window on standard error.
pub(super) fn show_warnings() {
    App::empty().add_plugins(LogPlugin {
        level: Level::WARN,
        // The command that records reports its own failure, and the one that loads a task file its faults.
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

/// A text with characters escaped that a terminal would obey, such as those of ids in a stranger's file.
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

/// Standard error that receives texts in printable form.
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
        // Then nobody reads it.
        let _ = self.flush();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped() {
        assert_eq!(printable("two\nlines\t\u{e4}"), "two\nlines\t\u{e4}");
        assert_eq!(
            printable("a\u{1b}[31mred\u{9b}2J\r\u{7}"),
            "a\\u{1b}[31mred\\u{9b}2J\\r\\u{7}"
        );
    }
}
