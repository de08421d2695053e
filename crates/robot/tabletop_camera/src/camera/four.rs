//! Four vectors at once, each a lane.

use std::ops::{Add, Div, Mul, Sub};

use bevy::math::{Mat3, Mat4, Quat, Vec3, Vec4};

/// Four vectors by their parts.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FourVectors {
    pub x: Vec4,
    pub y: Vec4,
    pub z: Vec4,
}

impl FourVectors {
    /// The same vector four times.
    #[inline]
    pub fn splat(vector: Vec3) -> Self {
        Self {
            x: Vec4::splat(vector.x),
            y: Vec4::splat(vector.y),
            z: Vec4::splat(vector.z),
        }
    }

    /// The vectors in the first three parts of these.
    #[inline]
    pub fn of_each(vectors: [Vec4; 4]) -> Self {
        let [x, y, z, _] = transposed(vectors);
        Self { x, y, z }
    }

    #[inline]
    pub fn dot(self, other: Self) -> Vec4 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - other.y * self.z,
            y: self.z * other.x - other.z * self.x,
            z: self.x * other.y - other.x * self.y,
        }
    }
}

impl Add for FourVectors {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }
}

impl Sub for FourVectors {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }
}

impl Mul<Vec4> for FourVectors {
    type Output = Self;

    #[inline]
    fn mul(self, factors: Vec4) -> Self {
        Self {
            x: self.x * factors,
            y: self.y * factors,
            z: self.z * factors,
        }
    }
}

impl Div<Vec4> for FourVectors {
    type Output = Self;

    #[inline]
    fn div(self, divisors: Vec4) -> Self {
        Self {
            x: self.x / divisors,
            y: self.y / divisors,
            z: self.z / divisors,
        }
    }
}

/// A rotation of vectors, four at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FourTurned {
    x: FourVectors,
    y: FourVectors,
    z: FourVectors,
}

impl FourTurned {
    pub fn by(rotation: Quat) -> Self {
        let axes = Mat3::from_quat(rotation);
        Self {
            x: FourVectors::splat(axes.x_axis),
            y: FourVectors::splat(axes.y_axis),
            z: FourVectors::splat(axes.z_axis),
        }
    }

    #[inline]
    pub fn apply(&self, vectors: FourVectors) -> FourVectors {
        self.x * vectors.x + self.y * vectors.y + self.z * vectors.z
    }
}

/// The first parts of all, the second ones, and so on.
#[inline]
pub(crate) fn transposed([a, b, c, d]: [Vec4; 4]) -> [Vec4; 4] {
    let columns = Mat4::from_cols(a, b, c, d).transpose();
    [
        columns.x_axis,
        columns.y_axis,
        columns.z_axis,
        columns.w_axis,
    ]
}
