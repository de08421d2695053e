//! A script's replies as commands of the simulation.

use bevy::prelude::*;
use tabletop_core::{Arm, Drive, RobotCommand, RobotJoint, RobotMode};
use tabletop_engine::{InitReply, MotorCommand};

/// The commands of an init script.
pub(crate) fn commands_of_init(reply: &InitReply) -> Vec<RobotCommand> {
    let markers = reply.draw_markers.iter();
    let markers = markers.map(|point| Vec3::from_array(point.map(|x| x as f32)));
    let mut commands = vec![RobotCommand::ShowMarkers(markers.collect())];
    commands.extend(
        reply
            .init_joint_angles
            .map(|angles| RobotCommand::Drive(at_once(&angles))),
    );
    commands
}

/// The first angle of an init script that a joint cannot have.
pub(crate) fn unreachable(reply: &InitReply) -> Option<String> {
    let angles = reply.init_joint_angles.as_ref()?;
    let mut joints = each_joint(angles, |angle| angle).into_iter();
    let (joint, angle) = joints.find(|&(joint, angle)| {
        let (least, largest) = joint.limits();
        !(least..=largest).contains(&angle)
    })?;
    let (least, largest) = joint.limits();
    Some(format!(
        "aux.initJointAngles wants {joint} at {angle}; it is moved to the nearest of its angles, {least} to {largest}"
    ))
}

/// The command of a callback script for one tick.
pub(crate) fn command_of_motor(motor: &MotorCommand, mode: RobotMode) -> RobotCommand {
    let torques = motor.joint_torques.filter(|_| mode == RobotMode::Dynamic);
    let mut drives = match (torques, &motor.joint_angles) {
        (_, Some(angles)) => at_once(angles),
        (Some(torques), None) => each_joint(&torques, Drive::Torque),
        (None, None) => each_joint(&motor.joint_velocities, Drive::Velocity),
    };
    for (arm, velocity) in Arm::BOTH.into_iter().zip(motor.gripper_velocities) {
        drives.push((RobotJoint::gripper(arm), Drive::Velocity(velocity)));
    }
    let head = motor.head_velocity.map(Drive::Velocity);
    drives.extend(head.map(|drive| (RobotJoint::HeadPan, drive)));
    RobotCommand::Drive(drives)
}

/// The last command of a script that ends in a tick: velocities are zero from then on.
pub(crate) fn last_command(motor: &MotorCommand) -> Option<RobotCommand> {
    let angles = motor.joint_angles.as_ref();
    angles.map(|angles| RobotCommand::Drive(at_once(angles)))
}

fn at_once(angles: &[[f64; 7]; 2]) -> Vec<(RobotJoint, Drive)> {
    each_joint(angles, Drive::Position)
}

fn each_joint<T>(values: &[[f64; 7]; 2], each: impl Fn(f64) -> T) -> Vec<(RobotJoint, T)> {
    let arms = Arm::BOTH.into_iter().zip(values);
    arms.flat_map(|(arm, values)| RobotJoint::of_arm(arm).into_iter().zip(values))
        .map(|(joint, value)| (joint, each(*value)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motor() -> MotorCommand {
        let mut motor = MotorCommand {
            gripper_velocities: [0.5, -1.0],
            ..MotorCommand::default()
        };
        motor.joint_velocities[1][6] = 2.0;
        motor
    }

    fn drives(command: RobotCommand) -> Vec<(RobotJoint, Drive)> {
        match command {
            RobotCommand::Drive(drives) => drives,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn velocities_are_for_every_joint_of_the_arms_and_the_grippers() {
        let drives = drives(command_of_motor(&motor(), RobotMode::Kinematic));
        assert_eq!(drives.len(), 16);
        assert_eq!(drives[13], (RobotJoint::RightW2, Drive::Velocity(2.0)));
        assert_eq!(
            drives[15],
            (RobotJoint::RightGripper, Drive::Velocity(-1.0))
        );
    }

    #[test]
    fn an_angle_out_of_reach_is_noted() {
        let mut angles = [[0.0; 7]; 2];
        let note = |angles| {
            unreachable(&InitReply {
                init_joint_angles: Some(angles),
                ..InitReply::default()
            })
        };
        assert_eq!(note(angles), None);
        angles[1][0] = 99.0;
        let note = note(angles).unwrap();
        assert!(note.contains("at 99; it is moved to"), "{note}");
    }

    #[test]
    fn angles_take_the_place_of_velocities_and_torques_need_motors() {
        let torques = MotorCommand {
            joint_torques: Some([[1.0; 7]; 2]),
            ..motor()
        };
        let first = |motor: &MotorCommand, mode| drives(command_of_motor(motor, mode))[0].1;
        assert_eq!(first(&torques, RobotMode::Kinematic), Drive::Velocity(0.0));
        assert_eq!(first(&torques, RobotMode::Dynamic), Drive::Torque(1.0));
        let angles = MotorCommand {
            joint_angles: Some([[0.25; 7]; 2]),
            ..torques
        };
        assert_eq!(first(&angles, RobotMode::Dynamic), Drive::Position(0.25));
    }

    #[test]
    fn the_head_turns_only_on_command() {
        let turning = MotorCommand {
            head_velocity: Some(0.1),
            ..motor()
        };
        let drives = drives(command_of_motor(&turning, RobotMode::Kinematic));
        assert_eq!(
            drives.last(),
            Some(&(RobotJoint::HeadPan, Drive::Velocity(0.1)))
        );
    }
}
