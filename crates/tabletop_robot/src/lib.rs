//! The robot: a Baxter, or another robot that a `robot.ron` describes, in the world of the tabletop simulator (report section 5).
//!
//! [`SimCommand`](tabletop_core::SimCommand)s control it, and [`Robot`](tabletop_core::Robot) is its state. It starts hidden: it can
//! then neither be seen nor touched, but its camera works.
//!
//! In kinematic mode its joints move exactly as commanded; in dynamic mode motors with limited torque move its masses
//! ([`RobotMode`](tabletop_core::RobotMode)).
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_robot::RobotPlugin;
//! use tabletop_core::prelude::*;
//! use tabletop_physics::PhysicsPlugin;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), PhysicsPlugin::default()))
//!     .add_plugins(RobotPlugin::default())
//!     .start();
//! let there = vec![(RobotJoint::RightE1.into(), Drive::Toward(1.5))];
//! app.world_mut().write_command(RobotCommand::Drive(there));
//! app.step(120);
//! let robot = app.world().resource::<Robot>();
//! assert_eq!(robot.joint(RobotJoint::RightE1).position, 1.5);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod articulation;
mod command;
mod contacts;
mod description;
mod dynamics;
mod gripper;
mod hand_cameras;
pub mod look;
mod motion;
mod owner;
mod plugin;
mod source;

pub use articulation::link_entities::RobotLink;
pub use description::{Description, DescriptionError};
pub use gripper::closing::STEEPEST_GRIP;
pub use plugin::RobotPlugin;
pub use source::DescriptionSource;

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{Description, RobotLink, RobotPlugin};
}
