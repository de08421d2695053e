//! Keys and mouse of the window. Every act of the user becomes a [`SimCommand`](tabletop_core::SimCommand).
//!
//! The keys are in one table, [`Action`](tabletop_user::Action). A click on an object puts it into the selected hand, a drag moves it in the
//! drag plane, a press anywhere else lets it go. Right drags, middle drags and the wheel move the camera.

mod around;
mod axis_turn;
mod clear_view;
mod clipboard;
mod context_menu;
mod drag;
mod focus;
mod grip;
mod history_keys;
mod jog;
mod key_moves;
mod keys;
mod measure;
mod mechanism_keys;
mod mouse;
mod navigate;
mod object_keys;
mod operable;
mod pick;
mod plane;
mod pointer;
mod recording_keys;
mod regarded;
mod repeats;
mod robot_keys;
mod script_control;
mod snapshot;
#[cfg(test)]
mod test_world;
mod travel;
mod turns;
mod typing;
mod wheel;

pub use clipboard::Clipboard;
pub use context_menu::{ContextMenu, OpenMenu};
pub use focus::TakesKeys;
pub use grip::MouseGrip;
pub use jog::{Directions, Jog};
pub use operable::{Choice, Deed};
pub use plane::PlaneButtons;
pub use pointer::{Buttons, Pointer};
pub use regarded::{Regard, Regarded};
pub use script_control::toggled;
pub use turns::{MAX_DEGREES, TurnSums};
pub use typing::TypingPlugin;

use bevy::prelude::*;

/// Adds keys and mouse. Needs [`UserPlugin`](tabletop_user::UserPlugin) and [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct InputPlugin;

impl Plugin for InputPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((
            focus::plugin,
            keys::plugin,
            history_keys::plugin,
            pointer::plugin,
            mouse::plugin,
            plane::plugin,
            turns::plugin,
            object_keys::plugin,
            jog::plugin,
            robot_keys::plugin,
            script_control::plugin,
        ))
        .add_plugins((
            snapshot::plugin,
            navigate::plugin,
            mechanism_keys::plugin,
            key_moves::plugin,
            recording_keys::plugin,
            measure::plugin,
            clear_view::plugin,
            context_menu::plugin,
        ));
    }
}
