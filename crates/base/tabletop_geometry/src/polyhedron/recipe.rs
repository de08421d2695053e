//! Recipes of regular polyhedra.

use bevy::prelude::*;

/// The least number of sides with which a solid is meant to look round: 20° or less between two of them.
pub const ROUND_SIDES: u32 = 18;

/// The largest number of sides. More of them could not be told apart, so a solid that asks for more gets this number.
pub const MOST_SIDES: u32 = 64;

/// The recipe of a polyhedron, with the bits of its lengths.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Recipe {
    Tapered {
        along: Along,
        radii: [u32; 2],
        span: u32,
        sides: u32,
    },
    Ring {
        radii: [u32; 2],
        span: u32,
        sides: u32,
    },
    Wedge {
        radii: [u32; 2],
        span: u32,
        sides: u32,
    },
    Read {
        corners: Vec<[u32; 3]>,
        triangles: Vec<[u32; 3]>,
    },
    Scaled {
        of: usize,
        by: [u32; 3],
    },
}

/// The axis of a solid.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Along {
    Y,
    Z,
}

impl Along {
    pub(super) const fn axis(self) -> Vec3 {
        match self {
            Self::Y => Vec3::Y,
            Self::Z => Vec3::Z,
        }
    }

    /// The point at a height on the axis, at a radius from it and an angle from X.
    pub(super) fn point(self, height: f32, radius: f32, angle: f32) -> Vec3 {
        let (sin, cos) = libm::sincosf(angle);
        match self {
            Self::Y => Vec3::new(radius * cos, height, -radius * sin),
            Self::Z => Vec3::new(radius * cos, radius * sin, height),
        }
    }
}
