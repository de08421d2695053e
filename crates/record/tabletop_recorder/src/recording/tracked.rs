//! Tracking of objects: whether they have changed enough to be reported.

use bevy::math::Vec3;
use tabletop_geometry::Pose;

use crate::files::states::ObjectState;

/// Square of the distance, in units, beyond which a move is reported.
const REPORTED_DISTANCE_SQUARED: f32 = 0.001;

/// Angle, in degrees about any of the three axes, beyond which a turn is reported.
const REPORTED_DEGREES: f32 = 0.5;

/// A recording's memory of an object on the table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tracked {
    pub(crate) id: String,
    /// Number of its `create` line in the recording, from 1.
    pub(crate) number: usize,
    /// Its state at the end of the tick before.
    last: Option<ObjectState>,
    /// The pose in its last `move` line.
    reported: Option<Pose>,
}

impl Tracked {
    pub(crate) fn new(id: &str, number: usize) -> Self {
        Self {
            id: id.to_owned(),
            number,
            last: None,
            reported: None,
        }
    }

    /// True if a frame at which it is here needs a `move` line: it was never reported; or has come to rest (it is, to the
    /// bit, where it was a tick ago) somewhere else than last reported; or is farther from there than the thresholds.
    pub(crate) fn is_report_due(&self, pose: Pose) -> bool {
        self.reported.is_none_or(|reported| {
            let rests = self.last.is_some_and(|last| is_same(last.pose, pose));
            rests && self.is_elsewhere(pose) || is_far(reported, pose)
        })
    }

    /// True if it is anywhere else, by any bit, than its last `move` line says.
    pub(crate) fn is_elsewhere(&self, pose: Pose) -> bool {
        self.reported
            .is_none_or(|reported| !is_same(reported, pose))
    }

    pub(crate) fn report(&mut self, pose: Pose) {
        self.reported = Some(pose);
    }

    /// Notes its state at the end of a tick, and says whether that differs in any bit from the tick before.
    pub(crate) fn note(&mut self, state: ObjectState) -> bool {
        let last = self.last.replace(state);
        !last.is_some_and(|last| last.is_same(state))
    }
}

fn is_same(a: Pose, b: Pose) -> bool {
    bits(a) == bits(b)
}

fn bits(pose: Pose) -> [u32; 7] {
    let Vec3 { x, y, z } = pose.location;
    let [qx, qy, qz, qw] = pose.rotation.to_array();
    [x, y, z, qx, qy, qz, qw].map(f32::to_bits)
}

fn is_far(a: Pose, b: Pose) -> bool {
    a.location.distance_squared(b.location) > REPORTED_DISTANCE_SQUARED
        || (a.degrees() - b.degrees())
            .to_array()
            .into_iter()
            .any(|difference| {
                let turn = difference.abs() % 360.0;
                turn.min(360.0 - turn) > REPORTED_DEGREES
            })
}

#[cfg(test)]
mod tests {
    use bevy::prelude::default;

    use super::*;

    fn still(pose: Pose) -> ObjectState {
        ObjectState { pose, ..default() }
    }

    fn reported_at(pose: Pose) -> Tracked {
        let mut tracked = Tracked::new("it", 1);
        tracked.note(still(pose));
        tracked.report(pose);
        tracked
    }

    fn turned(z: f32) -> Pose {
        Pose::from_degrees(Vec3::ZERO, Vec3::new(0.0, 0.0, z))
    }

    #[test]
    fn an_object_that_was_never_reported_is_reported() {
        assert!(Tracked::new("it", 1).is_report_due(Pose::IDENTITY));
        assert!(!reported_at(Pose::IDENTITY).is_report_due(Pose::IDENTITY));
    }

    #[test]
    fn moves_are_reported_beyond_the_square_root_of_a_thousandth() {
        let tracked = reported_at(Pose::IDENTITY);
        assert!(!tracked.is_report_due(Pose::at(Vec3::X * 0.0316)));
        assert!(tracked.is_report_due(Pose::at(Vec3::X * 0.0317)));
        assert!(!tracked.is_report_due(Pose::at(Vec3::splat(0.0182))));
        assert!(tracked.is_report_due(Pose::at(Vec3::splat(0.0183))));
    }

    #[test]
    fn turns_are_reported_beyond_half_a_degree_about_any_axis() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            let tracked = reported_at(Pose::IDENTITY);
            let turned = |degrees: f32| Pose::from_degrees(Vec3::ZERO, axis * degrees);
            assert!(!tracked.is_report_due(turned(0.49)));
            assert!(tracked.is_report_due(turned(0.51)));
            assert!(tracked.is_report_due(turned(-0.51)));
        }
    }

    #[test]
    fn a_turn_past_180_degrees_is_small() {
        let tracked = reported_at(turned(179.8));
        assert!(!tracked.is_report_due(turned(-179.9)));
        assert!(tracked.is_report_due(turned(-179.6)));
    }

    #[test]
    fn a_change_of_velocity_alone_is_noted_and_no_event() {
        let mut tracked = reported_at(Pose::IDENTITY);
        let mut state = still(Pose::IDENTITY);
        assert!(!tracked.note(state));
        state.twist.angular.z = 1e-9;
        assert!(!tracked.is_report_due(state.pose));
        assert!(tracked.note(state));
    }

    #[test]
    fn an_object_that_comes_to_rest_is_reported_once() {
        let mut tracked = reported_at(Pose::IDENTITY);
        let rest = Pose::at(Vec3::X * 1e-6);
        assert!(!tracked.is_report_due(rest), "it still moves");
        assert!(tracked.is_elsewhere(rest));
        assert!(tracked.note(still(rest)));
        assert!(tracked.is_report_due(rest), "it has come to rest");
        tracked.report(rest);
        assert!(!tracked.note(still(rest)));
        assert!(!tracked.is_report_due(rest), "it is where it was reported");
        assert!(!tracked.is_elsewhere(rest));
    }
}
