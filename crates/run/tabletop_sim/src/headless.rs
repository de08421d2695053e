//! The simulator without a window.

use bevy::{
    app::{Plugins, TaskPoolOptions, TaskPoolPlugin},
    ecs::schedule::SingleThreadedExecutor,
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
        .edit_schedule(PreStartup, on_one_thread)
        .edit_schedule(Startup, on_one_thread)
        .edit_schedule(PostStartup, on_one_thread)
        .start();
    app
}

/// Bevy's threads may be those of the process that this one was forked from, so none is waited for.
fn on_one_thread(schedule: &mut Schedule) {
    schedule.set_executor(SingleThreadedExecutor::new());
}

/// The world of a [`headless_app_with`] these plugins, for [`step_world`](tabletop_core::step_world). It can be sent to another thread.
///
/// ```
/// use tabletop_core::{SimTick, step_world};
/// use tabletop_sim::{TabletopSimPlugins, headless_world};
///
/// let mut world = headless_world(TabletopSimPlugins);
/// let ticks = std::thread::spawn(move || {
///     step_world(&mut world, 60);
///     world.resource::<SimTick>().0
/// });
/// assert_eq!(ticks.join().unwrap(), 60);
/// ```
pub fn headless_world<M>(plugins: impl Plugins<M>) -> World {
    let mut app = headless_app_with(plugins);
    std::mem::take(app.world_mut())
}
