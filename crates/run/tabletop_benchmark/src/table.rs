//! Scores as a table.

use crate::{
    score::{Score, TeachingResult},
    trials::RobotTrials,
};

/// A table of scores by their families, in Markdown.
pub fn table(scores: &[Score]) -> String {
    let mut families: Vec<_> = scores.iter().map(|score| score.lesson.family).collect();
    families.dedup();
    let rows = families.iter().map(|family| {
        let own = scores.iter().filter(|score| score.lesson.family == *family);
        row(family, &own.collect::<Vec<_>>())
    });
    let all = row("all", &scores.iter().collect::<Vec<_>>());
    let head = "| family | programs | right after 1 | after 2 | after 3 | after 1, or named | after 3, or named |\n|---|---|---|---|---|---|---|";
    let lines: Vec<_> = [head.to_owned()]
        .into_iter()
        .chain(rows)
        .chain([all])
        .collect();
    lines.join("\n") + "\n"
}

fn row(name: &str, scores: &[&Score]) -> String {
    let count = |number: usize, is_so: fn(&TeachingResult) -> bool| {
        let results = scores.iter().filter_map(|score| score.results.get(number));
        results.filter(|result| is_so(result)).count()
    };
    let right = |number| count(number, |it| it.is_right);
    let named = |number| count(number, |it| it.is_right || it.is_named);
    format!(
        "| {name} | {} | {} | {} | {} | {} | {} |",
        scores.len(),
        right(0),
        right(1),
        right(2),
        named(0),
        named(2)
    )
}

/// A table of a robot's trials by their families, in Markdown.
pub fn trials_table(trials: &[RobotTrials]) -> String {
    let mut families: Vec<_> = trials.iter().map(|one| one.lesson.family).collect();
    families.dedup();
    let of = |family: &str| {
        let own = trials.iter().filter(|one| one.lesson.family == family);
        trials_row(family, &own.collect::<Vec<_>>())
    };
    let rows: Vec<_> = families.iter().map(|family| of(family)).collect();
    let all = trials_row("all", &trials.iter().collect::<Vec<_>>());
    let head =
        "| family | programs | tables | done by the robot | without room |\n|---|---|---|---|---|";
    format!("{head}\n{}\n{all}\n", rows.join("\n"))
}

fn trials_row(name: &str, trials: &[&RobotTrials]) -> String {
    let sum = |of: fn(&RobotTrials) -> usize| trials.iter().map(|one| of(one)).sum::<usize>();
    format!(
        "| {name} | {} | {} | {} | {} |",
        trials.len(),
        sum(|one| one.trials.len()),
        sum(RobotTrials::done),
        sum(|one| one.without_room)
    )
}
