//! The orders to the simulated robot, taken over for the real one.

use std::{
    collections::BTreeMap,
    thread::sleep,
    time::{Duration, Instant},
};

use bevy::prelude::*;
use tabletop_bridge::{
    Bridge, FARTHEST_STEP, LimbTarget, RobotState, RobotTarget, TargetError, WatchdogState,
    approach_speed,
};
use tabletop_core::{
    Drive, IssuedCommand, JointLayout, JointName, RobotCommand, RobotLayout, SimCommand, SimFact,
    TICK_SECONDS,
};

use crate::RealRobot;

/// How long a move to given angles may take, in s, and how far, in rad, each joint may be from its angle in the end.
const MOVE_SECONDS: u64 = 30;
const ARRIVED: f64 = 0.02;
/// From one order to the next in a move.
const MOVE_PERIOD: Duration = Duration::from_millis(10);
/// Speed of a joint, in rad/s, and of an opening, in units/s, that is to go to a position at a leisurely pace, and how far, in rad, a joint may
/// be from it in the end.
const LEISURELY: f64 = 1.0;
const NEARLY_THERE: f64 = 0.01;

/// The orders that last for more than a tick.
#[derive(Default)]
pub(crate) struct LastingOrders {
    /// Positions that joints are to go to at a leisurely pace, until they are there.
    toward: BTreeMap<JointName, f64>,
    /// The opening of each gripper that is being moved, in units, as it was last ordered, by the names of the limbs.
    openings: BTreeMap<String, f64>,
    /// The head's angle as it was last ordered, while it is being turned.
    head: Option<f64>,
    /// The reason for which the last target was vetoed, if it was.
    vetoed: Option<String>,
}

/// Takes the orders to joints out of the commands of this tick. A real robot that is driven gets them. In a pause they are refused like
/// those to the simulated one, and it rests.
pub(crate) fn take_over(
    In(will_be_paused): In<bool>,
    mut real: ResMut<RealRobot>,
    layout: Res<RobotLayout>,
    mut commands: MessageMutator<IssuedCommand>,
    mut facts: MessageWriter<SimFact>,
    mut lasting: Local<LastingOrders>,
) {
    if real.is_added() {
        // Nobody has wanted anything of this one.
        *lasting = LastingOrders::default();
    }
    let drives = match will_be_paused {
        true => {
            commands.clear();
            Vec::new()
        }
        false => taken(&mut commands, &mut facts),
    };
    let state = real.state();
    if real.end().is_some() {
        return;
    }
    let Some(bridge) = real.bridge() else {
        return;
    };
    let wanted = match will_be_paused {
        true => Ok((RobotTarget::default(), false)),
        // What is said to limbs that are not driven reaches nobody.
        false => target_of(
            &drives,
            &layout,
            &state,
            |limb| bridge.drives(limb),
            &mut lasting,
        ),
    };
    let (target, is_far) = match wanted {
        Ok(wanted) => wanted,
        Err(reason) => {
            real.give_up(reason);
            return;
        }
    };
    if bridge.watchdog() == WatchdogState::Watching {
        // Until somebody wants a motion, it is left alone.
        if target == RobotTarget::default() {
            return;
        }
        if let Err(error) = bridge.arm() {
            real.give_up(error.to_string());
            return;
        }
    }
    if let Err(reason) = follow(bridge, target, is_far, &mut lasting.vetoed) {
        real.give_up(reason);
    }
}

/// The drives of this tick by all who may drive a real robot. They are not carried out by the simulated one: it is where the real one is.
fn taken(
    commands: &mut MessageMutator<IssuedCommand>,
    facts: &mut MessageWriter<SimFact>,
) -> Vec<(JointName, Drive)> {
    let mut drives = Vec::new();
    for issued in commands.read().filter(|issued| issued.may_drive()) {
        let SimCommand::Robot(command) = &mut issued.command else {
            continue;
        };
        match command {
            RobotCommand::Drive(own) => drives.append(own),
            RobotCommand::ReachTo { .. } => {
                *command = RobotCommand::Drive(Vec::new());
                facts.write(SimFact::Refused {
                    cause: Some(issued.id),
                    reason: "a real robot is told angles and velocities of its joints, not poses"
                        .into(),
                });
            }
            RobotCommand::Mirror(_)
            | RobotCommand::Show(_)
            | RobotCommand::ShowFace(_)
            | RobotCommand::ShowMarkers(_) => {}
        }
    }
    drives
}

/// What the real robot is to do for these orders, and whether it is farther away than a step.
fn target_of(
    drives: &[(JointName, Drive)],
    layout: &RobotLayout,
    state: &RobotState,
    is_driven: impl Fn(&str) -> bool,
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
    let mut target = RobotTarget::default();
    let mut is_far = false;
    for limb in layout.limbs.iter().filter(|it| is_driven(it.name.as_str())) {
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
        let speeds = joints.iter().map(|joint| {
            let here = measured(&joint.urdf_name);
            let goal = lasting.toward.get(&joint.name);
            if goal.is_some_and(|goal| (goal - here).abs() < NEARLY_THERE) {
                lasting.toward.remove(&joint.name);
            }
            lasting.speed(&of, joint.name, here)
        });
        let speeds: Vec<_> = speeds.collect();
        if speeds.iter().any(|speed| *speed != 0.0) {
            let limb = limb.name.to_string();
            target.limbs.insert(limb, LimbTarget::Velocities(speeds));
        }
    }
    for limb in layout.limbs.iter().filter(|it| is_driven(it.name.as_str())) {
        let Some(reading) = state.grippers.get(limb.name.as_str()) else {
            continue;
        };
        let joint = layout.joint(limb.gripper.joint);
        let widest = joint.limits[1];
        let ordered = lasting.openings.get(limb.name.as_str()).copied();
        let opening = ordered.unwrap_or(reading.opening * widest);
        let Some(next) = lasting.next(&of, joint, opening) else {
            lasting.openings.remove(limb.name.as_str());
            continue;
        };
        if !reading.is_calibrated {
            return Err(format!(
                "the gripper of limb {} does not know its range, so it cannot be moved: begin with --calibrate-grippers, with which it closes and opens to find it",
                limb.name
            ));
        }
        lasting.openings.insert(limb.name.to_string(), next);
        let share = (next / widest).clamp(0.0, 1.0);
        target.grippers.insert(limb.name.to_string(), share);
    }
    if let Some(neck) = layout.neck.map(|neck| layout.joint(neck)) {
        let measured = state.joints.get(&neck.urdf_name);
        let angle = lasting.head.or(measured.map(|it| it.position));
        lasting.head = angle.and_then(|angle| lasting.next(&of, neck, angle));
        target.head = lasting.head;
    }
    Ok((target, is_far))
}

impl LastingOrders {
    /// The speed that a joint at this position is to have: 0 if nobody wants it to move.
    fn speed(&self, of: &BTreeMap<JointName, Drive>, joint: JointName, position: f64) -> f64 {
        let toward = |goal: f64| {
            // As the watchdog brakes, so that it is not passed.
            let left = approach_speed((goal - position).abs()).copysign(goal - position);
            left.clamp(-LEISURELY, LEISURELY)
        };
        match of.get(&joint) {
            Some(Drive::Velocity(speed)) => *speed,
            Some(Drive::Position(_) | Drive::Torque(_)) => 0.0,
            Some(Drive::Toward(_)) | None => self.toward.get(&joint).copied().map_or(0.0, toward),
        }
    }

    /// The next position of a joint that is told positions and was told this one last; none if nobody wants it to move.
    fn next(
        &mut self,
        of: &BTreeMap<JointName, Drive>,
        joint: &JointLayout,
        last: f64,
    ) -> Option<f64> {
        if let Some(Drive::Position(goal)) = of.get(&joint.name) {
            return Some(joint.clamp(*goal));
        }
        let speed = self.speed(of, joint.name, last);
        let next = joint.clamp(last + speed * f64::from(TICK_SECONDS));
        let goal = self.toward.get(&joint.name).copied();
        if let Some(goal) = goal.map(|goal| joint.clamp(goal))
            && (goal - next).abs() < NEARLY_THERE
        {
            self.toward.remove(&joint.name);
            return Some(goal);
        }
        (speed != 0.0).then_some(next)
    }
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
