//! Drawing a picture, row by row.

use bevy::math::Vec3;
use tabletop_core::Picture;

use crate::{
    camera::{Camera, View},
    glass::Glass,
    row::{Offset, SampleRow},
    scene::Scene,
    seen::{InRow, Seen},
    surface::bytes,
};

/// Draws pictures, one after the other. It keeps its memory, so that it allocates nothing once it has drawn a picture of the
/// same size and a scene of the same length.
#[derive(Clone, Debug, Default)]
pub struct Painter {
    seen: Seen,
    glass: Glass,
    in_row: InRow,
    centers: [SampleRow; 1],
    smooth: [SampleRow; 4],
}

impl Painter {
    /// Draws what the camera sees. Of surfaces that are equally near, one of the first kind is seen (cuboids are before
    /// cylinders and balls, and these before figures), and of those the first in the scene.
    pub fn draw(&mut self, scene: &Scene, camera: &Camera, picture: &mut Picture) {
        let view = View::of(camera);
        self.seen.look_at(scene, &view);
        self.glass.look_at(&scene.markers, &view);
        picture.resize(camera.width, camera.height);
        for row in 0..camera.height {
            self.seen.find_in_row(row, &mut self.in_row);
            self.draw_row(&view, row, picture);
            if camera.antialiasing {
                self.smooth_row(&view, row, picture);
            }
            self.blend_row(&view, row, camera.antialiasing, picture);
        }
    }

    /// Draws a row as it is seen through the centres of its pixels.
    fn draw_row(&mut self, view: &View, row: u32, picture: &mut Picture) {
        let Self {
            seen,
            in_row,
            centers,
            ..
        } = self;
        let offset = Offset::CENTER;
        centers[0].clear(view.width);
        seen.sample(in_row, row, offset, &mut centers[0]);
        seen.sample_figures(in_row, row, [offset], centers);
        let [centers] = centers;
        let mut start = row as usize * view.width as usize;
        let row_of_depths = &mut picture.depth[start..start + view.width as usize];
        for (depth, nearness) in row_of_depths.iter_mut().zip(&centers.nearness) {
            *depth = 1.0 / nearness;
        }
        let mut column = 0;
        for run in centers.surface.chunk_by(|one, next| one == next) {
            let end = start + run.len();
            let surface = &seen.surfaces[run[0] as usize];
            picture.objects[start..end].fill(surface.object);
            let (depths, rgb) = (
                &picture.depth[start..end],
                &mut picture.rgb[3 * start..3 * end],
            );
            surface.paint(view, row, column, depths, rgb);
            column += run.len();
            start = end;
        }
    }

    /// Mixes the colours of those pixels of a row in which more than one surface is seen.
    fn smooth_row(&mut self, view: &View, row: u32, picture: &mut Picture) {
        for (offset, samples) in Offset::SMOOTH.into_iter().zip(&mut self.smooth) {
            samples.clear(view.width);
            self.seen.sample(&self.in_row, row, offset, samples);
        }
        self.seen
            .sample_figures(&self.in_row, row, Offset::SMOOTH, &mut self.smooth);
        let first = row as usize * view.width as usize;
        let pixels = picture.rgb[3 * first..].chunks_exact_mut(3);
        let [a, b, c, d] = self.smooth.each_ref().map(|samples| samples.surface.iter());
        let surfaces = a.zip(b).zip(c.zip(d)).zip(&self.centers[0].surface);
        for (column, (pixel, (((a, b), (c, d)), center))) in pixels.zip(surfaces).enumerate() {
            let is_one_surface = (a ^ center) | (b ^ center) | (c ^ center) | (d ^ center) == 0;
            if !is_one_surface && self.seen.is_edge_between([*center, *a, *b, *c, *d]) {
                pixel.copy_from_slice(&bytes(self.mixed(view, row, column)));
            }
        }
    }

    /// Blends what is transparent into a row.
    fn blend_row(&mut self, view: &View, row: u32, is_smooth: bool, picture: &mut Picture) {
        if is_smooth {
            let [a, b, c, d] = self.smooth.each_ref();
            let [o, p, q, r] = Offset::SMOOTH;
            let samples = [(o, a), (p, b), (q, c), (r, d)];
            self.glass.blend(view, row, &samples, picture);
        } else {
            let samples = [(Offset::CENTER, &self.centers[0])];
            self.glass.blend(view, row, &samples, picture);
        }
    }

    /// The mean colour of the smooth samples of a pixel.
    fn mixed(&self, view: &View, row: u32, column: usize) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (offset, samples) in Offset::SMOOTH.into_iter().zip(&self.smooth) {
            let surface = &self.seen.surfaces[samples.surface[column] as usize];
            let (x, y) = (column as f32 + offset.x, row as f32 + offset.y);
            sum += surface.shown(view, x, y, 1.0 / samples.nearness[column]);
        }
        sum / 4.0
    }
}
