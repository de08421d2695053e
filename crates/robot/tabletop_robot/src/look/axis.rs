//! The axes that shapes lie along.

use bevy::math::Vec3;
use serde::Deserialize;

/// An axis of a link's frame, which also names the two others: u, v and the axis are right-handed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum LinkAxis {
    /// u is y, v is z.
    X,
    /// u is z, v is x.
    Y,
    /// u is x, v is y.
    Z,
}

impl LinkAxis {
    /// The point with these coordinates, the last one along the axis.
    pub const fn point(self, u: f32, v: f32, along: f32) -> Vec3 {
        match self {
            Self::X => Vec3::new(along, u, v),
            Self::Y => Vec3::new(v, along, u),
            Self::Z => Vec3::new(u, v, along),
        }
    }
}
