//! Linear functions of the point of the picture: rays and numbers.

use std::ops::{Add, Mul};

use bevy::math::{Vec3, Vec4};

use super::four::{FourVectors, transposed};

/// Offset of a row of samples from their pixels' centres, in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampleOffset {
    pub x: f32,
    pub y: f32,
}

impl SampleOffset {
    /// The pixels' centres.
    pub const CENTER: Self = Self { x: 0.0, y: 0.0 };

    /// Largest distance of a pixel's samples from its centre, to the right and down.
    pub const REACH: f32 = 0.375;

    /// The samples for smooth edges: no two of them share a row, column or diagonal of the pixel.
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

    /// Offsets of the smooth samples of a row: to the right in their pixels, and down in the picture.
    #[inline]
    pub fn smooth_on_row(row: u32) -> (Vec4, Vec4) {
        let x = Vec4::from_array(Self::SMOOTH.map(|offset| offset.x));
        let y = Vec4::from_array(Self::SMOOTH.map(|offset| offset.y));
        (x, y + row as f32)
    }
}

/// Directions that depend linearly on the point of the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rays {
    pub first: Vec3,
    pub right: Vec3,
    pub down: Vec3,
}

impl Rays {
    /// Direction of the ray through a point of the picture.
    pub fn through(&self, x: f32, y: f32) -> Vec3 {
        self.first + self.right * x + self.down * y
    }

    /// The directions along a row of samples.
    pub fn on_row(&self, row: u32, offset: SampleOffset) -> OnRow<Vec3> {
        OnRow {
            first: self.through(offset.x, row as f32 + offset.y),
            step: self.right,
        }
    }

    /// The same rays, each mapped by a linear function.
    pub fn map(&self, linear: impl Fn(Vec3) -> Vec3) -> Self {
        Self {
            first: linear(self.first),
            right: linear(self.right),
            down: linear(self.down),
        }
    }

    /// The scalar product of each ray with each of four vectors.
    #[inline]
    pub fn four_dots(&self, vectors: FourVectors) -> FourLinear {
        FourLinear {
            first: vectors.dot(FourVectors::splat(self.first)),
            right: vectors.dot(FourVectors::splat(self.right)),
            down: vectors.dot(FourVectors::splat(self.down)),
        }
    }

    /// The scalar product of each ray with a vector.
    pub fn dot(&self, vector: Vec3) -> Linear {
        Linear {
            first: self.first.dot(vector),
            right: self.right.dot(vector),
            down: self.down.dot(vector),
        }
    }
}

/// A number that depends linearly on the point of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Linear {
    pub first: f32,
    pub right: f32,
    pub down: f32,
}

impl Linear {
    pub const fn constant(value: f32) -> Self {
        Self {
            first: value,
            right: 0.0,
            down: 0.0,
        }
    }

    /// Its bits, which identify it.
    pub fn bits(&self) -> [u32; 3] {
        [self.first, self.right, self.down].map(f32::to_bits)
    }

    /// Its value at a point of the picture.
    pub fn at(&self, x: f32, y: f32) -> f32 {
        self.first + self.right * x + self.down * y
    }

    /// Its values along a row of samples.
    pub fn on_row(&self, row: u32, offset: SampleOffset) -> OnRow<f32> {
        OnRow {
            first: self.first + self.down * (row as f32 + offset.y) + self.right * offset.x,
            step: self.right,
        }
    }

    /// Its values along four rows of samples.
    #[inline]
    pub fn on_rows(&self, rows: Vec4, offset: SampleOffset) -> [OnRow<f32>; 4] {
        let first = self.first + self.down * (rows + offset.y) + self.right * offset.x;
        first.to_array().map(|first| OnRow {
            first,
            step: self.right,
        })
    }
}

/// Four numbers that depend linearly on the point of the picture, each a lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FourLinear {
    pub first: Vec4,
    pub right: Vec4,
    pub down: Vec4,
}

impl FourLinear {
    /// Each of them.
    #[inline]
    pub fn each(&self) -> [Linear; 4] {
        let [a, b, c, d] = transposed([self.first, self.right, self.down, self.down]);
        let linear = |parts: Vec4| Linear {
            first: parts.x,
            right: parts.y,
            down: parts.z,
        };
        [linear(a), linear(b), linear(c), linear(d)]
    }
}

/// A linear function of a sample's column in its row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnRow<T> {
    first: T,
    pub step: T,
}

impl<T: Copy + Add<Output = T> + Mul<f32, Output = T>> OnRow<T> {
    /// Its value at a column.
    #[inline]
    pub fn at(&self, column: f32) -> T {
        self.first + self.step * column
    }
}

impl OnRow<f32> {
    /// Its values at four columns.
    #[inline]
    pub fn at_four(&self, columns: Vec4) -> Vec4 {
        self.first + self.step * columns
    }
}
