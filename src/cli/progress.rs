//! Progress of long commands.

use std::{
    io::{self, IsTerminal as _, Write as _},
    time::{Duration, Instant},
};

/// A progress line on standard error, if that is a terminal.
pub(super) struct ProgressLine {
    all: u64,
    done: u64,
    start: Instant,
    shown: Option<Instant>,
    is_visible: bool,
}

/// Time between changes of the line.
const PERIOD: Duration = Duration::from_millis(100);
/// Number of characters of the bar.
const WIDTH: usize = 24;

impl ProgressLine {
    pub fn new(all: u64) -> Self {
        Self {
            all,
            done: 0,
            start: Instant::now(),
            shown: None,
            is_visible: io::stderr().is_terminal(),
        }
    }

    /// Counts one more done; `dropped` is the number of dropped ones so far.
    pub fn advance(&mut self, dropped: u64) {
        self.done += 1;
        let is_recent = self.shown.is_some_and(|shown| shown.elapsed() < PERIOD);
        if !self.is_visible || (is_recent && self.done < self.all) {
            return;
        }
        self.shown = Some(Instant::now());
        let line = line(self.done, self.all, dropped, self.start.elapsed());
        let mut stderr = io::stderr();
        let _unheard = write!(stderr, "\r{line}\x1b[K").and_then(|()| stderr.flush());
    }

    /// Clears the line for the next message.
    pub fn end(&self) {
        if self.is_visible && self.shown.is_some() {
            let _unheard = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

fn line(done: u64, all: u64, dropped: u64, elapsed: Duration) -> String {
    let part = done as f64 / all.max(1) as f64;
    let full = (part * WIDTH as f64) as usize;
    let bar = "█".repeat(full) + &"░".repeat(WIDTH.saturating_sub(full));
    let seconds = elapsed.as_secs_f64();
    let rate = done as f64 / seconds.max(1e-3);
    let left = (all - done.min(all)) as f64 / rate.max(1e-9);
    let dropped = match dropped {
        0 => String::new(),
        dropped => format!(", {dropped} dropped"),
    };
    format!("{bar} {done} of {all}{dropped}, {rate:.1} a second, {left:.0} s left")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_says_how_far_it_is() {
        assert_eq!(
            line(3, 12, 0, Duration::from_secs(6)),
            "██████░░░░░░░░░░░░░░░░░░ 3 of 12, 0.5 a second, 18 s left"
        );
        assert_eq!(
            line(12, 12, 2, Duration::from_secs(6)),
            "████████████████████████ 12 of 12, 2 dropped, 2.0 a second, 0 s left"
        );
    }
}
