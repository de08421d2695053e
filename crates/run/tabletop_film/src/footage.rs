//! A recording, seen by cameras that need not have been there.

use bevy::prelude::*;
use tabletop_camera::{CameraSpec, Shot, Studio};
use tabletop_core::{HandCameras, Paused, SimTick, StepApp as _};
use tabletop_recorder::{RecorderPlugin, UnrecordedPlugin};
use tabletop_replay::{Player, Replay};
use tabletop_sim::headless_app_with;

use crate::error::FilmError;

/// A recording, simulated again before cameras.
#[derive(Debug)]
pub struct Footage<'r> {
    replay: &'r Replay,
    cameras: Vec<CameraSpec>,
}

impl<'r> Footage<'r> {
    /// A recording before these cameras.
    pub const fn new(replay: &'r Replay, cameras: Vec<CameraSpec>) -> Self {
        Self { replay, cameras }
    }

    /// Shows each of these ticks, in ascending order, as it is at its end: a shot a camera.
    ///
    /// # Errors
    /// [`FilmError::Camera`], or an error of `each`.
    pub fn shoot<E: From<FilmError>>(
        &self,
        ticks: impl IntoIterator<Item = SimTick>,
        mut each: impl FnMut(SimTick, &[Shot]) -> Result<(), E>,
    ) -> Result<(), E> {
        let plugins = self.replay.plugins().disable::<RecorderPlugin>();
        let mut app = headless_app_with(plugins.add(UnrecordedPlugin));
        self.replay.play_in(&mut app);
        let known = app.world().resource::<HandCameras>().0.clone();
        let mut studio = Studio::new(self.cameras.clone(), &known).map_err(FilmError::from)?;
        for tick in ticks {
            advance(&mut app, tick);
            let shots = studio.shoot(app.world_mut()).map_err(FilmError::from)?;
            each(tick, shots)?;
        }
        Ok(())
    }
}

/// Simulates to the end of a tick, unless the recording ends in a pause before.
fn advance(app: &mut App, tick: SimTick) {
    let has_come = |world: &World| {
        let is_stuck = world.resource::<Player>().is_over() && world.resource::<Paused>().0;
        *world.resource::<SimTick>() > tick || is_stuck
    };
    while !has_come(app.world()) {
        app.step(1);
    }
}
