//! Where the user stands and looks, and how that changes.

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use tabletop_core::Table;

/// Speed in units a second.
const SPEED: f32 = 10.0;

/// Turning speed in radians a second.
const TURN: f32 = 1.0;

/// Greatest elevation in radians: just short of straight up, so that the camera cannot roll over.
const MAX_ELEVATION: f32 = FRAC_PI_2 - 0.01;

/// Where a camera stands and looks, always upright: Z is up in its picture.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[require(Transform)]
pub struct Viewpoint {
    /// Its location in units.
    pub location: Vec3,
    /// Direction of view about the Z axis in radians: 0 looks along Y, positive values turn to the left.
    pub heading: f32,
    /// Direction of view above the horizon in radians.
    pub elevation: f32,
}

/// What the user wants the camera to do: each part is -1, 0 or 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steering {
    /// Along the direction of view.
    pub forward: f32,
    /// To the right.
    pub right: f32,
    /// Along the world's Z.
    pub up: f32,
    /// Turn left, about the world's Z.
    pub turn_left: f32,
    /// Turn up, about the camera's side axis.
    pub turn_up: f32,
}

impl Viewpoint {
    /// The view of a table from the user's side, looking at its centre.
    pub fn of_table(table: &Table) -> Self {
        let location = Vec3::new(0.0, -(table.yspan / 2.0 + 6.0), 14.0);
        Self {
            location,
            heading: 0.0,
            elevation: -(location.z / -location.y).atan(),
        }
    }

    /// The direction of view, of unit length.
    pub fn direction(self) -> Vec3 {
        self.rotation() * Vec3::NEG_Z
    }

    /// The direction to the right in the picture, of unit length; always level.
    pub fn right(self) -> Vec3 {
        self.rotation() * Vec3::X
    }

    /// The orientation of the camera, which looks along its own -Z.
    pub fn rotation(self) -> Quat {
        Quat::from_rotation_z(self.heading) * Quat::from_rotation_x(FRAC_PI_2 + self.elevation)
    }

    /// After going round the vertical line through a point by so many radians, counter-clockwise as seen from above.
    pub fn orbited(self, center: Vec3, angle: f32) -> Self {
        let around = Quat::from_rotation_z(angle);
        Self {
            location: center + around * (self.location - center),
            heading: self.heading + angle,
            ..self
        }
    }

    /// After so many seconds of being steered.
    pub fn steered(self, steering: Steering, seconds: f32) -> Self {
        let direction = steering.forward * self.direction()
            + steering.right * self.right()
            + steering.up * Vec3::Z;
        let elevation = self.elevation + steering.turn_up * TURN * seconds;
        Self {
            location: self.location + direction * SPEED * seconds,
            heading: self.heading + steering.turn_left * TURN * seconds,
            elevation: elevation.clamp(-MAX_ELEVATION, MAX_ELEVATION),
        }
    }
}

impl From<Viewpoint> for Transform {
    fn from(viewpoint: Viewpoint) -> Self {
        Self::from_translation(viewpoint.location).with_rotation(viewpoint.rotation())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start() -> Viewpoint {
        Viewpoint::of_table(&Table::default())
    }

    fn assert_near(actual: Vec3, expected: Vec3) {
        assert!(
            (actual - expected).length() < 1e-4,
            "{actual} is not {expected}"
        );
    }

    #[test]
    fn it_starts_looking_at_the_centre_with_z_up() {
        let start = start();
        assert_eq!(start.location, Vec3::new(0.0, -12.0, 14.0));
        assert_near(start.direction(), -start.location.normalize());
        assert_near(start.right(), Vec3::X);
        assert!((start.rotation() * Vec3::Y).z > 0.0);
    }

    #[test]
    fn it_moves_ten_units_a_second_along_its_own_directions() {
        let start = start();
        let moved = |steering| start.steered(steering, 0.5).location - start.location;
        let still = Steering::default();
        let forward = Steering {
            forward: 1.0,
            ..still
        };
        assert_near(moved(forward), 5.0 * start.direction());
        assert_near(
            moved(Steering {
                right: -1.0,
                ..still
            }),
            -5.0 * Vec3::X,
        );
        assert_near(moved(Steering { up: 1.0, ..still }), 5.0 * Vec3::Z);
        let both = Steering {
            right: 1.0,
            ..forward
        };
        assert_near(moved(both), 5.0 * (start.direction() + Vec3::X));
    }

    #[test]
    fn it_turns_a_radian_a_second_about_the_vertical_and_stays_upright() {
        let left = Steering {
            turn_left: 1.0,
            ..default()
        };
        let turned = start().steered(left, FRAC_PI_2);
        let level = turned.direction().with_z(0.0).normalize();
        assert_near(level, Vec3::NEG_X);
        assert_near(turned.right(), Vec3::Y);
        assert_eq!(turned.location, start().location);
    }

    #[test]
    fn it_goes_round_a_point_and_sees_it_in_the_same_place() {
        let center = Vec3::new(3.0, 1.0, 5.0);
        let seen_from =
            |viewpoint: Viewpoint| viewpoint.rotation().inverse() * (center - viewpoint.location);
        let orbited = start().orbited(center, FRAC_PI_2);
        assert_near(seen_from(orbited), seen_from(start()));
        assert_near(orbited.location, Vec3::new(16.0, -2.0, 14.0));
        assert_near(orbited.right(), Vec3::Y);
    }

    #[test]
    fn it_cannot_roll_over() {
        for turn_up in [1.0, -1.0] {
            let steering = Steering {
                turn_up,
                ..default()
            };
            let turned = start().steered(steering, 100.0);
            assert!(turned.direction().z * turn_up > 0.999);
            assert!(
                (turned.rotation() * Vec3::Y).z > 0.0,
                "it stands on its head"
            );
        }
    }

    #[test]
    fn many_short_frames_lead_where_few_long_ones_do() {
        let steering = Steering {
            right: 1.0,
            up: -1.0,
            turn_up: 1.0,
            ..default()
        };
        let after = |frames: u16| {
            (0..frames).fold(start(), |viewpoint, _| {
                viewpoint.steered(steering, 1.0 / f32::from(frames))
            })
        };
        let (few, many) = (after(10), after(1000));
        assert!(few.location.distance(many.location) < 1e-3);
        assert!((few.elevation - many.elevation).abs() < 1e-3);
    }
}
