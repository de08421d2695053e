//! A real robot beside the simulated one.
//!
//! With [`RealRobotPlugin`], the simulated robot is where the real one was measured to be, so everything that looks at the simulated one, such as scripts, the recorder and the
//! window, sees the real one. A robot that is only followed ([`RealLink::Shadow`]) is sent nothing. One that is driven ([`RealLink::Driven`]) gets every order that
//! anybody gives to the simulated robot's joints, watched over by `tabletop_bridge`.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod body_guard;
mod mirror;
mod orders;
mod pace;
mod robot;
mod sight;

use bevy::prelude::*;
use tabletop_core::{
    OrderSystems, PictureSystems, RestApp as _, RestingSystems, SensorImage, SimSystems,
    TickSystems,
};

pub use body_guard::BodyGuard;
pub use robot::{RealLink, RealRobot, head_pictures};

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
            (orders::take_over, mirror::follow)
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
                .after(PictureSystems)
                .before(SimSystems::Record)
                .run_if(resource_exists::<RealRobot>)
                .in_set(RestingSystems),
        );
        if self.is_paced {
            app.init_resource::<pace::TickDue>()
                .add_systems(FixedFirst, pace::wait_for_wall_clock);
        }
    }
}
