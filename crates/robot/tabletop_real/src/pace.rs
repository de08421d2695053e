//! The pace of real time.

use std::{
    thread::sleep,
    time::{Duration, Instant},
};

use bevy::prelude::*;
use tabletop_core::TICKS_PER_SECOND;

/// When the next tick is due.
#[derive(Resource, Default)]
pub(crate) struct TickDue(Option<Instant>);

/// Waits until the next tick is due. What was late is not made up for.
pub(crate) fn wait_for_wall_clock(mut pace: ResMut<TickDue>) {
    let tick = Duration::from_secs(1) / TICKS_PER_SECOND;
    let now = Instant::now();
    let due = pace.0.unwrap_or(now);
    sleep(due.saturating_duration_since(now));
    pace.0 = Some(due.max(now) + tick);
}
