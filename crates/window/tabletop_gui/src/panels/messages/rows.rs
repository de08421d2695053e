//! Notices as rows of the same height, so that only those that are seen have to be laid out.

use std::ops::Range;

use tabletop_user::{Notices, Tone};

/// A row: a part of a notice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Row {
    /// Number of the notice, counted from the oldest one.
    pub notice: usize,
    /// The part of its text, in bytes.
    pub part: Range<usize>,
}

/// The rows of all notices that are shown, made anew when something changes.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    made_for: Option<RowInputs>,
    rows: Vec<Row>,
}

/// The inputs that decide the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct RowInputs {
    revision: u64,
    tones: [bool; Tone::ALL.len()],
    columns: usize,
}

impl Rows {
    /// The rows of the notices with these tones, each with at most `columns` letters.
    pub fn of(
        &mut self,
        notices: &Notices,
        tones: [bool; Tone::ALL.len()],
        columns: usize,
    ) -> &[Row] {
        let wanted = RowInputs {
            revision: notices.revision(),
            tones,
            columns,
        };
        if self.made_for != Some(wanted) {
            self.made_for = Some(wanted);
            self.rows.clear();
            for (index, notice) in notices.all().enumerate() {
                if tones[notice.tone as usize] {
                    let parts = parts(&notice.text, columns);
                    let row = |part| Row {
                        notice: index,
                        part,
                    };
                    self.rows.extend(parts.map(row));
                }
            }
        }
        &self.rows
    }
}

/// The parts of a text that fit into a row each: its lines, broken after `columns` letters.
fn parts(text: &str, columns: usize) -> impl Iterator<Item = Range<usize>> {
    let mut next = 0;
    text.split('\n').flat_map(move |line| {
        let start = next;
        next += line.len() + 1;
        broken(line, columns.max(1)).map(move |part| start + part.start..start + part.end)
    })
}

/// A line, broken before the word that does not fit, or within it if it is longer than a row.
fn broken(line: &str, columns: usize) -> impl Iterator<Item = Range<usize>> {
    let mut start = Some(0);
    std::iter::from_fn(move || {
        let from = start?;
        let rest = &line[from..];
        let fits = rest.char_indices().nth(columns).map(|(end, _)| end);
        let end = fits.map(|end| {
            let space = rest[..end].rfind(' ').filter(|&space| space > 0);
            space.map_or(end, |space| space + 1)
        });
        start = end.map(|end| from + end);
        Some(from..end.map_or(line.len(), |end| from + end))
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn texts(text: &str, columns: usize) -> Vec<&str> {
        parts(text, columns).map(|part| &text[part]).collect()
    }

    #[test]
    fn texts_are_broken_between_words_and_long_words_anywhere() {
        assert_eq!(texts("one two three", 8), ["one two ", "three"]);
        assert_eq!(texts("abcdefgh", 3), ["abc", "def", "gh"]);
        assert_eq!(texts("a\n  at b", 20), ["a", "  at b"]);
        assert_eq!(texts("", 20), [""]);
        assert_eq!(texts("äöü äöü", 4), ["äöü ", "äöü"]);
    }

    proptest! {
        #[test]
        fn nothing_is_lost_and_nothing_is_wider_than_a_row(text in "[a-zä \n]{0,80}", columns in 1..20_usize) {
            let rows = texts(&text, columns);
            prop_assert!(rows.iter().all(|row| row.chars().count() <= columns));
            prop_assert_eq!(rows.concat(), text.replace('\n', ""));
        }
    }

    #[test]
    fn rows_are_rebuilt_when_their_content_changes() {
        let mut notices = Notices::default();
        notices.append(Tone::Event, "news");
        notices.append(Tone::Fault, "a fault");
        let mut rows = Rows::default();
        let all = [true; 3];
        assert_eq!(rows.of(&notices, all, 80).len(), 2);
        assert_eq!(rows.of(&notices, all, 5).len(), 3);
        assert_eq!(rows.of(&notices, [false, true, true], 80).len(), 1);
        notices.append(Tone::Fault, "another");
        assert_eq!(rows.of(&notices, all, 80).len(), 3);
    }
}
