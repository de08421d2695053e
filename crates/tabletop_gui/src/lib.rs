//! Keys, mouse and panels of the window. Everything that the user does becomes a [`SimCommand`](tabletop_core::SimCommand); what came
//! of it is read from [`SimFact`](tabletop_core::SimFact)s.
//!
//! | key, mouse | what it does |
//! |---|---|
//! | Space | pause, resume |
//! | Esc | quit |
//! | click on an object | the selected hand takes it |
//! | drag what is held | moves it in the drag plane |
//! | press anywhere else | lets it go |
//! | `/`, Shift + `/` | turns the drag plane counter-clockwise, clockwise |
//! | left Ctrl | shows the plane at right angles while held |
//!
//! Panels are drawn over the picture of the [`UserCamera`].
//!
//! ```no_run
//! use bevy::prelude::*;
//! use tabletop_core::prelude::*;
//! use tabletop_gui::GuiPlugin;
//!
//! App::new()
//!     .add_plugins((DefaultPlugins, CorePlugin::default(), GuiPlugin))
//!     .run();
//! ```

mod bar;
mod demo_tools;
mod drag;
mod keys;
mod mouse;
mod notices;
mod pause;
mod pick;
mod plane;
mod pointer;
mod slider;
mod style;
#[cfg(test)]
mod test_world;
mod turns;

pub use bar::{Panel, Panels};
pub use notices::Notices;

use bevy::prelude::*;
use bevy_egui::{EguiGlobalSettings, EguiPlugin, PrimaryEguiContext};
use tabletop_core::UserCamera;

/// Adds keys and panels. Needs Bevy's renderer and [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct GuiPlugin;

impl Plugin for GuiPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(EguiGlobalSettings {
            auto_create_primary_context: false,
            ..default()
        })
        .add_plugins(EguiPlugin {
            // The few textures of the panels do not need it, and not every graphics driver has it.
            bindless_mode_array_size: None,
        })
        .add_observer(draw_panels_over)
        .add_plugins((
            style::plugin,
            keys::plugin,
            pointer::plugin,
            mouse::plugin,
            plane::plugin,
            turns::plugin,
            demo_tools::plugin,
            bar::plugin,
            notices::plugin,
            pause::plugin,
        ));
    }
}

fn draw_panels_over(camera: On<Add, UserCamera>, mut commands: Commands) {
    commands.entity(camera.entity).insert(PrimaryEguiContext);
}
