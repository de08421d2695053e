//! The simulated robot as a mirror of the real one.

use bevy::prelude::*;
use tabletop_bridge::RobotState;
use tabletop_core::{
    Actor, CommandWriter, Drive, JointName, JointRole, Robot, RobotCommand, RobotLayout,
};

use crate::RealRobot;

/// The least change of a joint, in rad, m or units, that is followed.
const CHANGED: f64 = 1e-6;

/// Brings the joints of the simulated robot to where those of the real one were measured.
pub(crate) fn follow(
    mut real: ResMut<RealRobot>,
    layout: Res<RobotLayout>,
    robot: Res<Robot>,
    mut commands: CommandWriter,
) {
    real.look_after();
    let measured = measured(&real.state(), &layout);
    let drives = measured.into_iter().filter_map(|(number, position)| {
        let joint = &layout.joints[number];
        let position = joint.clamp(position);
        let has_moved = (robot.joints[number].position - position).abs() > CHANGED;
        has_moved.then_some((joint.name, Drive::Position(position)))
    });
    let drives: Vec<(JointName, Drive)> = drives.collect();
    if !drives.is_empty() {
        commands.write(Actor::Controller, RobotCommand::Drive(drives));
    }
}

/// The positions of the layout's joints, by their numbers, as far as the real robot has them.
fn measured(state: &RobotState, layout: &RobotLayout) -> Vec<(usize, f64)> {
    let joints = layout.joints.iter().enumerate();
    let turned = joints.filter_map(|(number, joint)| match joint.role {
        JointRole::Limb { .. } | JointRole::Neck => {
            Some((number, state.joints.get(&joint.urdf_name)?.position))
        }
        JointRole::Gripper { .. } => None,
    });
    let opened = layout.limbs.iter().filter_map(|limb| {
        let gripper = state.grippers.get(limb.name.as_str())?;
        let joint = limb.gripper.joint;
        let [_, widest] = layout.joint(joint).limits;
        Some((joint.index(), gripper.opening * widest))
    });
    turned.chain(opened).collect()
}
