//! The app of tests.

use bevy::{app::Plugins, prelude::*, time::TimeUpdateStrategy};
use tabletop_core::CorePlugin;
use tabletop_user::UserPlugin;

use crate::surface::Surface;

/// An app that makes a tick in each frame, with the assets that plugins draw with, after its first frame.
pub(crate) fn test_app<M>(plugins: impl Plugins<M>) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .init_resource::<Assets<Mesh>>()
        .init_resource::<Assets<Surface>>()
        .add_plugins(plugins);
    app.finish();
    app.cleanup();
    app.update();
    app
}
