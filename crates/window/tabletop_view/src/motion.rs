//! Smooth pictures between ticks: drawn shapes lie between the last two ticks, at any frame rate.

use bevy::prelude::*;
use tabletop_geometry::Pose;

/// An object that is farther than this from where it was a tick ago, in units, did not move there but was put there:
/// its speed would be 30 m/s.
const JUMP: f32 = 5.0;

/// The poses of a body at the last two ticks.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub(crate) struct BodyMotion {
    previous: Pose,
    present: Pose,
}

impl BodyMotion {
    /// Of a body that stands here and did not come from anywhere.
    pub fn standing_at(pose: Pose) -> Self {
        Self {
            previous: pose,
            present: pose,
        }
    }

    /// After a tick that has brought the body here.
    pub fn moved_to(self, pose: Pose) -> Self {
        if self.present.location.distance(pose.location) > JUMP {
            return Self::standing_at(pose);
        }
        Self {
            previous: self.present,
            present: pose,
        }
    }

    /// The pose to draw when `fraction` (0..=1) of the next tick has passed: one tick behind it. A body that stands still is
    /// drawn at the same place to the last bit.
    pub fn at(self, fraction: f32) -> Pose {
        if self.previous == self.present {
            return self.present;
        }
        Pose::new(
            self.previous.location.lerp(self.present.location, fraction),
            self.previous
                .rotation
                .slerp(self.present.rotation, fraction),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_is_drawn_between_its_last_two_ticks() {
        let turned = |degrees| Pose::from_degrees(Vec3::X * degrees / 90.0, Vec3::Z * degrees);
        let motion = BodyMotion::standing_at(turned(0.0))
            .moved_to(turned(30.0))
            .moved_to(turned(90.0));
        for (fraction, degrees) in [(0.0, 30.0), (0.5, 60.0), (1.0, 90.0)] {
            let (drawn, expected) = (motion.at(fraction), turned(degrees));
            assert!((drawn.location - expected.location).length() < 1e-5);
            assert!(drawn.rotation.angle_between(expected.rotation) < 1e-3);
        }
    }

    #[test]
    fn a_body_that_stands_still_is_drawn_there() {
        let (from, to) = (Pose::IDENTITY, Pose::at(Vec3::X));
        let motion = BodyMotion::standing_at(from).moved_to(to).moved_to(to);
        assert_eq!(motion.at(0.3).location, Vec3::X);
        let pose = Pose::from_degrees(Vec3::new(0.1, 0.7, 1.3), Vec3::new(10.0, 20.0, 30.0));
        let motion = BodyMotion::standing_at(pose);
        assert!((0..100u8).all(|part| motion.at(f32::from(part) / 100.0) == pose));
    }

    #[test]
    fn a_jump_is_not_drawn_as_a_move() {
        let far = Pose::at(Vec3::X * 10.0);
        let motion = BodyMotion::standing_at(Pose::IDENTITY).moved_to(far);
        assert_eq!(motion.at(0.0), far);
    }
}
