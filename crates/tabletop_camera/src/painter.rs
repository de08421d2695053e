//! Drawing a picture, in bands of rows that several threads may draw at once.

use bevy::tasks::ComputeTaskPool;
use tabletop_core::Picture;

use crate::{
    band::{Band, Pixels, Sight},
    camera::{Camera, View},
    glass::Glass,
    scene::Scene,
    seen::Seen,
};

/// So many rows are a band. The pictures are the same whatever it is.
const ROWS_IN_BAND: usize = 16;

/// Draws pictures, one after the other. It keeps its memory, so that it allocates next to nothing once it has drawn a picture of
/// the same size and a scene of the same length.
///
/// In an app, Bevy's compute threads help.
#[derive(Clone, Debug, Default)]
pub struct Painter {
    seen: Seen,
    glass: Glass,
    bands: Vec<Band>,
}

impl Painter {
    /// Draws what the camera sees. Of surfaces that are equally near, one of the first kind is seen (cuboids are before
    /// cylinders and balls, and these before figures), and of those the first in the scene.
    pub fn draw(&mut self, scene: &Scene, camera: &Camera, picture: &mut Picture) {
        let view = View::of(camera);
        self.seen.look_at(scene, &view);
        self.glass.look_at(&scene.markers, &view);
        picture.resize(camera.width, camera.height);
        if picture.depth.is_empty() {
            return;
        }
        let sight = &Sight {
            view: &view,
            seen: &self.seen,
            glass: &self.glass,
            is_smooth: camera.antialiasing,
        };
        let first_rows = || (0..camera.height).step_by(ROWS_IN_BAND);
        self.bands.resize_with(first_rows().len(), Band::default);
        let parts = Pixels::of(picture).parts(ROWS_IN_BAND * camera.width as usize);
        let bands = self.bands.iter_mut().zip(first_rows()).zip(parts);
        match ComputeTaskPool::try_get() {
            Some(threads) => {
                threads.scope(|tasks| {
                    for ((band, first_row), part) in bands {
                        tasks.spawn(async move { band.draw(sight, first_row, part) });
                    }
                });
            }
            None => bands.for_each(|((band, first_row), part)| band.draw(sight, first_row, part)),
        }
    }
}
