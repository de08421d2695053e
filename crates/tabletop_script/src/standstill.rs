//! While the simulation waits for the script, frames go by without ticks.

use std::time::Duration;

use bevy::{
    ecs::message::{MessageRegistry, ShouldUpdateMessages},
    prelude::*,
};
use tabletop_core::Standstill;

/// After a standstill, time goes on, so that a tick is tried again.
pub(crate) fn resume_time(standstill: Res<Standstill>, mut time: ResMut<Time<Virtual>>) {
    if standstill.0 {
        time.unpause();
    }
}

/// At a standstill, the time that is left of this frame passes without ticks, and no more comes.
pub(crate) fn drop_overstep(
    standstill: Res<Standstill>,
    mut fixed: ResMut<Time<Fixed>>,
    mut time: ResMut<Time<Virtual>>,
) {
    if standstill.0 {
        fixed.discard_overstep(Duration::MAX);
        time.pause();
    }
}

/// At a standstill no tick reads messages, so none may be dropped.
pub(crate) fn keep_messages(
    standstill: Res<Standstill>,
    registry: Option<ResMut<MessageRegistry>>,
) {
    let registry = registry.filter(|registry| {
        standstill.0 && matches!(registry.should_update, ShouldUpdateMessages::Ready)
    });
    if let Some(mut registry) = registry {
        registry.should_update = ShouldUpdateMessages::Waiting;
    }
}
