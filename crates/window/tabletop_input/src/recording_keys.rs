//! The key that begins a recording and ends it.

use bevy::prelude::*;
use tabletop_core::{Actor, CommandWriter, Recording, RecordingCommand};
use tabletop_user::{Action, KeySystems, was_struck};

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Recording>().add_systems(
        RunFixedMainLoop,
        record.run_if(was_struck(Action::Record)).in_set(KeySystems),
    );
}

fn record(recording: Res<Recording>, mut commands: CommandWriter) {
    commands.write(Actor::Key, begin_or_end(*recording));
}

/// What a key does that begins recordings and ends them.
pub(crate) const fn begin_or_end(recording: Recording) -> RecordingCommand {
    match recording.0 {
        true => RecordingCommand::Finish,
        false => RecordingCommand::Start,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::TestWorld;
    use KeyCode::{ControlLeft, KeyR};

    #[test]
    fn a_key_begins_a_recording_and_ends_it() {
        let mut test = TestWorld::new(plugin);
        for (is_recording, command) in [
            (false, RecordingCommand::Start),
            (true, RecordingCommand::Finish),
        ] {
            test.app.insert_resource(Recording(is_recording));
            for key in [ControlLeft, KeyR] {
                test.keys().press(key);
            }
            assert_eq!(test.hold_still(), [command.into()]);
            assert_eq!(test.hold_still(), []);
            test.keys().release_all();
        }
    }
}
