//! The picture that the head camera shows now.

use bevy::prelude::*;
use tabletop_camera::{Camera, DrawnFigure, FiguresSeen, Rasterizer, Scene, VisibleWorld};
use tabletop_core::{HeadCamera, Picture};
use tabletop_planner::PlanningStage;

/// What the head camera shows.
#[derive(Clone, Debug)]
pub struct HeadPicture {
    /// The camera, in the table's frame.
    pub camera: Camera,
    /// The colours that it sees. Depth and objects are left out: it does not see them.
    pub picture: Picture,
    /// The robot's own links, as they are in the picture.
    pub links: Vec<DrawnFigure>,
}

/// A stage whose robot sees with its head camera.
pub trait HeadCameraStage: PlanningStage {
    /// What the head camera shows now; `None` if the app has no camera.
    fn head_picture(&mut self) -> Option<HeadPicture>;
}

pub(super) fn head_picture(app: &mut App) -> Option<HeadPicture> {
    let world = app.world_mut();
    let look = world.run_system_cached(|head: Res<HeadCamera>, world: VisibleWorld| {
        let mut scene = Scene::default();
        world.draw(FiguresSeen::FromHead, &mut scene, &mut Vec::new());
        let camera = Camera::of_head(&head, &world.table());
        let mut picture = Picture::default();
        Rasterizer::default().draw(&scene, &camera, &mut picture);
        picture.depth.fill(0.0);
        picture.objects.fill(0);
        HeadPicture {
            camera,
            picture,
            links: scene.figures,
        }
    });
    look.ok()
}
