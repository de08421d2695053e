//! Recordings of demonstrations on disk, in the files of the original program and with what replays need besides.
//!
//! A recording is one episode in a folder: per segment `n` the events `n.txt` and the pictures `n/<frame>.png`, and for the
//! whole of it the commands `session.jsonl` and the states `states.csv`. `docs/recordings.md` describes the files.
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_core::prelude::*;
//! use tabletop_recorder::{RecorderPlugin, Session};
//!
//! let folder = std::env::temp_dir().join(format!("tabletop_example_{}", std::process::id()));
//! let recorder = RecorderPlugin { folder: folder.clone(), ..default() };
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), recorder)).start();
//!
//! app.world_mut().write_message(SimCommand::StartRecording);
//! app.step(60);
//! app.world_mut().write_message(SimCommand::FinishRecording);
//! app.step(1);
//!
//! let session = Session::read(folder.join("session.jsonl"))?;
//! assert_eq!(session.commands[0].tick, 60);
//! assert_eq!(session.commands[0].command, SimCommand::FinishRecording);
//! # std::fs::remove_dir_all(folder)?;
//! # Ok::<_, Box<dyn std::error::Error>>(())
//! ```

mod cause;
mod change;
mod chronicle;
mod episode;
mod error;
mod event;
mod extent;
mod folder;
mod frame;
mod joints;
mod log_file;
mod order;
mod picture;
mod prelude;
mod properties;
mod reading;
mod recorder;
mod rehearsal;
mod session;
mod stage;
mod states;

pub use error::RecorderError;
pub use event::Event;
pub use frame::{FRAMES_PER_SECOND, TICKS_PER_FRAME};
pub use log_file::whole_lines;
pub use reading::{
    JointRow, Occurrence, RecordedEvent, RecordedFrame, RecordedSegment, RecordingReader, StateRow,
};
pub use recorder::retell;
pub use rehearsal::RehearsalPlugin;
pub use session::{
    Session, SessionCommand, SessionHeader, SessionObject, SessionScene, SessionSettings,
};

use std::path::PathBuf;

use bevy::prelude::*;
use serde_json::{Map, Value};
use tabletop_core::{PictureSystems, SimSystems, TickSystems};

use crate::recorder::{Recorder, ask_for_picture, record, take_commands};

/// Records the simulation into a folder from [`StartRecording`] to [`FinishRecording`], both ticks included.
/// Needs [`CorePlugin`](tabletop_core::CorePlugin).
///
/// It keeps between the phases of a tick: before [`SimSystems::Ingest`] it logs the commands, after [`PictureSystems`]
/// it writes what came of them. Both also happen while paused, so that nothing is missed that is done meanwhile.
///
/// [`StartRecording`]: tabletop_core::SimCommand::StartRecording
/// [`FinishRecording`]: tabletop_core::SimCommand::FinishRecording
#[derive(Clone, Debug)]
pub struct RecorderPlugin {
    /// The folder. What is there when a recording starts is moved aside.
    pub folder: PathBuf,
    /// What the [settings](SessionSettings) are to begin with.
    pub header: Map<String, Value>,
    /// What is written beside the pictures.
    pub channels: Channels,
}

/// What is written of a frame beside its picture, of the same pixels, as PNG files of 16 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Channels {
    /// `<frame>.depth.png`: how far away it is, in tenths of a millimetre along the axis of view; 0 where nothing is.
    pub depth: bool,
    /// `<frame>.ids.png`: what it is; 0 where nothing is, 1 for the table, n + 1 for the object of the recording's n-th `create`
    /// line, 65535 for anything else.
    pub ids: bool,
}

impl Default for RecorderPlugin {
    fn default() -> Self {
        Self {
            folder: "demo".into(),
            header: Map::new(),
            channels: Channels::default(),
        }
    }
}

impl Plugin for RecorderPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Recorder::new(self.folder.clone(), self.channels))
            .insert_resource(SessionSettings(self.header.clone()))
            .add_systems(
                FixedUpdate,
                (
                    take_commands
                        .after(SimSystems::Load)
                        .before(SimSystems::Ingest),
                    ask_for_picture
                        .after(SimSystems::Propagate)
                        .before(SimSystems::Sense),
                    record.after(PictureSystems).before(SimSystems::Record),
                )
                    .in_set(TickSystems),
            );
    }
}
