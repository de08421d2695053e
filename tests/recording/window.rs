//! A window without a picture.

use std::path::PathBuf;

use bevy::{app::PluginGroupBuilder, prelude::*, time::TimeUpdateStrategy};
use tabletop::{
    core::{HeadCamera, TICK_SECONDS},
    prelude::*,
    recorder::RecorderPlugin,
};

use crate::demonstration::fresh_folder;

/// A window without a picture: every frame has a tick, unless the simulation waits.
pub struct Window {
    pub app: App,
    /// The folder of its recording.
    pub folder: PathBuf,
}

impl Window {
    /// A window that records into a folder of this name, with its plugins changed like this.
    pub fn open(name: &str, change: impl FnOnce(PluginGroupBuilder) -> PluginGroupBuilder) -> Self {
        let folder = fresh_folder(name);
        let recorder = RecorderPlugin {
            folder: folder.clone(),
            ..default()
        };
        let plugins = TabletopSimPlugins.build().set(recorder);
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, change(plugins)))
            .insert_resource(HeadCamera {
                width: 40,
                height: 30,
                ..default()
            })
            .insert_resource(TimeUpdateStrategy::ManualDuration(
                std::time::Duration::from_secs_f32(TICK_SECONDS),
            ));
        app.finish();
        app.cleanup();
        Self { app, folder }
    }

    pub fn give(&mut self, command: impl Into<SimCommand>) {
        self.app.world_mut().write_command(command);
    }

    pub fn write<M: Message>(&mut self, message: M) {
        self.app.world_mut().write_message(message);
    }

    pub fn frames(&mut self, frames: usize) {
        (0..frames).for_each(|_| self.app.update());
    }

    /// Lets frames pass until this condition holds.
    pub fn frames_until(&mut self, is_so: impl Fn(&World) -> bool) {
        for _ in 0..10_000 {
            if is_so(self.app.world()) {
                return;
            }
            self.app.update();
        }
        panic!("it never comes");
    }

    pub fn next_tick(&self) -> u64 {
        self.app.world().resource::<SimTick>().0
    }
}
