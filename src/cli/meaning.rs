//! What demonstrations mean, in lines.

use crate::program::{Meaning, Untouched};

/// The first line of a file that has a program.
pub(super) const HEADING: &str = "# What demonstrations mean";

/// The words with which the comment of a table begins that decides what is meant.
pub(super) const ASKED: &str = "Which is meant?";

/// What else demonstrations may mean, with the numbers of `--answer`, and what was not moved in them.
pub(super) fn told(meaning: &Meaning) -> Vec<String> {
    let alternatives = meaning.alternatives.iter().zip(1..);
    let alternatives = alternatives.map(|(other, number)| {
        let program = other.program.in_a_line();
        let differs = &other.decided_by.sentence;
        format!("Or {number}: {program} It differs {differs}.")
    });
    let untouched = meaning.untouched.iter().map(Untouched::to_string);
    alternatives.chain(untouched).collect()
}
