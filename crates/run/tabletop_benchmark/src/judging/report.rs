//! Judgements in words.

use std::fmt::Write as _;

use super::{PairedOutcomes, PolicyJudgement, SuccessRate, percent};

/// How often each task was done, with the interval of its true rate; with perturbations, how often then; and where the others failed.
pub fn report(judgement: &PolicyJudgement) -> String {
    let mut text = String::from("| task | done | rate | 95 % interval |\n|---|---|---|---|\n");
    for (title, task) in judgement.task_titles() {
        let cells = rate_cells(judgement.rate(task, None));
        let _infallible = writeln!(text, "| {title} | {cells} |");
    }
    text + &perturbations(judgement) + &failures(judgement)
}

/// How often something was done, the share, and the interval of the true one.
fn rate_cells(rate: SuccessRate) -> String {
    let [low, high] = rate.interval().map(percent);
    let (SuccessRate { done, tried }, share) = (rate, percent(rate.share()));
    format!("{done} of {tried} | {share} % | {low} to {high} %")
}

/// How often all tasks were done with each perturbation, beside the episodes that begin alike.
fn perturbations(judgement: &PolicyJudgement) -> String {
    if judgement.header.perturbations.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "\n| perturbation | done | rate | 95 % interval | only without | only with | p |\n|---|---|---|---|---|---|---|\n",
    );
    let unperturbed = rate_cells(judgement.rate(None, None));
    let _infallible = writeln!(text, "| none | {unperturbed} | | | |");
    for perturbation in &judgement.header.perturbations {
        let cells = rate_cells(judgement.rate(None, Some(*perturbation)));
        let outcomes = PairedOutcomes::of(&judgement.twins(*perturbation));
        let PairedOutcomes { first, second, .. } = outcomes;
        let significance = outcomes.significance();
        let _infallible = writeln!(
            text,
            "| {perturbation} | {cells} | {first} | {second} | {significance:.3} |"
        );
    }
    text + "\n"
}

/// The failures of each task by the first step that was not done.
fn failures(judgement: &PolicyJudgement) -> String {
    let mut text = String::new();
    for group in judgement.failures() {
        let numbers = group.episodes.iter();
        let numbers = numbers.map(|(_, episode)| episode.episode.to_string());
        let numbers = numbers.collect::<Vec<_>>().join(", ");
        let perturbed = match group.perturbation {
            None => String::new(),
            Some(perturbation) => format!(", {perturbation}"),
        };
        let (task, done, step, reasons) =
            (group.task, group.steps_done, group.step, group.reasons());
        let _infallible = writeln!(
            text,
            "{task}{perturbed}, after {done} steps: {step} {reasons}; episodes {numbers}"
        );
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
    let mut text = String::from(
        "| task | both | only this | only the other | neither | p |\n|---|---|---|---|---|---|\n",
    );
    for (title, outcomes) in judgement.outcomes_beside(other)? {
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
