//! A recording, seen by cameras that need not have been there.

use bevy::prelude::*;
use tabletop_camera::{Camera, FiguresSeen, Rasterizer, Scene, VisibleWorld};
use tabletop_core::{
    HandCamera, HandCameras, HeadCamera, ObjectSpec, Paused, Picture, SimTick, StepApp as _, Table,
};
use tabletop_recorder::{RecorderPlugin, UnrecordedPlugin};
use tabletop_replay::{Player, Replay};
use tabletop_robot::HandCameraCarrier;
use tabletop_sim::headless_app_with;

use crate::{
    camera::{CameraPlace, FilmCamera},
    error::FilmError,
};

/// A recording, simulated again before cameras.
#[derive(Debug)]
pub struct Footage<'r> {
    replay: &'r Replay,
    cameras: Vec<FilmCamera>,
}

/// A picture of a camera, and what its numbers mean.
#[derive(Clone, Debug, Default)]
pub struct Shot {
    /// The picture. It has no pixels if the robot lacks the link that carries the camera.
    pub picture: Picture,
    /// The things behind the numbers in [`Picture::objects`], from 1.
    pub things: Vec<SeenThing>,
}

/// A thing in a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeenThing {
    /// The table.
    Table,
    /// The object of this id.
    Object(String),
    /// Part of the robot, or something else that is no object.
    Figure,
}

/// The cameras before a world, and their pictures.
#[derive(Debug, Default)]
struct Studio {
    cameras: Vec<FilmCamera>,
    /// For each camera, the hand camera that it is.
    hands: Vec<Option<HandCamera>>,
    rasterizers: Vec<Rasterizer>,
    scene: Scene,
    shown: Vec<Entity>,
    shots: Vec<Shot>,
}

impl<'r> Footage<'r> {
    /// A recording before these cameras.
    pub const fn new(replay: &'r Replay, cameras: Vec<FilmCamera>) -> Self {
        Self { replay, cameras }
    }

    /// Shows each of these ticks, in ascending order, as it is at its end: a shot a camera.
    ///
    /// # Errors
    /// [`FilmError::NoCamera`], or an error of `each`.
    pub fn shoot<E: From<FilmError>>(
        &self,
        ticks: impl IntoIterator<Item = SimTick>,
        mut each: impl FnMut(SimTick, &[Shot]) -> Result<(), E>,
    ) -> Result<(), E> {
        let plugins = self.replay.plugins().disable::<RecorderPlugin>();
        let mut app = headless_app_with(plugins.add(UnrecordedPlugin));
        self.replay.play_in(&mut app);
        let known = app.world().resource::<HandCameras>().0.clone();
        let mut studio = Studio::new(self.cameras.clone(), &known)?;
        for tick in ticks {
            advance(&mut app, tick);
            let drawn = app
                .world_mut()
                .run_system_cached_with(draw, &mut studio)
                .map_err(|error| FilmError::Failed(error.to_string()));
            drawn?;
            each(tick, &studio.shots)?;
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

impl Studio {
    fn new(cameras: Vec<FilmCamera>, known: &[HandCamera]) -> Result<Self, FilmError> {
        let hand_of = |camera: &FilmCamera| -> Result<Option<HandCamera>, FilmError> {
            match &camera.viewpoint {
                CameraPlace::Head | CameraPlace::Standing(_) => Ok(None),
                CameraPlace::Hand(name) => {
                    let is_it =
                        |it: &&HandCamera| it.name == *name || it.name == format!("{name}_camera");
                    let hand = known
                        .iter()
                        .find(is_it)
                        .ok_or_else(|| FilmError::NoCamera {
                            name: name.clone(),
                            known: known.iter().map(|hand| hand.name.clone()).collect(),
                        })?;
                    let [width, height] = camera.size.unwrap_or([hand.width, hand.height]);
                    Ok(Some(HandCamera {
                        width,
                        height,
                        vertical_fov: camera.vertical_fov.unwrap_or(hand.vertical_fov),
                        ..hand.clone()
                    }))
                }
            }
        };
        let hands: Result<Vec<_>, _> = cameras.iter().map(hand_of).collect();
        let count = cameras.len();
        Ok(Self {
            hands: hands?,
            rasterizers: std::iter::repeat_with(Rasterizer::default)
                .take(count)
                .collect(),
            shots: vec![Shot::default(); count],
            cameras,
            ..Self::default()
        })
    }
}

/// Draws the present world for each camera.
fn draw(
    InMut(studio): InMut<Studio>,
    world: VisibleWorld,
    head: Res<HeadCamera>,
    carrier: HandCameraCarrier,
    objects: Query<&ObjectSpec>,
    tables: Query<(), With<Table>>,
) {
    let thing = |&entity: &Entity| match objects.get(entity) {
        Ok(object) => SeenThing::Object(object.id.to_string()),
        Err(_) if tables.contains(entity) => SeenThing::Table,
        Err(_) => SeenThing::Figure,
    };
    let poses = |hand: &HandCamera| carrier.poses(std::slice::from_ref(hand)).pop()?;
    for (number, camera) in studio.cameras.iter().enumerate() {
        let hand = studio.hands[number].as_ref();
        let of_head = |mount| HeadCamera {
            vertical_fov: camera.vertical_fov.unwrap_or(head.vertical_fov),
            width: camera.size.map_or(head.width, |[width, _]| width),
            height: camera.size.map_or(head.height, |[_, height]| height),
            mount,
            ..*head
        };
        let view = match camera.viewpoint {
            CameraPlace::Head => Some(Camera::of_head(&of_head(head.mount), &world.table())),
            CameraPlace::Standing(pose) => {
                let usual = HeadCamera {
                    square_fov: false,
                    ..of_head(Some(pose))
                };
                Some(Camera::of_head(&usual, &world.table()))
            }
            CameraPlace::Hand(_) => {
                hand.and_then(|hand| Some(Camera::of_hand(hand, poses(hand)?, &head)))
            }
        };
        let seen = match camera.viewpoint {
            CameraPlace::Head => FiguresSeen::FromHead,
            CameraPlace::Hand(_) | CameraPlace::Standing(_) => FiguresSeen::FromElsewhere,
        };
        let shot = &mut studio.shots[number];
        let Some(view) = view else {
            shot.picture.resize(0, 0);
            continue;
        };
        world.draw(seen, &mut studio.scene, &mut studio.shown);
        studio.rasterizers[number].draw(&studio.scene, &view, &mut shot.picture);
        shot.things = studio.shown.iter().map(thing).collect();
    }
}
