//! A real robot beside the simulated one.
//!
//! With [`RealRobotPlugin`], the simulated robot is a [mirror](tabletop_core::RobotCommand::Mirror): it is where the real one was measured to be, whatever is in the way in the
//! simulation, so everything that looks at the simulated one, such as scripts, the recorder and the window, sees the real one. Its head camera shows what the real one has
//! sent, and nothing is drawn. A robot that is only followed ([`RealLink::Shadow`]) is sent nothing. One that is driven ([`RealLink::Driven`]) gets the orders that somebody who
//! [may](tabletop_core::IssuedCommand::may_drive) gives to the simulated robot's joints, watched over by `tabletop_bridge`. What was measured is no order.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod body_guard;
mod execution;
mod interface;
mod mirror;
mod orders;
mod pace;
mod robot;
mod sentinel;
mod sight;

use bevy::prelude::*;
use tabletop_core::{
    OrderSystems, Paused, PictureSystems, RestApp as _, RestingSystems, SensorImage, SimBlocked,
    TickSystems,
};

pub use body_guard::BodyGuard;
pub use execution::execute;
pub use interface::{find_interface, interface_of, shipped_body};
pub use robot::{RealLink, RealRobot, head_pictures};
pub use sentinel::sentinel_command;

/// Lets a [`RealRobot`] stand in for the simulated one. Insert that resource, too.
#[derive(Clone, Copy, Debug, Default)]
pub struct RealRobotPlugin {
    /// True if ticks wait for the wall clock, as without a window nobody else makes them.
    pub is_paced: bool,
}

impl Plugin for RealRobotPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            FixedUpdate,
            (
                |mut real: ResMut<RealRobot>| real.look_after(),
                Paused::will_be.pipe(orders::take_over),
                Paused::will_be
                    .pipe(mirror::follow)
                    .run_if(SimBlocked::is_clear),
            )
                .chain()
                .after(OrderSystems::Script)
                .before(TickSystems)
                .run_if(resource_exists::<RealRobot>)
                .in_set(RestingSystems),
        )
        // It moves by itself.
        .wake_while(resource_exists::<RealRobot>);
        app.init_resource::<SensorImage>().add_systems(
            FixedUpdate,
            sight::see
                .in_set(PictureSystems::Receive)
                .run_if(resource_exists::<RealRobot>)
                .in_set(RestingSystems),
        );
        if self.is_paced {
            app.init_resource::<pace::TickDue>()
                .add_systems(FixedFirst, pace::wait_for_wall_clock);
        }
    }
}
