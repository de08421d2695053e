//! `tabletop dataset`: folders of recordings and LeRobot datasets.

use std::{collections::BTreeSet, path::PathBuf, process::ExitCode};

use crate::dataset::{
    CheckOptions, DatasetFolder, DatasetPart, DatasetSummary, check, divide, merge, repair,
    statistics, summarize, trim, write_card,
};
use clap::{Args, Subcommand};

use super::{
    Failure, Output, import::failed, number_run::run_of, progress::ProgressLine,
    terminal::show_warnings,
};

#[derive(Args)]
pub(super) struct DatasetArgs {
    #[command(subcommand)]
    action: DatasetAction,
}

#[derive(Subcommand)]
enum DatasetAction {
    /// Print how many episodes, frames, seconds, tasks, objects and cameras there are, and their size
    Info(DatasetPlace),
    /// Print the distribution of every number: of lengths, steps, places, states and actions
    Stats(DatasetPlace),
    /// Check every file against its neighbours, and look for duplicates, jumps and tasks that do not last; exit code 1 if there are any
    Check(DatasetCheckArgs),
    /// End or take back what a killed export has left in a LeRobot dataset
    Repair(DatasetPlace),
    /// Make one dataset of several of one kind
    Merge(MergeArgs),
    /// Divide a dataset
    Split(SplitArgs),
    /// Make a dataset without some episodes of another
    Drop(DropArgs),
    /// Make a dataset without the still beginnings and ends of another's episodes
    Trim(TrimArgs),
    /// Write a README.md for a hub into the dataset, with pictures
    Card(DatasetPlace),
}

#[derive(Args)]
struct DatasetPlace {
    /// A recording, a folder of recordings, or a LeRobot dataset
    #[arg(value_name = "DIR")]
    dataset: PathBuf,
}

#[derive(Args)]
struct DatasetCheckArgs {
    #[command(flatten)]
    place: DatasetPlace,
    /// Do not simulate recordings again to see whether their tasks last
    #[arg(long)]
    quick: bool,
}

#[derive(Args)]
struct MergeArgs {
    /// The datasets, in order
    #[arg(value_name = "DIR", required = true)]
    datasets: Vec<PathBuf>,
    /// The folder of the new dataset
    #[arg(long, value_name = "OUT")]
    out: PathBuf,
}

#[derive(Args)]
struct SplitArgs {
    #[command(flatten)]
    place: DatasetPlace,
    /// The folder of the parts
    #[arg(value_name = "OUT")]
    out: PathBuf,
    /// The parts with their shares, such as train=9,valid=1. Every part gets episodes from everywhere in the dataset
    #[arg(long, value_name = "NAME=SHARE,…", value_parser = share, value_delimiter = ',', required = true)]
    into: Vec<(String, u32)>,
}

#[derive(Args)]
struct DropArgs {
    #[command(flatten)]
    place: DatasetPlace,
    /// The folder of the new dataset
    #[arg(value_name = "OUT")]
    out: PathBuf,
    /// The episodes that are left out, from 0, separated by commas: each a number or a run, such as 3 or 5-6
    #[arg(long, value_name = "N,…", value_parser = run_of, value_delimiter = ',', required = true)]
    episodes: Vec<std::ops::RangeInclusive<u32>>,
}

#[derive(Args)]
struct TrimArgs {
    #[command(flatten)]
    place: DatasetPlace,
    /// The folder of the new dataset
    #[arg(value_name = "OUT")]
    out: PathBuf,
}

impl DatasetPlace {
    fn open(&self) -> Result<DatasetFolder, Failure> {
        DatasetFolder::open(&self.dataset).map_err(failed)
    }
}

/// Carries out the action.
pub(super) fn run(args: &DatasetArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let said = match &args.action {
        DatasetAction::Info(place) => described(&summarize(&place.open()?).map_err(failed)?),
        DatasetAction::Stats(place) => table(&place.open()?)?,
        DatasetAction::Check(args) => return checked(args),
        DatasetAction::Repair(place) => repaired(place)?,
        DatasetAction::Merge(args) => {
            let datasets: Result<Vec<_>, _> = args
                .datasets
                .iter()
                .map(|it| DatasetFolder::open(it))
                .collect();
            let episodes = merge(&datasets.map_err(failed)?, &args.out).map_err(failed)?;
            format!("{episodes} episodes.\n")
        }
        DatasetAction::Split(args) => split(args)?,
        DatasetAction::Drop(args) => drop_episodes(args)?,
        DatasetAction::Trim(args) => {
            let trimmed = trim(&args.place.open()?, &args.out).map_err(failed)?;
            let (episodes, frames) = (trimmed.episodes, trimmed.frames);
            format!("{episodes} episodes, {frames} frames cut off.\n")
        }
        DatasetAction::Card(place) => {
            let card = write_card(&place.open()?).map_err(failed)?;
            format!("{}\n", card.display())
        }
    };
    Output::Stdout.write(said.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

fn described(summary: &DatasetSummary) -> String {
    let DatasetSummary {
        kind,
        episodes,
        frames,
        seconds,
        tasks,
        objects,
        cameras,
        bytes,
        imported,
        cut_off,
    } = summary;
    let list = |items: &BTreeSet<String>| {
        let items: Vec<_> = items.iter().map(String::as_str).collect();
        format!("{} ({})", items.len(), items.join(", "))
    };
    let mut lines = vec![
        format!("kind      {kind}"),
        format!("episodes  {episodes}"),
        format!("frames    {frames}"),
        format!("seconds   {seconds:.1}"),
        format!("objects   {}", list(objects)),
        format!("cameras   {}", list(cameras)),
        format!("size      {:.1} MB", *bytes as f64 / 1e6),
    ];
    for (count, what) in [(imported, "imported"), (cut_off, "cut off")] {
        if *count > 0 {
            lines.push(format!("{what:<9} {count}"));
        }
    }
    lines.push(format!("tasks     {}", tasks.len()));
    lines.extend(tasks.iter().map(|(task, count)| match count {
        Some(count) => format!("  {count:>6}  {task}"),
        None => format!("  {task}"),
    }));
    lines.join("\n") + "\n"
}

fn table(dataset: &DatasetFolder) -> Result<String, Failure> {
    let statistics = statistics(dataset).map_err(failed)?;
    let width = statistics.keys().map(|name| name.chars().count()).max();
    let width = width.unwrap_or(0);
    let mut text = format!(
        "{:<width$} {:>9} {:>12} {:>12} {:>12} {:>12}\n",
        "", "count", "min", "mean", "max", "std"
    );
    for (name, number) in &statistics {
        text += &format!(
            "{name:<width$} {:>9} {:>12.4} {:>12.4} {:>12.4} {:>12.4}\n",
            number.count,
            number.min,
            number.mean(),
            number.max,
            number.deviation()
        );
    }
    Ok(text)
}

fn checked(args: &DatasetCheckArgs) -> Result<ExitCode, Failure> {
    let dataset = args.place.open()?;
    let options = CheckOptions {
        simulates: !args.quick,
    };
    let episodes = dataset.episodes();
    let mut line = ProgressLine::new(episodes as u64, "");
    let findings = check(&dataset, options, |done| line.reach(done as u64, ""));
    line.end();
    let findings = findings.map_err(failed)?;
    let mut text: String = findings
        .iter()
        .map(|finding| format!("{finding}\n"))
        .collect();
    let count = findings.len();
    text += &match count {
        0 => format!("{episodes} episodes, nothing wrong.\n"),
        _ => format!("{episodes} episodes, {count} faults.\n"),
    };
    Output::Stdout.write(text.as_bytes())?;
    Ok(ExitCode::from(u8::from(count > 0)))
}

fn repaired(place: &DatasetPlace) -> Result<String, Failure> {
    let repair = repair(&place.dataset).map_err(failed)?;
    let mut text = match repair.export {
        Some(export) => format!("{export}; that is made up for.\n"),
        None => "Nothing to repair.\n".to_owned(),
    };
    for recording in repair.cut_off {
        let recording = recording.display();
        text += &format!(
            "{recording} was cut off; `tabletop replay {recording} --out NEW` makes a complete one of it.\n"
        );
    }
    Ok(text + &format!("{} episodes.\n", repair.episodes))
}

/// Reads a part and its share, such as `train=9`.
fn share(text: &str) -> Result<(String, u32), String> {
    let part = text.split_once('=').and_then(|(name, share)| {
        let share = share
            .parse()
            .ok()
            .filter(|share| (1..=1_000_000).contains(share))?;
        let is_name = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '-' | '_');
        (!name.is_empty() && name.chars().all(is_name)).then(|| (name.to_owned(), share))
    });
    part.ok_or_else(|| "expected a name and a share from 1 to 1000000, such as train=9".into())
}

fn split(args: &SplitArgs) -> Result<String, Failure> {
    let dataset = args.place.open()?;
    let names: BTreeSet<_> = args.into.iter().map(|(name, _)| name).collect();
    if names.len() != args.into.len() {
        return Err(Failure::input("--into names a part twice"));
    }
    let mut parts: Vec<_> = args
        .into
        .iter()
        .map(|(name, _)| DatasetPart {
            name: Some(name.clone()),
            ..DatasetPart::default()
        })
        .collect();
    let all: u64 = args.into.iter().map(|(_, share)| u64::from(*share)).sum();
    for episode in 0..dataset.episodes() {
        // The part that is farthest behind its share.
        let behind = |place: &usize| {
            let due = (episode as u64 + 1) * u64::from(args.into[*place].1);
            due as i128 - (parts[*place].episodes.len() as u64 * all) as i128
        };
        let first_of_all = (0..parts.len()).rev().max_by_key(behind);
        if let Some(place) = first_of_all {
            parts[place].episodes.insert(episode);
        }
    }
    divide(&[dataset], &args.out, &parts).map_err(failed)?;
    let lines = parts.iter().map(|part| {
        let name = part.name.as_deref().unwrap_or_default();
        format!("{name}: {} episodes.\n", part.episodes.len())
    });
    Ok(lines.collect())
}

fn drop_episodes(args: &DropArgs) -> Result<String, Failure> {
    let dataset = args.place.open()?;
    let all = dataset.episodes();
    let dropped: BTreeSet<_> = args.episodes.iter().cloned().flatten().collect();
    if let Some(number) = dropped.iter().find(|number| **number as usize >= all) {
        return Err(Failure::input(format!(
            "{}: there is no episode {number}; it has episodes 0 to {}",
            args.place.dataset.display(),
            all.saturating_sub(1)
        )));
    }
    let episodes = (0..all).filter(|number| !dropped.contains(&(*number as u32)));
    let rest = DatasetPart {
        name: None,
        episodes: episodes.collect(),
    };
    let count = rest.episodes.len();
    divide(&[dataset], &args.out, &[rest]).map_err(failed)?;
    Ok(format!("{count} episodes.\n"))
}
