//! The debug messages on the console: every command and every fact, with the tick in which it came.

use bevy::prelude::*;
use tabletop_core::{IssuedCommand, SimFact, SimTick};

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, write);
}

fn write(
    tick: Res<SimTick>,
    mut commands: MessageReader<IssuedCommand>,
    mut facts: MessageReader<SimFact>,
) {
    let tick = tick.0;
    for command in commands.read() {
        debug!(
            "tick {tick}: {:?} orders {:?}",
            command.actor, command.command
        );
    }
    for fact in facts.read() {
        debug!("tick {tick}: {fact:?}");
    }
}
