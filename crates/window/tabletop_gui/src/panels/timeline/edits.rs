//! The buttons and keys that edit the open recording.

use std::ops::RangeInclusive;

use bevy::prelude::*;
use bevy_egui::egui::Ui;
use tabletop_user::{Action, EditOrder, KeySystems, TimelineEdit, was_struck};

use super::{model::Model, selected_segments::SelectedSegments, view::View};
use crate::widgets::button::button;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(
        RunFixedMainLoop,
        delete_selected
            .run_if(was_struck(Action::DeleteSegments))
            .in_set(KeySystems),
    );
}

fn delete_selected(view: Res<View>, mut orders: MessageWriter<EditOrder>) {
    let selected = view.selection.movable();
    orders.write_batch(selected.map(deletion));
}

fn deletion(segments: RangeInclusive<usize>) -> EditOrder {
    EditOrder::Edit(TimelineEdit::Delete(segments))
}

/// Shows the buttons of an open recording, and returns the user's orders.
pub(super) fn show(ui: &mut Ui, model: &Model, selection: &SelectedSegments) -> Vec<EditOrder> {
    let mut orders = Vec::new();
    if !model.is_open() {
        return orders;
    }
    ui.horizontal_wrapped(|ui| {
        orders.extend(moving(ui, model, selection));
        ui.separator();
        orders.extend(undoing(ui, model));
        match &model.editing.present {
            Some(present) => {
                ui.spinner();
                ui.label(format!("{present} …"));
            }
            None => {
                ui.weak(advice(selection));
            }
        }
    });
    orders
}

fn moving(ui: &mut Ui, model: &Model, selection: &SelectedSegments) -> Vec<EditOrder> {
    let selected = selection.movable();
    let swap = |is_later| {
        let neighbours = selection.neighbours(model.timeline, is_later)?;
        let edit = TimelineEdit::Swap(selection.movable()?, neighbours);
        Some(EditOrder::Edit(edit))
    };
    let delete = model.keymap.tooltip(Action::DeleteSegments);
    let earlier = "Lets the selected segments change places with those before them";
    let later = "Lets the selected segments change places with those after them";
    give(
        ui,
        model,
        [
            ("Earlier", earlier, swap(false)),
            ("Later", later, swap(true)),
            ("Delete", &delete, selected.map(deletion)),
        ],
    )
}

fn undoing(ui: &mut Ui, model: &Model) -> Vec<EditOrder> {
    let editing = model.editing;
    let undo = model.keymap.tooltip(Action::Undo);
    let redo = model.keymap.tooltip(Action::Redo);
    let save = "Saves the edited recording beside the original one";
    let undoable = (editing.undoable > 0).then_some(EditOrder::Undo);
    let redoable = (editing.redoable > 0).then_some(EditOrder::Redo);
    let unsaved = editing.is_unsaved.then_some(EditOrder::Save);
    give(
        ui,
        model,
        [
            ("Undo edit", &undo, undoable),
            ("Redo edit", &redo, redoable),
            ("Save edits", save, unsaved),
        ],
    )
}

/// Shows a button for each order, and returns the orders that are given. One that cannot be given, or not now, is grey.
fn give(
    ui: &mut Ui,
    model: &Model,
    orders: [(&str, &str, Option<EditOrder>); 3],
) -> Vec<EditOrder> {
    let is_free = model.editing.present.is_none();
    orders
        .into_iter()
        .filter_map(|(name, tooltip, order)| {
            let is_enabled = is_free && order.is_some();
            let button = button(ui, is_enabled, name, tooltip);
            order.filter(|_| button.clicked())
        })
        .collect()
}

fn advice(selection: &SelectedSegments) -> &'static str {
    match selection.segments() {
        None => "Click a segment to edit it",
        Some(_) => "Drag an end to retime",
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{SimTick, Timeline, TimelineSegment, TimelineStage};

    use super::*;
    use crate::test_world::TestWorld;

    #[test]
    fn a_key_deletes_the_selected_segments() {
        let segment = TimelineSegment {
            start: default(),
            act: None,
            color: None,
        };
        let timeline = Timeline {
            stage: TimelineStage::Open,
            segments: [0, 30]
                .map(|tick| TimelineSegment {
                    start: SimTick(tick),
                    ..segment.clone()
                })
                .into(),
            ..default()
        };
        for (number, expected) in [(0, None), (1, Some(deletion(1..=1)))] {
            let mut view = View::default();
            view.selection.choose(&timeline, number);
            let mut test = TestWorld::new(plugin);
            test.app.insert_resource(view);
            test.keys().press(KeyCode::Delete);
            test.hold_still();
            let mut orders = test.app.world_mut().resource_mut::<Messages<EditOrder>>();
            assert_eq!(orders.drain().next(), expected);
        }
    }
}
