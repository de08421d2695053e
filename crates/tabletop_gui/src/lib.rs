//! Keys and panels of the window. Every key and button becomes a [`SimCommand`](tabletop_core::SimCommand); what came
//! of it is read from [`SimFact`](tabletop_core::SimFact)s.
//!
//! | key | what it does |
//! |---|---|
//! | Space | pause, resume |
//! | Esc | quit |
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

mod keys;
mod notices;
mod pause;

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
        .add_plugins((keys::plugin, notices::plugin, pause::plugin));
    }
}

fn draw_panels_over(camera: On<Add, UserCamera>, mut commands: Commands) {
    commands.entity(camera.entity).insert(PrimaryEguiContext);
}
