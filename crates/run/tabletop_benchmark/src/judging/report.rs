//! Judgements in words.

use std::{collections::BTreeMap, fmt::Write as _};

use super::{PairedOutcomes, PolicyJudgement, SuccessRate};

/// How often each task was done, with the interval of its true rate, and where the others failed.
pub fn report(judgement: &PolicyJudgement) -> String {
    let episodes = judgement.episodes();
    let rate = |name: Option<&str>| {
        let own = episodes.values();
        let own = own.filter(|episode| name.is_none_or(|name| episode.task == name));
        SuccessRate::of(own.map(|episode| episode.done))
    };
    let mut text = String::from("| task | done | rate | 95 % interval |\n|---|---|---|---|\n");
    let tasks = &judgement.header.tasks;
    let rows = tasks
        .iter()
        .map(|task| (task.name.as_str(), Some(task.name.as_str())));
    for (title, name) in rows.chain([("all", None)]) {
        let rate = rate(name);
        let [low, high] = rate.interval().map(percent);
        let (SuccessRate { done, tried }, share) = (rate, percent(rate.share()));
        let _infallible = writeln!(
            text,
            "| {title} | {done} of {tried} | {share} % | {low} to {high} % |"
        );
    }
    text + &failures(judgement)
}

/// The failures of each task by the first step that was not done.
fn failures(judgement: &PolicyJudgement) -> String {
    let mut text = String::new();
    for task in &judgement.header.tasks {
        let mut groups = BTreeMap::<(usize, &str), (BTreeMap<&str, usize>, Vec<String>)>::new();
        let own = judgement.episodes().values();
        for episode in own.filter(|episode| episode.task == task.name && !episode.done) {
            let step = episode
                .left
                .as_deref()
                .unwrap_or("It was done, but not known to be.");
            let (classes, numbers) = groups.entry((episode.steps_done, step)).or_default();
            let class = episode.failure.as_deref().unwrap_or("not done");
            *classes.entry(class).or_default() += 1;
            numbers.push(episode.episode.to_string());
        }
        for ((done, step), (classes, numbers)) in groups {
            let classes = classes
                .iter()
                .map(|(class, count)| format!("{count} {class}"));
            let classes = classes.collect::<Vec<_>>().join(", ");
            let (name, numbers) = (&task.name, numbers.join(", "));
            let _infallible = writeln!(
                text,
                "{name}, after {done} steps: {step} {classes}; episodes {numbers}"
            );
        }
    }
    text
}

/// A policy beside another one in the episodes of both.
///
/// # Errors
/// They do not begin alike.
pub fn paired_report(
    judgement: &PolicyJudgement,
    other: &PolicyJudgement,
) -> Result<String, String> {
    let pairs = judgement.beside(other)?;
    let mut text = String::from(
        "| task | both | only this | only the other | neither | p |\n|---|---|---|---|---|---|\n",
    );
    let tasks = &judgement.header.tasks;
    let rows = tasks
        .iter()
        .map(|task| (task.name.as_str(), Some(task.name.as_str())));
    for (title, name) in rows.chain([("all", None)]) {
        let own = pairs
            .iter()
            .filter(|(task, _)| name.is_none_or(|name| name == *task));
        let outcomes = PairedOutcomes::of(own.map(|(_, pair)| *pair));
        if outcomes.count() == 0 {
            continue;
        }
        let PairedOutcomes {
            both,
            first,
            second,
            neither,
        } = outcomes;
        let significance = outcomes.significance();
        let _infallible = writeln!(
            text,
            "| {title} | {both} | {first} | {second} | {neither} | {significance:.3} |"
        );
    }
    Ok(text)
}

/// A share as a number of percents.
fn percent(share: f64) -> String {
    format!("{:.0}", share * 100.0)
}
