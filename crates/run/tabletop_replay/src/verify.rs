//! The comparison of a recording with its replay.

use bevy::prelude::default;
use tabletop_recorder::{Durability, RecorderPlugin};
use tabletop_storage::{Storage, TemporaryFolder};

use crate::{Replay, ReplayError, difference::bytes_in};

/// Number of bytes that a replay may write beyond those of the recording. Lines that were cut off are missing there.
const MOST_BEYOND: u64 = 64 << 20;

impl Replay {
    /// Replays the recording into a temporary folder as long as this says so of the number of ticks replayed, and returns the
    /// [first difference](Self::first_difference). A replay that writes far more than the recording holds is not followed to its end.
    ///
    /// # Errors
    /// [`ReplayError::Record`], as with a full disk; or a file of the recording cannot be read.
    pub fn verify(
        &self,
        mut goes_on: impl FnMut(u64) -> bool,
    ) -> Result<Option<String>, ReplayError> {
        let temporary = TemporaryFolder::new("tabletop-replay")
            .map_err(|error| ReplayError::Record(error.to_string()))?;
        let storage = Storage::default();
        let recorder = RecorderPlugin {
            folder: temporary.path().join("replayed"),
            durability: Durability::None,
            storage: storage.clone(),
            ..default()
        };
        let replayed = recorder.folder.clone();
        let most_bytes = bytes_in(self.folder())?.saturating_add(MOST_BEYOND);
        self.record_while(recorder, self.camera(), |ticks| {
            storage.bytes_written() <= most_bytes && goes_on(ticks)
        })?;
        self.first_difference(&replayed)
    }
}
