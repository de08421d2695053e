//! The app of tests.

use bevy::prelude::*;
use tabletop_core::{CorePlugin, StepApp as _};
use tabletop_physics::PhysicsPlugin;

use crate::ScenePlugin;

/// An app with physics and scenes, without a table.
pub(crate) fn test_app() -> App {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        CorePlugin::default(),
        PhysicsPlugin::default(),
        ScenePlugin,
    ))
    .start();
    app
}
