//! What an actor does.

use std::{
    fmt::{Debug, Display},
    fs, io,
};

use serde_json::json;
use tabletop_dataset::{DatasetFolder, DatasetPart, divide, merge, trim, write_card};
use tabletop_episodes::Collection;
use tabletop_export::{
    DatasetFormat, ExportError, LeRobot, LeRobotReader, Matlab, Mcap, Rlds, Robomimic,
};
use tabletop_recorder::{RecorderError, whole_recording};
use tabletop_storage::{Storage, WriterLock};

use crate::workplace::{Workplace, demo, episode};

/// What an actor does to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    Export(Format),
    Repair,
    Read,
    Merge,
    Drop,
    Trim,
    Card,
    Edit,
    Multiply,
    Count,
    New,
    /// Counts without a lock: what the search must find.
    Careless,
}

/// The format of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    LeRobot,
    Rlds,
    Mcap,
    Matlab,
    Robomimic,
}

impl Format {
    pub const ALL: [Self; 5] = [
        Self::LeRobot,
        Self::Rlds,
        Self::Mcap,
        Self::Matlab,
        Self::Robomimic,
    ];

    pub const fn place(self) -> &'static str {
        match self {
            Self::LeRobot => "lerobot",
            Self::Rlds => "rlds",
            Self::Mcap => "mcap",
            Self::Matlab => "mat",
            Self::Robomimic => "file.hdf5",
        }
    }
}

impl Operation {
    pub const ALL: [Self; 15] = [
        Self::Export(Format::LeRobot),
        Self::Export(Format::Rlds),
        Self::Export(Format::Mcap),
        Self::Export(Format::Matlab),
        Self::Export(Format::Robomimic),
        Self::Repair,
        Self::Read,
        Self::Merge,
        Self::Drop,
        Self::Trim,
        Self::Card,
        Self::Edit,
        Self::Multiply,
        Self::Count,
        Self::New,
    ];

    /// Does it. What it adds has these sentences. The error is what a user would read.
    pub fn perform(
        self,
        at: &Workplace,
        tasks: &[String],
        storage: &Storage,
    ) -> Result<(), String> {
        match self {
            Self::Export(format) => export(format, at, tasks, storage),
            Self::Repair => said(LeRobot::repair(&at.at("lerobot"), storage).map(drop)),
            Self::Read => read(at),
            Self::Merge => {
                said(set(at).and_then(|set| merge(&[set], &at.at("merged"), storage).map(drop)))
            }
            Self::Drop => said(set(at).and_then(|set| {
                let part = DatasetPart {
                    name: None,
                    episodes: [0].into(),
                };
                divide(&[set], &at.at("merged"), &[part], storage)
            })),
            Self::Trim => {
                said(set(at).and_then(|set| trim(&set, &at.at("merged"), storage).map(drop)))
            }
            Self::Card => said(set(at).and_then(|set| write_card(&set, storage).map(drop))),
            Self::Edit => said(edit(at, storage)),
            Self::Multiply => multiply(at, storage),
            Self::Count => {
                let lock = WriterLock::of_place(&at.at("count"), storage);
                let counted = lock.and_then(|_alone| count(at, storage));
                said(counted).map_err(|error| format!("count: {error}"))
            }
            Self::Careless => said(count(at, storage)).map_err(|error| format!("count: {error}")),
            Self::New => {
                let text = tasks.concat();
                let made = storage.write_new(&at.at("new"), text.as_bytes());
                said(made).map_err(|error| format!("new: {error}"))
            }
        }
    }
}

fn said<T, E: Display>(result: Result<T, E>) -> Result<T, String> {
    result.map_err(|error| error.to_string())
}

fn set(at: &Workplace) -> Result<DatasetFolder, tabletop_dataset::DatasetError> {
    DatasetFolder::open(&at.at("lerobot"))
}

fn export(
    format: Format,
    at: &Workplace,
    tasks: &[String],
    storage: &Storage,
) -> Result<(), String> {
    let place = at.at(format.place());
    said(match format {
        Format::LeRobot => LeRobot::open(place, storage).and_then(|it| add(it, tasks)),
        Format::Rlds => Rlds::open(place, storage).and_then(|it| add(it, tasks)),
        Format::Mcap => Mcap::open(place, storage).and_then(|it| add(it, tasks)),
        Format::Matlab => Matlab::open(place, storage).and_then(|it| add(it, tasks)),
        Format::Robomimic => Robomimic::open(place, storage).and_then(|it| add(it, tasks)),
    })
}

fn add<F: DatasetFormat>(mut dataset: F, tasks: &[String]) -> Result<(), ExportError> {
    for task in tasks {
        dataset.write(F::prepare(episode(task))?)?;
    }
    dataset.finish()
}

/// Reads the dataset, of which every episode that it counts is there.
fn read(at: &Workplace) -> Result<(), String> {
    let reader = said(LeRobotReader::open(&at.at("lerobot")))?;
    let mut episodes = 0;
    let visited = reader.visit(|_| {
        episodes += 1;
        Ok::<_, ExportError>(())
    });
    said(visited)?;
    assert_eq!(
        episodes,
        reader.episodes(),
        "a reader sees other episodes than are counted"
    );
    Ok(())
}

/// Makes a recording of another.
fn edit(at: &Workplace, storage: &Storage) -> Result<(), RecorderError> {
    let to = at.at("edited");
    whole_recording(&to, storage, |folder| {
        let copied = storage.copy_folder(demo(), folder);
        copied.map_err(|source| RecorderError::Create {
            path: folder.to_owned(),
            source,
        })
    })
    .map(drop)
}

/// Makes two demonstrations.
fn multiply(at: &Workplace, storage: &Storage) -> Result<(), String> {
    let manifest = json!({ "made_of": "demo" });
    let collection = said(Collection::open(
        &at.at("many"),
        "many.json",
        &manifest,
        storage,
    ))?;
    for number in 0..2 {
        if !said(collection.holds(number, |_| true))? {
            let part = collection.part(number);
            let copied = storage.copy_folder(demo(), &part);
            copied.map_err(|error| format!("many: {error}"))?;
            said(collection.keep(number))?;
        }
    }
    said(collection.close())
}

/// Counts one more, as a setting of two windows.
fn count(at: &Workplace, storage: &Storage) -> io::Result<()> {
    let path = at.at("count");
    let number: u32 = fs::read_to_string(&path)?
        .parse()
        .map_err(io::Error::other)?;
    storage.replace(&path, (number + 1).to_string().as_bytes())
}
