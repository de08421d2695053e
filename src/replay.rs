//! Running a recording again.

use std::{
    collections::BTreeSet,
    fs, io,
    path::{Path, PathBuf},
};

use bevy::prelude::*;
use tabletop_core::{HeadCamera, SimCommand, SimTick, StepApp as _};
use tabletop_recorder::{RecorderError, RecorderPlugin, Session};

use crate::{TabletopSimPlugins, headless_app_with};

/// Why a recording cannot be run again.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// Its session log cannot be read.
    #[error(transparent)]
    Session(#[from] RecorderError),
    /// It does not say what was on the table.
    #[error(
        "{}: the recording began without a scene on the table, so it cannot be run again; \
         load a task file before the recording starts",
        folder.display()
    )]
    NoScene {
        /// The recording's folder.
        folder: PathBuf,
    },
    /// A file of one of the recordings cannot be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// Simulates the recording in a folder again, from its scene on, and records that into another folder, with pictures of
/// the same size or, if a camera is given, as this camera sees it.
///
/// The world goes through the same states if it was at its scene's beginning, or had not been touched since, when the
/// recording started.
///
/// # Errors
///
/// The session log cannot be read, or does not say what was on the table.
pub fn replay(folder: &Path, into: &Path, camera: Option<HeadCamera>) -> Result<(), ReplayError> {
    let session = Session::read(folder.join("session.jsonl"))?;
    let Some(task) = session.scene.task else {
        return Err(ReplayError::NoScene {
            folder: folder.to_owned(),
        });
    };
    let mut app = headless_app_with(TabletopSimPlugins.build().set(RecorderPlugin {
        folder: into.to_owned(),
        header: session.header.settings,
    }));
    if let Some(camera) = camera.or(session.header.camera) {
        app.insert_resource(camera);
    }
    app.insert_resource(SimTick(task.tick));
    let mut begin = vec![SimCommand::SetScene(Box::new(task.scene))];
    let start = session.header.start_tick;
    let last = session
        .commands
        .iter()
        .map(|command| command.tick)
        .fold(start, u64::max);
    let mut commands = session.commands.into_iter().peekable();
    for tick in task.tick..=last {
        for command in begin.drain(..) {
            app.world_mut().write_message(command);
        }
        if tick == start {
            app.world_mut().write_message(SimCommand::StartRecording);
        }
        while let Some(next) = commands.next_if(|next| next.tick <= tick) {
            app.world_mut().write_message(next.command);
        }
        app.step(1);
    }
    Ok(())
}

/// The first file in which two recordings differ, and how.
///
/// # Errors
///
/// A folder or file cannot be read.
pub fn first_difference(recorded: &Path, replayed: &Path) -> Result<Option<String>, ReplayError> {
    let mut files = files_in(recorded)?;
    files.extend(files_in(replayed)?);
    for file in files {
        let name = file.display();
        let (before, after) = (recorded.join(&file), replayed.join(&file));
        let difference = match (before.exists(), after.exists()) {
            (true, false) => format!("{name}: was recorded, and is not there in the replay"),
            (false, true) => format!("{name}: was not recorded, and is there in the replay"),
            _ => {
                let (before, after) = (read(&before)?, read(&after)?);
                if before == after {
                    continue;
                }
                format!("{name}: {}", first_difference_of(&before, &after))
            }
        };
        return Ok(Some(difference));
    }
    Ok(None)
}

/// Where two files differ: line and texts, or for pictures that they do.
fn first_difference_of(before: &[u8], after: &[u8]) -> String {
    let (Ok(before), Ok(after)) = (std::str::from_utf8(before), std::str::from_utf8(after)) else {
        return "the pictures differ".into();
    };
    let (mut before, mut after) = (before.lines(), after.lines());
    let end = "the end of the file";
    for line in 1.. {
        let (was, is) = (before.next(), after.next());
        if was != is || was.is_none() {
            let (was, is) = (was.unwrap_or(end), is.unwrap_or(end));
            return format!("line {line}: recorded `{was}`, replayed `{is}`");
        }
    }
    String::new()
}

/// The files of a recording, relative to its folder, in alphabetical order.
fn files_in(folder: &Path) -> Result<BTreeSet<PathBuf>, ReplayError> {
    let mut files = BTreeSet::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(inner) = folders.pop() {
        let path = folder.join(&inner);
        let failed = |source| ReplayError::Io {
            path: path.clone(),
            source,
        };
        for entry in fs::read_dir(&path).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let name = inner.join(entry.file_name());
            match entry.file_type().map_err(failed)?.is_dir() {
                true => folders.push(name),
                false => {
                    files.insert(name);
                }
            }
        }
    }
    Ok(files)
}

fn read(path: &Path) -> Result<Vec<u8>, ReplayError> {
    fs::read(path).map_err(|source| ReplayError::Io {
        path: path.to_owned(),
        source,
    })
}
