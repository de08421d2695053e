//! The ranges of numbers, and how many there may be.

use std::ops::RangeInclusive;

use bevy::math::{Quat, Vec3};
use tabletop_core::limits::{MOST_LINKS, SPANS};
use tabletop_geometry::Pose;

/// Objects and other elements of a scene, with the parts of composites.
pub(super) const MOST_PARTS: usize = 100_000;

/// Values in a command: markers, drives, letters of an id.
pub(super) const MOST_VALUES: usize = 1 << 20;

/// Angles of a joint, in radians: half a turn to each side, with room for rounding.
pub(super) const ANGLES: RangeInclusive<f32> = -3.15..=3.15;

pub(super) const FRICTIONS: RangeInclusive<f32> = 0.0..=1000.0;

pub(super) const VELOCITIES: RangeInclusive<f32> = -1000.0..=1000.0;

pub(super) const SIDES: RangeInclusive<u32> = 3..=u32::MAX;

pub(super) const LINKS: RangeInclusive<u32> = 1..=MOST_LINKS;

pub(super) const PLACES: RangeInclusive<f32> = -1e6..=1e6;

pub(super) type Checked = Result<(), String>;

pub(super) fn check_sides(sides: u32) -> Checked {
    match SIDES.contains(&sides) {
        true => Ok(()),
        false => Err(format!(
            "{sides} sides, expected at least {}",
            SIDES.start()
        )),
    }
}

pub(super) fn check_parts(count: usize) -> Checked {
    match count > MOST_PARTS {
        true => Err(format!(
            "a scene has more than {MOST_PARTS} objects and parts"
        )),
        false => Ok(()),
    }
}

pub(super) fn check_count(name: &str, count: usize) -> Checked {
    match count > MOST_VALUES {
        true => Err(format!("{count} {name}, expected at most {MOST_VALUES}")),
        false => Ok(()),
    }
}

pub(super) fn at(place: &str) -> impl Fn(String) -> String {
    move |problem| format!("{place}: {problem}")
}

pub(super) fn within(name: &str, value: f32, range: &RangeInclusive<f32>) -> Checked {
    match range.contains(&value) {
        true => Ok(()),
        false => Err(format!(
            "{name}: {value} is not from {} to {}",
            range.start(),
            range.end()
        )),
    }
}

pub(super) fn spans(name: &str, span: Vec3) -> Checked {
    span.to_array()
        .into_iter()
        .try_for_each(|value| within(name, value, &SPANS))
}

pub(super) fn place(name: &str, location: Vec3) -> Checked {
    location
        .to_array()
        .into_iter()
        .try_for_each(|value| within(name, value, &PLACES))
}

pub(super) fn check_place(pose: Pose) -> Checked {
    place("location", pose.location)?;
    rotation(pose.rotation)
}

pub(super) fn finite(name: &str, value: Vec3) -> Checked {
    match value.is_finite() {
        true => Ok(()),
        false => Err(format!("{name}: a number is not finite")),
    }
}

pub(super) fn finite_pose(pose: Pose) -> Checked {
    finite("location", pose.location)?;
    rotation(pose.rotation)
}

pub(super) fn rotation(rotation: Quat) -> Checked {
    match (rotation.length_squared() - 1.0).abs() < 0.01 {
        true => Ok(()),
        false => Err("rotation: it is no unit quaternion".into()),
    }
}
