//! The light of a picture.

use bevy::math::{Vec3, Vec4};
use tabletop_core::Light;

use crate::camera::FourVectors;

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

    /// The [clamped](Self::clamp) shares of four surfaces with these normals.
    #[inline]
    pub fn four_shares(&self, normals: FourVectors) -> Vec4 {
        let part = |normal: Vec4, along: f32, against: f32| {
            let (along, against) = (Vec4::splat(along), Vec4::splat(against));
            normal * normal * Vec4::select(normal.cmpgt(Vec4::ZERO), along, against)
        };
        let Light { along, against, .. } = self.light;
        let x = part(normals.x, along.x, against.x);
        let y = part(normals.y, along.y, against.y);
        let z = part(normals.z, along.z, against.z);
        let share = (x + y + z).min(Vec4::ONE);
        share.max(Vec4::splat(self.least)).min(Vec4::ONE)
    }

    /// A share within those that there are: rounding may bring shares a little beyond those at a triangle's corners.
    #[inline]
    pub fn clamp(&self, share: f32) -> f32 {
        share.max(self.least).min(1.0)
    }

    /// [Clamps](Self::clamp) four shares.
    #[inline]
    pub fn clamp_four(&self, shares: Vec4) -> Vec4 {
        let least = Vec4::splat(self.least);
        // Of a number and NaN, processors choose differently.
        Vec4::select(shares.cmpgt(least), shares, least).min(Vec4::ONE)
    }

    /// A colour, red, green and blue in 0..=255, in this light.
    pub fn lit(&self, color: Vec3) -> Vec3 {
        (color * self.light.color).min(Vec3::splat(255.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_shares_are_those_of_each() {
        let lighting = Lighting::default();
        let normals = [
            Vec3::NEG_Y,
            Vec3::Z,
            Vec3::new(0.3, -0.7, 0.2).normalize(),
            Vec3::splat(-1.0).normalize(),
        ];
        let each = normals.map(|normal| normal.extend(0.0));
        let shares = lighting.four_shares(FourVectors::of_each(each));
        for (own, normal) in shares.to_array().into_iter().zip(normals) {
            assert_eq!(own, lighting.clamp(lighting.share(normal)), "{normal}");
        }
    }
}
