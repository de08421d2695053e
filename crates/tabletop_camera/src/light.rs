//! The light of the original program, worked out in display values: no gamma, no highlights, no shadows. The same formula
//! lights the window (`tabletop_view`, `surface.wgsl`).

use bevy::math::Vec3;

/// What every surface shows of its colour.
pub(crate) const AMBIENT: f32 = 0.8;

/// Where the one white lamp hangs, in units.
pub(crate) const LAMP: Vec3 = Vec3::new(0.0, 0.0, 10.0);

/// As far as the lamp reaches, in units; its light falls off linearly.
const RANGE: f32 = 50.0;

/// Nothing counts as nearer to the lamp than this, in units.
const NEAREST: f32 = 1e-6;

/// The factor of a colour where `height` is how far the lamp is above the surface's tangential plane, in units, and
/// `to_lamp` leads from the surface to the lamp.
pub(crate) fn light(height: f32, to_lamp: Vec3) -> f32 {
    // The cosine height / distance times the fall-off 1 - distance / RANGE.
    let distance = to_lamp.length().max(NEAREST);
    AMBIENT + height.max(0.0) * (1.0 / distance - 1.0 / RANGE).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_what_the_formula_says() {
        let below = |distance: f32| light(distance, Vec3::Z * distance);
        assert!((below(10.0) - (0.8 + 0.8)).abs() < 1e-6);
        assert!((below(40.0) - (0.8 + 0.2)).abs() < 1e-6);
        assert_eq!(below(60.0), 0.8);
        let slanted = light(6.0, Vec3::new(8.0, 0.0, 6.0));
        assert!((slanted - (0.8 + 0.6 * 0.8)).abs() < 1e-6);
        assert_eq!(light(-6.0, Vec3::new(8.0, 0.0, -6.0)), 0.8);
        assert!(light(0.0, Vec3::ZERO).is_finite());
    }
}
