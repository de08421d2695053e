//! The context menu of an object: a click with the right button opens it, and the simulation stands still until it is closed.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Ui},
};
use tabletop_core::{Actor, ClockCommand, CommandWriter, MechanismCommand, Paused};
use tabletop_user::Keymap;

use crate::{
    input::{
        navigate::{self, Gesture},
        operable::{Choice, Operable},
        pointer::{Buttons, MouseSystems, Pointer},
    },
    widgets::button::button,
};

/// Width of the menu in points.
const WIDTH: f32 = 150.0;

/// The menu that is open.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct ContextMenu(Option<OpenMenu>);

#[derive(Clone, Debug)]
struct OpenMenu {
    /// Location of the cursor, in pixels.
    at: Vec2,
    /// Id of the object.
    object: String,
    choices: Vec<Choice>,
    /// The simulation stands still for it.
    is_still: bool,
}

impl ContextMenu {
    /// Run condition: no menu is open.
    pub fn is_closed(menu: Res<Self>) -> bool {
        menu.0.is_none()
    }

    /// Closes the menu, and lets the simulation run on. Returns true if one was open.
    pub fn close(&mut self, commands: &mut CommandWriter) -> bool {
        let was_open = self.0.take().is_some();
        if was_open {
            commands.write(Actor::Mouse, ClockCommand::SetPaused(false));
        }
        was_open
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<ContextMenu>()
        .add_systems(
            RunFixedMainLoop,
            (
                close_when_running,
                open.run_if(Paused::is_running).before(navigate::come_up),
            )
                .chain()
                .in_set(MouseSystems),
        )
        .add_systems(EguiPrimaryContextPass, show_menu);
}

/// Closes the menu when the simulation runs on.
fn close_when_running(mut menu: ResMut<ContextMenu>, paused: Res<Paused>) {
    let Some(open) = &menu.0 else {
        return;
    };
    match (open.is_still, paused.0) {
        (true, false) => menu.0 = None,
        (false, true) => {
            if let Some(open) = &mut menu.0 {
                open.is_still = true;
            }
        }
        (true, true) | (false, false) => {}
    }
}

/// The right button comes up where it went down: the object there has its menu.
fn open(
    buttons: Res<Buttons>,
    gesture: Res<Gesture>,
    pointer: Res<Pointer>,
    operable: Operable,
    mut menu: ResMut<ContextMenu>,
    mut commands: CommandWriter,
) {
    let is_click = buttons.just_released(MouseButton::Right)
        && matches!(
            *gesture,
            Gesture::Press {
                button: MouseButton::Right,
                ..
            }
        );
    let (true, false, Some(at), Some(ray)) =
        (is_click, pointer.is_panels, pointer.cursor, pointer.ray)
    else {
        return;
    };
    let Some((object, choices)) = operable.choices_along(ray) else {
        return;
    };
    if choices.iter().all(|(_, command)| command.is_err()) {
        return;
    }
    menu.0 = Some(OpenMenu {
        at,
        object: object.to_owned(),
        choices: choices.into(),
        is_still: false,
    });
    commands.write(Actor::Mouse, ClockCommand::SetPaused(true));
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
    let (Some(open), Ok(context)) = (&menu.0, contexts.ctx_mut()) else {
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

    use super::*;
    use crate::input::operable::Deed;

    fn open_menu() -> OpenMenu {
        let hand = Hand::Any;
        let point_to = MechanismCommand::PointTo {
            hand,
            target: "red".into(),
        };
        let no = |why: &str| Err(why.to_owned());
        OpenMenu {
            at: Vec2::splat(50.0),
            object: "red".into(),
            choices: vec![
                (Deed::Trigger, no("it is no control")),
                (Deed::PointTo, Ok(point_to)),
                (Deed::Fasten, no("it has no point")),
                (Deed::Loosen, no("it has no point")),
                (Deed::Cut, no("it is not a pair of scissors")),
            ],
            is_still: true,
        }
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
