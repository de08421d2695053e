//! Triangles of figures, of which there are many and small ones.
//!
//! They are clamp_share like [`Face`](super::face::Face)s, by planes through the eye and their edges, but several rows of samples
//! are found at once and without branches. The near plane does not cut them.

use std::ops::Range;

use bevy::math::{Vec3, Vec4};

use crate::{
    camera::{Linear, SampleOffset, View},
    raster::scanline::SampleRow,
};

/// A triangle as it is seen.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// The rows in which it may be seen.
    pub rows: Range<u32>,
    surface: u32,
    inverse_depth: Linear,
    edges: [Edge; 3],
}

/// Where the samples of a row have to be to lie on the inner side of an edge: not left of `slope * y + offset`, or left of
/// it. For the two triangles that share an edge these numbers are the same to the last bit.
#[derive(Clone, Copy, Debug)]
struct Edge {
    slope: f32,
    offset: f32,
    /// 0 if samples must not be left of it, otherwise minus infinity.
    not_from: f32,
    /// 0 if samples must be left of it, otherwise infinity.
    not_before: f32,
}

impl Triangle {
    /// The triangle with these corners, given relative to the eye and counter-clockwise as seen from outside, and with this
    /// normal of unit length. It has to be seen from outside.
    pub fn seen(
        view: &View,
        corners: [Vec3; 3],
        normal: Vec3,
        rows: Range<u32>,
        surface: u32,
    ) -> Self {
        let edge = |i: usize| {
            let (from, to) = (corners[i], corners[(i + 1) % 3]);
            Edge::from(view.rays.dot(to.cross(from)))
        };
        Self {
            rows,
            surface,
            inverse_depth: view.rays.dot(normal / normal.dot(corners[0])),
            edges: std::array::from_fn(edge),
        }
    }

    /// Puts it into the samples of a row of pixels that see it and nothing nearer.
    pub fn draw<const N: usize>(
        &self,
        row: u32,
        offsets: [SampleOffset; N],
        samples: &mut [SampleRow; N],
    ) {
        let lane = |i: usize| offsets[i.min(N - 1)];
        let [x, y] = [
            |offset: SampleOffset| offset.x,
            |offset: SampleOffset| offset.y,
        ]
        .map(|part| Vec4::from_array(std::array::from_fn(|i| part(lane(i)))));
        let y = y + row as f32;
        let count = samples[0].surface.len();
        let width = Vec4::splat(count as f32);
        let (mut starts, mut ends) = (Vec4::ZERO, width);
        for edge in &self.edges {
            let at = y * edge.slope + edge.offset - x;
            starts = starts.max(at + edge.not_from);
            ends = ends.min(at + edge.not_before);
        }
        let [starts, ends] = [starts.min(width), ends.max(Vec4::ZERO)].map(columns);
        for (i, samples) in samples.iter_mut().enumerate() {
            let inverse_depth = self.inverse_depth.on_row(row, offsets[i]);
            let end = ends[i].min(count);
            samples.put_some(starts[i].min(end)..end, inverse_depth, self.surface);
        }
    }
}

impl From<Linear> for Edge {
    /// Where this is positive.
    fn from(Linear { first, right, down }: Linear) -> Self {
        /// Where the edge is level, this stands for 0: it meets rows very far out, on the one or on the other side.
        const LEVEL: f32 = 1e-30;
        let right = if right == 0.0 { LEVEL } else { right };
        let (not_from, not_before) = if right > 0.0 {
            (0.0, f32::INFINITY)
        } else {
            (f32::NEG_INFINITY, 0.0)
        };
        Self {
            slope: -down / right,
            offset: -first / right,
            not_from,
            not_before,
        }
    }
}

/// The columns that are nearest to half a column right of these places, which are at least 0.
fn columns(x: Vec4) -> [usize; 4] {
    // From 2^23 on there are only whole numbers, and the last bits of such a number count them.
    const WHOLE: f32 = 8_388_608.0;
    (x + 0.5 + WHOLE)
        .to_array()
        .map(|column| (column.to_bits() & 0x007f_ffff) as usize)
}
