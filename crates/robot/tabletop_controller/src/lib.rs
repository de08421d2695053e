//! The seam between the robot and whoever acts for it: a planner, a learned policy, a device in a person's hand.
//!
//! A [`Controller`] receives a [`Sight`] of the world once a tick and returns [`Drives`] for the robot's joints. Give one to
//! [`RobotController`], and [`ControllerPlugin`] lets it act until it is taken away:
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_controller::{Controller, ControllerPlugin, Drives, RobotController, Sight};
//! use tabletop_core::{Drive, RobotJoint, prelude::*};
//!
//! /// Turns the left arm's last joint.
//! struct Turning;
//!
//! impl Controller for Turning {
//!     fn act(&mut self, _: &Sight) -> Drives {
//!         vec![(RobotJoint::LeftW2.name(), Drive::Velocity(1.0))]
//!     }
//! }
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), ControllerPlugin));
//! app.insert_resource(RobotController::new(Turning));
//! app.start().step(1);
//! let commands = app.world().resource::<Messages<IssuedCommand>>();
//! assert_eq!(commands.len(), 1);
//! ```

mod controller;
mod observer;
mod sight;

pub use controller::{Controller, Drives, RobotController};
pub use observer::Observer;
pub use sight::{Angles, LimbSight, SeenObject, Sight, angles};

use bevy::prelude::*;
use tabletop_core::{OrderSystems, RestApp as _, RestingSystems};

/// Lets the [`RobotController`] act once a tick, in [`OrderSystems::Controller`], unless the simulation is paused.
#[derive(Clone, Copy, Debug, Default)]
pub struct ControllerPlugin;

impl Plugin for ControllerPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<RobotController>()
            .add_systems(
                FixedUpdate,
                controller::act
                    .run_if(RobotController::acts)
                    .in_set(OrderSystems::Controller)
                    .in_set(RestingSystems),
            )
            .wake_while(RobotController::acts);
    }
}
