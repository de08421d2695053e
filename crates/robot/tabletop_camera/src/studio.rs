//! Cameras before a world, and their pictures.

use std::cell::RefCell;

use bevy::prelude::*;
use tabletop_core::{HandCamera, HeadCamera, ObjectSpec, Picture, Table};
use tabletop_robot::HandCameraCarrier;

use thiserror::Error;

use crate::{
    Camera, FiguresSeen, Rasterizer, Scene, VisibleWorld,
    camera_spec::{CameraPlace, CameraSpec},
};

/// Why a camera has no picture.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum StudioError {
    /// The robot has no such hand camera.
    #[error("the robot has no camera {name}; expected head{}", .known.iter().map(|name| format!(", {name}")).collect::<String>())]
    NoCamera {
        /// Its name.
        name: String,
        /// The hand cameras that it has.
        known: Vec<String>,
    },
    /// The world is no simulator's.
    #[error("the pictures cannot be made: {0}")]
    Failed(String),
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
pub struct Studio {
    cameras: Vec<CameraSpec>,
    /// For each camera, the hand camera that it is.
    hands: Vec<Option<HandCamera>>,
    /// One for each camera; none if those of the thread draw.
    rasterizers: Vec<Rasterizer>,
    scene: Scene,
    shown: Vec<Entity>,
    shots: Vec<Shot>,
}

thread_local! {
    /// For each camera of a studio that draws alone, the memory of its pictures: too large for each of many worlds to have its own.
    static OF_THREAD: RefCell<Vec<Rasterizer>> = const { RefCell::new(Vec::new()) };
}

impl Studio {
    /// These cameras, of which those in the robot's hands are among the known ones.
    ///
    /// # Errors
    /// [`StudioError::NoCamera`]
    pub fn new(cameras: Vec<CameraSpec>, known: &[HandCamera]) -> Result<Self, StudioError> {
        let hand_of = |camera: &CameraSpec| -> Result<Option<HandCamera>, StudioError> {
            match &camera.viewpoint {
                CameraPlace::Head | CameraPlace::Standing(_) => Ok(None),
                CameraPlace::Hand(name) => {
                    let is_it =
                        |it: &&HandCamera| it.name == *name || it.name == format!("{name}_camera");
                    let hand = known
                        .iter()
                        .find(is_it)
                        .ok_or_else(|| StudioError::NoCamera {
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

    /// The same cameras, whose pictures are drawn on the thread of the caller alone.
    #[must_use]
    pub fn alone(mut self) -> Self {
        self.rasterizers = Vec::new();
        self
    }

    /// The present world before each camera.
    ///
    /// # Errors
    /// [`StudioError::Failed`] if the world is no simulator's.
    pub fn shoot(&mut self, world: &mut World) -> Result<&[Shot], StudioError> {
        let drawn = match self.rasterizers.is_empty() {
            true => OF_THREAD.with_borrow_mut(|rasterizers| {
                let count = rasterizers.len().max(self.cameras.len());
                rasterizers.resize_with(count, Rasterizer::alone);
                world.run_system_cached_with(draw, (&mut *self, rasterizers))
            }),
            false => {
                let mut own = std::mem::take(&mut self.rasterizers);
                let drawn = world.run_system_cached_with(draw, (&mut *self, &mut own));
                self.rasterizers = own;
                drawn
            }
        };
        drawn.map_err(|error| StudioError::Failed(error.to_string()))?;
        Ok(&self.shots)
    }
}

/// Draws the present world for each camera.
fn draw(
    (InMut(studio), InMut(rasterizers)): (InMut<Studio>, InMut<Vec<Rasterizer>>),
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
        rasterizers[number].draw(&studio.scene, &view, &mut shot.picture);
        shot.things = studio.shown.iter().map(thing).collect();
    }
}
