//! What became of an episode.

use serde::{Deserialize, Serialize};

use super::{Perturbation, beginning::TaskBeginning};

/// What became of an episode of a task.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JudgedEpisode {
    /// The task's name.
    pub task: String,
    /// The number of the episode, from 0.
    pub episode: u64,
    /// In what it differs from the episode of the same task and number in which nothing does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub perturbation: Option<Perturbation>,
    /// The words in which the task was told, if they are others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub words: Option<String>,
    /// The seed of its beginning.
    pub seed: u64,
    /// The fingerprint of its beginning, without the perturbation.
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
        beginning: &TaskBeginning,
        left: Vec<String>,
        failure: Option<(&str, String)>,
        ticks: u64,
    ) -> Self {
        let (task, words) = (beginning.task, &beginning.words);
        let steps = beginning.step_count();
        let steps_done = steps.saturating_sub(left.len());
        let (failure, reason) = failure.unzip();
        let left = left.into_iter().next();
        Self {
            task: task.name.to_owned(),
            episode: beginning.episode,
            perturbation: beginning.perturbation,
            words: (*words != task.words()).then(|| words.clone()),
            seed: beginning.seed,
            beginning: beginning.fingerprint.clone(),
            done: failure.is_none() && left.is_none(),
            steps,
            steps_done,
            left,
            failure: failure.map(str::to_owned),
            reason,
            ticks,
        }
    }

    /// Its task, its number and its perturbation, in words.
    pub fn name(&self) -> String {
        episode_name(&self.task, self.episode, self.perturbation)
    }
}

/// A task, a number and a perturbation, in words.
pub(super) fn episode_name(task: &str, episode: u64, perturbation: Option<Perturbation>) -> String {
    match perturbation {
        None => format!("{task}, episode {episode}"),
        Some(perturbation) => format!("{task}, episode {episode}, {perturbation}"),
    }
}
