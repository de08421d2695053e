//! Where the joints are to go.

use bevy::prelude::*;
use tabletop_core::{Arm, Drive, JOINTS_PER_ARM, RobotJoint, TICK_SECONDS, WIDEST_GRIP};

/// Speed of manual control, in rad/s, and units/s for grippers (report section 5.1).
pub const MANUAL_SPEED: f64 = 1.0;

/// What the joints are to do in this tick and later.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct JointTargets {
    /// JointTargets for this tick, by [`RobotJoint::index`].
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
pub(crate) enum Setpoint {
    /// There, by way of everything between.
    Move(f64),
    /// There at once.
    Jump(f64),
}

impl Setpoint {
    /// The position itself.
    pub const fn position(self) -> f64 {
        match self {
            Self::Move(position) | Self::Jump(position) => position,
        }
    }
}

impl JointTargets {
    /// Takes an order for a joint, in place of all earlier ones for it.
    pub fn take(&mut self, joint: RobotJoint, drive: Drive) {
        self.cancel(joint);
        match drive {
            Drive::Toward(position) => self.toward[joint.index()] = Some(joint.clamp(position)),
            _ => self.now[joint.index()] = Some(drive),
        }
    }

    /// Sends a joint to a position as fast as its motor can, in place of all earlier orders for it.
    pub fn rush(&mut self, joint: RobotJoint, position: f64) {
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
    pub fn setpoint(&self, joint: RobotJoint, position: f64) -> Setpoint {
        let step = match self.now[joint.index()] {
            Some(Drive::Velocity(velocity)) => velocity * f64::from(TICK_SECONDS),
            Some(Drive::Position(there)) => return Setpoint::Jump(joint.clamp(there)),
            _ => match (self.toward[joint.index()], self.rush[joint.index()]) {
                (_, Some(there)) => return Setpoint::Jump(there),
                (Some(there), _) => toward(position, there, MANUAL_SPEED),
                (None, None) => 0.0,
            },
        };
        Setpoint::Move(joint.clamp(position + step))
    }

    /// Where the joints of an arm at these angles are to be after this tick.
    pub fn arm_setpoints(
        &self,
        arm: Arm,
        angles: [f64; JOINTS_PER_ARM],
    ) -> [Setpoint; JOINTS_PER_ARM] {
        let joints = RobotJoint::of_arm(arm);
        let Some(goal) = self.reach[arm as usize] else {
            return std::array::from_fn(|i| self.setpoint(joints[i], angles[i]));
        };
        let farthest = (0..JOINTS_PER_ARM)
            .map(|i| (goal[i] - angles[i]).abs())
            .fold(0.0, f64::max);
        let ticks = (farthest / (MANUAL_SPEED * f64::from(TICK_SECONDS))).ceil();
        std::array::from_fn(|i| {
            Setpoint::Move(if ticks <= 1.0 {
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

#[cfg(test)]
mod tests {
    use tabletop_core::Robot;

    use super::*;
    use crate::articulation::link_entities::positions;

    const E1: RobotJoint = RobotJoint::LeftE1;

    fn targets(joint: RobotJoint, drive: Drive) -> JointTargets {
        let mut targets = JointTargets::default();
        targets.take(joint, drive);
        targets
    }

    #[test]
    fn a_velocity_holds_for_one_tick() {
        let mut targets = targets(E1, Drive::Velocity(-1.5));
        assert_eq!(
            targets.setpoint(E1, 1.0),
            Setpoint::Move(1.0 - 1.5 * f64::from(TICK_SECONDS))
        );
        targets.end_tick(&positions(&Robot::default()));
        assert_eq!(targets.setpoint(E1, 1.0), Setpoint::Move(1.0));
    }

    #[test]
    fn limits_are_kept() {
        assert_eq!(
            targets(E1, Drive::Velocity(1e9)).setpoint(E1, 1.0),
            Setpoint::Move(2.618)
        );
        assert_eq!(
            targets(E1, Drive::Position(-7.0)).setpoint(E1, 1.0),
            Setpoint::Jump(-0.05)
        );
        assert_eq!(
            targets(E1, Drive::Toward(-7.0)).toward[E1.index()],
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
            let targets = targets(GRIPPER, drive);
            assert_eq!(
                targets.open(GRIPPER, opening),
                opens,
                "{drive:?} at {opening}"
            );
        }
        assert!(!JointTargets::default().open(GRIPPER, WIDEST_GRIP));
    }

    #[test]
    fn a_joint_goes_on_towards_its_goal_and_stops_there() {
        let mut targets = targets(E1, Drive::Toward(1.02));
        let mut robot = Robot::default();
        robot.joints[E1.index()].position = 1.0;
        for _ in 0..2 {
            let next = targets.setpoint(E1, robot.joint(E1).position).position();
            robot.joints[E1.index()].position = next;
            targets.end_tick(&positions(&robot));
        }
        assert_eq!(robot.joint(E1).position, 1.02);
        assert!(!targets.are_given());
    }

    #[test]
    fn the_joints_of_an_arm_that_reaches_arrive_together() {
        let mut targets = JointTargets::default();
        let mut robot = Robot::default();
        let start = robot.angles(Arm::Right);
        let mut goal = start;
        goal[0] -= 1.0;
        goal[5] += 0.25;
        targets.send(Arm::Right, goal);
        let mut ticks = 0;
        while targets.is_under_way(Arm::Right) {
            let now = robot.angles(Arm::Right);
            let slow = (now[5] - start[5]) / 0.25;
            let fast = (start[0] - now[0]) / 1.0;
            assert!((slow - fast).abs() < 1e-9);
            let setpoints = targets.arm_setpoints(Arm::Right, now);
            for (joint, setpoint) in RobotJoint::of_arm(Arm::Right).into_iter().zip(setpoints) {
                robot.joints[joint.index()].position = setpoint.position();
            }
            targets.end_tick(&positions(&robot));
            ticks += 1;
        }
        assert!((60..=61).contains(&ticks), "{ticks}");
        assert_eq!(robot.angles(Arm::Right), goal);
    }

    #[test]
    fn a_new_order_takes_the_place_of_the_old_one() {
        let mut targets = JointTargets::default();
        targets.send(Arm::Left, [0.0; 7]);
        targets.take(E1, Drive::Velocity(0.0));
        assert!(!targets.is_under_way(Arm::Left));
        targets.take(E1, Drive::Toward(0.0));
        targets.take(E1, Drive::Velocity(0.5));
        assert!(!targets.is_under_way(Arm::Left));
    }
}
