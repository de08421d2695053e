//! The sentence of the step that the robot does, over the picture of the table.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Align2, Area, Context, Frame, Id, Order, Rect, RichText, vec2},
};
use tabletop_user::{Action, ImitatedStep, Imitating, Keymap, TaskOrder};

use crate::{
    panels::{arrangement::Panels, window::free_desk},
    widgets::{button::button, style::ACCENT},
};

/// Size of the sentence, and how far it is above the lower edge of the desk, in points.
const SIZE: f32 = 18.0;
const ABOVE: f32 = 12.0;

/// The content of the caption.
struct Model<'a> {
    imitating: &'a Imitating,
    keymap: &'a Keymap,
    /// The part of the screen that is free at its lower edge.
    desk: Rect,
}

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, show_caption);
}

fn show_caption(
    mut contexts: EguiContexts,
    imitating: Res<Imitating>,
    keymap: Res<Keymap>,
    panels: Res<Panels>,
    mut orders: MessageWriter<TaskOrder>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let model = Model {
        imitating: &imitating,
        keymap: &keymap,
        desk: free_desk(context, &panels),
    };
    orders.write_batch(show(context, &model));
}

/// Shows the sentence while the robot is busy, and returns the user's order.
fn show(context: &Context, model: &Model) -> Option<TaskOrder> {
    let (sentence, remark) = texts(model.imitating)?;
    let stop = format!(
        "The robot stops where it is ({})",
        model.keymap.hint(Action::Imitate)
    );
    let below = context.viewport_rect().bottom() - model.desk.bottom();
    Area::new(Id::new("caption"))
        .order(Order::Middle)
        .anchor(Align2::CENTER_BOTTOM, vec2(0.0, -below - ABOVE))
        .interactable(true)
        .fade_in(false)
        .show(context, |ui| {
            Frame::window(ui.style())
                .show(ui, |ui| {
                    let row = ui.horizontal(|ui| {
                        ui.label(RichText::new(sentence).size(SIZE).strong());
                        if !remark.is_empty() {
                            ui.label(RichText::new(remark).color(ACCENT));
                        }
                        button(ui, true, "Stop the robot", &stop).clicked()
                    });
                    row.inner.then_some(TaskOrder::Stop)
                })
                .inner
        })
        .inner
}

/// The texts about the present step and its progress; `None` if the robot is not busy.
fn texts(imitating: &Imitating) -> Option<(String, &'static str)> {
    match imitating {
        Imitating::Idle => None,
        Imitating::Preparing => Some(("The robot gets ready.".into(), "")),
        Imitating::Step(ImitatedStep {
            number,
            of,
            sentence,
            tries,
            is_planning,
        }) => {
            let sentence = match of {
                Some(all) => format!("{number} of {all}: {sentence}"),
                None => format!("{number}: {sentence}"),
            };
            let remark = match (is_planning, tries) {
                (true, _) => "finding a way …",
                (false, 0) => "",
                (false, _) => "once more",
            };
            Some((sentence, remark))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::{Harness, kittest::Queryable as _};

    struct Stage {
        imitating: Imitating,
        keymap: Keymap,
        orders: Vec<TaskOrder>,
    }

    fn harness(imitating: Imitating) -> Harness<'static, Stage> {
        let stage = Stage {
            imitating,
            keymap: Keymap::default(),
            orders: Vec::new(),
        };
        let frame = |ui: &mut bevy_egui::egui::Ui, stage: &mut Stage| {
            let model = Model {
                imitating: &stage.imitating,
                keymap: &stage.keymap,
                desk: free_desk(ui.ctx(), &Panels::default()),
            };
            stage.orders.extend(show(ui.ctx(), &model));
        };
        let mut harness = Harness::new_ui_state(frame, stage);
        harness.run();
        harness
    }

    #[test]
    fn the_present_step_is_reported_and_how_it_gets_on() {
        let step = |tries, is_planning| {
            Imitating::Step(ImitatedStep {
                number: 2,
                of: Some(2),
                sentence: "Close the box.".into(),
                tries,
                is_planning,
            })
        };
        for (imitating, remark) in [
            (step(0, true), Some("finding a way …")),
            (step(0, false), None),
            (step(1, false), Some("once more")),
        ] {
            let harness = harness(imitating);
            assert!(harness.query_by_label("2 of 2: Close the box.").is_some());
            for text in ["finding a way …", "once more"] {
                let is_there = harness.query_by_label(text).is_some();
                assert_eq!(is_there, remark == Some(text), "{text}");
            }
        }
        assert!(
            harness(Imitating::Preparing)
                .query_by_label("The robot gets ready.")
                .is_some()
        );
    }

    #[test]
    fn a_step_of_a_program_has_a_number_alone() {
        let step = ImitatedStep {
            number: 3,
            sentence: "Put the red block into the box.".into(),
            ..default()
        };
        let harness = harness(Imitating::Step(step));
        let caption = harness.query_by_label("3: Put the red block into the box.");
        assert!(caption.is_some());
    }

    #[test]
    fn the_robot_is_stopped_and_nothing_is_reported_of_an_idle_one() {
        let mut harness = harness(Imitating::Preparing);
        harness.get_by_label("Stop the robot").click();
        harness.run();
        assert_eq!(harness.state().orders, [TaskOrder::Stop]);
        harness.state_mut().imitating = Imitating::Idle;
        harness.run();
        assert!(harness.query_by_label("Stop the robot").is_none());
    }
}
