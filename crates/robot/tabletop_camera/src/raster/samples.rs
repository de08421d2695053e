//! The samples of a band of rows: one in the middle of each pixel, and for smooth edges four more.

use std::ops::Range;

use bevy::math::Vec4;

use crate::camera::{Linear, OnRow, SampleOffset};

/// Nearest surface in the middle of each pixel of a row.
#[derive(Debug)]
pub(crate) struct CenterRow<'a> {
    /// One over the depth; 0 for the background.
    pub inverse_depth: &'a mut [f32],
    /// Index of the surface in [`VisibleSurfaces`](super::visible::VisibleSurfaces), whose first surface is the background.
    pub surface: &'a mut [u32],
}

/// Nearest surface at each of the four smooth samples of each pixel of a row.
#[derive(Debug)]
pub(crate) struct SmoothRow<'a> {
    pub inverse_depth: &'a mut [[f32; 4]],
    pub surface: &'a mut [[u32; 4]],
}

/// The samples of some rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Samples<Depth, RasterSurface> {
    inverse_depth: Vec<Depth>,
    surface: Vec<RasterSurface>,
    width: usize,
}

/// Number of samples behind the last ones, so that four can be read wherever one is.
const PADDING: usize = 3;

/// The columns of four samples from the first one on.
const LANES: Vec4 = Vec4::new(0.0, 1.0, 2.0, 3.0);

pub(crate) type CenterSamples = Samples<f32, u32>;
pub(crate) type SmoothSamples = Samples<[f32; 4], [u32; 4]>;

/// A linear function of the point of the picture, along a row of pixels at the smooth samples of each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SmoothOnRow {
    first: Vec4,
    step: Vec4,
}

impl<Depth: Clone + Default, RasterSurface: Clone + Default> Samples<Depth, RasterSurface> {
    /// Sets its size; the samples are arbitrary afterwards.
    pub fn resize(&mut self, width: usize, rows: usize) {
        self.width = width;
        let samples = width * rows + PADDING;
        if self.surface.len() != samples {
            self.inverse_depth.resize(samples, Depth::default());
            self.surface.resize(samples, RasterSurface::default());
        }
    }

    /// Number of pixels in a row.
    pub const fn columns(&self) -> usize {
        self.width
    }

    /// Copies these columns of a row from another row of samples of the same width.
    pub fn copy_columns(
        &mut self,
        row: usize,
        columns: Range<usize>,
        other: &Self,
        other_row: usize,
    ) where
        Depth: Copy,
        RasterSurface: Copy,
    {
        let own = row * self.width;
        let own = own + columns.start..own + columns.end;
        let from = other_row * other.width;
        let from = from + columns.start..from + columns.end;
        self.inverse_depth[own.clone()].copy_from_slice(&other.inverse_depth[from.clone()]);
        self.surface[own].copy_from_slice(&other.surface[from]);
    }

    /// Number of pixels in a row, as a float in each lane.
    pub fn width(&self) -> Vec4 {
        Vec4::splat(self.width as f32)
    }

    fn row(&mut self, row: usize) -> (&mut [Depth], &mut [RasterSurface]) {
        let pixels = row * self.width..(row + 1) * self.width;
        (
            &mut self.inverse_depth[pixels.clone()],
            &mut self.surface[pixels],
        )
    }
}

impl CenterSamples {
    pub fn center_row(&mut self, row: usize) -> CenterRow<'_> {
        let (inverse_depth, surface) = self.row(row);
        CenterRow {
            inverse_depth,
            surface,
        }
    }

    /// Puts a surface into a few columns of a row, from the start to before the end behind it, where they see nothing nearer.
    #[inline]
    pub fn put_few(
        &mut self,
        row: usize,
        [start, end]: [f32; 2],
        inverse_depth: OnRow<f32>,
        surface: u32,
    ) {
        let surface = Vec4::splat(f32::from_bits(surface));
        let row = row * self.width..(row + 1) * self.width + PADDING;
        let (inverse_depths, surfaces) =
            (&mut self.inverse_depth[row.clone()], &mut self.surface[row]);
        let mut x = LANES + start;
        let mut first = column(start);
        // Four samples at once, among them some behind the columns. Their surfaces are bits only.
        while let (Some(seen_inverse_depth), Some(seen_surface)) = (
            inverse_depths.get_mut(first..first + 4),
            surfaces.get_mut(first..first + 4),
        ) && let (Some(seen_inverse_depth), Some(seen_surface)) = (
            seen_inverse_depth.first_chunk_mut(),
            seen_surface.first_chunk_mut(),
        ) {
            let own = inverse_depth.at_four(x);
            let is_seen = x.cmplt(Vec4::splat(end));
            put_lanes(seen_inverse_depth, seen_surface, is_seen, own, surface);
            x += 4.0;
            first += 4;
            if x.x >= end {
                return;
            }
        }
    }
}

impl SmoothSamples {
    pub fn smooth_row(&mut self, row: usize) -> SmoothRow<'_> {
        let (inverse_depth, surface) = self.row(row);
        SmoothRow {
            inverse_depth,
            surface,
        }
    }
}

impl SmoothOnRow {
    pub fn of(linear: &Linear, row: u32) -> Self {
        let (x, y) = SampleOffset::smooth_on_row(row);
        let [first, right, down] = [linear.first, linear.right, linear.down].map(Vec4::splat);
        Self {
            first: first + down * y + right * x,
            step: right,
        }
    }

    #[inline]
    pub fn at(&self, column: Vec4) -> Vec4 {
        self.first + self.step * column
    }
}

impl CenterRow<'_> {
    /// Clears these columns.
    pub fn clear(&mut self, columns: Range<usize>) {
        self.inverse_depth[columns.clone()].fill(0.0);
        self.surface[columns].fill(0);
    }

    /// Puts a surface into these columns without a test of depth.
    pub fn fill(&mut self, columns: Range<usize>, inverse_depth: OnRow<f32>, surface: u32) {
        let first = columns.start as i32;
        for (x, seen) in (first..).zip(&mut self.inverse_depth[columns.clone()]) {
            *seen = inverse_depth.at(x as f32);
        }
        self.surface[columns].fill(surface);
    }

    /// Puts surfaces into these columns where they see nothing nearer. `seen_at` gives the inverse depth and the surface at a column.
    #[inline]
    pub fn put(&mut self, columns: Range<usize>, seen_at: impl Fn(f32) -> (f32, u32)) {
        let first = columns.start as i32;
        let inverse_depth = self.inverse_depth[columns.clone()].iter_mut();
        let surface = self.surface[columns].iter_mut();
        for (x, (inverse_depth, surface)) in (first..).zip(inverse_depth.zip(surface)) {
            let (own_inverse_depth, own_surface) = seen_at(x as f32);
            // Without a branch, so that the compiler can do several samples at once.
            let is_nearer = own_inverse_depth > *inverse_depth;
            let mask = u32::from(is_nearer).wrapping_neg();
            *inverse_depth = if is_nearer {
                own_inverse_depth
            } else {
                *inverse_depth
            };
            *surface = own_surface & mask | *surface & !mask;
        }
    }
}

impl SmoothRow<'_> {
    /// Clears these columns.
    pub fn clear(&mut self, columns: Range<usize>) {
        self.inverse_depth[columns.clone()].fill([0.0; 4]);
        self.surface[columns].fill([0; 4]);
    }

    /// Puts a surface into all samples of these columns without a test of depth.
    pub fn fill(&mut self, columns: Range<usize>, inverse_depth: SmoothOnRow, surface: u32) {
        let first = columns.start as i32;
        for (x, seen) in (first..).zip(&mut self.inverse_depth[columns.clone()]) {
            *seen = inverse_depth.at(Vec4::splat(x as f32)).to_array();
        }
        self.surface[columns].fill([surface; 4]);
    }

    /// Puts a surface into the samples from `start` to before `end` that see nothing nearer.
    #[inline]
    pub fn put(
        &mut self,
        columns: Range<usize>,
        [starts, ends]: [Vec4; 2],
        inverse_depth: SmoothOnRow,
        surface: u32,
    ) {
        let surface = Vec4::splat(f32::from_bits(surface));
        let first = columns.start as i32;
        let seen_inverse_depth = self.inverse_depth[columns.clone()].iter_mut();
        let seen = seen_inverse_depth.zip(&mut self.surface[columns]);
        for (x, (seen_inverse_depth, seen_surface)) in (first..).zip(seen) {
            let x = Vec4::splat(x as f32);
            let own = inverse_depth.at(x);
            let is_seen = x.cmpge(starts) & x.cmplt(ends);
            put_lanes(seen_inverse_depth, seen_surface, is_seen, own, surface);
        }
    }

    /// Puts another row's findings at one of the samples of these columns where they are nearer.
    pub fn merge(&mut self, sample: usize, columns: Range<usize>, other: &CenterRow) {
        let own = other.inverse_depth[columns.clone()]
            .iter()
            .zip(&other.surface[columns.clone()]);
        let seen_inverse_depth = self.inverse_depth[columns.clone()].iter_mut();
        let seen = seen_inverse_depth.zip(&mut self.surface[columns]);
        for ((seen_inverse_depth, seen_surface), (&inverse_depth, &surface)) in seen.zip(own) {
            if inverse_depth > seen_inverse_depth[sample] {
                seen_inverse_depth[sample] = inverse_depth;
                seen_surface[sample] = surface;
            }
        }
    }
}

/// A column as an index. It is a whole number, not negative and not too large.
#[inline]
pub(crate) fn column(x: f32) -> usize {
    // The last bits of a number from 2^23 on count the whole numbers.
    const WHOLE: f32 = 8_388_608.0;
    ((x + WHOLE).to_bits() & 0x007f_ffff) as usize
}

/// The first columns that are not left of these places, from 0 to the number of columns.
#[inline]
pub(crate) fn first_columns(x: Vec4, columns: Vec4) -> Vec4 {
    // From 2^23 on there are only whole numbers.
    const WHOLE: f32 = 8_388_608.0;
    let x = x.max(Vec4::ZERO).min(columns);
    let nearest = x + WHOLE - WHOLE;
    nearest + Vec4::select(x.cmpgt(nearest), Vec4::ONE, Vec4::ZERO)
}

/// Puts a surface, given as bits, into those of four samples that may see it and see nothing nearer.
#[inline]
fn put_lanes(
    seen_inverse_depth: &mut [f32; 4],
    seen_surface: &mut [u32; 4],
    is_seen: bevy::math::BVec4A,
    own: Vec4,
    surface: Vec4,
) {
    let seen = Vec4::from(*seen_inverse_depth);
    let is_seen = own.cmpgt(seen) & is_seen;
    *seen_inverse_depth = Vec4::select(is_seen, own, seen).to_array();
    let seen = Vec4::from(seen_surface.map(f32::from_bits));
    *seen_surface = Vec4::select(is_seen, surface, seen)
        .to_array()
        .map(f32::to_bits);
}
