//! Keys that copy, paste and delete objects.

use bevy::prelude::*;
use tabletop_core::{Actor, CommandWriter, ObjectEdit, Paused, SceneCommand};
use tabletop_user::{Action, Chosen, KeySystems, was_struck};

use super::{present_object::OnTable, selection::Selection};

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Selection>().add_systems(
        RunFixedMainLoop,
        (
            copy.run_if(was_struck(Action::CopyObjects)),
            paste.run_if(was_struck(Action::PasteObjects)),
            delete.run_if(was_struck(Action::DeleteObject)),
        )
            .chain()
            .run_if(Paused::is_running)
            .in_set(KeySystems),
    );
}

/// Keeps the chosen object, unless it is one of those that are selected in the panel: then these, as without a choice.
fn copy(chosen: Res<Chosen>, on_table: OnTable, mut selection: ResMut<Selection>) {
    let list = &mut selection.objects;
    match chosen.0.and_then(|object| on_table.present(object)) {
        Some(object) if !list.has(&object.spec.id) => list.copy(vec![object.spec]),
        Some(_) | None => list.copy_selected(&on_table.all()),
    }
}

fn paste(on_table: OnTable, selection: Res<Selection>, mut commands: CommandWriter) {
    let edits = selection.objects.pasted(&on_table.all());
    if !edits.is_empty() {
        commands.write(Actor::Key, SceneCommand::Edit(edits));
    }
}

/// Takes the chosen object from the table, with all that are selected in the panel if it is one of them.
fn delete(
    chosen: Res<Chosen>,
    on_table: OnTable,
    selection: Res<Selection>,
    mut commands: CommandWriter,
) {
    let Some(object) = chosen.0.and_then(|object| on_table.present(object)) else {
        return;
    };
    let id = object.spec.id;
    let edits = match selection.objects.has(&id) {
        true => selection.objects.removed(&on_table.all()),
        false => vec![ObjectEdit::Remove(id)],
    };
    if !edits.is_empty() {
        commands.write(Actor::Key, SceneCommand::Edit(edits));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::TestWorld;
    use KeyCode::{ControlLeft, Delete, KeyC, KeyV};
    use tabletop_core::SimCommand;

    fn strike(test: &mut TestWorld, keys: &[KeyCode]) -> Vec<ObjectEdit> {
        keys.iter().for_each(|&key| test.keys().press(key));
        let commands = test.hold_still();
        test.keys().release_all();
        test.hold_still();
        let edits = |command| {
            let SimCommand::Scene(SceneCommand::Edit(edits)) = command else {
                panic!("{command:?}");
            };
            edits
        };
        commands.into_iter().flat_map(edits).collect()
    }

    fn ids(edits: &[ObjectEdit]) -> Vec<&str> {
        let added = |edit: &ObjectEdit| matches!(edit, ObjectEdit::Add(_));
        assert!(edits.iter().all(added), "{edits:?}");
        edits
            .iter()
            .filter_map(|edit| match edit {
                ObjectEdit::Add(spec) => Some(&*spec.id),
                ObjectEdit::Change { .. } | ObjectEdit::Remove(_) => None,
            })
            .collect()
    }

    #[test]
    fn keys_copy_paste_and_delete_the_chosen_object() {
        let mut test = TestWorld::new(plugin);
        let red = test.block("red", Vec3::Z);
        assert_eq!(strike(&mut test, &[ControlLeft, KeyV]), []);
        assert_eq!(strike(&mut test, &[Delete]), []);
        test.app.insert_resource(Chosen(Some(red)));
        assert_eq!(strike(&mut test, &[ControlLeft, KeyC]), []);
        let pasted = strike(&mut test, &[ControlLeft, KeyV]);
        assert_eq!(ids(&pasted), ["red"]);
        let removed = [ObjectEdit::Remove("red".into())];
        assert_eq!(strike(&mut test, &[Delete]), removed);
    }

    #[test]
    fn a_chosen_object_is_deleted_and_copied_with_those_that_are_selected_with_it() {
        let mut test = TestWorld::new(plugin);
        let blue = test.block("blue", Vec3::new(5.0, 0.0, 1.0));
        test.block("red", Vec3::Z);
        test.app.insert_resource(Chosen(Some(blue)));
        let mut selection = test.app.world_mut().resource_mut::<Selection>();
        selection
            .objects
            .select_for_move(&["red", "blue"], [0.0; 3]);
        strike(&mut test, &[ControlLeft, KeyC]);
        assert_eq!(
            ids(&strike(&mut test, &[ControlLeft, KeyV])),
            ["blue", "red"]
        );
        let removed = ["blue", "red"].map(|id| ObjectEdit::Remove(id.into()));
        assert_eq!(strike(&mut test, &[Delete]), removed);
    }

    #[test]
    fn without_a_choice_what_is_selected_in_the_panel_is_copied() {
        let mut test = TestWorld::new(plugin);
        test.block("red", Vec3::Z);
        test.block("blue", Vec3::new(5.0, 0.0, 1.0));
        let mut selection = test.app.world_mut().resource_mut::<Selection>();
        let list = &mut selection.objects;
        list.select_for_move(&["red", "blue"], [0.0; 3]);
        strike(&mut test, &[ControlLeft, KeyC]);
        let pasted = strike(&mut test, &[ControlLeft, KeyV]);
        let mut ids = ids(&pasted);
        ids.sort_unstable();
        assert_eq!(ids, ["blue", "red"]);
    }
}
