//! The light of a picture.

use bevy::math::{Vec3, Vec4};
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

    /// The [clamped](Self::clamp) shares of four surfaces, whose normals are given by their parts along X, Y and Z.
    #[inline]
    pub fn four_shares(&self, normals: [Vec4; 3]) -> Vec4 {
        let (along, against) = (self.light.along, self.light.against);
        let [x, y, z] = std::array::from_fn(|axis| {
            let normal = normals[axis];
            let [along, against] = [along, against].map(|shares| Vec4::splat(shares[axis]));
            normal * normal * Vec4::select(normal.cmpgt(Vec4::ZERO), along, against)
        });
        let share = (x + y + z).min(Vec4::ONE);
        share.max(Vec4::splat(self.least)).min(Vec4::ONE)
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
        let part = |axis: usize| Vec4::from_array(normals.map(|normal| normal[axis]));
        let shares = lighting.four_shares([part(0), part(1), part(2)]);
        for (own, normal) in shares.to_array().into_iter().zip(normals) {
            assert_eq!(own, lighting.clamp(lighting.share(normal)), "{normal}");
        }
    }
}
