//! Progress as lines, which a command writes and the program around it reads.

/// The environment variable that asks a command for its progress, as lines on standard error.
pub const PROGRESS_VARIABLE: &str = "TABLETOP_PROGRESS";

/// The beginning of such a line.
const BEGINNING: &str = "progress ";

/// The line of this progress.
pub fn progress_line(done: u64, all: u64) -> String {
    format!("{BEGINNING}{done} {all}")
}

/// The items that are done, and all of them, if a line tells progress.
pub fn progress_in(line: &str) -> Option<(u64, u64)> {
    let (done, all) = line.strip_prefix(BEGINNING)?.split_once(' ')?;
    Some((done.parse().ok()?, all.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_reads_back() {
        assert_eq!(progress_in(&progress_line(3, 12)), Some((3, 12)));
        for other in ["", "progress", "progress 3", "progress x 12", "3 12"] {
            assert_eq!(progress_in(other), None);
        }
    }
}
