//! Effort where it is needed: the engine's precision in the next step, chosen from its state alone.
//!
//! The solver is most of a tick. An object that stands alone needs few sub-steps; one deep in a stack, or handled, needs many; a
//! landing needs many sweeps.

mod care;
mod depth;
mod engine;
mod foresight;
mod landing;
mod mode;
mod substeps;
mod touches;
mod waking;

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::*,
    rapier::prelude::{CCDSolver, ColliderSet, ContactPair, PhysicsPipeline, RigidBodySet},
};
use tabletop_core::Held;

pub use care::Care;
pub use engine::Engine;
pub(crate) use engine::REACH;
pub(crate) use mode::PREDICTION;
pub(crate) use substeps::{BASE_SUBSTEPS, SUBSTEPS_OF_FREE};

use crate::{holding::JustReleased, settings::PhysicsSettings};
use substeps::substeps;
use touches::bodies_of;

pub(crate) fn spend_effort(
    mut contexts: Query<(
        &mut RapierContextSimulation,
        &RapierContextColliders,
        &mut RapierRigidBodySet,
        &RapierContextJoints,
    )>,
    released: Query<(), With<JustReleased>>,
    held: Query<&RapierRigidBodyHandle, With<Held>>,
    settings: Res<PhysicsSettings>,
    mut care: ResMut<Care>,
) {
    if !released.is_empty() {
        care.expect_landing();
    }
    for (mut simulation, colliders, mut bodies, joints) in &mut contexts {
        let simulation = &mut *simulation;
        // It keeps the fixed shapes from step to step, and learns of changes only in steps in which something is fast: it would look for shapes
        // that are gone.
        simulation.ccd_solver = CCDSolver::new();
        if !joints.impulse_joints.is_empty() {
            // The pipeline keeps the grouping of joints from step to step, and a new pipeline would group them differently: a world that was
            // restored with one would go on differently.
            simulation.pipeline = PhysicsPipeline::new();
        }
        let mut engine = Engine {
            parameters: &mut simulation.integration_parameters,
            islands: &mut simulation.islands,
            broad_phase: &simulation.broad_phase,
            narrow_phase: &simulation.narrow_phase,
            bodies: &mut bodies.bodies,
            colliders: &colliders.colliders,
            joints: &joints.impulse_joints,
            gravity: settings.gravity,
        };
        engine.wake_what_is_hit(held.iter().map(|handle| handle.0));
        care.spend(engine);
    }
}

/// The share of a pair's reported impulses that acted in the last step: the engine counts the impulses at the beginning of the
/// step as well as those of all sub-steps.
pub fn impulse_share(pair: &ContactPair, bodies: &RigidBodySet, colliders: &ColliderSet) -> f32 {
    let touching = bodies_of(pair, colliders).into_iter().flatten();
    let most = touching.filter_map(|body| Some(substeps(bodies.get(body)?)));
    let substeps = most.max().unwrap_or(BASE_SUBSTEPS) as f32;
    substeps / (substeps + 1.0)
}
