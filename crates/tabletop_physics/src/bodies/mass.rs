//! Mass and inertia of objects.

use bevy::{math::DMat3, prelude::*};
use bevy_rapier3d::{prelude::MassProperties, rapier};
use tabletop_core::{Shape, Solid};

/// Mass properties of a shape that weighs `mass` kg: the centre of mass is its origin whatever its parts are
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
            let orientation = DMat3::from_quat(primitive.pose.rotation.as_dquat());
            let offset = primitive.pose.location.as_dvec3();
            let own = DMat3::from_diagonal(inertia_per_kg(primitive.solid).as_dvec3());
            let shift = DMat3::from_diagonal(bevy::math::DVec3::splat(offset.length_squared()))
                - outer_product(offset);
            share * (orientation * own * orientation.transpose() + shift)
        })
        .sum();
    MassProperties::from_rapier(rapier::dynamics::MassProperties::with_inertia_matrix(
        Vec3::ZERO,
        mass,
        inertia.as_mat3(),
    ))
}

fn outer_product(v: bevy::math::DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// Principal moments of inertia about a solid's centre, in its own axes, for a mass of 1 kg.
fn inertia_per_kg(solid: Solid) -> Vec3 {
    match solid {
        Solid::Cuboid(span) => {
            let square = span * span;
            Vec3::new(
                square.y + square.z,
                square.x + square.z,
                square.x + square.y,
            ) / 12.0
        }
        Solid::Cylinder { radius, yspan } => {
            let across = radius * radius / 4.0 + yspan * yspan / 12.0;
            Vec3::new(across, radius * radius / 2.0, across)
        }
        Solid::Ball(radius) => Vec3::splat(0.4 * radius * radius),
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Part, Pose, Rgb};

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
