//! What became of an episode.

use serde::{Deserialize, Serialize};

use super::{beginning::TaskBeginning, tasks::JudgedTask};

/// What became of an episode of a task.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JudgedEpisode {
    /// The task's name.
    pub task: String,
    /// The number of the episode, from 0.
    pub episode: u64,
    /// The seed of its beginning.
    pub seed: u64,
    /// The fingerprint of its beginning.
    pub beginning: String,
    /// True if the task was done.
    pub done: bool,
    /// Number of steps of the task.
    pub steps: usize,
    /// Number of steps that were done in the end.
    pub steps_done: usize,
    /// The first step that was not done.
    pub left: Option<String>,
    /// The class of the failure.
    pub failure: Option<String>,
    /// The failure in words.
    pub reason: Option<String>,
    /// Simulated time, in ticks.
    pub ticks: u64,
}

impl JudgedEpisode {
    /// The result of an episode that began so: what was left to do in the end, and what the policy failed by, as a class and in words.
    pub fn new(
        task: &JudgedTask,
        episode: u64,
        beginning: &TaskBeginning,
        left: Vec<String>,
        failure: Option<(&str, String)>,
        ticks: u64,
    ) -> Self {
        let steps_done = beginning.steps.saturating_sub(left.len());
        let (failure, reason) = failure.unzip();
        let left = left.into_iter().next();
        Self {
            task: task.name.to_owned(),
            episode,
            seed: beginning.seed,
            beginning: beginning.fingerprint.clone(),
            done: failure.is_none() && left.is_none(),
            steps: beginning.steps,
            steps_done,
            left,
            failure: failure.map(str::to_owned),
            reason,
            ticks,
        }
    }
}
