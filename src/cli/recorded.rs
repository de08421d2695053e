//! The end of a command's recording.

use crate::recorder::{MovedAside, RecordingReport, finish_recording};
use bevy::prelude::*;

use super::{Failure, terminal::say};

/// Finishes a recording that still runs. The run has failed if a recording has.
pub(super) fn finish(app: &mut App) -> Result<RecordingReport, Failure> {
    finish_recording(app.world_mut()).map_err(Failure::run)
}

/// Says where the earlier recordings are that were in the way.
pub(super) fn say_moved_aside<'m>(moved_aside: impl IntoIterator<Item = &'m MovedAside>) {
    for moved in moved_aside {
        let (from, to) = (moved.from.display(), moved.to.display());
        say(format_args!(
            "tabletop: {from}: the earlier recording there is now {to}"
        ));
    }
}
