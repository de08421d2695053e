//! Rigid bodies of objects and of the table.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{Dynamics, ObjectSpec, Shape, Table};
use tabletop_geometry::{Bounds, Polyhedron, Pose, Primitive, Solid, Twist};

use super::mass::mass_properties;
use crate::{
    effort::{BASE_SUBSTEPS, SUBSTEPS_OF_FREE},
    settings::PhysicsSettings,
    workarounds::polytope::Polytope,
};

/// Speeds below which an object falls asleep after half a second: 0.02 m/s and 0.2 rad/s.
const SLEEP_THRESHOLDS: Sleeping = Sleeping {
    normalized_linear_threshold: 0.2,
    angular_threshold: 0.2,
    sleeping: false,
};

/// Radius, in units, of a body without solids.
const POINT: f32 = 0.01;

/// The components of an object's body.
pub(crate) fn add_object(world: &mut World, object: Entity, spec: &ObjectSpec) {
    let settings = *world.resource::<PhysicsSettings>();
    let mut body = world.entity_mut(object);
    body.insert_if_new((
        collider(&spec.shape),
        // Objects have a size, not a scale; a file's quaternions may be a little longer than one, which looks like a scale.
        ColliderScale::Absolute(Vec3::ONE),
        surface(&settings, spec.dynamics),
        Velocity::linear(spec.dynamics.velocity),
        Twist {
            linear: spec.dynamics.velocity,
            ..Twist::default()
        },
    ));
    if spec.is_fixed() {
        body.insert_if_new(RigidBody::Fixed);
        return;
    }
    body.insert_if_new((
        RigidBody::Dynamic,
        ColliderMassProperties::MassProperties(mass_properties(&spec.shape, spec.mass)),
        Ccd::enabled(),
        AdditionalSolverIterations(SUBSTEPS_OF_FREE - BASE_SUBSTEPS),
        Damping {
            linear_damping: 0.0,
            angular_damping: angular_damping(&spec.shape, &settings),
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
    let surface = surface(world.resource::<PhysicsSettings>(), Dynamics::default());
    world
        .entity_mut(table)
        .insert_if_new((RigidBody::Fixed, compound(&[size.slab()]), surface));
}

fn surface(settings: &PhysicsSettings, dynamics: Dynamics) -> impl Bundle + use<> {
    (
        Friction {
            coefficient: dynamics.friction.unwrap_or(settings.friction),
            combine_rule: CoefficientCombineRule::Multiply,
        },
        Restitution {
            coefficient: dynamics.restitution.unwrap_or(settings.restitution),
            combine_rule: CoefficientCombineRule::Average,
        },
    )
}

/// The collider of a whole shape, in the shape's frame.
pub fn collider(shape: &Shape) -> Collider {
    match shape.colliding().as_slice() {
        [] => Collider::ball(POINT),
        [only] if only.pose == Pose::IDENTITY => solid_collider(&only.solid),
        parts => compound(parts),
    }
}

fn compound(parts: &[Primitive]) -> Collider {
    let parts = parts.iter().map(|part| {
        let Pose { location, rotation } = part.pose;
        (location, rotation, solid_collider(&part.solid))
    });
    Collider::compound(parts.collect())
}

fn solid_collider(solid: &Solid) -> Collider {
    match *solid {
        Solid::Cuboid(span) => Collider::cuboid(span.x / 2.0, span.y / 2.0, span.z / 2.0),
        Solid::Cylinder { radius, yspan } => match Polytope::of_cylinder(radius, yspan) {
            Some(prism) => prism.into(),
            None => Collider::cylinder(yspan / 2.0, radius),
        },
        Solid::Ball(radius) => Collider::ball(radius),
        Solid::Polyhedron(ref polyhedron) => match Polytope::of_polyhedron(polyhedron) {
            Some(polytope) => polytope.into(),
            None => cuboid_around(polyhedron),
        },
    }
}

/// Share of its rotation that a body of this shape loses in a second.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "few shapes roll or hang in chains"
)]
const fn angular_damping(shape: &Shape, settings: &PhysicsSettings) -> f32 {
    match shape {
        Shape::Cylinder { .. } | Shape::Sphere { .. } => settings.rolling_damping,
        Shape::Link { .. } => settings.link_damping,
        _ => settings.angular_damping,
    }
}

/// A cuboid about the origin that encloses a polyhedron too thin for a polytope.
fn cuboid_around(polyhedron: &Polyhedron) -> Collider {
    let Bounds { low, high } = polyhedron.bounds();
    let half = low.abs().max(high.abs()).max(Vec3::splat(1e-4));
    Collider::cuboid(half.x, half.y, half.z)
}
