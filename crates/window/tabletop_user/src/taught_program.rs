//! The program that demonstrations mean, in words.

use bevy::prelude::*;

/// The program that the last demonstrations mean, in words. The crate that explains recordings sets it.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct TaughtProgram {
    /// Its sentences; empty if there is none.
    pub sentences: String,
    /// The number of demonstrations that it explains.
    pub demonstrations: usize,
    /// Other programs that may be meant, the shortest first.
    pub others: Vec<OtherProgram>,
    /// The objects like those that were moved which were not, in sentences.
    pub untouched: Vec<String>,
    /// True if the next recording is one more demonstration of it.
    pub is_awaiting: bool,
    /// The reason why no program explains the demonstrations.
    pub fault: Option<String>,
}

/// A program that may be meant, too.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OtherProgram {
    /// Its sentences.
    pub sentences: String,
    /// When it acts differently, such as `if there is another one like the red block`.
    pub differs: String,
}
