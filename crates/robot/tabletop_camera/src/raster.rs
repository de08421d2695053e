//! Drawing of a picture, in bands of rows that several threads may draw at once.

mod backdrop;
mod band;
mod bounds;
mod coverage;
mod edge_table;
mod face;
mod kept;
mod layers;
mod lighting;
mod polyhedra;
mod projection;
mod quadric;
mod resolve;
mod samples;
mod span;
mod surface;
mod transparent;
mod triangle;
mod visible;

pub use layers::PictureLayers;

use bevy::tasks::ComputeTaskPool;
use tabletop_core::Picture;

use self::{
    backdrop::Backdrop,
    band::{Band, Frame},
    face::ROWS,
    kept::{KeptBand, KeptBands},
    lighting::Lighting,
    polyhedra::Polyhedra,
    resolve::Pixels,
    transparent::TransparentSpheres,
    visible::VisibleSurfaces,
};
use crate::{
    camera::{Camera, PinholeView},
    scene::Scene,
};

/// Number of rows of a thread's task: whole bands. The pictures do not depend on it.
const ROWS_IN_TASK: usize = 2 * ROWS;

/// Draws pictures, one after the other. It keeps its memory, so it allocates next to nothing after a picture of
/// the same size and a scene of the same length; it also keeps its results for the table and for figures that stay. Rows in which
/// nothing has changed since the last picture are not drawn again.
///
/// In an app, Bevy's compute threads help, unless it [draws alone](Self::alone).
#[derive(Clone, Debug, Default)]
pub struct Rasterizer {
    is_alone: bool,
    polyhedra: Polyhedra,
    visible: VisibleSurfaces,
    spheres: TransparentSpheres,
    backdrop: Backdrop,
    kept: KeptBands,
    bands: Vec<Band>,
}

impl Rasterizer {
    /// A rasterizer that draws on the thread of its caller alone: for worlds that keep all cores busy among themselves.
    pub fn alone() -> Self {
        Self {
            is_alone: true,
            ..Self::default()
        }
    }

    /// Draws the view of the camera. Of surfaces that are equally near, the first kind wins: cuboids come before
    /// cylinders and balls, these before figures, and polyhedra are last; within a kind, the first in the scene wins.
    pub fn draw(&mut self, scene: &Scene, camera: &Camera, picture: &mut Picture) {
        let view = PinholeView::of(camera);
        let lighting = Lighting::from(camera.light);
        if self.visible.lighting != lighting {
            // Nothing of the last picture looks the same.
            *self = Self {
                is_alone: self.is_alone,
                ..Self::default()
            };
            self.visible.lighting = lighting;
        }
        self.polyhedra.find(&scene.solids);
        self.visible.project(scene, self.polyhedra.figures(), &view);
        self.spheres.project(&scene.markers, &view, &lighting);
        picture.resize(camera.width, camera.height);
        if picture.depth.is_empty() {
            return;
        }
        let backdrop = self.visible.backdrop;
        let backdrop = backdrop.map(|face| &self.visible.faces[face as usize]);
        self.backdrop.prepare(backdrop, &view);
        let frame = &Frame {
            view: &view,
            visible: &self.visible,
            spheres: &self.spheres,
            backdrop: &self.backdrop,
            is_smooth: camera.antialiasing,
        };
        let width = camera.width as usize;
        self.kept.compare(scene, &self.visible, &view);
        if self.kept.is_whole() {
            self.kept.copy_to(picture);
            return;
        }
        let pixels = Pixels::of(picture);
        let draw = |band: &mut Band, first_row, pixels: Pixels, kept: &mut [KeptBand]| {
            let rows = (first_row..).step_by(ROWS);
            let parts = rows.zip(pixels.parts(ROWS * width));
            for ((first_row, pixels), kept) in parts.zip(kept) {
                kept.draw_into(pixels, |pixels| band.draw(frame, first_row, pixels));
            }
        };
        let mut kept: Vec<_> = self.kept.bands().collect();
        match ComputeTaskPool::try_get().filter(|_| !self.is_alone) {
            Some(threads) => {
                let first_rows = (0..camera.height).step_by(ROWS_IN_TASK);
                self.bands.resize_with(first_rows.len(), Band::default);
                let bands = self.bands.iter_mut().zip(first_rows);
                let parts = pixels.parts(ROWS_IN_TASK * width);
                let parts = parts.zip(kept.chunks_mut(ROWS_IN_TASK / ROWS));
                threads.scope(|tasks| {
                    for ((band, first_row), (part, kept)) in bands.zip(parts) {
                        tasks.spawn(async move { draw(band, first_row, part, kept) });
                    }
                });
            }
            None => {
                self.bands.resize_with(1, Band::default);
                draw(&mut self.bands[0], 0, pixels, &mut kept);
            }
        }
    }
}
