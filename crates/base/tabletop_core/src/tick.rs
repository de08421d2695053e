//! Ticks: the unit of simulated time.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// Ticks per second of simulated time.
pub const TICKS_PER_SECOND: u32 = 60;

/// Length of a tick in seconds.
pub const TICK_SECONDS: f32 = 1.0 / TICKS_PER_SECOND as f32;

/// The number of ticks simulated so far.
#[derive(
    Resource,
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    Reflect,
)]
#[reflect(Resource)]
pub struct SimTick(pub u64);
