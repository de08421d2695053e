//! The simulator without a window.

use bevy::{
    app::{Plugins, TaskPoolOptions, TaskPoolPlugin},
    prelude::*,
};
use tabletop_core::StepApp as _;

use crate::plugins::TabletopSimPlugins;

/// A started simulator without window, ready to be [stepped](tabletop_core::StepApp::step). It runs on one thread; a
/// second one helps to draw pictures.
pub fn headless_app() -> App {
    headless_app_with(TabletopSimPlugins)
}

/// [`headless_app`] with these plugins in place of [`TabletopSimPlugins`].
pub fn headless_app_with<M>(plugins: impl Plugins<M>) -> App {
    let one_thread = TaskPoolPlugin {
        task_pool_options: TaskPoolOptions::with_num_threads(1),
    };
    let mut app = App::new();
    app.add_plugins((MinimalPlugins.set(one_thread), plugins))
        .start();
    app
}
