//! Taking the hand cameras' pictures of a tick.

use bevy::prelude::*;
use tabletop_core::{HandImages, HeadCamera, Picture, SimTick};

use crate::{
    Camera, Rasterizer, Scene,
    visible_world::{FiguresSeen, VisibleWorld},
};

/// Memory kept from picture to picture.
#[derive(Resource, Debug, Default)]
pub(crate) struct HandCameraRenderer {
    /// One for each camera.
    rasterizers: Vec<Rasterizer>,
    scene: Scene,
}

/// Draws the present views of the hand cameras that were asked for pictures, in the light of the head camera.
pub(crate) fn render_hand_cameras(
    tick: Res<SimTick>,
    head: Res<HeadCamera>,
    world: VisibleWorld,
    mut renderer: ResMut<HandCameraRenderer>,
    mut images: ResMut<HandImages>,
) {
    let Some(cameras) = images.take() else {
        return;
    };
    let HandCameraRenderer { rasterizers, scene } = &mut *renderer;
    let HandImages {
        poses,
        pictures,
        shown,
        ..
    } = &mut *images;
    world.draw(FiguresSeen::FromElsewhere, scene, shown);
    rasterizers.resize_with(cameras.len(), Rasterizer::default);
    pictures.resize_with(cameras.len(), Picture::default);
    for (i, (camera, picture)) in cameras.iter().zip(pictures).enumerate() {
        let Some(pose) = poses.get(i).copied().flatten() else {
            picture.resize(0, 0);
            continue;
        };
        let camera = Camera::of_hand(camera, pose, &head);
        rasterizers[i].draw(scene, &camera, picture);
    }
    images.tick = *tick;
}
