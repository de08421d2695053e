//! The light of a picture.

use bevy::math::Vec3;
use tabletop_core::Light;

/// The light of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lighting {
    light: Light,
    /// The smallest share.
    least: f32,
}

impl From<Light> for Lighting {
    fn from(light: Light) -> Self {
        Self {
            light,
            least: light.least(),
        }
    }
}

impl Default for Lighting {
    fn default() -> Self {
        Light::default().into()
    }
}

impl Lighting {
    /// The share of its colour that a surface with this outward unit normal shows.
    #[inline]
    pub fn share(&self, normal: Vec3) -> f32 {
        self.light.share(normal)
    }

    /// A share within those that there are: rounding may bring shares a little beyond those at a triangle's corners.
    #[inline]
    pub fn clamp(&self, share: f32) -> f32 {
        share.max(self.least).min(1.0)
    }

    /// A colour, red, green and blue in 0..=255, in this light.
    pub fn lit(&self, color: Vec3) -> Vec3 {
        (color * self.light.color).min(Vec3::splat(255.0))
    }
}
