//! Touches of a body.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::Shape;
use tabletop_geometry::Pose;

use super::convex::{Convex, convex_parts, placed_parts};
use crate::bodies::collider;

/// True if an object is within a distance, in units, of a shape at a pose.
pub fn is_touching(
    world: &mut World,
    object: Entity,
    shape: &Shape,
    at: Pose,
    within: f32,
) -> bool {
    let mut contexts =
        world.query_filtered::<&RapierContextColliders, With<DefaultRapierContext>>();
    let Ok(colliders) = contexts.single(world) else {
        return false;
    };
    let handle = colliders.entity2collider().get(&object);
    let Some(body) = handle.and_then(|handle| colliders.colliders.get(*handle)) else {
        return false;
    };
    let parts = placed_parts(body);
    let others = convex_parts(at, &collider(shape).raw);
    let is_near = |part: &Convex| others.iter().any(|other| part.is_near(other, within));
    parts.iter().any(is_near)
}
