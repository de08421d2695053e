//! Notices to the user.

use std::collections::VecDeque;

use bevy::prelude::*;
use jiff::{Zoned, civil::Time};

/// Older notices are forgotten, so that a script that is refused a million times does not fill the memory.
const MAX_NOTICES: usize = 1000;

/// The tone of a notice, which its colour shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Something has happened.
    Event,
    /// Somebody warns.
    Warning,
    /// Something is wrong.
    Fault,
}

impl Tone {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Event, Self::Warning, Self::Fault];

    /// The plural of notices of this tone.
    pub const fn plural(self) -> &'static str {
        match self {
            Self::Event => "Events",
            Self::Warning => "Warnings",
            Self::Fault => "Faults",
        }
    }

    /// The name of the filter that leaves them out or not.
    pub const fn filter(self) -> &'static str {
        match self {
            Self::Event => "List events",
            Self::Warning => "List warnings",
            Self::Fault => "List faults",
        }
    }
}

/// One message to the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// The number of notices before it, counting those that are forgotten.
    pub number: u64,
    /// Its tone.
    pub tone: Tone,
    /// Its text.
    pub text: String,
    /// The time of day at which it came.
    pub at: Time,
    /// True if it is only listed.
    pub is_quiet: bool,
}

/// The notices in the order in which they came, until the user clears them.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct Notices {
    notices: VecDeque<Notice>,
    /// The number of the next one.
    next: u64,
    /// The number of the first one that the user has not seen in full.
    unseen: u64,
    /// Grows with every change of the notices.
    revision: u64,
}

impl Notice {
    /// The time of day at which it came, as the user reads it.
    pub fn time(&self) -> String {
        self.at.strftime("%H:%M:%S").to_string()
    }
}

impl Notices {
    /// Adds a notice unless it is there already.
    pub fn add(&mut self, tone: Tone, text: &str) {
        if !self.iter().any(|there| there == text) {
            self.append(tone, text);
        }
    }

    /// Adds a notice after all others, as often as it comes.
    pub fn append(&mut self, tone: Tone, text: &str) {
        self.push(tone, text, false);
    }

    /// Adds a line to the list after all others without calling the user's attention to it.
    pub fn log(&mut self, tone: Tone, text: &str) {
        self.push(tone, text, true);
    }

    fn push(&mut self, tone: Tone, text: &str, is_quiet: bool) {
        if self.notices.len() == MAX_NOTICES {
            self.notices.pop_front();
        }
        self.notices.push_back(Notice {
            number: self.next,
            tone,
            text: text.to_owned(),
            at: Zoned::now().time(),
            is_quiet,
        });
        self.next += 1;
        self.revision += 1;
    }

    /// Adds a notice after all others, also if it was there already.
    pub fn renew(&mut self, tone: Tone, text: &str) {
        self.notices.retain(|there| there.text != text);
        self.append(tone, text);
    }

    /// The texts of the notices, oldest first.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &str> {
        self.notices.iter().map(|notice| notice.text.as_str())
    }

    /// True if there are no notices.
    pub fn is_empty(&self) -> bool {
        self.notices.is_empty()
    }

    /// All of them, one below the other.
    pub fn text(&self) -> String {
        self.iter().flat_map(|text| [text, "\n"]).collect()
    }

    /// Forgets them all.
    pub fn clear(&mut self) {
        self.notices.clear();
        self.revision += 1;
    }

    /// The notices, oldest first.
    pub fn all(&self) -> impl ExactSizeIterator<Item = &Notice> + DoubleEndedIterator {
        self.notices.iter()
    }

    /// The notice that is this far from the oldest one.
    pub fn get(&self, index: usize) -> Option<&Notice> {
        self.notices.get(index)
    }

    /// Those that came from this number on.
    pub fn since(&self, number: u64) -> impl Iterator<Item = &Notice> {
        let first = self
            .notices
            .partition_point(|notice| notice.number < number);
        self.notices.range(first..)
    }

    /// The number of the next notice.
    pub const fn next(&self) -> u64 {
        self.next
    }

    /// A number that changes whenever the notices do.
    pub const fn revision(&self) -> u64 {
        self.revision
    }

    /// The number of notices of this tone.
    pub fn count(&self, tone: Tone) -> usize {
        self.all().filter(|notice| notice.tone == tone).count()
    }

    /// The faults that the user has not seen in full.
    pub fn unseen_faults(&self) -> impl Iterator<Item = &Notice> {
        self.since(self.unseen)
            .filter(|notice| notice.tone == Tone::Fault)
    }

    /// The user sees them now.
    pub const fn see(&mut self) {
        self.unseen = self.next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_notices_are_forgotten() {
        let mut notices = Notices::default();
        for number in 0..=MAX_NOTICES {
            notices.add(Tone::Event, &number.to_string());
        }
        assert_eq!(notices.iter().len(), MAX_NOTICES);
        assert_eq!(notices.iter().next(), Some("1"));
        assert!(notices.text().starts_with("1\n2\n"));
    }

    #[test]
    fn a_notice_that_is_there_is_added_only_where_repetition_matters() {
        let mut notices = Notices::default();
        let texts = |notices: &Notices| notices.iter().collect::<Vec<_>>().join(" ");
        for text in ["a", "b", "a"] {
            notices.add(Tone::Event, text);
        }
        assert_eq!(texts(&notices), "a b");
        notices.renew(Tone::Event, "a");
        assert_eq!(texts(&notices), "b a");
        notices.append(Tone::Event, "b");
        assert_eq!(texts(&notices), "b a b");
    }

    #[test]
    fn faults_count_until_they_are_seen() {
        let mut notices = Notices::default();
        for (tone, text) in [
            (Tone::Fault, "one"),
            (Tone::Event, "two"),
            (Tone::Fault, "three"),
        ] {
            notices.add(tone, text);
        }
        assert_eq!(notices.unseen_faults().count(), 2);
        notices.see();
        assert_eq!(notices.unseen_faults().count(), 0);
        notices.add(Tone::Fault, "four");
        let unseen: Vec<_> = notices
            .unseen_faults()
            .map(|notice| &*notice.text)
            .collect();
        assert_eq!(unseen, ["four"]);
    }

    #[test]
    fn numbers_go_on_after_notices_are_forgotten() {
        let mut notices = Notices::default();
        notices.add(Tone::Event, "a");
        notices.clear();
        assert!(notices.is_empty());
        notices.add(Tone::Event, "b");
        let since: Vec<_> = notices.since(1).map(|notice| &*notice.text).collect();
        assert_eq!(since, ["b"]);
        assert_eq!(notices.next(), 2);
    }
}
