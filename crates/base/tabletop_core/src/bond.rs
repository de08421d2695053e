//! Bond points: where objects are fastened to each other, such as a screw's tip and its hole.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use tabletop_geometry::Pose;

/// A point of a composite at which it can be fastened to another object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct BondPoint {
    /// The type of the point. Only points of the same type fit each other.
    pub fit: String,
    /// The end of the bond that this point is.
    pub end: BondEnd,
}

/// The two ends of a bond.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub enum BondEnd {
    /// The end that is fastened: a screw.
    Guest(GuestPoint),
    /// The end that it is fastened to: a hole.
    Host(HostPoint),
}

/// The end of a bond that is fastened.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Reflect)]
pub struct GuestPoint {
    /// Id of the host point to which it is bonded at first; empty for none.
    pub host: String,
    /// Its tightness at first; 0 if it is not bonded.
    pub tightness: u32,
}

/// The end of a bond to which another is fastened. Each step of tightness can act on other parts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Reflect)]
pub struct HostPoint {
    /// Id of the control whose state is the tightness; empty for none.
    pub downstream: String,
    /// Id of the control whose state a step overrides; empty for none.
    pub downstream_override: String,
    /// Id of another host point that a step can lock; empty for none.
    pub downstream_lock: String,
    /// The steps, from the loosest.
    pub steps: Vec<TightnessStep>,
}

impl HostPoint {
    /// The step at a tightness; none at 0.
    pub fn step(&self, tightness: u32) -> Option<&TightnessStep> {
        let number = tightness.checked_sub(1)?;
        self.steps.get(number as usize)
    }

    /// Where the guest point is at a tightness, in the frame of the host point.
    pub fn place(&self, tightness: u32) -> Pose {
        self.step(tightness)
            .map_or(Pose::IDENTITY, |step| step.pose)
    }

    /// How the step to a tightness turns the guest: the axis in the frame of the host point, as long as the angle in rad. It turns the
    /// shorter way; none if there is no such step, or if it does not turn.
    pub fn turn_to(&self, tightness: u32) -> Option<Vec3> {
        let before = self.place(tightness.checked_sub(1)?);
        let turn = self.step(tightness)?.pose.rotation * before.rotation.inverse();
        // Half a turn goes the way that is written.
        let is_longer = turn.w < -LEAST_TURN;
        let turn = if is_longer { -turn } else { turn }.to_scaled_axis();
        (turn.length() > LEAST_TURN).then_some(turn)
    }
}

/// An angle, in rad, below which a step turns nothing.
const LEAST_TURN: f32 = 1e-3;

/// A step of a host point's tightness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, Reflect)]
pub struct TightnessStep {
    /// Pose of the guest point in the frame of the host point.
    pub pose: Pose,
    /// The state that overrides the control's own.
    pub state: Option<u32>,
    /// True if it locks the other host point.
    pub locks: bool,
}

/// A guest point fastened to a host point, and its tightness.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bond {
    /// Id of the host point.
    pub host_point: String,
    /// Id of the object to which the host point belongs.
    pub host: String,
    /// Id of the guest point.
    pub guest_point: String,
    /// Id of the object to which the guest point belongs.
    pub guest: String,
    /// The tightness, as a step; 0 once the bond is gone.
    pub tightness: u32,
}

/// All bonds, in the order in which they were made.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct Bonds(pub Vec<Bond>);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_turns_the_shorter_way_from_the_one_before() {
        let step = |degrees: f32| TightnessStep {
            pose: Pose::from_degrees(Vec3::Z, Vec3::Z * degrees),
            ..default()
        };
        let host = HostPoint {
            steps: [0.0, -90.0, 180.0, 0.0, 360.0].map(step).into(),
            ..default()
        };
        let degrees = |tightness| {
            host.turn_to(tightness)
                .map(|turn| turn.z.to_degrees().round())
        };
        let turns = [0, 1, 2, 3, 4, 5, 6].map(degrees);
        assert_eq!(turns[..4], [None, None, Some(-90.0), Some(-90.0)]);
        assert_eq!(turns[4].map(f32::abs), Some(180.0));
        assert_eq!(turns[5..], [None, None]);
    }
}
