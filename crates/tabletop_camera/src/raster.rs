//! Drawing a picture, in bands of rows that several threads may draw at once.

mod band;
mod bounds;
mod coverage;
mod edge_table;
mod face;
mod quadric;
mod resolve;
mod samples;
mod span;
mod surface;
mod transparent;
mod triangle;
mod visible;

use bevy::tasks::ComputeTaskPool;
use tabletop_core::Picture;

use self::{
    band::{Band, Frame},
    face::ROWS,
    resolve::Pixels,
    transparent::TransparentSpheres,
    visible::VisibleSurfaces,
};
use crate::{
    camera::{Camera, View},
    scene::Scene,
};

/// Draws pictures, one after the other. It keeps its memory, so that it allocates next to nothing once it has drawn a picture of
/// the same size and a scene of the same length.
///
/// In an app, Bevy's compute threads help.
#[derive(Clone, Debug, Default)]
pub struct Rasterizer {
    visible: VisibleSurfaces,
    spheres: TransparentSpheres,
    bands: Vec<Band>,
}

impl Rasterizer {
    /// Draws what the camera sees. Of surfaces that are equally near, one of the first kind is seen (cuboids are before
    /// cylinders and balls, and these before figures), and of those the first in the scene.
    pub fn draw(&mut self, scene: &Scene, camera: &Camera, picture: &mut Picture) {
        let view = View::of(camera);
        self.visible.project(scene, &view);
        self.spheres.project(&scene.markers, &view);
        picture.resize(camera.width, camera.height);
        if picture.depth.is_empty() {
            return;
        }
        let frame = &Frame {
            view: &view,
            visible: &self.visible,
            spheres: &self.spheres,
            is_smooth: camera.antialiasing,
        };
        let first_rows = || (0..camera.height).step_by(ROWS);
        self.bands.resize_with(first_rows().len(), Band::default);
        let parts = Pixels::of(picture).parts(ROWS * camera.width as usize);
        let bands = self.bands.iter_mut().zip(first_rows()).zip(parts);
        match ComputeTaskPool::try_get() {
            Some(threads) => {
                threads.scope(|tasks| {
                    for ((band, first_row), part) in bands {
                        tasks.spawn(async move { band.draw(frame, first_row, part) });
                    }
                });
            }
            None => bands.for_each(|((band, first_row), part)| band.draw(frame, first_row, part)),
        }
    }
}
