//! The robot: its joints, what they are told, and what is known of it.

mod layout;
mod layout_file;
mod name;

pub use layout::{
    BaseLayout, CameraLayout, FingerLook, GripperKind, GripperLayout, JointId, JointLayout,
    JointRole, LimbId, LimbLayout, LinkFrame, RobotLayout,
};
pub use layout_file::{LayoutError, LayoutFile};
pub use name::{JointName, LimbName};

use std::{f64::consts::FRAC_PI_2, fmt};

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{Pose, TICK_SECONDS, Table};

/// One of the robot's arms, as the robot sees them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Arm {
    /// The left arm, at negative X.
    Left,
    /// The right arm.
    Right,
}

impl Arm {
    /// The arms, in the order in which scripts see them.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// Its name in frames of a robot description: `left` or `right`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// The other arm.
    pub const fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

impl fmt::Display for Arm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One of the robot's seventeen joints (report section 5, figure 10, table 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are those of the report's figure 10")]
pub enum RobotJoint {
    LeftS0,
    LeftS1,
    LeftE0,
    LeftE1,
    LeftW0,
    LeftW1,
    LeftW2,
    RightS0,
    RightS1,
    RightE0,
    RightE1,
    RightW0,
    RightW1,
    RightW2,
    /// The neck: positive turns the view to the robot's left.
    HeadPan,
    /// Opening of the left gripper: the inner distance of its fingers in units.
    LeftGripper,
    /// Opening of the right gripper.
    RightGripper,
}

/// Joints of an arm.
pub const JOINTS_PER_ARM: usize = 7;

impl RobotJoint {
    /// All joints, in the order of [`index`](Self::index).
    pub const ALL: [Self; 17] = [
        Self::LeftS0,
        Self::LeftS1,
        Self::LeftE0,
        Self::LeftE1,
        Self::LeftW0,
        Self::LeftW1,
        Self::LeftW2,
        Self::RightS0,
        Self::RightS1,
        Self::RightE0,
        Self::RightE1,
        Self::RightW0,
        Self::RightW1,
        Self::RightW2,
        Self::HeadPan,
        Self::LeftGripper,
        Self::RightGripper,
    ];

    /// Its place in [`ALL`](Self::ALL).
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The joints of an arm from the shoulder to the wrist: S0, S1, E0, E1, W0, W1, W2.
    pub const fn of_arm(arm: Arm) -> [Self; JOINTS_PER_ARM] {
        let first = arm as usize * JOINTS_PER_ARM;
        let mut joints = [Self::LeftS0; JOINTS_PER_ARM];
        let mut i = 0;
        while i < JOINTS_PER_ARM {
            joints[i] = Self::ALL[first + i];
            i += 1;
        }
        joints
    }

    /// The gripper of an arm.
    pub const fn gripper(arm: Arm) -> Self {
        match arm {
            Arm::Left => Self::LeftGripper,
            Arm::Right => Self::RightGripper,
        }
    }

    /// The arm that it belongs to; `None` for the neck.
    pub const fn arm(self) -> Option<Arm> {
        match self.index() {
            0..7 | 15 => Some(Arm::Left),
            14 => None,
            _ => Some(Arm::Right),
        }
    }

    /// Whether it is the opening of a gripper, in units, and not an angle.
    pub const fn is_gripper(self) -> bool {
        matches!(self, Self::LeftGripper | Self::RightGripper)
    }

    /// Its name in a robot description: `left_s0`, `head_pan`; `left_gripper` for the opening.
    pub const fn name(self) -> &'static str {
        match self {
            Self::LeftS0 => "left_s0",
            Self::LeftS1 => "left_s1",
            Self::LeftE0 => "left_e0",
            Self::LeftE1 => "left_e1",
            Self::LeftW0 => "left_w0",
            Self::LeftW1 => "left_w1",
            Self::LeftW2 => "left_w2",
            Self::RightS0 => "right_s0",
            Self::RightS1 => "right_s1",
            Self::RightE0 => "right_e0",
            Self::RightE1 => "right_e1",
            Self::RightW0 => "right_w0",
            Self::RightW1 => "right_w1",
            Self::RightW2 => "right_w2",
            Self::HeadPan => "head_pan",
            Self::LeftGripper => "left_gripper",
            Self::RightGripper => "right_gripper",
        }
    }

    /// Least and largest value: table 1 of the report in radians, units for grippers.
    pub const fn limits(self) -> (f64, f64) {
        if self.is_gripper() {
            return (0.0, WIDEST_GRIP);
        }
        match self.index() % JOINTS_PER_ARM {
            _ if matches!(self, Self::HeadPan) => (-FRAC_PI_2, FRAC_PI_2),
            0 => (-1.7, 1.7),
            1 => (-2.147, 1.047),
            2 => (-3.054, 3.054),
            3 => (-0.05, 2.618),
            5 => (-FRAC_PI_2, 2.094),
            _ => (-3.059, 3.059),
        }
    }

    /// The value nearest to this one that is within the limits.
    pub const fn clamp(self, value: f64) -> f64 {
        let (least, largest) = self.limits();
        value.clamp(least, largest)
    }

    /// Where it stands when the program starts.
    pub const fn home(self) -> f64 {
        if self.is_gripper() {
            return WIDEST_GRIP;
        }
        if matches!(self, Self::HeadPan) {
            return 0.0;
        }
        let left = match self.index() % JOINTS_PER_ARM {
            0 => 0.25,
            2 => -1.527,
            3 => 2.618,
            4 => 1.529,
            5 => 1.5,
            _ => 0.0,
        };
        left * self.mirror()
    }

    /// 1, or -1 for the joints of the right arm that turn the other way when both arms move as mirror images: the sign of
    /// manual control.
    pub const fn mirror(self) -> f64 {
        match self {
            Self::RightS0 | Self::RightE0 | Self::RightW0 | Self::RightW2 => -1.0,
            Self::LeftS0
            | Self::LeftS1
            | Self::LeftE0
            | Self::LeftE1
            | Self::LeftW0
            | Self::LeftW1
            | Self::LeftW2
            | Self::RightS1
            | Self::RightE1
            | Self::RightW1
            | Self::HeadPan
            | Self::LeftGripper
            | Self::RightGripper => 1.0,
        }
    }
}

impl From<RobotJoint> for JointId {
    fn from(joint: RobotJoint) -> Self {
        Self(joint as u16)
    }
}

impl From<Arm> for LimbId {
    fn from(arm: Arm) -> Self {
        Self(arm as u8)
    }
}

impl fmt::Display for RobotJoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Largest inner distance of the fingers of a gripper, in units.
pub const WIDEST_GRIP: f64 = 2.0;

/// What a joint is told. Angles in rad, openings of grippers in units, times in s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Drive {
    /// Move at this speed for the present tick only.
    Velocity(f64),
    /// Be at this position now; in dynamic mode, get there as fast as the motor can.
    Position(f64),
    /// Go to this position at the speed of manual control, over as many ticks as it takes.
    Toward(f64),
    /// Apply this torque, in N m, for the present tick only. Dynamic mode.
    Torque(f64),
}

/// How the robot's joints move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum RobotMode {
    /// Exactly as told, without masses and forces.
    #[default]
    Kinematic,
    /// By motors with limited torque, which move the masses of the links and what they meet.
    Dynamic,
}

/// What the robot's screen shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Face {
    /// Calm, eyes open.
    #[default]
    Neutral,
    /// A smile.
    Happy,
    /// Wide eyes, a round mouth.
    Surprised,
    /// Eyes shut.
    Asleep,
    /// A black screen.
    Blank,
}

impl Face {
    /// The faces in the order of the key that changes them.
    pub const ALL: [Self; 5] = [
        Self::Neutral,
        Self::Happy,
        Self::Surprised,
        Self::Asleep,
        Self::Blank,
    ];

    /// The next one in the order, after the last one the first.
    #[must_use]
    pub fn next(self) -> Self {
        Self::ALL[(self as usize + 1) % Self::ALL.len()]
    }
}

/// What is known of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointState {
    /// Angle in rad, opening in units.
    pub position: f64,
    /// Change of [`position`](Self::position) in the last tick, per s.
    pub velocity: f64,
    /// Torque of its motor in N m; 0 in kinematic mode.
    pub torque: f64,
}

/// What is known of a limb.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LimbState {
    /// The end effector: a point midway between the fingers, its x along the opening, its -z where the fingers point.
    pub end_effector: Pose,
    /// Origins of the joints that are [tracked](LimbLayout::trackers), in the table's frame.
    pub joint_origins: Vec<Vec3>,
    /// The objects that the gripper holds, in the order in which it took them.
    pub holds: Vec<Entity>,
    /// What the arm is stopped by; `None` if nothing is in its way.
    pub blocked_by: Option<String>,
    /// Whether it is on its way to a position that it was told to go to.
    pub is_moving: bool,
}

/// A thing that a body of the robot touches.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotContact {
    /// The body: the link's name in the robot's description, or a finger (`left-gripper-right-finger`).
    pub body: String,
    /// The object, or the table.
    pub thing: Entity,
    /// Where on the thing's surface, in the table's frame: the centre of the pressure, the middle of the area that a finger
    /// holds, or, where neither presses nor holds, the nearest point.
    pub point: Vec3,
    /// How hard they pressed each other in the last tick, along the normals, in kg units/s; 0 for what the robot holds and
    /// for what only stops it.
    pub impulse: f32,
}

/// The state of the robot after the last tick. Only the robot's own plugin writes it.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Robot {
    /// Whether it stands at the table; hidden, it can neither be seen nor touched, but its camera works.
    pub is_shown: bool,
    /// How its joints move.
    pub mode: RobotMode,
    /// What its screen shows.
    pub face: Face,
    /// Its joints, by [`JointId`].
    pub joints: Vec<JointState>,
    /// Its limbs, by [`LimbId`].
    pub limbs: Vec<LimbState>,
    /// What its bodies touch: body by body, of each the table first, then the objects in the order of their creation.
    pub contacts: Vec<RobotContact>,
}

impl Default for Robot {
    /// [Baxter](RobotLayout::baxter).
    fn default() -> Self {
        Self::at_home(RobotLayout::baxter())
    }
}

impl Robot {
    /// A hidden robot with its joints where they are when the program starts.
    pub fn at_home(layout: &RobotLayout) -> Self {
        let joints = layout.joints.iter().map(|joint| JointState {
            position: joint.home,
            ..default()
        });
        Self {
            is_shown: false,
            mode: RobotMode::default(),
            face: Face::default(),
            joints: joints.collect(),
            limbs: vec![LimbState::default(); layout.limbs.len()],
            contacts: Vec::new(),
        }
    }

    /// What is known of a joint.
    pub fn joint(&self, joint: RobotJoint) -> &JointState {
        &self.joints[joint.index()]
    }

    /// What is known of an arm.
    pub fn arm(&self, arm: Arm) -> &LimbState {
        &self.limbs[arm as usize]
    }

    /// Angles of the joints of an arm, in rad.
    pub fn angles(&self, arm: Arm) -> [f64; JOINTS_PER_ARM] {
        RobotJoint::of_arm(arm).map(|joint| self.joint(joint).position)
    }

    /// What is known of a limb.
    pub fn limb(&self, limb: LimbId) -> &LimbState {
        &self.limbs[limb.index()]
    }

    /// Positions of these joints, in rad.
    pub fn positions_of(&self, joints: &[JointId]) -> Vec<f64> {
        let joints = joints.iter();
        joints
            .map(|joint| self.joints[joint.index()].position)
            .collect()
    }

    /// Puts the joints to these positions, reached in a tick.
    pub fn move_to(&mut self, positions: &[f64]) {
        for (joint, position) in self.joints.iter_mut().zip(positions) {
            joint.velocity = (position - joint.position) / f64::from(TICK_SECONDS);
            joint.position = *position;
        }
    }

    /// The arm whose gripper holds this object.
    pub fn holder_of(&self, object: Entity) -> Option<Arm> {
        Arm::BOTH
            .into_iter()
            .find(|&arm| self.arm(arm).holds.contains(&object))
    }
}

/// Marks an object that a gripper holds: it stays when the table is cleared.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gripped {
    /// The arm.
    pub by: Arm,
}

/// Where the torso's frame stands: x forward, y left, z up; in front of the table.
pub fn robot_base(table: &Table) -> Pose {
    Pose::from_degrees(
        Vec3::new(0.0, -(table.yspan / 2.0 + 3.0), 2.0),
        Vec3::new(0.0, 0.0, 90.0),
    )
}

/// Points that a script wants to see: transparent blue balls that nothing touches.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Markers(pub Vec<Vec3>);

impl Markers {
    /// Radius of a marker, in units.
    pub const RADIUS: f32 = 1.0;
    /// How much of what lies behind a marker is covered by it.
    pub const OPACITY: f32 = 0.5;

    /// Colour of a marker.
    pub const COLOR: crate::Rgb = crate::Rgb::new(0.0, 0.5, 0.5);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_stand_in_the_order_of_their_index_and_belong_to_their_arm() {
        for (i, joint) in RobotJoint::ALL.into_iter().enumerate() {
            assert_eq!(joint.index(), i);
            let arm = joint.arm().map(Arm::name);
            assert_eq!(
                arm,
                joint
                    .name()
                    .split_once('_')
                    .map(|(arm, _)| arm)
                    .filter(|arm| *arm != "head")
            );
        }
        assert_eq!(RobotJoint::of_arm(Arm::Right)[6], RobotJoint::RightW2);
    }

    #[test]
    fn home_is_within_the_limits_and_the_same_for_both_arms() {
        for joint in RobotJoint::ALL {
            assert_eq!(joint.clamp(joint.home()), joint.home(), "{joint}");
        }
        let [left, right] = Arm::BOTH.map(RobotJoint::of_arm);
        for (left, right) in left.into_iter().zip(right) {
            assert_eq!(left.home(), right.mirror() * right.home());
        }
    }
}
