//! Recordings of demonstrations on disk, in the files of the original program, with further files for replays.
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
//! app.world_mut().write_command(RecordingCommand::Start);
//! app.step(60);
//! app.world_mut().write_command(RecordingCommand::Finish);
//! app.step(1);
//!
//! let session = Session::read(folder.join("session.jsonl"))?;
//! assert_eq!(session.commands[0].tick, 60);
//! assert_eq!(session.commands[0].command, SimCommand::Recording(RecordingCommand::Finish));
//! # std::fs::remove_dir_all(folder)?;
//! # Ok::<_, Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod error;
mod files;
mod reading;
mod recording;

pub use error::RecorderError;
pub use files::{
    bounds::object_fault,
    channels::Channels,
    durability::Durability,
    event::Event,
    frame::{FRAMES_PER_SECOND, TICKS_PER_FRAME},
    hand_pictures::HandPictures,
    log_file::whole_lines,
    notes::{NOTES, read_notes, write_notes},
    recording_writer::{RecordingWriter, write_recording},
    session::{
        IMPORTED, Session, SessionCommand, SessionHeader, SessionObject, SessionScene,
        SessionSettings,
    },
    whole_recording::whole_recording,
};
pub use reading::{
    event::{Occurrence, RecordedEvent},
    object_change::ObjectChange,
    original::{LineRemark, OriginalRecording, read_original},
    picture::read_picture,
    recording_reader::RecordingReader,
    rows::{JointRow, StateRow},
    segment::{RecordedFrame, RecordedSegment},
};
pub use recording::{
    finish::{finish_recording, recording_report},
    recorder::{GivenCommands, record_into, set_earlier_commands},
    recorder_plugin::RecorderPlugin,
    report::{MovedAside, RecordingReport},
    unrecorded::UnrecordedPlugin,
};

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{RecorderError, RecorderPlugin, RecordingReader, Session, UnrecordedPlugin};
}
