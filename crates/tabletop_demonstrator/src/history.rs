//! Undo and redo: the world as it was when a segment of a recording began, bit for bit.

use bevy::{
    ecs::{entity_disabling::Disabled, system::SystemState},
    prelude::*,
};
use bevy_rapier3d::prelude::*;
use tabletop_core::{
    Gripped, Held, History, Recording, Remembered, Rewinds, Rewound, SimCommand, SimFact,
};
use tabletop_physics::{JustReleased, KeepRemoved, Parked, PhysicsSnapshot};

use crate::grasp::{Carry, CarryTarget};

/// The snapshots of the present recording.
#[derive(Resource, Default)]
pub(crate) struct Snapshots {
    undoable: Vec<Snapshot>,
    redoable: Vec<Undone>,
}

/// A segment that was undone.
struct Undone {
    begin: Snapshot,
    end: Snapshot,
}

/// The world at a moment between two ticks.
struct Snapshot {
    physics: Option<PhysicsSnapshot>,
    entities: Vec<(Entity, EntityState)>,
    resources: Remembered,
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

/// Tells that a hand is about to act, and remembers the world before it if that can be undone.
pub(crate) fn begin_segment(world: &mut World) {
    world.write_message(SimFact::SegmentBegun);
    if !world.resource::<Recording>().0 {
        return;
    }
    world.resource_mut::<KeepRemoved>().0 = true;
    let snapshot = Snapshot::take(world);
    let mut snapshots = world.resource_mut::<Snapshots>();
    snapshots.undoable.push(snapshot);
    snapshots.redoable.clear();
    publish(world);
}

/// Carries out undo and redo, and forgets everything when the recording has ended.
pub(crate) fn undo_and_redo(
    world: &mut World,
    reader: &mut SystemState<MessageReader<SimCommand>>,
) -> Result {
    let commands = SimCommand::unread(world, reader, |command| {
        matches!(command, SimCommand::Undo | SimCommand::Redo)
    })?;
    if !world.resource::<Recording>().0 {
        forget(world);
    }
    for command in commands {
        let fact = match command {
            SimCommand::Undo => undo(world),
            _ => redo(world),
        };
        world.write_message(fact);
        publish(world);
    }
    Ok(())
}

fn undo(world: &mut World) -> SimFact {
    let Some(begin) = world.resource_mut::<Snapshots>().undoable.pop() else {
        return SimFact::Refused {
            reason: "there is nothing to undo: only what was done in the present recording can be"
                .into(),
        };
    };
    let end = Snapshot::take(world);
    begin.restore(world);
    let undone = Undone { begin, end };
    world.resource_mut::<Snapshots>().redoable.push(undone);
    SimFact::Undone
}

fn redo(world: &mut World) -> SimFact {
    let Some(Undone { begin, end }) = world.resource_mut::<Snapshots>().redoable.pop() else {
        return SimFact::Refused {
            reason: "there is nothing to redo".into(),
        };
    };
    end.restore(world);
    world.resource_mut::<Snapshots>().undoable.push(begin);
    SimFact::Redone
}

fn publish(world: &mut World) {
    let snapshots = world.resource::<Snapshots>();
    let history = History {
        undoable: snapshots.undoable.len(),
        redoable: snapshots.redoable.len(),
    };
    world.resource_mut::<History>().set_if_neq(history);
}

/// Drops the snapshots and what was kept for them.
fn forget(world: &mut World) {
    if !world.resource::<KeepRemoved>().0 {
        return;
    }
    world.resource_mut::<KeepRemoved>().0 = false;
    *world.resource_mut::<Snapshots>() = Snapshots::default();
    publish(world);
    let mut disabled = world.query_filtered::<Entity, (With<Rewinds>, With<Disabled>)>();
    for entity in disabled.iter(world).collect::<Vec<_>>() {
        world.try_despawn(entity).ok();
    }
}

impl Snapshot {
    fn take(world: &mut World) -> Self {
        let mut simulated = world.query_filtered::<Entity, With<Rewinds>>();
        let entities: Vec<_> = simulated.iter(world).collect();
        Self {
            physics: PhysicsSnapshot::take(world),
            entities: entities
                .into_iter()
                .map(|entity| (entity, EntityState::of(world.entity(entity))))
                .collect(),
            resources: world.resource::<Rewound>().remember(world),
        }
    }

    fn restore(&self, world: &mut World) {
        let mut simulated = world.query_filtered::<Entity, With<Rewinds>>();
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
