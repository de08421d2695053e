//! Recordings of edited segments, simulated beside the frames of the window.

use std::{
    ops::RangeInclusive,
    path::{Path, PathBuf},
};

use bevy::prelude::*;
use tabletop_core::Timeline;
use tabletop_recorder::{Durability, MovedAside, RecorderPlugin, whole_recording};
use tabletop_replay::{Replay, SegmentEdit};
use tabletop_storage::{Storage, TemporaryFolder};
use tabletop_user::TimelineEdit;

use super::drafts::Draft;
use crate::background::BackgroundWork;

/// A recording that is being simulated.
pub(super) struct EditSimulation {
    /// What is done, in words.
    pub present: String,
    /// What it means that this fails.
    pub refusal: &'static str,
    /// The folder of the recording whose commands are simulated.
    pub source: PathBuf,
    pub work: BackgroundWork<Simulated>,
}

/// The result of a simulation.
#[derive(Debug)]
pub(super) enum Simulated {
    Edited(Draft),
    Saved {
        folder: PathBuf,
        moved_aside: Vec<MovedAside>,
    },
}

impl EditSimulation {
    /// Begins to edit the recording of a timeline.
    pub fn edit(timeline: &Timeline, edit: TimelineEdit, allowed: Vec<PathBuf>) -> Self {
        let source = timeline.folder.clone();
        let (edit, present) = understood(edit, timeline);
        Self {
            present,
            refusal: "the edit is refused",
            source: source.clone(),
            work: BackgroundWork::begin(move || edited(&source, edit, &allowed)),
        }
    }

    /// Begins to save the recording in a folder in another one.
    pub fn save(source: PathBuf, folder: PathBuf, allowed: Vec<PathBuf>) -> Self {
        Self {
            present: format!("Saving {}", folder.display()),
            refusal: "the edited recording is not saved",
            source: source.clone(),
            work: BackgroundWork::begin(move || saved(&source, folder, &allowed)),
        }
    }
}

fn edited(source: &Path, edit: SegmentEdit, allowed: &[PathBuf]) -> Result<Simulated, String> {
    let replay = Replay::read_allowing(source, allowed).map_err(|error| error.to_string())?;
    let edited = replay.edited(&[edit]).map_err(|error| error.to_string())?;
    let place = TemporaryFolder::new("tabletop-edit").map_err(|error| error.to_string())?;
    let folder = place
        .path()
        .join(source.file_name().unwrap_or("recording".as_ref()));
    let recorder = RecorderPlugin {
        folder: folder.clone(),
        durability: Durability::None,
        ..default()
    };
    let report = edited.record(recorder, replay.camera());
    report.map_err(|error| error.to_string())?;
    Ok(Simulated::Edited(Draft {
        folder,
        is_saved: false,
        _place: place,
    }))
}

fn saved(source: &Path, folder: PathBuf, allowed: &[PathBuf]) -> Result<Simulated, String> {
    let replay = Replay::read_allowing(source, allowed).map_err(|error| error.to_string())?;
    let report = whole_recording(&folder, &Storage::default(), |folder| {
        let recorder = RecorderPlugin {
            folder: folder.to_owned(),
            ..default()
        };
        replay.record(recorder, replay.camera())
    });
    let (_, moved_aside) = report.map_err(|error| error.to_string())?;
    Ok(Simulated::Saved {
        folder,
        moved_aside: moved_aside.into_iter().collect(),
    })
}

/// The edit as the replayer knows it, and what is done, in words.
fn understood(edit: TimelineEdit, timeline: &Timeline) -> (SegmentEdit, String) {
    match edit {
        TimelineEdit::Delete(segments) => (
            SegmentEdit::Drop(numbers(&segments).collect()),
            format!("Deleting {}", named(&segments)),
        ),
        TimelineEdit::Swap(one, other) => (
            SegmentEdit::Swap(numbers(&one), numbers(&other)),
            format!("Exchanging {} and {}", named(&one), named(&other)),
        ),
        TimelineEdit::Retime { segment, ticks } => {
            let factor = ticks as f64 / timeline.ticks_of(segment) as f64;
            (
                SegmentEdit::Retime(segment as u32, factor),
                format!("Retiming segment {segment}"),
            )
        }
    }
}

fn numbers(segments: &RangeInclusive<usize>) -> RangeInclusive<u32> {
    *segments.start() as u32..=*segments.end() as u32
}

fn named(segments: &RangeInclusive<usize>) -> String {
    let (first, last) = (segments.start(), segments.end());
    match first == last {
        true => format!("segment {first}"),
        false => format!("segments {first} to {last}"),
    }
}
