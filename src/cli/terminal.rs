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
    let said = writeln!(io::stderr(), "{}", plain(&printable(&line.to_string())));
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

/// The operating system's words for what users come upon, and ours.
const PLAIN_WORDS: [(&str, &str); 5] = [
    (
        "No such file or directory",
        "there is no such file or folder",
    ),
    ("Permission denied", "it may not be read or changed by you"),
    ("No space left on device", "the disk is full"),
    ("Is a directory", "it is a folder"),
    ("Not a directory", "a file stands where a folder is needed"),
];

/// A text without the numbers of the operating system's errors, and in plain words where there are some.
fn plain(text: &str) -> Cow<'_, str> {
    const NUMBER: &str = " (os error ";
    if !text.contains(NUMBER) {
        return text.into();
    }
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(NUMBER) {
        let known = PLAIN_WORDS
            .iter()
            .find_map(|(theirs, ours)| Some((before.strip_suffix(theirs)?, ours)));
        match known {
            Some((before, ours)) => plain.extend([before, ours]),
            None => plain.push_str(before),
        }
        rest = after.trim_start_matches(|letter: char| letter.is_ascii_digit());
        rest = rest.strip_prefix(')').unwrap_or(rest);
    }
    plain.push_str(rest);
    plain.into()
}

/// A text with characters escaped that a terminal would obey, such as those of ids in a stranger's file.
pub(super) fn printable(text: &str) -> Cow<'_, str> {
    escaped_if(text, |letter| {
        is_obeyed(letter) && !matches!(letter, '\n' | '\t')
    })
}

/// A name or a sentence of a stranger as a part of a line, which it does not end.
pub(super) fn in_line(text: &str) -> Cow<'_, str> {
    escaped_if(text, is_obeyed)
}

/// True for a control character, and for one that changes the direction or the lines of what is around it.
fn is_obeyed(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

fn escaped_if(text: &str, obeyed: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&obeyed) {
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
        io::stderr().write_all(plain(&printable(&String::from_utf8_lossy(&text))).as_bytes())
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
        assert_eq!(printable("a\u{202e}b\u{2028}c"), "a\\u{202e}b\\u{2028}c");
    }

    #[test]
    fn errors_of_the_operating_system_are_in_plain_words() {
        let missing = std::io::Error::from_raw_os_error(2);
        assert_eq!(
            plain(&format!("a: {missing}, and b: {missing}")),
            "a: there is no such file or folder, and b: there is no such file or folder"
        );
        assert_eq!(plain("odd (os error 99); go on"), "odd; go on");
        assert_eq!(plain("nothing"), "nothing");
    }

    #[test]
    fn a_name_does_not_end_its_line() {
        assert_eq!(in_line("two\nlines\t\u{e4}"), "two\\nlines\\t\u{e4}");
        assert_eq!(in_line("one"), "one");
    }
}
