//! Demonstrations that are not recorded.

use bevy::prelude::*;
use tabletop_core::{
    CommandSystems, IssuedCommand, Recording, RecordingCommand, RestingSystems, SimFact,
    SimSystems, TickSystems,
};

use crate::recording::recorder::{IS_RUNNING, NONE_IS_RUNNING, refused};

/// Stands in for [`RecorderPlugin`](crate::RecorderPlugin) where nothing is to be written: commands between
/// [`Start`] and [`Finish`] can be undone, and leave no files.
/// Needs [`CorePlugin`](tabletop_core::CorePlugin).
///
/// [`Start`]: RecordingCommand::Start
/// [`Finish`]: RecordingCommand::Finish
#[derive(Clone, Copy, Debug, Default)]
pub struct UnrecordedPlugin;

impl Plugin for UnrecordedPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            FixedUpdate,
            (
                start.in_set(CommandSystems::Recording),
                finish
                    .after(SimSystems::Sense)
                    .before(SimSystems::Record)
                    .in_set(TickSystems),
            )
                .in_set(RestingSystems),
        );
    }
}

fn start(
    mut recording: ResMut<Recording>,
    mut commands: MessageReader<IssuedCommand>,
    mut facts: MessageWriter<SimFact>,
) {
    for (cause, command) in commands.read().filter_map(IssuedCommand::of_kind) {
        match command {
            RecordingCommand::Start if recording.0 => {
                facts.write(refused(cause, IS_RUNNING));
            }
            RecordingCommand::Start => recording.0 = true,
            RecordingCommand::Finish if !recording.0 => {
                facts.write(refused(cause, NONE_IS_RUNNING));
            }
            RecordingCommand::Finish => {}
        }
    }
}

fn finish(mut recording: ResMut<Recording>, mut commands: MessageReader<IssuedCommand>) {
    for (_, command) in commands.read().filter_map(IssuedCommand::of_kind) {
        match command {
            RecordingCommand::Start => {}
            RecordingCommand::Finish => recording.0 = false,
        }
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{CorePlugin, StepApp as _, WriteCommand as _};

    use super::*;

    #[test]
    fn a_recording_without_files_starts_and_finishes() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UnrecordedPlugin))
            .start();
        let mut give = |command: RecordingCommand| {
            app.world_mut().write_command(command);
            app.step(1);
            let mut facts = app.world_mut().resource_mut::<Messages<SimFact>>();
            let refused = facts.drain().count() > 0;
            (app.world().resource::<Recording>().0, refused)
        };
        assert_eq!(give(RecordingCommand::Finish), (false, true));
        assert_eq!(give(RecordingCommand::Start), (true, false));
        assert_eq!(give(RecordingCommand::Start), (true, true));
        assert_eq!(give(RecordingCommand::Finish), (false, false));
    }
}
