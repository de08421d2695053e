//! Resolution of samples to the pixels of a row.

use std::ops::Range;

use bevy::math::{Vec3, Vec4};
use tabletop_core::Picture;

use crate::{
    camera::SampleOffset,
    color::nearest_bytes,
    raster::{
        backdrop::Backdrop,
        samples::{CenterRow, SmoothRow},
        surface::{FourPixels, RasterSurface},
        visible::VisibleSurfaces,
    },
};

/// Pixels of a picture, one after the other.
#[derive(Debug)]
pub(crate) struct Pixels<'a> {
    pub rgb: &'a mut [u8],
    pub depth: &'a mut [f32],
    pub objects: &'a mut [u32],
}

/// A row of pixels, with the surfaces that its samples see.
#[derive(Debug)]
pub(crate) struct RowResolver<'a, 'b> {
    pub visible: &'a VisibleSurfaces,
    pub backdrop: &'a Backdrop,
    pub row: u32,
    pub centers: CenterRow<'a>,
    pub smooth: Option<SmoothRow<'a>>,
    pub pixels: &'a mut Pixels<'b>,
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

    /// The same pixels, for a while.
    pub fn reborrow(&mut self) -> Pixels<'_> {
        Pixels {
            rgb: self.rgb,
            depth: self.depth,
            objects: self.objects,
        }
    }

    /// Copies the same number of other pixels.
    pub fn copy_from(&mut self, other: &Pixels) {
        self.rgb.copy_from_slice(other.rgb);
        self.depth.copy_from_slice(other.depth);
        self.objects.copy_from_slice(other.objects);
    }

    /// Parts of this many pixels each; the last part has the rest.
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

impl RowResolver<'_, '_> {
    /// Paints these columns, in which all samples see one face.
    pub fn paint_face(&mut self, face: u32, columns: Range<usize>) {
        let known = self.backdrop.row(self.row);
        let known = known.filter(|_| self.visible.backdrop == Some(face));
        let face = &self.visible.faces[face as usize];
        let depths = &mut self.pixels.depth[columns.clone()];
        if let Some(known) = known {
            depths.copy_from_slice(&known[columns.clone()]);
        } else {
            let inverse_depth = face.plane.inverse_depth;
            let inverse_depth = inverse_depth.on_row(self.row, SampleOffset::CENTER);
            for (x, depth) in (columns.start as i32..).zip(depths) {
                *depth = 1.0 / inverse_depth.at(x as f32);
            }
        }
        self.pixels.objects[columns.clone()].fill(face.look.object);
        face.look
            .paint(&mut self.pixels.rgb[3 * columns.start..3 * columns.end]);
    }

    /// Paints these columns from their samples.
    pub fn paint_samples(&mut self, columns: Range<usize>) {
        if columns.is_empty() {
            return;
        }
        self.paint_centers(columns.clone());
        if !self.visible.quadrics.is_empty() {
            self.paint_curved(columns.clone());
        }
        self.smooth(columns);
    }

    /// Paints these columns from the samples in the middle of the pixels.
    fn paint_centers(&mut self, columns: Range<usize>) {
        let (surfaces, rest) = self.centers.surface[columns.clone()].as_chunks::<4>();
        let (inverse_depths, _) = self.centers.inverse_depth[columns.clone()].as_chunks::<4>();
        let (rgb, _) = self.pixels.rgb[3 * columns.start..3 * columns.end].as_chunks_mut::<12>();
        let (depths, _) = self.pixels.depth[columns.clone()].as_chunks_mut::<4>();
        let (objects, _) = self.pixels.objects[columns.clone()].as_chunks_mut::<4>();
        let count = surfaces.len();
        let (inverse_depths, rgb) = (&inverse_depths[..count], &mut rgb[..count]);
        let (depths, objects) = (&mut depths[..count], &mut objects[..count]);
        let mut is_flat = false;
        for i in 0..count {
            let depth = Vec4::ONE / Vec4::from_array(inverse_depths[i]);
            if is_flat && surfaces[i] == surfaces[i - 1] {
                rgb[i] = rgb[i - 1];
                objects[i] = objects[i - 1];
                depths[i] = depth.to_array();
                continue;
            }
            let pixels = FourPixels {
                rgb: &mut rgb[i],
                depth: &mut depths[i],
                objects: &mut objects[i],
            };
            is_flat = RasterSurface::paint_four(
                surfaces[i].map(|surface| &self.visible.surfaces[surface as usize]),
                &self.visible.lighting,
                self.row,
                columns.start + 4 * i,
                depth,
                pixels,
            );
        }
        let rest = columns.end - rest.len()..columns.end;
        if !rest.is_empty() {
            self.paint_rest(rest);
        }
    }

    /// Paints up to three columns from the samples in the middle of the pixels.
    #[cold]
    fn paint_rest(&mut self, columns: Range<usize>) {
        let count = columns.len();
        let (mut rgb, mut depth, mut objects) = ([0; 12], [0.0; 4], [0; 4]);
        let (mut surfaces, mut inverse_depths) = ([0; 4], [0.0; 4]);
        surfaces[..count].copy_from_slice(&self.centers.surface[columns.clone()]);
        inverse_depths[..count].copy_from_slice(&self.centers.inverse_depth[columns.clone()]);
        let pixels = FourPixels {
            rgb: &mut rgb,
            depth: &mut depth,
            objects: &mut objects,
        };
        RasterSurface::paint_four(
            surfaces.map(|surface| &self.visible.surfaces[surface as usize]),
            &self.visible.lighting,
            self.row,
            columns.start,
            Vec4::ONE / Vec4::from_array(inverse_depths),
            pixels,
        );
        self.pixels.rgb[3 * columns.start..3 * columns.end].copy_from_slice(&rgb[..3 * count]);
        self.pixels.depth[columns.clone()].copy_from_slice(&depth[..count]);
        self.pixels.objects[columns].copy_from_slice(&objects[..count]);
    }

    /// Paints the balls and the sides of cylinders in these columns.
    fn paint_curved(&mut self, columns: Range<usize>) {
        let mut start = columns.start;
        for run in self.centers.surface[columns].chunk_by(|one, next| one == next) {
            let end = start + run.len();
            let surface = &self.visible.surfaces[run[0] as usize];
            if let Some(quadric) = surface.quadric() {
                let curve = &self.visible.quadrics[quadric].curve;
                let depths = &self.pixels.depth[start..end];
                let rgb = &mut self.pixels.rgb[3 * start..3 * end];
                curve.paint(
                    surface,
                    &self.visible.lighting,
                    self.row,
                    start,
                    depths,
                    rgb,
                );
            }
            start = end;
        }
    }

    /// Mixes the colours of pixels in these columns that see more than one surface.
    fn smooth(&mut self, columns: Range<usize>) {
        let Some(smooth) = &self.smooth else {
            return;
        };
        for column in columns {
            let (center, samples) = (self.centers.surface[column], smooth.surface[column]);
            let [a, b, c, d] = samples;
            if samples != [center; 4] && self.visible.is_edge_between([center, a, b, c, d]) {
                let mixed = nearest_bytes(self.mixed(smooth, column));
                self.pixels.rgb[3 * column..3 * column + 3].copy_from_slice(&mixed);
            }
        }
    }

    /// The mean colour of the smooth samples of a pixel.
    fn mixed(&self, smooth: &SmoothRow, column: usize) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (i, offset) in SampleOffset::SMOOTH.into_iter().enumerate() {
            let surface = &self.visible.surfaces[smooth.surface[column][i] as usize];
            let (x, y) = (column as f32 + offset.x, self.row as f32 + offset.y);
            sum += surface.shown(
                &self.visible.quadrics,
                &self.visible.lighting,
                x,
                y,
                1.0 / smooth.inverse_depth[column][i],
            );
        }
        sum / 4.0
    }
}
