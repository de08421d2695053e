//! Driving: a robot's joints and end effectors move as the actions of a served policy say.

use bevy::prelude::*;
use tabletop_controller::{Drives, Observer, Sight};
use tabletop_core::{
    Actor, Drive, JointId, LimbId, Robot, RobotCommand, RobotLayout, TICKS_PER_SECOND,
    WriteCommand as _, step_world,
};
use tabletop_geometry::{Pose, UNITS_PER_METER, turn_about};
use tabletop_planner::PlanFailure;
use tabletop_robot::{Articulation, base, reach_nearby};
use tabletop_wire::{ActionColumn, MappedActions};

use crate::{
    driven_task::DrivenTask,
    remote_policy::RemotePolicy,
    robot_view::{joint_named, limb_named, observe},
};

/// Ticks for which a task must be done without a break until it counts as done.
const SETTLED: u64 = 30;

/// Lets a robot act as a served policy says until the task is done, which `is_done` tells, or until its time is over.
///
/// # Errors
/// The policy does not answer, or says which object is to be put where instead of what is to be moved.
pub fn follow_actions(
    policy: &RemotePolicy,
    world: &mut World,
    task: &DrivenTask,
    mut is_done: impl FnMut(&Sight) -> bool,
) -> Result<(), PlanFailure> {
    let mapping = policy.mapping();
    let undecided = |reason: String| PlanFailure::Undecided(reason);
    let (rate, columns) = match &mapping.actions {
        MappedActions::Columns { rate, columns, .. } => (u64::from(*rate), columns),
        MappedActions::Places => {
            return Err(undecided("the actions of the mapping are places".into()));
        }
    };
    let begin = |action: u64| action * u64::from(TICKS_PER_SECOND) / rate;
    let mut observer = Observer::default();
    let (mut action, mut thought, mut done_since) = (0, 0, None);
    loop {
        let observation = observe(world, mapping, task);
        let observation = observation.map_err(|error| undecided(error.to_string()))?;
        let (chunk, ticks) = task.thinking.of(|| policy.actions(&observation));
        let chunk = chunk.map_err(|error| undecided(error.to_string()))?;
        step_world(world, ticks);
        thought += ticks;
        for numbers in chunk.rows() {
            let goals = goals(world, columns, numbers);
            action += 1;
            for left in (1..=begin(action) - begin(action - 1)).rev() {
                let drives = drives(world, &goals, left);
                if !drives.is_empty() {
                    world.write_command_of(Actor::Controller, RobotCommand::Drive(drives));
                }
                step_world(world, 1);
            }
            let now = begin(action) + thought;
            done_since = match is_done(observer.look(world)) {
                true => done_since.or(Some(now)),
                false => None,
            };
            if now >= task.most || done_since.is_some_and(|since| now - since >= SETTLED) {
                return Ok(());
            }
        }
    }
}

/// What a joint is to do during an action.
#[derive(Clone, Copy, Debug, PartialEq)]
enum JointGoal {
    /// To move at this speed.
    Speed(f64),
    /// To be there at the end.
    Position(f64),
}

/// The goals of joints for an action that begins now. An end effector that cannot get where it is displaced to stays where it is.
fn goals(
    world: &mut World,
    columns: &[ActionColumn],
    numbers: &[f64],
) -> Vec<(JointId, JointGoal)> {
    let mut goals = Vec::new();
    let mut displaced: Vec<(LimbId, [f32; 6])> = Vec::new();
    let layout = world.resource::<RobotLayout>();
    for (column, number) in columns.iter().zip(numbers) {
        match column {
            ActionColumn::Position(scaled) => {
                if let Some(joint) = joint_named(layout, &scaled.name) {
                    let position = layout.joint(joint).clamp(scaled.position(*number));
                    goals.push((joint, JointGoal::Position(position)));
                }
            }
            ActionColumn::Velocity { joint, scale } => {
                if let Some(joint) = joint_named(layout, joint) {
                    goals.push((joint, JointGoal::Speed(number * scale)));
                }
            }
            ActionColumn::Displacement { limb, part, scale } => {
                let Some(limb) = limb_named(layout, limb) else {
                    continue;
                };
                let known = displaced.iter().position(|(other, _)| *other == limb);
                let place = known.unwrap_or(displaced.len());
                if known.is_none() {
                    displaced.push((limb, [0.0; 6]));
                }
                displaced[place].1[part.index()] += (number * scale) as f32;
            }
            ActionColumn::Ignored => {}
        }
    }
    for (limb, by) in displaced.into_iter().filter(|(_, by)| *by != [0.0; 6]) {
        let goal = displacement(world, limb, by);
        if let Ok(angles) = reach_nearby(world, limb, goal) {
            let joints = &world.resource::<RobotLayout>().limb(limb).joints;
            let angles = angles.into_iter().map(JointGoal::Position);
            goals.extend(joints.iter().copied().zip(angles));
        }
    }
    goals
}

/// The pose of an end effector that is displaced along and about the axes of the robot's base, in m and rad.
fn displacement(world: &mut World, limb: LimbId, by: [f32; 6]) -> Pose {
    let base = base(world);
    let now = world.resource::<Robot>().limb(limb).end_effector;
    let [x, y, z, along_x, along_y, along_z] = by;
    let way = base.rotation * Vec3::new(x, y, z) * UNITS_PER_METER as f32;
    let turn = base.rotation * Vec3::new(along_x, along_y, along_z);
    let turn = match turn.try_normalize() {
        Some(axis) => turn_about(axis, turn.length()),
        None => Quat::IDENTITY,
    };
    Pose::new(now.location + way, (turn * now.rotation).normalize())
}

/// The drives of a tick, of which so many are left until the action ends. No joint is faster than its motor.
fn drives(world: &World, goals: &[(JointId, JointGoal)], left: u64) -> Drives {
    let robot = world.resource::<Robot>();
    let layout = world.resource::<RobotLayout>();
    let drive = |(joint, goal): &(JointId, JointGoal)| {
        let speed = match goal {
            JointGoal::Speed(speed) => *speed,
            JointGoal::Position(there) => {
                let way = there - robot.joint(*joint).position;
                way * f64::from(TICKS_PER_SECOND) / left as f64
            }
        };
        let fastest = fastest(world, *joint);
        let speed = speed.clamp(-fastest, fastest);
        (layout.joint(*joint).name, Drive::Velocity(speed))
    };
    goals.iter().map(drive).collect()
}

/// The greatest speed of a joint, in rad/s or m/s, or units/s for a gripper's opening: the model's, or else the layout's.
fn fastest(world: &World, joint: JointId) -> f64 {
    let articulation = world.resource::<Articulation>();
    let layout = articulation.layout.joint(joint);
    let described = articulation.joint(joint).filter(|_| !layout.is_gripper());
    let described = described.map_or(0.0, |joint| articulation.model().joint(joint).velocity);
    match described > layout.speed {
        true => described,
        false => layout.travel_speed(),
    }
}
