//! What scripts print: lines, as many as a person may want to read and never more than fit in memory.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, Instant},
};

/// How many lines wait to be fetched, at most.
const MAX_WAITING: usize = 1000;
/// How many lines are taken in a second, at most.
const MAX_PER_SECOND: u32 = 200;
/// How long a line may be, in bytes.
const MAX_LINE: usize = 2000;
/// How much of the standard error is kept for the case that the engine dies.
const LAST_WORDS: usize = 20;

/// A line that an engine has printed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConsoleLine {
    /// Where it was printed.
    pub stream: Stream,
    /// The line, without its end and without control characters.
    pub text: String,
}

/// An output of an engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stream {
    /// The standard output: what scripts display.
    Out,
    /// The standard error: warnings.
    Error,
    /// A remark of this program: that lines were left out.
    Note,
}

/// Lines on their way from an engine to whoever shows them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Console(Arc<Mutex<Lines>>);

#[derive(Debug, Default)]
struct Lines {
    waiting: VecDeque<ConsoleLine>,
    last_words: VecDeque<String>,
    left_out: u64,
    second: Option<Instant>,
    in_second: u32,
}

impl Console {
    /// Takes a line, or counts it as left out.
    pub(crate) fn push(&self, stream: Stream, bytes: &[u8]) {
        let mut lines = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        let same = |start: Instant| now.duration_since(start) < Duration::from_secs(1);
        if !lines.second.is_some_and(same) {
            lines.second = Some(now);
            lines.in_second = 0;
        }
        lines.in_second += 1;
        let full = lines.in_second > MAX_PER_SECOND || lines.waiting.len() >= MAX_WAITING;
        if full && stream == Stream::Out {
            lines.left_out += 1;
            return;
        }
        let text = clean(bytes);
        if stream == Stream::Error {
            if lines.last_words.len() >= LAST_WORDS {
                lines.last_words.pop_front();
            }
            lines.last_words.push_back(text.clone());
        }
        if full {
            lines.left_out += 1;
            return;
        }
        lines.note_gap();
        lines.waiting.push_back(ConsoleLine { stream, text });
    }

    /// All lines that wait.
    pub(crate) fn drain(&self) -> Vec<ConsoleLine> {
        let mut lines = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        lines.note_gap();
        lines.waiting.drain(..).collect()
    }

    /// The last lines of the standard error.
    pub(crate) fn last_words(&self) -> String {
        let lines = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        lines
            .last_words
            .iter()
            .map(String::as_str)
            .collect::<Vec<_>>()
            .join("\n")
    }
}

impl Lines {
    fn note_gap(&mut self) {
        if self.left_out > 0 {
            let text = format!("({} more lines were left out)", self.left_out);
            let stream = Stream::Note;
            self.waiting.push_back(ConsoleLine { stream, text });
            self.left_out = 0;
        }
    }
}

/// A line that can be shown: no control characters, no terminal sequences, not too long.
fn clean(bytes: &[u8]) -> String {
    let shown = bytes.get(..MAX_LINE).unwrap_or(bytes);
    let text = String::from_utf8_lossy(shown);
    let mut cleaned = String::with_capacity(text.len());
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '\x1b' if letters.next_if_eq(&'[').is_some() => {
                // A terminal's sequence ends with a letter.
                while letters
                    .next()
                    .is_some_and(|part| !part.is_ascii_alphabetic())
                {}
            }
            '\t' => cleaned.push_str("    "),
            letter if letter.is_control() => {}
            letter => cleaned.push(letter),
        }
    }
    if shown.len() < bytes.len() {
        cleaned.push('…');
    }
    cleaned
}

/// Splits what an engine prints into lines. A control character 1 begins a line of its own that is for the program.
#[derive(Debug, Default)]
pub(crate) struct Splitter {
    line: Vec<u8>,
}

/// A line for a person or for the program.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Piece<'a> {
    /// Printed by the script.
    Text(&'a [u8]),
    /// Printed by the driver.
    Mark(&'a [u8]),
}

impl Splitter {
    /// Takes more bytes and calls `each` for every line that has become complete.
    pub(crate) fn feed(&mut self, bytes: &[u8], mut each: impl FnMut(Piece)) {
        for part in bytes.split_inclusive(|byte| *byte == b'\n') {
            let mut rest = part;
            if let Some(mark) = part.iter().position(|byte| *byte == 1) {
                let (before, after) = rest.split_at(mark);
                self.add(before);
                if !self.line.is_empty() {
                    self.end(&mut each);
                }
                rest = after;
            }
            let ended = rest.ends_with(b"\n");
            self.add(rest.strip_suffix(b"\n").unwrap_or(rest));
            if ended {
                self.end(&mut each);
            }
        }
    }

    fn add(&mut self, bytes: &[u8]) {
        let room = (2 * MAX_LINE).saturating_sub(self.line.len());
        self.line
            .extend_from_slice(bytes.get(..room).unwrap_or(bytes));
    }

    fn end(&mut self, each: &mut impl FnMut(Piece)) {
        match self.line.split_first() {
            Some((1, mark)) => each(Piece::Mark(mark)),
            _ => each(Piece::Text(
                self.line.strip_suffix(b"\r").unwrap_or(&self.line),
            )),
        }
        self.line.clear();
    }

    /// What is left when nothing more comes.
    pub(crate) fn finish(&mut self, mut each: impl FnMut(Piece)) {
        if !self.line.is_empty() {
            self.end(&mut each);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(chunks: &[&[u8]]) -> Vec<String> {
        let mut splitter = Splitter::default();
        let mut all = Vec::new();
        let mut each = |piece: Piece| match piece {
            Piece::Text(text) => all.push(String::from_utf8_lossy(text).into_owned()),
            Piece::Mark(mark) => all.push(format!("<{}>", String::from_utf8_lossy(mark))),
        };
        for chunk in chunks {
            splitter.feed(chunk, &mut each);
        }
        splitter.finish(each);
        all
    }

    #[test]
    fn marks_are_told_from_text() {
        assert_eq!(
            pieces(&[b"a\n\nb\x01done 3\nc"]),
            ["a", "", "b", "<done 3>", "c"]
        );
        assert_eq!(
            pieces(&[b"x\n\x01do", b"ne 3\ny\r\n"]),
            ["x", "<done 3>", "y"]
        );
    }

    #[test]
    fn a_flood_is_bounded() {
        let console = Console::default();
        for _ in 0..100_000 {
            console.push(Stream::Out, b"keyboard> ");
        }
        let lines = console.drain();
        assert!(lines.len() <= MAX_PER_SECOND as usize + 1);
        assert_eq!(lines.last().unwrap().stream, Stream::Note);
        let mut splitter = Splitter::default();
        for _ in 0..1000 {
            splitter.feed(&[b'x'; 1000], |_| {});
        }
        assert!(splitter.line.len() <= 2 * MAX_LINE);
    }

    #[test]
    fn terminal_sequences_are_not_shown() {
        assert_eq!(clean(b"\x1b[H\x1b[2Ja\tb\x07"), "a    b");
        assert!(clean(&[b'x'; 5000]).ends_with('…'));
    }
}
