//! The way of a body in a step in which it touches nothing.

use bevy::prelude::*;
use bevy_rapier3d::rapier::prelude::{Pose, RigidBody};
use tabletop_geometry::turn_about;

/// The way of a body on which nothing but gravity acts. Units: s, and those of the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeFlight {
    centre: Vec3,
    linear: Vec3,
    angular: Vec3,
    pub acceleration: Vec3,
}

impl FreeFlight {
    /// That of a body which stays.
    pub const STILL: Self = Self {
        centre: Vec3::ZERO,
        linear: Vec3::ZERO,
        angular: Vec3::ZERO,
        acceleration: Vec3::ZERO,
    };

    pub fn of(body: &RigidBody, acceleration: Vec3) -> Self {
        Self {
            centre: body.center_of_mass(),
            linear: body.linvel(),
            angular: body.angvel(),
            acceleration,
        }
    }

    /// The pose, after a time, of what is part of the body and has this one at first.
    pub fn pose(&self, first: &Pose, time: f32) -> Pose {
        let turn = self.turn(time);
        let arm = turn * (first.translation - self.centre);
        Pose::from_parts(self.centre_at(time) + arm, turn * first.rotation)
    }

    /// Where a point of the body is at first that is here after a time.
    pub fn first(&self, here: Vec3, time: f32) -> Vec3 {
        self.centre + self.turn(time).inverse() * (here - self.centre_at(time))
    }

    /// The velocity of a point of the body that is here after a time.
    pub fn velocity(&self, here: Vec3, time: f32) -> Vec3 {
        self.linear + self.acceleration * time + self.angular.cross(here - self.centre_at(time))
    }

    /// The way, after a time, from the body's centre of mass to a point of it that is here at first.
    pub fn arm(&self, first: Vec3, time: f32) -> Vec3 {
        self.turn(time) * (first - self.centre)
    }

    fn centre_at(&self, time: f32) -> Vec3 {
        self.centre + self.linear * time + self.acceleration * (0.5 * time * time)
    }

    fn turn(&self, time: f32) -> Quat {
        match self.angular.try_normalize() {
            Some(axis) => turn_about(axis, self.angular.length() * time),
            None => Quat::IDENTITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_on_its_way_comes_from_where_it_was() {
        let way = FreeFlight {
            centre: Vec3::new(1.0, 2.0, 3.0),
            linear: Vec3::new(-20.0, 5.0, 0.0),
            angular: Vec3::new(3.0, -8.0, 1.0),
            acceleration: Vec3::Z * -98.1,
        };
        let first = Pose::from_parts(Vec3::new(1.5, 2.0, 2.0), Quat::from_rotation_x(0.3));
        let point = Vec3::new(0.1, 0.2, -0.3);
        let later = way.pose(&first, 0.01);
        assert!((way.first(later * point, 0.01) - first * point).length() < 1e-5);
        let next = way.pose(&first, 0.01001);
        let velocity = (next * point - later * point) / 1e-5;
        let error = velocity - way.velocity(later * point, 0.01);
        assert!(error.length() < 0.1, "{error}");
    }
}
