//! Actions of the robot, as numbers from -1 to 1.

use bevy::prelude::*;
use tabletop_core::{
    Drive, JointId, JointName, LimbId, MANUAL_SPEED, Robot, RobotCommand, RobotLayout,
    TICK_SECONDS, WriteCommand as _, step_world,
};
use tabletop_geometry::{Pose, turn_about};
use tabletop_robot::reach_nearby;

/// Distance, in units, and angle about the vertical, in rad, by which a step moves an end effector at most: with 20 steps a second 2 units/s and
/// 2 rad/s.
const LONGEST_DELTA: (f32, f32) = (0.1, 0.1);

/// The actions of an environment. All their numbers are from -1 to 1; others count as the nearest of these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionSpace {
    /// The velocity of each joint of the limbs, limb by limb from the base, up to 1 rad/s; then of each gripper's opening, up to 1 unit/s.
    JointVelocity,
    /// The position of the same joints and openings between their limits, which they reach at the end of the step, evenly, or as far as their
    /// [`travel_speed`](tabletop_core::JointLayout::travel_speed) takes them.
    JointPosition,
    /// For each limb the displacement of its end effector along x, y and z, up to 0.1 units a step, its turn about the vertical, up to 0.1 rad a
    /// step, and the velocity of its gripper's opening, up to 1 unit/s. An end effector keeps its other angles.
    EndEffectorDelta,
    /// The demonstrator's hand takes what is highest at a place of the table and puts it down at another: x and y of both places, as shares of
    /// the table's half extents, and the turn about the vertical in shares of π. A step lasts as long as that takes.
    PickPlace,
}

impl ActionSpace {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::JointVelocity,
        Self::JointPosition,
        Self::EndEffectorDelta,
        Self::PickPlace,
    ];

    /// Its name in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::JointVelocity => "joint_velocity",
            Self::JointPosition => "joint_position",
            Self::EndEffectorDelta => "end_effector_delta",
            Self::PickPlace => "pick_place",
        }
    }

    /// Number of the numbers of an action.
    pub fn len(self, layout: &RobotLayout) -> usize {
        match self {
            Self::JointVelocity | Self::JointPosition => driven(layout).count(),
            Self::EndEffectorDelta => 5 * layout.limbs.len(),
            Self::PickPlace => 5,
        }
    }
}

/// The joints that actions move.
fn driven(layout: &RobotLayout) -> impl Iterator<Item = JointId> {
    let joints = layout
        .limbs
        .iter()
        .flat_map(|limb| limb.joints.iter().copied());
    joints.chain(layout.limbs.iter().map(|limb| limb.gripper.joint))
}

/// Simulates these ticks with the velocities of an action.
pub(crate) fn move_at(world: &mut World, action: &[f32], ticks: u64) {
    let layout = world.resource::<RobotLayout>();
    let joints = driven(layout).map(|joint| layout.joint(joint));
    let velocities = joints.zip(action).map(|(joint, &share)| {
        let velocity = f64::from(share) * joint.manual_speed();
        (joint.name, Drive::Velocity(velocity))
    });
    let drives = velocities.collect();
    drive_for(world, drives, ticks);
}

/// Simulates these ticks on the way to the positions of an action.
pub(crate) fn move_to(world: &mut World, action: &[f32], ticks: u64) {
    for left in (1..=ticks).rev() {
        let time = left as f64 * f64::from(TICK_SECONDS);
        let (layout, robot) = (world.resource::<RobotLayout>(), world.resource::<Robot>());
        let drives = driven(layout).zip(action).map(|(id, &share)| {
            let joint = layout.joint(id);
            let [low, high] = joint.limits;
            let there = low + (high - low) * (f64::from(share) + 1.0) / 2.0;
            let velocity = (there - robot.joint(id).position) / time;
            let speed = joint.travel_speed();
            (joint.name, Drive::Velocity(velocity.clamp(-speed, speed)))
        });
        let drives = drives.collect();
        world.write_command(RobotCommand::Drive(drives));
        step_world(world, 1);
    }
}

/// The poses to which the actions of an episode have sent the end effectors.
#[derive(Clone, Debug, Default)]
pub(crate) struct EndEffectorTargets(Vec<Pose>);

impl EndEffectorTargets {
    /// Those of a robot at rest.
    pub fn new(world: &World) -> Self {
        let limbs = world.resource::<Robot>().limbs.iter();
        Self(limbs.map(|limb| limb.end_effector).collect())
    }

    /// Simulates these ticks with end effectors displaced by an action. One that cannot get there stays where it is.
    pub fn move_by(&mut self, world: &mut World, action: &[f32], ticks: u64) {
        let mut grippers = Vec::new();
        for (number, (target, action)) in self.0.iter_mut().zip(action.chunks(5)).enumerate() {
            let &[x, y, z, turn, opening] = action else {
                continue;
            };
            let limb = LimbId(number as u8);
            let layout = world.resource::<RobotLayout>();
            let limb_layout = layout.limb(limb);
            let gripper = layout.joint(limb_layout.gripper.joint).name;
            grippers.push((gripper, Drive::Velocity(f64::from(opening) * MANUAL_SPEED)));
            if [x, y, z, turn] == [0.0; 4] {
                continue;
            }
            let names: Vec<_> = limb_layout
                .joints
                .iter()
                .map(|&joint| layout.joint(joint).name)
                .collect();
            let next = Pose::new(
                target.location + Vec3::new(x, y, z) * LONGEST_DELTA.0,
                (turn_about(Vec3::Z, turn * LONGEST_DELTA.1) * target.rotation).normalize(),
            );
            if let Ok(angles) = reach_nearby(world, limb, next) {
                *target = next;
                let drives = names.into_iter().zip(angles.into_iter().map(Drive::Toward));
                world.write_command(RobotCommand::Drive(drives.collect()));
            } else {
                *target = world.resource::<Robot>().limb(limb).end_effector;
            }
        }
        drive_for(world, grippers, ticks);
    }
}

/// Simulates these ticks with the same velocities in each.
fn drive_for(world: &mut World, drives: Vec<(JointName, Drive)>, ticks: u64) {
    for _ in 0..ticks {
        world.write_command(RobotCommand::Drive(drives.clone()));
        step_world(world, 1);
    }
}
