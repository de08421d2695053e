//! The context menu of an object: a click with the right button opens it, and the simulation stands still until it is closed.

use bevy::prelude::*;
use tabletop_core::{Actor, ClockCommand, CommandWriter, Paused};

use crate::{
    navigate::{self, Gesture},
    operable::{Choice, Operable},
    pointer::{Buttons, MouseSystems, Pointer},
};

/// The menu that is open.
#[derive(Resource, Clone, Debug, Default)]
pub struct ContextMenu(Option<OpenMenu>);

/// An open menu.
#[derive(Clone, Debug)]
pub struct OpenMenu {
    /// Location of the cursor, in pixels.
    pub at: Vec2,
    /// Id of the object.
    pub object: String,
    /// What can be done with it.
    pub choices: Vec<Choice>,
    /// The simulation stands still for it.
    is_still: bool,
}

impl OpenMenu {
    /// The menu of an object.
    pub const fn new(at: Vec2, object: String, choices: Vec<Choice>) -> Self {
        Self {
            at,
            object,
            choices,
            is_still: false,
        }
    }
}

impl ContextMenu {
    /// The menu, if one is open.
    pub const fn get(&self) -> Option<&OpenMenu> {
        self.0.as_ref()
    }

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
    app.init_resource::<ContextMenu>().add_systems(
        RunFixedMainLoop,
        (
            close_when_running,
            open.run_if(Paused::is_running).before(navigate::come_up),
        )
            .chain()
            .in_set(MouseSystems),
    );
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
    menu.0 = Some(OpenMenu::new(at, object.to_owned(), choices.into()));
    commands.write(Actor::Mouse, ClockCommand::SetPaused(true));
}
