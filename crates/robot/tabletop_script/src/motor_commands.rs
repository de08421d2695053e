//! A script's replies as commands of the simulation.

use bevy::prelude::*;
use tabletop_core::{Drive, JointLayout, JointName, RobotCommand, RobotLayout, RobotMode};
use tabletop_engine::{InitReply, JointMatrix, MotorCommand};

/// The commands of an init script.
pub(crate) fn commands_of_init(reply: &InitReply, layout: &RobotLayout) -> Vec<RobotCommand> {
    let markers = reply.draw_markers.iter();
    let markers = markers.map(|point| Vec3::from_array(point.map(|x| x as f32)));
    let mut commands = vec![RobotCommand::ShowMarkers(markers.collect())];
    let angles = reply.init_joint_angles.as_ref();
    commands.extend(angles.map(|angles| RobotCommand::drive(at_once(angles, layout))));
    commands
}

/// The first angle of an init script that a joint cannot have.
pub(crate) fn unreachable(reply: &InitReply, layout: &RobotLayout) -> Option<String> {
    let angles = reply.init_joint_angles.as_ref()?;
    let mut joints = each_joint(angles, layout);
    let (joint, angle) = joints.find(|(joint, angle)| {
        let [least, largest] = joint.limits;
        !(least..=largest).contains(angle)
    })?;
    let (name, [least, largest]) = (joint.name, joint.limits);
    Some(format!(
        "aux.initJointAngles wants {name} at {angle}; it is moved to the nearest of its angles, {least} to {largest}"
    ))
}

/// The command of a callback script for one tick.
pub(crate) fn command_of_motor(
    motor: &MotorCommand,
    mode: RobotMode,
    layout: &RobotLayout,
) -> RobotCommand {
    let torques = motor.joint_torques.as_ref();
    let torques = torques.filter(|_| mode == RobotMode::Dynamic);
    let mut drives = match (torques, &motor.joint_angles) {
        (_, Some(angles)) => at_once(angles, layout),
        (Some(torques), None) => drives(torques, layout, Drive::Torque),
        (None, None) => drives(&motor.joint_velocities, layout, Drive::Velocity),
    };
    let grippers = layout.limbs.iter().map(|limb| limb.gripper.joint);
    let velocities = motor.gripper_velocities.iter().copied();
    let head = layout.neck.zip(motor.head_velocity);
    let others = grippers.zip(velocities).chain(head);
    drives.extend(others.map(|(joint, velocity)| {
        let name = layout.joint(joint).name;
        (name, Drive::Velocity(velocity))
    }));
    RobotCommand::Drive(drives)
}

/// The last command of a script that ends in a tick: velocities are zero from then on.
pub(crate) fn last_command(motor: &MotorCommand, layout: &RobotLayout) -> Option<RobotCommand> {
    let angles = motor.joint_angles.as_ref();
    angles.map(|angles| RobotCommand::drive(at_once(angles, layout)))
}

fn at_once(angles: &JointMatrix, layout: &RobotLayout) -> Vec<(JointName, Drive)> {
    drives(angles, layout, Drive::Position)
}

fn drives(
    values: &JointMatrix,
    layout: &RobotLayout,
    drive: fn(f64) -> Drive,
) -> Vec<(JointName, Drive)> {
    let joints = each_joint(values, layout);
    joints
        .map(|(joint, value)| (joint.name, drive(value)))
        .collect()
}

fn each_joint<'a>(
    values: &'a JointMatrix,
    layout: &'a RobotLayout,
) -> impl Iterator<Item = (&'a JointLayout, f64)> {
    let limbs = layout.limbs.iter().zip(values.rows());
    let joints = limbs.flat_map(|(limb, values)| limb.joints.iter().zip(values));
    joints.map(|(joint, value)| (layout.joint(*joint), *value))
}

#[cfg(test)]
mod tests {
    use tabletop_core::RobotJoint;

    use super::*;

    fn motor() -> MotorCommand {
        let mut motor = MotorCommand {
            gripper_velocities: vec![0.5, -1.0],
            ..MotorCommand::at_rest([2, 7])
        };
        motor.joint_velocities[1][6] = 2.0;
        motor
    }

    fn drives(command: RobotCommand) -> Vec<(JointName, Drive)> {
        let RobotCommand::Drive(drives) = command else {
            panic!("{command:?}");
        };
        drives
    }

    #[test]
    fn velocities_are_for_every_joint_of_the_arms_and_the_grippers() {
        let drives = drives(command_of_motor(
            &motor(),
            RobotMode::Kinematic,
            RobotLayout::baxter(),
        ));
        assert_eq!(drives.len(), 16);
        assert_eq!(
            drives[13],
            (RobotJoint::RightW2.name(), Drive::Velocity(2.0))
        );
        assert_eq!(
            drives[15],
            (RobotJoint::RightGripper.name(), Drive::Velocity(-1.0))
        );
    }

    #[test]
    fn an_angle_out_of_reach_is_noted() {
        let mut angles = [[0.0; 7]; 2];
        let note = |angles: [[f64; 7]; 2]| {
            let reply = InitReply {
                init_joint_angles: Some(JointMatrix::from(angles)),
                ..InitReply::default()
            };
            unreachable(&reply, RobotLayout::baxter())
        };
        assert_eq!(note(angles), None);
        angles[1][0] = 99.0;
        let note = note(angles).unwrap();
        assert!(note.contains("at 99; it is moved to"), "{note}");
    }

    #[test]
    fn angles_take_the_place_of_velocities_and_torques_need_motors() {
        let torques = MotorCommand {
            joint_torques: Some([[1.0; 7]; 2].into()),
            ..motor()
        };
        let first = |motor: &MotorCommand, mode| {
            drives(command_of_motor(motor, mode, RobotLayout::baxter()))[0].1
        };
        assert_eq!(first(&torques, RobotMode::Kinematic), Drive::Velocity(0.0));
        assert_eq!(first(&torques, RobotMode::Dynamic), Drive::Torque(1.0));
        let angles = MotorCommand {
            joint_angles: Some([[0.25; 7]; 2].into()),
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
        let drives = drives(command_of_motor(
            &turning,
            RobotMode::Kinematic,
            RobotLayout::baxter(),
        ));
        assert_eq!(
            drives.last(),
            Some(&(RobotJoint::HeadPan.name(), Drive::Velocity(0.1)))
        );
    }
}
