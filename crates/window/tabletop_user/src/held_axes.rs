//! The axes through the held object, about which it is turned.

use bevy::prelude::*;

/// The axes that are drawn through the held object (report section 4, figure 8).
#[derive(Clone, Copy, Debug)]
pub struct HeldAxes;

impl HeldAxes {
    /// Their length, in units.
    pub const LENGTH: f32 = 10.0;

    /// Length of the part of an axis, at its arrow, by which it is dragged, in units.
    const GRIP: f32 = 1.0;

    /// Points along the part of an axis by which it is dragged.
    pub fn arrow(center: Vec3, axis: Vec3) -> impl Iterator<Item = Vec3> {
        let points = 0..=10_u8;
        points.map(move |point| {
            let back = Self::GRIP * f32::from(point) / 10.0;
            center + axis * (Self::LENGTH / 2.0 - back)
        })
    }
}
