//! The Demonstration Tools (report section 4, figure 8): hands, what is held, rotations, recording.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Color32, Ui},
};
use tabletop_core::{Hand, Hands, History, ObjectSpec, Recording, SimCommand, SimFact};

use crate::{
    input::plane::PlaneButtons,
    input::turns::Turns,
    panels::{Panel, Panels},
    widgets::slider::angle_slider,
};

/// The sliders have the colours of the axes, a little lighter, for a dark panel.
const SLIDERS: [(&str, Color32); 3] = [
    ("X", Color32::from_rgb(255, 70, 70)),
    ("Y", Color32::from_rgb(60, 220, 60)),
    ("Z", Color32::from_rgb(90, 130, 255)),
];

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, open_at_first_grasp)
        .add_systems(EguiPrimaryContextPass, show_panel);
}

fn open_at_first_grasp(
    mut is_done: Local<bool>,
    mut facts: MessageReader<SimFact>,
    mut panels: ResMut<Panels>,
) {
    let has_grasped = facts
        .read()
        .any(|fact| matches!(fact, SimFact::Grasped { .. }));
    if has_grasped && !*is_done {
        panels.set_open(Panel::DemonstrationTools, true);
        *is_done = true;
    }
}

/// What the panel shows and changes.
#[derive(SystemParam)]
struct Tools<'w, 's> {
    hands: Res<'w, Hands>,
    specs: Query<'w, 's, &'static ObjectSpec>,
    recording: Res<'w, Recording>,
    history: Res<'w, History>,
    turns: ResMut<'w, Turns>,
    plane_buttons: ResMut<'w, PlaneButtons>,
    commands: MessageWriter<'w, SimCommand>,
}

fn show_panel(mut contexts: EguiContexts, mut panels: ResMut<Panels>, mut tools: Tools) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let mut pressed = PlaneButtons::default();
    Panel::DemonstrationTools.show(context, &mut panels, |ui| {
        tools.hands(ui);
        ui.separator();
        let is_holding = tools.held().is_some();
        tools.held_object(ui, is_holding);
        ui.separator();
        ui.add_enabled_ui(is_holding, |ui| {
            pressed = plane_rotation(ui);
            ui.separator();
            tools.object_rotation(ui);
        });
        ui.separator();
        tools.recording(ui);
    });
    tools.plane_buttons.set_if_neq(pressed);
}

impl Tools<'_, '_> {
    /// Id of what the selected hand holds.
    fn held(&self) -> Option<&str> {
        let object = self.hands.held_by(self.hands.selected)?;
        Some(&self.specs.get(object).ok()?.id)
    }

    fn hands(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.label("Current Hand:");
            for hand in Hand::ALL {
                let is_selected = self.hands.selected == hand;
                if ui.radio(is_selected, format!("{hand:?}")).clicked() && !is_selected {
                    self.commands.write(SimCommand::SelectHand(hand));
                }
            }
        });
    }

    fn held_object(&mut self, ui: &mut Ui, is_holding: bool) {
        ui.horizontal(|ui| {
            ui.label("Current Object:");
            let id = self.held().unwrap_or("<empty>");
            ui.add(egui::Label::new(egui::RichText::new(id).strong()).truncate());
        });
        let hand = self.hands.selected;
        ui.add_enabled_ui(is_holding, |ui| {
            ui.horizontal(|ui| {
                self.command_button(ui, "Release", true, SimCommand::Release(hand));
                self.command_button(ui, "Destroy", true, SimCommand::Destroy(hand));
            });
        });
    }

    fn object_rotation(&mut self, ui: &mut Ui) {
        ui.label("Object Rotation:");
        let hand = self.hands.selected;
        for (axis, (name, color)) in SLIDERS.into_iter().enumerate() {
            let shown = self.turns.of(hand)[axis];
            let changed = angle_slider(ui, name, color, shown);
            if changed != shown {
                let turn = self.turns.turn_to(hand, axis, changed);
                self.commands.write_batch(turn);
            }
        }
    }

    fn recording(&mut self, ui: &mut Ui) {
        let is_recording = self.recording.0;
        let (can_undo, can_redo) = (self.history.undoable > 0, self.history.redoable > 0);
        ui.horizontal(|ui| {
            ui.label("Recording:");
            self.command_button(ui, "Start", !is_recording, SimCommand::StartRecording);
            self.command_button(ui, "Finish", is_recording, SimCommand::FinishRecording);
            self.command_button(ui, "Undo", can_undo, SimCommand::Undo);
            self.command_button(ui, "Redo", can_redo, SimCommand::Redo);
        });
    }

    fn command_button(&mut self, ui: &mut Ui, text: &str, is_enabled: bool, command: SimCommand) {
        if ui
            .add_enabled(is_enabled, egui::Button::new(text))
            .clicked()
        {
            self.commands.write(command);
        }
    }
}

/// The buttons that turn the plane while they are held down.
fn plane_rotation(ui: &mut Ui) -> PlaneButtons {
    ui.horizontal(|ui| {
        ui.label("Plane Rotation:");
        let mut is_down = |text| ui.button(text).is_pointer_button_down_on();
        PlaneButtons {
            counter_clockwise: is_down("CCW"),
            clockwise: is_down("CW"),
        }
    })
    .inner
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::CorePlugin;

    #[test]
    fn the_first_grasp_opens_the_panel_and_later_ones_leave_it_closed() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .init_resource::<Panels>()
            .add_systems(Update, open_at_first_grasp);
        for is_open in [true, false] {
            app.world_mut().write_message(SimFact::Grasped {
                hand: Hand::Any,
                id: "red".into(),
            });
            app.update();
            let mut panels = app.world_mut().resource_mut::<Panels>();
            assert_eq!(panels.is_open(Panel::DemonstrationTools), is_open);
            panels.set_open(Panel::DemonstrationTools, false);
        }
    }
}
