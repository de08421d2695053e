//! Drawing a band of rows of a picture, row by row.

use bevy::math::Vec3;
use tabletop_core::Picture;

use crate::{
    camera::{SampleOffset, View},
    color::nearest_bytes,
    raster::{
        scanline::SampleRow,
        transparent::{Blend, TransparentSpheres},
        visible::{ActiveSurfaces, VisibleSurfaces},
    },
};

/// What is to be drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<'a> {
    pub view: &'a View,
    pub visible: &'a VisibleSurfaces,
    pub spheres: &'a TransparentSpheres,
    pub is_smooth: bool,
}

/// Pixels of a picture, one after the other.
#[derive(Debug)]
pub(crate) struct Pixels<'a> {
    pub rgb: &'a mut [u8],
    pub depth: &'a mut [f32],
    pub objects: &'a mut [u32],
}

/// The memory that it takes to draw a band.
#[derive(Clone, Debug, Default)]
pub(crate) struct Band {
    active: ActiveSurfaces,
    centers: [SampleRow; 1],
    smooth: [SampleRow; 4],
    blend: Blend,
}

impl<'a> Pixels<'a> {
    /// All of a picture.
    pub fn of(picture: &'a mut Picture) -> Self {
        Self {
            rgb: &mut picture.rgb,
            depth: &mut picture.depth,
            objects: &mut picture.objects,
        }
    }

    /// Parts of so many pixels, the last one with what is left.
    pub fn parts(self, pixels: usize) -> impl Iterator<Item = Self> {
        let rgb = self.rgb.chunks_mut(3 * pixels);
        let depth = self.depth.chunks_mut(pixels);
        let objects = self.objects.chunks_mut(pixels);
        rgb.zip(depth)
            .zip(objects)
            .map(|((rgb, depth), objects)| Self {
                rgb,
                depth,
                objects,
            })
    }
}

impl Band {
    /// Draws what is seen in these whole rows.
    pub fn draw(&mut self, frame: &Frame, first_row: u32, pixels: Pixels) {
        let Frame { view, visible, .. } = *frame;
        visible.activate_above(first_row, &mut self.active);
        for (row, mut pixels) in (first_row..).zip(pixels.parts(view.width as usize)) {
            visible.activate_row(row, &mut self.active);
            self.draw_row(frame, row, &mut pixels);
            if frame.is_smooth {
                self.smooth_row(frame, row, pixels.rgb);
            }
            self.blend_row(frame, row, pixels.rgb);
        }
    }

    /// Draws a row as it is seen through the centres of its pixels.
    fn draw_row(&mut self, frame: &Frame, row: u32, pixels: &mut Pixels) {
        let Frame { view, visible, .. } = *frame;
        let Self {
            active, centers, ..
        } = self;
        centers[0].clear(view.width);
        visible.sample(active, row, SampleOffset::CENTER, &mut centers[0]);
        visible.sample_figures(active, row, [SampleOffset::CENTER], centers);
        let [centers] = centers;
        for (depth, inverse_depth) in pixels.depth.iter_mut().zip(&centers.inverse_depth) {
            *depth = 1.0 / inverse_depth;
        }
        let mut start = 0;
        for run in centers.surface.chunk_by(|one, next| one == next) {
            let end = start + run.len();
            let surface = &visible.surfaces[run[0] as usize];
            pixels.objects[start..end].fill(surface.object);
            let (depths, rgb) = (
                &pixels.depth[start..end],
                &mut pixels.rgb[3 * start..3 * end],
            );
            surface.paint(row, start, depths, rgb);
            start = end;
        }
    }

    /// Mixes the colours of those pixels of a row in which more than one surface is visible.
    fn smooth_row(&mut self, frame: &Frame, row: u32, rgb: &mut [u8]) {
        let Frame { view, visible, .. } = *frame;
        for (offset, samples) in SampleOffset::SMOOTH.into_iter().zip(&mut self.smooth) {
            samples.clear(view.width);
            visible.sample(&self.active, row, offset, samples);
        }
        visible.sample_figures(&self.active, row, SampleOffset::SMOOTH, &mut self.smooth);
        let pixels = rgb.chunks_exact_mut(3);
        let [a, b, c, d] = self.smooth.each_ref().map(|samples| samples.surface.iter());
        let surfaces = a.zip(b).zip(c.zip(d)).zip(&self.centers[0].surface);
        for (column, (pixel, (((a, b), (c, d)), center))) in pixels.zip(surfaces).enumerate() {
            let is_one_surface = (a ^ center) | (b ^ center) | (c ^ center) | (d ^ center) == 0;
            if !is_one_surface && visible.is_edge_between([*center, *a, *b, *c, *d]) {
                pixel.copy_from_slice(&nearest_bytes(self.mixed(frame, row, column)));
            }
        }
    }

    /// Blends what is transparent into the colours of a row.
    fn blend_row(&mut self, frame: &Frame, row: u32, rgb: &mut [u8]) {
        let Self {
            centers,
            smooth,
            blend,
            ..
        } = self;
        let (offsets, samples): (&[SampleOffset], &[SampleRow]) = match frame.is_smooth {
            true => (&SampleOffset::SMOOTH, smooth),
            false => (&[SampleOffset::CENTER], centers),
        };
        frame
            .spheres
            .blend(frame.view, row, offsets, samples, blend, rgb);
    }

    /// The mean colour of the smooth samples of a pixel.
    fn mixed(&self, frame: &Frame, row: u32, column: usize) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (offset, samples) in SampleOffset::SMOOTH.into_iter().zip(&self.smooth) {
            let surface = &frame.visible.surfaces[samples.surface[column] as usize];
            let (x, y) = (column as f32 + offset.x, row as f32 + offset.y);
            sum += surface.shown(x, y, 1.0 / samples.inverse_depth[column]);
        }
        sum / 4.0
    }
}
