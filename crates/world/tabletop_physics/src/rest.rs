//! Rest of the physics: nothing in it can change.

use bevy::{ecs::change_detection::Tick, ecs::system::SystemId, prelude::*};
use bevy_rapier3d::{plugin::systems::step_simulation, prelude::*};
use tabletop_core::{RestApp as _, RestingSystems, SimSystems};

use crate::{
    hooks::ContactHooks,
    workarounds::{
        outside::{ChangedBody, ChangedCollider, Removals},
        quarantine::Quarantine,
    },
};

/// Number of steps after which Rapier's broad phase checks whether its tree is worth tidying up. Any other step in which everything sleeps
/// only counts.
const STEPS_OF_BROAD_PHASE: u64 = 8;

/// The parts of Rapier's context that a step changes.
type Context = (
    Ref<'static, RapierContextSimulation>,
    Ref<'static, RapierRigidBodySet>,
    Ref<'static, RapierContextColliders>,
    Ref<'static, RapierContextJoints>,
);

/// The ticks in which a step last changed Rapier's context.
#[derive(Resource, Default)]
struct LastStep([Tick; 4]);

/// The part of a physics step that a tick at rest still makes.
#[derive(Resource)]
struct BareStep {
    step: SystemId,
    note: SystemId,
}

pub(crate) fn plugin(app: &mut App) {
    // They are entities, which must not come as late as the first rest: those of objects would be others.
    let step = app.register_system(step_simulation::<ContactHooks>);
    let note = app.register_system(note_step);
    app.insert_resource(BareStep { step, note })
        .init_resource::<LastStep>()
        .add_systems(
            FixedUpdate,
            note_step
                .after(PhysicsSet::Writeback)
                .in_set(SimSystems::Physics)
                .in_set(RestingSystems),
        )
        .wake_while(is_any_body_awake)
        .wake_while(is_engine_changed)
        .wake_while(is_any_body_changed)
        .wake_while(is_any_body_removed)
        .wake_while(Quarantine::changes)
        .at_rest(count_steps);
}

fn is_any_body_awake(contexts: Query<&RapierContextSimulation>) -> bool {
    let mut contexts = contexts.iter();
    contexts.any(|simulation| simulation.islands.num_active_bodies() > 0)
}

fn changes(
    (simulation, bodies, colliders, joints): <Context as bevy::ecs::query::QueryData>::Item<'_, '_>,
) -> [Tick; 4] {
    [
        simulation.last_changed(),
        bodies.last_changed(),
        colliders.last_changed(),
        joints.last_changed(),
    ]
}

fn note_step(contexts: Query<Context>, mut last: ResMut<LastStep>) {
    last.0 = contexts.iter().next().map(changes).unwrap_or_default();
}

fn is_engine_changed(contexts: Query<Context>, last: Res<LastStep>) -> bool {
    contexts.iter().any(|context| changes(context) != last.0)
}

fn is_any_body_changed(
    bodies: Query<
        (),
        Or<(
            Changed<Transform>,
            ChangedBody,
            ChangedCollider,
            Or<(Changed<ImpulseJoint>, Changed<MultibodyJoint>)>,
        )>,
    >,
) -> bool {
    !bodies.is_empty()
}

fn is_any_body_removed(mut removed: Removals) -> bool {
    removed.any()
}

/// Lets Rapier count the steps of ticks that are passed over, as far as the number matters: the last bits of later steps
/// depend on it.
fn count_steps(world: &mut World, ticks: u64) -> Result {
    let &BareStep { step, note } = world.resource();
    for _ in 0..ticks % STEPS_OF_BROAD_PHASE {
        world.run_system(step)?;
    }
    world.run_system(note)?;
    Ok(())
}
