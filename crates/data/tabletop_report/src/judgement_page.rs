//! The page of a judgement: how often a policy did tasks, with and without perturbations, where it failed, and how that looked.

use std::{collections::BTreeMap, fmt::Write as _};

use tabletop_benchmark::{
    AnswerDelay, JudgedEpisode, PairedOutcomes, PolicyJudgement, SuccessRate, percent,
};
use tabletop_core::TICKS_PER_SECOND;

use crate::{
    html::{escaped, picture_address, table},
    page::page,
};

/// Width and height of the drawing of a rate.
const DRAWING: [f64; 2] = [120.0, 14.0];
/// Room for the mark of a rate beyond its ends.
const MARGIN: f64 = 4.0;

/// The page of a judgement; beside another policy, of which the name and the outcomes are given; with films of episodes, contact sheets in PNG, by their
/// numbers.
pub fn judgement_page(
    judgement: &PolicyJudgement,
    beside: Option<(&str, &[(&str, PairedOutcomes)])>,
    films: &BTreeMap<u64, Vec<u8>>,
) -> String {
    let body = [
        header(judgement),
        rates(judgement),
        perturbations(judgement),
        beside.map_or_else(String::new, |(name, outcomes)| pairs(name, outcomes)),
        failures(judgement),
        contact_sheets(judgement, films),
        repetition(judgement),
    ];
    let header = &judgement.header;
    let title = format!("{}, {}", header.policy, header.benchmark);
    page(&title, &body.concat(), None)
}

fn header(judgement: &PolicyJudgement) -> String {
    let header = &judgement.header;
    let mode = if header.dynamic { ", by motors" } else { "" };
    let delay = match header.delay {
        None => "the simulation waits for each answer".to_owned(),
        Some(AnswerDelay::Measured) => "in real time".to_owned(),
        Some(AnswerDelay::Ms(delay)) => format!("each answer takes {delay} ms"),
    };
    let rate = judgement.rate(None, None);
    let [low, high] = rate.interval().map(percent);
    format!(
        "<header><h1>{}</h1>\n<p class=\"task\">{} of {} episodes done: {} %, between {low} and {high} %</p>\n\
         <p class=\"facts\">{} · {}{mode} · {delay} · tabletop {}</p></header>\n",
        escaped(&header.policy),
        rate.done,
        rate.tried,
        percent(rate.share()),
        escaped(&header.benchmark),
        escaped(&header.robot),
        escaped(&header.program),
    )
}

fn rates(judgement: &PolicyJudgement) -> String {
    let sentences: BTreeMap<_, _> = judgement
        .header
        .tasks
        .iter()
        .map(|task| (task.name.as_str(), task.sentences.as_str()))
        .collect();
    let rows = judgement.task_titles().map(|(title, task)| {
        let told = task.and_then(|task| sentences.get(task)).copied();
        let cells = [escaped(title), escaped(told.unwrap_or_default())];
        let rate = rate_cells(judgement.rate(task, None));
        cells.into_iter().chain(rate).collect()
    });
    let headings = ["task", "is told", "", "done", "rate", "95 % interval"];
    let rows: Vec<Vec<_>> = rows.collect();
    format!("<h2>Rates</h2>\n{}", table(&headings, &rows))
}

/// A rate: drawn, and in numbers.
fn rate_cells(rate: SuccessRate) -> [String; 4] {
    let [low, high] = rate.interval();
    let SuccessRate { done, tried } = rate;
    [
        drawn(rate),
        format!("{done} of {tried}"),
        format!("{} %", percent(rate.share())),
        format!("{} to {} %", percent(low), percent(high)),
    ]
}

/// A rate as a mark on a line from 0 to 1, with its interval.
fn drawn(rate: SuccessRate) -> String {
    let [width, height] = DRAWING;
    let x = |share: f64| MARGIN + share * (width - 2.0 * MARGIN);
    let [low, high] = rate.interval().map(x);
    let (end, middle) = (x(1.0), height / 2.0);
    format!(
        "<svg class=\"rate\" viewBox=\"0 0 {width} {height}\" aria-hidden=\"true\"><path d=\"M{MARGIN} {middle}H{end}\"/>\
         <path class=\"interval\" d=\"M{low:.1} {middle}H{high:.1}\"/><circle cx=\"{:.1}\" cy=\"{middle}\" r=\"{MARGIN}\"/></svg>",
        x(rate.share())
    )
}

fn perturbations(judgement: &PolicyJudgement) -> String {
    let perturbations = &judgement.header.perturbations;
    if perturbations.is_empty() {
        return String::new();
    }
    let none = [String::from("none")].into_iter();
    let none = none.chain(rate_cells(judgement.rate(None, None)));
    let none: Vec<_> = none.chain([const { String::new() }; 3]).collect();
    let perturbed = perturbations.iter().map(|perturbation| {
        let outcomes = PairedOutcomes::of(&judgement.twins(*perturbation));
        let rate = rate_cells(judgement.rate(None, Some(*perturbation)));
        let cells = [perturbation.to_string()].into_iter().chain(rate);
        let compared = [
            outcomes.first.to_string(),
            outcomes.second.to_string(),
            format!("{:.3}", outcomes.significance()),
        ];
        cells.chain(compared).collect()
    });
    let rows: Vec<Vec<_>> = [none].into_iter().chain(perturbed).collect();
    let headings = [
        "perturbation",
        "",
        "done",
        "rate",
        "95 % interval",
        "only without",
        "only with",
        "p",
    ];
    let all = table(&headings, &rows);

    let each = judgement.task_titles().map(|(title, task)| {
        let variants = [None]
            .into_iter()
            .chain(perturbations.iter().copied().map(Some));
        let rates = variants.map(|variant| {
            let SuccessRate { done, tried } = judgement.rate(task, variant);
            format!("{done} of {tried}")
        });
        [escaped(title)].into_iter().chain(rates).collect()
    });
    let rows: Vec<Vec<_>> = each.collect();
    let names = perturbations.iter().map(|perturbation| perturbation.name());
    let headings: Vec<_> = ["task", "none"].into_iter().chain(names).collect();
    let by_task = table(&headings, &rows);
    format!("<h2>Perturbations</h2>\n{all}<h2>Perturbations by task</h2>\n{by_task}")
}

fn pairs(other: &str, outcomes: &[(&str, PairedOutcomes)]) -> String {
    let rows = outcomes.iter().map(|(title, outcomes)| {
        let PairedOutcomes {
            both,
            first,
            second,
            neither,
        } = outcomes;
        let counts = [both, first, second, neither].map(u64::to_string);
        let significance = format!("{:.3}", outcomes.significance());
        let cells = [escaped(title)].into_iter().chain(counts);
        cells.chain([significance]).collect()
    });
    let rows: Vec<Vec<_>> = rows.collect();
    let headings = [
        "task",
        "both",
        "only this",
        "only the other",
        "neither",
        "p",
    ];
    format!(
        "<h2>Beside {}</h2>\n{}",
        escaped(other),
        table(&headings, &rows)
    )
}

fn failures(judgement: &PolicyJudgement) -> String {
    let rows = judgement.failures().into_iter().map(|group| {
        let numbers = group.episodes.iter();
        let numbers: Vec<_> = numbers
            .map(|(_, episode)| episode.episode.to_string())
            .collect();
        let perturbation = group.perturbation.map_or("", |it| it.name());
        vec![
            escaped(group.task),
            perturbation.to_owned(),
            group.steps_done.to_string(),
            escaped(group.step),
            escaped(&group.reasons()),
            numbers.join(", "),
        ]
    });
    let rows: Vec<_> = rows.collect();
    if rows.is_empty() {
        return String::new();
    }
    let headings = [
        "task",
        "perturbation",
        "steps done",
        "first step not done",
        "why",
        "episodes",
    ];
    format!("<h2>Failures</h2>\n{}", table(&headings, &rows))
}

fn contact_sheets(judgement: &PolicyJudgement, films: &BTreeMap<u64, Vec<u8>>) -> String {
    let shown = films.iter().filter_map(|(number, film)| {
        let episode = judgement.episodes().get(number)?;
        Some((episode, film))
    });
    let mut shown: Vec<_> = shown.collect();
    if shown.is_empty() {
        return String::new();
    }
    let place = |episode: &JudgedEpisode| {
        let mut tasks = judgement.header.tasks.iter();
        tasks.position(|task| task.name == episode.task)
    };
    shown.sort_by_key(|(episode, _)| (place(episode), !episode.done));
    let mut html = String::from("<h2>Films</h2>\n");
    for (episode, film) in shown {
        let name = escaped(&episode.name());
        let seconds = episode.ticks as f64 / f64::from(TICKS_PER_SECOND);
        let end = match (&episode.left, &episode.reason) {
            _ if episode.done => "done".to_owned(),
            (Some(left), Some(reason)) => format!("not done: {left} {reason}"),
            (Some(only), None) | (None, Some(only)) => format!("not done: {only}"),
            (None, None) => "not done".to_owned(),
        };
        let _infallible = write!(
            html,
            "<section class=\"film\"><p><b>{name}</b> <span class=\"unit\">{seconds:.1} s</span> {}</p>\n<img alt=\"Pictures of {name}\" src=\"{}\"></section>\n",
            escaped(&end),
            picture_address(film),
        );
    }
    html
}

/// All that decides the results, as the first line of their file has it.
fn repetition(judgement: &PolicyJudgement) -> String {
    // Texts, numbers and lists always have a JSON.
    let json = serde_json::to_string_pretty(&judgement.header).unwrap_or_default();
    format!(
        "<details><summary>What decides the results</summary>\n<pre>{}</pre></details>\n",
        escaped(&json)
    )
}

#[cfg(test)]
mod tests {
    use serde_json::json;
    use tabletop_benchmark::{JudgementHeader, NamedTask, Perturbation};

    use super::*;

    fn judged(perturbation: Option<Perturbation>, done: bool) -> JudgedEpisode {
        JudgedEpisode {
            task: "stack".into(),
            episode: 0,
            perturbation,
            words: None,
            seed: 1,
            beginning: "a".into(),
            done,
            steps: 1,
            steps_done: usize::from(done),
            left: (!done).then(|| "Put A on <B>.".into()),
            failure: (!done).then(|| "premature".into()),
            reason: (!done).then(|| "the policy said so".into()),
            ticks: 90,
        }
    }

    fn judgement() -> PolicyJudgement {
        let mut judgement = PolicyJudgement::new(JudgementHeader {
            benchmark: "benchmark@1".into(),
            program: "1".into(),
            robot: "Panda".into(),
            dynamic: false,
            policy: "ws://<gpu>:8000".into(),
            about: json!({}),
            mapping: None,
            delay: Some(AnswerDelay::Ms(40)),
            tasks: vec![NamedTask {
                name: "stack".into(),
                sentences: "Put A on B.".into(),
            }],
            perturbations: vec![Perturbation::Light],
        });
        judgement.add(judged(None, true)).unwrap();
        judgement
            .add(judged(Some(Perturbation::Light), false))
            .unwrap();
        judgement
    }

    #[test]
    fn a_page_has_rates_perturbations_failures_and_films() {
        let judgement = judgement();
        let films = judgement.filmed().into_iter();
        let films: BTreeMap<_, _> = films.map(|number| (number, b"PNG".to_vec())).collect();
        assert_eq!(films.len(), 2);
        let outcomes = [("stack", PairedOutcomes::default())];
        let page = judgement_page(&judgement, Some(("other.jsonl", &outcomes)), &films);
        for part in [
            "<h1>ws://&lt;gpu&gt;:8000</h1>",
            "1 of 1 episodes done: 100 %, between 21 and 100 %",
            "each answer takes 40 ms",
            "<td>light</td><td><svg",
            "<td>1</td><td>0</td><td>1.000</td>",
            "<h2>Beside other.jsonl</h2>",
            "<td>Put A on &lt;B&gt;.</td><td>1 premature</td><td>0</td>",
            "<b>stack, episode 0</b> <span class=\"unit\">1.5 s</span> done",
            "<b>stack, episode 0, light</b> <span class=\"unit\">1.5 s</span> not done: Put A on &lt;B&gt;. the policy said so",
            "<img alt=\"Pictures of stack, episode 0\" src=\"data:image/png;base64,UE5H\">",
            "&quot;benchmark&quot;: &quot;benchmark@1&quot;",
        ] {
            assert!(page.contains(part), "{part}: {page}");
        }
        let bare = judgement_page(&judgement, None, &BTreeMap::new());
        assert!(
            !bare.contains("<h2>Beside") && !bare.contains("<h2>Films"),
            "{bare}"
        );
    }
}
