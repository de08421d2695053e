//! Durations of simulations without a window.

use crate::core::{ClockCommand, StepApp as _, TICKS_PER_SECOND, WriteCommand as _};
use bevy::prelude::*;

use super::range::NumberRange;

/// Durations up to a year.
pub(super) const SECONDS: NumberRange<f64> =
    NumberRange::decimal(0.0, 366.0 * 24.0 * 3600.0).of("seconds");

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
