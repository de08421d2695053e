//! Boxes around drawn shapes.

use bevy::math::{Mat3, Vec3, Vec4};
use tabletop_geometry::{Pose, Solid};

use crate::{
    camera::{FourTurned, FourVectors, PinholeView},
    scene::DrawnSolid,
};

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
pub(crate) fn corners_of_box(
    body: Pose,
    [least, most]: [Vec3; 2],
    view: &PinholeView,
) -> [FourVectors; 2] {
    let turned = FourTurned::by(body.rotation);
    let origin = FourVectors::splat(body.location - view.eye);
    [least.z, most.z].map(|z| {
        let corners = FourVectors {
            x: Vec4::new(least.x, most.x, least.x, most.x),
            y: Vec4::new(least.y, least.y, most.y, most.y),
            z: Vec4::splat(z),
        };
        turned.apply(corners) + origin
    })
}
