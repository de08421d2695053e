//! Demonstrations read from folders, be they recordings of this program or of the original one.

use std::path::Path;

use tabletop_core::{JointSpec, ObjectSpec, SimTick, Table};
use tabletop_recorder::{
    RecordedSegment, RecorderError, RecordingReader, TICKS_PER_FRAME, read_original,
};

use crate::{
    demonstration::{Demonstration, ShownObject},
    furniture::Furniture,
    inference::inferred_acts,
    track::Track,
};

impl Demonstration {
    /// Reads a recording, be it one of the original program. The furniture completes its events.
    ///
    /// # Errors
    /// A file cannot be read, or has a line that no recorder writes; the error names the file.
    pub fn read(folder: impl AsRef<Path>, furniture: &Furniture) -> Result<Self, RecorderError> {
        match read_original(&folder)? {
            Some(segments) => Ok(Self::of_events(&segments, TICKS_PER_FRAME, furniture)),
            None => Self::of(&RecordingReader::open(folder)?),
        }
    }

    /// The demonstration of segments of events, which are all that a recording of the original program has. Objects are as the properties in their
    /// events describe them, completed from the furniture. If the events name no hand, its acts are inferred from the poses.
    pub fn of_events(
        segments: &[RecordedSegment],
        ticks_per_frame: u64,
        furniture: &Furniture,
    ) -> Self {
        let mut shown = Self {
            is_poses_only: true,
            ..Self::default()
        };
        shown.follow(segments, ticks_per_frame, true);
        let frames = segments.iter().flat_map(|segment| &segment.events);
        let last = frames.map(|event| event.frame).max().unwrap_or(0);
        shown.end = SimTick(last * ticks_per_frame);
        shown.furnish(furniture);
        if shown.acts.is_empty() {
            shown.acts = inferred_acts(&shown);
        }
        shown
    }

    /// The demonstration of the motions of objects, whose descriptions have their first poses: all that was seen, from tick 0 to the last one. The
    /// acts of the hands are inferred from the motions.
    pub fn of_motions(
        table: Table,
        objects: impl IntoIterator<Item = (ObjectSpec, Track)>,
        joints: Vec<JointSpec>,
        end: SimTick,
    ) -> Self {
        let objects = objects.into_iter().map(|(spec, track)| ShownObject {
            spec,
            track,
            created: SimTick(0),
            deleted: None,
            is_guessed: false,
        });
        let mut shown = Self {
            table,
            objects: objects.collect(),
            joints,
            end,
            is_poses_only: true,
            ..Self::default()
        };
        shown.acts = inferred_acts(&shown);
        shown
    }
}
