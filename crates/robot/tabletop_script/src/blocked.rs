//! While the simulation waits for the script, frames go by without ticks, and each tries the one that is due.
//!
//! The time that passes until then is not made up for.

use std::time::Duration;

use bevy::{
    ecs::message::{MessageRegistry, ShouldUpdateMessages},
    prelude::*,
};

/// The frame has no tick but the one that is being tried.
pub(crate) fn drop_overstep(mut time: ResMut<Time<Fixed>>) {
    time.discard_overstep(Duration::MAX);
}

/// The tick that could not begin is due again in the next frame.
pub(crate) fn try_again(mut time: ResMut<Time<Fixed>>) {
    let tick = time.timestep();
    time.accumulate_overstep(tick);
}

/// No tick has read messages, so none may be dropped.
pub(crate) fn keep_messages(registry: Option<ResMut<MessageRegistry>>) {
    let registry =
        registry.filter(|registry| matches!(registry.should_update, ShouldUpdateMessages::Ready));
    if let Some(mut registry) = registry {
        registry.should_update = ShouldUpdateMessages::Waiting;
    }
}
