//! The robot: its joints, what they are told, and what is known of it.

mod baxter;
mod layout;
mod layout_file;
mod name;
mod obstacle;

pub use baxter::{Arm, JOINTS_PER_ARM, RobotJoint, WIDEST_GRIP};
pub use layout::{
    BaseLayout, CameraCarrier, CameraLayout, FingerLook, GripperKind, GripperLayout, JointId,
    JointLayout, JointRole, LimbId, LimbLayout, LinkFrame, RobotLayout,
};
pub use layout_file::{LayoutError, LayoutFile};
pub(crate) use name::snake_case;
pub use name::{JointName, LimbName};
pub use obstacle::Obstacle;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{Pose, TICK_SECONDS};

/// Speed of manual control, in rad/s, and units/s for grippers (report section 5.1).
pub const MANUAL_SPEED: f64 = 1.0;

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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Reflect)]
pub enum RobotMode {
    /// Exactly as told, without masses and forces.
    #[default]
    Kinematic,
    /// By motors with limited torque, which move the masses of the links and what they meet.
    Dynamic,
}

/// What the robot's screen shows.
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

/// What is known of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
pub struct JointState {
    /// Angle in rad, opening in units.
    pub position: f64,
    /// Change of [`position`](Self::position) in the last tick, per s.
    pub velocity: f64,
    /// Torque of its motor in N m; 0 in kinematic mode.
    pub torque: f64,
}

/// What is known of a limb.
#[derive(Clone, Debug, Default, PartialEq, Reflect)]
pub struct LimbState {
    /// The end effector: a point midway between the fingers, its x along the opening, its -z where the fingers point.
    pub end_effector: Pose,
    /// Origins of the joints that are [tracked](LimbLayout::trackers), in the table's frame.
    pub joint_origins: Vec<Vec3>,
    /// The objects that the gripper holds, in the order in which it took them.
    pub holds: Vec<Entity>,
    /// What the arm is stopped by; `None` if nothing is in its way.
    pub blocked_by: Option<Obstacle>,
    /// Whether it is on its way to a position that it was told to go to.
    pub is_moving: bool,
}

/// A thing that a body of the robot touches.
#[derive(Clone, Debug, PartialEq, Reflect)]
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
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[reflect(Resource)]
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
    pub fn joint(&self, joint: impl Into<JointId>) -> &JointState {
        &self.joints[joint.into().index()]
    }

    /// What is known of a limb.
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

    /// Puts the joints to these positions, reached in a tick.
    pub fn move_to(&mut self, positions: &[f64]) {
        for (joint, position) in self.joints.iter_mut().zip(positions) {
            joint.velocity = (position - joint.position) / f64::from(TICK_SECONDS);
            joint.position = *position;
        }
    }
}

/// Points that a script wants to see: transparent blue balls that nothing touches.
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource)]
pub struct Markers(pub Vec<Vec3>);

impl Markers {
    /// Radius of a marker, in units.
    pub const RADIUS: f32 = 1.0;
    /// How much of what lies behind a marker is covered by it.
    pub const OPACITY: f32 = 0.5;

    /// Colour of a marker.
    pub const COLOR: crate::Rgb = crate::Rgb::new(0.0, 0.5, 0.5);
}
