//! The simulated drive of the robot: its joints move as they are commanded, as far as nothing is in the way, push what is free and grip what
//! is between their fingers (report section 5).
//!
//! [`SimCommand`](tabletop_core::SimCommand)s control it, and [`Robot`](tabletop_core::Robot) is its state. In kinematic mode joints move
//! exactly as commanded; in dynamic mode motors with limited torque move the masses of the links
//! ([`RobotMode`](tabletop_core::RobotMode)). Another drive, such as a real robot's, takes the place of [`DrivePlugin`].
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_core::prelude::*;
//! use tabletop_drive::DrivePlugin;
//! use tabletop_physics::PhysicsPlugin;
//! use tabletop_robot::RobotPlugin;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), PhysicsPlugin::default()))
//!     .add_plugins((RobotPlugin::default(), DrivePlugin))
//!     .start();
//! let there = vec![(RobotJoint::RightE1.into(), Drive::Toward(1.5))];
//! app.world_mut().write_command(RobotCommand::Drive(there));
//! app.step(120);
//! let robot = app.world().resource::<Robot>();
//! assert_eq!(robot.joint(RobotJoint::RightE1).position, 1.5);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod command;
mod contacts;
mod dynamics;
mod gripper;
mod motion;
mod owner;
mod plugin;
mod self_collision;

pub use gripper::closing::STEEPEST_GRIP;
pub use plugin::DrivePlugin;
