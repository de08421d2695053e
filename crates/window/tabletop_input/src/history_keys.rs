//! Keys that undo and redo: segments of a recording that is made (report section 4.1), changes outside of one, edits of an open one.

use bevy::prelude::*;
use tabletop_core::{Actor, CommandWriter, History, HistoryCommand};
use tabletop_user::{Action, EditOrder, Editing, KeySystems, was_struck};

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(
        RunFixedMainLoop,
        (
            undo.run_if(was_struck(Action::Undo)),
            redo.run_if(was_struck(Action::Redo)),
        )
            .in_set(KeySystems),
    );
}

fn undo(
    history: Res<History>,
    editing: Res<Editing>,
    mut commands: CommandWriter,
    mut edits: MessageWriter<EditOrder>,
) {
    if history.undoable == 0 && editing.undoable > 0 {
        edits.write(EditOrder::Undo);
    } else {
        // If there is nothing, the refusal says so.
        commands.write(Actor::Key, HistoryCommand::Undo);
    }
}

fn redo(
    history: Res<History>,
    editing: Res<Editing>,
    mut commands: CommandWriter,
    mut edits: MessageWriter<EditOrder>,
) {
    if history.redoable == 0 && editing.redoable > 0 {
        edits.write(EditOrder::Redo);
    } else {
        commands.write(Actor::Key, HistoryCommand::Redo);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::TestWorld;
    use KeyCode::{ControlLeft, KeyY, KeyZ, ShiftRight};
    use tabletop_core::SimCommand;

    #[test]
    fn keys_undo_and_redo_once_a_press() {
        for (keys, command) in [
            (
                &[ControlLeft, KeyZ][..],
                SimCommand::History(HistoryCommand::Undo),
            ),
            (
                &[ControlLeft, ShiftRight, KeyZ],
                SimCommand::History(HistoryCommand::Redo),
            ),
            (
                &[ControlLeft, KeyY],
                SimCommand::History(HistoryCommand::Redo),
            ),
        ] {
            let mut test = TestWorld::new(plugin);
            // If there is nothing to undo, the refusal says so.
            keys.iter().for_each(|&key| test.keys().press(key));
            assert_eq!(test.hold_still(), [command]);
            assert_eq!(test.hold_still(), []);
        }
    }

    #[test]
    fn keys_undo_and_redo_edits_of_an_open_recording() {
        for (keys, order) in [
            (&[ControlLeft, KeyZ][..], EditOrder::Undo),
            (&[ControlLeft, KeyY], EditOrder::Redo),
        ] {
            let mut test = TestWorld::new(plugin);
            test.app.insert_resource(Editing {
                undoable: 1,
                redoable: 1,
                ..default()
            });
            keys.iter().for_each(|&key| test.keys().press(key));
            assert_eq!(test.hold_still(), []);
            let mut orders = test.app.world_mut().resource_mut::<Messages<EditOrder>>();
            assert_eq!(orders.drain().collect::<Vec<_>>(), [order]);
        }
    }
}
