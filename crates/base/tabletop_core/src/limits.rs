//! Limits on the numbers of scenes, in task files and recordings.

use std::ops::RangeInclusive;

/// Extents, radii and thicknesses, in units.
pub const SPANS: RangeInclusive<f32> = 0.001..=1000.0;

/// Masses, in kg.
pub const MASSES: RangeInclusive<f32> = 0.0..=1e6;

/// Paddings of links, in units.
pub const PADDINGS: RangeInclusive<f32> = 0.0..=1000.0;

/// Displacements of sliding joints, in units.
pub const DISPLACEMENTS: RangeInclusive<f32> = -1000.0..=1000.0;

/// Proportions of a whole.
pub const PROPORTIONS: RangeInclusive<f32> = 0.0..=1.0;

/// Angles of a switch's blocks, in degrees.
pub const SWITCH_ANGLES: RangeInclusive<f32> = 0.0..=80.0;

/// How far caps of push buttons go down, in units.
pub const TRAVELS: RangeInclusive<f32> = 0.01..=10.0;

/// Forces, in newtons, that can be needed to press the cap of a push button down.
pub const PRESSING_FORCES: RangeInclusive<f32> = 0.1..=1000.0;

/// Springs of push buttons, in kg/s².
pub const STIFFNESSES: RangeInclusive<f32> = 0.0..=1e8;

/// Largest number of links of a chain.
pub const MOST_LINKS: u32 = 1000;
