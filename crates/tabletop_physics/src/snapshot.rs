//! The state of the physics engine at a moment.

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::*,
    rapier::prelude::{CCDSolver, DefaultBroadPhase, IslandManager, NarrowPhase, PhysicsPipeline},
};

use crate::effort::Care;

/// The physics engine's whole state: not poses alone, but contacts, sleep and everything else that decides what comes next.
/// A world that is [restored](Self::restore) goes on bit for bit as the one that the snapshot was [taken](Self::take) of,
/// if the entities of its bodies have their components of that moment, too.
#[derive(Clone, Default)]
pub struct PhysicsSnapshot {
    bodies: RapierRigidBodySet,
    colliders: RapierContextColliders,
    joints: RapierContextJoints,
    islands: IslandManager,
    broad_phase: DefaultBroadPhase,
    narrow_phase: NarrowPhase,
    ccd_solver: CCDSolver,
    care: Care,
}

/// The parts of Rapier's context.
type Context = (
    &'static mut RapierContextSimulation,
    &'static mut RapierRigidBodySet,
    &'static mut RapierContextColliders,
    &'static mut RapierContextJoints,
);

impl PhysicsSnapshot {
    /// The present state; `None` in a world without physics.
    pub fn take(world: &mut World) -> Option<Self> {
        let care = *world.get_resource()?;
        let mut contexts = world.query_filtered::<Context, With<DefaultRapierContext>>();
        let (simulation, bodies, colliders, joints) = contexts.single_mut(world).ok()?;
        Some(Self {
            bodies: bodies.clone(),
            colliders: colliders.clone(),
            joints: joints.clone(),
            islands: simulation.islands.clone(),
            broad_phase: simulation.broad_phase.clone(),
            narrow_phase: simulation.narrow_phase.clone(),
            ccd_solver: simulation.ccd_solver.clone(),
            care,
        })
    }

    /// Puts the engine back into this state.
    pub fn restore(&self, world: &mut World) {
        world.insert_resource(self.care);
        let mut contexts = world.query_filtered::<Context, With<DefaultRapierContext>>();
        let Ok((mut simulation, mut bodies, mut colliders, mut joints)) =
            contexts.single_mut(world)
        else {
            return;
        };
        bodies.clone_from(&self.bodies);
        colliders.clone_from(&self.colliders);
        joints.clone_from(&self.joints);
        simulation.islands = self.islands.clone();
        simulation.broad_phase = self.broad_phase.clone();
        simulation.narrow_phase = self.narrow_phase.clone();
        simulation.ccd_solver = self.ccd_solver.clone();
        simulation.pipeline = PhysicsPipeline::new();
    }
}

/// Makes the engine as new if it has no bodies: which places they had would decide the last bits of what comes next.
pub fn renew_if_empty(world: &mut World) {
    let mut bodies = world.query_filtered::<&RapierRigidBodySet, With<DefaultRapierContext>>();
    if bodies.single(world).is_ok_and(|set| set.bodies.is_empty()) {
        PhysicsSnapshot::default().restore(world);
    }
}

/// Takes an entity's body, with its colliders and joints, out of the engine, and leaves the entity as it is.
pub fn remove_body(world: &mut World, entity: Entity) {
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
