//! The robot: a Baxter, or another robot with the same arms, in the world of the tabletop simulator (report section 5).
//!
//! It is told what to do by [`SimCommand`](tabletop_core::SimCommand)s and its state is in
//! [`Robot`](tabletop_core::Robot). It starts hidden: it can neither be seen nor touched then, but its camera works.
//!
//! In kinematic mode its joints move exactly as told; in dynamic mode motors with limited torque move its masses
//! ([`RobotMode`](tabletop_core::RobotMode)).
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_robot::BaxterPlugin;
//! use tabletop_core::prelude::*;
//! use tabletop_physics::PhysicsPlugin;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), PhysicsPlugin::default()))
//!     .add_plugins(BaxterPlugin::default())
//!     .start();
//! let there = vec![(RobotJoint::RightE1, Drive::Toward(1.5))];
//! app.world_mut().write_message(SimCommand::Drive(there));
//! app.step(120);
//! let robot = app.world().resource::<Robot>();
//! assert_eq!(robot.joint(RobotJoint::RightE1).position, 1.5);
//! ```

mod advance;
mod clearance;
mod contact;
mod driven;
mod dynamics;
mod feel;
mod figures;
mod grip;
mod grips;
pub mod look;
mod matrix;
mod meeting;
mod motion;
mod motor;
mod orders;
mod pad;
mod parts;
mod plugin;
mod reach;
mod shown;
mod skeleton;
mod surroundings;
mod touch;

pub use grip::STEEPEST_GRIP;
pub use orders::MANUAL_SPEED;
pub use parts::RobotBody;
pub use plugin::{BaxterPlugin, Description, Source};
