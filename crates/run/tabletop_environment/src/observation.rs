//! Observations: the state of robot, objects and goal as numbers, and pictures.

use bevy::prelude::*;
use tabletop_core::{ObjectIndex, Robot, RobotLayout};
use tabletop_geometry::Twist;
use tabletop_scenario::Verdict;

/// Numbers of an object: location, rotation, velocity and angular velocity.
const OF_AN_OBJECT: usize = 13;

/// Numbers of a limb: location and rotation of its end effector, and whether it holds something.
const OF_A_LIMB: usize = 8;

/// Numbers of a check: the place that there is, and the one that should be.
const OF_A_CHECK: usize = 6;

/// What an environment observes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObservationSpace {
    /// The [state](StateLayout).
    State,
    /// A picture.
    Rgb,
    /// A picture with depth, and the robot's part of the state.
    Rgbd,
}

impl ObservationSpace {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::State, Self::Rgb, Self::Rgbd];

    /// Its name in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::State => "state",
            Self::Rgb => "rgb",
            Self::Rgbd => "rgbd",
        }
    }

    /// Whether it has a picture.
    pub const fn has_picture(self) -> bool {
        match self {
            Self::State => false,
            Self::Rgb | Self::Rgbd => true,
        }
    }
}

/// The order of the numbers of a state: the robot's, then those of each object of the task file, then those of each check.
///
/// The robot's are the positions of all joints (rad, openings in units), their velocities, and for each limb the location of its end effector,
/// its rotation as a quaternion x, y, z, w, and 1 if its gripper holds something. An object's are its location, rotation, velocity and angular
/// velocity; 0 once it is gone. A check's are the two places that it compares ([`Gap`](tabletop_scenario::Gap)). Lengths in units, times in s.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateLayout {
    /// Number of joints.
    pub joints: usize,
    /// Number of limbs.
    pub limbs: usize,
    /// Ids of the objects.
    pub objects: Vec<String>,
    /// Number of checks.
    pub checks: usize,
}

impl StateLayout {
    /// Number of the robot's numbers.
    pub const fn of_robot(&self) -> usize {
        2 * self.joints + OF_A_LIMB * self.limbs
    }

    /// Number of all numbers.
    pub const fn numbers(&self) -> usize {
        self.of_robot() + OF_AN_OBJECT * self.objects.len() + OF_A_CHECK * self.checks
    }

    /// The names of the numbers, in order.
    pub fn names(&self, layout: &RobotLayout) -> Vec<String> {
        let mut names = Vec::new();
        for what in ["position", "velocity"] {
            names.extend(
                layout
                    .joints
                    .iter()
                    .map(|joint| format!("{}.{what}", joint.name)),
            );
        }
        for limb in &layout.limbs {
            let parts = ["x", "y", "z", "qx", "qy", "qz", "qw"];
            let parts = parts.map(|part| format!("{}.end_effector.{part}", limb.name));
            names.extend(parts);
            names.push(format!("{}.holds", limb.name));
        }
        for object in &self.objects {
            let parts = [
                "x", "y", "z", "qx", "qy", "qz", "qw", "vx", "vy", "vz", "wx", "wy", "wz",
            ];
            names.extend(parts.map(|part| format!("{object}.{part}")));
        }
        for check in 0..self.checks {
            for what in ["achieved", "desired"] {
                names.extend(["x", "y", "z"].map(|part| format!("goal{check}.{what}.{part}")));
            }
        }
        names
    }

    /// Writes the state into a slice of as many numbers.
    pub(crate) fn write(&self, world: &World, verdicts: &[Verdict], state: &mut [f32]) {
        let robot = world.resource::<Robot>();
        let mut numbers = state.iter_mut();
        let mut put = |few: &[f32]| {
            for (&number, place) in few.iter().zip(numbers.by_ref()) {
                *place = number;
            }
        };
        for joint in &robot.joints {
            put(&[joint.position as f32]);
        }
        for joint in &robot.joints {
            put(&[joint.velocity as f32]);
        }
        for limb in &robot.limbs {
            put(&limb.end_effector.location.to_array());
            put(&limb.end_effector.rotation.to_array());
            put(&[f32::from(u8::from(!limb.holds.is_empty()))]);
        }
        let index = world.resource::<ObjectIndex>();
        for id in &self.objects {
            let object = index.get(id).and_then(|id| world.get_entity(id).ok());
            let Some((object, place)) = object.and_then(|it| Some((it, it.get::<Transform>()?)))
            else {
                put(&[0.0; OF_AN_OBJECT]);
                continue;
            };
            put(&place.translation.to_array());
            put(&place.rotation.to_array());
            let twist = object.get::<Twist>().copied().unwrap_or_default();
            put(&twist.linear.to_array());
            put(&twist.angular.to_array());
        }
        for verdict in verdicts {
            put(&verdict.gap.achieved.to_array());
            put(&verdict.gap.desired.to_array());
        }
    }
}
