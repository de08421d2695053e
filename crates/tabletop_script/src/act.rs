//! What a script orders, as commands.

use bevy::prelude::*;
use tabletop_core::{Arm, Drive, RobotJoint, RobotMode, SimCommand};
use tabletop_engine::{EngineError, InitReply, Motor, ScriptError};

/// Markers beyond are too far away to be drawn anywhere.
const FARTHEST: f64 = 1e6;

/// The commands for what an init script wants.
///
/// # Errors
/// A marker is too far away.
pub(crate) fn commands_of_init(reply: &InitReply) -> Result<Vec<SimCommand>, EngineError> {
    let mut commands = vec![SimCommand::ShowMarkers(markers(&reply.draw_markers)?)];
    commands.extend(
        reply
            .init_joint_angles
            .map(|angles| SimCommand::Drive(at_once(&angles))),
    );
    Ok(commands)
}

fn markers(points: &[[f64; 3]]) -> Result<Vec<Vec3>, EngineError> {
    let far = |point: &[f64; 3]| point.iter().position(|x| x.abs() > FARTHEST);
    let mut rows = points.iter().enumerate();
    match rows.find_map(|(row, point)| Some((row, far(point)?))) {
        None => Ok(points
            .iter()
            .map(|point| Vec3::from_array(point.map(|x| x as f32)))
            .collect()),
        Some((row, column)) => Err(EngineError::Script(ScriptError {
            message: format!(
                "aux.drawMarkers({},{}) is {:e}; it must be between -{FARTHEST:e} and {FARTHEST:e}",
                row + 1,
                column + 1,
                points[row][column]
            ),
            ..ScriptError::default()
        })),
    }
}

/// The command for what a callback script orders for a tick.
pub(crate) fn command_of_motor(motor: &Motor, mode: RobotMode) -> SimCommand {
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
    SimCommand::Drive(drives)
}

/// The last command of a script that ends in a tick: velocities are zero from then on.
pub(crate) fn last_command(motor: &Motor) -> Option<SimCommand> {
    let angles = motor.joint_angles.as_ref();
    angles.map(|angles| SimCommand::Drive(at_once(angles)))
}

fn at_once(angles: &[[f64; 7]; 2]) -> Vec<(RobotJoint, Drive)> {
    each_joint(angles, Drive::Position)
}

fn each_joint(values: &[[f64; 7]; 2], drive: impl Fn(f64) -> Drive) -> Vec<(RobotJoint, Drive)> {
    let arms = Arm::BOTH.into_iter().zip(values);
    arms.flat_map(|(arm, values)| RobotJoint::of_arm(arm).into_iter().zip(values))
        .map(|(joint, value)| (joint, drive(*value)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motor() -> Motor {
        let mut motor = Motor {
            gripper_velocities: [0.5, -1.0],
            ..Motor::default()
        };
        motor.joint_velocities[1][6] = 2.0;
        motor
    }

    fn drives(command: SimCommand) -> Vec<(RobotJoint, Drive)> {
        match command {
            SimCommand::Drive(drives) => drives,
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
    fn markers_out_of_reach_are_the_scripts_fault() {
        let fault = |draw_markers: Vec<[f64; 3]>| {
            let reply = InitReply {
                draw_markers,
                ..InitReply::default()
            };
            commands_of_init(&reply)
                .err()
                .map(|error| error.to_string())
        };
        assert_eq!(fault(vec![[1.0, 2.0, 3.0]]), None);
        assert_eq!(
            fault(vec![[0.0; 3], [0.0, -1e39, 0.0]]).unwrap(),
            "aux.drawMarkers(2,2) is -1e39; it must be between -1e6 and 1e6"
        );
    }

    #[test]
    fn angles_take_the_place_of_velocities_and_torques_need_motors() {
        let torques = Motor {
            joint_torques: Some([[1.0; 7]; 2]),
            ..motor()
        };
        let first = |motor: &Motor, mode| drives(command_of_motor(motor, mode))[0].1;
        assert_eq!(first(&torques, RobotMode::Kinematic), Drive::Velocity(0.0));
        assert_eq!(first(&torques, RobotMode::Dynamic), Drive::Torque(1.0));
        let angles = Motor {
            joint_angles: Some([[0.25; 7]; 2]),
            ..torques
        };
        assert_eq!(first(&angles, RobotMode::Dynamic), Drive::Position(0.25));
    }

    #[test]
    fn the_head_turns_only_if_it_is_told_to() {
        let turning = Motor {
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
