//! The wheel of the mouse, and two fingers on a touchpad.

use bevy::input::mouse::{MouseScrollUnit, MouseWheel};

/// The turn of the wheel, in notches.
pub(crate) fn notches(wheel: &MouseWheel) -> f32 {
    match wheel.unit {
        MouseScrollUnit::Line => wheel.y,
        MouseScrollUnit::Pixel => wheel.y / MouseScrollUnit::SCROLL_UNIT_CONVERSION_FACTOR,
    }
}
