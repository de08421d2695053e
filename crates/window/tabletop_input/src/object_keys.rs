//! Keys that make objects and clear the table (report section 6.1).

use bevy::prelude::*;
use tabletop_core::{Actor, CommandWriter, Paused, Preset, SceneCommand};
use tabletop_user::{Action, KeySystems, PresetSeeds, was_struck};

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<PresetSeeds>().add_systems(
        RunFixedMainLoop,
        (
            make(Preset::BigBlock).run_if(was_struck(Action::MakeBlock)),
            make(Preset::Stack(5)).run_if(was_struck(Action::MakeStack)),
            clear_table.run_if(was_struck(Action::ClearTable)),
        )
            .chain()
            .in_set(KeySystems)
            .run_if(Paused::is_running),
    );
}

fn make(preset: Preset) -> impl FnMut(ResMut<PresetSeeds>, CommandWriter) {
    move |mut seeds, mut commands| {
        commands.write(Actor::Key, seeds.make(preset));
    }
}

fn clear_table(mut commands: CommandWriter) {
    commands.write(Actor::Key, SceneCommand::Clear);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::TestWorld;
    use KeyCode::{ControlLeft, KeyB, KeyC, KeyN};

    #[test]
    fn keys_make_presets_and_clear_the_table_once_a_press() {
        let mut seeds = PresetSeeds::default();
        let mut test = TestWorld::new(plugin);
        for (key, command) in [
            (KeyB, seeds.make(Preset::BigBlock)),
            (KeyN, seeds.make(Preset::Stack(5))),
            (KeyC, SceneCommand::Clear),
            (KeyN, seeds.make(Preset::Stack(5))),
        ] {
            test.keys().press(key);
            assert_eq!(test.hold_still(), [command.into()]);
            assert_eq!(test.hold_still(), []);
            test.keys().release(key);
        }
    }

    #[test]
    fn copying_or_a_pause_clears_nothing() {
        let mut test = TestWorld::new(plugin);
        test.keys().press(ControlLeft);
        test.keys().press(KeyC);
        assert_eq!(test.hold_still(), []);
        test.keys().release_all();
        test.app.insert_resource(Paused(true));
        test.keys().press(KeyC);
        assert_eq!(test.hold_still(), []);
    }
}
