//! Judgements: the results of a policy, with all that is needed to repeat them.

use std::{collections::BTreeMap, fmt::Write as _};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{BENCHMARK_VERSION, JudgedEpisode, JudgedTask, Perturbation, episode::episode_name};

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
    /// The time that answers take, if the simulation runs on meanwhile.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub delay: Option<AnswerDelay>,
    /// The tasks, in the order of each round.
    pub tasks: Vec<NamedTask>,
    /// The perturbations in which each beginning is tried once more, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub perturbations: Vec<Perturbation>,
}

/// The time for which the simulation runs on until a policy answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AnswerDelay {
    /// As long as it takes, which no run repeats.
    Measured,
    /// So many milliseconds.
    Ms(u64),
}

impl JudgementHeader {
    /// Number of episodes of a round: of each task one without a perturbation, and one with each.
    pub const fn round(&self) -> u64 {
        self.tasks.len() as u64 * self.variants()
    }

    /// The task of the episode of a number, the episode's number among those of the task, and its perturbation.
    pub fn episode(&self, number: u64) -> Option<(&NamedTask, u64, Option<Perturbation>)> {
        let (tasks, variants) = (self.tasks.len() as u64, self.variants());
        let round = number / variants;
        let episode = round.checked_div(tasks)?;
        let task = self.tasks.get((round % tasks) as usize)?;
        let perturbation = (number % variants).checked_sub(1);
        let perturbation = perturbation.and_then(|it| self.perturbations.get(it as usize));
        Some((task, episode, perturbation.copied()))
    }

    /// The episode of a number in words.
    pub fn episode_name(&self, number: u64) -> Option<String> {
        let (task, episode, perturbation) = self.episode(number)?;
        Some(episode_name(&task.name, episode, perturbation))
    }

    /// The number of an episode, if its task and its perturbation are of these.
    fn number_of(&self, episode: &JudgedEpisode) -> Option<u64> {
        let mut tasks = self.tasks.iter();
        let task = tasks.position(|task| task.name == episode.task)?;
        let variant = match episode.perturbation {
            None => 0,
            Some(perturbation) => {
                let mut known = self.perturbations.iter();
                1 + known.position(|it| *it == perturbation)?
            }
        };
        let rounds = episode.episode.checked_mul(self.round())?;
        rounds.checked_add(task as u64 * self.variants() + variant as u64)
    }

    const fn variants(&self) -> u64 {
        1 + self.perturbations.len() as u64
    }
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
    /// The episodes by their numbers: of each task one without and one with each perturbation, then another round of them.
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

    /// Adds an episode.
    ///
    /// # Errors
    /// Its task or its perturbation is none of the header's, or it is there already with another result.
    pub fn add(&mut self, episode: JudgedEpisode) -> Result<(), String> {
        let number = self.header.number_of(&episode);
        let number = number.ok_or_else(|| {
            let task = &episode.task;
            match episode.perturbation {
                None => format!("the first line has no task {task:?}"),
                Some(it) => format!("the first line has no task {task:?} with {:?}", it.name()),
            }
        })?;
        match self.episodes.get(&number) {
            Some(known) if *known != episode => {
                let name = episode.name();
                Err(format!("{name}: it is there already, with another result"))
            }
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

    /// The number of the first episode that is missing before the last one of a round.
    pub fn missing(&self) -> Option<u64> {
        let numbers = (0..).zip(self.episodes.keys());
        let mut numbers = numbers.filter(|(expected, number)| expected != *number);
        let first = numbers.next().map(|(expected, _)| expected);
        let (count, round) = (self.episodes.len() as u64, self.header.round());
        first.or_else(|| (!count.is_multiple_of(round.max(1))).then_some(count))
    }

    /// The header and the episodes, each in a line of JSON.
    pub fn lines(&self) -> String {
        let mut text = header_line(&self.header);
        for episode in self.episodes.values() {
            text += &episode_line(episode);
        }
        text
    }

    /// The episodes of this policy and those of another one that are in both, in pairs.
    ///
    /// # Errors
    /// An episode does not begin as that of the other one.
    pub fn beside<'a>(&'a self, other: &'a Self) -> Result<Vec<[&'a JudgedEpisode; 2]>, String> {
        let key =
            |episode: &'a JudgedEpisode| (&episode.task, episode.episode, episode.perturbation);
        let others = other.episodes.values();
        let others: BTreeMap<_, _> = others.map(|episode| (key(episode), episode)).collect();
        let mut pairs = Vec::new();
        for episode in self.episodes.values() {
            let Some(second) = others.get(&key(episode)) else {
                continue;
            };
            if episode.beginning != second.beginning {
                let (robot, others) = (&self.header.robot, &other.header.robot);
                let mut fault = format!("{}: it begins otherwise", episode.name());
                if robot != others {
                    let _infallible = write!(fault, "; the robot is {others}, and here {robot}");
                }
                return Err(fault);
            }
            pairs.push([episode, second]);
        }
        match pairs.is_empty() {
            true => Err("it has no episode of the same tasks".into()),
            false => Ok(pairs),
        }
    }

    /// The episodes without a perturbation, each with the one that begins alike and has this one, in pairs.
    pub fn twins(&self, perturbation: Perturbation) -> Vec<[&JudgedEpisode; 2]> {
        let place = self
            .header
            .perturbations
            .iter()
            .position(|it| *it == perturbation);
        let own = self.episodes.iter();
        let own = own.filter(|(_, episode)| episode.perturbation.is_none());
        let pairs = own.filter_map(|(number, episode)| {
            let twin = self.episodes.get(&(number + 1 + place? as u64))?;
            Some([episode, twin])
        });
        pairs.collect()
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
