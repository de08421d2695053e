//! The end of recordings, and their report.

use bevy::prelude::*;
use tabletop_core::{Recording, RecordingCommand, StepApp as _, WriteCommand as _};

use crate::recording::{recorder::Recorder, report::RecordingReport};

/// The recordings that a world has made so far; `None` without a recorder.
pub fn recording_report(world: &World) -> Option<&RecordingReport> {
    world.get_resource::<Recorder>().map(Recorder::report)
}

/// Finishes the recording that an app is making, if it is making one.
///
/// # Errors
/// A recording has failed, now or before: the fault, and the remedy.
pub fn finish_recording(app: &mut App) -> Result<RecordingReport, String> {
    if app.world().resource::<Recording>().0 {
        app.world_mut().write_command(RecordingCommand::Finish);
        app.step(1);
    }
    let report = recording_report(app.world()).cloned().unwrap_or_default();
    match report.failure {
        Some(failure) => Err(failure),
        None => Ok(report),
    }
}
