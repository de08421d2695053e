//! Helpers of the tests of dynamic mode.

use tabletop_core::{Arm, Drive, JOINTS_PER_ARM, Robot, RobotCommand, RobotJoint, StepApp};

use super::Stage;

/// The tested arm.
pub const ARM: Arm = Arm::Right;

/// Ticks of a second.
pub const SECOND: u64 = 60;

pub fn drive(stage: &mut Stage, drives: &[(RobotJoint, Drive)]) {
    stage.tell(RobotCommand::drive(drives.iter().copied()));
}

/// Sends an arm to angles, and waits until it is there.
pub fn go(stage: &mut Stage, arm: Arm, angles: [f64; JOINTS_PER_ARM]) {
    let joints = RobotJoint::of_arm(arm);
    let mut drives: Vec<_> = joints.into_iter().zip(angles.map(Drive::Toward)).collect();
    // Up first, out of the way of the table.
    let down = drives.remove(1);
    for drives in [vec![(joints[1], Drive::Toward(-1.2))], drives, vec![down]] {
        drive(stage, &drives);
        stage.app.step(1);
        for _ in 0..400 {
            if !stage.robot().limb(arm).is_moving {
                break;
            }
            stage.app.step(1);
        }
    }
    stage.app.step(30);
    let off = off(stage, arm, angles);
    assert!(
        off < 0.1,
        "{off}° off: {:?}",
        stage.robot().limb(arm).blocked_by
    );
}

/// Largest difference of the arm's joints from these angles, in degrees.
pub fn off(stage: &Stage, arm: Arm, angles: [f64; JOINTS_PER_ARM]) -> f64 {
    let is = stage.robot().angles(arm);
    is.iter()
        .zip(angles)
        .map(|(is, angle)| (is - angle).abs().to_degrees())
        .fold(0.0, f64::max)
}

/// Largest torques of the motors, in N m.
pub fn effort(joint: RobotJoint) -> f64 {
    if joint.index() % JOINTS_PER_ARM < 4 {
        50.0
    } else {
        15.0
    }
}

/// Checks that motors stay within their limits.
pub fn check_limits(robot: &Robot) {
    for joint in RobotJoint::of_arm(Arm::Left)
        .into_iter()
        .chain(RobotJoint::of_arm(Arm::Right))
    {
        let state = robot.joint(joint);
        let speed = if joint.index() % JOINTS_PER_ARM < 4 {
            1.5
        } else {
            4.0
        };
        assert!(state.torque.abs() <= effort(joint), "{joint}: {state:?}");
        assert!(state.velocity.abs() <= speed + 1e-6, "{joint}: {state:?}");
        assert_eq!(
            joint.clamp(state.position),
            state.position,
            "{joint}: {state:?}"
        );
    }
}
