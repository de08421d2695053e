//! The commands to the robot, carried out.

use bevy::{ecs::system::SystemState, prelude::*};
use tabletop_core::{
    Drive, IssuedCommand, Markers, Paused, Robot, RobotCommand, RobotJoint, RobotMode, carry_out,
};

use crate::command::{joint_targets::JointTargets, reach, visibility};

/// Carries out the commands to the robot.
pub(crate) fn obey(
    world: &mut World,
    reader: &mut SystemState<MessageReader<IssuedCommand>>,
) -> Result {
    carry_out(world, reader, |world, cause, command| match command {
        RobotCommand::Show(show) => {
            visibility::show(world, cause, show);
            Ok(())
        }
        RobotCommand::Drive(drives) => drive(world, drives),
        RobotCommand::ReachTo { arm, pose } => {
            refuse_while_paused(world)?;
            let angles = reach::solve(world, arm, pose)?;
            world.resource_mut::<JointTargets>().send(arm, angles);
            Ok(())
        }
        RobotCommand::ShowFace(face) => {
            world.resource_mut::<Robot>().face = face;
            Ok(())
        }
        RobotCommand::ShowMarkers(points) => show_markers(world, points),
    })
}

fn drive(world: &mut World, drives: Vec<(RobotJoint, Drive)>) -> Result<(), String> {
    refuse_while_paused(world)?;
    let mode = world.resource::<Robot>().mode;
    for &(joint, drive) in &drives {
        check(mode, joint, drive)?;
    }
    let mut targets = world.resource_mut::<JointTargets>();
    for (joint, drive) in drives {
        match drive {
            Drive::Position(there) if has_motor(mode, joint) => targets.rush(joint, there),
            Drive::Velocity(_) | Drive::Position(_) | Drive::Toward(_) | Drive::Torque(_) => {
                targets.take(joint, drive);
            }
        }
    }
    Ok(())
}

fn show_markers(world: &mut World, points: Vec<Vec3>) -> Result<(), String> {
    if let Some(point) = points.iter().find(|point| !point.is_finite()) {
        return Err(format!("a marker cannot stand at {point}"));
    }
    world.resource_mut::<Markers>().0 = points;
    Ok(())
}

fn refuse_while_paused(world: &World) -> Result<(), String> {
    match world.resource::<Paused>().0 {
        true => Err("the robot cannot move while the simulation is paused".into()),
        false => Ok(()),
    }
}

/// Whether a joint is moved by a motor with limited torque.
fn has_motor(mode: RobotMode, joint: RobotJoint) -> bool {
    mode == RobotMode::Dynamic && !joint.is_gripper() && joint != RobotJoint::HeadPan
}

/// Whether a joint can do what it is told.
fn check(mode: RobotMode, joint: RobotJoint, drive: Drive) -> Result<(), String> {
    let value = match drive {
        Drive::Velocity(value)
        | Drive::Position(value)
        | Drive::Toward(value)
        | Drive::Torque(value) => value,
    };
    if !value.is_finite() {
        return Err(format!(
            "joint {joint} cannot be told {drive:?}: not a number"
        ));
    }
    match drive {
        Drive::Torque(_) if !has_motor(mode, joint) => Err(format!(
            "joint {joint} cannot be told a torque: only the joints of arms can, in dynamic mode"
        )),
        Drive::Velocity(_) | Drive::Position(_) | Drive::Toward(_) | Drive::Torque(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const E1: RobotJoint = RobotJoint::LeftE1;

    #[test]
    fn what_is_not_a_number_is_refused() {
        for drive in [Drive::Velocity(f64::NAN), Drive::Position(f64::INFINITY)] {
            assert!(check(RobotMode::Kinematic, E1, drive).is_err());
        }
        assert!(check(RobotMode::Kinematic, E1, Drive::Torque(1.0)).is_err());
        assert!(check(RobotMode::Dynamic, E1, Drive::Torque(1.0)).is_ok());
        assert!(check(RobotMode::Dynamic, RobotJoint::HeadPan, Drive::Torque(1.0)).is_err());
    }
}
