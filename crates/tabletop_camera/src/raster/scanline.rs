//! One row of samples of a picture.

use std::ops::Range;

use bevy::math::Vec4;

use crate::camera::OnRow;

/// Nearest surface at each sample of a row.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampleRow {
    /// One over the depth; 0 where nothing is.
    pub inverse_depth: Vec<f32>,
    /// Which surface it is: an index into the rasterizer's list, whose first entry is nothing.
    pub surface: Vec<u32>,
}

impl SampleRow {
    /// Makes it a row of nothing.
    pub fn clear(&mut self, width: u32) {
        let width = width as usize;
        self.inverse_depth.clear();
        self.inverse_depth.resize(width, 0.0);
        self.surface.clear();
        self.surface.resize(width, 0);
    }

    /// Puts a surface into those samples of these few columns that see nothing nearer.
    #[inline]
    pub fn put_some(&mut self, columns: Range<usize>, inverse_depth: OnRow<f32>, surface: u32) {
        const LANES: Vec4 = Vec4::new(0.0, 1.0, 2.0, 3.0);
        let Some(last) = self.inverse_depth.len().checked_sub(4) else {
            self.put(columns, |x| (inverse_depth.at(x), surface));
            return;
        };
        let ends = [columns.start, columns.end].map(|end| Vec4::splat(end as i32 as f32));
        let [base, step] = [inverse_depth.at(0.0), inverse_depth.step].map(Vec4::splat);
        let surface = Vec4::splat(f32::from_bits(surface));
        for first in columns.step_by(4) {
            // Four samples at once, among them some that are before or behind the columns. Their surfaces are bits only.
            let first = first.min(last);
            let (Some(seen_inverse_depth), Some(seen_surface)) = (
                self.inverse_depth[first..].first_chunk_mut::<4>(),
                self.surface[first..].first_chunk_mut::<4>(),
            ) else {
                return;
            };
            let x = Vec4::splat(first as i32 as f32) + LANES;
            let own = base + step * x;
            let seen = Vec4::from(*seen_inverse_depth);
            let is_seen = own.cmpgt(seen) & x.cmpge(ends[0]) & x.cmplt(ends[1]);
            *seen_inverse_depth = Vec4::select(is_seen, own, seen).to_array();
            let seen = Vec4::from(seen_surface.map(f32::from_bits));
            *seen_surface = Vec4::select(is_seen, surface, seen)
                .to_array()
                .map(f32::to_bits);
        }
    }

    /// Puts surfaces into those samples of these columns that see nothing nearer. `seen_at` says for a column how near
    /// which surface is.
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
