//! The context menu of an object, as the user sees it.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Ui},
};
use tabletop_core::{Actor, CommandWriter, MechanismCommand};
use tabletop_input::{ContextMenu, OpenMenu};
use tabletop_user::Keymap;

use crate::widgets::button::button;

/// Width of the menu in points.
const WIDTH: f32 = 150.0;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, show_menu);
}

/// A request of the user to the menu.
#[derive(Clone, Debug, PartialEq)]
enum Request {
    Close,
    Do(MechanismCommand),
}

fn show_menu(
    mut contexts: EguiContexts,
    mut menu: ResMut<ContextMenu>,
    keymap: Res<Keymap>,
    mut commands: CommandWriter,
) {
    let (Some(open), Ok(context)) = (menu.get(), contexts.ctx_mut()) else {
        return;
    };
    let request = show(context, open, &keymap);
    if let Some(request) = request {
        menu.close(&mut commands);
        if let Request::Do(command) = request {
            commands.write(Actor::Mouse, command);
        }
    }
}

fn show(context: &egui::Context, open: &OpenMenu, keymap: &Keymap) -> Option<Request> {
    let at = egui::pos2(open.at.x, open.at.y) / context.zoom_factor();
    let area = egui::Area::new(egui::Id::new("context menu"))
        .order(egui::Order::Foreground)
        .constrain(true)
        .fixed_pos(at);
    let shown = area.show(context, |ui| {
        let frame = egui::Frame::menu(ui.style());
        frame.show(ui, |ui| items(ui, open, keymap)).inner
    });
    let is_elsewhere = |input: &egui::InputState| {
        let at = input.pointer.interact_pos();
        let is_outside = at.is_some_and(|at| !shown.response.rect.contains(at));
        input.pointer.any_pressed() && is_outside
    };
    let closed = context.input(is_elsewhere);
    shown.inner.or(closed.then_some(Request::Close))
}

fn items(ui: &mut Ui, open: &OpenMenu, keymap: &Keymap) -> Option<Request> {
    ui.set_width(WIDTH);
    ui.add(egui::Label::new(egui::RichText::new(&open.object).weak()).truncate());
    let column = egui::Layout::top_down_justified(egui::Align::LEFT);
    let items = |ui: &mut Ui| {
        let mut request = None;
        for (deed, command) in &open.choices {
            let action = deed.action();
            let tooltip = match command {
                Ok(_) => keymap.tooltip(action),
                Err(reason) => reason.clone(),
            };
            let label = keymap.label(action);
            if button(ui, command.is_ok(), label, &tooltip).clicked()
                && let Ok(command) = command
            {
                request = Some(Request::Do(command.clone()));
            }
        }
        request
    };
    ui.with_layout(column, items).inner
}

#[cfg(test)]
mod tests {
    use egui_kittest::{Harness, kittest::Queryable as _};
    use tabletop_core::Hand;

    use tabletop_input::Deed;

    use super::*;

    fn open_menu() -> OpenMenu {
        let hand = Hand::Any;
        let point_to = MechanismCommand::PointTo {
            hand,
            target: "red".into(),
        };
        let no = |why: &str| Err(why.to_owned());
        let choices = vec![
            (Deed::Trigger, no("it is no control")),
            (Deed::PointTo, Ok(point_to)),
            (Deed::Fasten, no("it has no point")),
            (Deed::Loosen, no("it has no point")),
            (Deed::Cut, no("it is not a pair of scissors")),
        ];
        OpenMenu::new(Vec2::splat(50.0), "red".into(), choices)
    }

    /// The request of a click on an item of the menu.
    fn clicked(label: &str) -> Option<Request> {
        let frame = |ui: &mut Ui, asked: &mut Option<Request>| {
            let request = show(ui.ctx(), &open_menu(), &Keymap::default());
            *asked = asked.take().or(request);
        };
        let mut harness = Harness::new_ui_state(frame, None);
        harness.run();
        harness.get_by_label(label).click();
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn an_item_asks_for_its_command_and_a_grey_one_for_nothing() {
        let point_to = open_menu().choices[1].1.clone().ok().map(Request::Do);
        assert_eq!(clicked("Point to"), point_to);
        for label in ["Trigger", "Fasten", "Loosen", "Cut"] {
            assert_eq!(clicked(label), None, "{label}");
        }
    }
}
