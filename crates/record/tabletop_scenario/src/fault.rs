//! Numbers of a scenario that make no sense.

use bevy::prelude::*;

/// Longest time that a step may ask for, in seconds.
const LONGEST: f32 = 24.0 * 3600.0;

pub(crate) fn fault_of_vector(vector: Vec3) -> Option<String> {
    (!vector.is_finite()).then(|| "expected three finite numbers".to_owned())
}

pub(crate) fn fault_of_time(seconds: f32) -> Option<String> {
    (!(0.0..=LONGEST).contains(&seconds))
        .then(|| format!("expected a time of 0 to {LONGEST} seconds, found {seconds}"))
}
