//! Rigid bodies of objects and of the table.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{Dynamics, ObjectSpec, Shape, Table};
use tabletop_geometry::{Bounds, Polyhedron, Pose, Primitive, Solid, Twist};

use super::mass::mass_properties;
use crate::{
    effort::{BASE_SUBSTEPS, SUBSTEPS_OF_FREE},
    impact::Elasticity,
    settings::PhysicsSettings,
    workarounds::polytope::Polytope,
};

/// Speed, in units/s, below which all points of an object stay that falls asleep after half a second: 5 mm/s. Rapier compares half of it.
const SLEEP_BELOW: f32 = 0.05;

/// The same of chain links: 4 cm/s. A solver that goes from joint to joint leaves a long chain a creep and a tremor of this size, which take a minute to
/// die away.
const LINK_SLEEPS_BELOW: f32 = 0.4;

/// Radius, in units, of a body without solids.
const POINT: f32 = 0.01;

/// The components of an object's body.
pub(crate) fn add_object(world: &mut World, object: Entity, spec: &ObjectSpec) {
    let settings = *world.resource::<PhysicsSettings>();
    let mut body = world.entity_mut(object);
    if let Some(elasticity) = elasticity(&settings, spec.dynamics) {
        body.insert_if_new(elasticity);
    }
    body.insert_if_new((
        collider(&spec.shape),
        // Objects have a size, not a scale; a file's quaternions may be a little longer than one, which looks like a scale.
        ColliderScale::Absolute(Vec3::ONE),
        friction(&settings, spec.dynamics),
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
            sleep_thresholds(&spec.shape)
        } else {
            Sleeping::disabled()
        },
    ));
}

/// Lets an object with a round outline turn at any speed. Rapier turns others by at most 45° a step, so that their corners do not pass through things.
pub(crate) fn let_round_object_spin(world: &mut World, object: Entity) {
    let shape = world.get::<ObjectSpec>(object).map(|spec| &spec.shape);
    let is_round = matches!(shape, Some(Shape::Sphere { .. } | Shape::Cylinder { .. }));
    let handle = world.get::<RapierRigidBodyHandle>(object);
    let Some(handle) = handle.filter(|_| is_round).map(|handle| handle.0) else {
        return;
    };
    let mut sets = world.query_filtered::<&mut RapierRigidBodySet, With<DefaultRapierContext>>();
    if let Ok(mut set) = sets.single_mut(world)
        && let Some(body) = set.bodies.get_mut(handle)
    {
        body.set_allow_fast_rotation(true);
    }
}

/// The components of the table's body.
pub(crate) fn add_table(world: &mut World, table: Entity, size: Table) {
    let settings = *world.resource::<PhysicsSettings>();
    let mut table = world.entity_mut(table);
    if let Some(elasticity) = elasticity(&settings, Dynamics::default()) {
        table.insert_if_new(elasticity);
    }
    table.insert_if_new((
        RigidBody::Fixed,
        compound(&[size.slab()]),
        friction(&settings, Dynamics::default()),
    ));
}

fn friction(settings: &PhysicsSettings, dynamics: Dynamics) -> Friction {
    Friction {
        coefficient: dynamics.friction.unwrap_or(settings.friction),
        combine_rule: CoefficientCombineRule::Multiply,
    }
}

fn elasticity(settings: &PhysicsSettings, dynamics: Dynamics) -> Option<Elasticity> {
    let restitution = dynamics.restitution.unwrap_or(settings.restitution);
    (restitution > 0.0).then_some(Elasticity(restitution))
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
        Shape::Cylinder { .. } | Shape::Sphere { .. } | Shape::Ring { .. } => {
            settings.rolling_damping
        }
        Shape::Link { .. } => settings.link_damping,
        _ => settings.angular_damping,
    }
}

const fn sleep_thresholds(shape: &Shape) -> Sleeping {
    let below = if let Shape::Link { .. } = shape {
        LINK_SLEEPS_BELOW
    } else {
        SLEEP_BELOW
    };
    Sleeping {
        normalized_linear_threshold: below / 2.0,
        angular_threshold: 0.2,
        sleeping: false,
    }
}

/// A cuboid about the origin that encloses a polyhedron too thin for a polytope.
fn cuboid_around(polyhedron: &Polyhedron) -> Collider {
    let Bounds { low, high } = polyhedron.bounds();
    let half = low.abs().max(high.abs()).max(Vec3::splat(1e-4));
    Collider::cuboid(half.x, half.y, half.z)
}
