//! A recording while it is made: one demonstration as a sequence of segments.

mod commands;
mod events;
mod frames;
mod history;

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use tabletop_core::{
    Actor, CommandId, CommandSystems, HandCamera, JointState, SimTick, Timeline, TimelineSegment,
    TimelineStage,
};

use crate::{
    error::RecorderError,
    files::{
        channels::Channels,
        destination::Destination,
        frame::FrameClock,
        new_recording::NewRecording,
        recording_files::RecordingFiles,
        session::{SessionHeader, SessionScene},
    },
    recording::{
        earlier_commands::EarlierCommands,
        objects::RecordedObjects,
        progress::{SegmentStart, UndoneSegment},
        stage::FrameSight,
    },
};

/// A running recording.
#[derive(Debug)]
pub(crate) struct Episode {
    files: RecordingFiles,
    clock: FrameClock,
    objects: RecordedObjects,
    /// The sight at the last frame.
    sight: FrameSight,
    /// The robot's joints at the end of the tick before.
    last_joints: Option<Vec<JointState>>,
    /// True if the simulation is paused where the session log ends.
    is_paused: bool,
    channels: Channels,
    hand_cameras: Arc<[HandCamera]>,
    /// True if the commands of the tick in which it began are not in the session log yet.
    is_beginning: bool,
    /// The present tick.
    tick: SimTick,
    /// The commands of this tick that are in the session log.
    logged: Vec<LoggedCommand>,
    /// The tick and phase of the last command there.
    last: Option<(SimTick, CommandSystems)>,
    /// The marks of this tick's segments, which follow the commands there.
    marks: Vec<u8>,
    /// Length of the session log before the first recorded command.
    head: u64,
    undoable: Vec<SegmentStart>,
    redoable: Vec<UndoneSegment>,
    /// The number of written pictures, those of undone segments included.
    pictures: usize,
}

/// A command in the session log.
#[derive(Clone, Copy, Debug)]
struct LoggedCommand {
    id: CommandId,
    actor: Actor,
    /// Length of the session log before it.
    before: u64,
    /// The tick and phase of the command before it.
    follows: Option<(SimTick, CommandSystems)>,
}

impl Episode {
    /// Begins a recording in a new folder.
    pub(crate) fn begin(
        destination: &Destination,
        header: &SessionHeader,
        scene: &SessionScene,
        earlier: &EarlierCommands,
    ) -> Result<NewRecording<Self>, RecorderError> {
        let lines = earlier.lines();
        let new = RecordingFiles::create(destination, header, scene, lines)?;
        let files = new.opened;
        let objects = scene.objects.iter().map(|object| object.spec.clone());
        let start = SimTick(header.start_tick);
        let opened = Self {
            clock: FrameClock { start },
            head: files.session.len(),
            files,
            objects: RecordedObjects::opening(objects),
            sight: FrameSight::default(),
            last_joints: None,
            is_paused: earlier.is_paused(),
            channels: destination.channels,
            hand_cameras: header.hand_cameras.clone().into(),
            is_beginning: true,
            tick: start,
            logged: Vec::new(),
            last: earlier.last(),
            marks: Vec::new(),
            undoable: Vec::new(),
            redoable: Vec::new(),
            pictures: 0,
        };
        Ok(NewRecording {
            opened,
            moved_aside: new.moved_aside,
        })
    }

    /// Ends a recording that cannot go on. Returns its folder.
    pub(crate) fn abandon(self) -> PathBuf {
        let folder = self.folder().to_owned();
        self.files.abandon();
        folder
    }

    pub(crate) fn folder(&self) -> &Path {
        self.files.folder.path()
    }

    /// The timeline of a recording that begins.
    pub(crate) fn timeline(&self) -> Timeline {
        let start = self.clock.start;
        let opening = TimelineSegment {
            start,
            act: None,
            color: None,
        };
        Timeline {
            stage: TimelineStage::Running,
            folder: self.folder().to_owned(),
            start,
            end: start,
            segments: vec![opening],
            ..Timeline::default()
        }
    }

    pub(crate) fn is_frame(&self, tick: SimTick) -> bool {
        self.clock.is_frame(tick)
    }

    /// The hand cameras whose pictures it holds.
    pub(crate) const fn hand_cameras(&self) -> &Arc<[HandCamera]> {
        &self.hand_cameras
    }

    /// Number of ticks before a frame, from this one on.
    pub(crate) fn ticks_to_frame(&self, tick: SimTick) -> u64 {
        self.clock.tick(self.clock.frame(tick)).0 - tick.0
    }
}
