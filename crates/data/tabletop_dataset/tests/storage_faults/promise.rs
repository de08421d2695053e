//! What must hold afterwards.

use std::{collections::BTreeMap, fs};

use serde_json::Value;
use tabletop_dataset::{DatasetContent, DatasetFolder};
use tabletop_export::{EpisodeFile, LeRobot, LeRobotReader, MatlabFile, McapFile, read_robomimic};
use tabletop_recorder::RecordingReader;
use tabletop_storage::{Patience, Storage, is_taken};

use crate::{
    operation::{Format, Operation},
    workplace::{Workplace, episode},
};

/// What an actor says it has done.
#[derive(Debug)]
pub struct Claim {
    pub operation: Operation,
    pub tasks: Vec<String>,
    pub outcome: Outcome,
}

/// How an operation ended.
#[derive(Debug)]
pub enum Outcome {
    Done,
    Failed(String),
    Killed,
}

/// Checks every promise, repairs what can be repaired, and writes to every place again.
pub fn check(at: &Workplace, claims: &[Claim]) -> Result<(), String> {
    for claim in claims {
        is_said(claim)?;
    }
    check_lerobot(at, claims)?;
    for format in Format::ALL {
        require(at, claims, format)?;
    }
    check_recordings(at, claims)?;
    check_merged(at, claims)?;
    check_card(at, claims)?;
    check_count(at, claims)?;
    check_new(at, claims)?;
    go_on(at)
}

/// Whoever fails names the place.
fn is_said(claim: &Claim) -> Result<(), String> {
    let Outcome::Failed(said) = &claim.outcome else {
        return Ok(());
    };
    let places = match claim.operation {
        Operation::Export(format) => vec![format.place()],
        Operation::Repair | Operation::Read | Operation::Card => vec!["lerobot"],
        Operation::Merge | Operation::Drop | Operation::Trim => vec!["lerobot", "merged"],
        Operation::Edit => vec!["edited"],
        Operation::Multiply => vec!["many"],
        Operation::Count | Operation::Careless => vec!["count"],
        Operation::New => vec!["new"],
    };
    match places.iter().any(|place| said.contains(place)) {
        true => Ok(()),
        false => Err(format!("{:?} says no place: {said}", claim.operation)),
    }
}

fn all_of(claims: &[Claim], operation: Operation) -> impl Iterator<Item = &Claim> {
    claims.iter().filter(move |it| it.operation == operation)
}

fn count_done(claims: &[Claim], operation: Operation) -> usize {
    let all = all_of(claims, operation);
    all.filter(|claim| matches!(claim.outcome, Outcome::Done))
        .count()
}

/// A repair ends in a set that is usable, in which nothing is left of what was cut off.
fn check_lerobot(at: &Workplace, claims: &[Claim]) -> Result<(), String> {
    let folder = at.at("lerobot");
    if !is_taken(&folder) {
        return Ok(());
    }
    let storage = Storage::default().with_patience(Patience::None);
    let repaired = LeRobot::repair(&folder, &storage);
    repaired.map_err(|error| format!("the repair fails: {error}"))?;
    let again = LeRobot::repair(&folder, &storage).map_err(|error| error.to_string())?;
    if again.export.is_some() || again.is_recounted {
        return Err(format!("a second repair finds {again:?}"));
    }
    if count_done(claims, Operation::Export(Format::LeRobot)) > 0 {
        let opened = LeRobotReader::open(&folder);
        opened.map_err(|error| format!("it is not usable: {error}"))?;
    }
    Ok(())
}

/// The sentences of the episodes in a place, each as often as it is there.
fn sentences(at: &Workplace, format: Format, known: &[String]) -> Result<Vec<String>, String> {
    let place = at.at(format.place());
    let error = |error: &dyn ToString| error.to_string();
    match format {
        Format::LeRobot if !is_taken(&place.join("meta/info.json")) => Ok(Vec::new()),
        Format::LeRobot => {
            let reader = LeRobotReader::open(&place).map_err(|it| error(&it))?;
            let mut found = Vec::new();
            let visited = reader.visit(|episode| {
                found.push(episode.task);
                Ok::<_, tabletop_export::ExportError>(())
            });
            visited.map_err(|it| error(&it))?;
            match found.len() == reader.episodes() {
                true => Ok(found),
                false => Err(format!(
                    "it counts {}, and has {found:?}",
                    reader.episodes()
                )),
            }
        }
        Format::Rlds => rlds_sentences(at, known),
        Format::Mcap => files_of::<McapFile>(at, format, known),
        Format::Matlab => files_of::<MatlabFile>(at, format, known),
        Format::Robomimic if !is_taken(&place) => Ok(Vec::new()),
        Format::Robomimic => match read_robomimic(&place) {
            Ok(episodes) => Ok(episodes.into_iter().map(|episode| episode.task).collect()),
            // A new file describes no environment.
            Err(fault) if fault.to_string().contains("env_args has no names") => Ok(Vec::new()),
            Err(fault) => Err(error(&fault)),
        },
    }
}

fn rlds_sentences(at: &Workplace, known: &[String]) -> Result<Vec<String>, String> {
    let info = at.at("rlds/dataset_info.json");
    if !is_taken(&info) {
        return Ok(Vec::new());
    }
    let bytes = fs::read(info).map_err(|error| error.to_string())?;
    let info: Value = serde_json::from_slice(&bytes).map_err(|error| error.to_string())?;
    let mut found = Vec::new();
    let lengths = info["splits"][0]["shardLengths"].as_array().unwrap();
    for (number, length) in lengths.iter().enumerate() {
        let path = at.at(&format!("rlds/rlds-train.tfrecord-{number:05}"));
        let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let mut rest = &bytes[..];
        let mut records = 0;
        while let Some(length) = rest.first_chunk() {
            let length = u64::from_le_bytes(*length) as usize;
            let record = rest.get(12..12 + length).ok_or("a record is cut off")?;
            let text = String::from_utf8_lossy(record);
            found.extend(known.iter().find(|it| text.contains(it.as_str())).cloned());
            rest = rest.get(16 + length..).ok_or("a record is cut off")?;
            records += 1;
        }
        if length.as_str() != Some(&records.to_string()) {
            return Err(format!("{records} records, not {length}"));
        }
    }
    Ok(found)
}

fn files_of<F: EpisodeFile>(
    at: &Workplace,
    format: Format,
    known: &[String],
) -> Result<Vec<String>, String> {
    let content = |task: &String| F::content(&episode(task)).map_err(|error| error.to_string());
    let mut of_content = BTreeMap::new();
    for task in known {
        of_content.insert(content(task)?, task);
    }
    let files = at.shown(format.place()).into_iter().map(|name| {
        let path = at.at(format.place()).join(&name);
        let bytes = fs::read(path).map_err(|error| error.to_string())?;
        let task = of_content.get(&bytes);
        task.map(|&task| task.clone())
            .ok_or_else(|| format!("{name} is not whole"))
    });
    files.collect()
}

/// What was exported is there once, and all or nothing of a dataset's export that failed; of files, each is whole.
fn require(at: &Workplace, claims: &[Claim], format: Format) -> Result<(), String> {
    let operation = Operation::Export(format);
    let known: Vec<_> = all_of(claims, operation)
        .flat_map(|it| it.tasks.clone())
        .collect();
    let found = sentences(at, format, &known).map_err(|error| format!("{format:?}: {error}"))?;
    let mut often = BTreeMap::<&str, usize>::new();
    for task in &found {
        *often.entry(task).or_default() += 1;
    }
    let count = |task: &String| often.get(task.as_str()).copied().unwrap_or(0);
    for claim in all_of(claims, operation) {
        let counts: Vec<_> = claim.tasks.iter().map(count).collect();
        let is_kept = match (&claim.outcome, format) {
            (Outcome::Done, _) => counts.iter().all(|&count| count == 1),
            (Outcome::Failed(_) | Outcome::Killed, Format::LeRobot | Format::Rlds) => {
                counts.iter().all(|&count| count == 1) || counts.iter().all(|&count| count == 0)
            }
            (
                Outcome::Failed(_) | Outcome::Killed,
                Format::Mcap | Format::Matlab | Format::Robomimic,
            ) => counts.iter().all(|&count| count <= 1),
        };
        if !is_kept {
            return Err(format!(
                "{claim:?}: its episodes are there {counts:?} times"
            ));
        }
    }
    match often.keys().all(|task| known.iter().any(|it| it == task)) {
        true => Ok(()),
        false => Err(format!("{format:?}: there are others: {often:?}")),
    }
}

/// Recordings that can be seen are whole, and no fewer than were made.
fn check_recordings(at: &Workplace, claims: &[Claim]) -> Result<(), String> {
    let is_edited = |name: &String| name.starts_with("edited");
    let edited: Vec<_> = at.shown("").into_iter().filter(is_edited).collect();
    let many = at
        .shown("many")
        .into_iter()
        .filter(|name| name != "many.json");
    let many: Vec<_> = many.map(|name| format!("many/{name}")).collect();
    for recording in edited.iter().chain(&many) {
        let read = RecordingReader::open(at.at(recording));
        let read = read.map_err(|error| format!("{recording}: {error}"))?;
        if let Some(tick) = read.cut_off_at() {
            return Err(format!("{recording} is cut off at {tick:?}"));
        }
    }
    let all = all_of(claims, Operation::Edit).count();
    let done = count_done(claims, Operation::Edit);
    if !(done..=all).contains(&edited.len()) {
        return Err(format!(
            "{done} of {all} recordings were edited, there are {edited:?}"
        ));
    }
    if count_done(claims, Operation::Multiply) > 0 && many.len() != 2 {
        return Err(format!("two demonstrations were made, there are {many:?}"));
    }
    Ok(())
}

/// The new folder is there with all that it is to hold, once.
fn check_merged(at: &Workplace, claims: &[Claim]) -> Result<(), String> {
    let operations = [Operation::Merge, Operation::Drop, Operation::Trim];
    let done: usize = operations.map(|it| count_done(claims, it)).iter().sum();
    let path = at.at("merged");
    if done > 1 || (done == 1 && !is_taken(&path)) {
        return Err(format!("{done} made the new folder: {}", is_taken(&path)));
    }
    if !is_taken(&path) {
        return Ok(());
    }
    let merged = DatasetFolder::open(&path).map_err(|error| format!("merged: {error}"))?;
    let DatasetContent::LeRobot(reader) = &merged.content else {
        return Err("merged: it is no dataset".into());
    };
    let mut episodes = 0;
    let visited = reader.visit(|_| {
        episodes += 1;
        Ok::<_, tabletop_export::ExportError>(())
    });
    visited.map_err(|error| format!("merged: {error}"))?;
    match episodes == merged.episodes() {
        true => Ok(()),
        false => Err(format!(
            "merged counts {}, has {episodes}",
            merged.episodes()
        )),
    }
}

/// A card names pictures that are there.
fn check_card(at: &Workplace, claims: &[Claim]) -> Result<(), String> {
    let done = count_done(claims, Operation::Card);
    let card = fs::read_to_string(at.at("lerobot/README.md")).ok();
    if done > 1 || (done == 1 && card.is_none()) {
        return Err(format!("{done} wrote a card, which is {card:?}"));
    }
    let card = card.unwrap_or_default();
    let pictures = card.split('(').filter_map(|text| text.split_once(".png)"));
    let mut paths = pictures.map(|(name, _)| at.at(&format!("lerobot/{name}.png")));
    match paths.find(|path| !is_taken(path)) {
        None => Ok(()),
        Some(path) => Err(format!(
            "the card names {}, which is not there",
            path.display()
        )),
    }
}

fn check_count(at: &Workplace, claims: &[Claim]) -> Result<(), String> {
    let operations = [Operation::Count, Operation::Careless];
    let all: usize = operations.map(|it| all_of(claims, it).count()).iter().sum();
    let done: usize = operations.map(|it| count_done(claims, it)).iter().sum();
    let text = fs::read_to_string(at.at("count")).map_err(|error| error.to_string())?;
    let count = text.parse().map_err(|_| format!("the count is {text:?}"))?;
    match (done..=all).contains(&count) {
        true => Ok(()),
        false => Err(format!("{done} of {all} were counted, and it is {count}")),
    }
}

/// A new file is that of one who made it, whole.
fn check_new(at: &Workplace, claims: &[Claim]) -> Result<(), String> {
    let done = count_done(claims, Operation::New);
    let found = fs::read_to_string(at.at("new")).ok();
    let mut makers = all_of(claims, Operation::New);
    let is_whole = makers.any(|claim| found == Some(claim.tasks.concat()));
    match (done, &found) {
        (0, None) => Ok(()),
        (0 | 1, Some(_)) if is_whole => Ok(()),
        _ => Err(format!("{done} made a new file, which is {found:?}")),
    }
}

/// Whoever comes next can go on everywhere.
fn go_on(at: &Workplace) -> Result<(), String> {
    let storage = Storage::default().with_patience(Patience::None);
    let tasks = ["next".to_owned()];
    let has_card = is_taken(&at.at("lerobot/README.md"));
    for operation in [Operation::Export(Format::LeRobot), Operation::Card]
        .into_iter()
        .take(if has_card { 1 } else { 2 })
        .chain([
            Operation::Export(Format::Rlds),
            Operation::Export(Format::Mcap),
            Operation::Export(Format::Matlab),
            Operation::Export(Format::Robomimic),
            Operation::Edit,
            Operation::Multiply,
            Operation::Count,
        ])
    {
        let performed = operation.perform(at, &tasks, &storage);
        performed.map_err(|error| format!("{operation:?} cannot go on: {error}"))?;
    }
    Ok(())
}
