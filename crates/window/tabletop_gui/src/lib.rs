//! Panels of the window, beside its keys and mouse. Every act of the user becomes a [`SimCommand`](tabletop_core::SimCommand); the results
//! are read from [`SimFact`](tabletop_core::SimFact)s. Users bind keys in [`keymap_file`]s.
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

pub mod display;
mod files;
mod kept;
pub mod keymap_file;
mod panels;
mod picture;
mod pictures;
pub mod preferences;
mod scale;
mod takes;
#[cfg(test)]
#[path = "../../tabletop_input/src/test_world.rs"]
#[expect(dead_code, reason = "these tests need a part of it")]
mod test_world;
mod theme;
mod widget_list;
mod widgets;

pub use files::{FileRequest, Files, TaskFile};
pub use panels::help::Help;
pub use panels::hints::Unattended;
pub use panels::status::Renderer;
pub use panels::{Browser, Panel, Panels, Purpose};
pub use picture::PictureStatus;
pub use preferences::Preferences;
pub use widget_list::WidgetListPlugin;

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{Files, GuiPlugin, Panel, Panels, Preferences};
}

use bevy::{asset::AssetEventSystems, prelude::*};
use bevy_egui::{
    EguiGlobalSettings, EguiInputSystemSettings, EguiPlugin, EguiPostUpdateSet, PrimaryEguiContext,
};
#[cfg(test)]
use tabletop_input::{Buttons, Pointer};
use tabletop_input::{InputPlugin, TypingPlugin};
use tabletop_user::{UserCamera, UserPlugin};

/// Adds keys and panels. Needs Bevy's renderer and [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct GuiPlugin;

impl Plugin for GuiPlugin {
    fn build(&self, app: &mut App) {
        UserPlugin::add_to(app);
        app.init_resource::<Preferences>()
            .insert_resource(EguiGlobalSettings {
                auto_create_primary_context: false,
                input_system_settings: EguiInputSystemSettings {
                    // `TypingPlugin` does it.
                    run_write_keyboard_input_messages_system: false,
                    ..default()
                },
                ..default()
            })
            .add_plugins(EguiPlugin {
                // The few textures of the panels do not need it, and not every graphics driver has it.
                bindless_mode_array_size: None,
            })
            // Otherwise a texture that has changed, such as new letters, is seen a frame late, and new ones are not seen until then.
            .configure_sets(
                PostUpdate,
                EguiPostUpdateSet::PostProcessOutput.before(AssetEventSystems),
            )
            .add_plugins(TypingPlugin)
            .add_observer(draw_panels_over);
        add_parts(app);
    }
}

/// All that does not need a renderer.
fn add_parts(app: &mut App) {
    app.add_plugins((
        InputPlugin,
        theme::plugin,
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
        keymap_file::plugin,
        panels::help::plugin,
        panels::messages::robot::plugin,
        panels::robot::plugin,
        panels::status::plugin,
        panels::head_view::plugin,
        panels::timeline::plugin,
        panels::camera::plugin,
    ))
    .add_plugins((
        panels::display::plugin,
        files::plugin,
        panels::objects::plugin,
        panels::browser::plugin,
        panels::quit::plugin,
        panels::window_keys::plugin,
        panels::context_menu::plugin,
        panels::caption::plugin,
        panels::hints::plugin,
    ))
    .add_plugins((
        panels::name_tag::plugin,
        panels::pose::plugin,
        panels::recording_mark::plugin,
        panels::plots::plugin,
        panels::recordings::plugin,
        takes::plugin,
    ));
}

fn draw_panels_over(camera: On<Add, UserCamera>, mut commands: Commands) {
    commands.entity(camera.entity).insert(PrimaryEguiContext);
}

#[cfg(test)]
mod tests {
    use bevy::{
        app::RunFixedMainLoop,
        ecs::schedule::{InternedScheduleLabel, ScheduleLabel as _},
    };
    use bevy_egui::EguiPrimaryContextPass;
    use tabletop_core::CorePlugin;

    use super::*;

    #[test]
    fn no_system_asks_for_the_same_thing_twice() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .init_resource::<Preferences>();
        add_parts(&mut app);
        let schedules: [InternedScheduleLabel; 7] = [
            Startup.intern(),
            PreUpdate.intern(),
            Update.intern(),
            PostUpdate.intern(),
            RunFixedMainLoop.intern(),
            FixedUpdate.intern(),
            EguiPrimaryContextPass.intern(),
        ];
        for label in schedules {
            let world = app.world_mut();
            // Bevy panics where a system's parameters exclude each other.
            let built = world.schedule_scope(label, |world, schedule| schedule.initialize(world));
            assert!(built.is_ok(), "{label:?}");
        }
    }
}
