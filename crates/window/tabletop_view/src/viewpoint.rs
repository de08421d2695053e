//! The user's viewpoint and its motions.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use bevy::prelude::*;
use tabletop_core::Table;
use tabletop_geometry::Pose;
use tabletop_user::Steering;

use crate::spans::Spans as _;

/// Greatest elevation in radians: just short of straight up, so that the camera cannot roll over.
const MAX_ELEVATION: f32 = FRAC_PI_2 - 0.01;

/// Farthest from the centre of the table, in units.
const REACH: f32 = 200.0;

/// Nothing that moves the camera at once brings it lower than this, in units above the table's top.
const LOWEST: f32 = 0.25;

/// As near as the camera comes to a point that it approaches, in units.
const NEAREST: f32 = 0.5;

/// A view of the whole table is wider than the table by this factor.
const MARGIN: f32 = 1.15;

/// Height of the view from the front, in units.
const FRONT_HEIGHT: f32 = 3.0;

/// The least and the largest distance of a camera from the centre of its view, in units.
const CENTERED: std::ops::RangeInclusive<f32> = 6.0..=40.0;

/// A camera's location and direction of view, always upright: Z is up in its picture.
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

    /// The same view from the other side.
    pub fn across(table: &Table) -> Self {
        let Self {
            location,
            elevation,
            ..
        } = Self::of_table(table);
        Self {
            location: location.with_y(-location.y),
            heading: PI,
            elevation,
        }
    }

    /// The view of all of a table from above. The picture takes in so much to the right and upwards at a distance of 1.
    pub fn from_above(table: &Table, picture: Vec2) -> Self {
        let distances = table.spans() / 2.0 / picture;
        Self {
            location: Vec3::ZERO,
            heading: 0.0,
            elevation: -MAX_ELEVATION,
        }
        .centered_on(Vec3::ZERO, distances.max_element() * MARGIN)
    }

    /// The level view of all of a table from the user's side.
    pub fn from_front(table: &Table, picture: Vec2) -> Self {
        let from_edge = Vec2::new(table.xspan / 2.0, FRONT_HEIGHT) / picture;
        let distance = table.yspan / 2.0 + from_edge.max_element() * MARGIN;
        Self {
            location: Vec3::new(0.0, -distance, FRONT_HEIGHT),
            heading: 0.0,
            elevation: 0.0,
        }
    }

    /// The view of a camera of this pose, upright.
    pub fn of_camera(pose: Pose) -> Self {
        let direction = pose.rotation * Vec3::NEG_Z;
        let level = direction.truncate().length();
        Self {
            location: pose.location,
            heading: (-direction.x).atan2(direction.y),
            elevation: direction.z.atan2(level),
        }
    }

    /// After turning nothing and going to where a point is in the middle, about as far away as now.
    pub fn centered(self, point: Vec3) -> Self {
        let distance = self.location.distance(point);
        self.centered_on(point, distance.clamp(*CENTERED.start(), *CENTERED.end()))
    }

    fn centered_on(self, point: Vec3, distance: f32) -> Self {
        Self {
            location: point - self.direction() * distance,
            ..self
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

    /// After going round a point, which is seen in the same place then: by this angle about the vertical line through it,
    /// counter-clockwise as seen from above, and as much of the rise above it as limits let it, in radians.
    pub fn orbited(self, center: Vec3, angle: f32, rise: f32) -> Self {
        let rise = self.possible_rise(center, rise);
        let over = Quat::from_axis_angle(self.right(), -rise);
        let around = Quat::from_rotation_z(angle) * over;
        Self {
            location: center + around * (self.location - center),
            heading: self.heading + angle,
            elevation: self.elevation - rise,
        }
    }

    /// As much of a rise as neither turns the camera over nor brings it below the table's top.
    fn possible_rise(self, center: Vec3, rise: f32) -> f32 {
        let tilt = self.elevation - MAX_ELEVATION..=self.elevation + MAX_ELEVATION;
        let rise = rise.clamp(*tilt.start(), *tilt.end());
        // Seen from the side, the camera goes round the centre in a circle, from this angle on.
        let ahead = Quat::from_rotation_z(self.heading) * Vec3::Y;
        let from_center = self.location - center;
        let (level, height) = (-from_center.dot(ahead), from_center.z);
        let lowest = (self.lowest() - center.z) / level.hypot(height);
        if lowest.is_nan() || lowest <= -1.0 {
            return rise;
        }
        let at_lowest = lowest.min(1.0).asin();
        let angle = match height.atan2(level) {
            angle if angle < -FRAC_PI_2 => angle + TAU,
            angle => angle,
        };
        let [least, most] = [at_lowest - angle, PI - at_lowest - angle];
        rise.clamp(least.min(0.0), most.max(0.0))
    }

    /// Nothing below this height can be reached from here by a motion at once.
    fn lowest(self) -> f32 {
        LOWEST.min(self.location.z)
    }

    /// After a shift by a vector, in units.
    pub fn shifted(self, by: Vec3) -> Self {
        let location = self.location + by;
        Self {
            location: location.with_z(location.z.max(self.lowest())),
            ..self
        }
        .within_reach()
    }

    /// After an approach to a point that multiplies the distance by this factor, as far as limits allow; the point is seen in the same
    /// place then.
    pub fn approached(self, point: Vec3, factor: f32) -> Self {
        let from_point = self.location - point;
        let distance = from_point.length();
        let nearest = NEAREST.min(distance);
        let location = point + from_point.normalize_or_zero() * (distance * factor).max(nearest);
        let is_allowed = location.z >= self.lowest()
            && (location.length() <= REACH || location.length() <= self.location.length());
        match is_allowed {
            true => Self { location, ..self },
            false => self,
        }
    }

    /// After being steered for this time, in seconds.
    pub fn steered(self, steering: Steering, seconds: f32) -> Self {
        let velocity = steering.forward * self.direction()
            + steering.right * self.right()
            + steering.up * Vec3::Z;
        let elevation = self.elevation + steering.turn_up * seconds;
        Self {
            location: self.location + velocity * seconds,
            heading: self.heading + steering.turn_left * seconds,
            elevation: elevation.clamp(-MAX_ELEVATION, MAX_ELEVATION),
        }
        .within_reach()
    }

    fn within_reach(self) -> Self {
        Self {
            location: self.location.clamp_length_max(REACH),
            ..self
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
    use proptest::prelude::*;

    fn start() -> Viewpoint {
        Viewpoint::of_table(&Table::default())
    }

    fn assert_near(actual: Vec3, expected: Vec3) {
        assert!(
            (actual - expected).length() < 1e-4,
            "{actual} is not {expected}"
        );
    }

    /// A point in the frame of the camera.
    fn seen_from(viewpoint: Viewpoint, point: Vec3) -> Vec3 {
        viewpoint.rotation().inverse() * (point - viewpoint.location)
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
    fn it_moves_along_its_own_directions() {
        let start = start();
        let moved = |steering| start.steered(steering, 0.5).location - start.location;
        let still = Steering::default();
        let forward = Steering {
            forward: 10.0,
            ..still
        };
        assert_near(moved(forward), 5.0 * start.direction());
        let left = Steering {
            right: -10.0,
            ..still
        };
        assert_near(moved(left), -5.0 * Vec3::X);
        assert_near(moved(Steering { up: 10.0, ..still }), 5.0 * Vec3::Z);
        let both = Steering {
            right: 10.0,
            ..forward
        };
        assert_near(moved(both), 5.0 * (start.direction() + Vec3::X));
    }

    #[test]
    fn it_turns_about_the_vertical_and_stays_upright() {
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
        let orbited = start().orbited(center, FRAC_PI_2, 0.0);
        assert_near(seen_from(orbited, center), seen_from(start(), center));
        assert_near(orbited.location, Vec3::new(16.0, -2.0, 14.0));
        assert_near(orbited.right(), Vec3::Y);
    }

    #[test]
    fn it_rises_above_a_point_and_sinks_no_lower_than_the_table() {
        let risen = start().orbited(Vec3::ZERO, 0.0, 0.3);
        assert!(risen.location.z > 16.0 && risen.elevation < start().elevation);
        let sunk = start().orbited(Vec3::ZERO, 0.0, -3.0);
        assert!((sunk.location.z - LOWEST).abs() < 1e-4, "{sunk:?}");
        assert!(sunk.location.y < -18.0, "{sunk:?}");
        assert_near(seen_from(sunk, Vec3::ZERO), seen_from(start(), Vec3::ZERO));
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
            right: 10.0,
            up: -10.0,
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

    #[test]
    fn it_does_not_get_lost() {
        let away = Steering {
            forward: -10.0,
            ..default()
        };
        assert!(start().steered(away, 1e6).location.length() < REACH + 1.0);
        let far = (0..1000).fold(start(), |viewpoint, _| {
            viewpoint.approached(Vec3::ZERO, 1.2)
        });
        assert!((REACH / 1.3..=REACH).contains(&far.location.length()));
        let near = (0..1000).fold(start(), |viewpoint, _| viewpoint.approached(Vec3::Z, 0.8));
        assert!((near.location.distance(Vec3::Z) - NEAREST).abs() < 1e-3);
    }

    /// The corners of a table's top, from -1 to 1 where they are within the picture.
    fn in_picture(viewpoint: Viewpoint, table: &Table, picture: Vec2) -> [Vec2; 4] {
        let half = table.spans() / 2.0;
        [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|corner| {
            let seen = seen_from(viewpoint, (half * Vec2::from(corner)).extend(0.0));
            assert!(seen.z < 0.0, "it is behind the camera");
            seen.truncate() / -seen.z / picture
        })
    }

    #[test]
    fn views_show_all_of_the_table() {
        for (xspan, yspan) in [(20.0, 12.0), (4.0, 30.0), (60.0, 8.0)] {
            let table = &Table { xspan, yspan };
            for aspect in [0.5, 4.0 / 3.0, 16.0 / 9.0] {
                let picture = Vec2::new(aspect, 1.0) * (PI / 8.0).tan();
                for view in [
                    Viewpoint::from_above(table, picture),
                    Viewpoint::from_front(table, picture),
                ] {
                    for corner in in_picture(view, table, picture) {
                        assert!(corner.x.abs() <= 1.0 && corner.y.abs() <= 1.0, "{corner}");
                    }
                }
            }
        }
    }

    #[test]
    fn it_looks_through_another_camera() {
        let pose = Pose::looking_at(Vec3::new(1.0, -7.0, 11.0), Vec3::new(-2.0, 3.0, 0.0));
        let viewpoint = Viewpoint::of_camera(pose);
        assert_eq!(viewpoint.location, pose.location);
        assert!(viewpoint.rotation().angle_between(pose.rotation) < 1e-3);
    }

    fn any_viewpoint() -> impl Strategy<Value = Viewpoint> {
        let location = [-60.0..60.0_f32, -60.0..60.0, -20.0..60.0];
        (location, -4.0..4.0_f32, -MAX_ELEVATION..MAX_ELEVATION).prop_map(
            |(location, heading, elevation)| Viewpoint {
                location: location.into(),
                heading,
                elevation,
            },
        )
    }

    fn any_point() -> impl Strategy<Value = Vec3> {
        [-20.0..20.0_f32, -20.0..20.0, -4.0..20.0].prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn an_orbit_keeps_the_point_in_its_place_and_the_camera_upright_and_above_the_table(
            start in any_viewpoint(),
            center in any_point(),
            angle in -4.0..4.0_f32,
            rise in -4.0..4.0_f32,
        ) {
            let orbited = start.orbited(center, angle, rise);
            let moved = seen_from(orbited, center) - seen_from(start, center);
            prop_assert!(moved.length() < 1e-3, "{moved}");
            prop_assert!(orbited.elevation.abs() <= MAX_ELEVATION + 1e-5);
            prop_assert!(orbited.location.z >= start.location.z.min(LOWEST) - 1e-3, "{orbited:?}");
        }

        #[test]
        fn an_approach_keeps_the_direction_to_the_point(
            start in any_viewpoint(),
            point in any_point(),
            factor in 0.1..10.0_f32,
        ) {
            let approached = start.approached(point, factor);
            let [before, after] = [start, approached].map(|viewpoint| seen_from(viewpoint, point));
            prop_assume!(before.length() > 0.1);
            prop_assert!(before.normalize().distance(after.normalize()) < 1e-3);
            prop_assert!(after.length() >= NEAREST.min(before.length()) - 1e-3);
        }

        #[test]
        fn a_shift_that_no_limit_ends_moves_everything_alike(
            start in any_viewpoint(),
            point in any_point(),
            by in [-5.0..5.0_f32, -5.0..5.0, 0.0..5.0],
        ) {
            let shifted = start.shifted(by.into());
            let moved = seen_from(shifted, point + Vec3::from(by)) - seen_from(start, point);
            prop_assert!(moved.length() < 1e-3, "{moved}");
        }

        #[test]
        fn centring_keeps_the_direction_of_view(start in any_viewpoint(), point in any_point()) {
            let centered = start.centered(point);
            let seen = seen_from(centered, point);
            prop_assert!(seen.truncate().length() < 1e-2, "{seen}");
            prop_assert!((5.99..40.01).contains(&-seen.z), "{seen}");
            prop_assert_eq!(centered.direction(), start.direction());
        }
    }
}
