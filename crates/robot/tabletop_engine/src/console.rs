//! Output of scripts: as many lines as a person may want to read, and never more than fit in memory.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, Instant},
};

/// Lines of the standard error that are kept for the case that the engine dies.
const LAST_ERRORS: usize = 20;
/// Time until the next note that lines were left out.
const NOTE_INTERVAL: Duration = Duration::from_secs(1);

/// The limit on the kept output of a script.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ConsoleLimit {
    /// As much as a person can look at: 200 lines a second.
    #[default]
    Readable,
    /// All, up to 64 MiB that nobody has fetched.
    Whole,
}

impl ConsoleLimit {
    fn lines_per_second(self) -> u32 {
        match self {
            Self::Readable => 200,
            Self::Whole => u32::MAX,
        }
    }

    /// The most bytes that wait to be fetched.
    fn waiting(self) -> usize {
        match self {
            Self::Readable => 1 << 20,
            Self::Whole => 64 << 20,
        }
    }

    /// The greatest length of a line, in bytes.
    fn line(self) -> usize {
        match self {
            Self::Readable => 2000,
            Self::Whole => 1 << 20,
        }
    }
}

/// A line that an engine has printed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConsoleLine {
    /// The stream on which it was printed.
    pub stream: Stream,
    /// The line, without its end and without control characters.
    pub text: String,
}

/// An output of an engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stream {
    /// The standard output, where scripts display values.
    Out,
    /// The standard error: warnings.
    Error,
    /// A remark of this program.
    Note,
}

/// Lines on their way from an engine to the code that shows them.
#[derive(Clone, Debug)]
pub(crate) struct Console {
    limit: ConsoleLimit,
    lines: Arc<Mutex<LineQueue>>,
}

#[derive(Debug, Default)]
struct LineQueue {
    waiting: VecDeque<ConsoleLine>,
    waiting_bytes: usize,
    /// The last lines of the standard error that nobody has fetched, each with whether it waits.
    last_errors: VecDeque<(String, bool)>,
    left_out: u64,
    noted: Option<Instant>,
    second: Option<Instant>,
    in_second: u32,
}

impl Console {
    pub(crate) fn new(limit: ConsoleLimit) -> Self {
        Self {
            limit,
            lines: Arc::default(),
        }
    }

    /// A splitter for the lines that this takes.
    pub(crate) fn splitter(&self) -> Splitter {
        Splitter {
            line: Vec::new(),
            limit: 2 * self.limit.line(),
        }
    }

    /// Takes a line, or counts it as left out.
    pub(crate) fn push(&self, stream: Stream, bytes: &[u8]) {
        self.with(|lines| lines.push(self.limit, stream, bytes));
    }

    /// All lines that wait.
    pub(crate) fn drain(&self) -> Vec<ConsoleLine> {
        self.with(|lines| {
            lines.note_gap(NOTE_INTERVAL);
            lines.waiting_bytes = 0;
            lines.last_errors.clear();
            lines.waiting.drain(..).collect()
        })
    }

    /// Nothing more comes of one of the outputs.
    pub(crate) fn finish(&self) {
        self.with(|lines| lines.note_gap(Duration::ZERO));
    }

    /// The last lines of the standard error that nobody has fetched. Nobody will.
    pub(crate) fn take_last_errors(&self) -> String {
        self.with(|lines| {
            let last: Vec<_> = lines.last_errors.drain(..).collect();
            let is_error = |line: &ConsoleLine| line.stream == Stream::Error;
            let waiting = lines.waiting.iter().filter(|line| is_error(line)).count();
            let taken = last.iter().filter(|(_, waits)| *waits).count();
            let mut kept = waiting.saturating_sub(taken);
            lines.waiting.retain(|line| {
                let stays = !is_error(line) || kept > 0;
                kept -= usize::from(is_error(line) && stays);
                stays
            });
            let words: Vec<_> = last.into_iter().map(|(text, _)| text).collect();
            words.join("\n")
        })
    }

    fn with<T>(&self, act: impl FnOnce(&mut LineQueue) -> T) -> T {
        act(&mut self.lines.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl LineQueue {
    fn push(&mut self, limit: ConsoleLimit, stream: Stream, bytes: &[u8]) {
        let over = |start: Instant| start.elapsed() >= Duration::from_secs(1);
        if self.second.is_none_or(over) {
            self.second = Some(Instant::now());
            self.in_second = 0;
        }
        self.in_second = self.in_second.saturating_add(1);
        let full =
            self.in_second > limit.lines_per_second() || self.waiting_bytes >= limit.waiting();
        if full && stream == Stream::Out {
            self.left_out += 1;
            return;
        }
        let full = full && stream != Stream::Note;
        let text = clean(bytes, limit.line());
        if stream == Stream::Error {
            if self.last_errors.len() >= LAST_ERRORS {
                self.last_errors.pop_front();
            }
            self.last_errors.push_back((text.clone(), !full));
        }
        if full {
            self.left_out += 1;
            return;
        }
        self.note_gap(NOTE_INTERVAL);
        self.waiting_bytes += text.len() + size_of::<ConsoleLine>();
        self.waiting.push_back(ConsoleLine { stream, text });
    }

    /// Notes how many lines were left out, unless that was noted just now.
    fn note_gap(&mut self, interval: Duration) {
        if self.left_out == 0 || self.noted.is_some_and(|noted| noted.elapsed() < interval) {
            return;
        }
        let text = match self.left_out {
            1 => "(1 more line was left out)".to_owned(),
            count => format!("({count} more lines were left out)"),
        };
        let stream = Stream::Note;
        self.waiting.push_back(ConsoleLine { stream, text });
        self.noted = Some(Instant::now());
        self.left_out = 0;
    }
}

/// A line that can be shown: no control characters, no terminal sequences, not too long.
fn clean(bytes: &[u8], limit: usize) -> String {
    let shown = bytes.get(..limit).unwrap_or(bytes);
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

/// Splits the output of an engine into lines. A control character 1 begins a line of its own that is for the program.
#[derive(Debug)]
pub(crate) struct Splitter {
    line: Vec<u8>,
    /// The greatest length of a line, in bytes.
    limit: usize,
}

/// A line for a person or for the program.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum OutputPiece<'a> {
    /// Printed by the script.
    Text(&'a [u8]),
    /// Printed by the driver.
    Mark(&'a [u8]),
}

impl Splitter {
    /// Takes more bytes and calls `each` for every line that has become complete.
    pub(crate) fn feed(&mut self, bytes: &[u8], mut each: impl FnMut(OutputPiece)) {
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
        let room = self.limit.saturating_sub(self.line.len());
        self.line
            .extend_from_slice(bytes.get(..room).unwrap_or(bytes));
    }

    fn end(&mut self, each: &mut impl FnMut(OutputPiece)) {
        match self.line.split_first() {
            Some((1, mark)) => each(OutputPiece::Mark(mark)),
            _ => each(OutputPiece::Text(
                self.line.strip_suffix(b"\r").unwrap_or(&self.line),
            )),
        }
        self.line.clear();
    }

    /// Hands over the rest when nothing more comes.
    pub(crate) fn finish(&mut self, mut each: impl FnMut(OutputPiece)) {
        if !self.line.is_empty() {
            self.end(&mut each);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(chunks: &[&[u8]]) -> Vec<String> {
        let mut splitter = Console::new(ConsoleLimit::Readable).splitter();
        let mut all = Vec::new();
        let mut each = |piece: OutputPiece| match piece {
            OutputPiece::Text(text) => all.push(String::from_utf8_lossy(text).into_owned()),
            OutputPiece::Mark(mark) => all.push(format!("<{}>", String::from_utf8_lossy(mark))),
        };
        for chunk in chunks {
            splitter.feed(chunk, &mut each);
        }
        splitter.finish(each);
        all
    }

    #[test]
    fn marks_are_distinguished_from_text() {
        assert_eq!(
            pieces(&[b"a\n\nb\x01done 3\nc"]),
            ["a", "", "b", "<done 3>", "c"]
        );
        assert_eq!(
            pieces(&[b"x\n\x01do", b"ne 3\ny\r\n"]),
            ["x", "<done 3>", "y"]
        );
    }

    fn notes(lines: &[ConsoleLine]) -> Vec<&str> {
        let notes = lines.iter().filter(|line| line.stream == Stream::Note);
        notes.map(|line| line.text.as_str()).collect()
    }

    #[test]
    fn a_flood_is_bounded_and_noted_once_a_second() {
        let console = Console::new(ConsoleLimit::Readable);
        let mut lines = Vec::new();
        for _ in 0..100 {
            for _ in 0..1000 {
                console.push(Stream::Out, b"keyboard> ");
            }
            lines.extend(console.drain());
        }
        assert!(
            lines.len() < 100_000 && notes(&lines).len() < 100,
            "{}",
            lines.len()
        );
        console.push(Stream::Out, b"one more");
        console.finish();
        lines.extend(console.drain());
        let noted = notes(&lines).into_iter().map(|note| {
            let count = note.trim_start_matches('(').split(' ').next();
            count.unwrap().parse::<usize>().unwrap()
        });
        let noted: usize = noted.sum();
        assert_eq!(lines.len() - notes(&lines).len() + noted, 100_001);
        let mut splitter = console.splitter();
        for _ in 0..1000 {
            splitter.feed(&[b'x'; 1000], |_| {});
        }
        assert!(splitter.line.len() <= 4000);
    }

    #[test]
    fn one_line_is_no_lines() {
        let mut lines = LineQueue {
            left_out: 1,
            ..LineQueue::default()
        };
        lines.note_gap(Duration::ZERO);
        assert_eq!(
            notes(lines.waiting.make_contiguous()),
            ["(1 more line was left out)"]
        );
    }

    #[test]
    fn a_full_console_still_takes_notes() {
        let console = Console::new(ConsoleLimit::Readable);
        for _ in 0..100_000 {
            console.push(Stream::Out, b"x");
        }
        console.push(Stream::Note, b"cut off");
        assert!(notes(&console.drain()).contains(&"cut off"));
    }

    #[test]
    fn all_is_kept_where_all_is_wanted() {
        let console = Console::new(ConsoleLimit::Whole);
        for _ in 0..100_000 {
            console.push(Stream::Out, &[b'x'; 300]);
        }
        assert_eq!(console.drain().len(), 100_000);
    }

    #[test]
    fn last_errors_are_reported_once() {
        let console = Console::new(ConsoleLimit::Readable);
        console.push(Stream::Error, b"shown");
        assert_eq!(console.drain().len(), 1);
        console.push(Stream::Error, b"unseen");
        console.push(Stream::Out, b"result");
        assert_eq!(console.take_last_errors(), "unseen");
        assert_eq!(console.drain().len(), 1);
    }

    #[test]
    fn of_equal_errors_only_the_last_are_reported_with_the_end() {
        let console = Console::new(ConsoleLimit::Readable);
        for _ in 0..50 {
            console.push(Stream::Error, b"again");
        }
        console.push(Stream::Out, b"result");
        let reported = console.take_last_errors();
        assert_eq!(reported.lines().count(), LAST_ERRORS);
        assert_eq!(console.drain().len(), 50 - LAST_ERRORS + 1);
    }

    #[test]
    fn all_that_does_not_fit_is_counted() {
        let console = Console::new(ConsoleLimit::Whole);
        for _ in 0..300 {
            console.push(Stream::Out, &[b'x'; 1 << 18]);
        }
        let lines = console.drain();
        let left_out = 301 - lines.len();
        assert!(left_out > 10, "{left_out}");
        assert_eq!(
            notes(&lines),
            [format!("({left_out} more lines were left out)")]
        );
    }

    #[test]
    fn terminal_sequences_are_not_shown() {
        assert_eq!(clean(b"\x1b[H\x1b[2Ja\tb\x07", 2000), "a    b");
        assert!(clean(&[b'x'; 5000], 2000).ends_with('…'));
    }
}
