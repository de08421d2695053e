//! Demonstrations that are not recorded.

use bevy::prelude::*;
use tabletop_core::{Recording, SimCommand, SimFact, SimSystems, TickSystems};

use crate::recording::recorder::{IS_RUNNING, NONE_IS_RUNNING, refused};

/// Stands in for [`RecorderPlugin`](crate::RecorderPlugin) where nothing is to be written: what is done between
/// [`StartRecording`] and [`FinishRecording`] can be undone, and leaves no files.
/// Needs [`CorePlugin`](tabletop_core::CorePlugin).
///
/// [`StartRecording`]: SimCommand::StartRecording
/// [`FinishRecording`]: SimCommand::FinishRecording
#[derive(Clone, Copy, Debug, Default)]
pub struct UnrecordedPlugin;

impl Plugin for UnrecordedPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            FixedUpdate,
            (
                start.after(SimSystems::Load).before(SimSystems::Ingest),
                finish.after(SimSystems::Sense).before(SimSystems::Record),
            )
                .in_set(TickSystems),
        );
    }
}

fn start(
    mut recording: ResMut<Recording>,
    mut commands: MessageReader<SimCommand>,
    mut facts: MessageWriter<SimFact>,
) {
    for command in commands.read() {
        match command {
            SimCommand::StartRecording if recording.0 => {
                facts.write(refused(IS_RUNNING.into()));
            }
            SimCommand::StartRecording => recording.0 = true,
            SimCommand::FinishRecording if !recording.0 => {
                facts.write(refused(NONE_IS_RUNNING.into()));
            }
            _ => {}
        }
    }
}

fn finish(mut recording: ResMut<Recording>, mut commands: MessageReader<SimCommand>) {
    if commands
        .read()
        .any(|command| *command == SimCommand::FinishRecording)
    {
        recording.0 = false;
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{CorePlugin, StepApp as _};

    use super::*;

    #[test]
    fn it_starts_and_finishes_what_is_not_there_to_be_read() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UnrecordedPlugin))
            .start();
        let mut told = |command: SimCommand| {
            app.world_mut().write_message(command);
            app.step(1);
            let mut facts = app.world_mut().resource_mut::<Messages<SimFact>>();
            let refused = facts.drain().count() > 0;
            (app.world().resource::<Recording>().0, refused)
        };
        assert_eq!(told(SimCommand::FinishRecording), (false, true));
        assert_eq!(told(SimCommand::StartRecording), (true, false));
        assert_eq!(told(SimCommand::StartRecording), (true, true));
        assert_eq!(told(SimCommand::FinishRecording), (false, false));
    }
}
