//! Triangles of figures: many and small.
//!
//! As for [`RasterFace`](super::face::RasterFace)s, planes through the eye and their edges bound them, but several rows of samples
//! are found at once and without branches. The near plane does not cut them.

use std::ops::Range;

use bevy::math::{Vec3, Vec4};

use crate::{
    camera::{Linear, PinholeView, Rays, SampleOffset},
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

impl Triangle {
    /// The triangle with these corners, given relative to the eye and counterclockwise as seen from outside, and with this
    /// unit normal. It has to be seen from outside.
    pub fn seen(
        view: &PinholeView,
        corners: [Vec3; 3],
        normal: Vec3,
        rows: Range<u32>,
        surface: u32,
    ) -> Self {
        Self {
            rows,
            surface,
            inverse_depth: view.rays.dot(normal / normal.dot(corners[0])),
            edges: Edges::of(view, corners),
        }
    }

    /// Draws it into the centre samples that see nothing nearer, in up to four rows.
    #[inline]
    pub fn draw_centers(&self, rows: Range<u32>, first_row: u32, samples: &mut CenterSamples) {
        const LANES: Vec4 = Vec4::new(0.0, 1.0, 2.0, 3.0);
        let width = samples.width();
        let [starts, ends] = self.columns(LANES + rows.start as f32, Vec4::ZERO, width);
        for (row, (start, end)) in rows.zip(starts.to_array().into_iter().zip(ends.to_array())) {
            if start < end {
                let inverse_depth = self.inverse_depth.on_row(row, SampleOffset::CENTER);
                let row = (row - first_row) as usize;
                samples.put_few(row, [start, end], inverse_depth, self.surface);
            }
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
    /// The edges from each corner to the next: a sample is inside where the ray's product with the normal of the plane through the eye and the
    /// edge is positive. As many are computed at once as the processor can.
    fn of(view: &PinholeView, [a, b, c]: [Vec3; 3]) -> Self {
        /// Replaces the 0 of a level edge, which then meets rows very far out, on one side or the other.
        const LEVEL: Vec4 = Vec4::splat(1e-30);
        let lanes = |part: fn(Vec3) -> f32| {
            let [a, b, c] = [a, b, c].map(part);
            (Vec4::new(a, b, c, a), Vec4::new(b, c, a, b))
        };
        let ((from_x, to_x), (from_y, to_y)) = (lanes(|at| at.x), lanes(|at| at.y));
        let (from_z, to_z) = lanes(|at| at.z);
        let normal_x = to_y * from_z - from_y * to_z;
        let normal_y = to_z * from_x - from_z * to_x;
        let normal_z = to_x * from_y - from_x * to_y;
        let dot = |ray: Vec3| normal_x * ray.x + normal_y * ray.y + normal_z * ray.z;
        let Rays { first, right, down } = view.rays;
        let (first, right, down) = (dot(first), dot(right), dot(down));
        let right = Vec4::select(right.cmpeq(Vec4::ZERO), LEVEL, right);
        let is_from = right.cmpgt(Vec4::ZERO);
        Self {
            slope: -down / right,
            offset: -first / right,
            not_from: Vec4::select(is_from, Vec4::ZERO, Vec4::NEG_INFINITY),
            not_before: Vec4::select(is_from, Vec4::INFINITY, Vec4::ZERO),
        }
    }
}

/// The columns that are nearest to half a column right of these places, which are at least 0.
#[inline]
fn half_right(x: Vec4) -> Vec4 {
    // From 2^23 on there are only whole numbers.
    const WHOLE: f32 = 8_388_608.0;
    x + 0.5 + WHOLE - WHOLE
}
