//! Judgements: the results of a policy, with all that is needed to repeat them.

use std::{collections::BTreeMap, fmt::Write as _};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{BENCHMARK_VERSION, JudgedEpisode, JudgedTask};

/// What decides the results of a policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JudgementHeader {
    /// The version of tasks and beginnings.
    pub benchmark: String,
    /// The version of the program.
    pub program: String,
    /// The robot's name.
    pub robot: String,
    /// True if its arms are moved by motors with limited torque.
    pub dynamic: bool,
    /// The policy's file or address.
    pub policy: String,
    /// What is known of the policy: the fingerprint of its file, or what its server says of itself.
    pub about: Value,
    /// The name of the mapping, and its fingerprint.
    pub mapping: Option<[String; 2]>,
    /// The tasks, in the order of each round.
    pub tasks: Vec<NamedTask>,
}

/// A task in a judgement.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedTask {
    /// Its name.
    pub name: String,
    /// Its sentences.
    pub sentences: String,
}

impl From<&JudgedTask> for NamedTask {
    fn from(task: &JudgedTask) -> Self {
        Self {
            name: task.name.to_owned(),
            sentences: task.sentences.to_owned(),
        }
    }
}

/// The results of a policy.
#[derive(Clone, Debug, PartialEq)]
pub struct PolicyJudgement {
    /// What decides them.
    pub header: JudgementHeader,
    /// The episodes by their numbers: one of each task, then another one of each.
    episodes: BTreeMap<u64, JudgedEpisode>,
}

impl PolicyJudgement {
    /// One without episodes.
    pub const fn new(header: JudgementHeader) -> Self {
        Self {
            header,
            episodes: BTreeMap::new(),
        }
    }

    /// The number of the episode of a task, if that is one of the header's.
    fn number_of(&self, episode: &JudgedEpisode) -> Option<u64> {
        let tasks = &self.header.tasks;
        let task = tasks.iter().position(|task| task.name == episode.task)?;
        let rounds = episode.episode.checked_mul(tasks.len() as u64)?;
        rounds.checked_add(task as u64)
    }

    /// Adds an episode.
    ///
    /// # Errors
    /// Its task is none of the header's, or it is there already with another result.
    pub fn add(&mut self, episode: JudgedEpisode) -> Result<(), String> {
        let number = self.number_of(&episode);
        let number = number.ok_or_else(|| {
            let task = &episode.task;
            format!("the first line has no task {task:?}")
        })?;
        match self.episodes.get(&number) {
            Some(known) if *known != episode => Err(format!(
                "{}, episode {}: it is there already, with another result",
                episode.task, episode.episode
            )),
            Some(_) | None => {
                self.episodes.insert(number, episode);
                Ok(())
            }
        }
    }

    /// The episodes by their numbers.
    pub const fn episodes(&self) -> &BTreeMap<u64, JudgedEpisode> {
        &self.episodes
    }

    /// True if the episode of a number is there.
    pub fn holds(&self, number: u64) -> bool {
        self.episodes.contains_key(&number)
    }

    /// The first episode that is missing before the last one, by its task and its number.
    pub fn missing(&self) -> Option<(&str, u64)> {
        let numbers = (0..).zip(self.episodes.keys());
        let mut numbers = numbers.filter(|(expected, number)| expected != *number);
        let first = numbers.next().map(|(expected, _)| expected);
        let (count, tasks) = (self.episodes.len() as u64, self.header.tasks.len() as u64);
        let first = first.or_else(|| (!count.is_multiple_of(tasks.max(1))).then_some(count))?;
        let task = self.header.tasks.get((first % tasks) as usize)?;
        Some((&task.name, first / tasks))
    }

    /// The header and the episodes, each in a line of JSON.
    pub fn lines(&self) -> String {
        let mut text = header_line(&self.header);
        for episode in self.episodes.values() {
            text += &episode_line(episode);
        }
        text
    }

    /// The outcomes of this policy and another one in the episodes that are in both, with the task of each pair.
    ///
    /// # Errors
    /// An episode does not begin as that of the other one.
    pub fn beside(&self, other: &Self) -> Result<Vec<(&str, [bool; 2])>, String> {
        let mut pairs = Vec::new();
        let others = other.episodes.values();
        let others: BTreeMap<_, _> = others
            .map(|episode| ((&episode.task, episode.episode), episode))
            .collect();
        for episode in self.episodes.values() {
            let Some(second) = others.get(&(&episode.task, episode.episode)) else {
                continue;
            };
            if episode.beginning != second.beginning {
                let (robot, others) = (&self.header.robot, &other.header.robot);
                let mut fault = format!(
                    "{}, episode {}: it begins otherwise",
                    episode.task, episode.episode
                );
                if robot != others {
                    let _infallible = write!(fault, "; the robot is {others}, and here {robot}");
                }
                return Err(fault);
            }
            pairs.push((episode.task.as_str(), [episode.done, second.done]));
        }
        match pairs.is_empty() {
            true => Err("it has no episode of the same tasks".into()),
            false => Ok(pairs),
        }
    }

    /// Refuses results of another version of the benchmark.
    pub(super) fn check_version(&self) -> Result<(), String> {
        match self.header.benchmark.as_str() {
            BENCHMARK_VERSION => Ok(()),
            other => Err(format!(
                "it is of {other:?}, and this program judges by {BENCHMARK_VERSION:?}"
            )),
        }
    }
}

/// A header as a line of JSON.
pub(super) fn header_line(header: &JudgementHeader) -> String {
    line(serde_json::to_string(header))
}

/// An episode as a line of JSON.
pub(super) fn episode_line(episode: &JudgedEpisode) -> String {
    line(serde_json::to_string(episode))
}

/// Texts, numbers and lists always have a JSON.
fn line(json: serde_json::Result<String>) -> String {
    json.unwrap_or_default() + "\n"
}
