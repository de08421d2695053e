//! Jumps: objects that are farther from where they were than anything goes.

use std::collections::BTreeMap;

use bevy::math::Vec3;
use tabletop_core::SimTick;
use tabletop_recorder::StateRow;
use tabletop_training::TrainingEpisode;

use crate::{
    check::finding::Findings,
    limits::{FARTHEST_IN_FRAME, FARTHEST_IN_TICK},
};

/// Finds jumps from tick to tick. An object without a row in a tick is where it was.
pub(super) fn jumps_between_ticks(rows: &[StateRow], findings: &mut Findings) {
    let mut last = BTreeMap::<&str, (SimTick, Vec3)>::new();
    for row in rows {
        let now = row.pose.location;
        let before = last.insert(&row.id, (row.tick, now));
        if let Some((_, before)) = before
            && before.distance(now) > FARTHEST_IN_TICK
        {
            findings.add(format!(
                "{} jumps by {:.1} units in tick {}",
                row.id,
                before.distance(now),
                row.tick.0
            ));
        }
    }
}

/// Finds jumps from frame to frame of the state of objects.
pub(super) fn jumps_between_frames(episode: &TrainingEpisode, findings: &mut Findings) {
    let state = episode.whole_state();
    let names = state.names.iter().enumerate();
    let objects: Vec<_> = names
        .filter_map(|(place, name)| Some((place.checked_sub(3)?, name.strip_suffix(".qx")?)))
        .collect();
    let frames: Vec<_> = state.frames().collect();
    for (number, two) in frames.windows(2).enumerate() {
        for (place, id) in &objects {
            let pose = |frame: &[f32]| frame.get(*place..place + 7).map(<[f32]>::to_vec);
            let (Some(before), Some(now)) = (pose(two[0]), pose(two[1])) else {
                continue;
            };
            // All numbers of an object that is not there are 0.
            let is_there = |pose: &[f32]| pose.iter().any(|value| *value != 0.0);
            let way = Vec3::from_slice(&now).distance(Vec3::from_slice(&before));
            if is_there(&before) && is_there(&now) && way > FARTHEST_IN_FRAME {
                findings.add(format!(
                    "{id} jumps by {way:.1} units in frame {}",
                    number + 1
                ));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::{Pose, Twist};

    use super::*;

    #[test]
    fn a_jump_is_found_and_a_fall_is_none() {
        let row = |tick, x: f32| StateRow {
            tick: SimTick(tick),
            id: "it".into(),
            pose: Pose::at(Vec3::X * x),
            twist: Twist::default(),
        };
        let mut findings = Findings::default();
        jumps_between_ticks(&[row(0, 0.0), row(1, 0.5), row(2, 1.2)], &mut findings);
        assert_eq!(findings.found, []);
        jumps_between_ticks(&[row(0, 0.0), row(1, 3.0)], &mut findings);
        assert_eq!(findings.found[0].problem, "it jumps by 3.0 units in tick 1");
    }
}
