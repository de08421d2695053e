//! The next recording, as the user wants it.

use std::path::PathBuf;

use bevy::prelude::*;

/// The folder of a recording that the user has given no name.
const NAMELESS: &str = "demo";

/// The next recording: its folder, and what the user writes about it. Takes of one name are numbered.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct NextTake {
    /// The folder of the recordings; empty for the working folder.
    pub shelf: PathBuf,
    /// The name of the takes; empty for a recording without a name, which has no number either.
    pub name: String,
    /// The number of the take, from 1.
    pub number: u32,
    /// The notes that are kept with the recording.
    pub notes: String,
}

impl NextTake {
    /// The folder of the recording.
    pub fn folder(&self) -> PathBuf {
        self.shelf.join(match &*self.name {
            "" => NAMELESS.to_owned(),
            name => format!("{name}-{:02}", self.number),
        })
    }

    /// The number of the take of this name that a folder of recordings has under this name.
    pub fn number_of(&self, folder: &str) -> Option<u32> {
        folder
            .strip_prefix(&self.name)?
            .strip_prefix('-')?
            .parse()
            .ok()
    }

    /// A name as it can be a folder's: without what separates folders, not hidden, and no option of a command line.
    pub fn usable_name(typed: &str) -> String {
        let usable = typed
            .chars()
            .map(|letter| match letter {
                '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|' => '-',
                letter if letter.is_control() => '-',
                letter => letter,
            })
            .take(MOST_LETTERS);
        let usable: String = usable.collect();
        usable.trim_start_matches(['.', ' ', '-']).to_owned()
    }
}

/// Number of letters of a name: with its number and that of a recording that is moved aside, it is a file name everywhere.
const MOST_LETTERS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn takes_are_numbered_and_a_nameless_one_is_the_demo() {
        let mut take = NextTake {
            shelf: "mine".into(),
            name: "letter-u".into(),
            number: 7,
            ..default()
        };
        assert_eq!(take.folder(), PathBuf::from("mine/letter-u-07"));
        for (folder, number) in [
            ("letter-u-07", Some(7)),
            ("letter-u-123", Some(123)),
            ("letter-u", None),
            ("letter-u-07-1", None),
            ("letter-u-", None),
            ("other-07", None),
        ] {
            assert_eq!(take.number_of(folder), number, "{folder}");
        }
        take.name.clear();
        assert_eq!(take.folder(), PathBuf::from("mine/demo"));
        assert_eq!(NextTake::default().folder(), PathBuf::from("demo"));
    }

    #[test]
    fn a_name_stays_in_its_folder() {
        for (typed, name) in [
            ("../../etc/x", "etc-x"),
            ("--best", "best"),
            (".hidden", "hidden"),
            ("two words", "two words"),
            ("tab\there", "tab-here"),
        ] {
            assert_eq!(NextTake::usable_name(typed), name);
        }
        assert_eq!(NextTake::usable_name(&"x".repeat(500)).len(), 60);
    }
}
