//! Places on the table, in words.

use bevy::math::Vec3;

/// A location on the table, in words.
pub(crate) fn spot(location: Vec3) -> String {
    let short = |x: f32| {
        let rounded = (x * 10.0).round() / 10.0 + 0.0;
        format!("{rounded}")
    };
    format!("({}, {})", short(location.x), short(location.y))
}
