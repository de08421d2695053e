//! The world at a moment, to be gone back to.

use bevy::{ecs::entity_disabling::Disabled, prelude::*};
use bevy_rapier3d::prelude::*;
use tabletop_core::{Gripped, Held, ResourceSnapshot, Rollback, RollbackRegistry};
use tabletop_physics::{JustReleased, Parked, PhysicsSnapshot};

use crate::grasp::{Carry, CarryTarget};

/// The world at a moment between two ticks, bit for bit: what is [restored](Self::restore) goes on as it did then.
///
/// Objects that were removed since must have been [kept](tabletop_physics::KeepRemoved). Whether the simulation is paused is not part
/// of it.
pub struct Snapshot {
    physics: Option<PhysicsSnapshot>,
    entities: Vec<(Entity, EntityState)>,
    resources: ResourceSnapshot,
}

/// What changes in an object, joint, table or link while it exists.
#[derive(Clone, Default)]
struct EntityState {
    transform: Option<Transform>,
    global: Option<GlobalTransform>,
    velocity: Option<Velocity>,
    sleeping: Option<Sleeping>,
    body: Option<RigidBody>,
    gravity: Option<GravityScale>,
    disabled: Option<RigidBodyDisabled>,
    held: Option<Held>,
    gripped: Option<Gripped>,
    target: Option<CarryTarget>,
    carry: Option<Carry>,
    just_released: Option<JustReleased>,
}

impl Snapshot {
    /// The present state.
    pub fn take(world: &mut World) -> Self {
        let mut simulated = world.query_filtered::<Entity, With<Rollback>>();
        let entities: Vec<_> = simulated.iter(world).collect();
        Self {
            physics: PhysicsSnapshot::take(world),
            entities: entities
                .into_iter()
                .map(|entity| (entity, EntityState::of(world.entity(entity))))
                .collect(),
            resources: world.resource::<RollbackRegistry>().remember(world),
        }
    }

    /// Puts the world back into this state. What has come since is disabled.
    pub fn restore(&self, world: &mut World) {
        let mut simulated = world.query_filtered::<Entity, With<Rollback>>();
        let present: Vec<_> = simulated.iter(world).collect();
        for entity in present {
            if !self.entities.iter().any(|(kept, _)| *kept == entity) {
                world.entity_mut(entity).insert(Disabled);
            }
        }
        // Before the marks of what hands hold go, which would be taken for a loss.
        self.resources.restore(world);
        for (entity, state) in &self.entities {
            let Ok(mut entity) = world.get_entity_mut(*entity) else {
                continue;
            };
            entity.remove::<(Parked, Disabled)>();
            state.restore(&mut entity);
        }
        self.resources.restore(world);
        if let Some(physics) = &self.physics {
            physics.restore(world);
        }
    }
}

impl EntityState {
    fn of(entity: EntityRef) -> Self {
        Self {
            transform: entity.get().copied(),
            global: entity.get().copied(),
            velocity: entity.get().copied(),
            sleeping: entity.get().copied(),
            body: entity.get().copied(),
            gravity: entity.get().copied(),
            disabled: entity.get().copied(),
            held: entity.get().copied(),
            gripped: entity.get().copied(),
            target: entity.get().copied(),
            carry: entity.get().copied(),
            just_released: entity.get().copied(),
        }
    }

    fn restore(&self, entity: &mut EntityWorldMut) {
        put(entity, self.transform);
        put(entity, self.global);
        put(entity, self.velocity);
        put(entity, self.sleeping);
        put(entity, self.body);
        put(entity, self.gravity);
        put(entity, self.disabled);
        put(entity, self.held);
        put(entity, self.gripped);
        put(entity, self.target);
        put(entity, self.carry);
        put(entity, self.just_released);
    }
}

fn put<C: Component>(entity: &mut EntityWorldMut, component: Option<C>) {
    match component {
        Some(component) => entity.insert(component),
        None => entity.remove::<C>(),
    };
}
