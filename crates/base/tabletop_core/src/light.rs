//! Light: the share of its colour that a surface shows, in the window and in the head camera alike.

use bevy::{math::Vec3, prelude::Reflect};
use serde::{Deserialize, Serialize};

/// The light of the scene, in display values: no lamp, no shadows, no highlights, no gamma. The share of its colour that a surface
/// shows depends only on the direction in which it faces. A surface that faces up shows its full colour.
///
/// ```
/// use bevy::math::Vec3;
/// use tabletop_core::LIGHT;
///
/// assert_eq!(LIGHT.share(Vec3::Z), 1.0);
/// assert_eq!(LIGHT.share(Vec3::NEG_Y), 0.8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct Light {
    /// Shares of surfaces that face along X (right), Y (away from the user) and Z (up).
    pub along: Vec3,
    /// Shares of surfaces that face the other way: left, towards the user, down.
    pub against: Vec3,
    /// Its red, green and blue, by which the colours of surfaces are multiplied. Nothing gets brighter than white.
    pub color: Vec3,
}

/// The light of every scene, but for cameras that are given [another](crate::HeadCamera::light). As in the original program, the sides
/// that the user and the robot see first show 80 %. The others
/// differ from them, so that edges are visible.
pub const LIGHT: Light = Light {
    along: Vec3::new(0.9, 0.85, 1.0),
    against: Vec3::new(0.7, 0.8, 0.6),
    color: Vec3::ONE,
};

impl Default for Light {
    /// [`LIGHT`].
    fn default() -> Self {
        LIGHT
    }
}

impl Light {
    /// The largest part of its colour.
    const BRIGHTEST: f32 = 4.0;

    /// The fault of a light that cannot be.
    pub fn fault(&self) -> Option<String> {
        let is_within =
            |part: Vec3, most| part.to_array().iter().all(|it| (0.0..=most).contains(it));
        if !is_within(self.along, 1.0) || !is_within(self.against, 1.0) {
            return Some(
                "light: a surface cannot show less than nothing or more than all of its colour"
                    .into(),
            );
        }
        (!is_within(self.color, Self::BRIGHTEST))
            .then(|| format!("light: its color is not within 0 and {}", Self::BRIGHTEST))
    }

    /// The share of its colour, at most 1, that a surface with this outward unit normal shows: the mean of the shares along the
    /// axes, weighted by the squares of the normal's components, so that round surfaces look smooth.
    #[inline]
    pub fn share(&self, normal: Vec3) -> f32 {
        let shares = Vec3::select(normal.cmpgt(Vec3::ZERO), self.along, self.against);
        (normal * normal).dot(shares).min(1.0)
    }

    /// The smallest share.
    pub const fn least(&self) -> f32 {
        let (along, against) = (self.along, self.against);
        let least = along.x.min(along.y).min(along.z);
        least.min(against.x).min(against.y).min(against.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn each_side_of_a_block_differs_from_its_neighbours() {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let sides = axes.into_iter().flat_map(|axis| [axis, -axis]);
        for (one, other) in sides
            .clone()
            .flat_map(|one| sides.clone().map(move |o| (one, o)))
        {
            if one.dot(other) == 0.0 {
                assert!(
                    (LIGHT.share(one) - LIGHT.share(other)).abs() > 0.04,
                    "{one} {other}"
                );
            }
        }
    }

    #[test]
    fn a_light_that_cannot_be_has_a_fault() {
        assert_eq!(LIGHT.fault(), None);
        let too_bright = Light {
            color: Vec3::splat(5.0),
            ..LIGHT
        };
        assert!(
            too_bright
                .fault()
                .is_some_and(|fault| fault.contains("color"))
        );
        for along in [Vec3::splat(1.1), Vec3::NAN, Vec3::NEG_X] {
            assert!(Light { along, ..LIGHT }.fault().is_some(), "{along}");
        }
    }

    proptest! {
        #[test]
        fn no_surface_shows_more_than_its_colour_or_less_than_the_least_share(
            direction in [-1.0..1.0_f32, -1.0..1.0, -1.0..1.0],
        ) {
            let normal = Vec3::from(direction).normalize_or(Vec3::Z);
            let share = LIGHT.share(normal);
            prop_assert!((LIGHT.least() - 1e-6..=1.0).contains(&share), "{share}");
        }

        #[test]
        fn surfaces_that_face_nearly_the_same_way_look_nearly_the_same(
            direction in [-1.0..1.0_f32, -1.0..1.0, -1.0..1.0],
            step in [-1e-3..1e-3_f32, -1e-3..1e-3, -1e-3..1e-3],
        ) {
            let normal = Vec3::from(direction).normalize_or(Vec3::Z);
            let beside = (normal + Vec3::from(step)).normalize();
            prop_assert!((LIGHT.share(normal) - LIGHT.share(beside)).abs() < 2e-3);
        }
    }
}
