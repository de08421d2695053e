//! Execution of the commands to the robot.

use bevy::{ecs::system::SystemState, prelude::*};
use tabletop_core::{
    Drive, IssuedCommand, JointId, JointLayout, JointName, JointRole, Markers, MeasuredJoint,
    Paused, Robot, RobotCommand, RobotLayout, RobotMode, carry_out,
};

use tabletop_robot::reach;

use crate::command::{joint_targets::JointTargets, visibility};

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
        RobotCommand::Mirror(measured) => mirror(world, measured),
        RobotCommand::ReachTo { arm, pose } => {
            refuse_while_paused(world)?;
            let layout = world.resource::<RobotLayout>();
            let limb = layout.find_limb(arm).ok_or_else(|| {
                format!(
                    "the robot has no limb {arm}, only {}",
                    listed(&layout.limbs, |it| it.name)
                )
            })?;
            let angles = reach(world, limb, pose)?;
            aim(world, |layout, targets| targets.send(layout, limb, angles));
            Ok(())
        }
        RobotCommand::ShowFace(face) => {
            world.resource_mut::<Robot>().face = face;
            Ok(())
        }
        RobotCommand::ShowMarkers(points) => show_markers(world, points),
    })
}

fn mirror(world: &mut World, measured: Vec<(JointName, MeasuredJoint)>) -> Result<(), String> {
    refuse_while_paused(world)?;
    if world.resource::<Robot>().mode == RobotMode::Dynamic {
        return Err("a robot that is moved by its motors is no mirror of another".into());
    }
    let layout = world.resource::<RobotLayout>();
    let measured = measured.into_iter().map(|(name, measured)| {
        let joint = find_joint(layout, name)?;
        match measured.is_finite() {
            true => Ok((joint, measured)),
            false => Err(format!(
                "joint {name} cannot be at {measured:?}: not a number"
            )),
        }
    });
    let measured = measured.collect::<Result<Vec<_>, String>>()?;
    aim(world, |layout, targets| targets.mirror(layout, measured));
    Ok(())
}

/// Changes the targets of joints. They stay a resource of the world meanwhile, an empty one: to take a resource out costs more than the change.
fn aim(world: &mut World, change: impl FnOnce(&RobotLayout, &mut JointTargets)) {
    let mut targets = std::mem::take(&mut *world.resource_mut::<JointTargets>());
    change(world.resource::<RobotLayout>(), &mut targets);
    *world.resource_mut() = targets;
}

fn find_joint(layout: &RobotLayout, name: JointName) -> Result<JointId, String> {
    layout.find_joint(name).ok_or_else(|| {
        let known = listed(&layout.joints, |it| it.name);
        format!("the robot has no joint {name}, only {known}")
    })
}

fn drive(world: &mut World, drives: Vec<(JointName, Drive)>) -> Result<(), String> {
    refuse_while_paused(world)?;
    let mode = world.resource::<Robot>().mode;
    let layout = world.resource::<RobotLayout>();
    let drives = drives.into_iter().map(|(name, drive)| {
        let joint = find_joint(layout, name)?;
        check(mode, layout.joint(joint), drive)?;
        Ok((joint, drive))
    });
    let drives = drives.collect::<Result<Vec<(JointId, Drive)>, String>>()?;
    aim(world, |layout, targets| {
        for (joint, drive) in drives {
            match drive {
                Drive::Position(there) if has_motor(mode, layout.joint(joint)) => {
                    targets.rush(layout, joint, there);
                }
                Drive::Velocity(_) | Drive::Position(_) | Drive::Toward(_) | Drive::Torque(_) => {
                    targets.take(layout, joint, drive);
                }
            }
        }
    });
    Ok(())
}

fn listed<T, N: ToString>(parts: &[T], name: impl Fn(&T) -> N) -> String {
    let names: Vec<_> = parts.iter().map(|part| name(part).to_string()).collect();
    names.join(", ")
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

/// True if a motor with limited torque moves the joint.
fn has_motor(mode: RobotMode, joint: &JointLayout) -> bool {
    mode == RobotMode::Dynamic && matches!(joint.role, JointRole::Limb { .. })
}

/// Checks that a joint can carry out a drive.
fn check(mode: RobotMode, joint: &JointLayout, drive: Drive) -> Result<(), String> {
    let value = match drive {
        Drive::Velocity(value)
        | Drive::Position(value)
        | Drive::Toward(value)
        | Drive::Torque(value) => value,
    };
    if !value.is_finite() {
        return Err(format!(
            "joint {} cannot obey {drive:?}: not a number",
            joint.name
        ));
    }
    match drive {
        Drive::Torque(_) if !has_motor(mode, joint) => Err(format!(
            "joint {} cannot take a torque: only joints of arms can, in dynamic mode",
            joint.name
        )),
        Drive::Velocity(_) | Drive::Position(_) | Drive::Toward(_) | Drive::Torque(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_drives_are_refused() {
        let e1 = RobotLayout::baxter().joint(JointId(3));
        let head_pan = RobotLayout::baxter().joint(JointId(14));
        for drive in [Drive::Velocity(f64::NAN), Drive::Position(f64::INFINITY)] {
            assert!(check(RobotMode::Kinematic, e1, drive).is_err());
        }
        assert!(check(RobotMode::Kinematic, e1, Drive::Torque(1.0)).is_err());
        assert!(check(RobotMode::Dynamic, e1, Drive::Torque(1.0)).is_ok());
        assert!(check(RobotMode::Dynamic, head_pan, Drive::Torque(1.0)).is_err());
    }
}
