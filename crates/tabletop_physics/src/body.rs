//! Rigid bodies: what physics makes of an object and of the table.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{ObjectSpec, Shape, Solid, Table};

use crate::{PhysicsSettings, mass::mass_properties};

/// Speeds below which an object may fall asleep: linear in lengths of 1 m a second, angular in rad/s.
const SLEEP_THRESHOLDS: (f32, f32) = (0.005, 0.05);

/// Gives every object its body as soon as it appears.
pub(crate) fn add_body(
    add: On<Add, ObjectSpec>,
    objects: Query<&ObjectSpec>,
    settings: Res<PhysicsSettings>,
    mut commands: Commands,
) -> Result {
    let spec = objects.get(add.entity)?;
    let mut body = commands.entity(add.entity);
    body.insert((collider(&spec.shape), surface(&settings)));
    if spec.is_fixed() {
        body.insert(RigidBody::Fixed);
        return Ok(());
    }
    body.insert((
        RigidBody::Dynamic,
        ColliderMassProperties::MassProperties(mass_properties(&spec.shape, spec.mass)),
        Velocity::default(),
        Ccd::enabled(),
        Damping {
            linear_damping: 0.0,
            angular_damping: match spec.shape {
                Shape::Link { .. } => settings.link_damping,
                _ => settings.angular_damping,
            },
        },
        if settings.sleep {
            Sleeping {
                normalized_linear_threshold: SLEEP_THRESHOLDS.0,
                angular_threshold: SLEEP_THRESHOLDS.1,
                sleeping: false,
            }
        } else {
            Sleeping::disabled()
        },
    ));
    Ok(())
}

/// Gives the table its body as soon as it appears.
pub(crate) fn add_table(
    add: On<Add, Table>,
    tables: Query<&Table>,
    settings: Res<PhysicsSettings>,
    mut commands: Commands,
) -> Result {
    let table = tables.get(add.entity)?;
    let slab = Solid::Cuboid(Vec3::new(table.xspan, table.yspan, Table::THICKNESS));
    let below = Vec3::NEG_Z * Table::THICKNESS / 2.0;
    commands.entity(add.entity).insert((
        RigidBody::Fixed,
        Collider::compound(vec![(below, Quat::IDENTITY, solid_collider(slab))]),
        surface(&settings),
    ));
    Ok(())
}

fn surface(settings: &PhysicsSettings) -> impl Bundle {
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
    let primitives = shape.colliding();
    match primitives.as_slice() {
        [only] if only.pose == tabletop_core::Pose::IDENTITY => solid_collider(only.solid),
        several => Collider::compound(
            several
                .iter()
                .map(|part| (part.pose.location, part.pose.rotation, solid_collider(part.solid)))
                .collect(),
        ),
    }
}

fn solid_collider(solid: Solid) -> Collider {
    match solid {
        Solid::Cuboid(span) => Collider::cuboid(span.x / 2.0, span.y / 2.0, span.z / 2.0),
        Solid::Cylinder { radius, yspan } => Collider::cylinder(yspan / 2.0, radius),
        Solid::Ball(radius) => Collider::ball(radius),
    }
}
