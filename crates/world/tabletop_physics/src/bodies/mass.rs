//! Mass and inertia of objects.

use bevy::{
    math::{DMat3, DVec3},
    prelude::*,
};
use bevy_rapier3d::{prelude::MassProperties, rapier};
use tabletop_core::Shape;
use tabletop_geometry::{Primitive, Solid};

/// Mass properties of a shape that weighs `mass` kg: the centre of mass is its origin with any parts
/// (report section 6.2, `<composite>`), and the inertia about it is that of its parts, all of one density.
pub fn mass_properties(shape: &Shape, mass: f32) -> MassProperties {
    let primitives = shape.colliding();
    let volume: f64 = primitives
        .iter()
        .map(|primitive| f64::from(primitive.solid.volume()))
        .sum();
    let inertia: DMat3 = primitives
        .iter()
        .map(|primitive| {
            let share = f64::from(mass) * f64::from(primitive.solid.volume()) / volume;
            share * inertia_per_kg(primitive)
        })
        .sum();
    MassProperties::from_rapier(rapier::dynamics::MassProperties::with_inertia_matrix(
        Vec3::ZERO,
        mass,
        inertia.as_mat3(),
    ))
}

fn outer_product(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// The inertia of a solid about the origin of its shape, in the shape's axes, for a mass of 1 kg.
fn inertia_per_kg(primitive: &Primitive) -> DMat3 {
    let orientation = DMat3::from_quat(primitive.pose.rotation.as_dquat());
    let offset = primitive.pose.location.as_dvec3();
    let about_center = |moments: Vec3| {
        let own = DMat3::from_diagonal(moments.as_dvec3());
        let shift =
            DMat3::from_diagonal(DVec3::splat(offset.length_squared())) - outer_product(offset);
        orientation * own * orientation.transpose() + shift
    };
    match primitive.solid {
        Solid::Cuboid(span) => {
            let square = span * span;
            let moments = Vec3::new(
                square.y + square.z,
                square.x + square.z,
                square.x + square.y,
            );
            about_center(moments / 12.0)
        }
        Solid::Cylinder { radius, yspan } => {
            let across = radius * radius / 4.0 + yspan * yspan / 12.0;
            about_center(Vec3::new(across, radius * radius / 2.0, across))
        }
        Solid::Ball(radius) => about_center(Vec3::splat(0.4 * radius * radius)),
        Solid::Polyhedron(ref polyhedron) => {
            let faces = polyhedron
                .faces()
                .map(|face| face.map(|corner| orientation * corner.as_dvec3() + offset));
            inertia_of_faces(faces)
        }
    }
}

/// The inertia about the origin of the solid within these triangles, for a mass of 1 kg.
fn inertia_of_faces(faces: impl Iterator<Item = [DVec3; 3]>) -> DMat3 {
    let (mut volume, mut moment) = (0.0, DMat3::ZERO);
    for [a, b, c] in faces {
        // The tetrahedron from the origin to the triangle: means of its products of coordinates.
        let part = a.dot(b.cross(c)) / 6.0;
        let sum = a + b + c;
        let corners = [a, b, c, sum].map(outer_product);
        let [a, b, c, sum] = corners;
        volume += part;
        moment += (a + b + c + sum) * (part / 20.0);
    }
    let moment = moment * (1.0 / volume);
    let trace = moment.x_axis.x + moment.y_axis.y + moment.z_axis.z;
    DMat3::from_diagonal(DVec3::splat(trace)) - moment
}

#[cfg(test)]
mod tests {
    use tabletop_core::Part;
    use tabletop_geometry::{Pose, Rgb};

    use super::*;

    const COLOR: Rgb = Rgb::GRAY;

    fn block(span: Vec3) -> Shape {
        Shape::Block { span, color: COLOR }
    }

    fn sorted(inertia: Vec3) -> Vec3 {
        let mut moments = inertia.to_array();
        moments.sort_by(f32::total_cmp);
        moments.into()
    }

    #[test]
    fn a_block_has_the_textbook_inertia() {
        let properties = mass_properties(&block(Vec3::new(1.0, 2.0, 3.0)), 12.0);
        assert_eq!(properties.mass, 12.0);
        assert_eq!(properties.local_center_of_mass, Vec3::ZERO);
        let moments = sorted(properties.principal_inertia);
        assert!(
            (moments - Vec3::new(5.0, 10.0, 13.0)).length() < 1e-4,
            "{moments}"
        );
    }

    #[test]
    fn polyhedra_have_the_inertia_of_the_shapes_they_stand_for() {
        let square = Shape::Frustum {
            radius_top: std::f32::consts::SQRT_2,
            radius_bottom: std::f32::consts::SQRT_2,
            zspan: 3.0,
            sides: 4,
            color: COLOR,
        };
        let [square, same] = [square, block(Vec3::new(2.0, 2.0, 3.0))]
            .map(|shape| sorted(mass_properties(&shape, 3.0).principal_inertia));
        assert!((square - same).length() < 1e-3, "{square} {same}");
        let ring = Shape::Ring {
            radius_outer: 2.0,
            radius_inner: 1.0,
            zspan: 0.5,
            sides: 64,
            color: COLOR,
        };
        let ring = sorted(mass_properties(&ring, 1.0).principal_inertia);
        let across = 5.0 / 4.0 + 0.25 / 12.0;
        let expected = Vec3::new(across, across, 2.5);
        assert!((ring - expected).length() < 0.02, "{ring} {expected}");
    }

    #[test]
    fn two_half_blocks_weigh_and_turn_like_the_whole() {
        let half = |x: f32| Part {
            pointable: false,
            id: String::new(),
            pose: Pose::from_degrees(Vec3::X * x, Vec3::new(0.0, 90.0, 0.0)),
            shape: block(Vec3::new(3.0, 2.0, 0.5)),
        };
        let halves = Shape::Composite {
            parts: vec![half(-0.25), half(0.25)],
        };
        let whole = mass_properties(&block(Vec3::new(1.0, 2.0, 3.0)), 5.0);
        let parts = mass_properties(&halves, 5.0);
        assert!(
            (sorted(whole.principal_inertia) - sorted(parts.principal_inertia)).length() < 1e-4
        );
    }

    #[test]
    fn the_reference_point_is_the_centre_of_mass_even_outside_the_parts() {
        let shape = Shape::Composite {
            parts: vec![Part {
                pointable: false,
                id: String::new(),
                pose: Pose::at(Vec3::X * 2.0),
                shape: Shape::Sphere {
                    radius: 1.0,
                    color: COLOR,
                },
            }],
        };
        let properties = mass_properties(&shape, 1.0);
        assert_eq!(properties.local_center_of_mass, Vec3::ZERO);
        let moments = sorted(properties.principal_inertia);
        assert!(
            (moments - Vec3::new(0.4, 4.4, 4.4)).length() < 1e-4,
            "{moments}"
        );
    }
}
