//! Drawing a band of rows of a picture, row by row.

use bevy::math::Vec3;
use tabletop_core::Picture;

use crate::{
    camera::View,
    glass::{Blend, Glass},
    row::{Offset, SampleRow},
    seen::{InRow, Seen},
    surface::bytes,
};

/// What is to be drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight<'a> {
    pub view: &'a View,
    pub seen: &'a Seen,
    pub glass: &'a Glass,
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
    in_row: InRow,
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
    pub fn draw(&mut self, sight: &Sight, first_row: u32, pixels: Pixels) {
        let Sight { view, seen, .. } = *sight;
        seen.find_above(first_row, &mut self.in_row);
        for (row, mut pixels) in (first_row..).zip(pixels.parts(view.width as usize)) {
            seen.find_in_row(row, &mut self.in_row);
            self.draw_row(sight, row, &mut pixels);
            if sight.is_smooth {
                self.smooth_row(sight, row, pixels.rgb);
            }
            self.blend_row(sight, row, pixels.rgb);
        }
    }

    /// Draws a row as it is seen through the centres of its pixels.
    fn draw_row(&mut self, sight: &Sight, row: u32, pixels: &mut Pixels) {
        let Sight { view, seen, .. } = *sight;
        let Self {
            in_row, centers, ..
        } = self;
        centers[0].clear(view.width);
        seen.sample(in_row, row, Offset::CENTER, &mut centers[0]);
        seen.sample_figures(in_row, row, [Offset::CENTER], centers);
        let [centers] = centers;
        for (depth, nearness) in pixels.depth.iter_mut().zip(&centers.nearness) {
            *depth = 1.0 / nearness;
        }
        let mut start = 0;
        for run in centers.surface.chunk_by(|one, next| one == next) {
            let end = start + run.len();
            let surface = &seen.surfaces[run[0] as usize];
            pixels.objects[start..end].fill(surface.object);
            let (depths, rgb) = (
                &pixels.depth[start..end],
                &mut pixels.rgb[3 * start..3 * end],
            );
            surface.paint(row, start, depths, rgb);
            start = end;
        }
    }

    /// Mixes the colours of those pixels of a row in which more than one surface is seen.
    fn smooth_row(&mut self, sight: &Sight, row: u32, rgb: &mut [u8]) {
        let Sight { view, seen, .. } = *sight;
        for (offset, samples) in Offset::SMOOTH.into_iter().zip(&mut self.smooth) {
            samples.clear(view.width);
            seen.sample(&self.in_row, row, offset, samples);
        }
        seen.sample_figures(&self.in_row, row, Offset::SMOOTH, &mut self.smooth);
        let pixels = rgb.chunks_exact_mut(3);
        let [a, b, c, d] = self.smooth.each_ref().map(|samples| samples.surface.iter());
        let surfaces = a.zip(b).zip(c.zip(d)).zip(&self.centers[0].surface);
        for (column, (pixel, (((a, b), (c, d)), center))) in pixels.zip(surfaces).enumerate() {
            let is_one_surface = (a ^ center) | (b ^ center) | (c ^ center) | (d ^ center) == 0;
            if !is_one_surface && seen.is_edge_between([*center, *a, *b, *c, *d]) {
                pixel.copy_from_slice(&bytes(self.mixed(sight, row, column)));
            }
        }
    }

    /// Blends what is transparent into the colours of a row.
    fn blend_row(&mut self, sight: &Sight, row: u32, rgb: &mut [u8]) {
        let Self {
            centers,
            smooth,
            blend,
            ..
        } = self;
        let (offsets, samples): (&[Offset], &[SampleRow]) = match sight.is_smooth {
            true => (&Offset::SMOOTH, smooth),
            false => (&[Offset::CENTER], centers),
        };
        sight
            .glass
            .blend(sight.view, row, offsets, samples, blend, rgb);
    }

    /// The mean colour of the smooth samples of a pixel.
    fn mixed(&self, sight: &Sight, row: u32, column: usize) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (offset, samples) in Offset::SMOOTH.into_iter().zip(&self.smooth) {
            let surface = &sight.seen.surfaces[samples.surface[column] as usize];
            let (x, y) = (column as f32 + offset.x, row as f32 + offset.y);
            sum += surface.shown(x, y, 1.0 / samples.nearness[column]);
        }
        sum / 4.0
    }
}
