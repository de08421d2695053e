//! What demonstrations mean, in lines.

use crate::program::Meaning;

/// The first line of a file that has a program.
pub(super) const HEADING: &str = "# What demonstrations mean";

/// The words with which the comment of a table begins that decides what is meant.
pub(super) const ASKED: &str = "Which is meant?";

/// What else demonstrations may mean, with the numbers of `--answer`, and what was not moved in them.
pub(super) fn told(meaning: &Meaning) -> Vec<String> {
    let alternatives = meaning.alternatives.iter().zip(1..);
    let alternatives = alternatives.map(|(other, number)| {
        let program = other.program.to_string().replace('\n', " ");
        let differs = &other.decided_by.sentence;
        format!("Or {number}: {program} It differs {differs}.")
    });
    let untouched = not_moved(&meaning.untouched);
    alternatives.chain(untouched).collect()
}

/// The objects that were not moved, with what they are.
pub(super) fn not_moved(untouched: &[(String, Vec<String>)]) -> Vec<String> {
    let lines = untouched.iter();
    let lines = lines.map(|(kind, ids)| format!("Not moved, but of {kind}: {}.", ids.join(", ")));
    lines.collect()
}
