//! Rigid bodies: what physics makes of an object and of the table.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{ObjectSpec, Pose, Primitive, Shape, Solid, Table, Twist};

use crate::{PhysicsSettings, mass::mass_properties};

/// Speeds below which an object falls asleep after half a second: 0.02 m/s and 0.2 rad/s.
const SLEEP_THRESHOLDS: Sleeping = Sleeping {
    normalized_linear_threshold: 0.02,
    angular_threshold: 0.2,
    sleeping: false,
};

/// How far ahead of a fast body its contacts are looked for, in units: more than it moves in a tick after a fall of 100 units.
const SOFT_CCD_PREDICTION: f32 = 3.0;

/// The components of an object's body.
pub(crate) fn add_object(world: &mut World, object: Entity, spec: &ObjectSpec) {
    let settings = *world.resource::<PhysicsSettings>();
    let mut body = world.entity_mut(object);
    body.insert_if_new((
        collider(&spec.shape),
        surface(&settings),
        Velocity::default(),
        Twist::default(),
    ));
    if spec.is_fixed() {
        body.insert_if_new(RigidBody::Fixed);
        return;
    }
    body.insert_if_new((
        RigidBody::Dynamic,
        ColliderMassProperties::MassProperties(mass_properties(&spec.shape, spec.mass)),
        Ccd::enabled(),
        SoftCcd {
            prediction: SOFT_CCD_PREDICTION,
        },
        Damping {
            linear_damping: 0.0,
            angular_damping: match spec.shape {
                Shape::Cylinder { .. } | Shape::Sphere { .. } => settings.rolling_damping,
                Shape::Link { .. } => settings.link_damping,
                _ => settings.angular_damping,
            },
        },
        if settings.sleep {
            SLEEP_THRESHOLDS
        } else {
            Sleeping::disabled()
        },
    ));
}

/// The components of the table's body.
pub(crate) fn add_table(world: &mut World, table: Entity, size: Table) {
    let surface = surface(world.resource::<PhysicsSettings>());
    world
        .entity_mut(table)
        .insert_if_new((RigidBody::Fixed, compound(&[size.slab()]), surface));
}

fn surface(settings: &PhysicsSettings) -> impl Bundle + use<> {
    (
        Friction {
            coefficient: settings.friction,
            combine_rule: CoefficientCombineRule::Multiply,
        },
        Restitution {
            coefficient: settings.restitution,
            combine_rule: CoefficientCombineRule::Average,
        },
    )
}

/// The collider of a whole shape, in the shape's frame.
pub fn collider(shape: &Shape) -> Collider {
    match shape.colliding().as_slice() {
        [only] if only.pose == Pose::IDENTITY => solid_collider(only.solid),
        parts => compound(parts),
    }
}

fn compound(parts: &[Primitive]) -> Collider {
    let parts = parts.iter().map(|part| {
        let Pose { location, rotation } = part.pose;
        (location, rotation, solid_collider(part.solid))
    });
    Collider::compound(parts.collect())
}

fn solid_collider(solid: Solid) -> Collider {
    match solid {
        Solid::Cuboid(span) => Collider::cuboid(span.x / 2.0, span.y / 2.0, span.z / 2.0),
        Solid::Cylinder { radius, yspan } => {
            prism(radius, yspan).unwrap_or_else(|| Collider::cylinder(yspan / 2.0, radius))
        }
        Solid::Ball(radius) => Collider::ball(radius),
    }
}

/// A prism that stands in for a cylinder, its facets on the cylinder's surface. Rapier's own cylinder never comes to rest
/// on its side: inexact contact normals drive it on at some 0.2 units/s.
fn prism(radius: f32, yspan: f32) -> Option<Collider> {
    const SIDES: u32 = 32;
    let half_angle = std::f32::consts::PI / SIDES as f32;
    let corner_radius = radius / half_angle.cos();
    let corners = [-yspan / 2.0, yspan / 2.0]
        .into_iter()
        .flat_map(|y| {
            (0..SIDES).map(move |side| {
                let (sin, cos) = ((2 * side + 1) as f32 * half_angle).sin_cos();
                Vec3::new(cos * corner_radius, y, sin * corner_radius)
            })
        })
        .collect();
    let sides = (0..SIDES).flat_map(|side| {
        let next = (side + 1) % SIDES;
        let [low, low_next, high, high_next] = [side, next, SIDES + side, SIDES + next];
        [[low, high, low_next], [low_next, high, high_next]]
    });
    let ends = (1..SIDES - 1)
        .flat_map(|side| [[0, side, side + 1], [SIDES, SIDES + side + 1, SIDES + side]]);
    Collider::convex_mesh(corners, &sides.chain(ends).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prism_stands_in_for_every_size_of_cylinder() {
        for (radius, yspan) in [(0.5, 1.0), (0.001, 1000.0), (1000.0, 0.001), (0.35, 5.0)] {
            let prism = prism(radius, yspan);
            let collider = prism.unwrap_or_else(|| panic!("no prism for {radius} x {yspan}"));
            let bounds = collider.raw.compute_local_aabb();
            assert!((bounds.maxs.z / radius - 1.0).abs() < 1e-3, "{bounds:?}");
            assert!(
                (bounds.maxs.y * 2.0 / yspan - 1.0).abs() < 1e-3,
                "{bounds:?}"
            );
        }
    }
}
