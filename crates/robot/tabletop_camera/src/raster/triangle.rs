//! Triangles of figures: many and small.
//!
//! As for [`RasterFace`](super::face::RasterFace)s, planes through the eye and their edges bound them, but several rows of samples
//! are found at once and without branches. The near plane does not cut them.

use std::ops::Range;

use bevy::math::Vec4;

use crate::{
    camera::{FourLinear, FourVectors, Linear, PinholeView, SampleOffset, transposed},
    raster::samples::{CenterSamples, SmoothOnRow, SmoothSamples, column},
};

/// A triangle in the picture.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// The rows in which it may be seen.
    pub rows: Range<u32>,
    surface: u32,
    inverse_depth: Linear,
    edges: Edges,
}

/// The conditions for a row's samples to lie on the inner sides of three edges: not left of `slope * y + offset`, or left of
/// it. For the two triangles that share an edge these numbers are the same to the last bit. The fourth lanes are unused.
#[derive(Clone, Copy, Debug)]
struct Edges {
    slope: Vec4,
    offset: Vec4,
    /// 0 if samples must not be left of it, otherwise minus infinity.
    not_from: Vec4,
    /// 0 if samples must be left of it, otherwise infinity.
    not_before: Vec4,
}

/// Four triangles in the picture, each a lane.
pub(crate) struct FourTriangles {
    inverse_depth: [Linear; 4],
    edges: [Edges; 4],
}

impl FourTriangles {
    /// The triangles with these corners, given relative to the eye and counterclockwise as seen from outside, and with these
    /// unit normals. They have to be seen from outside.
    pub fn seen(view: &PinholeView, corners: &[FourVectors; 3], normals: FourVectors) -> Self {
        let inverse_depth = view.rays.four_dots(normals / normals.dot(corners[0]));
        Self {
            inverse_depth: inverse_depth.each(),
            edges: Edges::of(view, corners),
        }
    }

    /// One of them.
    #[inline]
    pub fn triangle(&self, lane: usize, rows: Range<u32>, surface: u32) -> Triangle {
        Triangle {
            rows,
            surface,
            inverse_depth: self.inverse_depth[lane],
            edges: self.edges[lane],
        }
    }
}

impl Triangle {
    /// Draws it into the centre samples that see nothing nearer, in up to four rows.
    #[inline]
    pub fn draw_centers(&self, rows: Range<u32>, first_row: u32, samples: &mut CenterSamples) {
        const LANES: Vec4 = Vec4::new(0.0, 1.0, 2.0, 3.0);
        let width = samples.width();
        let y = LANES + rows.start as f32;
        let [starts, ends] = self.columns(y, Vec4::ZERO, width);
        let mut lanes = starts.cmplt(ends).bitmask() & ((1 << rows.len().min(4)) - 1);
        if lanes == 0 {
            return;
        }
        let (starts, ends) = (starts.to_array(), ends.to_array());
        let on_rows = self.inverse_depth.on_rows(y, SampleOffset::CENTER);
        let row = (rows.start - first_row) as usize;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let columns = [starts[lane], ends[lane]];
            samples.put_few(row + lane, columns, on_rows[lane], self.surface);
        }
    }

    /// Draws it into the smooth samples of a row of pixels that see nothing nearer.
    pub fn draw_smooth(&self, row: u32, first_row: u32, samples: &mut SmoothSamples) {
        let (x, y) = SampleOffset::smooth_on_row(row);
        let width = samples.width();
        let [starts, ends] = self.columns(y, x, width);
        let is_any = starts.cmplt(ends);
        let first = Vec4::select(is_any, starts, width).min_element();
        let end = Vec4::select(is_any, ends, Vec4::ZERO).max_element();
        if first < end {
            let inverse_depth = SmoothOnRow::of(&self.inverse_depth, row);
            let columns = column(first)..column(end);
            let mut samples = samples.smooth_row((row - first_row) as usize);
            samples.put(columns, [starts, ends], inverse_depth, self.surface);
        }
    }

    /// The first column of its samples, and the one after the last, for samples at these offsets down and to the right in their pixels.
    fn columns(&self, down: Vec4, right: Vec4, width: Vec4) -> [Vec4; 2] {
        let (mut starts, mut ends) = (Vec4::ZERO, width);
        let Edges {
            slope,
            offset,
            not_from,
            not_before,
        } = self.edges;
        for i in 0..3 {
            let at = down * slope[i] + offset[i] - right;
            starts = starts.max(at + not_from[i]);
            ends = ends.min(at + not_before[i]);
        }
        let [starts, ends] = [starts.min(width), ends.max(Vec4::ZERO)].map(half_right);
        [starts, ends.min(width)]
    }
}

impl Edges {
    /// The edges of four triangles from each corner to the next: a sample is inside where the ray's product with the normal of the plane
    /// through the eye and the edge is positive.
    fn of(view: &PinholeView, [a, b, c]: &[FourVectors; 3]) -> [Self; 4] {
        /// Replaces the 0 of a level edge, which then meets rows very far out, on one side or the other.
        const LEVEL: Vec4 = Vec4::splat(1e-30);
        let edge = |from: &FourVectors, to: &FourVectors| {
            let FourLinear { first, right, down } = view.rays.four_dots(to.cross(*from));
            let right = Vec4::select(right.cmpeq(Vec4::ZERO), LEVEL, right);
            let is_from = right.cmpgt(Vec4::ZERO);
            let not_from = Vec4::select(is_from, Vec4::ZERO, Vec4::NEG_INFINITY);
            let not_before = Vec4::select(is_from, Vec4::INFINITY, Vec4::ZERO);
            (-down / right, -first / right, not_from, not_before)
        };
        let (first, second, third) = (edge(a, b), edge(b, c), edge(c, a));
        let slopes = transposed([first.0, second.0, third.0, third.0]);
        let offsets = transposed([first.1, second.1, third.1, third.1]);
        let not_from = transposed([first.2, second.2, third.2, third.2]);
        let not_before = transposed([first.3, second.3, third.3, third.3]);
        let lane = |lane: usize| Self {
            slope: slopes[lane],
            offset: offsets[lane],
            not_from: not_from[lane],
            not_before: not_before[lane],
        };
        [lane(0), lane(1), lane(2), lane(3)]
    }
}

/// The columns that are nearest to half a column right of these places, which are at least 0.
#[inline]
fn half_right(x: Vec4) -> Vec4 {
    // From 2^23 on there are only whole numbers.
    const WHOLE: f32 = 8_388_608.0;
    x + 0.5 + WHOLE - WHOLE
}
