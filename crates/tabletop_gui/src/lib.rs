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
//! | right drag; middle, or Shift + right drag; wheel | the camera goes round, along, towards what is under the cursor |
//! | `/`, Shift + `/` | turns the drag plane counter-clockwise, clockwise |
//! | left Ctrl | shows the plane at right angles while held |
//! | R | shows, hides the robot |
//! | 1, 2 | shows, hides the head view; saves it as a file |
//! | `\` | the robot's next face |
//! | T Y U I O P `[` | joints W2, W1, W0, E1, E0, S1, S0 of the right arm |
//! | G H J K L `;` `'` | the same joints of the left arm |
//! | `]` | the head joint H0 |
//! | Shift + any of these joints | the other way |
//! | `=`, `-` | opens, closes the right gripper |
//! | 0, 9 | opens, closes the left gripper |
//! | M | starts, stops the script that drives the robot |
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

mod input;
mod panels;
mod picture;
pub mod preferences;
mod preset_seeds;
mod scale;
#[cfg(test)]
mod test_world;
mod widget_list;
mod widgets;

pub use panels::messages::{Notices, Tone};
pub use panels::{Panel, Panels};
pub use picture::Picture;
pub use preferences::Preferences;
pub use preset_seeds::PresetSeeds;
pub use widget_list::WidgetListPlugin;

use bevy::{asset::AssetEventSystems, prelude::*};
use bevy_egui::{EguiGlobalSettings, EguiPlugin, EguiPostUpdateSet, PrimaryEguiContext};
use tabletop_core::UserCamera;

/// Adds keys and panels. Needs Bevy's renderer and [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct GuiPlugin;

impl Plugin for GuiPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Preferences>()
            .init_resource::<PresetSeeds>()
            .insert_resource(EguiGlobalSettings {
                auto_create_primary_context: false,
                ..default()
            })
            .add_plugins(EguiPlugin {
                // The few textures of the panels do not need it, and not every graphics driver has it.
                bindless_mode_array_size: None,
            })
            // Else a texture that has changed, such as new letters, is seen a frame late, and what is new is not seen until then.
            .configure_sets(
                PostUpdate,
                EguiPostUpdateSet::PostProcessOutput.before(AssetEventSystems),
            )
            .add_observer(draw_panels_over)
            .add_plugins((
                widgets::style::plugin,
                input::focus::plugin,
                input::keys::plugin,
                input::pointer::plugin,
                input::mouse::plugin,
                input::plane::plugin,
                input::turns::plugin,
                panels::demo_tools::plugin,
                panels::memory::plugin,
                panels::bar::plugin,
                panels::messages::plugin,
                panels::toasts::plugin,
                panels::pause::plugin,
                scale::plugin,
            ))
            .add_plugins((
                picture::plugin,
                input::jog::plugin,
                input::robot_keys::plugin,
                panels::messages::robot::plugin,
                panels::robot::plugin,
                input::script_control::plugin,
                panels::status::plugin,
                panels::head_view::plugin,
                input::snapshot::plugin,
                input::navigate::plugin,
                panels::camera::plugin,
            ));
    }
}

fn draw_panels_over(camera: On<Add, UserCamera>, mut commands: Commands) {
    commands.entity(camera.entity).insert(PrimaryEguiContext);
}
