//! The simulated robot as a mirror of the real one.

use std::{collections::BTreeMap, time::Duration};

use bevy::prelude::*;
use tabletop_bridge::RobotState;
use tabletop_core::{
    Actor, CommandWriter, JointName, JointRole, MeasuredJoint, RobotCommand, RobotLayout,
    TICK_SECONDS,
};

use crate::RealRobot;

/// Tells where the joints of the real robot are, and what its grippers say. That is no order, and never becomes one.
pub(crate) fn follow(
    In(will_be_paused): In<bool>,
    real: Res<RealRobot>,
    layout: Res<RobotLayout>,
    mut last: Local<LastMeasured>,
    mut commands: CommandWriter,
) {
    if real.is_added() {
        *last = LastMeasured::default();
    }
    let measured = last.followed_by(&real.state(), &layout);
    if !will_be_paused {
        commands.write(Actor::RealRobot, RobotCommand::Mirror(measured));
    }
}

/// What was measured last.
#[derive(Default)]
pub(crate) struct LastMeasured {
    at: Option<Duration>,
    joints: BTreeMap<JointName, MeasuredJoint>,
}

impl LastMeasured {
    /// The joints of the layout as far as the real robot has them. Speeds that it does not measure are those since the state before.
    fn followed_by(
        &mut self,
        state: &RobotState,
        layout: &RobotLayout,
    ) -> Vec<(JointName, MeasuredJoint)> {
        let since = |at: Duration| Some(at.checked_sub(self.at?)?.as_secs_f64());
        let since = state.joints_at.and_then(since).filter(|time| *time > 0.0);
        let turned = layout.joints.iter().filter_map(|joint| match joint.role {
            JointRole::Limb { .. } | JointRole::Neck => {
                let reading = state.joints.get(&joint.urdf_name)?;
                let velocity = reading.velocity.filter(|velocity| velocity.is_finite());
                let last = self.joints.get(&joint.name);
                let between = || match (last, since) {
                    (Some(last), Some(time)) => (reading.position - last.position) / time,
                    (Some(last), None) => last.velocity,
                    (None, _) => 0.0,
                };
                let torque = reading.effort.filter(|torque| torque.is_finite());
                let measured = MeasuredJoint {
                    position: reading.position,
                    velocity: velocity.unwrap_or_else(between),
                    torque: torque.unwrap_or(0.0),
                    grips: None,
                };
                Some((joint.name, measured))
            }
            JointRole::Gripper(_) => None,
        });
        let opened = layout.limbs.iter().filter_map(|limb| {
            let gripper = state.grippers.get(limb.name.as_str())?;
            let joint = layout.joint(limb.gripper.joint);
            let [_, widest] = joint.limits;
            let position = gripper.opening * widest;
            let last = self.joints.get(&joint.name);
            let way = last.map_or(0.0, |last| position - last.position);
            let measured = MeasuredJoint {
                position,
                velocity: way / f64::from(TICK_SECONDS),
                torque: 0.0,
                grips: Some(gripper.is_gripping),
            };
            Some((joint.name, measured))
        });
        let measured = turned.chain(opened).filter(|(_, joint)| joint.is_finite());
        let measured: Vec<_> = measured.collect();
        self.at = state.joints_at;
        self.joints = measured.iter().copied().collect();
        measured
    }
}

#[cfg(test)]
mod tests {
    use tabletop_bridge::{GripperReading, JointReading};
    use tabletop_core::RobotJoint;

    use super::*;

    fn state(milliseconds: u64, position: f64, velocity: Option<f64>) -> RobotState {
        let reading = JointReading {
            position,
            velocity,
            effort: Some(3.0),
        };
        RobotState {
            joints: BTreeMap::from([("left_s0".into(), reading)]),
            joints_at: Some(Duration::from_millis(milliseconds)),
            ..RobotState::default()
        }
    }

    fn speeds(states: &[RobotState]) -> Vec<f64> {
        let mut last = LastMeasured::default();
        let measured = states.iter().map(|state| {
            let measured = last.followed_by(state, RobotLayout::baxter());
            assert_eq!(measured.len(), 1);
            assert_eq!(measured[0].0, RobotJoint::LeftS0.name());
            assert_eq!(measured[0].1.torque, 3.0);
            measured[0].1.velocity
        });
        measured.collect()
    }

    #[test]
    fn a_speed_that_is_not_measured_is_that_since_the_state_before() {
        let states = [
            state(10, 0.5, None),
            state(20, 0.51, None),
            // The same state again.
            state(20, 0.51, None),
            state(40, 0.51, None),
        ];
        let speeds = speeds(&states);
        assert_eq!(speeds[0], 0.0);
        assert!((speeds[1] - 1.0).abs() < 1e-9);
        assert_eq!(speeds[2], speeds[1]);
        assert_eq!(speeds[3], 0.0);
    }

    #[test]
    fn a_measured_speed_is_taken_and_what_is_no_number_is_not() {
        let states = [state(10, 0.5, Some(0.2)), state(20, 0.5, Some(f64::NAN))];
        assert_eq!(speeds(&states), [0.2, 0.0]);
    }

    #[test]
    fn a_gripper_says_whether_it_holds_something() {
        let reading = GripperReading {
            id: 1,
            is_calibrated: true,
            is_gripping: true,
            has_error: false,
            opening: 0.25,
            sequence: None,
            at: Duration::ZERO,
        };
        let state = RobotState {
            grippers: BTreeMap::from([("right".into(), reading)]),
            ..RobotState::default()
        };
        let measured = LastMeasured::default().followed_by(&state, RobotLayout::baxter());
        let expected = MeasuredJoint {
            position: 0.5,
            grips: Some(true),
            ..MeasuredJoint::default()
        };
        assert_eq!(measured, [(RobotJoint::RightGripper.name(), expected)]);
    }
}
