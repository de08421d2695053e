//! Reshaping of objects: a control enters another state.

use bevy::prelude::*;
use bevy_rapier3d::{parry::bounding_volume::Aabb, prelude::*};
use tabletop_core::ObjectSpec;
use tabletop_geometry::Primitive;

use super::{body::collider, mass::mass_properties};
use crate::geometry::nearby;

/// Size of the space in which everything wakes, relative to the changed object.
const WOKEN: f32 = 1.05;

/// Replaces the description of an object on the table by another of the same id, in place: from now on it looks and collides so, and
/// its neighbours wake.
pub fn reshape(world: &mut World, object: Entity, spec: ObjectSpec) {
    let is_other_body = world.get::<ObjectSpec>(object).is_none_or(|before| {
        let solids = |spec: &ObjectSpec| {
            let solid = |part: &Primitive| (part.pose, part.solid.clone());
            let solids = spec.shape.colliding();
            solids.iter().map(solid).collect::<Vec<_>>()
        };
        solids(before) != solids(&spec)
    });
    if is_other_body {
        let before = room_of(world, object);
        set_collider(world, object, &spec);
        for room in [before, room_of(world, object)].into_iter().flatten() {
            wake_in(world, room);
        }
    }
    world.entity_mut(object).insert(spec);
}

/// Changes the collider in Rapier, where undo restores it. The components follow unnoticed: those of a new object have yet to be
/// carried to Rapier.
fn set_collider(world: &mut World, object: Entity, spec: &ObjectSpec) {
    let collider = collider(&spec.shape);
    let mass = (!spec.is_fixed()).then(|| mass_properties(&spec.shape, spec.mass));
    let mut contexts =
        world.query_filtered::<&mut RapierContextColliders, With<DefaultRapierContext>>();
    if let Ok(mut colliders) = contexts.single_mut(world)
        && let Some(handle) = colliders.entity2collider().get(&object).copied()
        && let Some(engine_collider) = colliders.colliders.get_mut(handle)
    {
        engine_collider.set_shape(collider.raw.clone());
        if let Some(mass) = mass {
            engine_collider.set_mass_properties(mass.into_rapier());
        }
    }
    if let Some(mut component) = world.get_mut::<Collider>(object) {
        *component.bypass_change_detection() = collider;
    }
    if let Some(mass) = mass
        && let Some(mut component) = world.get_mut::<ColliderMassProperties>(object)
    {
        *component.bypass_change_detection() = ColliderMassProperties::MassProperties(mass);
    }
}

fn room_of(world: &mut World, object: Entity) -> Option<Aabb> {
    let mut contexts =
        world.query_filtered::<&RapierContextColliders, With<DefaultRapierContext>>();
    let colliders = contexts.single(world).ok()?;
    let handle = colliders.entity2collider().get(&object)?;
    let bounds = colliders.colliders.get(*handle)?.compute_aabb();
    let half = bounds.half_extents() * WOKEN;
    Some(Aabb::new(bounds.center() - half, bounds.center() + half))
}

fn wake_in(world: &mut World, room: Aabb) {
    let mut contexts = world
        .query_filtered::<(&RapierContextColliders, &RapierRigidBodySet), With<DefaultRapierContext>>();
    let Ok((colliders, bodies)) = contexts.single(world) else {
        return;
    };
    let near: Vec<_> = nearby(colliders, bodies, room, |_| true)
        .map(|body| body.entity)
        .collect();
    for body in near {
        if let Some(mut sleeping) = world.get_mut::<Sleeping>(body) {
            sleeping.sleeping = false;
        }
    }
}
