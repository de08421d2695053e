//! What a judgement comes to: rates, failures in groups, and policies beside each other.

use std::collections::{BTreeMap, BTreeSet};

use super::{JudgedEpisode, PairedOutcomes, Perturbation, PolicyJudgement, SuccessRate};

/// The most kinds of failures of a task that are worth a film.
const FILMED: usize = 3;

/// Failures of a task that ended before the same step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FailureGroup<'a> {
    /// The task.
    pub task: &'a str,
    /// In what their beginnings differ from the task's own.
    pub perturbation: Option<Perturbation>,
    /// Number of steps that were done.
    pub steps_done: usize,
    /// The first step that was not done.
    pub step: &'a str,
    /// The classes of the failures, with their numbers.
    pub classes: BTreeMap<&'a str, usize>,
    /// The episodes by their numbers in the judgement.
    pub episodes: Vec<(u64, &'a JudgedEpisode)>,
}

impl FailureGroup<'_> {
    /// The classes of the failures, in words.
    pub fn reasons(&self) -> String {
        let classes = self.classes.iter();
        let classes = classes.map(|(class, count)| format!("{count} {class}"));
        classes.collect::<Vec<_>>().join(", ")
    }
}

impl PolicyJudgement {
    /// How often a task was done with a perturbation, or without one; all tasks together if none is named.
    pub fn rate(&self, task: Option<&str>, perturbation: Option<Perturbation>) -> SuccessRate {
        let episodes = self.episodes().values();
        let own = episodes.filter(|episode| {
            episode.perturbation == perturbation && task.is_none_or(|task| episode.task == task)
        });
        SuccessRate::of(own.map(|episode| episode.done))
    }

    /// The names of the tasks, each also as the one to be counted, and last all together.
    pub fn task_titles(&self) -> impl Iterator<Item = (&str, Option<&str>)> {
        let tasks = self.header.tasks.iter().map(|task| task.name.as_str());
        let titles = tasks.map(|name| (name, Some(name)));
        titles.chain([("all", None)])
    }

    /// The failures of each task, with and without perturbations, by the first step that was not done.
    pub fn failures(&self) -> Vec<FailureGroup<'_>> {
        let mut groups = BTreeMap::<_, FailureGroup>::new();
        let failed = self.episodes().iter().filter(|(_, episode)| !episode.done);
        for (number, episode) in failed {
            let mut tasks = self.header.tasks.iter();
            let place = tasks.position(|task| task.name == episode.task);
            let (perturbation, steps_done) = (episode.perturbation, episode.steps_done);
            let step = episode
                .left
                .as_deref()
                .unwrap_or("It was done, but not known to be.");
            let key = (place, perturbation, steps_done, step);
            let group = groups.entry(key).or_insert_with(|| FailureGroup {
                task: &episode.task,
                perturbation,
                steps_done,
                step,
                classes: BTreeMap::new(),
                episodes: Vec::new(),
            });
            let class = episode.failure.as_deref().unwrap_or("not done");
            *group.classes.entry(class).or_default() += 1;
            group.episodes.push((*number, episode));
        }
        groups.into_values().collect()
    }

    /// The numbers of the episodes that are worth a film: of each task a success, and one of each of the first kinds of failures.
    pub fn filmed(&self) -> BTreeSet<u64> {
        let failures = self.failures();
        let tasks = self.header.tasks.iter().map(|task| task.name.as_str());
        let filmed = tasks.flat_map(|task| {
            let mut episodes = self.episodes().iter();
            let success = episodes.find(|(_, episode)| episode.task == task && episode.done);
            let success = success.map(|(number, _)| *number);
            let own = failures.iter().filter(move |group| group.task == task);
            let firsts = own.filter_map(|group| Some(group.episodes.first()?.0));
            success.into_iter().chain(firsts.take(FILMED))
        });
        filmed.collect()
    }

    /// This policy beside another one: what both came to in each task that is in both, and last in all.
    ///
    /// # Errors
    /// They do not begin alike.
    pub fn outcomes_beside(&self, other: &Self) -> Result<Vec<(&str, PairedOutcomes)>, String> {
        let pairs = self.beside(other)?;
        let rows = self.task_titles().map(|(title, task)| {
            let own = pairs.iter();
            let own = own.filter(|[one, _]| task.is_none_or(|task| one.task == task));
            (title, PairedOutcomes::of(own))
        });
        Ok(rows.filter(|(_, it)| it.count() > 0).collect())
    }
}

/// A share as a number of percents.
pub fn percent(share: f64) -> String {
    format!("{:.0}", share * 100.0)
}
