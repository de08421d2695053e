//! Robots from URDF: the poses of their links, inverse kinematics of their arms, and the forces that their weight exerts on the
//! joints.
//!
//! Everything here is in URDF's units: **metres, radians, kilograms, seconds**, in the frame of the model's root link
//! (for Baxter: x forward, y left, z up), in `f64`. A unit of the simulator's table is 0.1 m.
//!
//! - [`RobotModel`]: links and joints, read from URDF and checked; [`RobotModel::frames`] and [`RobotModel::jacobian`] are its forward
//!   kinematics.
//! - [`ArmChain`]: the joints from a base to a tip; [`ArmChain::solve`] is its inverse kinematics.
//! - [`RobotModel::gravity_torques`], [`RobotModel::inverse_dynamics`], [`RobotModel::inertia_matrix`]: its dynamics.
//! - [`baxter()`] and [`baxter_smile()`]: the robot of the report, embedded.
//!
//! ```
//! use tabletop_kinematics::{ArmChain, Target, baxter};
//!
//! let robot = baxter()?;
//! let arm = ArmChain::between(&robot, "torso", "left_end_effector")?;
//! let start = [0.25, 0.0, -1.527, 2.618, 1.529, 1.5, 0.0];
//!
//! // 5 cm above the hand.
//! let mut hand = arm.tip(&start);
//! hand.translation.z += 0.05;
//! let angles = arm.solve(&Target::Pose(hand), &start)?;
//! assert!((arm.tip(&angles).translation - hand.translation).length() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

/// The types that most users of the crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{
        ArmChain, Frames, JointValues, LinkId, ModelJointId, RobotModel, Target, baxter,
    };
}

mod arm;
mod baxter;
mod dynamics;
mod error;
mod forward;
mod id;
mod inverse;
mod link;
mod model;
mod outline;
mod plain;
mod turn;
mod urdf;
mod values;

pub use arm::{ArmChain, DTwist, MOST_ARM_JOINTS};
pub use baxter::{baxter, baxter_smile};
pub use dynamics::{InertiaMatrix, Load};
pub use error::ModelError;
pub use forward::{Frames, MovingFrames};
pub use id::{LinkId, ModelJointId};
pub use inverse::{Miss, Target, Unreachable};
pub use link::{Geometry, Inertial, Link, LinkShape};
pub use model::{JointType, Mimic, ModelJoint, RobotModel};
pub use values::JointValues;
