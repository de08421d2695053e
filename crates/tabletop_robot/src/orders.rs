//! What the joints have been told.

use bevy::{ecs::system::SystemState, prelude::*};
use tabletop_core::{
    Arm, Drive, JOINTS_PER_ARM, Markers, Paused, Robot, RobotJoint, RobotMode, SimCommand, SimFact,
    TICK_SECONDS, WIDEST_GRIP,
};

use crate::{reach, shown};

/// Speed of manual control, in rad/s, and units/s for grippers (report section 5.1).
pub const MANUAL_SPEED: f64 = 1.0;

/// What the joints are to do in this tick and later.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Orders {
    /// Orders for this tick, by [`RobotJoint::index`].
    now: [Option<Drive>; 17],
    /// Where joints are on their way to.
    toward: [Option<f64>; 17],
    /// Where joints are on their way to as fast as their motors can.
    rush: [Option<f64>; 17],
    /// Where whole arms are on their way to, all joints arriving together.
    reach: [Option<[f64; JOINTS_PER_ARM]>; 2],
    /// For how many ticks each arm has waited for what it squeezes.
    waiting: [u32; 2],
}

/// Ticks for which an arm waits for what it squeezes to get out of its way.
const PATIENCE: u32 = 10;

/// Where a joint is to be after this tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Want {
    /// There, by way of everything between.
    Move(f64),
    /// There at once.
    Jump(f64),
}

impl Want {
    /// The position itself.
    pub const fn position(self) -> f64 {
        match self {
            Self::Move(position) | Self::Jump(position) => position,
        }
    }
}

impl Orders {
    /// Takes an order for a joint, in place of all earlier ones for it.
    fn take(&mut self, joint: RobotJoint, drive: Drive) {
        self.cancel(joint);
        match drive {
            Drive::Toward(position) => self.toward[joint.index()] = Some(joint.clamp(position)),
            _ => self.now[joint.index()] = Some(drive),
        }
    }

    /// Sends a joint to a position as fast as its motor can, in place of all earlier orders for it.
    fn rush(&mut self, joint: RobotJoint, position: f64) {
        self.cancel(joint);
        self.rush[joint.index()] = Some(joint.clamp(position));
    }

    /// Sends an arm to these angles.
    pub fn send(&mut self, arm: Arm, angles: [f64; JOINTS_PER_ARM]) {
        for joint in RobotJoint::of_arm(arm) {
            self.cancel(joint);
        }
        self.reach[arm as usize] = Some(angles);
    }

    /// Forgets where a joint was on its way to.
    fn cancel(&mut self, joint: RobotJoint) {
        self.now[joint.index()] = None;
        self.toward[joint.index()] = None;
        self.rush[joint.index()] = None;
        if let Some(arm) = joint.arm().filter(|_| !joint.is_gripper()) {
            self.reach[arm as usize] = None;
        }
    }

    /// Whether any joint is to move.
    pub fn are_given(&self) -> bool {
        self.now.iter().any(Option::is_some)
            || self.toward.iter().any(Option::is_some)
            || self.rush.iter().any(Option::is_some)
            || self.reach.iter().any(Option::is_some)
    }

    /// Whether an arm is on its way to somewhere.
    pub fn is_under_way(&self, arm: Arm) -> bool {
        let joints = RobotJoint::of_arm(arm);
        self.reach[arm as usize].is_some()
            || joints.into_iter().any(|joint| {
                self.toward[joint.index()].is_some() || self.rush[joint.index()].is_some()
            })
    }

    /// Ends the orders of this tick, and those that have been carried out now that the joints are at these positions.
    pub fn end_tick(&mut self, reached: &[f64; 17]) {
        self.now = [None; 17];
        for goals in [&mut self.toward, &mut self.rush] {
            for (goal, reached) in goals.iter_mut().zip(reached) {
                goal.take_if(|goal| goal == reached);
            }
        }
        for arm in Arm::BOTH {
            let reached = RobotJoint::of_arm(arm).map(|joint| reached[joint.index()]);
            self.reach[arm as usize].take_if(|angles| *angles == reached);
        }
    }

    /// Notes what an arm waits for in this tick; returns it when it has waited for long enough.
    pub fn wait_for(&mut self, arm: Arm, squeezed: Option<Entity>) -> Option<Entity> {
        let waiting = &mut self.waiting[arm as usize];
        *waiting = if squeezed.is_some() { *waiting + 1 } else { 0 };
        squeezed.filter(|_| *waiting >= PATIENCE)
    }

    /// Gives up where an arm was on its way to.
    pub fn give_up(&mut self, arm: Arm) {
        for joint in RobotJoint::of_arm(arm) {
            self.cancel(joint);
        }
    }

    /// The torque that a joint is told to apply, in N m.
    pub fn torque(&self, joint: RobotJoint) -> Option<f64> {
        match self.now[joint.index()] {
            Some(Drive::Torque(torque)) => Some(torque),
            _ => None,
        }
    }

    /// Whether a gripper with this opening is told to open, also where it cannot open any wider.
    pub fn open(&self, gripper: RobotJoint, opening: f64) -> bool {
        let is_wider = |there: f64| there > opening || there >= WIDEST_GRIP;
        match self.now[gripper.index()] {
            Some(Drive::Velocity(velocity)) => velocity > 0.0,
            Some(Drive::Position(there) | Drive::Toward(there)) => is_wider(there),
            Some(Drive::Torque(_)) => false,
            None => self.goal(gripper).is_some_and(is_wider),
        }
    }

    /// Where a joint is on its way to.
    pub fn goal(&self, joint: RobotJoint) -> Option<f64> {
        let of_arm = || {
            let arm = joint.arm()?;
            let place = RobotJoint::of_arm(arm).iter().position(|it| *it == joint)?;
            Some(self.reach[arm as usize]?[place])
        };
        self.toward[joint.index()]
            .or(self.rush[joint.index()])
            .or_else(of_arm)
    }

    /// Where a joint at `position` is to be after this tick, within its limits.
    pub fn want(&self, joint: RobotJoint, position: f64) -> Want {
        let step = match self.now[joint.index()] {
            Some(Drive::Velocity(velocity)) => velocity * f64::from(TICK_SECONDS),
            Some(Drive::Position(there)) => return Want::Jump(joint.clamp(there)),
            _ => match (self.toward[joint.index()], self.rush[joint.index()]) {
                (_, Some(there)) => return Want::Jump(there),
                (Some(there), _) => toward(position, there, MANUAL_SPEED),
                (None, None) => 0.0,
            },
        };
        Want::Move(joint.clamp(position + step))
    }

    /// Where the joints of an arm at these angles are to be after this tick.
    pub fn want_arm(&self, arm: Arm, angles: [f64; JOINTS_PER_ARM]) -> [Want; JOINTS_PER_ARM] {
        let joints = RobotJoint::of_arm(arm);
        let Some(goal) = self.reach[arm as usize] else {
            return std::array::from_fn(|i| self.want(joints[i], angles[i]));
        };
        let farthest = (0..JOINTS_PER_ARM)
            .map(|i| (goal[i] - angles[i]).abs())
            .fold(0.0, f64::max);
        let ticks = (farthest / (MANUAL_SPEED * f64::from(TICK_SECONDS))).ceil();
        std::array::from_fn(|i| {
            Want::Move(if ticks <= 1.0 {
                goal[i]
            } else {
                angles[i] + (goal[i] - angles[i]) / ticks
            })
        })
    }
}

/// A tick's step from one position towards another; the last one is exact.
fn toward(position: f64, there: f64, speed: f64) -> f64 {
    let way = there - position;
    let most = speed * f64::from(TICK_SECONDS);
    way.clamp(-most, most)
}

/// Carries out the commands to the robot.
pub(crate) fn obey(
    world: &mut World,
    reader: &mut SystemState<MessageReader<SimCommand>>,
) -> Result {
    let commands = SimCommand::unread(world, reader, |command| {
        matches!(
            command,
            SimCommand::ShowRobot(_)
                | SimCommand::Drive(_)
                | SimCommand::ReachTo { .. }
                | SimCommand::ShowFace(_)
                | SimCommand::ShowMarkers(_)
        )
    })?;
    for command in commands {
        if let Err(reason) = carry_out(world, command) {
            world.write_message(SimFact::Refused { reason });
        }
    }
    Ok(())
}

fn carry_out(world: &mut World, command: SimCommand) -> Result<(), String> {
    match command {
        SimCommand::ShowRobot(show) => shown::show(world, show),
        SimCommand::Drive(drives) => {
            refuse_while_paused(world)?;
            let mode = world.resource::<Robot>().mode;
            for &(joint, drive) in &drives {
                check(mode, joint, drive)?;
            }
            let mut orders = world.resource_mut::<Orders>();
            for (joint, drive) in drives {
                match drive {
                    Drive::Position(there) if has_motor(mode, joint) => orders.rush(joint, there),
                    _ => orders.take(joint, drive),
                }
            }
        }
        SimCommand::ReachTo { arm, pose } => {
            refuse_while_paused(world)?;
            let angles = reach::solve(world, arm, pose)?;
            world.resource_mut::<Orders>().send(arm, angles);
        }
        SimCommand::ShowFace(face) => world.resource_mut::<Robot>().face = face,
        SimCommand::ShowMarkers(points) => {
            if let Some(point) = points.iter().find(|point| !point.is_finite()) {
                return Err(format!("a marker cannot stand at {point}"));
            }
            world.resource_mut::<Markers>().0 = points;
        }
        _ => {}
    }
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
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::positions;

    const E1: RobotJoint = RobotJoint::LeftE1;

    fn orders(joint: RobotJoint, drive: Drive) -> Orders {
        let mut orders = Orders::default();
        orders.take(joint, drive);
        orders
    }

    #[test]
    fn a_velocity_holds_for_one_tick() {
        let mut orders = orders(E1, Drive::Velocity(-1.5));
        assert_eq!(
            orders.want(E1, 1.0),
            Want::Move(1.0 - 1.5 * f64::from(TICK_SECONDS))
        );
        orders.end_tick(&positions(&Robot::default()));
        assert_eq!(orders.want(E1, 1.0), Want::Move(1.0));
    }

    #[test]
    fn limits_are_kept() {
        assert_eq!(
            orders(E1, Drive::Velocity(1e9)).want(E1, 1.0),
            Want::Move(2.618)
        );
        assert_eq!(
            orders(E1, Drive::Position(-7.0)).want(E1, 1.0),
            Want::Jump(-0.05)
        );
        assert_eq!(
            orders(E1, Drive::Toward(-7.0)).toward[E1.index()],
            Some(-0.05)
        );
    }

    #[test]
    fn a_gripper_opens_by_order_even_where_it_cannot_move() {
        const GRIPPER: RobotJoint = RobotJoint::RightGripper;
        for (drive, opening, opens) in [
            (Drive::Velocity(0.1), WIDEST_GRIP, true),
            (Drive::Velocity(0.1), 1.0, true),
            (Drive::Velocity(0.0), 1.0, false),
            (Drive::Velocity(-0.1), 1.0, false),
            (Drive::Toward(WIDEST_GRIP), WIDEST_GRIP, true),
            (Drive::Position(9.0), WIDEST_GRIP, true),
            (Drive::Toward(1.1), 1.0, true),
            (Drive::Toward(1.0), 1.0, false),
            (Drive::Toward(0.0), 1.0, false),
            (Drive::Position(1.9), WIDEST_GRIP, false),
        ] {
            let orders = orders(GRIPPER, drive);
            assert_eq!(
                orders.open(GRIPPER, opening),
                opens,
                "{drive:?} at {opening}"
            );
        }
        assert!(!Orders::default().open(GRIPPER, WIDEST_GRIP));
    }

    #[test]
    fn a_joint_goes_on_towards_its_goal_and_stops_there() {
        let mut orders = orders(E1, Drive::Toward(1.02));
        let mut robot = Robot::default();
        robot.joints[E1.index()].position = 1.0;
        for _ in 0..2 {
            let next = orders.want(E1, robot.joint(E1).position).position();
            robot.joints[E1.index()].position = next;
            orders.end_tick(&positions(&robot));
        }
        assert_eq!(robot.joint(E1).position, 1.02);
        assert!(!orders.are_given());
    }

    #[test]
    fn the_joints_of_an_arm_that_reaches_arrive_together() {
        let mut orders = Orders::default();
        let mut robot = Robot::default();
        let start = robot.angles(Arm::Right);
        let mut goal = start;
        goal[0] -= 1.0;
        goal[5] += 0.25;
        orders.send(Arm::Right, goal);
        let mut ticks = 0;
        while orders.is_under_way(Arm::Right) {
            let now = robot.angles(Arm::Right);
            let slow = (now[5] - start[5]) / 0.25;
            let fast = (start[0] - now[0]) / 1.0;
            assert!((slow - fast).abs() < 1e-9);
            let wants = orders.want_arm(Arm::Right, now);
            for (joint, want) in RobotJoint::of_arm(Arm::Right).into_iter().zip(wants) {
                robot.joints[joint.index()].position = want.position();
            }
            orders.end_tick(&positions(&robot));
            ticks += 1;
        }
        assert!((60..=61).contains(&ticks), "{ticks}");
        assert_eq!(robot.angles(Arm::Right), goal);
    }

    #[test]
    fn a_new_order_takes_the_place_of_the_old_one() {
        let mut orders = Orders::default();
        orders.send(Arm::Left, [0.0; 7]);
        orders.take(E1, Drive::Velocity(0.0));
        assert!(!orders.is_under_way(Arm::Left));
        orders.take(E1, Drive::Toward(0.0));
        orders.take(E1, Drive::Velocity(0.5));
        assert!(!orders.is_under_way(Arm::Left));
    }

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
