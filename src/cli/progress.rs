//! Progress of long commands.

use std::{
    env,
    io::{self, IsTerminal as _, Write as _},
    time::{Duration, Instant},
};

use tabletop_sim::progress::{PROGRESS_VARIABLE, progress_line};

/// A progress line on standard error, if that is a terminal, or a new line each time for a program that asks for it.
pub(super) struct ProgressLine {
    all: u64,
    /// The unit of these numbers, with a space before it.
    unit: &'static str,
    start: Instant,
    shown: Option<Instant>,
    is_visible: bool,
    is_for_program: bool,
}

/// Time between changes of the line.
const PERIOD: Duration = Duration::from_millis(100);
/// Number of characters of the bar.
const WIDTH: usize = 24;

impl ProgressLine {
    pub fn new(all: u64, unit: &'static str) -> Self {
        Self {
            all,
            unit,
            start: Instant::now(),
            shown: None,
            is_visible: io::stderr().is_terminal(),
            is_for_program: env::var_os(PROGRESS_VARIABLE).is_some(),
        }
    }

    /// Sets the number of all items.
    pub const fn expect(&mut self, all: u64) {
        self.all = all;
    }

    /// Shows the number of done items, with a note behind.
    pub fn reach(&mut self, done: u64, note: &str) {
        let is_recent = self.shown.is_some_and(|shown| shown.elapsed() < PERIOD);
        if !(self.is_visible || self.is_for_program) || (is_recent && done < self.all) {
            return;
        }
        self.shown = Some(Instant::now());
        if self.is_for_program {
            let _unheard = writeln!(io::stderr(), "{}", progress_line(done, self.all));
            return;
        }
        let line = self.line(done, note, self.start.elapsed());
        let mut stderr = io::stderr();
        let _unheard = write!(stderr, "\r{line}\x1b[K").and_then(|()| stderr.flush());
    }

    fn line(&self, done: u64, note: &str, elapsed: Duration) -> String {
        let (all, unit) = (self.all, self.unit);
        let part = done as f64 / all.max(1) as f64;
        let full = ((part * WIDTH as f64) as usize).min(WIDTH);
        let bar = "█".repeat(full) + &"░".repeat(WIDTH - full);
        let rate = done as f64 / elapsed.as_secs_f64().max(1e-3);
        let left = (all - done.min(all)) as f64 / rate.max(1e-9);
        format!("{bar} {done} of {all}{unit}{note}, {rate:.1}{unit} a second, {left:.0} s left")
    }

    /// Clears the line for the next message.
    pub fn end(&self) {
        if self.is_visible && self.shown.is_some() {
            let _unheard = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_says_how_far_it_is() {
        let demonstrations = ProgressLine::new(12, "");
        assert_eq!(
            demonstrations.line(3, "", Duration::from_secs(6)),
            "██████░░░░░░░░░░░░░░░░░░ 3 of 12, 0.5 a second, 18 s left"
        );
        let replay = ProgressLine::new(12, " s");
        assert_eq!(
            replay.line(12, ", 2 dropped", Duration::from_secs(6)),
            "████████████████████████ 12 of 12 s, 2 dropped, 2.0 s a second, 0 s left"
        );
    }
}
