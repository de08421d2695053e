//! One row of samples of a picture.

use std::ops::Range;

use bevy::math::Vec4;

use crate::camera::OnRow;

/// Nearest surface at each sample of a row.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampleRow {
    /// One over the depth; 0 where nothing is.
    pub nearness: Vec<f32>,
    /// Which surface it is: an index into the painter's list, whose first entry is nothing.
    pub surface: Vec<u32>,
}

/// Where in its row of pixels a row of samples lies, in pixels from the pixels' centres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Offset {
    pub x: f32,
    pub y: f32,
}

impl Offset {
    /// The pixels' centres.
    pub const CENTER: Self = Self { x: 0.0, y: 0.0 };

    /// The samples of smooth edges: no two of them in a row, column or diagonal of the pixel.
    pub const SMOOTH: [Self; 4] = [
        Self {
            x: -0.125,
            y: -0.375,
        },
        Self {
            x: 0.375,
            y: -0.125,
        },
        Self {
            x: -0.375,
            y: 0.125,
        },
        Self { x: 0.125, y: 0.375 },
    ];
}

impl SampleRow {
    /// Makes it a row of nothing.
    pub fn clear(&mut self, width: u32) {
        let width = width as usize;
        self.nearness.clear();
        self.nearness.resize(width, 0.0);
        self.surface.clear();
        self.surface.resize(width, 0);
    }

    /// Puts a surface into those samples of these few columns that see nothing nearer.
    #[inline]
    pub fn put_some(&mut self, columns: Range<usize>, nearness: OnRow<f32>, surface: u32) {
        const LANES: Vec4 = Vec4::new(0.0, 1.0, 2.0, 3.0);
        let Some(last) = self.nearness.len().checked_sub(4) else {
            self.put(columns, |x| (nearness.at(x), surface));
            return;
        };
        let ends = [columns.start, columns.end].map(|end| Vec4::splat(end as i32 as f32));
        let [base, step] = [nearness.at(0.0), nearness.step].map(Vec4::splat);
        let surface = Vec4::splat(f32::from_bits(surface));
        for first in columns.step_by(4) {
            // Four samples at once, among them some that are before or behind the columns. Their surfaces are bits only.
            let first = first.min(last);
            let (Some(seen_nearness), Some(seen_surface)) = (
                self.nearness[first..].first_chunk_mut::<4>(),
                self.surface[first..].first_chunk_mut::<4>(),
            ) else {
                return;
            };
            let x = Vec4::splat(first as i32 as f32) + LANES;
            let own = base + step * x;
            let seen = Vec4::from(*seen_nearness);
            let is_seen = own.cmpgt(seen) & x.cmpge(ends[0]) & x.cmplt(ends[1]);
            *seen_nearness = Vec4::select(is_seen, own, seen).to_array();
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
        let nearness = self.nearness[columns.clone()].iter_mut();
        let surface = self.surface[columns].iter_mut();
        for (x, (nearness, surface)) in (first..).zip(nearness.zip(surface)) {
            let (own_nearness, own_surface) = seen_at(x as f32);
            // Without a branch, so that the compiler can do several samples at once.
            let is_nearer = own_nearness > *nearness;
            let mask = u32::from(is_nearer).wrapping_neg();
            *nearness = if is_nearer { own_nearness } else { *nearness };
            *surface = own_surface & mask | *surface & !mask;
        }
    }
}
