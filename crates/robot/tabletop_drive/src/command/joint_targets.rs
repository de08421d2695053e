//! Targets of the joints.

use bevy::prelude::*;
use tabletop_core::{Drive, JointId, JointRole, LimbId, MeasuredJoint, RobotLayout, TICK_SECONDS};

/// Targets of the joints, for this tick and later ones.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct JointTargets {
    /// Drives of this tick, by [`JointId`].
    now: Vec<Option<Drive>>,
    /// Goals of joints that move at the speed of manual control.
    toward: Vec<Option<f64>>,
    /// Goals of joints that move as fast as their motors can.
    rush: Vec<Option<f64>>,
    /// Goals of whole limbs, whose joints arrive together.
    reach: Vec<Option<Vec<f64>>>,
    /// Number of ticks for which each limb has waited for an object that it squeezes.
    waiting: Vec<u32>,
    /// The joints of a real robot that the simulated one mirrors in this tick.
    mirrored: Option<MirroredJoints>,
}

/// The joints of a real robot as they were measured, by [`JointId`]; `None` for those that were not.
pub(crate) type MirroredJoints = Vec<Option<MeasuredJoint>>;

/// Number of ticks for which an arm waits for a squeezed object to get out of its way.
const PATIENCE: u32 = 10;

/// The position of a joint at the end of this tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Setpoint {
    /// This position, by way of all positions between.
    Move(f64),
    /// This position, at once.
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
    /// Targets that move no joint.
    pub fn none(layout: &RobotLayout) -> Self {
        let (joints, limbs) = (layout.joints.len(), layout.limbs.len());
        Self {
            now: vec![None; joints],
            toward: vec![None; joints],
            rush: vec![None; joints],
            reach: vec![None; limbs],
            waiting: vec![0; limbs],
            mirrored: None,
        }
    }

    /// Lets the robot be a mirror in this tick; replaces all targets.
    pub fn mirror(&mut self, layout: &RobotLayout, measured: Vec<(JointId, MeasuredJoint)>) {
        let mut mirrored = vec![None; layout.joints.len()];
        for (joint, measured) in measured {
            mirrored[joint.index()] = Some(measured);
        }
        *self = Self {
            mirrored: Some(mirrored),
            ..Self::none(layout)
        };
    }

    /// The joints that the robot mirrors in this tick.
    pub const fn mirrored(&self) -> Option<&MirroredJoints> {
        self.mirrored.as_ref()
    }

    /// Takes a drive of a joint, which replaces all earlier ones.
    pub fn take(&mut self, layout: &RobotLayout, joint: JointId, drive: Drive) {
        self.cancel(layout, joint);
        match drive {
            Drive::Toward(position) => {
                self.toward[joint.index()] = Some(layout.joint(joint).clamp(position));
            }
            Drive::Velocity(_) | Drive::Position(_) | Drive::Torque(_) => {
                self.now[joint.index()] = Some(drive);
            }
        }
    }

    /// Sends a joint to a position as fast as its motor can; replaces all earlier targets of the joint.
    pub fn rush(&mut self, layout: &RobotLayout, joint: JointId, position: f64) {
        self.cancel(layout, joint);
        self.rush[joint.index()] = Some(layout.joint(joint).clamp(position));
    }

    /// Sends a limb to these angles.
    pub fn send(&mut self, layout: &RobotLayout, limb: LimbId, angles: Vec<f64>) {
        self.give_up(layout, limb);
        self.reach[limb.index()] = Some(angles);
    }

    /// Forgets the goal of a joint.
    fn cancel(&mut self, layout: &RobotLayout, joint: JointId) {
        self.now[joint.index()] = None;
        self.toward[joint.index()] = None;
        self.rush[joint.index()] = None;
        if let JointRole::Limb { limb, .. } = layout.joint(joint).role {
            self.reach[limb.index()] = None;
        }
    }

    /// True if any joint has a target.
    pub fn are_given(&self) -> bool {
        self.mirrored.is_some()
            || self.now.iter().any(Option::is_some)
            || self.toward.iter().any(Option::is_some)
            || self.rush.iter().any(Option::is_some)
            || self.reach.iter().any(Option::is_some)
    }

    /// True while a limb is on its way to a goal.
    pub fn is_under_way(&self, layout: &RobotLayout, limb: LimbId) -> bool {
        let joints = &layout.limb(limb).joints;
        self.reach[limb.index()].is_some()
            || joints.iter().any(|joint| {
                self.toward[joint.index()].is_some() || self.rush[joint.index()].is_some()
            })
    }

    /// Ends the targets of this tick, and those that are reached now that the joints are at these positions.
    pub fn end_tick(&mut self, layout: &RobotLayout, reached: &[f64]) {
        self.now.fill(None);
        self.mirrored = None;
        for goals in [&mut self.toward, &mut self.rush] {
            for (goal, reached) in goals.iter_mut().zip(reached) {
                goal.take_if(|goal| goal == reached);
            }
        }
        for (limb, goal) in layout.limbs.iter().zip(&mut self.reach) {
            let reached = limb.joints.iter().map(|joint| &reached[joint.index()]);
            goal.take_if(|angles| angles.iter().eq(reached));
        }
    }

    /// Counts a tick in which the limb waits for a squeezed object; returns the object once the limb has waited long enough.
    pub fn wait_for(&mut self, limb: LimbId, squeezed: Option<Entity>) -> Option<Entity> {
        let waiting = &mut self.waiting[limb.index()];
        *waiting = if squeezed.is_some() { *waiting + 1 } else { 0 };
        squeezed.filter(|_| *waiting >= PATIENCE)
    }

    /// Gives up the goals of a limb.
    pub fn give_up(&mut self, layout: &RobotLayout, limb: LimbId) {
        for &joint in &layout.limb(limb).joints {
            self.cancel(layout, joint);
        }
    }

    /// The commanded torque of a joint, in N m.
    pub fn torque(&self, joint: JointId) -> Option<f64> {
        match self.now[joint.index()] {
            Some(Drive::Torque(torque)) => Some(torque),
            _ => None,
        }
    }

    /// True if a gripper with this opening is commanded to open, even where it cannot open any wider.
    pub fn open(&self, layout: &RobotLayout, gripper: JointId, opening: f64) -> bool {
        let [_, widest] = layout.joint(gripper).limits;
        let is_wider = |there: f64| there > opening || there >= widest;
        match self.now[gripper.index()] {
            Some(Drive::Velocity(velocity)) => velocity > 0.0,
            Some(Drive::Position(there) | Drive::Toward(there)) => is_wider(there),
            Some(Drive::Torque(_)) => false,
            None => self.goal(layout, gripper).is_some_and(is_wider),
        }
    }

    /// The goal of a joint.
    pub fn goal(&self, layout: &RobotLayout, joint: JointId) -> Option<f64> {
        let of_limb = || match layout.joint(joint).role {
            JointRole::Limb { limb, place } => {
                let angles = self.reach[limb.index()].as_ref()?;
                angles.get(place).copied()
            }
            JointRole::Neck | JointRole::Gripper(_) => None,
        };
        self.toward[joint.index()]
            .or(self.rush[joint.index()])
            .or_else(of_limb)
    }

    /// The setpoint of a joint at `position` for this tick, within its limits.
    pub fn setpoint(&self, layout: &RobotLayout, joint: JointId, position: f64) -> Setpoint {
        let limited = layout.joint(joint);
        let step = match self.now[joint.index()] {
            Some(Drive::Velocity(velocity)) => velocity * f64::from(TICK_SECONDS),
            Some(Drive::Position(there)) => return Setpoint::Jump(limited.clamp(there)),
            _ => match (self.toward[joint.index()], self.rush[joint.index()]) {
                (_, Some(there)) => return Setpoint::Jump(there),
                (Some(there), _) => toward(position, there, limited.manual_speed()),
                (None, None) => 0.0,
            },
        };
        Setpoint::Move(limited.clamp(position + step))
    }

    /// The setpoints of a limb's joints at these angles for this tick.
    pub fn limb_setpoints(
        &self,
        layout: &RobotLayout,
        limb: LimbId,
        angles: &[f64],
    ) -> Vec<Setpoint> {
        let Some(goal) = &self.reach[limb.index()] else {
            let joints = layout.limb(limb).joints.iter().zip(angles);
            return joints
                .map(|(joint, angle)| self.setpoint(layout, *joint, *angle))
                .collect();
        };
        let joints = layout.limb(limb).joints.iter();
        let ways = joints.zip(goal.iter().zip(angles));
        let times = ways.map(|(joint, (goal, angle))| {
            (goal - angle).abs() / (layout.joint(*joint).manual_speed() * f64::from(TICK_SECONDS))
        });
        let ticks = times.fold(0.0, f64::max).ceil();
        let joints = goal.iter().zip(angles);
        joints
            .map(|(goal, angle)| {
                Setpoint::Move(if ticks <= 1.0 {
                    *goal
                } else {
                    angle + (goal - angle) / ticks
                })
            })
            .collect()
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
    use tabletop_robot::positions;

    const E1: JointId = JointId(3);
    const RIGHT: LimbId = LimbId(1);

    fn baxter() -> &'static RobotLayout {
        RobotLayout::baxter()
    }

    fn no_targets() -> JointTargets {
        JointTargets::none(baxter())
    }

    fn targets(joint: JointId, drive: Drive) -> JointTargets {
        let mut targets = no_targets();
        targets.take(baxter(), joint, drive);
        targets
    }

    #[test]
    fn a_velocity_holds_for_one_tick() {
        let mut targets = targets(E1, Drive::Velocity(-1.5));
        assert_eq!(
            targets.setpoint(baxter(), E1, 1.0),
            Setpoint::Move(1.0 - 1.5 * f64::from(TICK_SECONDS))
        );
        targets.end_tick(baxter(), &positions(&Robot::default()));
        assert_eq!(targets.setpoint(baxter(), E1, 1.0), Setpoint::Move(1.0));
    }

    #[test]
    fn limits_are_kept() {
        assert_eq!(
            targets(E1, Drive::Velocity(1e9)).setpoint(baxter(), E1, 1.0),
            Setpoint::Move(2.618)
        );
        assert_eq!(
            targets(E1, Drive::Position(-7.0)).setpoint(baxter(), E1, 1.0),
            Setpoint::Jump(-0.05)
        );
        assert_eq!(
            targets(E1, Drive::Toward(-7.0)).toward[E1.index()],
            Some(-0.05)
        );
    }

    #[test]
    fn a_gripper_opens_by_order_even_where_it_cannot_move() {
        const GRIPPER: JointId = JointId(16);
        const WIDEST_GRIP: f64 = 2.0;
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
                targets.open(baxter(), GRIPPER, opening),
                opens,
                "{drive:?} at {opening}"
            );
        }
        assert!(!no_targets().open(baxter(), GRIPPER, WIDEST_GRIP));
    }

    #[test]
    fn a_joint_goes_on_towards_its_goal_and_stops_there() {
        let mut targets = targets(E1, Drive::Toward(1.02));
        let mut robot = Robot::default();
        robot.joints[E1.index()].position = 1.0;
        for _ in 0..2 {
            let next = targets
                .setpoint(baxter(), E1, robot.joints[E1.index()].position)
                .position();
            robot.joints[E1.index()].position = next;
            targets.end_tick(baxter(), &positions(&robot));
        }
        assert_eq!(robot.joints[E1.index()].position, 1.02);
        assert!(!targets.are_given());
    }

    #[test]
    fn the_joints_of_an_arm_that_reaches_arrive_together() {
        let mut targets = no_targets();
        let mut robot = Robot::default();
        let start = robot.positions_of(&baxter().limb(RIGHT).joints);
        let mut goal = start.clone();
        goal[0] -= 1.0;
        goal[5] += 0.25;
        targets.send(baxter(), RIGHT, goal.clone());
        let mut ticks = 0;
        while targets.is_under_way(baxter(), RIGHT) {
            let now = robot.positions_of(&baxter().limb(RIGHT).joints);
            let slow = (now[5] - start[5]) / 0.25;
            let fast = (start[0] - now[0]) / 1.0;
            assert!((slow - fast).abs() < 1e-9);
            let setpoints = targets.limb_setpoints(baxter(), RIGHT, &now);
            for (joint, setpoint) in baxter().limb(RIGHT).joints.iter().zip(setpoints) {
                robot.joints[joint.index()].position = setpoint.position();
            }
            targets.end_tick(baxter(), &positions(&robot));
            ticks += 1;
        }
        assert!((60..=61).contains(&ticks), "{ticks}");
        assert_eq!(robot.positions_of(&baxter().limb(RIGHT).joints), goal);
    }

    #[test]
    fn a_new_order_takes_the_place_of_the_old_one() {
        let mut targets = no_targets();
        targets.send(baxter(), LimbId(0), vec![0.0; 7]);
        targets.take(baxter(), E1, Drive::Velocity(0.0));
        assert!(!targets.is_under_way(baxter(), LimbId(0)));
        targets.take(baxter(), E1, Drive::Toward(0.0));
        targets.take(baxter(), E1, Drive::Velocity(0.5));
        assert!(!targets.is_under_way(baxter(), LimbId(0)));
    }
}
