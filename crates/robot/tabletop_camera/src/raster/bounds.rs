//! Boxes around drawn shapes.

use bevy::math::{Mat3, Vec3};
use tabletop_geometry::{Pose, Solid};

use crate::{camera::PinholeView, scene::DrawnSolid};

/// The corners of the cuboid around a solid, relative to the eye, numbered as [`CUBOID`](super::face::CUBOID) has them.
pub(crate) fn corners_of_solid(drawn: &DrawnSolid, view: &PinholeView) -> [Vec3; 8] {
    let half = match drawn.solid {
        Solid::Cuboid(span) => span / 2.0,
        Solid::Cylinder { radius, yspan } => Vec3::new(radius, yspan / 2.0, radius),
        Solid::Ball(radius) => Vec3::splat(radius),
        Solid::Polyhedron(ref polyhedron) => Vec3::splat(polyhedron.radius()),
    };
    let center = drawn.pose.location - view.eye;
    let axes = Mat3::from_quat(drawn.pose.rotation);
    std::array::from_fn(|corner| {
        let side = |axis: usize| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
        center + axes * (half * Vec3::new(side(0), side(1), side(2)))
    })
}

/// The corners of a box with these least and largest coordinates in the frame of a body, relative to the eye.
pub(crate) fn corners_of_box(body: Pose, bounds: [Vec3; 2], view: &PinholeView) -> [Vec3; 8] {
    std::array::from_fn(|corner| {
        let coordinate = |axis: usize| bounds[corner >> axis & 1][axis];
        body * Vec3::new(coordinate(0), coordinate(1), coordinate(2)) - view.eye
    })
}
