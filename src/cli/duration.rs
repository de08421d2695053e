//! Durations of simulations without a window.

use bevy::prelude::*;
use tabletop::core::{ClockCommand, StepApp as _, TICKS_PER_SECOND, WriteCommand as _};

/// Reads a time of 0 to a year.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    const YEAR: f64 = 366.0 * 24.0 * 3600.0;
    text.parse()
        .ok()
        .filter(|seconds| (0.0..=YEAR).contains(seconds))
        .ok_or_else(|| format!("expected a number of seconds from 0 to {YEAR}"))
}

/// The ticks in a number of seconds.
pub(super) fn ticks(seconds: f64) -> u64 {
    (seconds * f64::from(TICKS_PER_SECOND)).round() as u64
}

/// Simulates this many ticks. With none, everything is still put on the table.
pub(super) fn pass(app: &mut App, ticks: u64) {
    if ticks == 0 {
        app.world_mut().write_command(ClockCommand::SetPaused(true));
    }
    app.step(ticks.max(1));
}
