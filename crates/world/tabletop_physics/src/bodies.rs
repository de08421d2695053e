//! Bodies of new objects, tables and joints, made in the order in which these appeared.
//!
//! Rapier's plugin would take them in the order of Bevy's tables, which depends on everything else in the app, and the
//! order of bodies decides the last bits of their motion.

mod body;
mod joint;
mod mass;
mod reshape;

pub use body::collider;
pub use mass::mass_properties;
pub use reshape::reshape;

use bevy::{ecs::entity_disabling::Disabled, prelude::*};
use bevy_rapier3d::{
    plugin::systems::{init_colliders, init_joints, init_rigid_bodies},
    prelude::RapierRigidBodyHandle,
};
use tabletop_core::{
    CommandSystems, Joint, ObjectSpec, RestApp as _, RestingSystems, SimSystems, Table, TickSystems,
};
use tabletop_history::RollbackApp as _;

use crate::workarounds::burden::NewBodies;

/// Gives new objects, tables and joints their bodies, in [`FixedUpdate`] after
/// [`SimSystems::Ingest`]. Runs while paused, too.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BodySystems;

/// Entities that have appeared and have no body yet. Undo may go back to the middle of a tick, in which there are some.
#[derive(Resource, Clone, Default)]
struct PendingBodies {
    bodies: Vec<Entity>,
    joints: Vec<Entity>,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<PendingBodies>()
        .configure_sets(
            FixedUpdate,
            BodySystems
                .in_set(TickSystems)
                .after(SimSystems::Ingest)
                .before(CommandSystems::Hands),
        )
        .add_systems(
            FixedUpdate,
            take_in
                .run_if(any)
                .in_set(BodySystems)
                .in_set(RestingSystems),
        )
        .wake_while(any)
        .rollback_resource::<PendingBodies>()
        .add_observer(note_object)
        .add_observer(note_table)
        .add_observer(note_joint);
}

fn note_object(add: On<Add, ObjectSpec>, mut pending: ResMut<PendingBodies>) {
    pending.bodies.push(add.entity);
}

fn note_table(add: On<Add, Table>, mut pending: ResMut<PendingBodies>) {
    pending.bodies.push(add.entity);
}

fn note_joint(add: On<Add, Joint>, mut pending: ResMut<PendingBodies>) {
    pending.joints.push(add.entity);
}

fn any(pending: Res<PendingBodies>) -> bool {
    !pending.bodies.is_empty() || !pending.joints.is_empty()
}

/// Gives all pending entities their bodies and joints at once.
/// Without the [plugin](crate::PhysicsPlugin) there are none.
///
/// # Errors
///
/// The world has no Rapier context.
pub fn take_in(world: &mut World) -> Result {
    let Some(mut pending) = world.get_resource_mut::<PendingBodies>() else {
        return Ok(());
    };
    let PendingBodies { bodies, joints } = std::mem::take(&mut *pending);
    for entity in bodies {
        if has_gone(world, entity) {
            continue;
        }
        if let Some(place) = world.get::<Transform>(entity).copied() {
            world
                .entity_mut(entity)
                .insert(GlobalTransform::from(place));
        }
        if let Some(spec) = world.get::<ObjectSpec>(entity).cloned() {
            body::add_object(world, entity, &spec);
        } else if let Some(table) = world.get::<Table>(entity).copied() {
            body::add_table(world, entity, table);
        }
        world.run_system_cached(init_rigid_bodies)?;
        world.run_system_cached(init_colliders)?;
        body::let_round_object_spin(world, entity);
        let handle = world.get::<RapierRigidBodyHandle>(entity).map(|it| it.0);
        world.resource_mut::<NewBodies>().0.extend(handle);
    }
    for entity in joints {
        if has_gone(world, entity) {
            continue;
        }
        if let Some(connection) = world.get::<Joint>(entity).copied() {
            joint::add_joint(world, entity, &connection);
            world.run_system_cached(init_joints)?;
        }
    }
    Ok(())
}

/// True if an entity has gone, for good or until undo brings it back, in the tick in which it came.
fn has_gone(world: &World, entity: Entity) -> bool {
    let entity = world.get_entity(entity);
    entity.map_or(true, |entity| entity.contains::<Disabled>())
}
