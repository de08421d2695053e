//! Colours as numbers of 0..=255, and rounded to bytes.

use bevy::math::Vec3;
use tabletop_geometry::Rgb;

/// A colour as numbers of 0..=255.
pub(crate) fn scaled_to_bytes(color: Rgb) -> Vec3 {
    Vec3::new(color.red, color.green, color.blue).clamp(Vec3::ZERO, Vec3::ONE) * 255.0
}

/// The nearest bytes to numbers of 0..=255.
pub(crate) fn nearest_bytes(shown: Vec3) -> [u8; 3] {
    shown.to_array().map(|part| nearest_byte(part) as u8)
}

/// The nearest whole number to one of 0..=255.
pub(crate) fn nearest_byte(number: f32) -> u32 {
    // From 2^23 on there are only whole numbers, and the last bits of such a number count them.
    const WHOLE: f32 = 8_388_608.0;
    (number + WHOLE).to_bits() & 0xff
}
