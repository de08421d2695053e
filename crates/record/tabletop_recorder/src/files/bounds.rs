//! Bounds on the content of a session log: those of task files, and sensible ones for everything else. A stranger's log is checked when it is
//! read.

mod command;
mod object;
mod scene;
mod values;

pub(crate) use command::check_command;
pub(crate) use scene::check_table;

use bevy::math::Vec3;
use tabletop_core::{
    HandCamera, HeadCamera, JointKind, JointSpec, ObjectSpec,
    limits::{DISPLACEMENTS, MASSES, PROPORTIONS, STIFFNESSES, TRAVELS},
};
use tabletop_geometry::Pose;

use crate::files::bounds::{
    object::check_object,
    values::{ANGLES, Checked, at, finite_pose, place, within},
};

/// Ticks from the first command of a log to its end: 30 days.
pub(crate) const MOST_TICKS: u64 = 30 * 24 * 3600 * 60;

/// No tick is later.
const LAST_TICK: u64 = 1 << 53;

/// The first command of a recording, and its start.
pub(crate) fn check_begin(begin_tick: Option<u64>, start_tick: u64) -> Checked {
    let begin = begin_tick.unwrap_or(start_tick);
    if start_tick > LAST_TICK {
        return Err(format!("start_tick: {start_tick} is over {LAST_TICK}"));
    }
    if begin > start_tick {
        return Err(format!(
            "begin_tick: {begin} is after the start in tick {start_tick}"
        ));
    }
    check_ticks(begin, start_tick).map_err(at("start_tick"))
}

/// The cameras of a recording.
pub(crate) fn check_cameras(camera: Option<&HeadCamera>, hand_cameras: &[HandCamera]) -> Checked {
    if let Some(fault) = camera.and_then(HeadCamera::fault) {
        return Err(format!("camera: {fault}"));
    }
    match HandCamera::fault_of(hand_cameras) {
        Some(fault) => Err(format!("hand_cameras: {fault}")),
        None => Ok(()),
    }
}

/// Checks that a recording can last from one tick to another.
pub(crate) fn check_ticks(begin: u64, end: u64) -> Checked {
    match end.saturating_sub(begin) > MOST_TICKS {
        true => Err(format!(
            "tick {end} is more than {MOST_TICKS} ticks (30 days) after the first command in tick {begin}"
        )),
        false => Ok(()),
    }
}

/// The location of an object that is put somewhere.
pub(crate) fn check_location(location: Vec3) -> Checked {
    place("location", location)
}

/// The fault of an object that makes no sense.
pub fn object_fault(object: &ObjectSpec) -> Option<String> {
    check_object(object, &mut 0).err()
}

/// An object may be anywhere when a recording starts.
pub(crate) fn check_present(pose: Pose, object: &ObjectSpec, parts: &mut usize) -> Checked {
    finite_pose(pose)
        .and_then(|()| check_object(object, parts))
        .map_err(at(&object.id))
}

pub(crate) fn check_joint(joint: &JointSpec) -> Checked {
    for frame in joint.frames {
        finite_pose(frame).map_err(at("joints"))?;
    }
    match joint.kind {
        JointKind::Ball | JointKind::Fixed => Ok(()),
        JointKind::Slider {
            min,
            max,
            friction,
            damping,
        } => {
            within("min", min, &DISPLACEMENTS)?;
            within("max", max, &DISPLACEMENTS)?;
            within("friction", friction, &MASSES)?;
            within("damping", damping, &PROPORTIONS)
        }
        JointKind::PushButton { travel, stiffness } => {
            within("travel", travel, &TRAVELS)?;
            within("stiffness", stiffness, &STIFFNESSES)
        }
        JointKind::Shears { min, max } => {
            within("min", min, &ANGLES)?;
            within("max", max, &ANGLES)
        }
        JointKind::Hinge { min, max, damping } => {
            within("min", min, &ANGLES)?;
            within("max", max, &ANGLES)?;
            within("damping", damping, &PROPORTIONS)
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::prelude::default;

    use super::*;

    #[test]
    fn cameras_and_ticks_are_bounded() {
        let large = HeadCamera {
            width: 20_000,
            height: 20_000,
            ..default()
        };
        assert_eq!(check_cameras(Some(&default()), &[]), Ok(()));
        let found = check_cameras(Some(&large), &[]).unwrap_err();
        assert!(found.contains("camera: 20000x20000"), "{found}");
        assert_eq!(check_begin(Some(5), 9), Ok(()));
        for (begin, start, problem) in [
            (Some(10), 9, "begin_tick: 10 is after the start in tick 9"),
            (None, u64::MAX, "start_tick: 18446744073709551615 is over"),
            (Some(5), 1 << 40, "more than 155520000 ticks (30 days)"),
        ] {
            let found = check_begin(begin, start).unwrap_err();
            assert!(found.contains(problem), "{found}");
        }
    }
}
