//! The end of recordings, and their report.

use bevy::prelude::*;
use tabletop_core::{Recording, RecordingCommand, WriteCommand as _, step_world};

use crate::recording::{recorder::Recorder, report::RecordingReport};

/// The recordings that a world has made so far; `None` without a recorder.
pub fn recording_report(world: &World) -> Option<&RecordingReport> {
    world.get_resource::<Recorder>().map(Recorder::report)
}

/// Finishes the recording that a world is making, if it is making one.
///
/// # Errors
/// A recording has failed, now or before: the fault, and the remedy.
pub fn finish_recording(world: &mut World) -> Result<RecordingReport, String> {
    if world.resource::<Recording>().0 {
        world.write_command(RecordingCommand::Finish);
        step_world(world, 1);
    }
    let report = recording_report(world).cloned().unwrap_or_default();
    match report.failure {
        Some(failure) => Err(failure),
        None => Ok(report),
    }
}
