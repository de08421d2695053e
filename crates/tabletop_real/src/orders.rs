//! The orders to the simulated robot, taken over for the real one.

use std::{
    collections::BTreeMap,
    thread::sleep,
    time::{Duration, Instant},
};

use bevy::prelude::*;
use tabletop_bridge::{
    Bridge, FARTHEST_STEP, LimbTarget, RobotState, RobotTarget, TargetError, WatchdogState,
};
use tabletop_core::{
    Drive, IssuedCommand, JointName, RobotCommand, RobotLayout, SimCommand, TICK_SECONDS,
};

use crate::RealRobot;

/// How long a move to given angles may take, in s, and how far, in rad, each joint may be from its angle in the end.
const MOVE_SECONDS: u64 = 30;
const ARRIVED: f64 = 0.02;
/// From one order to the next in a move.
const MOVE_PERIOD: Duration = Duration::from_millis(10);
/// Speed of a joint, in rad/s, and of an opening, in units/s, that is to go to a position at a leisurely pace.
const LEISURELY: f64 = 1.0;

/// The orders that last for more than a tick.
#[derive(Default)]
pub(crate) struct LastingOrders {
    /// Positions that joints are to go to at a leisurely pace.
    toward: BTreeMap<JointName, f64>,
    /// The opening of each gripper, in units, as it was last ordered, by the names of the limbs.
    openings: BTreeMap<String, f64>,
    /// The head's angle as it was last ordered.
    head: Option<f64>,
    /// The reason for which the last target was vetoed, if it was.
    vetoed: Option<String>,
}

/// Takes the orders to joints out of the commands of this tick. A real robot that is driven gets them.
pub(crate) fn take_over(
    mut real: ResMut<RealRobot>,
    layout: Res<RobotLayout>,
    mut commands: MessageMutator<IssuedCommand>,
    mut lasting: Local<LastingOrders>,
) {
    let mut drives = Vec::new();
    for issued in commands.read() {
        let SimCommand::Robot(command) = &mut issued.command else {
            continue;
        };
        if let RobotCommand::Drive(own) = command {
            drives.append(own);
        } else if let RobotCommand::ReachTo { .. } = command {
            *command = RobotCommand::Drive(Vec::new());
        }
    }
    let state = real.state();
    if real.end().is_some() {
        return;
    }
    let Some(bridge) = real.bridge() else {
        return;
    };
    if bridge.watchdog() == WatchdogState::Watching {
        // Until somebody wants something of it, it is left alone: scripts take their time to start.
        if drives.is_empty() {
            return;
        }
        if let Err(error) = bridge.arm() {
            real.give_up(error.to_string());
            return;
        }
    }
    let result =
        target_of(&drives, &layout, &state, &mut lasting).and_then(|(mut target, is_far)| {
            // What is said to the others reaches nobody.
            target.limbs.retain(|limb, _| bridge.drives(limb));
            target.grippers.retain(|limb, _| bridge.drives(limb));
            follow(bridge, target, is_far, &mut lasting.vetoed)
        });
    if let Err(reason) = result {
        real.give_up(reason);
    }
}

/// What the real robot is to do for these orders, and whether it is farther away than a step.
fn target_of(
    drives: &[(JointName, Drive)],
    layout: &RobotLayout,
    state: &RobotState,
    lasting: &mut LastingOrders,
) -> Result<(RobotTarget, bool), String> {
    let of: BTreeMap<JointName, Drive> = drives.iter().copied().collect();
    for (joint, drive) in &of {
        match drive {
            Drive::Toward(goal) => {
                lasting.toward.insert(*joint, *goal);
            }
            Drive::Torque(_) => {
                return Err(format!("{joint}: a real robot is sent no torques"));
            }
            Drive::Velocity(_) | Drive::Position(_) => {
                lasting.toward.remove(joint);
            }
        }
    }
    let speed = |joint: JointName, position: f64| match of.get(&joint) {
        Some(Drive::Velocity(speed)) => Some(*speed),
        Some(Drive::Position(_) | Drive::Torque(_)) => None,
        Some(Drive::Toward(_)) | None => {
            let goal = lasting.toward.get(&joint)?;
            let left = (goal - position) / f64::from(TICK_SECONDS) / 4.0;
            Some(left.clamp(-LEISURELY, LEISURELY))
        }
    };
    let mut target = RobotTarget::default();
    let mut is_far = false;
    for limb in &layout.limbs {
        let joints = limb.joints.iter().map(|&joint| layout.joint(joint));
        let joints: Vec<_> = joints.collect();
        let measured = |name: &str| state.joints.get(name).map_or(0.0, |it| it.position);
        let positions = joints.iter().map(|joint| match of.get(&joint.name) {
            Some(Drive::Position(position)) => Some(*position),
            _ => None,
        });
        let positions: Option<Vec<f64>> = positions.collect();
        if let Some(positions) = positions.filter(|positions| !positions.is_empty()) {
            let far = joints.iter().zip(&positions);
            is_far |= far
                .map(|(joint, position)| (position - measured(&joint.urdf_name)).abs())
                .any(|way| way > FARTHEST_STEP);
            let limb = limb.name.to_string();
            target.limbs.insert(limb, LimbTarget::Positions(positions));
            continue;
        }
        let speeds = joints
            .iter()
            .map(|joint| speed(joint.name, measured(&joint.urdf_name)).unwrap_or(0.0));
        let speeds: Vec<_> = speeds.collect();
        if speeds.iter().any(|speed| *speed != 0.0) {
            let limb = limb.name.to_string();
            target.limbs.insert(limb, LimbTarget::Velocities(speeds));
        }
    }
    for limb in &layout.limbs {
        let Some(reading) = state.grippers.get(limb.name.as_str()) else {
            continue;
        };
        let joint = layout.joint(limb.gripper.joint);
        let widest = joint.limits[1];
        let opening = lasting
            .openings
            .entry(limb.name.to_string())
            .or_insert(reading.opening * widest);
        match of.get(&joint.name) {
            Some(Drive::Position(goal)) => *opening = *goal,
            _ => {
                let by = speed(joint.name, *opening).unwrap_or(0.0);
                *opening = joint.clamp(*opening + by * f64::from(TICK_SECONDS));
            }
        }
        let is_moved = of.contains_key(&joint.name) || lasting.toward.contains_key(&joint.name);
        if is_moved && reading.is_calibrated {
            let share = (*opening / widest).clamp(0.0, 1.0);
            target.grippers.insert(limb.name.to_string(), share);
        }
    }
    if let Some(neck) = layout.neck.map(|neck| layout.joint(neck)) {
        let measured = state.joints.get(&neck.urdf_name);
        let angle = lasting.head.or(measured.map(|it| it.position));
        if let Some(angle) = angle {
            let next = match of.get(&neck.name) {
                Some(Drive::Position(goal)) => Some(*goal),
                _ => {
                    let by = speed(neck.name, angle).filter(|speed| *speed != 0.0);
                    by.map(|by| angle + by * f64::from(TICK_SECONDS))
                }
            };
            if let Some(next) = next.map(|next| neck.clamp(next)) {
                lasting.head = Some(next);
                target.head = Some(next);
            }
        }
    }
    Ok((target, is_far))
}

/// Lets the robot follow a target. One that is far is a move: it takes its time, in which nothing else happens.
fn follow(
    bridge: &mut Bridge,
    target: RobotTarget,
    is_far: bool,
    vetoed: &mut Option<String>,
) -> Result<(), String> {
    aim(bridge, target.clone(), vetoed)?;
    let end = Instant::now() + Duration::from_secs(MOVE_SECONDS);
    while is_far && !has_arrived(bridge, &target) {
        if let Some(why) = vetoed {
            return Err(format!("it cannot move there: {why}"));
        }
        if Instant::now() > end {
            return Err(format!("a move takes longer than {MOVE_SECONDS} s"));
        }
        sleep(MOVE_PERIOD);
        aim(bridge, target.clone(), vetoed)?;
    }
    Ok(())
}

/// Sends a target. One that the guard vetoes makes the joints rest until another one passes.
fn aim(
    bridge: &mut Bridge,
    target: RobotTarget,
    vetoed: &mut Option<String>,
) -> Result<(), String> {
    match bridge.aim(target) {
        Ok(()) => {
            *vetoed = None;
            Ok(())
        }
        Err(TargetError::Vetoed(why)) => {
            if vetoed.as_ref() != Some(&why) {
                warn!("the real robot rests: {why}");
            }
            *vetoed = Some(why);
            Ok(())
        }
        Err(error) => Err(match bridge.watchdog() {
            WatchdogState::Ramping(reason) | WatchdogState::Held(reason) => reason.to_string(),
            WatchdogState::Watching | WatchdogState::Armed => error.to_string(),
        }),
    }
}

fn has_arrived(bridge: &Bridge, target: &RobotTarget) -> bool {
    let state = bridge.state();
    target.limbs.iter().all(|(limb, target)| {
        let LimbTarget::Positions(positions) = target else {
            return true;
        };
        let joints = bridge.joints_of(limb);
        joints.zip(positions).all(|(joint, position)| {
            let measured = state.joints.get(joint);
            measured.is_some_and(|it| (it.position - position).abs() < ARRIVED)
        })
    })
}
