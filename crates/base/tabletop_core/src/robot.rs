//! The robot: its joints, the commands to them, and its state.

mod baxter;
mod layout;
mod layout_file;
mod name;
mod obstacle;

pub use baxter::{Arm, JOINTS_PER_ARM, RobotJoint, WIDEST_GRIP};
pub use layout::{
    BaseLayout, CameraCarrier, CameraLayout, FingerLook, GripperKind, GripperLayout,
    HandCameraLayout, JointId, JointLayout, JointRole, LimbId, LimbLayout, LinkFrame, RobotLayout,
};
pub use layout_file::{LayoutError, LayoutFile, UrdfJoint};
pub use name::snake_case;
pub use name::{JointName, LimbName, NameError};
pub use obstacle::Obstacle;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_geometry::Pose;

use crate::TICK_SECONDS;

/// Speed of manual control, in rad/s, and units/s for what slides (report section 5.1).
pub const MANUAL_SPEED: f64 = 1.0;

/// Speed at which fingers close and open where nobody moves them by hand, in units/s of their opening.
pub const FINGER_SPEED: f64 = 2.0;

/// A command to a joint. Angles in rad, ways of joints that slide in m, openings of grippers in units, times in s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Drive {
    /// Move at this speed for the present tick only.
    Velocity(f64),
    /// Be at this position now. In dynamic mode, get there as fast as the motor can.
    Position(f64),
    /// Go to this position at the speed of manual control, over as many ticks as it takes.
    Toward(f64),
    /// Apply this torque, in N m (a force in N to a joint that slides), for the present tick only. Dynamic mode.
    Torque(f64),
}

/// A joint of a real robot as it was measured. Angles in rad, ways of joints that slide in m, openings of grippers in units, times in s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeasuredJoint {
    /// Its position.
    pub position: f64,
    /// Its velocity.
    pub velocity: f64,
    /// Its torque, in N m (a force in N of a joint that slides); 0 if it is not measured.
    #[serde(default)]
    pub torque: f64,
    /// Whether a gripper says that it holds something; `None` if it does not say, and for other joints.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grips: Option<bool>,
}

impl MeasuredJoint {
    /// True if its numbers are numbers.
    pub const fn is_finite(&self) -> bool {
        self.position.is_finite() && self.velocity.is_finite() && self.torque.is_finite()
    }
}

/// The mode in which the robot's joints move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Reflect)]
pub enum RobotMode {
    /// Exactly as commanded, without masses and forces.
    #[default]
    Kinematic,
    /// By motors with limited torque, which move the masses of the links and of the objects that these push.
    Dynamic,
}

/// A face on the robot's screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Reflect)]
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

/// The state of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
pub struct JointState {
    /// Angle in rad, opening in units.
    pub position: f64,
    /// Change of [`position`](Self::position) in the last tick, per s; of a [mirrored](Robot::is_mirror) joint, the measured one.
    pub velocity: f64,
    /// Torque of its motor in N m; 0 in kinematic mode; of a mirrored joint, the measured one.
    pub torque: f64,
}

/// The state of a limb.
#[derive(Clone, Debug, Default, PartialEq, Reflect)]
pub struct LimbState {
    /// The end effector: a point midway between the fingers, its x along the opening, its -z where the fingers point.
    pub end_effector: Pose,
    /// Origins of the [tracked](LimbLayout::trackers) joints, in the table's frame.
    pub joint_origins: Vec<Vec3>,
    /// The objects that the gripper holds, in the order in which it gripped them.
    pub holds: Vec<Entity>,
    /// Whether the gripper of a real robot that is [mirrored](Robot::is_mirror) says that it holds something.
    pub says_it_grips: Option<bool>,
    /// The obstacle that stops the arm; `None` if its way is free.
    pub blocked_by: Option<Obstacle>,
    /// True while it is on its way to a commanded position.
    pub is_moving: bool,
}

/// A contact of a body of the robot with a thing.
#[derive(Clone, Debug, PartialEq, Reflect)]
pub struct RobotContact {
    /// The body: the link's name in the robot's description, or a finger (`left-gripper-right-finger`).
    pub body: String,
    /// The object, or the table.
    pub thing: Entity,
    /// The contact's place on the thing's surface, in the table's frame: the centre of pressure; for a finger that holds, the middle of the
    /// held area; where nothing presses or holds, the nearest point.
    pub point: Vec3,
    /// Impulse of the last tick along the normals, in kg units/s; 0 for an object that the robot holds and
    /// for one that only stops it.
    pub impulse: f32,
}

/// The state of the robot after the last tick. Only the robot's own plugin writes it.
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[reflect(Resource)]
pub struct Robot {
    /// True if it stands at the table. A hidden robot can neither be seen nor touched, but its camera works.
    pub is_shown: bool,
    /// The mode in which its joints move.
    pub mode: RobotMode,
    /// True if it was a mirror in the last tick: its joints are where those of a real robot were [measured](crate::RobotCommand::Mirror). What a
    /// simulated robot alone has, such as contacts, is then nothing that the real one has.
    pub is_mirror: bool,
    /// The face on its screen.
    pub face: Face,
    /// Its joints, by [`JointId`].
    pub joints: Vec<JointState>,
    /// Its limbs, by [`LimbId`].
    pub limbs: Vec<LimbState>,
    /// The contacts of its bodies, body by body: for each the table first, then the objects in the order of their creation.
    pub contacts: Vec<RobotContact>,
}

impl Default for Robot {
    /// [Baxter](RobotLayout::baxter).
    fn default() -> Self {
        Self::at_home(RobotLayout::baxter())
    }
}

impl Robot {
    /// A hidden robot whose joints are at their home positions.
    pub fn at_home(layout: &RobotLayout) -> Self {
        let joints = layout.joints.iter().map(|joint| JointState {
            position: joint.home,
            ..default()
        });
        Self {
            is_shown: false,
            mode: RobotMode::default(),
            is_mirror: false,
            face: Face::default(),
            joints: joints.collect(),
            limbs: vec![LimbState::default(); layout.limbs.len()],
            contacts: Vec::new(),
        }
    }

    /// The state of a joint.
    pub fn joint(&self, joint: impl Into<JointId>) -> &JointState {
        &self.joints[joint.into().index()]
    }

    /// The state of a limb.
    pub fn limb(&self, limb: impl Into<LimbId>) -> &LimbState {
        &self.limbs[limb.into().index()]
    }

    /// Angles of the joints of an arm of Baxter, in rad.
    pub fn angles(&self, arm: Arm) -> [f64; JOINTS_PER_ARM] {
        RobotJoint::of_arm(arm).map(|joint| self.joint(joint).position)
    }

    /// Positions of these joints, in rad.
    pub fn positions_of(&self, joints: &[JointId]) -> Vec<f64> {
        let joints = joints.iter();
        joints
            .map(|joint| self.joints[joint.index()].position)
            .collect()
    }

    /// Puts the joints where those of a real robot were measured. Those that were not, stand still.
    pub fn mirror(&mut self, measured: &[Option<MeasuredJoint>]) {
        self.is_mirror = true;
        for (joint, measured) in self.joints.iter_mut().zip(measured) {
            let measured = measured.unwrap_or(MeasuredJoint {
                position: joint.position,
                ..default()
            });
            *joint = JointState {
                position: measured.position,
                velocity: measured.velocity,
                torque: measured.torque,
            };
        }
    }

    /// Forgets what only a real robot has: it is no mirror any more.
    pub fn end_mirror(&mut self) {
        self.is_mirror = false;
        for joint in &mut self.joints {
            joint.torque = 0.0;
        }
        for limb in &mut self.limbs {
            limb.says_it_grips = None;
        }
    }

    /// Puts the joints at these positions, as reached in one tick.
    pub fn move_to(&mut self, positions: &[f64]) {
        for (joint, position) in self.joints.iter_mut().zip(positions) {
            joint.velocity = (position - joint.position) / f64::from(TICK_SECONDS);
            joint.position = *position;
        }
    }
}

/// Points that a script shows: transparent blue balls that nothing touches.
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource)]
pub struct Markers(pub Vec<Vec3>);

impl Markers {
    /// Radius of a marker, in units.
    pub const RADIUS: f32 = 1.0;
    /// Opacity of a marker, from 0 to 1.
    pub const OPACITY: f32 = 0.5;

    /// Colour of a marker.
    pub const COLOR: tabletop_geometry::Rgb = tabletop_geometry::Rgb::new(0.0, 0.5, 0.5);
}
