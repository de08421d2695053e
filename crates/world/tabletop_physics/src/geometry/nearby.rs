//! Surroundings of bodies that move without Rapier.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::{Aabb, BoundingVolume},
    prelude::*,
    rapier::prelude as rapier,
};

use super::convex::{Convex, placed_parts};

/// A body that reaches into a box.
pub struct Nearby<'a> {
    /// The body's entity.
    pub entity: Entity,
    /// The body.
    pub body: &'a rapier::RigidBody,
    /// Its collider.
    pub collider: &'a rapier::Collider,
    /// The box around it.
    pub bounds: Aabb,
}

impl Nearby<'_> {
    /// Its convex parts, in the table's frame.
    pub fn parts(&self) -> Vec<Convex> {
        placed_parts(self.collider)
    }
}

/// The bodies that reach into a box and can collide, in Rapier's order. Disabled ones are nowhere.
pub fn nearby<'a>(
    colliders: &'a RapierContextColliders,
    bodies: &'a RapierRigidBodySet,
    near: Aabb,
    can_be_met: impl Fn(Entity) -> bool,
) -> impl Iterator<Item = Nearby<'a>> {
    let colliders = colliders.colliders.iter();
    colliders.filter_map(move |(_, collider)| {
        let parent = collider.parent()?;
        let body = bodies.bodies.get(parent).filter(|body| body.is_enabled())?;
        let entity = bodies
            .rigid_body_entity(parent)
            .filter(|it| can_be_met(*it))?;
        let bounds = collider.compute_aabb();
        bounds.intersects(&near).then_some(Nearby {
            entity,
            body,
            collider,
            bounds,
        })
    })
}
