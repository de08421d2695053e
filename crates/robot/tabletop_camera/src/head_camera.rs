//! Taking the head camera's picture of a tick.

use bevy::prelude::*;
use tabletop_core::{HeadCamera, PictureDemand, SensorImage, SimTick};

use crate::{
    Camera, Rasterizer, Scene,
    visible_world::{FiguresSeen, VisibleWorld},
};

/// Memory kept from picture to picture.
#[derive(Resource, Debug, Default)]
pub(crate) struct HeadCameraRenderer {
    rasterizer: Rasterizer,
    scene: Scene,
}

/// Draws the present view of the head camera, if a picture was asked for.
pub(crate) fn render_head_camera(
    mut demand: ResMut<PictureDemand>,
    tick: Res<SimTick>,
    head: Res<HeadCamera>,
    world: VisibleWorld,
    mut renderer: ResMut<HeadCameraRenderer>,
    mut image: ResMut<SensorImage>,
) {
    if !demand.take() {
        return;
    }
    let HeadCameraRenderer { rasterizer, scene } = &mut *renderer;
    let SensorImage { picture, shown, .. } = &mut *image;
    world.draw(FiguresSeen::FromHead, scene, shown);
    let camera = Camera::of_head(&head, &world.table());
    rasterizer.draw(scene, &camera, picture);
    image.tick = *tick;
    image.received = None;
}
