//! Snapshots of Rapier.

use std::sync::Arc;

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::*,
    rapier::prelude::{
        CCDSolver, Collider, ContactManifold, ContactPair, DefaultBroadPhase, ImpulseJoint,
        IslandManager, NarrowPhase, PhysicsPipeline, RigidBody,
    },
};
use tabletop_core::Held;
use tabletop_history::{RollbackState, Since, despawn_or_park};

use crate::{effort::Care, holding::Carry, workarounds::rolling};

/// Rapier's whole state: not poses alone, but contacts, sleep and all else on which later steps depend.
/// A world that is [restored](RollbackState::restore) goes on bit for bit as the one that was [saved](RollbackState::save), if the
/// entities of its bodies have their components of that moment, too.
#[derive(Clone, Default)]
pub struct PhysicsSnapshot {
    bodies: Arc<RapierRigidBodySet>,
    colliders: Arc<RapierContextColliders>,
    joints: Arc<RapierContextJoints>,
    simulation: Arc<EngineState>,
}

/// The part of a [`RapierContextSimulation`] on which later steps depend.
struct EngineState {
    islands: IslandManager,
    broad_phase: DefaultBroadPhase,
    narrow_phase: NarrowPhase,
    ccd_solver: CCDSolver,
}

impl Default for EngineState {
    fn default() -> Self {
        Self {
            islands: IslandManager::default(),
            broad_phase: DefaultBroadPhase::default(),
            narrow_phase: rolling::narrow_phase(),
            ccd_solver: CCDSolver::default(),
        }
    }
}

impl From<&RapierContextSimulation> for EngineState {
    fn from(simulation: &RapierContextSimulation) -> Self {
        Self {
            islands: simulation.islands.clone(),
            broad_phase: simulation.broad_phase.clone(),
            narrow_phase: simulation.narrow_phase.clone(),
            ccd_solver: simulation.ccd_solver.clone(),
        }
    }
}

/// The parts of Rapier's context.
type Context = (
    &'static mut RapierContextSimulation,
    &'static mut RapierRigidBodySet,
    &'static mut RapierContextColliders,
    &'static mut RapierContextJoints,
);

impl RollbackState for PhysicsSnapshot {
    fn save(world: &mut World, earlier: Option<(&Self, Since)>) -> Option<Self> {
        let mut contexts = world.query_filtered::<EntityRef, With<DefaultRapierContext>>();
        let context = contexts.single(world).ok()?;
        Some(Self {
            bodies: save(
                context,
                earlier,
                |snapshot| &snapshot.bodies,
                RapierRigidBodySet::clone,
            )?,
            colliders: save(
                context,
                earlier,
                |snapshot| &snapshot.colliders,
                RapierContextColliders::clone,
            )?,
            joints: save(
                context,
                earlier,
                |snapshot| &snapshot.joints,
                RapierContextJoints::clone,
            )?,
            simulation: save(
                context,
                earlier,
                |snapshot| &snapshot.simulation,
                |simulation: &RapierContextSimulation| simulation.into(),
            )?,
        })
    }

    fn restore(&self, world: &mut World) {
        let mut contexts = world.query_filtered::<Context, With<DefaultRapierContext>>();
        let Ok((mut simulation, mut bodies, mut colliders, mut joints)) =
            contexts.single_mut(world)
        else {
            return;
        };
        bodies.clone_from(&self.bodies);
        colliders.clone_from(&self.colliders);
        joints.clone_from(&self.joints);
        simulation.islands = self.simulation.islands.clone();
        simulation.broad_phase = self.simulation.broad_phase.clone();
        simulation.narrow_phase = self.simulation.narrow_phase.clone();
        simulation.ccd_solver = self.simulation.ccd_solver.clone();
        simulation.pipeline = PhysicsPipeline::new();
    }

    fn bytes(&self, besides: Option<&Self>) -> usize {
        fn own<T>(own: &Arc<T>, other: Option<&Arc<T>>, bytes: impl FnOnce(&T) -> usize) -> usize {
            match other {
                Some(other) if Arc::ptr_eq(own, other) => 0,
                _ => size_of::<T>() + bytes(own),
            }
        }
        own(
            &self.bodies,
            besides.map(|other| &other.bodies),
            bytes_of_bodies,
        ) + own(
            &self.colliders,
            besides.map(|other| &other.colliders),
            bytes_of_colliders,
        ) + own(
            &self.joints,
            besides.map(|other| &other.joints),
            bytes_of_joints,
        ) + own(
            &self.simulation,
            besides.map(|other| &other.simulation),
            bytes_of_simulation,
        )
    }
}

/// A part of Rapier's state, or the earlier snapshot of it if it has not changed since.
fn save<C: Component, S>(
    context: EntityRef,
    earlier: Option<(&PhysicsSnapshot, Since)>,
    part: impl Fn(&PhysicsSnapshot) -> &Arc<S>,
    copy: impl FnOnce(&C) -> S,
) -> Option<Arc<S>> {
    let ticks = context.get_change_ticks::<C>()?;
    match earlier {
        Some((snapshot, since)) if !since.has_changed(ticks) => Some(part(snapshot).clone()),
        _ => Some(Arc::new(copy(context.get()?))),
    }
}

/// Bytes of an entry in the maps from entities to handles and back, and in the poses by handle.
const BYTES_PER_ENTRY: usize = 2 * size_of::<Entity>() + size_of::<GlobalTransform>();

fn bytes_of_bodies(set: &RapierRigidBodySet) -> usize {
    set.bodies.len() * (size_of::<RigidBody>() + BYTES_PER_ENTRY)
}

fn bytes_of_colliders(set: &RapierContextColliders) -> usize {
    set.colliders.len() * (size_of::<Collider>() + BYTES_PER_ENTRY)
}

fn bytes_of_joints(set: &RapierContextJoints) -> usize {
    set.impulse_joints.len() * (size_of::<ImpulseJoint>() + BYTES_PER_ENTRY)
}

fn bytes_of_simulation(simulation: &EngineState) -> usize {
    let manifold = |manifold: &ContactManifold| {
        size_of::<ContactManifold>()
            + size_of_val(&*manifold.points)
            + size_of_val(&*manifold.data.solver_contacts)
    };
    let pair = |pair: &ContactPair| {
        let manifolds = pair.manifolds.iter().chain(&pair.solver_clusters);
        size_of::<ContactPair>() + manifolds.map(manifold).sum::<usize>()
    };
    simulation.narrow_phase.contact_pairs().map(pair).sum()
}

/// Renews Rapier if it has no bodies: the handles of removed bodies would decide the last bits of later steps.
pub fn renew_if_empty(world: &mut World) {
    let mut bodies = world.query_filtered::<&RapierRigidBodySet, With<DefaultRapierContext>>();
    if bodies.single(world).is_ok_and(|set| set.bodies.is_empty()) {
        PhysicsSnapshot::default().restore(world);
        world.insert_resource(Care::default());
    }
}

/// Takes an object from its holder and removes it from the world, for good or until undo brings it back. Its body is removed at once, so
/// keeping the object makes no difference to the others.
pub fn remove_object(world: &mut World, object: Entity) {
    world.entity_mut(object).remove::<(Held, Carry)>();
    remove_body(world, object);
    despawn_or_park(world, object);
}

/// Removes a joint between two objects that stay, for good or until undo brings it back.
pub fn remove_joint(world: &mut World, joint: Entity) {
    let mut contexts =
        world.query_filtered::<&mut RapierContextJoints, With<DefaultRapierContext>>();
    if let Ok(mut joints) = contexts.single_mut(world)
        && let Some(handle) = joints.entity2impulse_joint().get(&joint).copied()
    {
        joints.impulse_joints.remove(handle, true);
    }
    despawn_or_park(world, joint);
}

/// Takes an entity's body, with its colliders and joints, out of Rapier. The entity itself stays.
fn remove_body(world: &mut World, entity: Entity) {
    let mut contexts = world.query_filtered::<Context, With<DefaultRapierContext>>();
    let Ok((mut simulation, mut bodies, mut colliders, mut joints)) = contexts.single_mut(world)
    else {
        return;
    };
    let Some(handle) = bodies.entity2body().get(&entity).copied() else {
        return;
    };
    let joints = &mut *joints;
    bodies.bodies.remove(
        handle,
        &mut simulation.islands,
        &mut colliders.colliders,
        &mut joints.impulse_joints,
        &mut joints.multibody_joints,
        true,
    );
}
