//! The motion of a driven limb: the speeds and angles that its joints are sent, and where they should be.

use super::state::StopReason;
use crate::{
    limits::{limited_speed, ramped_speed, speed_towards},
    orders::RobotOrder,
    profile::{BridgeProfile, JointProfile},
    state::RobotState,
};

/// How far a joint may be from where it should be, in rad.
pub const MOST_DEVIATION: f64 = 0.3;

/// How fast the expectation of a joint driven by velocities forgets, in s: speeds are followed to some percent, and where they lead to is not known for
/// long. So a joint that stands still is found out if it should turn at 0.3 rad/s or more.
const FORGETTING: f64 = 1.0;

/// The motion of a driven limb.
#[derive(Clone, Debug)]
pub(super) struct LimbMotion {
    /// Its place in the profile.
    pub limb: usize,
    /// The joints' speeds of the last command, in rad/s.
    pub speeds: Vec<f64>,
    /// Where the joints should be, in rad.
    pub expected: Vec<f64>,
    /// True if the last command was of positions.
    pub is_by_positions: bool,
    /// Where it is held.
    pub held: Option<Vec<f64>>,
}

impl LimbMotion {
    /// A limb at this place in the profile, with this many joints, that has not been moved.
    pub fn at_rest(limb: usize, joints: usize) -> Self {
        Self {
            limb,
            speeds: vec![0.0; joints],
            expected: vec![0.0; joints],
            is_by_positions: false,
            held: None,
        }
    }

    /// Turns the joints at wanted speeds, as far as limits let them. `lag` is the time, in s, from the measured angles to the end of the command.
    pub fn turn(
        &mut self,
        joints: &[JointProfile],
        share: f64,
        measured: &[f64],
        wanted: &[f64],
        lag: f64,
        seconds: f64,
    ) -> RobotOrder {
        if self.is_by_positions {
            self.is_by_positions = false;
            self.expected = measured.to_owned();
        }
        for (place, joint) in joints.iter().enumerate() {
            let last = self.speeds[place];
            let ahead = measured[place] + last * lag;
            let limited = limited_speed(joint, share, ahead, wanted[place]);
            let speed = limited_speed(joint, share, ahead, ramped_speed(last, limited, seconds));
            let forgotten = (measured[place] - self.expected[place]) * seconds / FORGETTING;
            self.expected[place] += speed * seconds + forgotten;
            self.speeds[place] = speed;
        }
        RobotOrder::Velocities {
            limb: self.limb,
            speeds: self.speeds.clone(),
        }
    }

    /// Brings the joints nearer to their goals. What is sent are angles on the way, so that a joint is soon found out that does not follow.
    pub fn approach(
        &mut self,
        joints: &[JointProfile],
        share: f64,
        measured: &[f64],
        goals: &[f64],
        seconds: f64,
    ) -> RobotOrder {
        if !self.is_by_positions {
            self.is_by_positions = true;
            self.expected = measured.to_owned();
        }
        for (place, joint) in joints.iter().enumerate() {
            let way = goals[place] - self.expected[place];
            let limited = limited_speed(joint, share, self.expected[place], speed_towards(way));
            let speed = ramped_speed(self.speeds[place], limited, seconds);
            self.speeds[place] = limited_speed(joint, share, self.expected[place], speed);
            self.expected[place] += self.speeds[place] * seconds;
        }
        RobotOrder::Positions {
            limb: self.limb,
            angles: self.expected.clone(),
        }
    }

    pub fn deviation(&self, profile: &BridgeProfile, state: &RobotState) -> Option<StopReason> {
        let joints = &profile.limbs[self.limb].joints;
        let measured = angles(joints, state);
        let deviations = measured
            .iter()
            .zip(&self.expected)
            .map(|(measured, expected)| (measured - expected).abs());
        let (joint, by) = joints
            .iter()
            .zip(deviations)
            .find(|(_, by)| *by > MOST_DEVIATION)?;
        Some(StopReason::Deviation {
            joint: joint.name.clone(),
            by,
        })
    }
}

/// The measured angles of joints, which are known once a state has an age.
pub(super) fn angles(joints: &[JointProfile], state: &RobotState) -> Vec<f64> {
    let angle = |joint: &JointProfile| state.joints.get(&joint.name).map_or(0.0, |it| it.position);
    joints.iter().map(angle).collect()
}
