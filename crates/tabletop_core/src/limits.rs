//! What numbers of scenes may be, in task files and in recordings.

use std::ops::RangeInclusive;

/// Extents, radii and thicknesses, in units.
pub const SPANS: RangeInclusive<f32> = 0.001..=1000.0;

/// Masses, in kg.
pub const MASSES: RangeInclusive<f32> = 0.0..=1e6;

/// Paddings of links, in units.
pub const PADDINGS: RangeInclusive<f32> = 0.0..=1000.0;

/// How far joints slide, in units.
pub const DISPLACEMENTS: RangeInclusive<f32> = -1000.0..=1000.0;

/// Shares of a whole.
pub const PROPORTIONS: RangeInclusive<f32> = 0.0..=1.0;

/// How far the blocks of a switch are turned, in degrees.
pub const SWITCH_ANGLES: RangeInclusive<f32> = 0.0..=80.0;

/// Most links of a chain.
pub const MOST_LINKS: u32 = 1000;
