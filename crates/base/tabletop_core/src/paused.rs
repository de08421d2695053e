//! The pause of the simulation.

use bevy::prelude::*;

use crate::{ClockCommand, IssuedCommand};

/// The pause: while it is true, time stands still. Commands are still carried out, so files can be loaded.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Paused(pub bool);

impl Paused {
    /// True if the tick that is beginning belongs to a pause, which may have just been asked for. For systems that give commands.
    pub fn will_be(
        mut commands: MessageReader<IssuedCommand>,
        mut asked_for: Local<Option<bool>>,
        paused: Res<Self>,
    ) -> bool {
        let commands = commands.read().filter_map(IssuedCommand::of_kind);
        let pauses = commands.map(|(_, command)| match command {
            ClockCommand::SetPaused(pause) => *pause,
        });
        // While the simulation is blocked, a request of an earlier frame is still to be carried out.
        *asked_for = pauses.last().or(*asked_for).filter(|ask| *ask != paused.0);
        asked_for.unwrap_or(paused.0)
    }

    /// Run condition: the simulation is running.
    pub fn is_running(paused: Res<Self>) -> bool {
        !paused.0
    }
}

/// Carries out the commands to the clock.
pub(crate) fn carry_out(mut commands: MessageReader<IssuedCommand>, mut paused: ResMut<Paused>) {
    for (_, command) in commands.read().filter_map(IssuedCommand::of_kind) {
        match command {
            ClockCommand::SetPaused(pause) => paused.0 = *pause,
        }
    }
}
