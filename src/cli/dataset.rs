//! `tabletop dataset`: folders of recordings and LeRobot datasets.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::dataset::{
    CheckOptions, DatasetFolder, DatasetPart, DatasetSummary, check, divide, merge, repair,
    statistics, summarize, trim, write_card,
};
use crate::{export::LeRobotRepair, storage::InnerPath};
use clap::{Args, Subcommand};

use super::{
    Failure, Output,
    counted::counted,
    import::failed,
    number_run::run_of,
    progress::ProgressLine,
    result_file::require_outside,
    terminal::{in_line, show_warnings},
    wait::WaitOption,
};

/// Letters of a name that a table shows.
const MOST_LETTERS: usize = 80;

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
    Repair(ChangedPlace),
    /// Make one dataset of several of one kind
    Merge(MergeArgs),
    /// Divide a dataset
    Split(SplitArgs),
    /// Make a dataset without some episodes of another
    Drop(DropArgs),
    /// Make a dataset without the still beginnings and ends of another's episodes
    Trim(TrimArgs),
    /// Write a README.md for a hub into the dataset, with pictures
    Card(ChangedPlace),
}

#[derive(Args)]
struct DatasetPlace {
    /// A recording, a folder of recordings, or a LeRobot dataset
    #[arg(value_name = "DIR")]
    dataset: PathBuf,
}

/// A dataset that gets files.
#[derive(Args)]
struct ChangedPlace {
    #[command(flatten)]
    place: DatasetPlace,
    #[command(flatten)]
    wait: WaitOption,
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
    #[command(flatten)]
    wait: WaitOption,
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
    #[command(flatten)]
    wait: WaitOption,
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
    #[command(flatten)]
    wait: WaitOption,
}

#[derive(Args)]
struct TrimArgs {
    #[command(flatten)]
    place: DatasetPlace,
    /// The folder of the new dataset
    #[arg(value_name = "OUT")]
    out: PathBuf,
    #[command(flatten)]
    wait: WaitOption,
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
        DatasetAction::Repair(changed) => repaired(changed)?,
        DatasetAction::Merge(args) => {
            let read: Vec<_> = args.datasets.iter().map(PathBuf::as_path).collect();
            require_outside(&args.out, &read)?;
            let datasets: Result<Vec<_>, _> = args
                .datasets
                .iter()
                .map(|it| DatasetFolder::open(it))
                .collect();
            let datasets = datasets.map_err(failed)?;
            let episodes = merge(&datasets, &args.out, &args.wait.storage()).map_err(failed)?;
            counted(episodes, "episode") + ".\n"
        }
        DatasetAction::Split(args) => split(args)?,
        DatasetAction::Drop(args) => drop_episodes(args)?,
        DatasetAction::Trim(args) => {
            require_outside(&args.out, &[&args.place.dataset])?;
            let dataset = args.place.open()?;
            let trimmed = trim(&dataset, &args.out, &args.wait.storage()).map_err(failed)?;
            let episodes = counted(trimmed.episodes, "episode");
            let frames = counted(trimmed.frames as usize, "frame");
            format!("{episodes}, {frames} cut off.\n")
        }
        DatasetAction::Card(changed) => {
            let dataset = changed.place.open()?;
            let card = write_card(&dataset, &changed.wait.storage()).map_err(failed)?;
            format!("{}\n", card.display())
        }
    };
    Output::tell(&said)?;
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
        contradiction,
    } = summary;
    let list = |items: &BTreeSet<String>| {
        let items: Vec<_> = items.iter().map(|item| in_line(item)).collect();
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
    lines.extend(contradiction.iter().map(|it| format!("wrong     {it}")));
    lines.push(format!("tasks     {}", tasks.len()));
    lines.extend(tasks.iter().map(|(task, count)| match count {
        Some(count) => format!("  {count:>6}  {}", in_line(task)),
        None => format!("  {}", in_line(task)),
    }));
    lines.join("\n") + "\n"
}

fn table(dataset: &DatasetFolder) -> Result<String, Failure> {
    let statistics = statistics(dataset).map_err(failed)?;
    let named = statistics
        .iter()
        .map(|(name, number)| (column_of(name), number));
    let named: Vec<_> = named.collect();
    let width = named.iter().map(|(name, _)| name.chars().count()).max();
    let width = width.unwrap_or(0);
    let mut text = format!(
        "{:<width$} {:>9} {:>12} {:>12} {:>12} {:>12}\n",
        "", "count", "min", "mean", "max", "std"
    );
    for (name, number) in named {
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

/// The name of a number in a table, which is not wider for it than a screen.
fn column_of(name: &str) -> String {
    let name = in_line(name);
    match name.char_indices().nth(MOST_LETTERS) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.into_owned(),
    }
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
        .map(|finding| in_line(&finding.to_string()).into_owned() + "\n")
        .collect();
    let count = findings.len();
    text += &match count {
        0 => format!("{}, nothing wrong.\n", counted(episodes, "episode")),
        _ => format!(
            "{}, {}.\n",
            counted(episodes, "episode"),
            counted(count, "fault")
        ),
    };
    Output::tell(&text)?;
    Ok(ExitCode::from(u8::from(count > 0)))
}

fn repaired(changed: &ChangedPlace) -> Result<String, Failure> {
    let repair = repair(&changed.place.dataset, &changed.wait.storage()).map_err(failed)?;
    let LeRobotRepair {
        export,
        is_recounted,
        ..
    } = repair.lerobot;
    let mut text = export.map_or_else(String::new, |export| {
        format!("{export}; that is made up for.\n")
    });
    if is_recounted {
        text += "Totals or statistics were not those of the tables; they are counted anew.\n";
    }
    if text.is_empty() {
        text += "Nothing to repair.\n";
    }
    for recording in repair.cut_off {
        let recording = recording.display();
        text += &format!(
            "{recording} was cut off; `tabletop replay {recording} --out NEW` makes a complete one of it.\n"
        );
    }
    Ok(text + &counted(repair.episodes, "episode") + ".\n")
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
    require_outside(&args.out, &[&args.place.dataset])?;
    let dataset = args.place.open()?;
    let names: BTreeSet<_> = args.into.iter().map(|(name, _)| name).collect();
    if names.len() != args.into.len() {
        return Err(Failure::input("--into names a part twice"));
    }
    let mut parts: Vec<_> = args
        .into
        .iter()
        .map(|(name, _)| DatasetPart {
            name: InnerPath::name(name).ok(),
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
    divide(&[dataset], &args.out, &parts, &args.wait.storage()).map_err(failed)?;
    let lines = parts.iter().map(|part| {
        let name = part.name.as_ref().map(InnerPath::as_path);
        let name = name.unwrap_or(Path::new("")).display();
        format!("{name}: {}.\n", counted(part.episodes.len(), "episode"))
    });
    Ok(lines.collect())
}

fn drop_episodes(args: &DropArgs) -> Result<String, Failure> {
    require_outside(&args.out, &[&args.place.dataset])?;
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
    divide(&[dataset], &args.out, &[rest], &args.wait.storage()).map_err(failed)?;
    Ok(counted(count, "episode") + ".\n")
}
